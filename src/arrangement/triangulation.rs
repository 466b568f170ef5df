//! A triangulation of a plane by half-edges: topology, and places of points in it.
//!
//! ```text
//!            c            the face of half-edge h = a -> b is on its left; next(h) = b -> c
//!           / \
//!          a---b          twin(h) = b -> a, or none at the rim
//! ```

use super::error::ArrangementError;
use super::kernel::{ClusterKernel, EXACT, PlaneView};
use super::point::ArrangementPoint;
use crate::geom::{DVec3, Sign};
use std::cell::Cell;

/// Units of work of a comparison of names.
const NAMES: u64 = 4;

/// With so many points, triangles are kept round while they are put in.
pub(super) const MANY: usize = 16;

/// In the place of a half-edge: there is none.
pub(super) const NONE: u32 = u32::MAX;

/// Points that a carrier sees: those of the cluster, and the ones that it makes itself.
#[derive(Debug)]
pub(super) struct CarrierView<'k> {
    pub(super) kernel: &'k ClusterKernel,
    pub(super) view: PlaneView,
    pub(super) shared: &'k [ArrangementPoint],
    /// These are numbered after the shared ones.
    pub(super) own: Vec<ArrangementPoint>,
    /// Work that has not been taken.
    units: Cell<u64>,
}

impl<'k> CarrierView<'k> {
    pub(super) fn new(kernel: &'k ClusterKernel, view: PlaneView, shared: &'k [ArrangementPoint]) -> Self {
        Self { kernel, view, shared, own: Vec::new(), units: Cell::new(0) }
    }

    pub(super) fn point(&self, id: u32) -> &ArrangementPoint {
        match self.shared.get(id as usize) {
            Some(point) => point,
            None => &self.own[id as usize - self.shared.len()],
        }
    }

    pub(super) fn push(&mut self, point: ArrangementPoint) -> u32 {
        self.own.push(point);
        (self.shared.len() + self.own.len() - 1) as u32
    }

    /// How three points turn.
    pub(super) fn orient(&self, a: &ArrangementPoint, b: &ArrangementPoint, c: &ArrangementPoint) -> Sign {
        let (units, sign) = match ClusterKernel::orient_near(self.view, a, b, c) {
            Some(sign) => (1, sign),
            None if self.kernel.are_collinear_by_name(self.view, [a, b, c]) => (NAMES, Sign::Zero),
            None => (EXACT, self.kernel.orient_exact(self.view, a, b, c)),
        };
        self.units.set(self.units.get() + units);
        sign
    }

    /// The units of work since this was last asked.
    pub(super) fn take_units(&self) -> u64 {
        self.units.take()
    }
}

/// Where a point is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Location {
    /// On this vertex.
    Vertex(u32),
    /// Inside this edge.
    Edge(u32),
    /// Inside the face of this half-edge.
    Face(u32),
}

/// Triangles over vertices, each of which stands for a point.
#[derive(Debug, Default)]
pub(super) struct Triangulation {
    /// The vertex at which each half-edge begins.
    origin: Vec<u32>,
    next: Vec<u32>,
    twin: Vec<u32>,
    /// The set of constraints that run along each half-edge, in its direction; 0: none.
    pub(super) tags: Vec<u32>,
    /// A half-edge that begins at each vertex.
    leaving: Vec<u32>,
    /// The point that each vertex is.
    pub(super) points: Vec<u32>,
    /// State of the choice of edges on walks, so that none goes round in circles.
    dice: u32,
}

impl Triangulation {
    /// One triangle of three points that turn counter-clockwise.
    pub(super) fn of_triangle(points: [u32; 3]) -> Self {
        Self {
            origin: vec![0, 1, 2],
            next: vec![1, 2, 0],
            twin: vec![NONE; 3],
            tags: vec![0; 3],
            leaving: vec![0, 1, 2],
            points: points.to_vec(),
            dice: 1,
        }
    }

    pub(super) fn half_edges(&self) -> u32 {
        self.origin.len() as u32
    }
    pub(super) fn from(&self, h: u32) -> u32 {
        self.origin[h as usize]
    }
    pub(super) fn to(&self, h: u32) -> u32 {
        self.origin[self.next[h as usize] as usize]
    }
    pub(super) fn next(&self, h: u32) -> u32 {
        self.next[h as usize]
    }
    pub(super) fn prev(&self, h: u32) -> u32 {
        self.next(self.next(h))
    }
    pub(super) fn twin(&self, h: u32) -> u32 {
        self.twin[h as usize]
    }
    /// The corner opposite `h` in its face.
    pub(super) fn apex(&self, h: u32) -> u32 {
        self.from(self.prev(h))
    }

    /// True when a constraint runs along the edge of `h`, in either direction.
    pub(super) fn is_constrained(&self, h: u32) -> bool {
        let twin = self.twin(h);
        self.tags[h as usize] != 0 || (twin != NONE && self.tags[twin as usize] != 0)
    }

    fn push(&mut self, origin: u32, tags: u32) -> u32 {
        self.origin.push(origin);
        self.next.push(NONE);
        self.twin.push(NONE);
        self.tags.push(tags);
        self.origin.len() as u32 - 1
    }

    fn link(&mut self, face: [u32; 3]) {
        for k in 0..3 {
            self.next[face[k] as usize] = face[(k + 1) % 3];
        }
    }

    fn pair(&mut self, g: u32, h: u32) {
        self.twin[g as usize] = h;
        if h != NONE {
            self.twin[h as usize] = g;
        }
    }

    /// The half-edges that begin at a vertex, counter-clockwise.
    pub(super) fn around(&self, vertex: u32) -> impl Iterator<Item = u32> + '_ {
        let start = self.leaving[vertex as usize];
        let mut first = start;
        // Clockwise to the rim, if there is one.
        loop {
            let twin = self.twin(first);
            if twin == NONE {
                break;
            }
            first = self.next(twin);
            if first == start {
                break;
            }
        }
        let mut at = Some(first);
        std::iter::from_fn(move || {
            let h = at?;
            let twin = self.twin(self.prev(h));
            at = (twin != NONE && twin != first).then_some(twin);
            Some(h)
        })
    }

    /// The half-edge between two vertices.
    pub(super) fn between(&self, from: u32, to: u32) -> Option<u32> {
        self.around(from).find(|&h| self.to(h) == to)
    }

    /// How the points of three vertices turn.
    pub(super) fn orient(&self, sight: &CarrierView<'_>, vertices: [u32; 3]) -> Sign {
        let [i, j, k] = vertices;
        if i == j || j == k || k == i {
            return Sign::Zero;
        }
        let [a, b, c] = vertices.map(|v| sight.point(self.points[v as usize]));
        sight.orient(a, b, c)
    }

    /// Where a point is, by a walk from half-edge `start`.
    pub(super) fn locate(
        &mut self,
        sight: &CarrierView<'_>,
        point: u32,
        start: u32,
    ) -> Result<Location, ArrangementError> {
        let p = sight.point(point);
        let turn = |t: &Self, h: u32| {
            let [a, b] = [t.from(h), t.to(h)].map(|v| sight.point(t.points[v as usize]));
            sight.orient(a, b, p)
        };
        let mut h = start;
        let mut came = NONE;
        for _ in 0..4 * u64::from(self.half_edges()) + 64 {
            self.dice = self.dice.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            for _ in 0..self.dice >> 30 {
                h = self.next(h);
            }
            let mut on = [NONE; 3];
            let mut zeros = 0;
            let mut leaves = NONE;
            for _ in 0..3 {
                if h != came {
                    match turn(self, h) {
                        Sign::Negative => {
                            leaves = h;
                            break;
                        }
                        Sign::Zero => {
                            on[zeros] = h;
                            zeros += 1;
                        }
                        Sign::Positive => {}
                    }
                }
                h = self.next(h);
            }
            if leaves != NONE {
                came = self.twin(leaves);
                if came == NONE {
                    return Err(ArrangementError::Inconsistent(
                        "a point is outside of its plane's triangles",
                    ));
                }
                h = came;
                continue;
            }
            return Ok(match zeros {
                0 => Location::Face(h),
                1 => Location::Edge(on[0]),
                _ if self.next(on[0]) == on[1] => Location::Vertex(self.from(on[1])),
                _ => Location::Vertex(self.from(on[0])),
            });
        }
        Err(ArrangementError::Inconsistent("a walk in a plane does not end"))
    }

    /// Puts a point where it is and gives its vertex: an existing one if the point is on one.
    pub(super) fn insert(
        &mut self,
        sight: &CarrierView<'_>,
        point: u32,
        start: u32,
    ) -> Result<u32, ArrangementError> {
        Ok(match self.locate(sight, point, start)? {
            Location::Vertex(v) => v,
            Location::Edge(h) => self.split_edge(h, point),
            Location::Face(h) => self.split_face(h, point),
        })
    }

    /// ```text
    ///        c                c
    ///       / \              /|\
    ///      /   \     ->     / p \
    ///     /  h  \          / / \ \
    ///    a-------b        a-------b
    /// ```
    fn split_face(&mut self, h: u32, point: u32) -> u32 {
        let face = [h, self.next(h), self.prev(h)];
        let corners = face.map(|h| self.from(h));
        let p = self.points.len() as u32;
        self.points.push(point);
        let inward = corners.map(|v| self.push(v, 0));
        let outward = corners.map(|_| self.push(p, 0));
        for k in 0..3 {
            self.link([face[k], inward[(k + 1) % 3], outward[k]]);
            self.pair(inward[k], outward[k]);
        }
        self.leaving.push(outward[0]);
        p
    }

    /// ```text
    ///        c                c
    ///       / \              /|\
    ///      /   \     ->     / | \
    ///     /  h  \          /  |  \
    ///    a-------b        a---p---b     and the same on the other side
    /// ```
    pub(super) fn split_edge(&mut self, h: u32, point: u32) -> u32 {
        let p = self.points.len() as u32;
        self.points.push(point);
        let g = self.twin(h);
        let after = self.split_half(h, p);
        self.leaving.push(after);
        if g != NONE {
            let after_g = self.split_half(g, p);
            self.pair(h, after_g);
            self.pair(g, after);
        }
        p
    }

    /// Splits the face of `h`, which then ends at `p`; gives the half-edge from `p` to where it ended.
    fn split_half(&mut self, h: u32, p: u32) -> u32 {
        let (n1, n2) = (self.next(h), self.prev(h));
        let c = self.from(n2);
        let after = self.push(p, self.tags[h as usize]);
        let (up, down) = (self.push(p, 0), self.push(c, 0));
        self.pair(up, down);
        self.link([h, up, n2]);
        self.link([after, n1, down]);
        after
    }

    /// ```text
    ///        c                c
    ///       / \              /|\
    ///      a---b     ->     a | b
    ///       \ /              \|/
    ///        d                d
    /// ```
    pub(super) fn flip(&mut self, h: u32) {
        let g = self.twin(h);
        let (n1, n2, m1, m2) = (self.next(h), self.prev(h), self.next(g), self.prev(g));
        let (a, b, c, d) = (self.from(h), self.from(g), self.from(n2), self.from(m2));
        self.leaving[a as usize] = m1;
        self.leaving[b as usize] = n1;
        self.origin[h as usize] = d;
        self.origin[g as usize] = c;
        self.link([h, n2, m1]);
        self.link([g, m2, n1]);
    }

    /// True when flipping the edge of `h`, which is not at the rim, makes triangles rounder as f64 sees it: the angles opposite to it
    /// are more than half a turn together. What is flipped is exactly convex, whatever the rounding.
    pub(super) fn is_rounder_flipped(&self, sight: &CarrierView<'_>, h: u32) -> bool {
        let [a, b, c, d] = [self.from(h), self.to(h), self.apex(h), self.apex(self.twin(h))];
        let place = |v: u32| DVec3::from_array(sight.point(self.points[v as usize]).near.map(|x| x.mid));
        let cotangent_at = |v: u32| {
            let (to_a, to_b) = (place(a) - place(v), place(b) - place(v));
            to_a.dot(to_b) / to_a.cross(to_b).length()
        };
        let side = |v: u32| self.orient(sight, [d, c, v]);
        cotangent_at(c) + cotangent_at(d) < -1e-9 && side(a) * side(b) == Sign::Negative
    }

    /// Flips edges around a vertex while that makes triangles rounder (Lawson 1977), so that few edges end in one vertex where
    /// many points are put in.
    pub(super) fn flip_around(&mut self, sight: &CarrierView<'_>, vertex: u32) {
        let mut opposite: Vec<u32> = self.around(vertex).map(|h| self.next(h)).collect();
        // Each flip joins the vertex to another one, so there are no more of them than vertices, whatever the rounding.
        while let Some(h) = opposite.pop() {
            let g = self.twin(h);
            if g != NONE && !self.is_constrained(h) && self.is_rounder_flipped(sight, h) {
                opposite.extend([self.next(g), self.prev(g)]);
                self.flip(h);
            }
        }
    }

    /// The corners of every triangle, as points.
    pub(super) fn faces(&self) -> Vec<[u32; 3]> {
        let mut is_told = vec![false; self.origin.len()];
        let mut faces = Vec::with_capacity(self.origin.len() / 3);
        for h in 0..self.half_edges() {
            if is_told[h as usize] {
                continue;
            }
            let face = [h, self.next(h), self.prev(h)];
            for h in face {
                is_told[h as usize] = true;
            }
            faces.push(face.map(|h| self.points[self.from(h) as usize]));
        }
        faces
    }
}

impl Triangulation {
    /// The corners, as vertices, of the faces that are reached from the left of tagged half-edges without crossing one that
    /// is constrained.
    pub(super) fn left_of_tags(&self) -> Vec<[u32; 3]> {
        let mut is_reached = vec![false; self.origin.len()];
        let mut stack: Vec<u32> = (0..self.half_edges()).filter(|&h| self.tags[h as usize] != 0).collect();
        let mut faces = Vec::new();
        while let Some(h) = stack.pop() {
            if is_reached[h as usize] {
                continue;
            }
            let face = [h, self.next(h), self.prev(h)];
            for h in face {
                is_reached[h as usize] = true;
                let twin = self.twin(h);
                if twin != NONE && !self.is_constrained(h) {
                    stack.push(twin);
                }
            }
            faces.push(face.map(|h| self.from(h)));
        }
        faces
    }
}
