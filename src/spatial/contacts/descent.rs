//! Simultaneous descent of a tree with itself.

use super::{COST_OF_CONTACT, Contacts, Effort, Gathered, Search, SearchedSurface, TriangleContact};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Shared, ThreePointPlane, contact, work_on_exact_signs};
use crate::par;
use crate::spatial::bvh::{Lanes, Leaf, Tree};
use crate::spatial::pairs::{Pair, expand, tasks};

/// Pairs of nodes that the descent starts from: enough for many threads, fixed, so that results do not depend on them.
const TASKS_AIM: usize = 1024;

/// Tasks that are run before it is seen whether that is enough, where one contact is.
const TASKS_AT_A_TIME: usize = 256;

/// The same where all are counted: what they keep is in memory until then.
const TASKS_AT_A_TIME_OF_ALL: usize = 64;

/// The same up to a number, all of which each of them may keep.
const TASKS_AT_A_TIME_UP_TO: usize = 8;

/// The contacts between the triangles of `tree`, except those inside one star, and the units of work they took; `None`: that is too
/// dear.
pub(super) fn pairs(
    tree: &Tree,
    surface: SearchedSurface<'_>,
    search: Search,
    effort: Effort,
    budget: &Budget,
) -> Result<Option<(Contacts, u64)>, Stopped> {
    let tasks = tasks(tree, TASKS_AIM, &|leaf, i| surface.sliver(leaf, i));
    let mut all = Gathered::new(search);
    let at_a_time = match search {
        Search::First => TASKS_AT_A_TIME,
        Search::UpTo { .. } => TASKS_AT_A_TIME_UP_TO,
        Search::All { .. } | Search::Most { .. } => TASKS_AT_A_TIME_OF_ALL,
    };
    let mut work = 0;
    let count = tasks.len();
    for (n, tasks) in tasks.chunks(at_a_time).enumerate() {
        // All of them end before an error is passed on: whether the work limit is reached depends on their sum alone.
        let found = par::try_map_ranges(tasks.len(), 1, |i| {
            let found = Gathered::new(search);
            ContactDescent { tree, surface, budget, found, unpaid: 0, work: 0, effort: effort.of_task() }
                .run(tasks[i.start])
        })?;
        for found in found {
            let Some((contacts, its_work)) = found else { return Ok(None) };
            all.merge(contacts);
            work += its_work;
            if all.is_enough() {
                return Ok(Some((all.finish(), work)));
            }
        }
        if effort.is_too_dear(work, all.contacts.count) {
            return Ok(None);
        }
        if work > effort.work_max && all.has_any() && (n + 1) * at_a_time < count {
            all.cut_short();
            break;
        }
    }
    Ok(Some((all.finish(), work)))
}

/// The search below one pair of nodes.
struct ContactDescent<'d> {
    tree: &'d Tree,
    surface: SearchedSurface<'d>,
    budget: &'d Budget,
    found: Gathered,
    /// Units not yet spent.
    unpaid: u64,
    /// Units used.
    work: u64,
    effort: Effort,
}

impl ContactDescent<'_> {
    /// What it found, and the units that took; `None`: that is too dear.
    fn run(mut self, start: Pair) -> Result<Option<(Contacts, u64)>, Stopped> {
        let mut stack = vec![start];
        while let Some(pair) = stack.pop() {
            self.count(1)?;
            let sliver = |leaf: &Leaf, i: usize| self.surface.sliver(leaf, i);
            if !expand(self.tree, &sliver, pair, |next| stack.push(next)) {
                let leaf = self.leaf(pair.x);
                if pair.is_of_slivers {
                    self.meet_one_by_one(leaf, pair.y)?;
                } else {
                    self.meet_leaves(leaf, self.leaf(pair.y), pair.x == pair.y)?;
                }
            }
            if self.found.is_enough() {
                break;
            }
            if self.effort.is_too_dear(self.work, self.found.contacts.count) {
                self.budget.spend(self.unpaid)?;
                return Ok(None);
            }
            if self.work > self.effort.work_max && self.found.has_any() && !stack.is_empty() {
                self.found.cut_short();
                break;
            }
        }
        self.budget.spend(self.unpaid)?;
        Ok(Some((self.found.finish(), self.work)))
    }

    fn count(&mut self, units: u64) -> Result<(), Stopped> {
        self.work += units;
        self.unpaid += units;
        if self.unpaid >= CHECK_EVERY as u64 {
            self.budget.spend(std::mem::take(&mut self.unpaid))?;
        }
        Ok(())
    }

    fn leaf<'d>(&self, node: u32) -> &'d Leaf
    where
        Self: 'd,
    {
        self.tree.leaf(self.tree.node(node))
    }

    /// Tests the triangles of two leaves, or the pairs inside one.
    #[inline]
    fn meet_leaves(&mut self, x: &Leaf, y: &Leaf, is_same: bool) -> Result<(), Stopped> {
        for i in 0..x.len() {
            let meeting = y.meeting(&x.bounds(i));
            self.compare(x, i, y, if is_same { meeting.after(i) } else { meeting })?;
        }
        Ok(())
    }

    /// Tests each triangle of leaf `x` with the triangles below node `y`. Boxes of long thin triangles are mostly empty,
    /// so the triangle itself is compared with the boxes.
    fn meet_one_by_one(&mut self, x: &Leaf, y: u32) -> Result<(), Stopped> {
        let mut stack = Vec::with_capacity(Tree::DEPTH_MAX);
        for i in 0..x.len() {
            let bounds = x.bounds(i);
            let sliver = self.surface.sliver(x, i);
            stack.push(y);
            while let Some(node) = stack.pop() {
                self.count(1)?;
                let node = self.tree.node(node);
                if !(node.bounds.meets(&bounds) && sliver.may_meet(&node.bounds)) {
                    continue;
                }
                match node.children() {
                    Some(children) => stack.extend(children),
                    None => {
                        let leaf = self.tree.leaf(node);
                        self.compare(x, i, leaf, leaf.meeting(&bounds))?;
                    }
                }
            }
        }
        Ok(())
    }

    /// Tests triangle `i` of leaf `x` with some of leaf `y`.
    #[inline]
    fn compare(&mut self, x: &Leaf, i: usize, y: &Leaf, meeting: Lanes) -> Result<(), Stopped> {
        if meeting.is_empty() {
            return Ok(());
        }
        let corners = x.corners(i);
        let pairs = y.pairs_with(corners);
        let harmless = self.surface.harmless_pairs(corners);
        let meeting = meeting.only(|j| pairs[j] & harmless == 0);
        if meeting.is_empty() {
            return Ok(());
        }
        let plane = ThreePointPlane::through(self.surface.points(corners).map(|p| *p));
        for j in meeting {
            let cost = self.surface.cost_of_pair(corners, y.corners(j));
            let exact_before = work_on_exact_signs();
            let kind = contact(&plane, self.surface.points(y.corners(j)), Shared::by_pairs(pairs[j]));
            let of_contact = if kind.is_some() { COST_OF_CONTACT } else { 0 };
            self.count(cost + (work_on_exact_signs() - exact_before) + of_contact)?;
            if let Some(kind) = kind {
                let (a, b) = (x.id(i), y.id(j));
                self.found.add(TriangleContact { a: a.min(b), b: a.max(b), kind });
            }
        }
        Ok(())
    }
}
