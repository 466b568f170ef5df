//! Vertices with so many triangles that their pairs must not be enumerated.

use super::build::Elements;
use super::frame::Box32;
use super::tree::Tree;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{DVec3, direction};

/// Triangles around one vertex up to which all their pairs may be looked at: 32 for each triangle.
const VALENCE_MAX: u32 = 64;

/// The triangles of a subtree that all have one vertex in common. A triangle is in one star at most: that of its
/// corner with the most triangles.
#[derive(Debug, Clone)]
pub(in crate::spatial) struct HubStar {
    /// The common vertex.
    pub(in crate::spatial) hub: u32,
    /// In the order they were given.
    pub(in crate::spatial) triangles: Vec<u32>,
}

/// The stars among `triangles`, by ascending hub.
pub(in crate::spatial) fn find(
    vertex_count: usize,
    triangles: &impl Elements,
    budget: &Budget,
) -> Result<Vec<HubStar>, Stopped> {
    let count = triangles.len();
    if count <= VALENCE_MAX as usize {
        return Ok(Vec::new());
    }
    let _charge = budget.charge(vertex_count as u64 * 4)?;
    let mut valence = vec![0u32; vertex_count];
    let mut largest = 0;
    for i in 0..count {
        if i.is_multiple_of(CHECK_EVERY) {
            budget.check()?;
        }
        for v in triangles.corners(triangles.id(i)) {
            valence[v as usize] += 1;
            largest = largest.max(valence[v as usize]);
        }
    }
    if largest <= VALENCE_MAX {
        return Ok(Vec::new());
    }
    let hubs: Vec<u32> = (0..vertex_count as u32).filter(|&v| valence[v as usize] > VALENCE_MAX).collect();
    let mut stars: Vec<HubStar> = hubs.iter().map(|&hub| HubStar { hub, triangles: Vec::new() }).collect();
    for i in 0..count {
        if i.is_multiple_of(CHECK_EVERY) {
            budget.check()?;
        }
        let id = triangles.id(i);
        let hub = hub_of(triangles.corners(id), &valence);
        if let Ok(star) = hubs.binary_search(&hub) {
            stars[star].triangles.push(id);
        }
    }
    stars.retain(|star| star.triangles.len() > VALENCE_MAX as usize);
    Ok(stars)
}

/// The corner with the most triangles; of several the one with the smallest id.
fn hub_of(corners: [u32; 3], valence: &[u32]) -> u32 {
    let [a, b, c] = corners.map(|v| (std::cmp::Reverse(valence[v as usize]), v));
    a.min(b).min(c).1
}

/// The tree of all `triangles`, with each star in a subtree of its own, and the nodes at which they begin. All ids are below
/// `id_end`.
pub(in crate::spatial) fn tree(
    stars: &[HubStar],
    id_end: usize,
    positions: &[DVec3],
    triangles: &impl Elements,
    budget: &Budget,
) -> Result<(Tree, Vec<u32>), Stopped> {
    if stars.is_empty() {
        return Ok((Tree::build(triangles, budget)?, Vec::new()));
    }
    let rest = all_others(stars, id_end, triangles);
    let rest = Tree::build(&Chosen { triangles, ids: &rest, positions, hub: None }, budget)?;
    let mut trees = Vec::with_capacity(stars.len());
    for star in stars {
        let hub = Some(positions[star.hub as usize]);
        trees.push(Tree::build(&Chosen { triangles, ids: &star.triangles, positions, hub }, budget)?);
    }
    let (forest, mut roots) = Tree::forest(&trees, budget)?;
    let (tree, first) = Tree::join(&rest, &forest);
    roots.iter_mut().for_each(|root| *root += first);
    Ok((tree, roots))
}

/// The triangles that are in no star; all ids are below `id_end`.
pub(super) fn all_others(stars: &[HubStar], id_end: usize, triangles: &impl Elements) -> Vec<u32> {
    let mut is_in_star = vec![false; id_end];
    for &id in stars.iter().flat_map(|s| &s.triangles) {
        is_in_star[id as usize] = true;
    }
    (0..triangles.len()).map(|place| triangles.id(place)).filter(|&id| !is_in_star[id as usize]).collect()
}

/// Some of the triangles. Those of a star are sorted by their directions from its hub.
struct Chosen<'c, E> {
    triangles: &'c E,
    ids: &'c [u32],
    positions: &'c [DVec3],
    hub: Option<DVec3>,
}

impl<E: Elements> Elements for Chosen<'_, E> {
    fn len(&self) -> usize {
        self.ids.len()
    }

    fn id(&self, place: usize) -> u32 {
        self.ids[place]
    }

    fn bounds(&self, id: u32) -> Box32 {
        self.triangles.bounds(id)
    }

    fn center(&self, id: u32) -> [f32; 3] {
        let Some(hub) = self.hub else { return self.triangles.center(id) };
        let [a, b, c] = self.corners(id).map(|v| self.positions[v as usize]);
        let unit = direction(hub, a / 3.0 + b / 3.0 + c / 3.0).unwrap_or(DVec3::ZERO);
        unit.to_array().map(|x| x as f32)
    }

    fn corners(&self, id: u32) -> [u32; 3] {
        self.triangles.corners(id)
    }
}
