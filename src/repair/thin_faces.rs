//! Removes needles, caps and folds: a needle's short edge is collapsed onto one of its ends, a cap's long edge is flipped,
//! and of two faces that lie on each other like a closed book the outer corners become one. No vertex gets a new place, and
//! the surface stays within a few hundredths of the face's longest edge.

use super::{Changes, Draft, Effects};
use crate::budget::{Budget, Stopped};
use crate::geom::{DVec3, NEEDLE_RATIO, Thinness, are_collinear, is_folded, thinness};
use crate::mesh::half_edge::{BuildError, FaceId, HalfEdgeId, HalfEdgeMesh, VertexId};

/// Which thin faces go, and how thin they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ThinFaces {
    /// Faces whose shortest edge is below a hundredth of their longest.
    pub needles: bool,
    /// Other faces with an angle above 175 degrees.
    pub caps: bool,
    /// Pairs of faces less than one degree apart, whose corners beside their edge are close to each other.
    pub folds: bool,
}

impl ThinFaces {
    /// True when some go.
    pub fn any(self) -> bool {
        self.needles || self.caps || self.folds
    }
}

/// Least cosine between the normal of a face before and after, and of a flipped pair and the face that was no cap.
const TURN_COSINE_MIN: f64 = 0.9;

/// Times that all faces are looked at: a face that is mended makes room for another.
const ROUNDS: usize = 4;

/// Mends thin faces, each only where the mesh stays a manifold of the same topology and no face around turns by more than
/// 26 degrees; others stay. A draft that is no manifold (see [`cut`](super::cut::cut)) stays as it is.
///
/// # Errors
/// When the budget stops the run.
pub fn mend_thin_faces(draft: &mut Draft, which: ThinFaces, budget: &Budget) -> Result<Changes, Stopped> {
    let mesh = match HalfEdgeMesh::from_triangles(&draft.triangles, draft.positions.len(), budget) {
        Ok(mesh) => mesh,
        Err(BuildError::Stopped(stopped)) => return Err(stopped),
        Err(_) => return Ok(counted([0; 4])),
    };
    let mut mending = Mending { mesh, positions: &draft.positions };
    let (mut collapsed, mut flipped, mut closed, mut left) = (0, 0, 0, 0);
    for _ in 0..ROUNDS {
        let faces: Vec<FaceId> = mending.mesh.faces().collect();
        let mended_before = collapsed + flipped + closed;
        left = 0;
        if which.folds {
            for (i, h) in mending.mesh.edges().collect::<Vec<HalfEdgeId>>().into_iter().enumerate() {
                if i % 1024 == 0 {
                    budget.spend(1024)?;
                }
                if mending.mesh.contains(h) && mending.is_fold(h) {
                    match mending.close(h) {
                        true => closed += 1,
                        false => left += 1,
                    }
                }
            }
        }
        for (i, face) in faces.into_iter().enumerate() {
            if i % 1024 == 0 {
                budget.spend(1024)?;
            }
            match mending.thinness(face) {
                Some((Thinness::Needle { .. }, short)) if which.needles => match mending.collapse(short) {
                    true => collapsed += 1,
                    false => left += 1,
                },
                Some((Thinness::Cap { .. }, long)) if which.caps => match mending.flip(long) {
                    true => flipped += 1,
                    false => left += 1,
                },
                _ => {}
            }
        }
        if collapsed + flipped + closed == mended_before {
            break;
        }
    }
    if collapsed + flipped + closed > 0 {
        let mesh = mending.mesh;
        let faces: Vec<FaceId> = mesh.faces().collect();
        let corners = |&face: &FaceId| {
            let mut corners = mesh.corners(face).map(|v| v.index() as u32);
            [corners.next(), corners.next(), corners.next()].map(Option::unwrap_or_default)
        };
        draft.triangle_origin = faces.iter().map(|face| draft.triangle_origin[face.index()]).collect();
        draft.triangles = faces.iter().map(corners).collect();
        draft.drop_unused_vertices();
    }
    Ok(counted([collapsed, flipped, closed, left]))
}

fn counted([collapsed, flipped, closed, left]: [u64; 4]) -> Changes {
    Changes::counted([
        ("needles_collapsed", collapsed),
        ("caps_flipped", flipped),
        ("folds_closed", closed),
        ("thin_faces_left", left),
    ])
    .with(Effects { mended_thin_faces: collapsed + flipped + closed > 0, ..Effects::default() })
}

struct Mending<'d> {
    mesh: HalfEdgeMesh,
    positions: &'d [DVec3],
}

impl Mending<'_> {
    fn place(&self, v: VertexId) -> DVec3 {
        self.positions[v.index()]
    }

    /// The places of the corners of `face`, in its order.
    fn corners(&self, face: FaceId) -> [DVec3; 3] {
        let mut corners = self.mesh.corners(face).map(|v| self.place(v));
        [corners.next(), corners.next(), corners.next()].map(Option::unwrap_or_default)
    }

    /// How `face` is thin, and the edge by which it is.
    fn thinness(&self, face: FaceId) -> Option<(Thinness, HalfEdgeId)> {
        let sides: Vec<HalfEdgeId> = self.mesh.loop_of(self.mesh.side(face)?).collect();
        let corners: Vec<DVec3> = sides.iter().map(|&h| self.place(self.mesh.origin(h))).collect();
        let thin = thinness([corners[0], corners[1], corners[2]])?;
        let (Thinness::Needle { shortest: edge } | Thinness::Cap { longest: edge }) = thin;
        Some((thin, sides[edge]))
    }

    /// True when the two faces of an edge lie almost on each other.
    fn is_fold(&self, h: HalfEdgeId) -> bool {
        let faces = [h, self.mesh.twin(h)].map(|h| self.mesh.face(h).map(|face| self.corners(face)));
        let [Some(one), Some(other)] = faces else { return false };
        let is_flat = |[a, b, c]: [DVec3; 3]| are_collinear(a, b, c);
        !is_flat(one) && !is_flat(other) && is_folded([unit_normal(one), unit_normal(other)])
    }

    /// Joins the corners of a fold beside its edge, if they are close: the edge is flipped and then collapsed.
    fn close(&mut self, h: HalfEdgeId) -> bool {
        let apex = |h: HalfEdgeId| self.place(self.mesh.destination(self.mesh.next(h)));
        let gap = apex(h).distance(apex(self.mesh.twin(h)));
        let length = self.place(self.mesh.origin(h)).distance(self.place(self.mesh.destination(h)));
        if gap >= NEEDLE_RATIO * length || self.mesh.flip(h).is_err() {
            return false;
        }
        let is_closed = self.collapse(h);
        // Three more flips bring a quadrilateral's diagonal back with its direction.
        if !is_closed {
            for _ in 0..3 {
                let _ = self.mesh.flip(h);
            }
        }
        is_closed
    }

    /// Collapses an edge onto the end that turns the faces around the other one less.
    fn collapse(&mut self, h: HalfEdgeId) -> bool {
        let both = [h, self.mesh.twin(h)].map(|h| (self.turn_of_collapse(h), h));
        let [(first, h), (second, g)] = both;
        let (best, chosen) = if first >= second { (first, h) } else { (second, g) };
        best >= TURN_COSINE_MIN && self.mesh.collapse(chosen).is_ok()
    }

    /// The least cosine between the normals, before and after, of the faces that stay when `h` is collapsed.
    fn turn_of_collapse(&self, h: HalfEdgeId) -> f64 {
        let (gone, kept) = (self.mesh.origin(h), self.mesh.destination(h));
        let mut least = 1.0f64;
        for face in self.mesh.star(gone).filter_map(|g| self.mesh.face(g)) {
            if self.mesh.corners(face).any(|v| v == kept) {
                continue;
            }
            let before = self.corners(face);
            let mut after = self.mesh.corners(face).map(|v| self.place(if v == gone { kept } else { v }));
            let after = [after.next(), after.next(), after.next()].map(Option::unwrap_or_default);
            least = least.min(turn(before, after));
        }
        least
    }

    /// Flips the long edge of a cap, if both new faces lie as the one on its other side does.
    fn flip(&mut self, h: HalfEdgeId) -> bool {
        let twin = self.mesh.twin(h);
        let Some(face) = self.mesh.face(twin) else { return false };
        let flat = self.corners(face);
        let apex = |h: HalfEdgeId| self.place(self.mesh.destination(self.mesh.next(h)));
        let [a, b] = [self.mesh.origin(h), self.mesh.destination(h)].map(|v| self.place(v));
        let (x, y) = (apex(h), apex(twin));
        let are_good = [[a, y, x], [y, b, x]].into_iter().all(|new| turn(flat, new) >= TURN_COSINE_MIN);
        are_good && self.mesh.flip(h).is_ok()
    }
}

/// Cosine between the normals of two triangles; -1 where one of them is collinear.
fn turn(before: [DVec3; 3], after: [DVec3; 3]) -> f64 {
    let is_flat = |[a, b, c]: [DVec3; 3]| are_collinear(a, b, c);
    if is_flat(before) || is_flat(after) { -1.0 } else { unit_normal(before).dot(unit_normal(after)) }
}

fn unit_normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).normalize_or_zero().cross((c - a).normalize_or_zero()).normalize_or_zero()
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: ThinFaces = ThinFaces { needles: true, caps: true, folds: true };

    fn area(draft: &Draft) -> f64 {
        let area = |t: usize| {
            let [a, b, c] = draft.corners(t);
            (b - a).cross(c - a).length() / 2.0
        };
        (0..draft.triangles.len()).map(area).sum()
    }

    /// A box of two halves, between whose tops is a slit of the given width, closed by two needles.
    fn with_slit(width: f64) -> Draft {
        let (l, m, r) = (0.0, 1.0, 1.0 + width);
        let points = [
            [l, 0.0, 1.0],
            [m, 0.0, 1.0],
            [r, 0.0, 1.0],
            [2.0, 0.0, 1.0],
            [l, 1.0, 1.0],
            [m, 1.0, 1.0],
            [r, 1.0, 1.0],
            [2.0, 1.0, 1.0],
            [1.0, 0.5, -1.0],
        ];
        let strip = |i: u32| [[i, i + 1, i + 5], [i, i + 5, i + 4]];
        let rim = [0, 1, 2, 3, 7, 6, 5, 4];
        let sides = (0..8).map(|i| [rim[(i + 1) % 8], rim[i], 8]);
        Draft::of(&points, &(0..3).flat_map(strip).chain(sides).collect::<Vec<_>>())
    }

    #[test]
    fn needles_go_by_their_short_edge_and_the_shape_stays() {
        let mut mesh = with_slit(1e-4);
        let (before, triangles) = (area(&mesh), mesh.triangles.len());
        let changes = mend_thin_faces(&mut mesh, ALL, &Budget::unlimited()).unwrap();
        assert_eq!((changes.count("needles_collapsed"), changes.count("thin_faces_left")), (2, 0));
        assert_eq!(mesh.triangles.len(), triangles - 4);
        assert!((area(&mesh) - before).abs() < 1e-3 && mesh.check().is_empty());
        HalfEdgeMesh::from_triangles(&mesh.triangles, mesh.positions.len(), &Budget::unlimited()).unwrap();
    }

    #[test]
    fn what_is_not_thin_or_not_asked_for_stays() {
        for (width, which) in [(0.1, ALL), (1e-4, ThinFaces { needles: false, ..ALL })] {
            let mut mesh = with_slit(width);
            let before = mesh.clone();
            mend_thin_faces(&mut mesh, which, &Budget::unlimited()).unwrap();
            assert_eq!(mesh, before);
        }
    }

    #[test]
    fn a_fold_closes_where_its_outer_corners_are_close_and_stays_where_they_are_not() {
        // A wall of two faces stands on the top of a tetrahedron, along an edge that was opened there.
        let fin = |gap: f64| {
            let points = [
                [0.0, -1.0, 0.0],
                [0.0, 1.0, 0.0],
                [-gap / 2.0, 0.0, 1.0],
                [gap / 2.0, 0.0, 1.0],
                [-2.0, 0.0, -1.0],
                [2.0, 0.0, -1.0],
            ];
            // The ridge 2-3 would be open but for the flaps to both sides.
            let triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 4], [2, 0, 4], [3, 1, 5], [0, 3, 5]];
            Draft::of(&points, &triangles)
        };
        let mut narrow = fin(1e-4);
        let before = narrow.triangles.len();
        let folds = ThinFaces { needles: false, caps: false, folds: true };
        let changes = mend_thin_faces(&mut narrow, folds, &Budget::unlimited()).unwrap();
        assert_eq!((changes.count("folds_closed"), narrow.triangles.len()), (1, before - 2));
        let mut wide = fin(0.1);
        let same = wide.clone();
        mend_thin_faces(&mut wide, folds, &Budget::unlimited()).unwrap();
        assert_eq!(wide, same);
    }

    #[test]
    fn a_cap_goes_by_a_flip_of_its_long_edge_unless_that_would_fold_the_surface() {
        // A square with a vertex just above its diagonal.
        let square = |height: f64| {
            Draft::of(
                &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.499, 0.501, height]],
                &[[0, 1, 2], [0, 2, 4], [2, 3, 4], [3, 0, 4]],
            )
        };
        let mut mesh = square(0.0);
        let changes = mend_thin_faces(&mut mesh, ALL, &Budget::unlimited()).unwrap();
        assert_eq!((changes.count("caps_flipped"), changes.count("thin_faces_left")), (1, 0));
        assert!((area(&mesh) - 1.0).abs() < 1e-12 && mesh.triangles.len() == 4);
        // On the rim there is nothing to flip with.
        let mut rim = Draft::of(&[[0.0; 3], [1.0, 0.0, 0.0], [0.5, 1e-3, 0.0]], &[[0, 1, 2]]);
        assert_eq!(mend_thin_faces(&mut rim, ALL, &Budget::unlimited()).unwrap().count("thin_faces_left"), 1);
    }
}
