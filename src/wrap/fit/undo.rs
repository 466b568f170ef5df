//! Takes moves back until no two triangles meet, exactly.

use super::normals::Stars;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3, Shared, ThreePointPlane, are_collinear, contact};
use crate::par;
use crate::spatial::{self, Bvh, Search, Terrains, coincident_f64};

/// How far a vertex goes back each time that what it belongs to meets something, as shares of its move: what all but passes is
/// about as near to the input as if it had not gone back.
const SHARES_BACK: [f64; 4] = [1.0 / 16.0, 1.0 / 8.0, 1.0 / 4.0, 1.0 / 2.0];

/// Rounds in which only the vertices of what meets go back.
const ROUNDS_NEAR: usize = 8;

/// Rounds before everything goes back.
const ROUNDS: usize = 13;

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
    nearest: impl Fn(DVec3) -> DVec3,
    budget: &Budget,
) -> Result<u64, Stopped> {
    let fitted = positions.to_vec();
    let mut times = vec![0u8; positions.len()];
    // After a search for contacts only triangles around a vertex that went back since can have begun to meet others.
    let mut changed: Option<Vec<u32>> = None;
    for round in 0..ROUNDS {
        let Offenders { vertices: mut bad, are_contacts } =
            offenders(positions, triangles, changed.as_deref(), budget)?;
        if bad.is_empty() {
            break;
        }
        for _ in ROUNDS_NEAR..=round {
            bad = around(&bad, stars).flat_map(|t| triangles[t as usize]).collect();
            bad.sort_unstable();
            bad.dedup();
        }
        for &v in &bad {
            let v = v as usize;
            if positions[v] == before[v] {
                continue;
            }
            let share = SHARES_BACK.get(usize::from(times[v])).filter(|_| round < ROUNDS_NEAR);
            positions[v] = share.map_or(before[v], |&share| nearest(fitted[v].lerp(before[v], share)));
            times[v] += 1;
        }
        if are_contacts {
            changed = Some(Vec::new());
        }
        if let Some(changed) = &mut changed {
            changed.extend(around(&bad, stars));
            changed.sort_unstable();
            changed.dedup();
        }
    }
    if !offenders(positions, triangles, None, budget)?.vertices.is_empty() {
        positions.copy_from_slice(before);
    }
    Ok(positions.iter().zip(&fitted).filter(|(now, fitted)| now != fitted).count() as u64)
}

/// The triangles around these vertices, those around several of them repeatedly.
fn around<'s>(vertices: &'s [u32], stars: &'s Stars) -> impl Iterator<Item = u32> + 's {
    vertices.iter().flat_map(|&v| stars.of_vertex(v as usize)).copied()
}

/// What breaks P0 or P1.
struct Offenders {
    /// Its vertices, ascending.
    vertices: Vec<u32>,
    /// Contacts were searched, which takes triangles with an area and vertices at places of their own.
    are_contacts: bool,
}

/// What breaks P0 or P1 `among` these triangles and all others, or everywhere.
fn offenders(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    among: Option<&[u32]>,
    budget: &Budget,
) -> Result<Offenders, Stopped> {
    let mut bad = at_one_place(positions, budget)?;
    bad.extend(flat(positions, triangles, among, budget)?);
    let are_contacts = bad.is_empty();
    if are_contacts {
        let bvh = Bvh::build(positions, triangles, None, budget)?;
        let meeting = match among {
            None => everywhere(positions, triangles, &bvh, budget)?,
            Some(among) => of_these(positions, triangles, among, &bvh, budget)?,
        };
        bad.extend(meeting.into_iter().flat_map(|t| triangles[t as usize]));
    }
    bad.sort_unstable();
    bad.dedup();
    Ok(Offenders { vertices: bad, are_contacts })
}

/// Vertices that are where another one is.
fn at_one_place(positions: &[DVec3], budget: &Budget) -> Result<Vec<u32>, Stopped> {
    let coincident = coincident_f64(positions, budget)?;
    let first = |v: u32| coincident.first[coincident.group[v as usize] as usize];
    Ok((0..positions.len() as u32).filter(|&v| first(v) != v).flat_map(|v| [v, first(v)]).collect())
}

/// Vertices of triangles without an area.
fn flat(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    among: Option<&[u32]>,
    budget: &Budget,
) -> Result<Vec<u32>, Stopped> {
    let count = among.map_or(triangles.len(), <[u32]>::len);
    let flat = par::try_map_ranges(count, CHECK_EVERY, |range| {
        budget.check()?;
        let mut flat = Vec::new();
        for place in range {
            let corners = triangles[among.map_or(place, |among| among[place] as usize)];
            let [a, b, c] = corners.map(|v| positions[v as usize]);
            if are_collinear(a, b, c) {
                flat.extend(corners);
            }
        }
        Ok(flat)
    })?;
    Ok(flat.concat())
}

/// Triangles that meet others.
fn everywhere(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    bvh: &Bvh,
    budget: &Budget,
) -> Result<Vec<u32>, Stopped> {
    let search = Search::All { keep: CONTACTS };
    // The surface is closed: every edge has its two triangles.
    let terrains = Terrains::find(positions, triangles, &[], budget)?;
    let contacts = spatial::self_contacts(positions, triangles, bvh, Some(&terrains), search, budget)?;
    Ok(contacts.list.iter().flat_map(|contact| [contact.a, contact.b]).collect())
}

/// Triangles that meet one of `these`, and those of these that do.
fn of_these(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    these: &[u32],
    bvh: &Bvh,
    budget: &Budget,
) -> Result<Vec<u32>, Stopped> {
    let found = par::try_map_ranges(these.len(), 256, |range| {
        let mut found = Vec::new();
        for &t in &these[range] {
            let corners = triangles[t as usize];
            let plane = ThreePointPlane::through(corners.map(|v| positions[v as usize]));
            let bounds = Aabb::of(corners.map(|v| positions[v as usize]));
            bvh.visit_box(bounds, budget, |other| {
                let others = triangles[other as usize];
                let shared = Shared::between(corners, others);
                let points = others.map(|v| &positions[v as usize]);
                if other != t && contact(&plane, points, shared).is_some() {
                    found.extend([t, other]);
                }
            })?;
        }
        budget.spend(4)?;
        Ok(found)
    })?;
    Ok(found.concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corner_that_went_through_the_base_comes_back() {
        let corners =
            [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]].map(DVec3::from_array);
        // Two tetrahedra, apart before; then a corner of the second is inside the first.
        let before: Vec<DVec3> = corners.into_iter().chain(corners.map(|p| p + 9.0)).collect();
        let tetrahedron = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let triangles: Vec<[u32; 3]> =
            tetrahedron.into_iter().chain(tetrahedron.map(|t| t.map(|v| v + 4))).collect();
        let budget = Budget::unlimited();
        let stars = Stars::of(&triangles, 8, &budget).unwrap();
        let mut positions = before.clone();
        positions[4] = DVec3::splat(0.5);
        positions[1] = DVec3::new(4.5, 0.0, 0.0);
        let taken_back = until_nothing_meets(&mut positions, &before, &triangles, &stars, |p| p, &budget).unwrap();
        assert!(taken_back >= 1 && positions[4] == before[4]);
        positions[1] = positions[0];
        until_nothing_meets(&mut positions, &before, &triangles, &stars, |p| p, &budget).unwrap();
        assert_eq!(positions[1], before[1]);
    }
}
