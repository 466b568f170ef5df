//! The solid that any triangles stand for, and which of them are hidden in it.

use super::{OpenShells, Shells, WindingTree, sort, turned};
use crate::budget::{Budget, Stopped};
use crate::geom::{Aabb, DVec3, Sign, triangle_area, upward_crossing};
use crate::spatial::Bvh;

/// Sides of a triangle are looked at this far from it, as a share of the longest side of the box around all.
const BESIDE: f64 = 1e-6;

/// Places on a triangle are moved this much of the way to its middle first, so that neighbours do not decide.
const INWARD: f64 = 1e-3;

/// Gaps are narrower than this share of the longest side.
const GAP: f64 = 0.01;

/// Directions in which a way out of a gap is looked for.
const DIRECTIONS: u32 = 24;

/// Turn from each direction to the next, which spreads them evenly.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// Farther than the diagonal of the box around all, whose longest side is 1.
const OUT: f64 = 2.0;

/// The solid that triangles stand for: what their closed shells and those that nearly bound a volume wind around.
#[derive(Debug)]
pub struct Solid {
    /// All that bounds a volume, closed by cones.
    corners: Vec<[DVec3; 3]>,
    /// The part of each triangle of a closed shell; these come first.
    part: Vec<u32>,
    /// Number of cones, which come last.
    cone_count: usize,
    bvh: Bvh,
    /// The cones, turned around.
    cones: WindingTree,
    center: DVec3,
    scale: f64,
    /// Area of the open parts that bound a volume, and of those that are sheets.
    open_areas: [f64; 2],
}

impl Solid {
    /// Reads `triangles`, whose corners are finite; positions that are equal must be one.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn of(
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        open_shells: OpenShells,
        budget: &Budget,
    ) -> Result<Self, Stopped> {
        let bounds = Aabb::of(triangles.as_flattened().iter().map(|&v| positions[v as usize]));
        let (center, size) = ((bounds.min + bounds.max) / 2.0, (bounds.max - bounds.min).max_element());
        let scale = if size > 0.0 && size.is_finite() { 1.0 / size } else { 1.0 };
        let _charge = budget.charge((positions.len() * 24 + triangles.len() * 160) as u64)?;
        let unit: Vec<DVec3> = positions.iter().map(|&p| (p - center) * scale).collect();
        let Shells { closed: mut corners, closed_part: part, open, cones, sheets, .. } =
            sort(&unit, triangles, open_shells, BESIDE, budget)?;
        let open_areas = [&open, &sheets].map(|part| part.iter().map(|&t| triangle_area(t)).sum());
        corners.extend(open);
        corners.extend(&cones);
        let names: Vec<[u32; 3]> = (0..corners.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        let bvh = Bvh::build(corners.as_flattened(), &names, None, budget)?;
        let cone_count = cones.len();
        let cones = WindingTree::build(turned(&cones), budget)?;
        Ok(Self { corners, part, cone_count, bvh, cones, center, scale, open_areas })
    }

    /// Whether most of the open surface is read as sheets, which bound no volume.
    pub fn is_mostly_sheets(&self) -> bool {
        let [of_volumes, of_sheets] = self.open_areas;
        of_sheets > of_volumes
    }

    /// Whether nobody sees a triangle at a `place` on it: both sides are inside, or a side that is not is a gap between
    /// bodies that is narrower than 1 % of the longest side of all and that no way leads out of in a straight line. A cavity
    /// that a shell of its own bounds is no gap. The triangle need not be one of those that were read.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn hides(&self, place: DVec3, corners: [DVec3; 3], budget: &Budget) -> Result<bool, Stopped> {
        if self.corners.is_empty() {
            return Ok(false);
        }
        let [a, b, c, place] =
            [corners[0], corners[1], corners[2], place].map(|p| (p - self.center) * self.scale);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let place = place.lerp((a + b + c) / 3.0, INWARD);
        if normal == DVec3::ZERO {
            return Ok(false);
        }
        for side in [normal, -normal] {
            let beside = place + side * BESIDE;
            let is_hidden = match self.surroundings(beside, budget)? {
                Surroundings::Inside => true,
                Surroundings::Cavity => false,
                Surroundings::Outside => self.is_in_gap(beside, side, budget)?,
            };
            if !is_hidden {
                return Ok(false);
            }
        }
        Ok(true)
    }

    fn surroundings(&self, place: DVec3, budget: &Budget) -> Result<Surroundings, Stopped> {
        let (mut count, mut of_parts) = (0, Vec::new());
        self.bvh.visit_upward_ray(place, budget, |t| {
            if let Some(turn) = upward_crossing(place, self.corners[t as usize]) {
                let turn = if turn == Sign::Positive { 1 } else { -1 };
                count += turn;
                of_parts.extend(self.part.get(t as usize).map(|&part| (part, turn)));
            }
        })?;
        if self.cones.is_inside(place, f64::from(count), budget)? {
            return Ok(Surroundings::Inside);
        }
        of_parts.sort_unstable();
        let is_around = |part: &[(u32, i32)]| part.iter().map(|&(_, turn)| turn).sum::<i32>() != 0;
        let is_cavity = of_parts.chunk_by(|a, b| a.0 == b.0).any(is_around);
        Ok(if is_cavity { Surroundings::Cavity } else { Surroundings::Outside })
    }

    /// Whether what is opposite is near and something is in the way in all directions.
    fn is_in_gap(&self, place: DVec3, normal: DVec3, budget: &Budget) -> Result<bool, Stopped> {
        if !self.is_met([place, place + normal * GAP], budget)? {
            return Ok(false);
        }
        let (u, v) = normal.any_orthonormal_pair();
        for k in 0..DIRECTIONS {
            // A spiral around the hemisphere, steepest first.
            let height = 1.0 - (f64::from(k) + 0.5) / f64::from(DIRECTIONS);
            let (sin, cos) = libm::sincos(f64::from(k) * GOLDEN_ANGLE);
            let radius = (1.0 - height * height).sqrt();
            let direction = normal * height + (u * cos + v * sin) * radius;
            // What is in the way is mostly near.
            let mut is_met = false;
            for length in [4.0 * GAP, OUT] {
                is_met = is_met || self.is_met([place, place + direction * length], budget)?;
            }
            if !is_met {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Whether a segment meets a triangle.
    fn is_met(&self, [from, to]: [DVec3; 2], budget: &Budget) -> Result<bool, Stopped> {
        let mut is_met = false;
        // Cones are not there.
        let is_real = |t: u32| (t as usize) < self.corners.len() - self.cone_count;
        self.bvh.visit_segment([from, to], budget, |t| {
            is_met = is_real(t) && meets(from, to, self.corners[t as usize]);
            !is_met
        })?;
        Ok(is_met)
    }
}

/// Where a place is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Surroundings {
    Inside,
    /// Outside, but a closed shell winds around it and another one back.
    Cavity,
    Outside,
}

/// Whether a segment meets a triangle, rounded.
fn meets(from: DVec3, to: DVec3, [a, b, c]: [DVec3; 3]) -> bool {
    let (ab, ac, along) = (b - a, c - a, to - from);
    let normal = ab.cross(ac);
    let slope = normal.dot(along);
    let offset = from - a;
    let share = -normal.dot(offset) / slope;
    let turn = along.cross(offset);
    let (v, w) = (ac.dot(turn) / slope, -ab.dot(turn) / slope);
    (0.0..=1.0).contains(&share) && v >= 0.0 && w >= 0.0 && v + w <= 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(low: f64, size: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let corner = |i: usize| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64) * size + low;
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        ((0..8).map(corner).collect(), triangles)
    }

    /// Two cubes as one mesh.
    fn both(
        first: (Vec<DVec3>, Vec<[u32; 3]>),
        second: (Vec<DVec3>, Vec<[u32; 3]>),
    ) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let (mut positions, mut triangles) = first;
        triangles.extend(second.1.iter().map(|t| t.map(|v| v + 8)));
        positions.extend(second.0);
        (positions, triangles)
    }

    fn hidden(mesh: &(Vec<DVec3>, Vec<[u32; 3]>)) -> Vec<u32> {
        let solid = Solid::of(&mesh.0, &mesh.1, OpenShells::Auto, &Budget::unlimited()).unwrap();
        let corners = |t: usize| mesh.1[t].map(|v| mesh.0[v as usize]);
        let is_hidden = |t: &usize| {
            solid.hides(corners(*t).iter().sum::<DVec3>() / 3.0, corners(*t), &Budget::unlimited()).unwrap()
        };
        (0..mesh.1.len()).filter(is_hidden).map(|t| t as u32).collect()
    }

    #[test]
    fn a_body_in_a_body_is_hidden_and_a_cavity_is_not() {
        let within = both(cube(0.0, 10.0), cube(3.0, 2.0));
        assert_eq!(hidden(&within), (12..24).collect::<Vec<_>>());
        let mut hollow = within;
        hollow.1[12..].iter_mut().for_each(|t| t.swap(1, 2));
        assert!(hidden(&hollow).is_empty());
    }

    #[test]
    fn what_goes_into_another_body_is_hidden_there_only() {
        let crossing = both(cube(0.0, 10.0), cube(5.0, 10.0));
        let solid = Solid::of(&crossing.0, &crossing.1, OpenShells::Auto, &Budget::unlimited()).unwrap();
        // The bottom of the second cube, at z = 5.
        let bottom =
            (12..24).find(|&t| crossing.1[t].iter().all(|&v| crossing.0[v as usize].z == 5.0)).unwrap();
        let unlimited = Budget::unlimited();
        let corners = crossing.1[bottom].map(|v| crossing.0[v as usize]);
        assert!(solid.hides(DVec3::new(7.0, 7.0, 5.0), corners, &unlimited).unwrap());
        assert!(!solid.hides(DVec3::new(12.0, 12.0, 5.0), corners, &unlimited).unwrap());
    }

    #[test]
    fn a_narrow_gap_between_bodies_is_hidden_and_its_rim_and_a_wide_one_are_not() {
        let lid = |height: f64| {
            let (mut positions, triangles) = cube(0.0, 10.0);
            positions.iter_mut().for_each(|p| p.z += height);
            both(cube(0.0, 10.0), (positions, triangles))
        };
        let top = |mesh: &(Vec<DVec3>, Vec<[u32; 3]>), place: DVec3| {
            let unlimited = Budget::unlimited();
            let solid = Solid::of(&mesh.0, &mesh.1, OpenShells::Auto, &unlimited).unwrap();
            solid.hides(place, mesh.1[2].map(|v| mesh.0[v as usize]), &unlimited).unwrap()
        };
        let (middle, rim) = (DVec3::new(6.0, 5.0, 10.0), DVec3::new(6.0, 0.004, 10.0));
        assert!(top(&lid(10.01), middle));
        assert!(!top(&lid(10.01), rim));
        assert!(!top(&lid(11.0), middle));
    }
}
