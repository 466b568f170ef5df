//! Closed shells that point inward: bodies that were drawn inside out are turned, cavities stay what they are, and where one reaches
//! the surface of its body it has a mouth.

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3, Sign, upward_crossing, volume_sign};
use crate::mesh::{EdgeGroups, edge_of};
use crate::repair::Draft;
use crate::spatial::{Bvh, ShellTriangles};
use std::cell::OnceCell;

/// Places in a shell that are looked at, at most.
const PLACES_MAX: usize = 64;

/// How far behind its triangles they are, as a share of the diagonal of its box: the wall of a cavity that all but lies on that of
/// its body is within this.
const DEPTH: f64 = 1.0 / 4096.0;

/// Turns the closed shells that point inward, unless they are cavities; gives their number. A shell that is nowhere outside of the
/// bodies around it is a cavity of theirs, also where it reaches their surface from within; one in a cavity is a body again.
pub(super) fn turn_inverted(draft: &mut Draft, budget: &Budget) -> Result<u64, Stopped> {
    let groups = EdgeGroups::build(&draft.triangles, draft.positions.len(), budget)?;
    let parts = groups.components(budget)?;
    let mut is_closed = vec![true; parts.count as usize];
    for (e, group) in groups.iter().enumerate() {
        if e % CHECK_EVERY == 0 {
            budget.spend(CHECK_EVERY as u64)?;
        }
        let forward = |&&h: &&u32| {
            let [from, to] = edge_of(&draft.triangles, h);
            from < to
        };
        if 2 * group.iter().filter(forward).count() != group.len() {
            is_closed[parts.of[(group[0] / 3) as usize] as usize] = false;
        }
    }
    drop(groups);
    let members = ShellTriangles::group(&parts.of, parts.count, budget)?;
    let mut is_inverted = vec![false; parts.count as usize];
    for part in (0..parts.count as usize).filter(|&part| is_closed[part]) {
        let corners = members.of(part).iter().map(|&t| draft.corners(t as usize));
        is_inverted[part] = volume_sign(corners, || budget.check())? == Sign::Negative;
    }
    if !is_inverted.contains(&true) {
        return Ok(0);
    }
    let bvh = Bvh::build(&draft.positions, &draft.triangles, None, budget)?;
    let shells =
        Shells { draft, of: &parts.of, members: &members, is_inverted: &is_inverted, bvh: &bvh, budget };
    let mut turned = Vec::new();
    for part in (0..parts.count as usize).filter(|&part| is_inverted[part]) {
        if !shells.is_cavity(part)? {
            turned.push(part);
        }
    }
    for &part in &turned {
        for &t in members.of(part) {
            draft.flip(t as usize);
        }
    }
    Ok(turned.len() as u64)
}

struct Shells<'s> {
    draft: &'s Draft,
    /// The shell of each triangle.
    of: &'s [u32],
    members: &'s ShellTriangles,
    is_inverted: &'s [bool],
    bvh: &'s Bvh,
    budget: &'s Budget,
}

/// The winding number of a place, by what winds around it.
#[derive(Default)]
struct Around {
    own: i32,
    /// By the other shells that point outward.
    outward: i32,
    /// By the other shells that point inward.
    inward: i32,
}

impl Shells<'_> {
    /// True when all that is in `part`, which points inward, is in bodies, and not all of it in their cavities.
    fn is_cavity(&self, part: usize) -> Result<bool, Stopped> {
        let own = self.members.of(part);
        let corners = || own.iter().flat_map(|&t| self.draft.corners(t as usize));
        let bounds = Aabb::of(corners());
        let depth = (bounds.max - bounds.min).length() * DEPTH;
        let (mut is_in_any, mut is_in_material) = (false, false);
        for &t in own.iter().step_by(own.len().div_ceil(PLACES_MAX)) {
            let [a, b, c] = self.draft.corners(t as usize);
            // The inside is where its triangles turn to.
            let Some(normal) = (b - a).cross(c - a).try_normalize() else { continue };
            let around = self.around(a / 3.0 + b / 3.0 + c / 3.0 + depth * normal, part)?;
            if around.own == -1 {
                if around.outward <= 0 {
                    return Ok(false);
                }
                is_in_any = true;
                is_in_material |= around.outward + around.inward > 0;
            }
        }
        if is_in_any {
            return Ok(is_in_material);
        }
        // It is thinner than that everywhere.
        let top = corners().fold(bounds.min, |top, p| if p.z > top.z { p } else { top });
        let around = self.around(top, part)?;
        Ok(around.outward + around.inward > 0)
    }

    /// What winds around a place that is on no other shell than `part`.
    fn around(&self, place: DVec3, part: usize) -> Result<Around, Stopped> {
        let mut around = Around::default();
        self.bvh.visit_upward_ray(place, self.budget, |t| {
            let shell = self.of[t as usize] as usize;
            let side = match upward_crossing(place, self.draft.corners(t as usize)) {
                Some(Sign::Positive) => 1,
                Some(_) => -1,
                None => 0,
            };
            *match () {
                () if shell == part => &mut around.own,
                () if self.is_inverted[shell] => &mut around.inward,
                () => &mut around.outward,
            } += side;
        })?;
        Ok(around)
    }
}

/// Tells mouths of cavities from sheets with two sides.
pub(super) struct Mouths<'d> {
    draft: &'d Draft,
    budget: &'d Budget,
    /// The shell of each triangle, once it is asked for: shells are those connected by edges.
    shells: OnceCell<Vec<u32>>,
}

impl<'d> Mouths<'d> {
    pub(super) fn of(draft: &'d Draft, budget: &'d Budget) -> Self {
        Self { draft, budget, shells: OnceCell::new() }
    }

    /// Whether a piece with void on both sides is a mouth: of the triangles that cover it as many turn one way as the other, and they
    /// are of several shells. `sources` tell which turn around.
    pub(super) fn have(&self, sources: &[(u32, bool)]) -> Result<bool, Stopped> {
        let turned = sources.iter().filter(|&&(_, is_turned)| is_turned).count();
        if 2 * turned != sources.len() {
            return Ok(false);
        }
        let shells = match self.shells.get() {
            Some(shells) => shells,
            None => {
                let Draft { triangles, positions, .. } = self.draft;
                let groups = EdgeGroups::build(triangles, positions.len(), self.budget)?;
                let shells = groups.components(self.budget)?.of;
                self.shells.get_or_init(|| shells)
            }
        };
        Ok(sources.iter().any(|&(t, _)| shells[t as usize] != shells[sources[0].0 as usize]))
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{cubes, volume_times_6};
    use super::super::{unite, unite_as_oriented};
    use super::*;
    use crate::repair::Changes;

    /// What uniting these cubes gives: eight times the volume of each, whether it is a cavity.
    fn united(of: &[(DVec3, f64, bool)]) -> (f64, Changes) {
        let mut draft = cubes(of);
        let changes = unite(&mut draft, &Budget::unlimited()).unwrap();
        (volume_times_6(&draft) / 6.0, changes)
    }

    #[test]
    fn a_cavity_that_reaches_the_surface_from_within_stays_open_there() {
        let body = (DVec3::ZERO, 4.0, false);
        for (low, mouths) in
            [([1.0, 1.0, 0.0], 1), ([0.0, 1.0, 3.0], 2), ([0.0, 0.0, 0.0], 3), ([1.0, 1.0, 1.0], 0)]
        {
            let (volume, changes) = united(&[body, (DVec3::from_array(low), 1.0, true)]);
            assert_eq!((volume, changes.count("shells_turned")), (63.0, 0), "{low:?}");
            let coverage = changes.coverage.unwrap();
            assert_eq!((coverage.mouths > 0, coverage.bare.len()), (mouths > 0, 0), "{low:?}");
        }
    }

    #[test]
    fn cavities_that_meet_each_other_in_a_body_are_both_cavities() {
        let body = (DVec3::ZERO, 8.0, false);
        let (low, high) = ((DVec3::ONE, 2.0, true), (DVec3::splat(2.0), 2.0, true));
        for cavities in [[low, high], [high, low]] {
            let (volume, changes) = united(&[&[body][..], &cavities].concat());
            // Where both are the winding number is below 0.
            assert_eq!((volume, changes.count("shells_turned")), (512.0 - 15.0, 0));
        }
    }

    #[test]
    fn what_points_inward_and_is_outside_of_bodies_or_in_a_cavity_is_turned() {
        let body = (DVec3::ZERO, 8.0, false);
        // Beside it on its surface, through its surface from above and from below, and in its cavity.
        for (others, volume) in [
            (vec![(DVec3::new(8.0, 2.0, 2.0), 2.0, true)], 520.0),
            (vec![(DVec3::new(2.0, 2.0, 7.0), 2.0, true)], 516.0),
            (vec![(DVec3::new(2.0, 2.0, -1.0), 2.0, true)], 516.0),
            (vec![(DVec3::ONE, 4.0, true), (DVec3::splat(2.0), 1.0, true)], 512.0 - 64.0 + 1.0),
        ] {
            let (found, changes) = united(&[&[body][..], &others].concat());
            assert_eq!((found, changes.count("shells_turned")), (volume, 1), "{others:?}");
        }
    }

    #[test]
    fn a_sheet_with_two_sides_is_no_mouth() {
        let mut draft = cubes(&[(DVec3::ZERO, 1.0, false)]);
        let first = draft.positions.len() as u32;
        draft.positions.extend([DVec3::splat(3.0), DVec3::new(4.0, 3.0, 3.0), DVec3::new(3.0, 4.0, 3.0)]);
        draft.vertex_origin.extend([8, 9, 10]);
        draft.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 1]]);
        draft.triangle_origin.extend([12, 13]);
        let coverage = unite_as_oriented(&mut draft, &Budget::unlimited()).unwrap().coverage.unwrap();
        assert_eq!((coverage.mouths, coverage.bare), (0, vec![12, 13]));
    }
}
