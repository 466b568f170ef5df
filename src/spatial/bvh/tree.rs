//! A tree of boxes, stored flat.

use super::{Box32, Leaf};
use crate::par;

/// A box and what is inside it.
#[derive(Debug, Clone, Copy)]
pub(in crate::spatial) struct BoxNode {
    pub(in crate::spatial) bounds: Box32,
    /// Left child, or `NO_CHILD` in a leaf.
    left: u32,
    /// Right child, with the mark of a star; in a leaf its number.
    right: u32,
}

const NO_CHILD: u32 = u32::MAX;

/// Mark on the top node of a star. There are fewer nodes than triangles, hence fewer than 2^31.
const STAR: u32 = 1 << 31;

impl BoxNode {
    pub(super) const UNSET: Self = Self::leaf(Box32::EMPTY, 0);

    pub(super) const fn leaf(bounds: Box32, number: u32) -> Self {
        Self { bounds, left: NO_CHILD, right: number }
    }

    pub(super) const fn inner(bounds: Box32, [left, right]: [u32; 2]) -> Self {
        Self { bounds, left, right }
    }

    /// Both children, unless it is a leaf.
    #[inline]
    pub(in crate::spatial) fn children(&self) -> Option<[u32; 2]> {
        (self.left != NO_CHILD).then_some([self.left, self.right & !STAR])
    }

    /// True for the top node of a star.
    #[inline]
    pub(in crate::spatial) fn is_star(&self) -> bool {
        self.left != NO_CHILD && self.right & STAR != 0
    }

    /// The same as the top node of a star.
    pub(super) fn as_star(self) -> Self {
        Self { right: self.right | STAR, ..self }
    }

    /// The number of a leaf.
    pub(super) fn leaf_number(&self) -> Option<u32> {
        (self.left == NO_CHILD).then_some(self.right)
    }

    fn moved(self, nodes_by: u32, leaves_by: u32) -> Self {
        match self.children() {
            Some([left, right]) => Self::inner(self.bounds, [left + nodes_by, right + nodes_by]),
            None => Self::leaf(self.bounds, self.right + leaves_by),
        }
    }
}

/// Boxes of elements with ids. The root, if there is one, is node 0.
#[derive(Debug, Clone, Default)]
pub(in crate::spatial) struct Tree {
    pub(super) nodes: Vec<BoxNode>,
    pub(super) leaves: Vec<Leaf>,
}

impl Tree {
    /// Most nodes from the root to a leaf: halving takes at most 32 steps, in a forest and again in one of its trees,
    /// and above both is one joint.
    pub(in crate::spatial) const DEPTH_MAX: usize = 66;

    /// One tree of both, of which the second is not empty; and the place of the root of that.
    pub(super) fn join(first: &Self, second: &Self) -> (Self, u32) {
        if first.is_empty() {
            return (second.clone(), 0);
        }
        let mut joint = Self { nodes: vec![BoxNode::UNSET], leaves: Vec::new() };
        let children = [joint.append(first), joint.append(second)];
        let bounds = first.nodes[0].bounds.union(&second.nodes[0].bounds);
        joint.nodes[0] = BoxNode::inner(bounds, children);
        (joint, children[1])
    }

    /// Adds the nodes of another tree; gives the place of its root.
    pub(super) fn append(&mut self, tree: &Self) -> u32 {
        let (nodes_by, leaves_by) = (self.nodes.len() as u32, self.leaves.len() as u32);
        let is_star = |node: &BoxNode| if node.is_star() { STAR } else { 0 };
        self.nodes.extend(tree.nodes.iter().map(|node| {
            let moved = node.moved(nodes_by, leaves_by);
            BoxNode { right: moved.right | is_star(node), ..moved }
        }));
        self.leaves.extend(&tree.leaves);
        nodes_by
    }

    /// The triangles in it, ascending.
    pub(super) fn ids(&self) -> Vec<u32> {
        let mut ids: Vec<u32> =
            self.leaves.iter().flat_map(|leaf| (0..leaf.len()).map(|k| leaf.id(k))).collect();
        par::sort_unstable(&mut ids);
        ids
    }

    pub(in crate::spatial) fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Number of nodes.
    pub(in crate::spatial) fn len(&self) -> u32 {
        self.nodes.len() as u32
    }

    /// The nodes below the root of a star, each before its children.
    pub(in crate::spatial) fn below(&self, root: u32) -> std::ops::Range<u32> {
        let Some([first, mut last]) = self.node(root).children() else { return 0..0 };
        while let Some([_, right]) = self.node(last).children() {
            last = right;
        }
        first..last + 1
    }

    #[inline]
    pub(in crate::spatial) fn node(&self, id: u32) -> &BoxNode {
        &self.nodes[id as usize]
    }

    /// The triangles of a node without children.
    #[inline]
    pub(in crate::spatial) fn leaf(&self, node: &BoxNode) -> &Leaf {
        &self.leaves[node.right as usize]
    }
}
