//! What a patch has to cover: a boundary loop, flat loops that lie in each other like the rims of a pipe's end, or loops
//! that face each other across a gap.

use super::facing::Rims;
use super::pinched::Walk;
use super::planar;
use super::shape::{FLAT_SHARE_MAX, LoopPolyline, shape};
use crate::budget::{Budget, Stopped};
use crate::geom::{DVec2, DVec3, Sign, orient2d};
use crate::mesh::BoundaryLoop;

/// How far the normals of loops in one plane may differ, as the cosine of the angle (0.08 degrees).
const PARALLEL_COS_MIN: f64 = 0.999_999;
/// Most flat loops that are searched for islands, in time that grows with their square.
const FLAT_LOOPS_MAX: usize = 4096;

/// One region to cover.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Region {
    /// The outer loop, then those of islands in it.
    pub(super) walks: Vec<Walk>,
    /// Unit normal of the outer loop, counter-clockwise around it; zero when it has none.
    pub(super) normal: DVec3,
    /// True when all loops lie in one plane, as nearly as float32 can say.
    pub(super) is_flat: bool,
    /// True when the outer loop is the rim of a flat sheet on which a patch would lie.
    pub(super) is_on_sheet: bool,
    /// True when the loops face each other across a gap.
    pub(super) is_bridge: bool,
    /// The half-edges of all loops.
    rim: Vec<u32>,
    /// For each loop the unit normal of the flat sheet of which it is a rim.
    sheets: Vec<Option<DVec3>>,
}

impl Region {
    fn new(outer: Walk, shape: &LoopPolyline, sheet: Option<DVec3>) -> Self {
        let LoopPolyline { normal, is_flat, .. } = *shape;
        let is_on_sheet = lies_on(sheet, normal);
        let rim = outer.half_edges.clone();
        Self { rim, walks: vec![outer], normal, is_flat, is_on_sheet, is_bridge: false, sheets: vec![sheet] }
    }

    fn add(&mut self, island: Walk, sheet: Option<DVec3>) {
        self.rim.extend(&island.half_edges);
        self.walks.push(island);
        self.sheets.push(sheet);
    }

    /// The half-edges of all loops, one after the other.
    pub(super) fn rim(&self) -> &[u32] {
        &self.rim
    }

    /// Those of each loop.
    pub(super) fn loops(&self) -> impl ExactSizeIterator<Item = &BoundaryLoop> {
        self.walks.iter().map(|walk| &walk.half_edges)
    }

    /// Where each loop begins in the rim.
    pub(super) fn loop_starts(&self) -> Vec<usize> {
        self.ranges().iter().map(|range| range.start).collect()
    }

    /// What of the rim each loop is.
    pub(super) fn ranges(&self) -> Vec<std::ops::Range<usize>> {
        let mut end = 0;
        let range = |own: &BoundaryLoop| {
            end += own.len();
            end - own.len()..end
        };
        self.loops().map(range).collect()
    }

    /// For each corner of the rim the next one in its loop.
    pub(super) fn next_corners(&self) -> Vec<u32> {
        let next = |range: std::ops::Range<usize>| {
            let start = range.start as u32;
            range.map(|i| i as u32 + 1).map(move |i| (i, start))
        };
        let mut corners = Vec::with_capacity(self.rim.len());
        for range in self.ranges() {
            let end = range.end as u32;
            corners.extend(next(range).map(|(i, start)| if i == end { start } else { i }));
        }
        corners
    }

    /// Its loops as regions of their own, or those that the only one joins; none when there is nothing to part.
    pub(super) fn parts_alone(&self, corner: impl Fn(u32) -> DVec3) -> Vec<Self> {
        let walks = match &self.walks[..] {
            [only] => only.joined().iter().cloned().map(Walk::of_one).collect(),
            several => several.to_vec(),
        };
        let region = |(walk, sheet): (Walk, Option<DVec3>)| {
            let shape = shape(walk.half_edges.iter().map(|&h| corner(h)).collect());
            Self::new(walk, &shape, sheet)
        };
        // Loops that are joined are of no flat sheet, or all of the same one.
        let sheets = self.sheets.iter().copied().cycle();
        walks.into_iter().zip(sheets).map(region).collect()
    }
}

/// Groups the walks into regions, in their order. `corner(h)` is the corner of a loop at half-edge `h`, `sheets` gives for each walk
/// the unit normal of the flat sheet of which it is a rim.
/// `outward(h)`, if it is given, is the unit direction in which the surface would go on there; loops that face each other
/// across a gap are then grouped, flat or not.
pub(super) fn regions(
    walks: Vec<Walk>,
    sheets: &[Option<DVec3>],
    corner: impl Fn(u32) -> DVec3,
    outward: Option<&dyn Fn(u32) -> DVec3>,
    budget: &Budget,
) -> Result<Vec<Region>, Stopped> {
    let loops: Vec<&BoundaryLoop> = walks.iter().map(|walk| &walk.half_edges).collect();
    let shapes: Vec<LoopPolyline> =
        loops.iter().map(|l| shape(l.iter().map(|&h| corner(h)).collect())).collect();
    let is_on_sheet = |i: usize| lies_on(sheets[i], shapes[i].normal);
    let in_plane = containers(&shapes, is_on_sheet, budget)?;
    let across = match outward {
        Some(outward) => {
            Rims { shapes: &shapes, loops: &loops, sheets, outward }.partners(&in_plane, budget)?
        }
        None => vec![None; loops.len()],
    };
    let is_outer = |i: usize| in_plane[i].is_none() && across[i].is_none();
    let mut regions: Vec<Option<Region>> = walks
        .iter()
        .zip(&shapes)
        .enumerate()
        .map(|(i, (outer, shape))| is_outer(i).then(|| Region::new(outer.clone(), shape, sheets[i])))
        .collect();
    for (i, island) in walks.into_iter().enumerate() {
        if let Some(region) = in_plane[i].or(across[i]).and_then(|c| regions[c].as_mut()) {
            if across[i].is_some() {
                (region.is_bridge, region.is_flat, region.is_on_sheet) = (true, false, false);
            }
            region.add(island, sheets[i]);
        }
    }
    Ok(regions.into_iter().flatten().collect())
}

/// True when a loop with this normal is the outer rim of a flat sheet, if it is one of a `sheet` with such a normal.
fn lies_on(sheet: Option<DVec3>, normal: DVec3) -> bool {
    sheet.is_some_and(|sheet| sheet.dot(normal) <= 0.0)
}

/// For each loop the one whose island it is: the smallest flat loop around it, if that is not an island itself and runs
/// the other way around. What is inside of a rim that `is_on_sheet` is a hole in the sheet.
fn containers(
    shapes: &[LoopPolyline],
    is_on_sheet: impl Fn(usize) -> bool,
    budget: &Budget,
) -> Result<Vec<Option<usize>>, Stopped> {
    let mut container = vec![None; shapes.len()];
    let mut flat: Vec<usize> = (0..shapes.len()).filter(|&i| shapes[i].is_flat).collect();
    if flat.len() > FLAT_LOOPS_MAX {
        return Ok(container);
    }
    flat.sort_by(|&a, &b| shapes[b].area.total_cmp(&shapes[a].area).then(a.cmp(&b)));
    for (rank, &inner) in flat.iter().enumerate() {
        budget.spend(rank as u64 / 64)?;
        let around = flat[..rank].iter().rev().find(|&&outer| contains(&shapes[outer], &shapes[inner]));
        container[inner] = around.copied().filter(|&outer| {
            container[outer].is_none()
                && shapes[outer].normal.dot(shapes[inner].normal) < 0.0
                && !is_on_sheet(outer)
        });
    }
    Ok(container)
}

/// True when `inner` lies in the plane of `outer` and inside it.
fn contains(outer: &LoopPolyline, inner: &LoopPolyline) -> bool {
    let tolerance = FLAT_SHARE_MAX * outer.bounds.diagonal();
    outer.normal.dot(inner.normal).abs() >= PARALLEL_COS_MIN
        && inner.bounds.min.cmpge(outer.bounds.min - tolerance).all()
        && inner.bounds.max.cmple(outer.bounds.max + tolerance).all()
        && inner.points.iter().all(|p| (p - outer.points[0]).dot(outer.normal).abs() <= tolerance)
        && is_inside(inner.points[0], outer)
}

/// Crossing test of a point in the view of the loop; exact but for points on the loop itself.
fn is_inside(point: DVec3, outer: &LoopPolyline) -> bool {
    let view = planar::view(outer.normal);
    let p = view(point);
    let crosses = |a: DVec2, b: DVec2| {
        let is_upward = a.y <= p.y && p.y < b.y;
        let is_downward = b.y <= p.y && p.y < a.y;
        (is_upward && orient2d(a, b, p) == Sign::Positive)
            || (is_downward && orient2d(a, b, p) == Sign::Negative)
    };
    let next = outer.points.iter().cycle().skip(1);
    outer.points.iter().zip(next).filter(|&(&a, &b)| crosses(view(a), view(b))).count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Squares in the plane z = 0 as (half side, is counter-clockwise); half-edges number the corners of all.
    fn grouped(squares: &[(f64, bool)]) -> Vec<Vec<u32>> {
        let corners: Vec<DVec3> = squares
            .iter()
            .flat_map(|&(half, is_ccw)| {
                let ring = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
                (0..4)
                    .map(move |i| ring[if is_ccw { i } else { 3 - i }])
                    .map(move |[x, y]| DVec3::new(x, y, 0.0) * half)
            })
            .collect();
        let walks = (0..squares.len() as u32).map(|s| Walk::of_one((4 * s..4 * s + 4).collect())).collect();
        regions(walks, &vec![None; squares.len()], |h| corners[h as usize], None, &Budget::unlimited())
            .unwrap()
            .into_iter()
            .map(|region| region.loops().map(|l| l[0] / 4).collect())
            .collect()
    }

    #[test]
    fn the_inner_rim_of_a_pipe_is_an_island_of_the_outer_one() {
        assert_eq!(grouped(&[(1.0, false), (2.0, true)]), [[1, 0]]);
    }

    #[test]
    fn a_loop_of_the_same_direction_is_a_region_of_its_own() {
        assert_eq!(grouped(&[(2.0, true), (1.0, true)]), [[0], [1]]);
    }

    #[test]
    fn a_pipe_in_a_pipe_gives_two_regions() {
        assert_eq!(grouped(&[(4.0, true), (3.0, false), (2.0, true), (1.0, false)]), [[0, 1], [2, 3]]);
    }
}
