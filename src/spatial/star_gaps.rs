//! How far a point is from the triangles of a star, by their directions from its hub.
//!
//! The boxes of a fan of long thin triangles hold each other's middles, so that a point on it is near all of them. Seen
//! from the hub it is near a few: what is seen in directions that make at least an angle with that of the point is at
//! least as far as the ray at that angle.

use super::Bvh;
use super::bvh::{Box32, Tree};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{DVec3, arc_box, direction};

/// What is in no star.
pub(super) const NO_STAR: u32 = u32::MAX;

/// The directions of the stars of a hierarchy.
#[derive(Debug, Clone)]
pub(super) struct StarGaps {
    /// Where each star's tree begins, with its hub; by ascending node.
    roots: Vec<(u32, DVec3)>,
    /// The node that the first of `directions` is of.
    first_node: u32,
    /// Around the directions of what the nodes of stars hold.
    directions: Vec<Box32>,
}

impl StarGaps {
    /// The stars of `bvh`. O(n).
    pub(super) fn of(bvh: &Bvh, positions: &[DVec3], budget: &Budget) -> Result<Self, Stopped> {
        let tree = bvh.tree();
        let hubs = bvh.stars().iter().map(|star| star.hub);
        let mut roots: Vec<(u32, u32)> = bvh.star_roots().iter().copied().zip(hubs).collect();
        roots.sort_unstable();
        let first_node = roots.first().map_or(tree.len(), |&(root, _)| root);
        let mut directions = vec![Box32::EMPTY; (tree.len() - first_node) as usize];
        let place = |node: u32| (node - first_node) as usize;
        for (k, &(root, hub)) in roots.iter().enumerate() {
            if k % CHECK_EVERY == 0 {
                budget.check()?;
            }
            // Every node comes before its children; the root was put elsewhere, before all of them.
            for node in tree.below(root).rev().chain([root]) {
                directions[place(node)] = match tree.node(node).children() {
                    Some([left, right]) => directions[place(left)].union(&directions[place(right)]),
                    None => leaf_directions(tree, node, hub, positions),
                };
            }
        }
        let roots = roots.into_iter().map(|(root, hub)| (root, positions[hub as usize])).collect();
        Ok(Self { roots, first_node, directions })
    }

    /// The star that begins at a node.
    pub(super) fn star_at(&self, node: u32) -> u32 {
        self.roots.binary_search_by_key(&node, |root| root.0).map_or(NO_STAR, |star| star as u32)
    }
}

/// The directions of what a leaf holds.
fn leaf_directions(tree: &Tree, node: u32, hub: u32, positions: &[DVec3]) -> Box32 {
    let leaf = tree.leaf(tree.node(node));
    (0..leaf.len()).fold(Box32::EMPTY, |all, k| {
        let corners = leaf.corners(k);
        let i = corners.iter().position(|&v| v == hub).unwrap_or(0);
        let [at, q, r] = [0, 1, 2].map(|k| positions[corners[(i + k) % 3] as usize]);
        all.union(&Box32::around(arc_box(at, q, r)))
    })
}

/// A point as it is seen from the hub of a star.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sighting {
    pub(super) star: u32,
    /// `None` at the hub itself.
    unit: Option<DVec3>,
    distance: f64,
}

impl Sighting {
    pub(super) fn new(gaps: &StarGaps, star: u32, p: DVec3) -> Self {
        let hub = gaps.roots[star as usize].1;
        Self { star, unit: direction(hub, p), distance: p.distance(hub) }
    }

    /// No point of what a node of the star holds is nearer than this, up to rounding.
    pub(super) fn gap(&self, gaps: &StarGaps, node: u32) -> f64 {
        let Some(unit) = self.unit else { return 0.0 };
        let bounds = gaps.directions[(node - gaps.first_node) as usize];
        let (min, max) = (bounds.min.map(f64::from), bounds.max.map(f64::from));
        let [min, max] = [min, max].map(DVec3::from_array);
        // The chord between two unit vectors is twice the sine of half their angle; beyond a right angle the hub is
        // nearest.
        let chord_squared = (min - unit).max(unit - max).max(DVec3::ZERO).length_squared().min(2.0);
        self.distance * (chord_squared * (1.0 - chord_squared / 4.0)).sqrt()
    }
}
