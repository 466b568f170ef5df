//! Closed shells that point inward: bodies that were drawn inside out are turned, cavities stay what they are, and where one reaches
//! the surface of its body it has a mouth.

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3, Sign, upward_crossing, volume_sign};
use crate::mesh::{EdgeGroups, edge_of, triangle_of};
use crate::par;
use crate::repair::Draft;
use crate::spatial::{Bvh, ShellTriangles};

/// Places in a shell that are looked at, at most.
const PLACES_MAX: usize = 64;

/// How far behind its triangles they are, as a share of the diagonal of its box: the wall of a cavity that all but lies on that of
/// its body is within this.
const DEPTH: f64 = 1.0 / 4096.0;

/// A shell that another one may be in is larger by this factor at least.
const LARGER: f64 = 1.000_001;

/// What was turned, and what was not.
pub(super) struct TurnedShells {
    /// Shells that were turned.
    pub(super) count: u64,
    /// All shells, where some are cavities.
    pub(super) with_cavities: Option<CavityShells>,
    /// The hierarchy of all triangles, where it was built and holds.
    pub(super) bvh: Option<Bvh>,
}

/// Turns the closed shells that point inward, unless they are cavities. A shell that is nowhere outside of the bodies around it is a
/// cavity of theirs, also where it reaches their surface from within; one in a larger cavity is a body again. Where the largest shell is
/// turned, the file is inside out mostly: what points outward and would be a cavity if every shell turned is turned too. Shells are those
/// connected by edges, so that bodies that share an edge count as one.
pub(super) fn turn_inverted(draft: &mut Draft, budget: &Budget) -> Result<TurnedShells, Stopped> {
    let groups = EdgeGroups::build(&draft.triangles, draft.positions.len(), budget)?;
    let (parts, open) = par::join(|| groups.components(budget), || open_edges(draft, &groups, budget));
    let parts = parts?;
    let mut is_closed = vec![true; parts.count as usize];
    for t in open? {
        is_closed[parts.of[t as usize] as usize] = false;
    }
    drop(groups);
    let members = ShellTriangles::group(&parts.of, parts.count, budget)?;
    let mut is_inverted = vec![false; parts.count as usize];
    for part in (0..parts.count as usize).filter(|&part| is_closed[part]) {
        let corners = members.of(part).iter().map(|&t| draft.corners(t as usize));
        is_inverted[part] = volume_sign(corners, || budget.check())? == Sign::Negative;
    }
    if !is_inverted.contains(&true) {
        return Ok(TurnedShells { count: 0, with_cavities: None, bvh: None });
    }
    let bvh = Bvh::build(&draft.positions, &draft.triangles, None, budget)?;
    let size = |part: usize| {
        let bounds = Aabb::of(members.of(part).iter().flat_map(|&t| draft.corners(t as usize)));
        (bounds.max - bounds.min).length()
    };
    let closed: Vec<usize> = (0..parts.count as usize).filter(|&part| is_closed[part]).collect();
    let mut sizes = vec![0.0; parts.count as usize];
    for &part in &closed {
        sizes[part] = size(part);
    }
    let turn = |draft: &mut Draft, shells: &[usize]| {
        for &t in shells.iter().flat_map(|&part| members.of(part)) {
            draft.flip(t as usize);
        }
    };
    let divide = |draft: &Draft, is_inverted: &[bool]| {
        let (of, members, sizes, bvh) = (&parts.of[..], &members, &sizes[..], &bvh);
        DraftShells { draft, of, members, is_inverted, sizes, bvh, budget }.divide_inverted()
    };
    let (mut cavities, mut turned) = divide(draft, &is_inverted)?;
    let largest = closed.iter().copied().max_by(|&a, &b| sizes[a].total_cmp(&sizes[b]));
    if largest.is_some_and(|part| turned.contains(&part)) {
        turn(draft, &closed);
        let is_outward: Vec<bool> = is_closed.iter().zip(&is_inverted).map(|(&c, &i)| c && !i).collect();
        let (cavities_of_turned, _) = divide(draft, &is_outward)?;
        turn(draft, &closed);
        turned.extend(&cavities_of_turned);
        cavities.extend(cavities_of_turned);
    }
    turn(draft, &turned);
    let with_cavities = CavityShells::of_parts(parts.of, &is_closed, &cavities);
    Ok(TurnedShells { count: turned.len() as u64, with_cavities, bvh: turned.is_empty().then_some(bvh) })
}

/// A triangle at each edge along which not as many triangles run one way as the other.
fn open_edges(draft: &Draft, groups: &EdgeGroups, budget: &Budget) -> Result<Vec<u32>, Stopped> {
    let is_forward = |&&h: &&u32| {
        let [from, to] = edge_of(&draft.triangles, h);
        from < to
    };
    let parts = par::try_map_ranges(groups.len(), CHECK_EVERY, |range| {
        budget.spend(range.len() as u64)?;
        let is_open = |group: &&[u32]| 2 * group.iter().filter(is_forward).count() != group.len();
        let open = range.map(|e| groups.group(e)).filter(is_open).map(|group| triangle_of(group[0]));
        Ok(open.collect::<Vec<_>>())
    })?;
    Ok(parts.concat())
}

/// What a shell is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ShellKind {
    /// It has a rim, or edges with more triangles one way than the other.
    Open,
    /// It points outward, now.
    Body,
    /// It points inward and is in bodies.
    Cavity,
}

/// Shells some of which are cavities.
pub(super) struct CavityShells {
    /// The shell of each triangle.
    of: Vec<u32>,
    kinds: Vec<ShellKind>,
}

impl CavityShells {
    /// The shells, where some are cavities. `of` is the shell of each triangle.
    fn of_parts(of: Vec<u32>, is_closed: &[bool], cavities: &[usize]) -> Option<Self> {
        let kind = |&is_closed: &bool| if is_closed { ShellKind::Body } else { ShellKind::Open };
        let mut kinds: Vec<ShellKind> = is_closed.iter().map(kind).collect();
        for &part in cavities {
            kinds[part] = ShellKind::Cavity;
        }
        (!cavities.is_empty()).then_some(Self { of, kinds })
    }

    /// Number of shells.
    pub(super) fn count(&self) -> usize {
        self.kinds.len()
    }

    /// The shell of a triangle.
    pub(super) fn of(&self, triangle: u32) -> usize {
        self.of[triangle as usize] as usize
    }

    /// Whether a piece with void on both sides is a mouth, where cavities reach the surface of a body: of the triangles that cover it
    /// those of bodies turn one way, and those of cavities, at least as many, the other. `sources` tell which turn around.
    pub(super) fn have_mouth(&self, sources: &[(u32, bool)]) -> bool {
        let count = |kind: ShellKind, is_turned: bool| {
            let is_one = |&&(t, turns): &&(u32, bool)| self.kinds[self.of(t)] == kind && turns == is_turned;
            sources.iter().filter(is_one).count()
        };
        let half = |is_turned| {
            let (bodies, cavities) =
                (count(ShellKind::Body, is_turned), count(ShellKind::Cavity, !is_turned));
            bodies > 0 && cavities >= bodies && bodies + cavities == sources.len()
        };
        half(true) || half(false)
    }

    /// Whether a piece with void on both sides is where cavities pass into each other: all triangles that cover it are of cavities.
    pub(super) fn have_passage(&self, sources: &[(u32, bool)]) -> bool {
        sources.iter().all(|&(t, _)| self.kinds[self.of(t)] == ShellKind::Cavity)
    }

    /// Whether the shell of a triangle is a body.
    pub(super) fn is_body(&self, triangle: u32) -> bool {
        self.kinds[self.of(triangle)] == ShellKind::Body
    }
}

struct DraftShells<'s> {
    draft: &'s Draft,
    /// The shell of each triangle.
    of: &'s [u32],
    members: &'s ShellTriangles,
    is_inverted: &'s [bool],
    /// The diagonal of the box of each closed shell.
    sizes: &'s [f64],
    bvh: &'s Bvh,
    budget: &'s Budget,
}

/// The winding number of a place, by what winds around it.
#[derive(Default)]
struct Around {
    own: i32,
    /// By the other shells that point outward.
    outward: i32,
    /// By those of the other shells that point inward that are larger: of two that lie on each other none is in the other.
    inward: i32,
}

impl DraftShells<'_> {
    /// The shells that point inward: the cavities, and those that are bodies inside out.
    fn divide_inverted(&self) -> Result<(Vec<usize>, Vec<usize>), Stopped> {
        let (mut cavities, mut bodies) = (Vec::new(), Vec::new());
        for part in (0..self.is_inverted.len()).filter(|&part| self.is_inverted[part]) {
            let kind = if self.is_cavity(part)? { &mut cavities } else { &mut bodies };
            kind.push(part);
        }
        Ok((cavities, bodies))
    }

    /// True when all that is in `part`, which points inward, is in bodies, and not all of it in their cavities.
    fn is_cavity(&self, part: usize) -> Result<bool, Stopped> {
        let own = self.members.of(part);
        let corners = || own.iter().flat_map(|&t| self.draft.corners(t as usize));
        let depth = self.sizes[part] * DEPTH;
        let (mut is_in_any, mut is_in_material) = (false, false);
        for &t in own.iter().step_by(own.len().div_ceil(PLACES_MAX)) {
            let [a, b, c] = self.draft.corners(t as usize);
            // The inside is where its triangles turn to.
            let Some(normal) = (b - a).cross(c - a).try_normalize() else { continue };
            let around = self.around(a / 3.0 + b / 3.0 + c / 3.0 + depth * normal, part)?;
            if around.own < 0 {
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
        let lowest = DVec3::splat(f64::NEG_INFINITY);
        let top = corners().fold(lowest, |top, p| if p.z > top.z { p } else { top });
        let around = self.around(top, part)?;
        Ok(around.outward + around.inward > 0)
    }

    /// What winds around a place.
    fn around(&self, place: DVec3, part: usize) -> Result<Around, Stopped> {
        let mut around = Around::default();
        self.bvh.visit_upward_ray(place, self.budget, |t| {
            let shell = self.of[t as usize] as usize;
            let side = match upward_crossing(place, self.draft.corners(t as usize)) {
                Some(Sign::Positive) => 1,
                Some(_) => -1,
                None => 0,
            };
            if shell == part {
                around.own += side;
            } else if !self.is_inverted[shell] {
                around.outward += side;
            } else if self.sizes[shell] > self.sizes[part] * LARGER {
                around.inward += side;
            }
        })?;
        Ok(around)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{cubes, volume_times_6};
    use super::super::unite;
    use super::*;
    use crate::repair::Changes;

    /// The volume that uniting these cubes gives, and what was done. Each has a lowest corner, a side, and `true` where it is inside out.
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
            assert_eq!((coverage.mouths > 0, coverage.bare_beside_mouths.len()), (mouths > 0, 0), "{low:?}");
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
    fn a_file_that_is_inside_out_as_a_whole_keeps_its_cavities() {
        let body = (DVec3::ZERO, 8.0, true);
        // Beside each other, through each other, and a body in one of them.
        for (inner, volume) in [
            (vec![(DVec3::ONE, 2.0, false), (DVec3::new(3.0, 1.0, 1.0), 2.0, false)], 512.0 - 16.0),
            (vec![(DVec3::ONE, 2.0, false), (DVec3::splat(2.0), 2.0, false)], 512.0 - 15.0),
            (vec![(DVec3::ONE, 4.0, false), (DVec3::splat(2.0), 1.0, true)], 512.0 - 64.0 + 1.0),
        ] {
            let (found, changes) = united(&[&[body][..], &inner].concat());
            assert_eq!((found, changes.count("shells_turned")), (volume, 3), "{inner:?}");
        }
        // A body beside it that points outward stays; beside a larger one that does, only the body is turned.
        let small = [body, (DVec3::ONE, 2.0, false), (DVec3::splat(9.0), 1.0, false)];
        let (volume, changes) = united(&small);
        assert_eq!((volume, changes.count("shells_turned")), (512.0 - 8.0 + 1.0, 2));
        let large = [(DVec3::splat(9.0), 10.0, false), (DVec3::splat(10.0), 1.0, true)];
        let (volume, changes) = united(&[&large, &small[..2]].concat());
        assert_eq!((volume, changes.count("shells_turned")), (1000.0 - 1.0 + 512.0, 1));
    }

    #[test]
    fn cavities_that_reach_the_surface_and_each_other_stay_open() {
        let body = (DVec3::ZERO, 8.0, false);
        let cup = (DVec3::new(2.0, 2.0, 4.0), 4.0, true);
        // A pocket under the cup, one through its floor, one beside it at the surface, and the cup twice.
        for (second, volume) in [
            ((DVec3::new(3.0, 3.0, 2.0), 2.0, true), 512.0 - 64.0 - 8.0),
            ((DVec3::new(3.0, 3.0, 3.0), 2.0, true), 512.0 - 64.0 - 4.0),
            ((DVec3::new(5.0, 3.0, 6.0), 2.0, true), 512.0 - 64.0 - 4.0),
            (cup, 512.0 - 64.0),
        ] {
            let (found, changes) = united(&[body, cup, second]);
            let coverage = changes.coverage.unwrap();
            assert_eq!((found, coverage.bare_beside_mouths.len()), (volume, 0), "{second:?}");
            assert!(coverage.mouths > 0, "{second:?}");
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
    fn a_cavity_that_is_there_twice_is_a_cavity_and_a_body_inside_out_on_itself_stays() {
        let (body, cavity) = ((DVec3::ZERO, 4.0, false), (DVec3::ONE, 2.0, true));
        assert_eq!(united(&[body, cavity, cavity]).0, 64.0 - 8.0);
        let (_, changes) = united(&[(DVec3::splat(9.0), 1.0, false), body, (DVec3::ZERO, 4.0, true)]);
        let coverage = changes.coverage.unwrap();
        assert_eq!((coverage.mouths, coverage.bare_beside_mouths.len()), (0, 24));
    }

    #[test]
    fn a_sheet_with_two_sides_is_no_mouth() {
        let mut draft = cubes(&[(DVec3::ZERO, 4.0, false), (DVec3::new(1.0, 1.0, 0.0), 1.0, true)]);
        let first = draft.positions.len() as u32;
        draft.positions.extend([DVec3::splat(6.0), DVec3::new(7.0, 6.0, 6.0), DVec3::new(6.0, 7.0, 6.0)]);
        draft.positions.extend([DVec3::splat(6.0), DVec3::new(7.0, 6.0, 6.0), DVec3::new(6.0, 7.0, 6.0)]);
        draft.vertex_origin.extend(0..6);
        draft.triangles.extend([[first, first + 1, first + 2], [first + 3, first + 5, first + 4]]);
        draft.triangle_origin.extend([30, 31]);
        let coverage = unite(&mut draft, &Budget::unlimited()).unwrap().coverage.unwrap();
        assert!(coverage.mouths > 0);
        assert_eq!(coverage.bare_beside_mouths, [30, 31]);
    }
}
