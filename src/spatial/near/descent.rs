//! Simultaneous descent of a tree of grown boxes with itself.

use super::features::SearchedFaces;
use super::{NearPair, NearPairs};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::par;
use crate::spatial::bvh::{Leaf, Sliver, Tree};
use crate::spatial::pairs::{Pair, expand, tasks};

/// Pairs of nodes that the descent starts from: enough for many threads, fixed, so that results do not depend on them.
const TASKS_AIM: usize = 512;

/// Tasks that are run before it is seen whether that was too much.
const TASKS_AT_A_TIME: usize = 16;

/// Most pairs kept of each task; more are counted.
const KEEP: usize = 1024;

/// A task may use this share of all work.
const SHARE_OF_TASK: u64 = 8;

/// Units of work for two triangles whose features are compared, beside that of their boxes.
const COMPARE_UNITS: u64 = 12;

/// What a search found, and how many pairs of boxes it looked at.
pub(super) type Searched = (NearPairs, u64);

/// All near features of the triangles of `tree` but those inside one star; `None` after `work_max` pairs of boxes.
pub(super) fn search<F: Fn(u32, [u32; 2]) -> bool + Sync>(
    tree: &Tree,
    faces: &SearchedFaces<'_, F>,
    work_max: u64,
    budget: &Budget,
) -> Result<Option<Searched>, Stopped> {
    let tasks = tasks(tree, TASKS_AIM, &|leaf, i| faces.sliver(leaf, i));
    let (mut all, mut work) = (NearPairs::default(), 0);
    for tasks in tasks.chunks(TASKS_AT_A_TIME) {
        let found = par::try_map_ranges(tasks.len(), 1, |i| {
            NearDescent { tree, faces, work_max: work_max.div_ceil(SHARE_OF_TASK), budget }
                .run(tasks[i.start])
        })?;
        for of_task in found {
            let Some((found, its_work)) = of_task else { return Ok(None) };
            work += its_work;
            all.add(found);
        }
        if work > work_max {
            return Ok(None);
        }
    }
    Ok(Some((all, work)))
}

/// The search below one pair of nodes.
struct NearDescent<'d, F> {
    tree: &'d Tree,
    faces: &'d SearchedFaces<'d, F>,
    work_max: u64,
    budget: &'d Budget,
}

impl<F: Fn(u32, [u32; 2]) -> bool + Sync> NearDescent<'_, F> {
    /// What was found and how many pairs of boxes were looked at; `None` when those were too many.
    fn run(&self, start: Pair) -> Result<Option<Searched>, Stopped> {
        let mut stack = vec![start];
        let (mut found, mut work, mut compared, mut spent) = (NearPairs::default(), 0u64, 0u64, 0u64);
        let mut add = |pair: NearPair| {
            found.counts[pair.kind as usize] += 1;
            if found.list.len() < KEEP {
                found.list.push(pair);
            }
        };
        while let Some(pair) = stack.pop() {
            work += 1;
            let sliver = |leaf: &Leaf, i: usize| self.faces.sliver(leaf, i);
            if !expand(self.tree, &sliver, pair, |next| stack.push(next)) {
                let (boxes, pairs) = match pair.is_of_slivers {
                    true => self.one_by_one(pair, &sliver, &mut add),
                    false => (0, self.leaves(pair, &mut add)),
                };
                work += boxes + pairs;
                compared += pairs;
            }
            let units = work + COMPARE_UNITS * compared;
            if units - spent >= CHECK_EVERY as u64 {
                self.budget.spend(units - spent)?;
                spent = units;
            }
            if work > self.work_max {
                return Ok(None);
            }
        }
        self.budget.spend(work + COMPARE_UNITS * compared - spent)?;
        Ok(Some((found, work)))
    }

    /// Compares the triangles of two leaves, or those of one with each other; how many pairs.
    fn leaves(&self, Pair { x, y, .. }: Pair, add: &mut impl FnMut(NearPair)) -> u64 {
        let [of_x, of_y] = [x, y].map(|node| self.tree.leaf(self.tree.node(node)));
        let mut work = 0;
        for i in 0..of_x.len() {
            let meeting = of_y.meeting(&of_x.bounds(i));
            for j in if x == y { meeting.after(i) } else { meeting } {
                work += 1;
                let (f, g) = (of_x.id(i), of_y.id(j));
                self.faces.compare([f.min(g), f.max(g)], add);
            }
        }
        work
    }

    /// Compares each triangle of leaf `x` with those below node `y`: how many nodes it looked at, and how many pairs.
    fn one_by_one(
        &self,
        Pair { x, y, .. }: Pair,
        sliver: &impl Fn(&Leaf, usize) -> Sliver,
        add: &mut impl FnMut(NearPair),
    ) -> (u64, u64) {
        let of_x = self.tree.leaf(self.tree.node(x));
        let (mut nodes, mut pairs, mut stack) = (0, 0, Vec::with_capacity(Tree::DEPTH_MAX));
        for i in 0..of_x.len() {
            let (bounds, sliver) = (of_x.bounds(i), sliver(of_x, i));
            stack.push(y);
            while let Some(node) = stack.pop() {
                nodes += 1;
                let node = self.tree.node(node);
                if !(node.bounds.meets(&bounds) && sliver.may_meet(&node.bounds)) {
                    continue;
                }
                if let Some(children) = node.children() {
                    stack.extend(children);
                    continue;
                }
                let of_y = self.tree.leaf(node);
                for j in of_y.meeting(&bounds) {
                    pairs += 1;
                    let (f, g) = (of_x.id(i), of_y.id(j));
                    self.faces.compare([f.min(g), f.max(g)], add);
                }
            }
        }
        (nodes, pairs)
    }
}
