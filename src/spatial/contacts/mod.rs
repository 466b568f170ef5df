//! Pairs of triangles that meet where they must not.

mod descent;
mod directions;
mod terrains;

use super::Bvh;
use super::bvh::{Frame, HubStar, Leaf, Sliver, Tree, TurnedTree};
use crate::budget::{Budget, Stopped};
use crate::geom::{ContactKind, DVec3, suits_expansions};
use crate::par;
use directions::ContactDirections;
pub use terrains::Terrains;

/// A pair of triangles that meet beyond what they share by their indices.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TriangleContact {
    /// The triangle with the smaller id.
    pub a: u32,
    /// The triangle with the larger id.
    pub b: u32,
    /// How they meet.
    pub kind: ContactKind,
}

/// What a search found.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Contacts {
    /// Number of pairs found.
    pub count: u64,
    /// How many of them are of each kind, in the order of [`ContactKind`].
    pub count_by_kind: [u64; 3],
    /// The pairs, sorted; the first ones when there are more than were asked for.
    pub list: Vec<TriangleContact>,
    /// The search ended before it had looked everywhere: there may be more pairs than `count`.
    pub is_cut_short: bool,
}

impl Contacts {
    /// True when every pair that there is stands in the list.
    pub fn are_all_listed(&self) -> bool {
        !self.is_cut_short && self.list.len() as u64 == self.count
    }
}

/// When a search may end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Search {
    /// After a contact is found; which one depends on the mesh alone, not on the threads.
    First,
    /// Count all, keep the first ones (sorted by `(a, b)`).
    All {
        /// Most pairs to keep.
        keep: usize,
    },
    /// The same, but where there are more than so many pairs, the rest is not counted.
    UpTo {
        /// Most pairs to count and to keep.
        most: usize,
    },
    /// As [`All`](Self::All), but where some are found and that takes more than 2^26 units of work and 1,024 for each triangle, the rest is not
    /// counted.
    Most {
        /// Most pairs to keep.
        keep: usize,
    },
}

/// Units of work after which a search for all contacts ends with those it has found, for each triangle and whatever their number.
/// Meshes that are as they are meant take 20 to 150 units a triangle.
const WORK_PER_TRIANGLE: u64 = 1024;
const WORK_MIN: u64 = 1 << 26;

/// What a pair of triangles counts beside its exact signs, and what more it counts when they meet.
const COST: u64 = 4;
const COST_OF_CONTACT: u64 = 16;

/// What a pair of triangles counts whose coordinates are so far apart that their signs are those of big integers.
const COST_IN_BIG_INTEGERS: u64 = 2048;

/// A search that takes more units of work than this, for each triangle and whatever their number, and finds little, looks at the boxes of
/// long triangles in vain; it begins again in coordinates in which they lie along axes, if there are such.
const DEAR_PER_TRIANGLE: u64 = 256;
const DEAR_MIN: u64 = 1 << 20;

/// Units of work for each contact found that are not in vain.
const DEAR_PER_CONTACT: u64 = 64;

/// Finds the pairs of triangles in `bvh` that meet in more than a common vertex or a common edge, exactly.
///
/// Equal positions must have equal indices, triangles must not be degenerate. Two triangles with the same three
/// vertices are not reported. Pairs at a vertex of `terrains`, if there are any, are not looked at.
///
/// Spends one work unit for each pair of boxes it looks at, and more for each pair of triangles.
///
/// # Errors
/// When the budget stops the run.
pub fn self_contacts(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    bvh: &Bvh,
    terrains: Option<&Terrains>,
    search: Search,
    budget: &Budget,
) -> Result<Contacts, Stopped> {
    let may_take_big_integers = !suits_expansions(positions);
    let surface = SearchedSurface {
        positions,
        triangles,
        terrains,
        seen: Seen::as_it_is(positions, bvh),
        may_take_big_integers,
    };
    let work_max = match search {
        Search::Most { .. } => WORK_MIN + WORK_PER_TRIANGLE * triangles.len() as u64,
        Search::First | Search::All { .. } | Search::UpTo { .. } => u64::MAX,
    };
    let (found, mut work) = pairs_beside_stars(bvh, surface, search, work_max, budget)?;
    let mut all = Gathered::new(search);
    all.merge(found);
    if all.is_enough() {
        return Ok(all.finish());
    }
    for stars in bvh.stars().chunks(STARS_AT_A_TIME) {
        let left = work_max.saturating_sub(work);
        if left == 0 && all.has_any() {
            all.cut_short();
            break;
        }
        let found = par::try_map_ranges(stars.len(), 1, |i| {
            star_contacts(surface, &stars[i.start], search, left / SHARE_OF_STAR, budget)
        })?;
        for (contacts, its_work) in found {
            all.merge(contacts);
            work += its_work;
        }
        if all.is_enough() {
            break;
        }
    }
    Ok(all.finish())
}

/// The contacts of triangles that are not of one star, and the units of work they took.
fn pairs_beside_stars(
    bvh: &Bvh,
    surface: SearchedSurface<'_>,
    search: Search,
    work_max: u64,
    budget: &Budget,
) -> Result<(Contacts, u64), Stopped> {
    let dear = DEAR_MIN + DEAR_PER_TRIANGLE * surface.triangles.len() as u64;
    let found = descent::pairs(bvh.tree(), surface, search, Effort { work_max, dear }, budget)?;
    if let Some(found) = found {
        return Ok(found);
    }
    let effort = Effort { work_max, dear: u64::MAX };
    let turned = bvh.turned(surface.positions, surface.triangles, budget)?;
    let (tree, seen) = match &turned {
        Some(turned) => (&turned.tree, Seen::turned(turned)),
        None => (bvh.tree(), surface.seen),
    };
    let found = descent::pairs(tree, SearchedSurface { seen, ..surface }, search, effort, budget)?;
    Ok(found.unwrap_or_default())
}

/// What a descent may take.
#[derive(Debug, Clone, Copy)]
struct Effort {
    /// Units of work after which it ends, if it has found something.
    work_max: u64,
    /// Units after which it is too dear, if it has found little.
    dear: u64,
}

impl Effort {
    fn is_too_dear(self, work: u64, contacts: u64) -> bool {
        work > self.dear && work > contacts.saturating_mul(DEAR_PER_CONTACT)
    }

    /// That of one of several tasks.
    fn of_task(self) -> Self {
        Self { work_max: self.work_max / SHARE_OF_TASK, dear: self.dear / DEAR_SHARE_OF_TASK }
    }
}

/// A task that has found something may use this share of all work.
const SHARE_OF_TASK: u64 = 64;

/// A task that has found little is too dear beyond this share of what is for all.
const DEAR_SHARE_OF_TASK: u64 = 16;

/// A star may use this share of the work that is left, once it has found something.
const SHARE_OF_STAR: u64 = 8;

/// Stars that are searched before it is seen whether that is enough.
const STARS_AT_A_TIME: usize = 64;

/// The contacts inside a star, and the units of work they took: two triangles of one hub meet beyond it exactly when they have a
/// common direction from it, so the boxes to compare are those of their directions. A flat fan of any size has few pairs of them.
fn star_contacts(
    surface: SearchedSurface<'_>,
    star: &HubStar,
    search: Search,
    work_max: u64,
    budget: &Budget,
) -> Result<(Contacts, u64), Stopped> {
    if surface.terrains.is_some_and(|terrains| terrains.holds(star.hub)) {
        return Ok((Contacts::default(), 0));
    }
    let directions = Tree::build(&ContactDirections { surface, star }, budget)?;
    let effort = Effort { work_max, dear: u64::MAX };
    Ok(descent::pairs(&directions, surface, search, effort, budget)?.unwrap_or_default())
}

/// The coordinates of the boxes.
#[derive(Clone, Copy)]
struct Seen<'s> {
    positions: &'s [DVec3],
    /// How far these may be from where they should be, in each coordinate.
    margin: f64,
    frame: Frame,
}

impl<'s> Seen<'s> {
    fn as_it_is(positions: &'s [DVec3], bvh: &Bvh) -> Self {
        Self { positions, margin: 0.0, frame: bvh.frame() }
    }

    fn turned(turned: &'s TurnedTree) -> Self {
        Self { positions: &turned.positions, margin: turned.margin, frame: turned.frame }
    }
}

/// The triangles that are searched.
#[derive(Clone, Copy)]
struct SearchedSurface<'s> {
    positions: &'s [DVec3],
    triangles: &'s [[u32; 3]],
    terrains: Option<&'s Terrains>,
    seen: Seen<'s>,
    /// Coordinates of some triangles are so far apart that signs are those of big integers.
    may_take_big_integers: bool,
}

impl<'s> SearchedSurface<'s> {
    #[inline]
    fn points(&self, corners: [u32; 3]) -> [&'s DVec3; 3] {
        corners.map(|v| &self.positions[v as usize])
    }

    /// Work units of a pair of triangles.
    #[inline]
    fn cost_of_pair(&self, a: [u32; 3], b: [u32; 3]) -> u64 {
        let takes_big_integers =
            self.may_take_big_integers && !suits_expansions(self.points(a).into_iter().chain(self.points(b)));
        if takes_big_integers { COST_IN_BIG_INTEGERS } else { COST }
    }

    /// Triangle `i` of a leaf, to be compared with boxes.
    fn sliver(&self, leaf: &Leaf, i: usize) -> Sliver {
        let Seen { positions, margin, frame } = self.seen;
        let corners = leaf.corners(i).map(|v| &positions[v as usize]);
        Sliver::new(&frame, corners).with_reach(frame.scaled(margin))
    }

    /// The pairs of equal corners, see [`crate::geom::Shared::by_pairs`], that say of another triangle that it meets
    /// this one in what they share only.
    #[inline]
    fn harmless_pairs(&self, corners: [u32; 3]) -> u32 {
        let Some(terrains) = self.terrains else { return 0 };
        (0..3).filter(|&i| terrains.holds(corners[i])).fold(0, |pairs, i| pairs | 7 << (3 * i))
    }
}

/// Contacts while they are collected: all are counted, the first ones are kept.
#[derive(Debug)]
struct Gathered {
    contacts: Contacts,
    keep: usize,
    /// More than so many are enough.
    most: u64,
}

impl Gathered {
    fn new(search: Search) -> Self {
        let (keep, most) = match search {
            Search::First => (1, 0),
            Search::UpTo { most } => (most, most as u64),
            Search::All { keep } | Search::Most { keep } => (keep, u64::MAX),
        };
        Self { contacts: Contacts::default(), keep, most }
    }

    fn is_enough(&self) -> bool {
        self.contacts.count > self.most
    }

    fn has_any(&self) -> bool {
        self.contacts.count > 0
    }

    fn cut_short(&mut self) {
        self.contacts.is_cut_short = true;
    }

    fn add(&mut self, contact: TriangleContact) {
        self.contacts.count += 1;
        self.contacts.count_by_kind[contact.kind as usize] += 1;
        self.contacts.list.push(contact);
        if self.contacts.list.len() / 2 > self.keep {
            self.trim();
        }
    }

    fn merge(&mut self, mut found: Contacts) {
        self.contacts.count += found.count;
        for (sum, of_kind) in self.contacts.count_by_kind.iter_mut().zip(found.count_by_kind) {
            *sum += of_kind;
        }
        self.contacts.list.append(&mut found.list);
        self.contacts.is_cut_short |= found.is_cut_short;
        if self.contacts.list.len() / 2 > self.keep {
            self.trim();
        }
    }

    fn trim(&mut self) {
        self.contacts.list.sort_unstable();
        self.contacts.list.truncate(self.keep);
    }

    fn finish(mut self) -> Contacts {
        self.trim();
        self.contacts
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    /// Triangles all through each other.
    fn tangle(count: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let mut state = 1u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8)
        };
        let positions = (0..3 * count).map(|_| DVec3::new(random(), random(), random())).collect();
        (positions, (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect())
    }

    /// Fans of long thin triangles in planes one above the other, and a triangle through some of them.
    fn plates(turn: DQuat) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        for plate in 0..50u32 {
            let first = positions.len() as u32;
            positions.push(DVec3::new(0.0, 0.0, f64::from(plate)));
            positions.extend((0..=60).map(|i| DVec3::new(f64::from(i), 1.0, f64::from(plate))));
            triangles.extend((1..=60).map(|i| [first, first + i, first + i + 1]));
        }
        let first = positions.len() as u32;
        positions.extend([(20.3, 0.4, 7.5), (21.1, 0.6, 10.5), (20.7, 0.9, 10.4)].map(DVec3::from));
        triangles.push([first, first + 1, first + 2]);
        (positions.into_iter().map(|p| turn * p).collect(), triangles)
    }

    #[test]
    fn long_thin_triangles_are_searched_in_coordinates_along_them() {
        let turn = DQuat::from_scaled_axis(DVec3::new(0.5, -0.7, 0.4));
        let (positions, triangles) = plates(turn);
        let unlimited = Budget::unlimited();
        let bvh = Bvh::build(&positions, &triangles, None, &unlimited).unwrap();
        let seen = Seen::as_it_is(&positions, &bvh);
        let surface = SearchedSurface {
            positions: &positions,
            triangles: &triangles,
            terrains: None,
            seen,
            may_take_big_integers: false,
        };
        let effort = Effort { work_max: u64::MAX, dear: u64::MAX };
        for search in [Search::All { keep: 99 }, Search::Most { keep: 99 }, Search::UpTo { most: 99 }] {
            let plain = descent::pairs(bvh.tree(), surface, search, effort, &unlimited).unwrap();
            let (plain, plain_work) = plain.unwrap();
            let budget = Budget::unlimited();
            let found = self_contacts(&positions, &triangles, &bvh, None, search, &budget).unwrap();
            assert!(found.count > 9 && found == plain, "{found:?} {plain:?}");
            assert!(2 * budget.work_used() < plain_work, "{} {plain_work}", budget.work_used());
        }
    }

    #[test]
    fn a_count_ends_at_its_bound_of_work_and_says_so() {
        let (positions, triangles) = tangle(5000);
        let count = |search, threads| {
            par::with_threads(threads, || {
                let budget = Budget::unlimited();
                let bvh = Bvh::build(&positions, &triangles, None, &budget).unwrap();
                let found = self_contacts(&positions, &triangles, &bvh, None, search, &budget).unwrap();
                (found, budget.work_used())
            })
        };
        let (all, _) = count(Search::All { keep: 0 }, 8);
        let (most, work) = count(Search::Most { keep: 0 }, 8);
        assert!(!all.is_cut_short && most.is_cut_short);
        assert!(0 < most.count && most.count < all.count, "{} of {}", most.count, all.count);
        assert!(work < 4 * (WORK_MIN + 5000 * WORK_PER_TRIANGLE), "{work}");
        assert_eq!((most, work), count(Search::Most { keep: 0 }, 1));
        // What is within the bound is counted in full.
        let (positions, triangles) = tangle(200);
        let budget = Budget::unlimited();
        let bvh = Bvh::build(&positions, &triangles, None, &budget).unwrap();
        let of = |search| self_contacts(&positions, &triangles, &bvh, None, search, &budget).unwrap();
        let all = of(Search::All { keep: 9 });
        assert_eq!(of(Search::Most { keep: 9 }), all);
        // Up to so many are all counted, and of more there are more than that.
        let count = all.count as usize;
        assert_eq!(of(Search::UpTo { most: count }), of(Search::All { keep: count }));
        let more = of(Search::UpTo { most: count - 1 });
        assert!(more.count >= count as u64 && more.list.len() == count - 1);
        let some = of(Search::UpTo { most: 50 });
        assert!((51..all.count).contains(&some.count), "{} of {}", some.count, all.count);
    }
}
