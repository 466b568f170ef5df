//! Which features of two triangles are near each other.

use super::{NearInput, NearKind, NearPair};
use crate::geom::{DVec3, Sign, closest_point_on_triangle, is_on_segment, orient3d};
use crate::spatial::bvh::{Frame, Leaf, Sliver};

/// The triangles that are searched.
pub(super) struct SearchedFaces<'m, F> {
    pub(super) input: NearInput<'m>,
    /// Whether a vertex and the ends of an edge are the corners of one triangle.
    pub(super) is_face: &'m F,
    /// The coordinates of the boxes.
    pub(super) frame: Frame,
}

impl<F: Fn(u32, [u32; 2]) -> bool> SearchedFaces<'_, F> {
    /// Triangle `i` of a leaf, which meets the boxes of all triangles that have features near its own.
    pub(super) fn sliver(&self, leaf: &Leaf, i: usize) -> Sliver {
        let corners = leaf.corners(i);
        let reach = self.frame.scaled(self.input.growth(corners));
        Sliver::new(&self.frame, corners.map(|v| &self.input.positions[v as usize])).with_reach(reach)
    }

    /// Tells the near pairs among the features that two triangles speak for.
    pub(super) fn compare(&self, faces: [u32; 2], add: &mut impl FnMut(NearPair)) {
        let [f, g] = faces;
        let [at_f, at_g] = faces.map(|t| self.input.triangles[t as usize]);
        self.corners_of(f, g, true, add);
        self.corners_of(g, f, false, add);
        for i in (0..3).filter(|i| self.owns(f, 3 + i)) {
            for j in (0..3).filter(|j| self.owns(g, 3 + j)) {
                self.edges(faces, [rotated(at_f, i), rotated(at_g, j)], add);
            }
        }
        if !at_f.iter().any(|v| at_g.contains(v)) {
            self.whole(faces, add);
        }
    }

    fn owns(&self, t: u32, bit: usize) -> bool {
        self.input.owned[t as usize] >> bit & 1 == 1
    }

    fn at(&self, v: u32) -> DVec3 {
        self.input.positions[v as usize]
    }

    fn reach(&self, vertices: &[u32]) -> f64 {
        vertices.iter().map(|&v| self.input.reach[v as usize]).fold(f64::INFINITY, f64::min)
    }

    /// The corners that triangle `f` speaks for against triangle `g`, its edges and, if `is_first`, its corners.
    fn corners_of(&self, f: u32, g: u32, is_first: bool, add: &mut impl FnMut(NearPair)) {
        let [at_f, at_g] = [f, g].map(|t| self.input.triangles[t as usize]);
        let corners = at_g.map(|v| self.at(v));
        for i in (0..3).filter(|i| self.owns(f, *i) && !at_g.contains(&at_f[*i])) {
            let first = rotated(at_f, i);
            let (v, p) = (first[0], self.at(first[0]));
            let reach = self.input.reach[v as usize];
            let low = corners[0].min(corners[1]).min(corners[2]) - reach;
            let high = corners[0].max(corners[1]).max(corners[2]) + reach;
            if !(p.cmpge(low).all() && p.cmple(high).all()) {
                continue;
            }
            let on_face = closest_point_on_triangle(p, corners);
            // Rounded, and what is rounded away is within reach of neither side of the comparison below.
            if on_face.distance(p) > reach * 1.001 {
                continue;
            }
            let pair = |kind, b, on: DVec3| NearPair {
                kind,
                a: first,
                b,
                faces: [f, g],
                distance: on.distance(p),
                place: p / 2.0 + on / 2.0,
            };
            for j in 0..3 {
                let other = rotated(at_g, j);
                if is_first && self.owns(g, j) && self.are_vertices_near(v, other[0]) {
                    add(pair(NearKind::VertexVertex, other, self.at(other[0])));
                }
                let ends = [other[0], other[1]];
                if self.owns(g, 3 + j)
                    && let Some(on) = self.near_inside_edge(v, ends)
                    && !ends.iter().any(|&end| self.are_vertices_near(v, end))
                    && !is_on_segment(p, self.at(ends[0]), self.at(ends[1]))
                    && !(self.is_face)(v, ends)
                {
                    add(pair(NearKind::VertexEdge, other, on));
                }
            }
            if is_above_inside(p, corners)
                && on_face.distance(p) <= self.reach(&[v, at_g[0], at_g[1], at_g[2]])
                && !(0..3).any(|j| self.is_vertex_within_edge(v, rotated(at_g, j)))
                && orient3d(corners[0], corners[1], corners[2], p) != Sign::Zero
            {
                add(pair(NearKind::VertexFace, at_g, on_face));
            }
        }
    }

    fn are_vertices_near(&self, v: u32, w: u32) -> bool {
        self.at(v).distance(self.at(w)) <= self.reach(&[v, w])
    }

    /// The point of an edge closest to vertex `v`, if it is inside the edge and near.
    fn near_inside_edge(&self, v: u32, [a, b]: [u32; 2]) -> Option<DVec3> {
        let (p, from) = (self.at(v), self.at(a));
        let along = self.at(b) - from;
        let share = (p - from).dot(along) / along.length_squared();
        let on = from + along * share;
        (share > 0.0 && share < 1.0 && on.distance(p) <= self.reach(&[v, a, b])).then_some(on)
    }

    /// Whether the edge between the first two of `other`, ends included, is within reach of vertex `v`.
    fn is_vertex_within_edge(&self, v: u32, [a, b, _]: [u32; 3]) -> bool {
        self.are_vertices_near(v, a)
            || self.are_vertices_near(v, b)
            || self.near_inside_edge(v, [a, b]).is_some()
    }

    /// Two edges, each the first two of its vertices.
    fn edges(&self, faces: [u32; 2], [e, h]: [[u32; 3]; 2], add: &mut impl FnMut(NearPair)) {
        let ([a, b, _], [c, d, _]) = (e, h);
        if a == c || a == d || b == c || b == d {
            return;
        }
        let reach = self.reach(&[a, b, c, d]);
        let [p, q, r, s] = [a, b, c, d].map(|v| self.at(v));
        if !((p.min(q) - reach).cmple(r.max(s)).all() && (r.min(s) - reach).cmple(p.max(q)).all()) {
            return;
        }
        let (u, w, between) = (q - p, s - r, p - r);
        let (uu, ww, uw) = (u.length_squared(), w.length_squared(), u.dot(w));
        let (ub, wb) = (u.dot(between), w.dot(between));
        let square = uu * ww - uw * uw;
        let (along, across) = ((uw * wb - ww * ub) / square, (uu * wb - uw * ub) / square);
        // Parallel edges have NaN or infinities here: their closest points are at an end of one of them.
        if !(along > 0.0 && along < 1.0 && across > 0.0 && across < 1.0) {
            return;
        }
        let (on_e, on_h) = (p + u * along, r + w * across);
        let distance = on_e.distance(on_h);
        let is_derived = || {
            self.is_vertex_within_edge(a, h)
                || self.is_vertex_within_edge(b, h)
                || self.is_vertex_within_edge(c, e)
                || self.is_vertex_within_edge(d, e)
        };
        if distance <= reach && !is_derived() && orient3d(p, q, r, s) != Sign::Zero {
            let place = on_e / 2.0 + on_h / 2.0;
            add(NearPair { kind: NearKind::EdgeEdge, a: e, b: h, faces, distance, place });
        }
    }

    /// Two triangles without a common vertex, each of whose vertices is near one of the other.
    fn whole(&self, faces: [u32; 2], add: &mut impl FnMut(NearPair)) {
        let [a, b] = faces.map(|t| self.input.triangles[t as usize]);
        for i in 0..3 {
            if !self.are_vertices_near(a[0], b[i]) {
                continue;
            }
            for second in [(i + 1) % 3, (i + 2) % 3] {
                let order = [b[i], b[second], b[3 - i - second]];
                if self.are_vertices_near(a[1], order[1]) && self.are_vertices_near(a[2], order[2]) {
                    let far = |k: usize| self.at(a[k]).distance(self.at(order[k]));
                    let distance = far(0).max(far(1)).max(far(2));
                    let place = (self.at(a[0]) + self.at(a[1]) + self.at(a[2])) / 3.0;
                    add(NearPair { kind: NearKind::FaceFace, a, b: order, faces, distance, place });
                    return;
                }
            }
        }
    }
}

/// Whether `p` is above or below the inside of a triangle.
fn is_above_inside(p: DVec3, [a, b, c]: [DVec3; 3]) -> bool {
    let normal = (b - a).cross(c - a);
    [(a, b), (b, c), (c, a)].into_iter().all(|(from, to)| normal.dot((to - from).cross(p - from)) > 0.0)
}

/// The corners from the `i`-th on.
fn rotated(corners: [u32; 3], i: usize) -> [u32; 3] {
    [i, i + 1, i + 2].map(|k| corners[k % 3])
}
