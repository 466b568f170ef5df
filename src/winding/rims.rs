//! Parts of a surface, and the rims of those that are open.

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::mesh::{Components, EdgeGroups, edge_of, triangle_of};

/// Parts connected by edges.
pub(super) struct ConnectedParts {
    pub(super) parts: Components,
    /// Whether each edge of a part is run through as often one way as the other.
    pub(super) is_closed: Vec<bool>,
    /// The edges that are not.
    pub(super) rims: Vec<UnbalancedEdge>,
}

/// An edge that its triangles run through more often one way than the other.
#[derive(Debug, Clone, Copy)]
pub(super) struct UnbalancedEdge {
    pub(super) from: u32,
    pub(super) to: u32,
    /// How much more often.
    pub(super) times: u32,
    pub(super) part: u32,
}

/// The parts of `triangles` over so many vertices.
///
/// # Errors
/// When the budget stops the run.
pub(super) fn parts(
    vertex_count: usize,
    triangles: &[[u32; 3]],
    budget: &Budget,
) -> Result<ConnectedParts, Stopped> {
    let groups = EdgeGroups::build(triangles, vertex_count, budget)?;
    let parts = groups.components(budget)?;
    let mut is_closed = vec![true; parts.count as usize];
    let mut rims = Vec::new();
    for (e, group) in groups.iter().enumerate() {
        if e % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let mut balance = 0i64;
        for &h in group {
            let [from, to] = edge_of(triangles, h);
            balance += i64::from(from < to) - i64::from(from > to);
        }
        if balance != 0 {
            let [a, b] = edge_of(triangles, group[0]);
            let (from, to) = if balance > 0 { (a.min(b), a.max(b)) } else { (a.max(b), a.min(b)) };
            let part = parts.of[triangle_of(group[0]) as usize];
            is_closed[part as usize] = false;
            rims.push(UnbalancedEdge { from, to, times: balance.unsigned_abs() as u32, part });
        }
    }
    Ok(ConnectedParts { parts, is_closed, rims })
}
