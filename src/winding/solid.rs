//! The solid that any triangles stand for, and which of them are hidden in it.

use super::outlook::{BESIDE, GAP, InTheWay, Unit, is_closed, is_met, way_out};
use super::{LookedFrom, OpenShells, Shells, WindingTree, sort, turned};
use crate::budget::{Budget, Stopped};
use crate::geom::{Aabb, DVec3, Sign, triangle_area, upward_crossing};
use crate::spatial::Bvh;

/// Units of work of asking whether a place is below a triangle.
const CROSSING: u64 = 4;

/// The solid that triangles stand for: what their closed shells and those that nearly bound a volume wind around.
#[derive(Debug)]
pub struct WindingSolid {
    /// All that bounds a volume, closed by cones.
    corners: Vec<[DVec3; 3]>,
    /// The part of each triangle of a closed shell; these come first.
    part: Vec<u32>,
    /// Number of cones, which come last.
    cone_count: usize,
    bvh: Bvh,
    /// The cones, turned around.
    cones: WindingTree,
    unit: Unit,
    /// Area of the open parts that bound a volume, and of those that are sheets.
    open_areas: [f64; 2],
}

impl WindingSolid {
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
        let unit = Unit::around(triangles.as_flattened().iter().map(|&v| positions[v as usize]));
        let _charge = budget.charge((positions.len() * 24 + triangles.len() * 190) as u64)?;
        let places: Vec<DVec3> = positions.iter().map(|&p| unit.of(p)).collect();
        let Shells { closed: mut corners, closed_part: part, open, cones, sheets, .. } =
            sort(&places, triangles, open_shells, BESIDE, budget)?;
        let open_areas = [&open, &sheets].map(|part| part.iter().map(|&t| triangle_area(t)).sum());
        corners.extend(open);
        corners.extend(&cones);
        let names: Vec<[u32; 3]> = (0..corners.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        let bvh = Bvh::build(corners.as_flattened(), &names, None, budget)?;
        let cone_count = cones.len();
        let cones = WindingTree::build(turned(&cones), budget)?;
        Ok(Self { corners, part, cone_count, bvh, cones, unit, open_areas })
    }

    /// Whether most of the open surface is read as sheets, which bound no volume.
    pub fn is_mostly_sheets(&self) -> bool {
        let [of_volumes, of_sheets] = self.open_areas;
        of_sheets > of_volumes
    }

    /// Whether nobody sees a triangle at a `place` on it: both sides are inside, or a side that is not is a gap between
    /// bodies that is narrower than 1 % of the longest side of all and that no way leads out of in a straight line. A cavity
    /// that a shell of its own bounds is no gap. The triangle need not be one of those that were read. What was in the way from a place
    /// nearby is looked at first.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn hides(
        &self,
        place: DVec3,
        corners: [DVec3; 3],
        nearby: &mut LookedFrom,
        budget: &Budget,
    ) -> Result<bool, Stopped> {
        if self.corners.is_empty() {
            return Ok(false);
        }
        // What is above one side is mostly above the other: the tree is asked once.
        let column = Aabb::of(self.unit.both_sides(place, corners).map(|[beside, _]| beside));
        let mut above = Vec::new();
        if column.min.is_finite() {
            let column = Aabb { max: column.max.with_z(f64::MAX), ..column };
            self.bvh.visit_box(column, budget, |t| above.push(t))?;
        }
        // A triangle without area has no sides, and is not hidden.
        let mut has_sides = false;
        for (n, [beside, side]) in self.unit.both_sides(place, corners).enumerate() {
            let is_hidden = match self.surroundings(beside, &above, budget)? {
                Containment::Inside => true,
                Containment::Cavity => false,
                Containment::Outside => {
                    let known = (&mut nearby.opposite[n], &mut nearby.in_the_gap[n]);
                    self.is_in_gap(beside, side, known, budget)?
                }
            };
            if !is_hidden {
                return Ok(false);
            }
            has_sides = true;
        }
        Ok(has_sides)
    }

    /// Where a place is that these triangles may be `above`.
    fn surroundings(&self, place: DVec3, above: &[u32], budget: &Budget) -> Result<Containment, Stopped> {
        budget.spend(CROSSING * above.len() as u64)?;
        let (mut count, mut of_parts) = (0, Vec::new());
        for &t in above {
            if let Some(turn) = upward_crossing(place, self.corners[t as usize]) {
                let turn = if turn == Sign::Positive { 1 } else { -1 };
                count += turn;
                of_parts.extend(self.part.get(t as usize).map(|&part| (part, turn)));
            }
        }
        if self.cones.is_inside(place, f64::from(count), budget)? {
            return Ok(Containment::Inside);
        }
        of_parts.sort_unstable();
        let is_around = |part: &[(u32, i32)]| part.iter().map(|&(_, turn)| turn).sum::<i32>() != 0;
        let is_cavity = of_parts.chunk_by(|a, b| a.0 == b.0).any(is_around);
        Ok(if is_cavity { Containment::Cavity } else { Containment::Outside })
    }

    /// Whether what is opposite is near and something is in the way in all directions.
    fn is_in_gap(
        &self,
        place: DVec3,
        normal: DVec3,
        (opposite, known): (&mut Option<u32>, &mut InTheWay),
        budget: &Budget,
    ) -> Result<bool, Stopped> {
        // Cones are not there.
        let real = &self.corners[..self.corners.len() - self.cone_count];
        if !is_met(&self.bvh, real, [place, place + normal * GAP], opposite, budget)? {
            return Ok(false);
        }
        let is_closed =
            |k: usize, direction| is_closed(&self.bvh, real, [place, direction], (k, &mut *known), budget);
        Ok(way_out(normal, is_closed)?.is_none())
    }
}

/// Where a place is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Containment {
    Inside,
    /// Outside, but a closed shell winds around it and another one back.
    Cavity,
    Outside,
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

    fn hides(solid: &WindingSolid, place: DVec3, corners: [DVec3; 3]) -> bool {
        solid.hides(place, corners, &mut LookedFrom::default(), &Budget::unlimited()).unwrap()
    }

    fn hidden(mesh: &(Vec<DVec3>, Vec<[u32; 3]>)) -> Vec<u32> {
        let solid = WindingSolid::of(&mesh.0, &mesh.1, OpenShells::Auto, &Budget::unlimited()).unwrap();
        let corners = |t: usize| mesh.1[t].map(|v| mesh.0[v as usize]);
        let is_hidden = |t: &usize| hides(&solid, corners(*t).iter().sum::<DVec3>() / 3.0, corners(*t));
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
    fn triangles_above_a_place_are_counted_on_both_of_its_sides() {
        let work = |cubes: u32| {
            let mut mesh = cube(0.0, 10.0);
            for i in 1..cubes {
                let base = mesh.0.len() as u32;
                let (positions, triangles) = cube(0.0, 10.0);
                mesh.0.extend(positions.iter().map(|&p| p + DVec3::Z * f64::from(11 * i)));
                mesh.1.extend(triangles.iter().map(|t| t.map(|v| v + base)));
            }
            let solid = WindingSolid::of(&mesh.0, &mesh.1, OpenShells::Auto, &Budget::unlimited()).unwrap();
            let (budget, bottom) = (Budget::unlimited(), mesh.1[0].map(|v| mesh.0[v as usize]));
            let place = bottom.iter().sum::<DVec3>() / 3.0;
            solid.hides(place, bottom, &mut LookedFrom::default(), &budget).unwrap();
            budget.work_used()
        };
        // At least the bottom and the top of each further cube, by a triangle of each, below one side at least.
        assert!(work(200) - work(100) > 2 * 100 * CROSSING, "{} {}", work(100), work(200));
    }

    #[test]
    fn what_goes_into_another_body_is_hidden_there_only() {
        let crossing = both(cube(0.0, 10.0), cube(5.0, 10.0));
        let solid =
            WindingSolid::of(&crossing.0, &crossing.1, OpenShells::Auto, &Budget::unlimited()).unwrap();
        // The bottom of the second cube, at z = 5.
        let bottom =
            (12..24).find(|&t| crossing.1[t].iter().all(|&v| crossing.0[v as usize].z == 5.0)).unwrap();
        let corners = crossing.1[bottom].map(|v| crossing.0[v as usize]);
        assert!(hides(&solid, DVec3::new(7.0, 7.0, 5.0), corners));
        assert!(!hides(&solid, DVec3::new(12.0, 12.0, 5.0), corners));
    }

    #[test]
    fn a_narrow_gap_between_bodies_is_hidden_and_its_rim_and_a_wide_one_are_not() {
        let lid = |height: f64| {
            let (mut positions, triangles) = cube(0.0, 10.0);
            positions.iter_mut().for_each(|p| p.z += height);
            both(cube(0.0, 10.0), (positions, triangles))
        };
        let top = |mesh: &(Vec<DVec3>, Vec<[u32; 3]>), place: DVec3| {
            let solid = WindingSolid::of(&mesh.0, &mesh.1, OpenShells::Auto, &Budget::unlimited()).unwrap();
            hides(&solid, place, mesh.1[2].map(|v| mesh.0[v as usize]))
        };
        let (middle, rim) = (DVec3::new(6.0, 5.0, 10.0), DVec3::new(6.0, 0.004, 10.0));
        assert!(top(&lid(10.01), middle));
        assert!(!top(&lid(10.01), rim));
        assert!(!top(&lid(11.0), middle));
    }

    #[test]
    fn what_was_in_the_way_nearby_changes_no_answer_and_saves_work() {
        // A gap between two cubes, which ends where the upper one does.
        let mut upper = cube(0.0, 10.0);
        upper.0.iter_mut().for_each(|p| *p += DVec3::new(5.0, 0.0, 10.01));
        let mesh = both(cube(0.0, 10.0), upper);
        let solid = WindingSolid::of(&mesh.0, &mesh.1, OpenShells::Auto, &Budget::unlimited()).unwrap();
        let (mut nearby, alone, after_others) =
            (LookedFrom::default(), Budget::unlimited(), Budget::unlimited());
        let mut hidden = 0;
        for i in 0..900 {
            let place = DVec3::new(f64::from(i % 30) / 3.0 + 0.1, f64::from(i / 30) / 3.0 + 0.1, 10.0);
            let corners = [place, place + DVec3::X * 0.01, place + DVec3::Y * 0.01];
            let is_hidden = solid.hides(place, corners, &mut LookedFrom::default(), &alone).unwrap();
            assert_eq!(solid.hides(place, corners, &mut nearby, &after_others), Ok(is_hidden), "{place}");
            hidden += u32::from(is_hidden);
        }
        assert!((200..700).contains(&hidden), "{hidden}");
        let [alone, after_others] = [alone, after_others].map(|budget| budget.work_used());
        assert!(10 * after_others < 9 * alone, "{after_others} of {alone}");
    }
}
