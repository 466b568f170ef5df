//! Takes moves back until no two triangles meet, exactly.

use super::normals::Stars;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{DVec3, are_collinear};
use crate::par;
use crate::spatial::{self, Bvh, Search, coincident_f64};

/// Rounds in which only the vertices of what meets go back.
const ROUNDS_NEAR: usize = 4;

/// Rounds before everything goes back.
const ROUNDS: usize = 9;

/// Contacts to take back in a round.
const CONTACTS: usize = 1 << 20;

/// Puts vertices back `before` their moves, those of triangles that meet or have no area and then ever more around them,
/// until nothing meets. `before` has no contacts. Gives the number of vertices that went back.
///
/// # Errors
/// When the budget stops the run.
pub(super) fn until_nothing_meets(
    positions: &mut [DVec3],
    before: &[DVec3],
    triangles: &[[u32; 3]],
    stars: &Stars,
    budget: &Budget,
) -> Result<u64, Stopped> {
    let mut taken_back = 0;
    for round in 0..ROUNDS {
        let mut bad = offenders(positions, triangles, budget)?;
        if bad.is_empty() {
            return Ok(taken_back);
        }
        for _ in ROUNDS_NEAR..=round {
            let wider: Vec<u32> = bad
                .iter()
                .flat_map(|&v| stars.of_vertex(v as usize).iter().flat_map(|&t| triangles[t as usize]))
                .collect();
            bad = wider;
            bad.sort_unstable();
            bad.dedup();
        }
        for v in bad.into_iter().map(|v| v as usize) {
            taken_back += u64::from(positions[v] != before[v]);
            positions[v] = before[v];
        }
    }
    if !offenders(positions, triangles, budget)?.is_empty() {
        for (position, &before) in positions.iter_mut().zip(before) {
            taken_back += u64::from(*position != before);
            *position = before;
        }
    }
    Ok(taken_back)
}

/// The vertices of what breaks P0 or P1, ascending.
fn offenders(positions: &[DVec3], triangles: &[[u32; 3]], budget: &Budget) -> Result<Vec<u32>, Stopped> {
    let coincident = coincident_f64(positions, budget)?;
    let mut bad: Vec<u32> = (0..positions.len() as u32)
        .filter(|&v| coincident.first[coincident.group[v as usize] as usize] != v)
        .collect();
    let firsts: Vec<u32> =
        bad.iter().map(|&v| coincident.first[coincident.group[v as usize] as usize]).collect();
    bad.extend(firsts);
    let flat = par::try_map_ranges(triangles.len(), CHECK_EVERY, |range| {
        budget.check()?;
        let is_flat = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| positions[v as usize]);
            are_collinear(a, b, c)
        };
        Ok(triangles[range].iter().filter(|t| is_flat(t)).flatten().copied().collect::<Vec<u32>>())
    })?;
    bad.extend(flat.into_iter().flatten());
    if bad.is_empty() {
        let bvh = Bvh::build(positions, triangles, None, budget)?;
        let contacts =
            spatial::self_contacts(positions, triangles, &bvh, None, Search::All { keep: CONTACTS }, budget)?;
        bad.extend(contacts.list.iter().flat_map(|c| [c.a, c.b]).flat_map(|t| triangles[t as usize]));
    }
    bad.sort_unstable();
    bad.dedup();
    Ok(bad)
}
