//! Whether the triangles around the vertices between parts are one fan each.
//!
//! Inside a part the corner table says so. The triangles between parts are in no table in the round in which the input
//! is judged.

use super::mesh::{Mesh, MeshDivision};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::par;

/// A triangle seen from one of its corners: the corner, and its other two in the triangle's order.
type Spoke = [u32; 3];

/// True when each vertex between parts has one fan of triangles, open or closed. Every edge has at most two triangles,
/// in opposite directions.
pub(super) fn are_fans_between<S: Copy + Send + Sync>(
    mesh: &Mesh<S>,
    division: &MeshDivision,
    budget: &Budget,
) -> Result<bool, Stopped> {
    let of_range = par::try_map_ranges(mesh.triangles.len(), CHECK_EVERY, |range| {
        budget.check()?;
        let spokes = mesh.triangles[range].iter().flat_map(|&[a, b, c]| [[a, b, c], [b, c, a], [c, a, b]]);
        Ok(spokes.filter(|spoke| division.is_between[spoke[0] as usize]).collect::<Vec<Spoke>>())
    })?;
    let mut spokes = of_range.concat();
    par::sort_unstable(&mut spokes);
    let mut fans = spokes.chunk_by(|a, b| a[0] == b[0]);
    Ok(fans.all(is_one_fan))
}

/// True when the spokes of a vertex follow one another. They are sorted by where they begin, each somewhere else.
fn is_one_fan(spokes: &[Spoke]) -> bool {
    let from = |v: u32| spokes.binary_search_by_key(&v, |spoke| spoke[1]).ok();
    let mut ends: Vec<u32> = spokes.iter().map(|spoke| spoke[2]).collect();
    ends.sort_unstable();
    // An open fan begins where no other spoke ends.
    let first = spokes.iter().position(|spoke| ends.binary_search(&spoke[1]).is_err()).unwrap_or(0);
    let mut count = 1;
    let mut at = first;
    while let Some(next) = from(spokes[at][2]).filter(|&next| next != first && count < spokes.len()) {
        (at, count) = (next, count + 1);
    }
    count == spokes.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_fan_open_or_closed_is_told_from_two() {
        let spokes = |sides: &[[u32; 2]]| {
            let mut spokes: Vec<Spoke> = sides.iter().map(|&[from, to]| [9, from, to]).collect();
            spokes.sort_unstable();
            is_one_fan(&spokes)
        };
        assert!(spokes(&[[1, 2]]));
        assert!(spokes(&[[1, 2], [2, 0], [0, 4]]));
        assert!(spokes(&[[1, 2], [2, 0], [0, 1]]));
        assert!(!spokes(&[[1, 2], [3, 4]]));
        assert!(!spokes(&[[1, 2], [2, 1], [3, 4], [4, 3]]));
        assert!(!spokes(&[[1, 2], [3, 4], [4, 3]]));
    }
}
