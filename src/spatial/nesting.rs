//! Which closed shells lie inside which, decided exactly.

use super::Bvh;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3, Sign, upward_crossing, volume_sign};
use crate::par;

/// In the place of a shell for triangles that belong to none.
pub const NO_SHELL: u32 = u32::MAX;

/// How disjoint closed shells lie in each other.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ShellNesting {
    /// True when the shell's exact signed volume is positive: its triangles are counter-clockwise seen from outside.
    pub is_outward: Vec<bool>,
    /// The innermost shell around each shell.
    pub parent: Vec<Option<u32>>,
    /// Number of shells around each shell.
    pub depth: Vec<u32>,
}

/// Nests `shell_count` shells; `shell_of[t]` is the shell of triangle `t`, or [`NO_SHELL`]. Every shell must have a
/// triangle and be closed, oriented and embedded, and no two may meet. A `bvh` must hold all their triangles; without one,
/// those that the rays may meet are looked for, which takes a tenth of what a hierarchy does.
///
/// One vertical ray for each shell, from its highest vertex: the shells that it crosses an odd number of times are those
/// around it. They form a chain in which each has a larger reach than the ones inside, so that the one with the least
/// reach is the innermost.
///
/// # Errors
/// When the budget stops the run.
pub fn nest(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    shell_of: &[u32],
    shell_count: u32,
    bvh: Option<&Bvh>,
    budget: &Budget,
) -> Result<ShellNesting, Stopped> {
    let members = ShellTriangles::group(shell_of, shell_count, budget)?;
    let corners = |t: u32| triangles[t as usize].map(|v| positions[v as usize]);
    let shells = par::try_map_ranges(shell_count as usize, 1, |range| {
        let own = members.of(range.start);
        let sign = volume_sign(own.iter().map(|&t| corners(t)), || budget.check())?;
        Ok(ShellExtent {
            is_outward: sign == Sign::Positive,
            ..ShellExtent::of(own.iter().map(|&t| corners(t)), budget)?
        })
    })?;
    let built = match bvh {
        None if shell_count > 1 => {
            let tops = shells.iter().map(|shell| shell.top).collect();
            let above = triangles_above(tops, positions, triangles, shell_of, budget)?;
            Some(Bvh::build(positions, triangles, Some(&above), budget)?)
        }
        _ => None,
    };
    let bvh = bvh.or(built.as_ref());
    let nested = par::try_map_ranges(shell_count as usize, 1, |range| {
        let shell = range.start;
        let top = shells[shell].top;
        let mut crossed = Vec::new();
        if let Some(bvh) = bvh.filter(|_| shell_count > 1) {
            bvh.visit_upward_ray(top, budget, |t| {
                let other = shell_of[t as usize];
                let may_contain =
                    other != NO_SHELL && other as usize != shell && shells[other as usize].surrounds(top);
                if may_contain && upward_crossing(top, corners(t)).is_some() {
                    crossed.push(other);
                }
            })?;
        }
        Ok(around(crossed, |s| shells[s as usize].bounds.max.x))
    })?;
    Ok(ShellNesting {
        is_outward: shells.iter().map(|s| s.is_outward).collect(),
        parent: nested.iter().map(|&(parent, _)| parent).collect(),
        depth: nested.iter().map(|&(_, depth)| depth).collect(),
    })
}

/// Tops that are looked at for a triangle, before it is taken to be above one.
const TOPS_MAX: usize = 32;

/// The triangles of shells that upward rays from `tops` may meet, ascending; a few more may be in.
fn triangles_above(
    mut tops: Vec<DVec3>,
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    shell_of: &[u32],
    budget: &Budget,
) -> Result<Vec<u32>, Stopped> {
    tops.sort_unstable_by(|a, b| a.x.total_cmp(&b.x));
    let is_above_one = |bounds: Aabb| {
        let first = tops.partition_point(|top| top.x < bounds.min.x);
        let beside = tops[first..].iter().take_while(|top| top.x <= bounds.max.x);
        let is_below = |top: &DVec3| top.y >= bounds.min.y && top.y <= bounds.max.y && top.z <= bounds.max.z;
        beside.enumerate().any(|(looked_at, top)| looked_at == TOPS_MAX || is_below(top))
    };
    let parts = par::try_map_ranges(triangles.len(), CHECK_EVERY, |range| {
        budget.spend(range.len() as u64)?;
        let of_shell = range.filter(|&t| shell_of[t] != NO_SHELL);
        let above = of_shell.filter(|&t| is_above_one(Aabb::of(triangles[t].map(|v| positions[v as usize]))));
        Ok(above.map(|t| t as u32).collect::<Vec<_>>())
    })?;
    Ok(parts.concat())
}

/// The innermost of the shells crossed an odd number of times, and how many those are.
fn around(mut crossed: Vec<u32>, reach: impl Fn(u32) -> f64) -> (Option<u32>, u32) {
    crossed.sort_unstable();
    let odd = crossed.chunk_by(|a, b| a == b).filter(|same| same.len() % 2 == 1).map(|same| same[0]);
    let depth = odd.clone().count() as u32;
    (odd.min_by(|&a, &b| reach(a).total_cmp(&reach(b))), depth)
}

/// What is to be known of a shell as a whole.
struct ShellExtent {
    is_outward: bool,
    bounds: Aabb,
    /// The highest vertex; of several the one met first.
    top: DVec3,
}

impl ShellExtent {
    fn of(triangles: impl Iterator<Item = [DVec3; 3]>, budget: &Budget) -> Result<Self, Stopped> {
        let (mut bounds, mut top) = (Aabb::EMPTY, DVec3::NEG_INFINITY);
        for (i, corners) in triangles.enumerate() {
            if i % CHECK_EVERY == 0 {
                budget.check()?;
            }
            bounds = bounds.union(Aabb::of(corners));
            top = corners.into_iter().fold(top, |top, p| if p.z > top.z { p } else { top });
        }
        Ok(Self { is_outward: false, bounds, top })
    }

    /// False only when `p` is certainly not inside.
    fn surrounds(&self, p: DVec3) -> bool {
        p.cmpgt(self.bounds.min).all() && p.cmplt(self.bounds.max).all()
    }
}

/// The triangles of each shell.
#[derive(Debug, Clone)]
pub struct ShellTriangles {
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl ShellTriangles {
    /// Groups the triangles by `shell_of`, ascending in each shell; those of [`NO_SHELL`] are left out. O(n).
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn group(shell_of: &[u32], shell_count: u32, budget: &Budget) -> Result<Self, Stopped> {
        let mut starts = vec![0; shell_count as usize + 1];
        for block in shell_of.chunks(CHECK_EVERY) {
            budget.check()?;
            for &s in block.iter().filter(|&&s| s != NO_SHELL) {
                starts[s as usize + 1] += 1;
            }
        }
        for s in 0..shell_count as usize {
            starts[s + 1] += starts[s];
        }
        let mut next = starts.clone();
        let mut triangles = vec![0; starts[shell_count as usize] as usize];
        for (t, &s) in shell_of.iter().enumerate() {
            if t % CHECK_EVERY == 0 {
                budget.check()?;
            }
            if s != NO_SHELL {
                triangles[next[s as usize] as usize] = t as u32;
                next[s as usize] += 1;
            }
        }
        Ok(Self { starts, triangles })
    }

    /// The triangles of `shell`.
    pub fn of(&self, shell: usize) -> &[u32] {
        &self.triangles[self.starts[shell] as usize..self.starts[shell + 1] as usize]
    }
}
