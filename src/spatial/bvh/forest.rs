//! Trees over elements, and a tree of trees.

use super::Box32;
use super::build::{Elements, tree};
use super::leaf::LEAF_LEN;
use super::tree::Tree;
use crate::budget::{Budget, Stopped};

impl Tree {
    /// Builds over `elements`. O(n log n).
    pub(in crate::spatial) fn build(elements: &impl Elements, budget: &Budget) -> Result<Self, Stopped> {
        tree(elements, LEAF_LEN, budget)
    }

    /// A tree of trees, none of them a single leaf, each marked as a star; and the place of each one's root.
    pub(super) fn forest(trees: &[Self], budget: &Budget) -> Result<(Self, Vec<u32>), Stopped> {
        let top = tree(&Roots(trees), 1, budget)?;
        let mut roots = vec![0; trees.len()];
        let mut forest = Self { nodes: top.nodes, leaves: Vec::new() };
        for place in 0..forest.nodes.len() {
            if let Some(leaf) = forest.nodes[place].leaf_number() {
                let number = top.leaves[leaf as usize].id(0) as usize;
                roots[number] = place as u32;
                let root = forest.append(&trees[number]);
                forest.nodes[place] = forest.nodes[root as usize].as_star();
            }
        }
        Ok((forest, roots))
    }
}

/// Trees as the elements of a tree.
struct Roots<'t>(&'t [Tree]);

impl Elements for Roots<'_> {
    fn len(&self) -> usize {
        self.0.len()
    }

    fn id(&self, place: usize) -> u32 {
        place as u32
    }

    fn bounds(&self, id: u32) -> Box32 {
        self.0[id as usize].nodes[0].bounds
    }

    fn corners(&self, _: u32) -> [u32; 3] {
        [0; 3]
    }
}
