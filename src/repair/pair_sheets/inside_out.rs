//! Which bodies that touch are inside out, before anything is parted.

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::mesh::{Components, EdgeGroups, UnionFind, edge_of, triangle_of};
use crate::repair::Draft;
use crate::spatial::{self, NO_SHELL};

/// Turns the bodies whose outermost one points inward, with everything that is in them; gives the number of triangles.
///
/// A body is here what hangs together by vertices: bodies that touch are one, and the exact sign of its volume is that of
/// its outermost surface. One with an edge at which directions do not cancel is left as it is.
///
/// # Errors
/// When the budget stops the run.
pub(super) fn turn(draft: &mut Draft, budget: &Budget) -> Result<u64, Stopped> {
    let bodies = bodies(draft, budget)?;
    let is_closed = closed(draft, &bodies, budget)?;
    let (mut shell, mut count) = (vec![NO_SHELL; bodies.count as usize], 0);
    for (body, _) in is_closed.iter().enumerate().filter(|&(_, &is_closed)| is_closed) {
        shell[body] = count;
        count += 1;
    }
    if count == 0 {
        return Ok(0);
    }
    let shell_of: Vec<u32> = bodies.of.iter().map(|&body| shell[body as usize]).collect();
    let nesting = spatial::nest(&draft.positions, &draft.triangles, &shell_of, count, None, budget)?;
    let is_root_outward = |mut s: u32| {
        // No longer than the shells are deep.
        for _ in 0..nesting.depth[s as usize] {
            let Some(parent) = nesting.parent[s as usize] else { break };
            s = parent;
        }
        nesting.is_outward[s as usize]
    };
    let turns: Vec<bool> = (0..count).map(|s| !is_root_outward(s)).collect();
    let mut turned = 0;
    for (t, &s) in shell_of.iter().enumerate() {
        if t % CHECK_EVERY == 0 {
            budget.check()?;
        }
        if s != NO_SHELL && turns[s as usize] {
            draft.flip(t);
            turned += 1;
        }
    }
    Ok(turned)
}

/// Triangles connected by vertices.
fn bodies(draft: &Draft, budget: &Budget) -> Result<Components, Stopped> {
    let mut sets = UnionFind::new(draft.positions.len());
    for block in draft.triangles.chunks(CHECK_EVERY) {
        budget.check()?;
        for &[a, b, c] in block {
            sets.unite(a, b);
            sets.unite(b, c);
        }
    }
    let vertices = sets.into_components();
    // Numbered anew by triangles, because a vertex without one would have a body of its own.
    let mut number = vec![u32::MAX; vertices.count as usize];
    let mut count = 0;
    let of = draft
        .triangles
        .iter()
        .map(|t| {
            let number = &mut number[vertices.of[t[0] as usize] as usize];
            if *number == u32::MAX {
                *number = count;
                count += 1;
            }
            *number
        })
        .collect();
    Ok(Components { of, count })
}

/// For each body, whether as many triangles run along each edge as against it.
fn closed(draft: &Draft, bodies: &Components, budget: &Budget) -> Result<Vec<bool>, Stopped> {
    let groups = EdgeGroups::build(&draft.triangles, draft.positions.len(), budget)?;
    let mut is_closed = vec![true; bodies.count as usize];
    for (e, group) in groups.iter().enumerate() {
        if e % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let [from, _] = edge_of(&draft.triangles, group[0]);
        let along = group.iter().filter(|&&h| edge_of(&draft.triangles, h)[0] == from).count();
        if 2 * along != group.len() {
            is_closed[bodies.of[triangle_of(group[0]) as usize] as usize] = false;
        }
    }
    Ok(is_closed)
}
