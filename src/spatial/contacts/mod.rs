//! Pairs of triangles that meet where they must not.

mod descent;
mod directions;
mod terrains;

use super::Bvh;
use super::bvh::{Frame, Leaf, Sliver, Star, Tree};
use crate::budget::{Budget, Stopped};
use crate::geom::{ContactKind, DVec3};
use crate::par;
use directions::Directions;
pub use terrains::Terrains;

/// A pair of triangles that meet beyond what they share by their indices.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Contact {
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
    pub list: Vec<Contact>,
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
}

/// Finds the pairs of triangles in `bvh` that meet in more than a common vertex or a common edge, exactly.
///
/// Equal positions must have equal indices, triangles must not be degenerate. Two triangles with the same three
/// vertices are not reported. Pairs at a vertex of `terrains`, if there are any, are not looked at.
///
/// Spends one work unit for each pair of boxes and of triangles it looks at.
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
    let surface = Surface { positions, triangles, terrains, frame: bvh.frame() };
    let found = descent::pairs(bvh.tree(), surface, search, budget)?;
    if search == Search::First && found.count > 0 {
        return Ok(found);
    }
    let mut all = Gathered::new(search);
    all.merge(found);
    for stars in bvh.stars().chunks(STARS_AT_A_TIME) {
        let found =
            par::try_map_ranges(stars.len(), 1, |i| star_contacts(surface, &stars[i.start], search, budget))?;
        found.into_iter().for_each(|contacts| all.merge(contacts));
        if all.is_enough() {
            break;
        }
    }
    Ok(all.finish())
}

/// Stars that are searched before it is seen whether that is enough.
const STARS_AT_A_TIME: usize = 64;

/// The contacts inside a star: two triangles of one hub meet beyond it exactly when they have a common direction from
/// it, so the boxes to compare are those of their directions. A flat fan of any size has few pairs of them.
fn star_contacts(
    surface: Surface<'_>,
    star: &Star,
    search: Search,
    budget: &Budget,
) -> Result<Contacts, Stopped> {
    if surface.terrains.is_some_and(|terrains| terrains.holds(star.hub)) {
        return Ok(Contacts::default());
    }
    let directions = Tree::build(&Directions { surface, star }, budget)?;
    descent::pairs(&directions, surface, search, budget)
}

/// The triangles that are searched.
#[derive(Clone, Copy)]
struct Surface<'s> {
    positions: &'s [DVec3],
    triangles: &'s [[u32; 3]],
    terrains: Option<&'s Terrains>,
    frame: Frame,
}

impl<'s> Surface<'s> {
    #[inline]
    fn points(&self, corners: [u32; 3]) -> [&'s DVec3; 3] {
        corners.map(|v| &self.positions[v as usize])
    }

    /// Triangle `i` of a leaf, to be compared with boxes.
    fn sliver(&self, leaf: &Leaf, i: usize) -> Sliver {
        Sliver::new(&self.frame, self.points(leaf.corners(i)))
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
    is_one_enough: bool,
}

impl Gathered {
    fn new(search: Search) -> Self {
        let (keep, is_one_enough) = match search {
            Search::First => (1, true),
            Search::All { keep } => (keep, false),
        };
        Self { contacts: Contacts::default(), keep, is_one_enough }
    }

    fn is_enough(&self) -> bool {
        self.is_one_enough && self.contacts.count > 0
    }

    fn add(&mut self, contact: Contact) {
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
