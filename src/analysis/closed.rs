//! Whether triangles close when some of their vertices are one.

use super::welded::indices_where;
use crate::budget::{Budget, Stopped};
use crate::mesh::EdgeGroups;

/// Whether every edge has exactly two triangles when vertices of the same name are one.
pub(super) fn is_closed(
    triangles: &[[u32; 3]],
    name: impl Fn(u32) -> u32,
    budget: &Budget,
) -> Result<bool, Stopped> {
    let named = triangles.iter().map(|t| t.map(&name));
    let named: Vec<[u32; 3]> = named.filter(|[a, b, c]| a != b && b != c && c != a).collect();
    let count = named.as_flattened().iter().max().map_or(0, |&v| v as usize + 1);
    let edges = EdgeGroups::build(&named, count, budget)?;
    Ok(!named.is_empty() && indices_where(edges.len(), budget, |e| edges.group(e).len() != 2)?.is_empty())
}
