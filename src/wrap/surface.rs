//! The input as the wrap sees it: triangles in lattice units, by what they say about inside and outside.

use crate::budget::{Budget, Charge, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::spatial::Bvh;
use crate::winding::Shells;

/// What a triangle says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Says {
    /// Inside is behind it.
    Boundary,
    /// It bounds no volume.
    Sheet,
}

/// All triangles: closed shells, then open ones that bound a volume, then sheets.
#[derive(Debug)]
pub(super) struct InputSurface {
    /// Corners in lattice units.
    pub(super) corners: Vec<[DVec3; 3]>,
    closed: usize,
    boundary: usize,
    /// The part of each: those connected by edges.
    parts: Vec<u32>,
    /// What closes the open ones.
    pub(super) cones: Vec<[DVec3; 3]>,
    bvh: Bvh,
}

/// How many triangles searches may still look at.
#[derive(Debug)]
pub(super) struct SearchAllowance(pub(super) u64);

impl SearchAllowance {
    /// Takes one; false when there is none left.
    fn take(&mut self) -> bool {
        let is_left = self.0 > 0;
        self.0 = self.0.saturating_sub(1);
        is_left
    }
}

/// Where a segment meets a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SegmentHit {
    /// Share of the segment before it.
    pub(super) share: f64,
    /// Triangle.
    pub(super) triangle: u32,
    /// The segment comes from behind the triangle.
    pub(super) is_exit: bool,
}

impl InputSurface {
    pub(super) fn new(shells: Shells, budget: &Budget) -> Result<Self, Stopped> {
        let (closed, boundary) = (shells.closed.len(), shells.closed.len() + shells.open.len());
        let mut corners = shells.closed;
        corners.extend(shells.open);
        corners.extend(shells.sheets);
        let parts = [shells.closed_part, shells.open_part, shells.sheet_part].concat();
        let bvh = Bvh::build(corners.as_flattened(), &separate(corners.len()), None, budget)?;
        Ok(Self { corners, closed, boundary, parts, cones: shells.cones, bvh })
    }

    /// Those that bound a volume.
    pub(super) fn boundary(&self) -> &[[DVec3; 3]] {
        &self.corners[..self.boundary]
    }

    pub(super) fn closed(&self) -> &[[DVec3; 3]] {
        &self.corners[..self.closed]
    }

    pub(super) fn open(&self) -> &[[DVec3; 3]] {
        &self.corners[self.closed..self.boundary]
    }

    pub(super) fn sheets(&self) -> &[[DVec3; 3]] {
        &self.corners[self.boundary..]
    }

    pub(super) fn says(&self, triangle: u32) -> Says {
        if (triangle as usize) < self.boundary { Says::Boundary } else { Says::Sheet }
    }

    /// The box of each part, by its number.
    pub(super) fn boxes_of_parts<'b>(&self, budget: &'b Budget) -> Result<(Vec<Aabb>, Charge<'b>), Stopped> {
        let count = self.parts.iter().max().map_or(0, |&part| part as usize + 1);
        let (mut boxes, charge) = budget.vec(count)?;
        boxes.resize(count, Aabb::EMPTY);
        for (&part, &corners) in self.parts.iter().zip(&self.corners) {
            boxes[part as usize] = boxes[part as usize].union(Aabb::of(corners));
        }
        Ok((boxes, charge))
    }

    /// Whether a part whose triangles' boxes meet `bounds` `is_wanted`, or may be as there are no looks left.
    pub(super) fn may_have_part(
        &self,
        bounds: Aabb,
        looks: &mut SearchAllowance,
        budget: &Budget,
        is_wanted: impl Fn(u32) -> bool,
    ) -> Result<bool, Stopped> {
        let may_be = |triangle: u32| !looks.take() || is_wanted(self.parts[triangle as usize]);
        self.bvh.any_in_box(bounds, budget, may_be)
    }

    /// Unit normal, zero for a triangle without area.
    pub(super) fn normal(&self, triangle: u32) -> DVec3 {
        let [a, b, c] = self.corners[triangle as usize];
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// Whether a triangle crosses the segment, or may do so as there are no looks left.
    pub(super) fn may_cross(
        &self,
        [from, to]: [DVec3; 2],
        looks: &mut SearchAllowance,
        budget: &Budget,
    ) -> Result<bool, Stopped> {
        let may_meet =
            |triangle: u32| !looks.take() || crossing(from, to, self.corners[triangle as usize]).is_some();
        self.bvh.any_in_box(Aabb::of([from, to]), budget, may_meet)
    }

    /// How thick the solid is behind a point of its surface, if less than `most`: how far it is `inward`, a unit vector, to where
    /// the solid ends.
    pub(super) fn thickness(
        &self,
        point: DVec3,
        inward: DVec3,
        most: f64,
        budget: &Budget,
    ) -> Result<Option<f64>, Stopped> {
        self.next_boundary(point, inward, most, true, budget)
    }

    /// How wide the gap before a point of the surface of the solid is, if less than `most`: how far it is `outward`, a unit vector,
    /// to where the solid begins again.
    pub(super) fn gap(
        &self,
        point: DVec3,
        outward: DVec3,
        most: f64,
        budget: &Budget,
    ) -> Result<Option<f64>, Stopped> {
        self.next_boundary(point, outward, most, false, budget)
    }

    /// How far it is from a point of the surface to the boundary that is an exit, or else an entry, and not of a body that is
    /// entered, or else left, on the way.
    fn next_boundary(
        &self,
        point: DVec3,
        along: DVec3,
        most: f64,
        is_exit: bool,
        budget: &Budget,
    ) -> Result<Option<f64>, Stopped> {
        let mut found = Vec::new();
        self.crossings(point, point + along * most, budget, &mut found)?;
        // The triangles that the point is on are passed the other way.
        let is_own = |hit: &SegmentHit| hit.share <= AT_ONE_PLACE && hit.is_exit != is_exit;
        found.retain(|hit| self.says(hit.triangle) == Says::Boundary && !is_own(hit));
        found.sort_by(|a, b| a.share.total_cmp(&b.share));
        let mut passed = 0;
        for hits in found.chunk_by(|a, b| b.share - a.share < AT_ONE_PLACE) {
            passed += hits.iter().map(|hit| if hit.is_exit == is_exit { 1 } else { -1 }).sum::<i32>();
            if passed > 0 {
                return Ok(Some(hits[0].share * most));
            }
        }
        Ok(None)
    }

    /// Every crossing of the segment, in no particular order.
    pub(super) fn crossings(
        &self,
        from: DVec3,
        to: DVec3,
        budget: &Budget,
        found: &mut Vec<SegmentHit>,
    ) -> Result<(), Stopped> {
        found.clear();
        self.bvh.visit_segment([from, to], budget, |triangle| {
            if let Some((share, is_exit)) = crossing(from, to, self.corners[triangle as usize]) {
                found.push(SegmentHit { share, triangle, is_exit });
            }
            true
        })
    }
}

/// Index triples of triangles that share no vertex.
pub(super) fn separate(count: usize) -> Vec<[u32; 3]> {
    (0..count as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect()
}

/// Crossings whose shares of a segment differ by less are at one place.
const AT_ONE_PLACE: f64 = 1e-6;

/// What rounding may hide at the edges of a triangle, in lattice units.
const SLACK: f64 = 1e-9;

/// Where a segment meets a triangle, rounded, and whether it comes from behind.
fn crossing(from: DVec3, to: DVec3, [a, b, c]: [DVec3; 3]) -> Option<(f64, bool)> {
    let (ab, ac, along) = (b - a, c - a, to - from);
    let normal = ab.cross(ac);
    let slope = normal.dot(along);
    if slope == 0.0 {
        return None;
    }
    let offset = from - a;
    let share = -normal.dot(offset) / slope;
    if !(-SLACK..=1.0 + SLACK).contains(&share) {
        return None;
    }
    let turn = along.cross(offset);
    let (v, w) = (ac.dot(turn) / slope, -ab.dot(turn) / slope);
    let is_in = v >= -SLACK && w >= -SLACK && v + w <= 1.0 + SLACK;
    is_in.then_some((share.clamp(0.0, 1.0), slope > 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_segment_meets_a_triangle_where_it_should() {
        let triangle = [[1.0, 1.0, 2.0], [5.0, 1.0, 2.0], [1.0, 5.0, 2.0]].map(DVec3::from_array);
        let meets = |x: f64, y: f64| {
            crossing(DVec3::new(x, y, 1.0), DVec3::new(x, y, 5.0), triangle).map(|(share, _)| share)
        };
        assert_eq!(meets(2.0, 2.0), Some(0.25));
        assert_eq!(meets(4.5, 1.2), Some(0.25));
        assert_eq!(meets(1.2, 4.5), Some(0.25));
        assert_eq!(meets(4.0, 4.0), None);
        assert_eq!(meets(0.9, 2.0), None);
        let [a, b, c] = triangle;
        let (low, high) = (DVec3::new(2.0, 2.0, 1.0), DVec3::new(2.0, 2.0, 3.0));
        assert_eq!(crossing(low, high, [a, b, c]), Some((0.5, true)));
        assert_eq!(crossing(low, high, [a, c, b]), Some((0.5, false)));
    }
}
