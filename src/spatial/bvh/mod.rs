//! Bounding volume hierarchy over triangles.
//!
//! The triangles around a vertex with very many of them (the hub of a fan, the pole of a sphere) are kept in a subtree
//! of their own, a *star*. Their boxes all meet at the hub, so a search for pairs must be able to leave them out as a
//! whole; see [`super::self_contacts`].

mod build;
mod forest;
mod frame;
mod leaf;
mod line;
mod sliver;
mod stars;
mod tree;
mod turned;

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3};
pub(super) use build::Elements;
pub(super) use frame::{Box32, Frame};
pub(super) use leaf::{Lanes, Leaf};
use line::BoxSegment;
pub(super) use sliver::Sliver;
pub(super) use stars::{HubStar, find as stars_of, tree as tree_with_stars};
pub(super) use tree::Tree;
pub(super) use turned::TurnedTree;

/// Boxes of triangles in a balanced tree: small flat nodes, f32 boxes that hold the exact ones.
#[derive(Debug, Clone)]
pub struct Bvh {
    frame: Frame,
    tree: Tree,
    stars: Vec<HubStar>,
    /// The node at which each star begins.
    star_roots: Vec<u32>,
}

impl Bvh {
    /// Bytes for each triangle: a leaf's share, and that of the nodes above, of which some are half empty.
    pub const BYTES_PER_TRIANGLE: u64 = 64;

    /// Builds over the triangles `ids` (all when `None`), whose positions must be finite. O(n log n).
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn build(
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        ids: Option<&[u32]>,
        budget: &Budget,
    ) -> Result<Self, Stopped> {
        let frame = Frame::UNIT;
        let mut all = IndexedTriangles { positions, triangles, ids, frame };
        all.frame = Frame::around(all.len(), |place| positions[all.corners(all.id(place))[0] as usize]);
        let stars = stars::find(positions.len(), &all, budget)?;
        let (tree, star_roots) = stars::tree(&stars, triangles.len(), positions, &all, budget)?;
        Ok(Self { frame: all.frame, tree, stars, star_roots })
    }

    /// Calls `visit` with the id of each triangle whose box may meet `query`, in an order that depends on the mesh
    /// alone. None that meets it is left out; a few that barely miss it may be in.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn visit_box(&self, query: Aabb, budget: &Budget, visit: impl FnMut(u32)) -> Result<(), Stopped> {
        let query = self.frame.box_of([query.min, query.max]);
        self.visit(|bounds| bounds.meets(&query), query, budget, all(visit))
    }

    /// Whether `is_wanted` is true of a triangle that [`visit_box`](Self::visit_box) would visit; none after it is visited.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn any_in_box(
        &self,
        query: Aabb,
        budget: &Budget,
        mut is_wanted: impl FnMut(u32) -> bool,
    ) -> Result<bool, Stopped> {
        let query = self.frame.box_of([query.min, query.max]);
        let mut is_any = false;
        let visit = |triangle| {
            is_any = is_wanted(triangle);
            !is_any
        };
        self.visit(|bounds| bounds.meets(&query), query, budget, visit)?;
        Ok(is_any)
    }

    /// As [`visit_box`](Self::visit_box) for the segment between two points, until `visit` is false.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn visit_segment(
        &self,
        [from, to]: [DVec3; 2],
        budget: &Budget,
        visit: impl FnMut(u32) -> bool,
    ) -> Result<(), Stopped> {
        let (query, line) = (self.frame.box_of([from, to]), BoxSegment::new(&self.frame, [from, to]));
        self.visit(|bounds| bounds.meets(&query) && line.may_meet(bounds), query, budget, visit)
    }

    /// As [`visit_box`](Self::visit_box) for the ray from `start` towards +z.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn visit_upward_ray(
        &self,
        start: DVec3,
        budget: &Budget,
        visit: impl FnMut(u32),
    ) -> Result<(), Stopped> {
        let query = self.frame.box_of([start, start.with_z(f64::MAX)]);
        self.visit(|bounds| bounds.meets(&query), query, budget, all(visit))
    }

    /// Calls `visit` with the triangles whose boxes meet `query` in nodes that may hold what is looked for.
    fn visit(
        &self,
        may_hold: impl Fn(&Box32) -> bool,
        query: Box32,
        budget: &Budget,
        mut visit: impl FnMut(u32) -> bool,
    ) -> Result<(), Stopped> {
        let mut stack = [0u32; Tree::DEPTH_MAX + 1];
        let mut depth = usize::from(!self.tree.is_empty());
        let mut visited = 0usize;
        while depth > 0 {
            depth -= 1;
            let node = self.tree.node(stack[depth]);
            visited += 1;
            if visited == CHECK_EVERY {
                budget.spend(std::mem::take(&mut visited) as u64)?;
            }
            if !may_hold(&node.bounds) {
                continue;
            }
            match node.children() {
                Some([left, right]) => {
                    stack[depth] = right;
                    stack[depth + 1] = left;
                    depth += 2;
                }
                None => {
                    let leaf = self.tree.leaf(node);
                    if !leaf.meeting(&query).all(|k| visit(leaf.id(k))) {
                        break;
                    }
                }
            }
        }
        budget.spend(visited as u64)
    }

    pub(super) fn tree(&self) -> &Tree {
        &self.tree
    }

    pub(super) fn frame(&self) -> Frame {
        self.frame
    }

    pub(super) fn stars(&self) -> &[HubStar] {
        &self.stars
    }

    /// The node at which each star begins.
    pub(super) fn star_roots(&self) -> &[u32] {
        &self.star_roots
    }
}

/// A visit that never ends early.
fn all(mut visit: impl FnMut(u32)) -> impl FnMut(u32) -> bool {
    move |triangle| {
        visit(triangle);
        true
    }
}

/// The triangles a hierarchy is built over.
#[derive(Clone, Copy)]
struct IndexedTriangles<'t> {
    positions: &'t [DVec3],
    triangles: &'t [[u32; 3]],
    ids: Option<&'t [u32]>,
    frame: Frame,
}

impl Elements for IndexedTriangles<'_> {
    fn len(&self) -> usize {
        self.ids.map_or(self.triangles.len(), <[u32]>::len)
    }

    fn id(&self, place: usize) -> u32 {
        self.ids.map_or(place as u32, |ids| ids[place])
    }

    fn bounds(&self, id: u32) -> Box32 {
        self.frame.box_of(self.corners(id).map(|v| self.positions[v as usize]))
    }

    fn corners(&self, id: u32) -> [u32; 3] {
        self.triangles[id as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::par;

    /// A strip of squares in the plane z = 0, each of two triangles.
    fn strip(squares: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let positions = (0..2 * (squares + 1)).map(|i| DVec3::new(f64::from(i / 2), f64::from(i % 2), 0.0));
        let triangles = (0..squares).map(|i| 2 * i).flat_map(|v| [[v, v + 2, v + 1], [v + 1, v + 2, v + 3]]);
        (positions.collect(), triangles.collect())
    }

    /// A fan of triangles around vertex 0.
    fn fan(count: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let rim = |i: u32| DVec3::new(f64::from(i), f64::from(i) * f64::from(i), 1.0);
        let positions = std::iter::once(DVec3::ZERO).chain((0..=count).map(rim)).collect();
        (positions, (1..=count).map(|i| [0, i, i + 1]).collect())
    }

    fn build((positions, triangles): &(Vec<DVec3>, Vec<[u32; 3]>), ids: Option<&[u32]>) -> Bvh {
        Bvh::build(positions, triangles, ids, &Budget::unlimited()).unwrap()
    }

    fn in_box(bvh: &Bvh, min: DVec3, max: DVec3) -> Vec<u32> {
        let mut found = Vec::new();
        bvh.visit_box(Aabb { min, max }, &Budget::unlimited(), |id| found.push(id)).unwrap();
        found.sort_unstable();
        found
    }

    fn above(bvh: &Bvh, start: DVec3) -> Vec<u32> {
        let mut found = Vec::new();
        bvh.visit_upward_ray(start, &Budget::unlimited(), |id| found.push(id)).unwrap();
        found.sort_unstable();
        found
    }

    #[test]
    fn a_box_finds_the_triangles_whose_boxes_it_meets_and_no_others() {
        let mesh = strip(50_000);
        let bvh = build(&mesh, None);
        for x in [0u32, 1, 777, 49_998] {
            let middle = DVec3::new(f64::from(x) + 0.5, 0.5, 0.0);
            assert_eq!(in_box(&bvh, middle, middle), [2 * x, 2 * x + 1], "{x}");
        }
        let everywhere = in_box(&bvh, DVec3::MIN, DVec3::MAX);
        assert!(everywhere.into_iter().eq(0..100_000));
        assert!(in_box(&bvh, DVec3::splat(0.1), DVec3::splat(0.2)).is_empty());
    }

    #[test]
    fn a_ray_finds_what_is_above_its_start() {
        let bvh = build(&strip(100), None);
        assert_eq!(above(&bvh, DVec3::new(3.5, 0.5, -1.0)), [6, 7]);
        assert_eq!(above(&bvh, DVec3::new(3.5, 0.5, 0.0)), [6, 7]);
        assert!(above(&bvh, DVec3::new(3.5, 0.5, 0.5)).is_empty());
    }

    #[test]
    fn only_the_chosen_triangles_are_in_the_tree() {
        let mesh = strip(100);
        assert_eq!(in_box(&build(&mesh, Some(&[7, 3, 150])), DVec3::MIN, DVec3::MAX), [3, 7, 150]);
        assert!(in_box(&build(&mesh, Some(&[])), DVec3::MIN, DVec3::MAX).is_empty());
        let far_apart = (vec![DVec3::MIN, DVec3::MAX, DVec3::X], vec![[0, 1, 2], [2, 2, 2]]);
        assert!(in_box(&build(&far_apart, None), DVec3::ZERO, DVec3::ZERO).contains(&0));
    }

    #[test]
    fn stars_are_in_the_tree_once_beside_everything_else() {
        let (mut positions, mut triangles) = fan(1_000);
        for k in 1..40 {
            let (more, fan) = fan(100);
            let base = positions.len() as u32;
            triangles.extend(fan.into_iter().map(|t| t.map(|v| v + base)));
            positions.extend(more.into_iter().map(|p| p + DVec3::Z * f64::from(10 * k)));
        }
        let (more, strip) = strip(100);
        let base = positions.len() as u32;
        triangles.extend(strip.into_iter().map(|t| t.map(|v| v + base)));
        positions.extend(more);
        for ids in [None, Some((0..4_900).collect::<Vec<u32>>())] {
            let bvh = Bvh::build(&positions, &triangles, ids.as_deref(), &Budget::unlimited()).unwrap();
            assert_eq!(bvh.stars().len(), 40);
            let everywhere = in_box(&bvh, DVec3::MIN, DVec3::MAX);
            assert!(everywhere.into_iter().eq(0..ids.map_or(5_100, |ids| ids.len() as u32)));
        }
    }

    #[test]
    fn the_tree_is_the_same_with_1_2_and_8_threads() {
        let mesh = strip(30_000);
        let [one, two, eight] =
            [1, 2, 8].map(|threads| par::with_threads(threads, || format!("{:?}", build(&mesh, None))));
        assert!(one == two && one == eight);
    }

    #[test]
    fn a_raised_stop_flag_ends_building_and_visiting() {
        let stop = crate::budget::StopFlag::default();
        let budget = Budget::new(stop.clone(), u64::MAX, u64::MAX);
        let (positions, triangles) = strip(10);
        let bvh = Bvh::build(&positions, &triangles, None, &budget).unwrap();
        stop.cancel();
        assert!(Bvh::build(&positions, &triangles, None, &budget).is_err());
        assert!(bvh.visit_upward_ray(DVec3::ZERO, &budget, |_| ()).is_err());
    }
}
