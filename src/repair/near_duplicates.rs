//! Drops sheets that lie triangle by triangle within a distance of other ones, in the same direction.

use super::{Changes, Draft};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::mesh::{EdgeGroups, UnionFind, edge_of, triangle_of};
use crate::spatial::Bvh;

/// Drops every sheet (triangles joined across edges with two of them in opposite directions) of which each triangle has a
/// near copy: one of another sheet that stays, whose corners are within `epsilon` of its own, in the same turn. Of two
/// such sheets the later one goes, as its first triangle says; what is only in part near another sheet stays whole.
///
/// # Errors
/// When the budget stops the run.
pub fn drop_near_duplicates(draft: &mut Draft, epsilon: f64, budget: &Budget) -> Result<Changes, Stopped> {
    let sheets = sheets(draft, budget)?;
    let count = sheets.iter().max().map_or(0, |max| *max as usize + 1);
    let mut members: Vec<Vec<u32>> = vec![Vec::new(); count];
    for (t, &sheet) in sheets.iter().enumerate() {
        members[sheet as usize].push(t as u32);
    }
    let bvh = Bvh::build(&draft.positions, &draft.triangles, None, budget)?;
    let mut is_gone = vec![false; count];
    for sheet in (0..count).rev() {
        let mut is_near = true;
        for &t in &members[sheet] {
            let corners = draft.corners(t as usize);
            let mut has_copy = false;
            let reach = DVec3::splat(epsilon);
            let query = Aabb { min: corners[0] - reach, max: corners[0] + reach };
            bvh.visit_box(query, budget, |other| {
                let of = sheets[other as usize] as usize;
                has_copy |= of != sheet
                    && !is_gone[of]
                    && is_near_copy(corners, draft.corners(other as usize), epsilon);
            })?;
            if !has_copy {
                is_near = false;
                break;
            }
        }
        is_gone[sheet] = is_near;
    }
    let is_kept: Vec<bool> = sheets.iter().map(|&sheet| !is_gone[sheet as usize]).collect();
    let gone = is_kept.iter().filter(|&&is_kept| !is_kept).count() as u64;
    let removed_parts = (0..count)
        .filter(|&sheet| is_gone[sheet])
        .map(|sheet| draft.triangle_origin[members[sheet][0] as usize])
        .collect();
    draft.retain_triangles(&is_kept);
    draft.drop_unused_vertices();
    let counts = [
        ("sheets_dropped", is_gone.iter().filter(|&&gone| gone).count() as u64),
        ("triangles_removed", gone),
    ];
    Ok(Changes { removed_parts, ..Changes::counted(counts) })
}

/// For each triangle the number of its sheet; sheets are numbered by their first triangles.
fn sheets(draft: &Draft, budget: &Budget) -> Result<Vec<u32>, Stopped> {
    let groups = EdgeGroups::build(&draft.triangles, draft.positions.len(), budget)?;
    let mut sets = UnionFind::new(draft.triangles.len());
    for (e, group) in groups.iter().enumerate() {
        if e % CHECK_EVERY == 0 {
            budget.check()?;
        }
        if let &[g, h] = group
            && edge_of(&draft.triangles, g)[0] != edge_of(&draft.triangles, h)[0]
        {
            sets.unite(triangle_of(g), triangle_of(h));
        }
    }
    Ok(sets.into_components().of)
}

/// True when the corners are within `epsilon` of each other one by one, in the same turn.
fn is_near_copy(a: [DVec3; 3], b: [DVec3; 3], epsilon: f64) -> bool {
    (0..3).any(|turn| (0..3).all(|k| a[k].distance(b[(k + turn) % 3]) <= epsilon))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::repair::Effects;

    /// A tetrahedron, and the given triangles with vertices of their own at these points.
    fn with(others: &[[[f64; 3]; 3]]) -> Draft {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let mut positions = corners.map(DVec3::from_array).to_vec();
        positions.extend(others.as_flattened().iter().map(|&p| DVec3::from_array(p)));
        let mut triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        triangles.extend((0..others.len() as u32).map(|i| [4 + 3 * i, 5 + 3 * i, 6 + 3 * i]));
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

    fn dropped(draft: &mut Draft, epsilon: f64) -> u64 {
        drop_near_duplicates(draft, epsilon, &Budget::unlimited()).unwrap().count("sheets_dropped")
    }

    const SLANTED: [[f64; 3]; 3] = [[0.0, 1.0, 0.01], [0.0, 0.0, 1.01], [1.0, 0.0, 0.01]];

    #[test]
    fn a_triangle_that_floats_over_a_face_in_its_direction_goes() {
        let mut draft = with(&[SLANTED]);
        let before = draft.clone();
        assert_eq!(dropped(&mut draft, 0.009), 0);
        assert_eq!(draft, before);
        let changes = drop_near_duplicates(&mut draft, 0.011, &Budget::unlimited()).unwrap();
        assert_eq!(changes.counts, [("sheets_dropped", 1), ("triangles_removed", 1)]);
        assert_eq!(changes.removed_parts, [4]);
        // What `crossing` removes decides about further attempts; this does not, though it counts by the same name.
        assert_eq!(changes.effects, Effects::default());
        assert_eq!(draft, with(&[]));
    }

    #[test]
    fn a_triangle_in_the_other_direction_is_a_wall_and_stays() {
        let [a, b, c] = SLANTED;
        assert_eq!(dropped(&mut with(&[[a, c, b]]), 0.1), 0);
    }

    #[test]
    fn of_copies_of_each_other_one_stays() {
        let far = SLANTED.map(|[x, y, z]| [x + 9.0, y, z]);
        let farther = far.map(|[x, y, z]| [x, y, z + 0.01]);
        let mut draft = with(&[far, farther, farther]);
        assert_eq!(dropped(&mut draft, 0.02), 2);
        assert_eq!(draft, with(&[far]));
    }

    #[test]
    fn a_sheet_that_is_near_in_part_stays_whole() {
        let mut draft = with(&[SLANTED]);
        draft.positions.push(DVec3::splat(2.0));
        draft.vertex_origin.push(7);
        draft.triangles.push([5, 4, 7]);
        draft.triangle_origin.push(5);
        assert_eq!(dropped(&mut draft, 0.1), 0);
    }
}
