//! Takes out triangles that meet others where they must not, with some around them, so that what is left can be closed
//! as holes are.

use super::{Changes, Draft, Effects};
use crate::budget::{Budget, Stopped};
use crate::geom::are_collinear;
use crate::mesh::{EdgeGroups, UnionFind, triangle_of};
use crate::spatial::{Bvh, Search, self_contacts};

/// Largest share of the triangles that may go, as one in so many: more than that is no local defect.
const ONE_IN_MIN: usize = 20;

/// Pieces of at most so many triangles that come apart by it go as well: they would be closed to slivers.
const CRUMB_MAX: u32 = 8;

/// Removes all triangles that pass through others, overlap or touch them, and `rings` rings of triangles around them.
/// Nothing happens where that would be more than one in twenty. The draft must be welded and without degenerate
/// triangles.
///
/// # Errors
/// When the budget stops the run.
pub fn remove_crossing(draft: &mut Draft, rings: u32, budget: &Budget) -> Result<Changes, Stopped> {
    let nothing = || Changes::counted([("triangles_removed", 0)]);
    let proper = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| draft.positions[v as usize]);
        !are_collinear(a, b, c)
    };
    if !draft.triangles.iter().all(proper) {
        return Ok(nothing());
    }
    let bvh = Bvh::build(&draft.positions, &draft.triangles, None, budget)?;
    let most = draft.triangles.len() / ONE_IN_MIN;
    let search = Search::All { keep: CONTACTS_MAX };
    let contacts = self_contacts(&draft.positions, &draft.triangles, &bvh, None, search, budget)?;
    drop(bvh);
    let mut is_kept = vec![true; draft.triangles.len()];
    for contact in &contacts.list {
        is_kept[contact.a as usize] = false;
        is_kept[contact.b as usize] = false;
    }
    for _ in 0..rings {
        budget.spend(draft.triangles.len() as u64 / 8)?;
        widen(draft, &mut is_kept);
    }
    let removed = is_kept.iter().filter(|&&kept| !kept).count();
    if removed == 0 || removed > most || contacts.count > contacts.list.len() as u64 {
        return Ok(nothing());
    }
    let crumbs = drop_crumbs(draft, &mut is_kept, budget)?;
    draft.retain_triangles(&is_kept);
    draft.drop_unused_vertices();
    let reason =
        format!("{} pairs of triangles met; they went with {rings} rings around them", contacts.count);
    let changes = Changes::counted([("triangles_removed", removed as u64), ("crumbs_removed", crumbs)]);
    let effects = Effects { removed_crossing: true, ..Effects::default() };
    Ok(Changes { reason, effects, ..changes })
}

/// Pairs that are looked at; where there are more, nothing is removed.
const CONTACTS_MAX: usize = 1 << 18;

/// Every triangle with a vertex of one that is not kept is not kept either.
fn widen(draft: &Draft, is_kept: &mut [bool]) {
    let mut is_near = vec![false; draft.positions.len()];
    for (corners, _) in draft.triangles.iter().zip(is_kept.iter()).filter(|(_, kept)| !**kept) {
        corners.iter().for_each(|&v| is_near[v as usize] = true);
    }
    for (corners, kept) in draft.triangles.iter().zip(is_kept) {
        *kept &= !corners.iter().any(|&v| is_near[v as usize]);
    }
}

/// Removes small pieces that are joined to nothing any more but were before; gives the number of their triangles.
fn drop_crumbs(draft: &Draft, is_kept: &mut [bool], budget: &Budget) -> Result<u64, Stopped> {
    let groups = EdgeGroups::build(&draft.triangles, draft.positions.len(), budget)?;
    let mut pieces = UnionFind::new(draft.triangles.len());
    let mut was_joined = vec![false; draft.triangles.len()];
    for group in groups.iter() {
        for pair in group.windows(2) {
            let [a, b] = [triangle_of(pair[0]), triangle_of(pair[1])];
            match [a, b].map(|t| is_kept[t as usize]) {
                [true, true] => {
                    pieces.unite(a, b);
                }
                [true, false] => was_joined[a as usize] = true,
                [false, true] => was_joined[b as usize] = true,
                [false, false] => {}
            }
        }
    }
    let pieces = pieces.into_components();
    let mut size = vec![0u32; pieces.count as usize];
    let mut is_torn = vec![false; pieces.count as usize];
    for (t, &piece) in pieces.of.iter().enumerate() {
        size[piece as usize] += 1;
        is_torn[piece as usize] |= was_joined[t];
    }
    let mut crumbs = 0;
    for (kept, &piece) in is_kept.iter_mut().zip(&pieces.of) {
        if *kept && is_torn[piece as usize] && size[piece as usize] <= CRUMB_MAX {
            *kept = false;
            crumbs += 1;
        }
    }
    Ok(crumbs)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;

    /// A flat sheet of `2 n n` triangles with a spike from below through one of its triangles.
    fn pierced(n: u32) -> Draft {
        let vertex = |i: u32| DVec3::new(f64::from(i % (n + 1)), f64::from(i / (n + 1)), 0.0);
        let mut positions: Vec<DVec3> = (0..(n + 1) * (n + 1)).map(vertex).collect();
        let corner = |r: u32, c: u32| r * (n + 1) + c;
        let mut triangles: Vec<[u32; 3]> = (0..n * n)
            .map(|i| (i / n, i % n))
            .flat_map(|(r, c)| {
                let [a, b] = [corner(r, c), corner(r, c + 1)];
                let [d, e] = [corner(r + 1, c), corner(r + 1, c + 1)];
                [[a, b, e], [a, e, d]]
            })
            .collect();
        let first = positions.len() as u32;
        let middle = f64::from(n / 2);
        positions.extend(
            [[0.7, 0.2, 0.5], [0.6, 0.1, -1.0], [0.8, 0.3, -1.0]]
                .map(|[x, y, z]| DVec3::new(middle + x, middle + y, z)),
        );
        triangles.push([first, first + 1, first + 2]);
        Draft {
            vertex_origin: (0..positions.len() as u32).collect(),
            triangle_origin: (0..triangles.len() as u32).collect(),
            positions,
            triangles,
            two_sided: Vec::new(),
            blends: Default::default(),
            polygons: Default::default(),
        }
    }

    #[test]
    fn what_crosses_goes_with_as_many_rings_as_asked() {
        for (rings, removed) in [(0, 2), (1, 14)] {
            let mut draft = pierced(20);
            let changes = remove_crossing(&mut draft, rings, &Budget::unlimited()).unwrap();
            assert_eq!(changes.count("triangles_removed"), removed, "{rings} rings");
            assert_eq!(draft.triangles.len() as u64, 801 - removed);
            assert!(draft.check().is_empty());
        }
    }

    #[test]
    fn nothing_goes_where_it_would_be_much() {
        let mut draft = pierced(3);
        let before = draft.clone();
        let changes = remove_crossing(&mut draft, 1, &Budget::unlimited()).unwrap();
        assert_eq!((changes.count("triangles_removed"), draft), (0, before));
    }
}
