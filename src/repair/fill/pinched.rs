//! Joins boundary loops that pass one vertex and would leave several fans of triangles there, closed each by itself.
//!
//! At a vertex, a loop comes along the border of one fan and leaves along that of another or of the same one, and a patch
//! joins the two. Boundary loops are parted where they meet, so that each passes a vertex once; so a loop may begin and end
//! at one fan, which a patch then closes to a ring of its own. Where the fans belong to one surface, the loops have to
//! exchange their continuations there:
//!
//! ```text
//!      fan 1                fan 1         in 1 -> out 1, in 2 -> out 2: two loops, and a patch for each leaves two fans;
//!   in 1 \ / out 1       in 1 \ / out 1   in 1 -> out 2, in 2 -> out 1: one loop that passes the vertex twice, and its
//!         v         or         v          patch leaves one
//!  out 2 / \ in 2       out 2 / \ in 2
//!      fan 2                fan 2
//! ```

use super::surface::Surface;
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::mesh::{BoundaryLoop, Components, edge_of, next_corner, prev_corner, triangle_of};
use rustc_hash::{FxHashMap, FxHashSet};

/// Loops that meet in one vertex, at most: how they are joined is chosen among all pairs.
const PASSES_MAX: usize = 16;
/// The fans of two parts that meet in a vertex are of one torn surface when the cosine of the angle between their normals is
/// above this; parts that lean against each other there stay two.
const SAME_SIDE_COS_MIN: f64 = 0.5;

/// A closed walk along the boundary, which may pass a vertex several times.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Walk {
    pub(super) half_edges: BoundaryLoop,
    /// The same by the boundary loops that they are of.
    pub(super) parts: Vec<BoundaryLoop>,
    /// True when these are whole loops.
    pub(super) is_of_loops: bool,
}

impl Walk {
    pub(super) fn of_one(traced: BoundaryLoop) -> Self {
        Self { half_edges: traced.clone(), parts: vec![traced], is_of_loops: true }
    }

    /// Loops that are closed with it; one where it has parts of some only.
    pub(super) fn loop_count(&self) -> usize {
        if self.is_of_loops { self.parts.len() } else { 1 }
    }
}

/// The walks that close `loops` with one fan at each vertex, as far as there are such: loops as they are, and loops that
/// are joined.
pub(super) fn join(
    loops: Vec<BoundaryLoop>,
    surface: &Surface,
    budget: &Budget,
) -> Result<Vec<Walk>, Stopped> {
    let passes = passes(&loops, surface, budget)?;
    if passes.is_empty() {
        return Ok(loops.into_iter().map(Walk::of_one).collect());
    }
    let mut joints = Joints { surface, next: FxHashMap::default(), is_changed: false, parts: None };
    for own in &loops {
        joints.next.extend(own.iter().copied().zip(own.iter().copied().cycle().skip(1)));
    }
    for out in passes {
        joints.join_fans(&out, budget)?;
    }
    if joints.is_changed {
        Ok(joints.walks(&loops))
    } else {
        Ok(loops.into_iter().map(Walk::of_one).collect())
    }
}

/// For each vertex that loops pass several times: the half-edges along which they leave it.
fn passes(loops: &[BoundaryLoop], surface: &Surface, budget: &Budget) -> Result<Vec<Vec<u32>>, Stopped> {
    let mut corners: Vec<(u32, u32)> = loops.iter().flatten().map(|&h| (surface.corner(h), h)).collect();
    budget.spend(corners.len() as u64 / 16 + 1)?;
    corners.sort_unstable();
    let several = corners.chunk_by(|a, b| a.0 == b.0).filter(|own| (2..=PASSES_MAX).contains(&own.len()));
    Ok(several.map(|own| own.iter().map(|&(_, h)| h).collect()).collect())
}

/// Where a fan ends that begins at a boundary half-edge, and its normal.
struct Fan {
    /// The boundary half-edge that leaves the vertex; a loop comes along it.
    end: u32,
    normal: DVec3,
}

struct Joints<'a> {
    surface: &'a Surface,
    /// For each half-edge of the loops the one after it.
    next: FxHashMap<u32, u32>,
    is_changed: bool,
    /// The parts of the surface, found when they are first asked for.
    parts: Option<Components>,
}

impl Joints<'_> {
    /// Joins loops at a vertex that they leave along `out`, until one fan will be there or no more of them belong together.
    fn join_fans(&mut self, out: &[u32], budget: &Budget) -> Result<(), Stopped> {
        budget.spend((out.len() * out.len()) as u64 / 4)?;
        let fans: Option<Vec<Fan>> = out.iter().map(|&h| self.fan(h)).collect();
        let Some(fans) = fans else { return Ok(()) };
        let ends: FxHashSet<u32> = fans.iter().map(|fan| fan.end).collect();
        // Each fan has an end of its own, along which a loop comes; it is not so where triangles run against each other.
        if ends.len() < out.len() || !ends.iter().all(|end| self.next.contains_key(end)) {
            return Ok(());
        }
        while let Some([i, k]) = self.best_exchange(out, &fans, budget)? {
            let (after_i, after_k) = (self.next[&fans[i].end], self.next[&fans[k].end]);
            self.next.insert(fans[i].end, after_k);
            self.next.insert(fans[k].end, after_i);
            self.is_changed = true;
        }
        Ok(())
    }

    /// The fan whose border a loop leaves along `h`; `None` when it ends at an edge with several triangles, or with one
    /// that runs the other way.
    fn fan(&self, h: u32) -> Option<Fan> {
        let Surface { triangles, groups, positions, .. } = self.surface;
        let vertex = self.surface.corner(h);
        let (mut at, mut normal) = (h, DVec3::ZERO);
        loop {
            let [p, q, r] =
                [at, next_corner(at), prev_corner(at)].map(|h| positions[self.surface.corner(h) as usize]);
            let cross = (q - p).cross(r - p);
            normal += cross.normalize_or_zero() * libm::atan2(cross.length(), (q - p).dot(r - p));
            let exit = next_corner(at);
            let [a, b] = edge_of(triangles, exit);
            match *groups.group(groups.find(triangles, [a.min(b), a.max(b)])?) {
                [only] => {
                    return (only == exit).then_some(Fan { end: exit, normal: normal.normalize_or_zero() });
                }
                [g, twin] => at = if g == exit { twin } else { g },
                _ => return None,
            }
            if at == h || edge_of(triangles, at)[1] != vertex {
                return None;
            }
        }
    }

    /// The two fans, of two rings that patches would make of them, whose loops turn least when they are joined there.
    fn best_exchange(
        &mut self,
        out: &[u32],
        fans: &[Fan],
        budget: &Budget,
    ) -> Result<Option<[usize; 2]>, Stopped> {
        // A patch joins the end of fan `i` to the fan that the loop leaves along.
        let to = |i: usize| out.iter().position(|&h| h == self.next[&fans[i].end]);
        let Some(to) = (0..out.len()).map(to).collect::<Option<Vec<usize>>>() else { return Ok(None) };
        let ring = rings(&to);
        let mut best: Option<(f64, [usize; 2])> = None;
        for i in 0..out.len() {
            for k in 0..i {
                if ring[i] == ring[k] || !self.belong_together(out, fans, [i, k], budget)? {
                    continue;
                }
                let turn = self.turn(fans[i].end, out[to[k]]) + self.turn(fans[k].end, out[to[i]]);
                if best.is_none_or(|(least, _)| turn < least) {
                    best = Some((turn, [i, k]));
                }
            }
        }
        Ok(best.map(|(_, pair)| pair))
    }

    /// True when two fans are of one part, or their surfaces look the same way.
    fn belong_together(
        &mut self,
        out: &[u32],
        fans: &[Fan],
        [i, k]: [usize; 2],
        budget: &Budget,
    ) -> Result<bool, Stopped> {
        if fans[i].normal.dot(fans[k].normal) >= SAME_SIDE_COS_MIN {
            return Ok(true);
        }
        if self.parts.is_none() {
            self.parts = Some(self.surface.groups.components(budget)?);
        }
        let part = |h: u32| self.parts.as_ref().map(|parts| parts.of[triangle_of(h) as usize]);
        Ok(part(out[i]) == part(out[k]))
    }

    /// The angle between the edge along which a loop comes and that along which it leaves.
    fn turn(&self, end: u32, out: u32) -> f64 {
        let to =
            |h: u32, end: usize| self.surface.positions[edge_of(&self.surface.triangles, h)[end] as usize];
        let at = to(out, 1);
        let (a, b) = (to(end, 1) - at, to(out, 0) - at);
        libm::atan2(a.cross(b).length(), a.dot(b))
    }

    /// The closed walks, in the order of the loops that they begin with.
    fn walks(&self, loops: &[BoundaryLoop]) -> Vec<Walk> {
        let mut of_loop: FxHashMap<u32, usize> = FxHashMap::default();
        for (i, own) in loops.iter().enumerate() {
            of_loop.extend(own.iter().map(|&h| (h, i)));
        }
        let mut is_walked: FxHashSet<u32> = FxHashSet::default();
        let mut walks = Vec::new();
        for &start in loops.iter().flatten() {
            let mut half_edges = Vec::new();
            let mut at = start;
            while is_walked.insert(at) {
                half_edges.push(at);
                at = self.next[&at];
            }
            if half_edges.is_empty() {
                continue;
            }
            let mut by_loop = half_edges.clone();
            by_loop.sort_by_key(|h| of_loop[h]);
            let parts: Vec<BoundaryLoop> =
                by_loop.chunk_by(|g, h| of_loop[g] == of_loop[h]).map(<[u32]>::to_vec).collect();
            let is_whole = |part: &BoundaryLoop| part.len() == loops[of_loop[&part[0]]].len();
            let is_of_loops = parts.iter().all(is_whole);
            let parts = if is_of_loops {
                parts.iter().map(|part| loops[of_loop[&part[0]]].clone()).collect()
            } else {
                parts
            };
            walks.push(Walk { half_edges, parts, is_of_loops });
        }
        walks
    }
}

/// The smallest member of the cycle of each number under a permutation.
fn rings(to: &[usize]) -> Vec<usize> {
    let mut ring = vec![usize::MAX; to.len()];
    for start in 0..to.len() {
        let mut at = start;
        while ring[at] == usize::MAX {
            ring[at] = start;
            at = to[at];
        }
    }
    ring
}
