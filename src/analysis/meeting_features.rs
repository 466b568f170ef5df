//! The vertices, edges and faces in whose inside triangles meet exactly, so that what meets has one pair of features however
//! many triangles show it: a vertex on an edge is one pair, though each may have six triangles around it.
//!
//! Every place where two triangles meet beyond what they share is inside one feature of each. Where an edge runs along a
//! face or two faces pass through each other, that ends in places of lower dimension, which are the ones told. Sides between
//! triangles of one polygon are inside its face and no edges.

use super::{Context, ProximityTest};
use crate::geom::{AxisProjection, DVec3, Sign, is_on_segment, orient3d};
use crate::spatial::TriangleContact;

/// Two features, each by its vertices in ascending order (one vertex, or the ends of an edge, with [`NONE`] behind them) or
/// by the number of a face in the file, [`NONE`] before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct FeatureMeeting {
    /// What they are.
    pub(super) test: ProximityTest,
    /// The feature of the lower dimension.
    a: [u32; 2],
    /// The other one.
    b: [u32; 2],
}

/// In the place of a vertex of an edge.
const NONE: u32 = u32::MAX;

impl FeatureMeeting {
    /// The vertices of both features that are no faces.
    pub(super) fn vertices(&self) -> impl Iterator<Item = u32> {
        let of = |[first, second]: [u32; 2]| match first {
            NONE => [NONE; 2],
            _ => [first, second],
        };
        [of(self.a), of(self.b)].into_iter().flatten().filter(|&v| v != NONE)
    }
}

/// What is compared with another triangle.
#[derive(Clone, Copy)]
struct ComparedTriangle {
    vertices: [u32; 3],
    at: [DVec3; 3],
    face: u32,
    /// For each side from a corner to the next one, whether it is an edge of the face.
    is_edge: [bool; 3],
}

impl ComparedTriangle {
    fn of(cx: &Context<'_>, sides: &PolygonSides, t: u32) -> Self {
        let written = cx.mesh.soup.triangles[t as usize];
        let vertices = written.map(|v| cx.mesh.first_at(v));
        let face = cx.mesh.soup.face_of(t);
        let is_edge = [0, 1, 2].map(|k| sides.has(cx, face, [written[k], written[(k + 1) % 3]]));
        Self { vertices, at: vertices.map(|v| cx.mesh.position(v)), face, is_edge }
    }

    /// The sides, each with its ends and the feature inside which it is.
    fn sides(&self) -> impl Iterator<Item = ([u32; 2], [DVec3; 2], bool)> {
        [0, 1, 2].into_iter().map(|k| {
            let next = (k + 1) % 3;
            ([self.vertices[k], self.vertices[next]], [self.at[k], self.at[next]], self.is_edge[k])
        })
    }

    fn face(&self) -> [u32; 2] {
        [NONE, self.face]
    }
}

/// The sides of the polygons that meet something.
pub(super) struct PolygonSides {
    /// Faces of the file with the ends of a side, ascending.
    sides: Vec<(u32, [u32; 2])>,
}

impl PolygonSides {
    /// Those of the faces of `contacts`.
    pub(super) fn of<'c>(cx: &Context<'_>, contacts: impl Iterator<Item = &'c TriangleContact>) -> Self {
        let (soup, polygons) = (cx.mesh.soup, &cx.mesh.soup.polygons);
        if polygons.faces.is_empty() {
            return Self { sides: Vec::new() };
        }
        let mut faces: Vec<u32> = contacts.flat_map(|c| [c.a, c.b]).map(|t| soup.face_of(t)).collect();
        faces.sort_unstable();
        faces.dedup();
        let of_face = |face: u32| {
            let i = polygons.faces.binary_search(&face).ok()?;
            let corners = polygons.corners_of(i);
            let ends = |k: usize| ascending([corners[k], corners[(k + 1) % corners.len()]]);
            Some((0..corners.len()).map(move |k| (face, ends(k))))
        };
        let mut sides: Vec<(u32, [u32; 2])> = faces.into_iter().filter_map(of_face).flatten().collect();
        sides.sort_unstable();
        Self { sides }
    }

    /// Whether the side of a triangle of the face is one of the face.
    fn has(&self, cx: &Context<'_>, face: u32, ends: [u32; 2]) -> bool {
        let is_polygon = !self.sides.is_empty() && cx.mesh.soup.polygons.faces.binary_search(&face).is_ok();
        !is_polygon || self.sides.binary_search(&(face, ascending(ends))).is_ok()
    }
}

/// The pairs of features, ascending, in which two triangles of the soup meet; nothing within one face.
pub(super) fn meetings(
    cx: &Context<'_>,
    sides: &PolygonSides,
    contact: &TriangleContact,
) -> Vec<FeatureMeeting> {
    let [f, g] = [contact.a, contact.b].map(|t| ComparedTriangle::of(cx, sides, t));
    if f.face == g.face {
        return Vec::new();
    }
    let (mut found, mut is_derived) = (Vec::new(), false);
    for (f, g) in [(f, g), (g, f)] {
        for (&v, &p) in f.vertices.iter().zip(&f.at).filter(|(v, _)| !g.vertices.contains(v)) {
            found.extend(vertex_on(v, p, &g));
        }
        for (ends, _, is_edge) in f.sides().filter(|side| passes_through(side.1, g.at)) {
            is_derived = true;
            if is_edge {
                found.push(FeatureMeeting { test: ProximityTest::EdgeFace, a: ascending(ends), b: g.face() });
            }
        }
    }
    for (e, at_e, is_edge_e) in f.sides() {
        for (h, at_h, is_edge_h) in g.sides().filter(|side| !side.0.iter().any(|v| e.contains(v))) {
            if are_crossing([at_e, at_h]) {
                is_derived = true;
                let (e, h) = (ascending(e), ascending(h));
                found.extend(match (is_edge_e, is_edge_h) {
                    (true, true) => {
                        Some(FeatureMeeting { test: ProximityTest::EdgeEdge, a: e.min(h), b: e.max(h) })
                    }
                    (true, false) => through_face(e, at_e, &g),
                    (false, true) => through_face(h, at_h, &f),
                    (false, false) => None,
                });
            }
        }
    }
    // What only meets sides inside a polygon goes on in its next triangle.
    if found.is_empty() && !is_derived {
        let [a, b] = [f.face, g.face];
        found.push(FeatureMeeting {
            test: ProximityTest::FaceFace,
            a: [NONE, a.min(b)],
            b: [NONE, a.max(b)],
        });
    }
    found.sort_unstable();
    found.dedup();
    found
}

fn ascending([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The meeting of vertex `v` at `p` with the triangle, of which it is no corner.
fn vertex_on(v: u32, p: DVec3, g: &ComparedTriangle) -> Option<FeatureMeeting> {
    let a = [v, NONE];
    let in_face = FeatureMeeting { test: ProximityTest::VertexFace, a, b: g.face() };
    if let Some((ends, _, is_edge)) = g.sides().find(|(_, [from, to], _)| is_on_segment(p, *from, *to)) {
        return Some(match is_edge {
            true => FeatureMeeting { test: ProximityTest::VertexEdge, a, b: ascending(ends) },
            false => in_face,
        });
    }
    is_inside(p, g.at).then_some(in_face)
}

/// The meeting of an edge with the face of a triangle, a side of which inside that face it crosses; none where it runs along
/// the face.
fn through_face(ends: [u32; 2], at: [DVec3; 2], of: &ComparedTriangle) -> Option<FeatureMeeting> {
    let [a, b, c] = of.at;
    let is_along = at.into_iter().all(|p| orient3d(a, b, c, p).is_zero());
    (!is_along).then(|| FeatureMeeting { test: ProximityTest::EdgeFace, a: ends, b: of.face() })
}

/// True when `p` is exactly in the triangle and on none of its edges.
fn is_inside(p: DVec3, [a, b, c]: [DVec3; 3]) -> bool {
    let turns = |(view, turn): (AxisProjection, Sign)| {
        [(a, b), (b, c), (c, a)].into_iter().all(|(from, to)| view.turn(from, to, p) == turn)
    };
    orient3d(a, b, c, p).is_zero() && AxisProjection::showing([a, b, c]).is_some_and(turns)
}

/// True when two segments meet exactly in a point inside both.
fn are_crossing([[a, b], [c, d]]: [[DVec3; 2]; 2]) -> bool {
    let Some((view, _)) = AxisProjection::showing([a, b, c]).filter(|_| orient3d(a, b, c, d).is_zero())
    else {
        return false;
    };
    are_apart(view.turn(a, b, c), view.turn(a, b, d)) && are_apart(view.turn(c, d, a), view.turn(c, d, b))
}

/// True when the segment's ends are on different sides of the triangle's plane and it passes through its inside.
fn passes_through([p, q]: [DVec3; 2], [a, b, c]: [DVec3; 3]) -> bool {
    let turns = [(a, b), (b, c), (c, a)].map(|(from, to)| orient3d(p, q, from, to));
    !turns[0].is_zero()
        && turns[0] == turns[1]
        && turns[1] == turns[2]
        && are_apart(orient3d(a, b, c, p), orient3d(a, b, c, q))
}

fn are_apart(s: Sign, t: Sign) -> bool {
    !s.is_zero() && !t.is_zero() && s != t
}
