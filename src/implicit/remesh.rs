//! A better mesh of the zero set than marching cubes give: the same surface with triangles of even size and shape.
//!
//! Edges are split, collapsed and flipped, and vertices moved along the zero set, towards edges of the wanted length
//! (Botsch and Kobbelt 2004), then towards the largest smallest angle. Rims stay as they are, bit for bit.

use super::field::Field;
use super::march::march;
use super::patch::{Patch, Unmeshed};
use super::rim::RimLines;
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::mesh::half_edge::{FaceId, HalfEdgeId, HalfEdgeMesh, VertexId};
use crate::par;
use crate::spatial::NearestSearch;

/// Rounds of even size, and rounds of better angles after them.
const SIZE_ROUNDS: usize = 8;
const ANGLE_ROUNDS: usize = 12;
/// Edges longer than this over the wanted length are split, shorter ones collapsed (Botsch and Kobbelt 2004).
const LONG: f64 = 4.0 / 3.0;
const SHORT: f64 = 4.0 / 5.0;
/// A vertex moves at most this share of the wanted length at once.
const STEP_SHARE: f64 = 0.5;
/// The least cosine between the normals of a triangle before and after it changes.
const TURN_COSINE: f64 = 0.5;
/// Edges sorted between two checks of the budget.
const SORTED_AT_ONCE: usize = 1 << 14;
/// Vertices handled between two checks of the budget.
const VERTICES: usize = 32;

/// The zero set of `field` inside of `rims` (see [`march`]) as even triangles with edges of about `edge_length`, which
/// near the rims change to the lengths there. Angles are at least 30 degrees where the rims allow it.
///
/// # Errors
/// When the budget stops the run; inside, why there are no triangles.
pub fn mesh_surface(
    field: &Field,
    rims: &[Vec<DVec3>],
    edge_length: f64,
    budget: &Budget,
) -> Result<Result<Patch, Unmeshed>, Stopped> {
    let patch = match march(field, rims, edge_length, budget)? {
        Ok(patch) => patch,
        Err(refusal) => return Ok(Err(refusal)),
    };
    let lines = match RimLines::new(field, rims, budget)? {
        Ok(lines) => lines,
        Err(refusal) => return Ok(Err(refusal)),
    };
    let built = HalfEdgeMesh::from_triangles(&patch.triangles, patch.points.len(), budget);
    budget.check()?;
    let Ok(mesh) = built else { return Ok(Err(Unmeshed::Topology { rims: rims.len() })) };
    let search = lines.search(budget)?;
    let mut work = RemeshState {
        field,
        lines: &lines,
        search: &search,
        edge_length,
        rim_count: lines.points.len(),
        mesh,
        points: patch.points,
        wanted: Vec::new(),
    };
    work.measure(budget)?;
    for _ in 0..SIZE_ROUNDS {
        work.split_long(budget)?;
        work.collapse_short(budget)?;
        work.flip(budget)?;
        work.smooth(budget)?;
        work.measure(budget)?;
    }
    for _ in 0..ANGLE_ROUNDS {
        work.flip(budget)?;
        work.open_angles(budget)?;
    }
    Ok(Ok(work.patch()))
}

struct RemeshState<'w> {
    field: &'w Field,
    lines: &'w RimLines,
    search: &'w NearestSearch<'w>,
    edge_length: f64,
    rim_count: usize,
    mesh: HalfEdgeMesh,
    points: Vec<DVec3>,
    /// The edge length wanted at each vertex.
    wanted: Vec<f64>,
}

impl RemeshState<'_> {
    fn at(&self, v: VertexId) -> DVec3 {
        self.points[v.index()]
    }

    fn is_fixed(&self, v: VertexId) -> bool {
        v.index() < self.rim_count
    }

    fn length(&self, h: HalfEdgeId) -> f64 {
        self.at(self.mesh.origin(h)).distance(self.at(self.mesh.destination(h)))
    }

    /// The length of the edge of `h` over the wanted one.
    fn excess(&self, h: HalfEdgeId) -> f64 {
        let [a, b] = [self.mesh.origin(h), self.mesh.destination(h)].map(|v| self.wanted[v.index()]);
        self.length(h) / (0.5 * (a + b))
    }

    fn wanted_at(&self, p: DVec3, budget: &Budget) -> Result<f64, Stopped> {
        self.lines.wanted_length(self.search, p, self.edge_length, budget)
    }

    fn measure(&mut self, budget: &Budget) -> Result<(), Stopped> {
        let of = |range: std::ops::Range<usize>| -> Result<Vec<f64>, Stopped> {
            self.points[range].iter().map(|&p| self.wanted_at(p, budget)).collect()
        };
        self.wanted = par::try_map_ranges(self.points.len(), VERTICES, of)?.concat();
        budget.spend(self.points.len() as u64)
    }

    /// The inner edges, longest or shortest first by `excess` times `sign`.
    fn sorted_edges(
        &self,
        sign: f64,
        is_wanted: impl Fn(f64) -> bool,
        budget: &Budget,
    ) -> Result<Vec<HalfEdgeId>, Stopped> {
        let mut edges: Vec<(f64, HalfEdgeId)> = self
            .mesh
            .edges()
            .filter(|&h| !self.mesh.is_boundary_edge(h))
            .map(|h| (self.excess(h), h))
            .filter(|&(excess, _)| is_wanted(excess))
            .collect();
        let order = |a: &(f64, HalfEdgeId), b: &(f64, HalfEdgeId)| {
            (b.0 * sign).total_cmp(&(a.0 * sign)).then(a.1.cmp(&b.1))
        };
        // In parts first, so that the run can be stopped between them: a stable sort only merges what is sorted.
        for part in edges.chunks_mut(SORTED_AT_ONCE) {
            budget.check()?;
            part.sort_by(order);
        }
        edges.sort_by(order);
        Ok(edges.into_iter().map(|(_, h)| h).collect())
    }

    fn split_long(&mut self, budget: &Budget) -> Result<(), Stopped> {
        for h in self.sorted_edges(1.0, |excess| excess > LONG, budget)? {
            budget.spend(1)?;
            if self.excess(h) <= LONG {
                continue;
            }
            let middle = self.at(self.mesh.origin(h)) * 0.5 + self.at(self.mesh.destination(h)) * 0.5;
            let place = self.field.project(middle, self.length(h)).unwrap_or(middle);
            let wanted = self.wanted_at(place, budget)?;
            let g = self.mesh.split_edge(h);
            let back = self.mesh.twin(h);
            self.points.push(place);
            self.wanted.push(wanted);
            for side in [g, back] {
                // From the new vertex over the end of the edge to the apex. They cannot be joined yet.
                let apex = self.mesh.next(self.mesh.next(side));
                let _ = self.mesh.split_face(side, apex);
            }
        }
        Ok(())
    }

    fn collapse_short(&mut self, budget: &Budget) -> Result<(), Stopped> {
        for h in self.sorted_edges(-1.0, |excess| excess < SHORT, budget)? {
            budget.spend(1)?;
            if !self.mesh.contains(h) || self.mesh.is_boundary_edge(h) || self.excess(h) >= SHORT {
                continue;
            }
            for h in [h, self.mesh.twin(h)] {
                if self.can_collapse(h) && self.mesh.collapse(h).is_ok() {
                    break;
                }
            }
        }
        Ok(())
    }

    /// Whether the origin of `h` may go onto its destination: no long edge, no triangle turned over.
    fn can_collapse(&self, h: HalfEdgeId) -> bool {
        let (gone, kept) = (self.mesh.origin(h), self.mesh.destination(h));
        if self.is_fixed(gone) {
            return false;
        }
        let to = self.at(kept);
        let is_short = self.mesh.neighbours(gone).all(|v| {
            let wanted = 0.5 * (self.wanted[v.index()] + self.wanted[kept.index()]);
            self.at(v).distance(to) <= LONG * wanted
        });
        is_short && self.can_move(gone, to, &[self.mesh.face(h), self.mesh.face(self.mesh.twin(h))])
    }

    /// Whether no triangle at `v`, except `leaving_out`, turns or collapses when `v` goes to `to`.
    fn can_move(&self, v: VertexId, to: DVec3, leaving_out: &[Option<FaceId>]) -> bool {
        self.mesh.star(v).filter(|&g| !leaving_out.contains(&self.mesh.face(g))).all(|g| {
            let [b, c] = self.opposite(g);
            let [before, after] = [self.at(v), to].map(|a| (b - a).cross(c - a));
            let shape = after.length() / ((b - to).length_squared() + (c - to).length_squared());
            before.dot(after) > TURN_COSINE * before.length() * after.length() && shape > 0.05
        })
    }

    /// The other two corners of the triangle of `g`.
    fn opposite(&self, g: HalfEdgeId) -> [DVec3; 2] {
        [self.at(self.mesh.destination(g)), self.at(self.mesh.origin(self.mesh.prev(g)))]
    }

    /// Flips edges whose flip makes the smallest angle of their triangles larger, in a few rounds.
    fn flip(&mut self, budget: &Budget) -> Result<(), Stopped> {
        for _ in 0..4 {
            let mut flipped = 0;
            let edges: Vec<HalfEdgeId> =
                self.mesh.edges().filter(|&h| !self.mesh.is_boundary_edge(h)).collect();
            for h in edges {
                budget.spend(1)?;
                if self.is_better_flipped(h) && self.mesh.flip(h).is_ok() {
                    flipped += 1;
                }
            }
            if flipped == 0 {
                break;
            }
        }
        Ok(())
    }

    fn is_better_flipped(&self, h: HalfEdgeId) -> bool {
        let t = self.mesh.twin(h);
        let [a, b] = [h, t].map(|h| self.at(self.mesh.origin(h)));
        let [x, y] = [h, t].map(|h| self.at(self.mesh.origin(self.mesh.prev(h))));
        let normal = (b - a).cross(x - a) + (a - b).cross(y - b);
        let (first, second) = ((y - x).cross(b - x), (x - y).cross(a - y));
        let is_facing = |n: DVec3| n.dot(normal) > TURN_COSINE * n.length() * normal.length();
        let before = sharpness([a, b, x]).min(sharpness([b, a, y]));
        let after = sharpness([x, y, b]).min(sharpness([y, x, a]));
        is_facing(first) && is_facing(second) && after > before + 1e-9
    }

    /// Moves each inner vertex towards the middle of its neighbours, along the zero set.
    fn smooth(&mut self, budget: &Budget) -> Result<(), Stopped> {
        let targets = self.targets(
            |work, v| {
                let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
                for g in work.mesh.star(v) {
                    let [b, c] = work.opposite(g);
                    let weight = (b - work.at(v)).cross(c - work.at(v)).length()
                        / (work.wanted[v.index()] * work.wanted[v.index()]);
                    sum += (work.at(v) + b + c) / 3.0 * weight;
                    weights += weight;
                }
                sum / weights
            },
            budget,
        )?;
        for (v, target) in targets {
            budget.spend(1)?;
            if self.can_move(v, target, &[]) {
                self.points[v.index()] = target;
            }
        }
        Ok(())
    }

    /// Moves each inner vertex to where the smallest angle around it is larger.
    fn open_angles(&mut self, budget: &Budget) -> Result<(), Stopped> {
        let targets = self.targets(Self::opened, budget)?;
        for (v, target) in targets {
            budget.spend(1)?;
            let before = self.least_angle_at(v, self.at(v));
            for share in [1.0, 0.5, 0.25] {
                let place = self.at(v) + (target - self.at(v)) * share;
                let place = if share == 1.0 {
                    place
                } else {
                    self.field.project(place, self.wanted[v.index()]).unwrap_or(place)
                };
                if self.least_angle_at(v, place) > before && self.can_move(v, place, &[]) {
                    self.points[v.index()] = place;
                    break;
                }
            }
        }
        Ok(())
    }

    /// The mean of the apexes of equilateral triangles on the sides opposite of `v`, where small angles count more.
    fn opened(&self, v: VertexId) -> DVec3 {
        let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
        for g in self.mesh.star(v) {
            let [b, c] = self.opposite(g);
            let (middle, side) = ((b + c) * 0.5, c - b);
            let away = self.at(v) - middle;
            let up = (away - side * (away.dot(side) / side.length_squared())).normalize_or_zero();
            let least = least_angle([self.at(v), b, c]).max(0.02);
            let weight = 1.0 / (least * least);
            sum += (middle + up * (side.length() * 0.75f64.sqrt())) * weight;
            weights += weight;
        }
        sum / weights
    }

    fn least_angle_at(&self, v: VertexId, place: DVec3) -> f64 {
        self.mesh.star(v).fold(f64::INFINITY, |least, g| {
            let [b, c] = self.opposite(g);
            least.min(least_angle([place, b, c]))
        })
    }

    /// For each inner vertex where `goal` wants it, moved onto the zero set.
    fn targets(
        &self,
        goal: impl Fn(&Self, VertexId) -> DVec3 + Sync,
        budget: &Budget,
    ) -> Result<Vec<(VertexId, DVec3)>, Stopped> {
        let free: Vec<VertexId> = self.mesh.vertices().filter(|&v| !self.is_fixed(v)).collect();
        let of = |range: std::ops::Range<usize>| -> Result<Vec<(VertexId, DVec3)>, Stopped> {
            budget.check()?;
            let target = |&v: &VertexId| {
                let reach = STEP_SHARE * self.wanted[v.index()];
                let step = (goal(self, v) - self.at(v)).clamp_length_max(reach);
                let place = self.field.project(self.at(v) + step, reach)?;
                Some((v, place))
            };
            Ok(free[range].iter().filter_map(target).collect())
        };
        Ok(par::try_map_ranges(free.len(), VERTICES, of)?.concat())
    }

    /// The triangles with the vertices that are left, numbered anew; the rims come first as before.
    fn patch(self) -> Patch {
        let mut number = vec![u32::MAX; self.points.len()];
        let mut points = Vec::new();
        for v in self.mesh.vertices() {
            number[v.index()] = points.len() as u32;
            points.push(self.at(v));
        }
        let corners = |f: FaceId| {
            let mut corners = [0; 3];
            self.mesh.corners(f).zip(&mut corners).for_each(|(v, corner)| *corner = number[v.index()]);
            corners
        };
        let triangles = self.mesh.faces().map(corners).collect();
        Patch { points, triangles }
    }
}

/// The smallest angle of a triangle, in radians.
fn least_angle([a, b, c]: [DVec3; 3]) -> f64 {
    let angle = |u: DVec3, v: DVec3| libm::atan2(u.cross(v).length(), u.dot(v));
    angle(b - a, c - a).min(angle(c - b, a - b)).min(angle(a - c, b - c))
}

/// Minus the largest cosine of a triangle's angles, which grows with the smallest angle.
fn sharpness([a, b, c]: [DVec3; 3]) -> f64 {
    let cosine = |u: DVec3, v: DVec3| u.dot(v) / (u.length() * v.length());
    -cosine(b - a, c - a).max(cosine(c - b, a - b)).max(cosine(a - c, b - c))
}
