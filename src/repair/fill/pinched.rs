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

use super::surface::FillSurface;
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::mesh::{BoundaryLoop, Components, edge_of, next_corner, prev_corner, triangle_of};
use rustc_hash::{FxHashMap, FxHashSet};

/// Loops that meet in one vertex, at most: how they are joined is chosen among all pairs.
const PASSES_MAX: usize = 16;
/// Memory for each half-edge of loops that meet others: maps to the next one and to the loop, and the walk.
const BYTES_PER_EDGE: u64 = 64;
/// The fans of two parts that meet in a vertex are of one torn surface when the cosine of the angle between their normals is
/// above this; parts that lean against each other there stay two.
const SAME_SIDE_COS_MIN: f64 = 0.5;

/// A closed walk along the boundary, which may pass a vertex several times.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Walk {
    pub(super) half_edges: BoundaryLoop,
    /// None when it is a boundary loop; otherwise the loops that it joins, then the parts that it has of others.
    parts: Vec<BoundaryLoop>,
    /// How many of these are whole loops.
    whole: usize,
}

impl Walk {
    pub(super) fn of_one(half_edges: BoundaryLoop) -> Self {
        Self { half_edges, parts: Vec::new(), whole: 0 }
    }

    /// The same by the boundary loops that they are of.
    pub(super) fn parts(&self) -> &[BoundaryLoop] {
        if self.parts.is_empty() { std::slice::from_ref(&self.half_edges) } else { &self.parts }
    }

    /// The loops that it joins; none when it is a boundary loop.
    pub(super) fn joined(&self) -> &[BoundaryLoop] {
        &self.parts[..self.whole]
    }

    /// Loops that count as closed with it: those that it joins, and one for all that it has only parts of.
    pub(super) fn loop_count(&self) -> usize {
        self.whole + usize::from(self.whole < self.parts().len())
    }
}

/// The walks that close `loops` with one fan at each vertex, as far as there are such: loops as they are, and loops that
/// are joined.
pub(super) fn join(
    loops: Vec<BoundaryLoop>,
    surface: &FillSurface,
    budget: &Budget,
) -> Result<Vec<Walk>, Stopped> {
    let passes = passes(&loops, surface, budget)?;
    if passes.is_empty() {
        return Ok(loops.into_iter().map(Walk::of_one).collect());
    }
    let meeting: FxHashSet<u32> = passes.iter().flatten().copied().collect();
    let meets = |own: &BoundaryLoop| own.iter().any(|h| meeting.contains(h));
    let edges: u64 = loops.iter().filter(|own| meets(own)).map(|own| own.len() as u64).sum();
    let _charge = budget.charge(edges * BYTES_PER_EDGE)?;
    let mut joints = Joints { surface, next: FxHashMap::default(), is_changed: false, parts: None };
    for own in loops.iter().filter(|own| meets(own)) {
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
fn passes(loops: &[BoundaryLoop], surface: &FillSurface, budget: &Budget) -> Result<Vec<Vec<u32>>, Stopped> {
    let mut corners: Vec<(u32, u32)> = loops.iter().flatten().map(|&h| (surface.corner(h), h)).collect();
    budget.spend(corners.len() as u64 / 16 + 1)?;
    corners.sort_unstable();
    let several = corners.chunk_by(|a, b| a.0 == b.0).filter(|own| (2..=PASSES_MAX).contains(&own.len()));
    Ok(several.map(|own| own.iter().map(|&(_, h)| h).collect()).collect())
}

/// Where a fan ends that begins at a boundary half-edge, and its normal.
struct BoundaryFan {
    /// The boundary half-edge that leaves the vertex; a loop comes along it.
    end: u32,
    normal: DVec3,
}

struct Joints<'a> {
    surface: &'a FillSurface,
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
        let mut fans = Vec::with_capacity(out.len());
        for &h in out {
            let Some(fan) = self.fan(h, budget)? else { return Ok(()) };
            fans.push(fan);
        }
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
    fn fan(&self, h: u32, budget: &Budget) -> Result<Option<BoundaryFan>, Stopped> {
        let FillSurface { triangles, groups, positions, .. } = self.surface;
        let vertex = self.surface.corner(h);
        let (mut at, mut normal) = (h, DVec3::ZERO);
        loop {
            budget.spend(1)?;
            let [p, q, r] =
                [at, next_corner(at), prev_corner(at)].map(|h| positions[self.surface.corner(h) as usize]);
            let cross = (q - p).cross(r - p);
            normal += cross.normalize_or_zero() * libm::atan2(cross.length(), (q - p).dot(r - p));
            let exit = next_corner(at);
            let [a, b] = edge_of(triangles, exit);
            let Some(edge) = groups.find(triangles, [a.min(b), a.max(b)]) else { return Ok(None) };
            match *groups.group(edge) {
                [_] => return Ok(Some(BoundaryFan { end: exit, normal: normal.normalize_or_zero() })),
                [g, twin] => at = if g == exit { twin } else { g },
                _ => return Ok(None),
            }
            if edge_of(triangles, at)[1] != vertex {
                return Ok(None);
            }
        }
    }

    /// The two fans, of two rings that patches would make of them, with the narrowest gaps between them when they are joined.
    fn best_exchange(
        &mut self,
        out: &[u32],
        fans: &[BoundaryFan],
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
                let gaps = self.gap(fans[i].end, out[to[k]]) + self.gap(fans[k].end, out[to[i]]);
                if best.is_none_or(|(least, _)| gaps < least) {
                    best = Some((gaps, [i, k]));
                }
            }
        }
        Ok(best.map(|(_, pair)| pair))
    }

    /// True when two fans are of one part, or their surfaces look the same way.
    fn belong_together(
        &mut self,
        out: &[u32],
        fans: &[BoundaryFan],
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
    fn gap(&self, end: u32, out: u32) -> f64 {
        let to =
            |h: u32, end: usize| self.surface.positions[edge_of(&self.surface.triangles, h)[end] as usize];
        let at = to(out, 1);
        let (a, b) = (to(end, 1) - at, to(out, 0) - at);
        libm::atan2(a.cross(b).length(), a.dot(b))
    }

    /// The closed walks, in the order of the loops that they begin with.
    fn walks(&self, loops: &[BoundaryLoop]) -> Vec<Walk> {
        let meets = |own: &BoundaryLoop| self.next.contains_key(&own[0]);
        let mut of_loop: FxHashMap<u32, usize> = FxHashMap::default();
        for (i, own) in loops.iter().enumerate().filter(|(_, own)| meets(own)) {
            of_loop.extend(own.iter().map(|&h| (h, i)));
        }
        let mut is_walked: FxHashSet<u32> = FxHashSet::default();
        let mut walks = Vec::with_capacity(loops.len());
        for own in loops {
            if !meets(own) {
                walks.push(Walk::of_one(own.clone()));
                continue;
            }
            for &start in own {
                let mut half_edges = Vec::new();
                let mut at = start;
                while is_walked.insert(at) {
                    half_edges.push(at);
                    at = self.next[&at];
                }
                if !half_edges.is_empty() {
                    walks.push(by_loops(half_edges, loops, &of_loop));
                }
            }
        }
        walks
    }
}

/// The walk along `half_edges`, by the loops that these are of; `of_loop` says which of `loops` that is.
fn by_loops(half_edges: BoundaryLoop, loops: &[BoundaryLoop], of_loop: &FxHashMap<u32, usize>) -> Walk {
    let mut sorted = half_edges.clone();
    sorted.sort_by_key(|h| of_loop[h]);
    let (mut whole, mut broken) = (Vec::new(), Vec::new());
    for part in sorted.chunk_by(|g, h| of_loop[g] == of_loop[h]) {
        let own = &loops[of_loop[&part[0]]];
        if part.len() == own.len() { whole.push(own.clone()) } else { broken.push(part.to_vec()) }
    }
    match &whole[..] {
        [only] if broken.is_empty() => Walk::of_one(only.clone()),
        _ => Walk { half_edges, whole: whole.len(), parts: [whole, broken].concat() },
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Boundary;

    /// Three triangles in a plane that share the vertex 0, counter-clockwise, the last one the other way around if it is `turned`.
    fn blades(is_turned: bool) -> FillSurface {
        let angle = |k: f64| k * std::f64::consts::FRAC_PI_3;
        let rim = (0..6).map(|k| DVec3::new(angle(f64::from(k)).cos(), angle(f64::from(k)).sin(), 0.0));
        let positions = std::iter::once(DVec3::ZERO).chain(rim).collect();
        let last = if is_turned { [0, 6, 5] } else { [0, 5, 6] };
        FillSurface::new(positions, vec![[0, 1, 2], [0, 3, 4], last], &Budget::unlimited()).unwrap()
    }

    fn walks(surface: &FillSurface) -> Vec<Walk> {
        let budget = Budget::unlimited();
        let boundary =
            Boundary::trace(&surface.triangles, surface.positions.len(), &surface.groups, &budget).unwrap();
        join(boundary.loops, surface, &budget).unwrap()
    }

    #[test]
    fn three_blades_get_one_walk_around_the_gaps_between_them() {
        let surface = blades(false);
        let walks = walks(&surface);
        assert_eq!(walks.len(), 1);
        let corners: Vec<u32> = walks[0].half_edges.iter().map(|&h| surface.corner(h)).collect();
        let start = corners.iter().position(|&v| v == 2).unwrap();
        let turned: Vec<u32> = corners.iter().cycle().skip(start).take(9).copied().collect();
        // From blade to blade the short way, not across.
        assert_eq!(turned, [2, 1, 0, 6, 5, 0, 4, 3, 0]);
        assert_eq!((walks[0].joined().len(), walks[0].loop_count()), (3, 3));
    }

    #[test]
    fn a_blade_that_looks_the_other_way_keeps_its_own_walk() {
        let walks = walks(&blades(true));
        assert_eq!(walks.iter().map(|walk| walk.half_edges.len()).collect::<Vec<_>>(), [6, 3]);
        assert_eq!(walks.iter().map(|walk| walk.joined().len()).collect::<Vec<_>>(), [2, 0]);
    }

    #[test]
    fn a_walk_with_parts_of_loops_names_what_it_has_of_each() {
        let of_loop = [(0, 0), (1, 0), (2, 0), (3, 1), (4, 1), (5, 1)].into_iter().collect();
        let loops = [vec![0, 1, 2], vec![3, 4, 5]];
        let both = by_loops(vec![1, 3, 4, 5, 2], &loops, &of_loop);
        assert_eq!(both.parts(), [vec![3, 4, 5], vec![1, 2]]);
        assert_eq!((both.joined(), both.loop_count()), (&loops[1..], 2));
        let part = by_loops(vec![1, 2], &loops, &of_loop);
        assert_eq!((part.joined().len(), part.loop_count()), (0, 1));
        // A loop that begins elsewhere is that loop.
        assert_eq!(by_loops(vec![4, 5, 3], &loops, &of_loop), Walk::of_one(vec![3, 4, 5]));
    }

    #[test]
    fn rings_are_the_cycles_of_a_permutation() {
        assert_eq!(rings(&[2, 1, 0, 4, 3]), [0, 1, 0, 3, 3]);
    }
}
