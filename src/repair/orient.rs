//! Turns triangles so that neighbours agree. Inside and outside are not decided here.

use super::{Changes, Draft, Effects};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::triangle_area;
use crate::mesh::{EdgeGroups, ParityUnionFind, edge_of, triangle_of};

/// Orients each part that is connected across edges of exactly two triangles. The direction that holds the larger area
/// of a part stays; at equal areas that of its first triangle. Edges where a part contradicts itself (Möbius band) keep
/// two triangles in one direction.
///
/// # Errors
/// When the budget stops the run.
pub fn orient(draft: &mut Draft, budget: &Budget) -> Result<Changes, Stopped> {
    let groups = draft.edge_groups(budget)?;
    if agree(draft, &groups, budget)? {
        return Ok(Changes::counted([("triangles_flipped", 0), ("edges_in_conflict", 0)]));
    }
    let _charge = budget.charge(draft.triangles.len() as u64 * 21)?;
    let mut parts = ParityUnionFind::new(draft.triangles.len());
    let mut conflicts = 0;
    // The triangles of a polygon are related before an edge can contradict it, so that it turns as a whole.
    for (e, group) in groups.diagonals().chain(groups.edges()).enumerate() {
        if e % CHECK_EVERY == 0 {
            budget.check()?;
        }
        if let &[g, h] = group {
            let is_same_way = edge_of(&draft.triangles, g)[0] == edge_of(&draft.triangles, h)[0];
            conflicts += u64::from(!parts.relate(triangle_of(g), triangle_of(h), is_same_way));
        }
    }
    let flipped = flip_minorities(draft, &mut parts, budget)?;
    let changes = Changes::counted([("triangles_flipped", flipped), ("edges_in_conflict", conflicts)]);
    Ok(changes.with(Effects { turned_triangles: flipped, ..Effects::default() }))
}

/// Whether the two triangles of each edge and each diagonal run through it in different directions, so that nothing turns.
fn agree(draft: &Draft, groups: &EdgeGroups, budget: &Budget) -> Result<bool, Stopped> {
    for (e, group) in groups.diagonals().chain(groups.edges()).enumerate() {
        if e % CHECK_EVERY == 0 {
            budget.check()?;
        }
        if let &[g, h] = group
            && edge_of(&draft.triangles, g)[0] == edge_of(&draft.triangles, h)[0]
        {
            return Ok(false);
        }
    }
    Ok(true)
}

/// In each part, flips the triangles of the direction that holds less area.
fn flip_minorities(draft: &mut Draft, parts: &mut ParityUnionFind, budget: &Budget) -> Result<u64, Stopped> {
    // Area as the first triangle of the part runs, less area against it; in the place of that first triangle.
    let mut balance = vec![0.0; draft.triangles.len()];
    for t in 0..draft.triangles.len() {
        if t % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let area = triangle_area(draft.corners(t));
        let (first, is_against) = parts.find(t as u32);
        balance[first as usize] += if is_against { -area } else { area };
    }
    let mut flipped = 0;
    for t in 0..draft.triangles.len() {
        if t % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let (first, is_against) = parts.find(t as u32);
        if is_against == (balance[first as usize] >= 0.0) {
            draft.flip(t);
            flipped += 1;
        }
    }
    Ok(flipped)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;

    fn draft(points: &[[f64; 2]], triangles: &[[u32; 3]]) -> Draft {
        Draft {
            positions: points.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect(),
            vertex_origin: (0..points.len() as u32).collect(),
            triangles: triangles.to_vec(),
            triangle_origin: (0..triangles.len() as u32).collect(),
            two_sided: Vec::new(),
            blends: Default::default(),
            polygons: Default::default(),
        }
    }

    #[test]
    fn the_smaller_area_turns() {
        let points = [[0.0, 0.0], [9.0, 0.0], [0.0, 9.0], [9.0, 1.0]];
        let mut mesh = draft(&points, &[[1, 0, 3], [0, 1, 2]]);
        let changes = orient(&mut mesh, &Budget::unlimited()).unwrap();
        assert_eq!(
            mesh.triangles,
            [[1, 0, 3], [0, 1, 2]],
            "they run in opposite directions along 0-1 already"
        );
        assert_eq!(changes.count("triangles_flipped"), 0);

        let mut mesh = draft(&points, &[[0, 1, 3], [0, 1, 2]]);
        let changes = orient(&mut mesh, &Budget::unlimited()).unwrap();
        assert_eq!(mesh.triangles, [[0, 3, 1], [0, 1, 2]]);
        assert_eq!(changes.count("triangles_flipped"), 1);
    }

    #[test]
    fn at_equal_areas_the_first_triangle_stays() {
        let mut mesh = draft(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, -1.0]], &[[0, 1, 3], [0, 1, 2]]);
        orient(&mut mesh, &Budget::unlimited()).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 3], [0, 2, 1]]);
    }

    #[test]
    fn a_moebius_band_keeps_a_conflict() {
        let points = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
        let band = [[0, 1, 2], [1, 2, 3], [2, 3, 4], [3, 4, 0], [4, 0, 1]];
        let mut mesh = draft(&points, &band);
        let changes = orient(&mut mesh, &Budget::unlimited()).unwrap();
        assert_eq!(changes.count("edges_in_conflict"), 1);
    }

    #[test]
    fn an_edge_of_three_triangles_relates_none_of_them() {
        let mut mesh = draft(
            &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, 2.0], [0.0, 3.0]],
            &[[0, 1, 2], [0, 1, 3], [0, 1, 4]],
        );
        assert_eq!(orient(&mut mesh, &Budget::unlimited()).unwrap().count("triangles_flipped"), 0);
    }
}
