//! Pairs of nodes of a tree, from the root down, for all pairs of triangles but those inside one star.
//!
//! A `sliver` is a triangle of a leaf, to compare it with boxes instead of its own.

use super::bvh::{Leaf, Sliver, Tree};

/// Two nodes whose triangles may meet; the same node twice for the pairs inside it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pair {
    pub(super) x: u32,
    pub(super) y: u32,
    /// The triangles in `x` are those of a star, long and thin; they go down into `y` one by one.
    pub(super) is_of_slivers: bool,
}

/// The first levels of the descent, in a fixed order.
pub(super) fn tasks(tree: &Tree, aim: usize, sliver: &impl Fn(&Leaf, usize) -> Sliver) -> Vec<Pair> {
    let root = Pair { x: 0, y: 0, is_of_slivers: false };
    let mut tasks = if tree.is_empty() { Vec::new() } else { vec![root] };
    while tasks.len() < aim {
        let mut below = Vec::new();
        for &pair in &tasks {
            if !expand(tree, sliver, pair, |next| below.push(next)) {
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
pub(super) fn expand(
    tree: &Tree,
    sliver: &impl Fn(&Leaf, usize) -> Sliver,
    pair: Pair,
    mut push: impl FnMut(Pair),
) -> bool {
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
                (true, true) => probe(tree, sliver, x, y) <= probe(tree, sliver, y, x),
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
fn probe(tree: &Tree, sliver: &impl Fn(&Leaf, usize) -> Sliver, x: u32, y: u32) -> usize {
    let mut visited = 0;
    for probe in 0..PROBES {
        let mut node = tree.node(x);
        let mut level = 0;
        while let Some(children) = node.children() {
            node = tree.node(children[probe >> (level % 3) & 1]);
            level += 1;
        }
        let sliver = sliver(tree.leaf(node), 0);
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
