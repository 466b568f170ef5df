//! Simultaneous descent of a tree with itself.

use super::{Contact, Contacts, Gathered, Search, Surface};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Plane, Shared, contact};
use crate::par;
use crate::spatial::bvh::{Lanes, Leaf, Sliver, Tree};

/// Two nodes whose triangles may meet; the same node twice for the pairs inside it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Pair {
    x: u32,
    y: u32,
    /// The triangles in `x` are those of a star, long and thin; they go down into `y` one by one.
    is_of_slivers: bool,
}

/// Pairs of nodes that the descent starts from: enough for many threads, fixed, so that results do not depend on them.
const TASKS_AIM: usize = 1024;

/// Tasks that are run before it is seen whether that is enough.
const TASKS_AT_A_TIME: usize = 256;

/// The contacts between the triangles of `tree`, except those inside one star.
pub(super) fn pairs(
    tree: &Tree,
    surface: Surface<'_>,
    search: Search,
    budget: &Budget,
) -> Result<Contacts, Stopped> {
    let tasks = tasks(tree, surface);
    let mut all = Gathered::new(search);
    for tasks in tasks.chunks(TASKS_AT_A_TIME) {
        // All of them end before an error is passed on: whether the work limit is reached depends on their sum alone.
        let found = par::try_map_ranges(tasks.len(), 1, |i| {
            Descent { tree, surface, budget, found: Gathered::new(search), work: 0 }.run(tasks[i.start])
        })?;
        for contacts in found {
            all.merge(contacts);
            if all.is_enough() {
                return Ok(all.finish());
            }
        }
    }
    Ok(all.finish())
}

/// The first levels of the descent, in a fixed order.
fn tasks(tree: &Tree, surface: Surface<'_>) -> Vec<Pair> {
    let root = Pair { x: 0, y: 0, is_of_slivers: false };
    let mut tasks = if tree.is_empty() { Vec::new() } else { vec![root] };
    while tasks.len() < TASKS_AIM {
        let mut below = Vec::new();
        for &pair in &tasks {
            if !expand(tree, surface, pair, |next| below.push(next)) {
                below.push(pair);
            }
        }
        if below == tasks {
            break;
        }
        tasks = below;
    }
    tasks
}

/// Gives the pairs one level down that may meet; false at the lowest level.
#[inline]
fn expand(tree: &Tree, surface: Surface<'_>, pair: Pair, mut push: impl FnMut(Pair)) -> bool {
    let Pair { x, y, is_of_slivers } = pair;
    let (node_x, node_y) = (tree.node(x), tree.node(y));
    let mut push_meeting = |x: u32, y: u32| {
        if x == y || tree.node(x).bounds.meets(&tree.node(y).bounds) {
            push(Pair { x, y, is_of_slivers });
        }
    };
    match (node_x.children(), node_y.children()) {
        (None, _) if is_of_slivers => return false,
        (Some([left, right]), _) if is_of_slivers => {
            push_meeting(left, y);
            push_meeting(right, y);
        }
        (Some([left, right]), _) if x == y => {
            if !node_x.is_star() {
                push_meeting(left, right);
                push_meeting(left, left);
                push_meeting(right, right);
            }
        }
        _ if node_x.is_star() || node_y.is_star() => {
            let is_x_better = match (node_x.is_star(), node_y.is_star()) {
                (true, true) => probe(tree, surface, x, y) <= probe(tree, surface, y, x),
                (is_x, _) => is_x,
            };
            let (x, y) = if is_x_better { (x, y) } else { (y, x) };
            push(Pair { x, y, is_of_slivers: true });
        }
        (None, None) => return false,
        (Some([left, right]), None) => {
            push_meeting(left, y);
            push_meeting(right, y);
        }
        (None, Some([left, right])) => {
            push_meeting(x, left);
            push_meeting(x, right);
        }
        (Some(of_x), Some(of_y)) => {
            for a in of_x {
                for b in of_y {
                    push_meeting(a, b);
                }
            }
        }
    }
    true
}

/// Triangles that are tried to compare two directions.
const PROBES: usize = 8;

/// Nodes after which a probe ends.
const PROBE_NODES_MAX: usize = 1024;

/// How many nodes below `y` a few triangles of star `x` meet. The triangles of a cone meet few boxes of its floor, but
/// those of the floor meet every box of the cone at its axis.
fn probe(tree: &Tree, surface: Surface<'_>, x: u32, y: u32) -> usize {
    let mut visited = 0;
    for probe in 0..PROBES {
        let mut node = tree.node(x);
        let mut level = 0;
        while let Some(children) = node.children() {
            node = tree.node(children[probe >> (level % 3) & 1]);
            level += 1;
        }
        let sliver = Sliver::new(&surface.frame, surface.points(tree.leaf(node).corners(0)));
        let mut stack = vec![y];
        while let Some(other) = stack.pop().filter(|_| visited < PROBE_NODES_MAX) {
            visited += 1;
            let other = tree.node(other);
            if other.bounds.meets(&node.bounds) && sliver.may_meet(&other.bounds) {
                stack.extend(other.children().into_iter().flatten());
            }
        }
    }
    visited
}

/// The search below one pair of nodes.
struct Descent<'d> {
    tree: &'d Tree,
    surface: Surface<'d>,
    budget: &'d Budget,
    found: Gathered,
    /// Units not yet spent.
    work: u64,
}

impl Descent<'_> {
    fn run(mut self, start: Pair) -> Result<Contacts, Stopped> {
        let mut stack = vec![start];
        while let Some(pair) = stack.pop() {
            self.count(1)?;
            if !expand(self.tree, self.surface, pair, |next| stack.push(next)) {
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
        }
        self.budget.spend(self.work)?;
        Ok(self.found.finish())
    }

    fn count(&mut self, units: u64) -> Result<(), Stopped> {
        self.work += units;
        if self.work >= CHECK_EVERY as u64 {
            self.budget.spend(std::mem::take(&mut self.work))?;
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
            let sliver = Sliver::new(&self.surface.frame, self.surface.points(x.corners(i)));
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
        let plane = Plane::through(self.surface.points(corners).map(|p| *p));
        for j in meeting {
            self.count(1)?;
            if let Some(kind) = contact(&plane, self.surface.points(y.corners(j)), Shared::by_pairs(pairs[j]))
            {
                let (a, b) = (x.id(i), y.id(j));
                self.found.add(Contact { a: a.min(b), b: a.max(b), kind });
            }
        }
        Ok(())
    }
}
