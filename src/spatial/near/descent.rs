//! Simultaneous descent of a tree of grown boxes with itself.

use super::features::Faces;
use super::{NearPair, NearPairs};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::par;
use crate::spatial::bvh::Tree;

/// Pairs of nodes that the descent starts from: enough for many threads, fixed, so that results do not depend on them.
const TASKS_AIM: usize = 512;

/// Most pairs kept of each task; more are counted.
const KEEP: usize = 1024;

/// A task may use this share of all work.
const SHARE_OF_TASK: u64 = 8;

/// All near features of the triangles of `tree`; `None` after `work_max` pairs of boxes.
pub(super) fn search<F: Fn(u32, [u32; 2]) -> bool + Sync>(
    tree: &Tree,
    faces: &Faces<'_, F>,
    work_max: u64,
    budget: &Budget,
) -> Result<Option<NearPairs>, Stopped> {
    let tasks = tasks(tree);
    let found = par::try_map_ranges(tasks.len(), 1, |i| {
        Descent { tree, faces, work_max: work_max.div_ceil(SHARE_OF_TASK), budget }.run(tasks[i.start])
    })?;
    let (mut all, mut work) = (NearPairs::default(), 0);
    for of_task in found {
        let Some((found, its_work)) = of_task else { return Ok(None) };
        work += its_work;
        for (sum, count) in all.counts.iter_mut().zip(found.counts) {
            *sum += count;
        }
        all.list.extend(found.list);
    }
    Ok((work <= work_max).then_some(all))
}

/// The first levels of the descent, in a fixed order.
fn tasks(tree: &Tree) -> Vec<[u32; 2]> {
    let mut tasks = if tree.is_empty() { Vec::new() } else { vec![[0, 0]] };
    while tasks.len() < TASKS_AIM {
        let mut below = Vec::new();
        for &pair in &tasks {
            if !expand(tree, pair, |next| below.push(next)) {
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

/// Gives the pairs one level down whose boxes meet; false at the lowest level.
#[inline]
fn expand(tree: &Tree, [x, y]: [u32; 2], mut push: impl FnMut([u32; 2])) -> bool {
    let mut push_meeting = |x: u32, y: u32| {
        if x == y || tree.node(x).bounds.meets(&tree.node(y).bounds) {
            push([x, y]);
        }
    };
    match (tree.node(x).children(), tree.node(y).children()) {
        (None, None) => return false,
        (Some([left, right]), _) if x == y => {
            push_meeting(left, right);
            push_meeting(left, left);
            push_meeting(right, right);
        }
        (Some(of_x), None) => of_x.into_iter().for_each(|a| push_meeting(a, y)),
        (None, Some(of_y)) => of_y.into_iter().for_each(|b| push_meeting(x, b)),
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

/// The search below one pair of nodes.
struct Descent<'d, F> {
    tree: &'d Tree,
    faces: &'d Faces<'d, F>,
    work_max: u64,
    budget: &'d Budget,
}

impl<F: Fn(u32, [u32; 2]) -> bool + Sync> Descent<'_, F> {
    /// What was found and how many pairs of boxes were looked at; `None` when those were too many.
    fn run(&self, start: [u32; 2]) -> Result<Option<(NearPairs, u64)>, Stopped> {
        let mut stack = vec![start];
        let (mut found, mut work, mut spent) = (NearPairs::default(), 0u64, 0u64);
        let mut add = |pair: NearPair| {
            found.counts[pair.kind as usize] += 1;
            if found.list.len() < KEEP {
                found.list.push(pair);
            }
        };
        while let Some(pair) = stack.pop() {
            work += 1;
            if !expand(self.tree, pair, |next| stack.push(next)) {
                work += self.leaves(pair, &mut add);
            }
            if work - spent >= CHECK_EVERY as u64 {
                self.budget.spend(work - spent)?;
                spent = work;
            }
            if work > self.work_max {
                return Ok(None);
            }
        }
        self.budget.spend(work - spent)?;
        Ok(Some((found, work)))
    }

    /// Compares the triangles of two leaves, or those of one with each other; how many pairs.
    fn leaves(&self, [x, y]: [u32; 2], add: &mut impl FnMut(NearPair)) -> u64 {
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
}
