//! How a tree is built: top-down, split at medians.
//!
//! Every node is split at the median of the centres along their longest extent, by count in whole leaves. Equal points
//! and outliers cannot unbalance the tree, places in the flat lists follow from counts alone (so halves are built at
//! the same time), and the result depends on the set of elements only.

use super::frame::Box32;
use super::leaf::Leaf;
use super::tree::{BoxNode, Tree};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::par;

/// What a tree is built over.
pub(in crate::spatial) trait Elements: Sync {
    /// Number of elements.
    fn len(&self) -> usize;
    /// Id of the element at `place`; all different.
    fn id(&self, place: usize) -> u32;
    /// Box of the element with this id.
    fn bounds(&self, id: u32) -> Box32;
    /// What the element is sorted by, so that neighbours in the tree are near each other.
    fn center(&self, id: u32) -> [f32; 3] {
        self.bounds(id).center()
    }
    /// Vertices of the element with this id.
    fn corners(&self, id: u32) -> [u32; 3];
}

/// Leaves up to which a subtree is built without a check of the budget and by one thread.
const SERIAL_LEAVES_MAX: usize = CHECK_EVERY / 4;

/// Builds over `elements`, `leaf_len` to a leaf.
pub(super) fn tree(elements: &impl Elements, leaf_len: usize, budget: &Budget) -> Result<Tree, Stopped> {
    let count = elements.len();
    if count == 0 {
        return Ok(Tree::default());
    }
    let leaf_count = count.div_ceil(leaf_len);
    let per_leaf = leaf_len * size_of::<BuildItem>() + 2 * size_of::<BoxNode>() + size_of::<Leaf>();
    let _charge = budget.charge(leaf_count as u64 * per_leaf as u64)?;
    let mut items = vec![BuildItem::default(); count];
    par::for_each_chunk_mut(&mut items, CHECK_EVERY, |begin, items| {
        // A stop is noticed again, and passed on, below.
        if budget.check().is_ok() {
            for (i, item) in items.iter_mut().enumerate() {
                let id = elements.id(begin + i);
                *item = BuildItem::new(id, elements.center(id));
            }
        }
    });
    budget.check()?;
    let mut nodes = vec![BoxNode::UNSET; 2 * leaf_count - 1];
    let mut leaves = vec![Leaf::EMPTY; leaf_count];
    let part = SubtreeSlices { nodes: &mut nodes, leaves: &mut leaves, first_node: 0, first_leaf: 0 };
    Builder { elements, leaf_len, budget }.split(&mut items, part)?;
    Ok(Tree { nodes, leaves })
}

/// An element while the tree is built.
#[derive(Clone, Copy, Default)]
struct BuildItem {
    /// Centre of its box, as integers in the order of the numbers.
    center: [i32; 3],
    id: i32,
}

impl BuildItem {
    fn new(id: u32, center: [f32; 3]) -> Self {
        Self { center: center.map(|x| in_order(x.to_bits() as i32)), id: id as i32 }
    }

    fn id(&self) -> u32 {
        self.id as u32
    }

    /// By the coordinate, then by id: no two items are equal.
    #[inline]
    fn key<const AXIS: usize>(&self) -> i64 {
        i64::from(self.center[AXIS]) << 32 | i64::from(self.id())
    }
}

/// The bits of a number as an integer in the same order, and back.
fn in_order(bits: i32) -> i32 {
    bits ^ (bits >> 31 & i32::MAX)
}

/// The places of a subtree in the flat lists: its root first, then the left subtree, then the right one.
struct SubtreeSlices<'t> {
    nodes: &'t mut [BoxNode],
    leaves: &'t mut [Leaf],
    first_node: u32,
    first_leaf: u32,
}

struct Builder<'b, E> {
    elements: &'b E,
    leaf_len: usize,
    budget: &'b Budget,
}

impl<E: Elements> Builder<'_, E> {
    /// Builds the subtree of `items`. Recursive: each level halves the number of leaves, so at most 32 deep.
    fn split(&self, items: &mut [BuildItem], part: SubtreeSlices<'_>) -> Result<Box32, Stopped> {
        let SubtreeSlices { nodes, leaves, first_node, first_leaf } = part;
        if let [leaf] = leaves {
            let bounds = self.fill(items, leaf);
            nodes[0] = BoxNode::leaf(bounds, first_leaf);
            return Ok(bounds);
        }
        let is_serial = leaves.len() <= SERIAL_LEAVES_MAX;
        let leaves_left = leaves.len().div_ceil(2);
        let middle = leaves_left * self.leaf_len;
        partition(items, middle);
        let (items_left, items_right) = items.split_at_mut(middle);
        let (root, below) = nodes.split_at_mut(1);
        let (nodes_left, nodes_right) = below.split_at_mut(2 * leaves_left - 1);
        let (leaves_left, leaves_right) = leaves.split_at_mut(leaves_left);
        let left =
            SubtreeSlices { first_node: first_node + 1, first_leaf, nodes: nodes_left, leaves: leaves_left };
        let right = SubtreeSlices {
            first_node: left.first_node + left.nodes.len() as u32,
            first_leaf: first_leaf + left.leaves.len() as u32,
            nodes: nodes_right,
            leaves: leaves_right,
        };
        let children = [left.first_node, right.first_node];
        let (left, right) = if is_serial {
            (self.split(items_left, left), self.split(items_right, right))
        } else {
            self.budget.check()?;
            par::join(|| self.split(items_left, left), || self.split(items_right, right))
        };
        let bounds = left?.union(&right?);
        root[0] = BoxNode::inner(bounds, children);
        Ok(bounds)
    }

    fn fill(&self, items: &mut [BuildItem], leaf: &mut Leaf) -> Box32 {
        items.sort_unstable_by_key(BuildItem::id);
        let mut bounds = Box32::EMPTY;
        for (k, id) in items.iter().map(BuildItem::id).enumerate() {
            let item_bounds = self.elements.bounds(id);
            leaf.set(k, id, &item_bounds, self.elements.corners(id));
            bounds = bounds.union(&item_bounds);
        }
        bounds
    }
}

/// Moves the items with the smallest centres, along the longest extent of all centres, before `middle`.
fn partition(items: &mut [BuildItem], middle: usize) {
    match longest_extent(items) {
        0 => items.select_nth_unstable_by_key(middle, BuildItem::key::<0>),
        1 => items.select_nth_unstable_by_key(middle, BuildItem::key::<1>),
        _ => items.select_nth_unstable_by_key(middle, BuildItem::key::<2>),
    };
}

fn longest_extent(items: &[BuildItem]) -> usize {
    let (mut min, mut max) = ([i32::MAX; 4], [i32::MIN; 4]);
    for item in items {
        // The id rides along: four lanes are one instruction, three are not.
        let [x, y, z] = item.center;
        for (k, value) in [x, y, z, item.id].into_iter().enumerate() {
            min[k] = min[k].min(value);
            max[k] = max[k].max(value);
        }
    }
    let number = |x: i32| f32::from_bits(in_order(x) as u32);
    let length = |axis: usize| number(max[axis]) - number(min[axis]);
    let longer = |a: usize, b: usize| if length(b) > length(a) { b } else { a };
    longer(longer(0, 1), 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_in_the_order_of_numbers_come_back_as_the_same_numbers() {
        let numbers = [f32::MIN, -1.5, -1.0, -f32::MIN_POSITIVE, 0.0, 1e-40, 1.0, f32::MAX];
        let integers = numbers.map(|x| in_order(x.to_bits() as i32));
        assert!(integers.is_sorted());
        assert_eq!(integers.map(|i| f32::from_bits(in_order(i) as u32)), numbers);
    }
}
