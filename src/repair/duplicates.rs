//! Drops faces that have the vertices of another one: triangles, and polygons with the same corners in the same order.

use super::{Changes, Draft, Effects};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::mesh::{
    EdgeGroups, Outlines, Polygons, UnionFind, edge_of, polygon_copies, prev_corner, triangle_of,
};

/// What becomes of two triangles with the same vertices in opposite directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum OppositePairs {
    /// Both go: a wall between two bodies, inside the solid that they are together. They stay as one triangle where they
    /// are the surface of a body or sheet of their own, which would vanish.
    #[default]
    Cancel,
    /// The first stays: a surface that the file gives in both directions.
    KeepFirst,
}

/// Leaves at most one triangle for each set of three vertices. Copies in one direction: the first stays. In both
/// directions: the first of the more frequent direction; in equal numbers, as `opposite` says.
///
/// # Errors
/// When the budget stops the run.
pub fn drop_duplicates(
    draft: &mut Draft,
    opposite: OppositePairs,
    budget: &Budget,
) -> Result<Changes, Stopped> {
    let outlines = draft.outlines(budget)?;
    let groups = EdgeGroups::of_faces(&draft.triangles, &outlines, draft.positions.len(), budget)?;
    let mut is_kept = vec![true; draft.triangles.len()];
    let mut pairs = Vec::new();
    let mut copies = 0;
    let mut choose = |same: &[Copied]| {
        let balance: i64 = same.iter().map(|s| if s.is_ascending { 1 } else { -1 }).sum();
        let stays = |s: &&Copied| balance == 0 || s.is_ascending == (balance > 0);
        let kept = same.iter().find(stays).map_or(same[0].triangle, |s| s.triangle);
        let face = |first: u32| draft.polygons.face_from(first as usize);
        for s in same {
            is_kept[face(s.triangle)].fill(s.triangle == kept);
        }
        copies += same.len() as u64 - 1;
        if balance == 0 {
            pairs.extend(face(kept).map(|t| t as u32));
        }
    };
    for_each_vertex_set(draft, &groups, budget, &mut choose)?;
    for_each_outline(draft, &outlines, budget, &mut choose)?;
    pairs.sort_unstable();
    let surfaces = match opposite {
        OppositePairs::KeepFirst => vec![true; pairs.len()],
        OppositePairs::Cancel => own_surfaces(draft, &groups, &pairs, &is_kept, budget)?,
    };
    let mut cancelled = 0;
    for (&t, is_surface) in pairs.iter().zip(surfaces) {
        if is_surface {
            draft.two_sided.push(draft.triangle_origin[t as usize]);
        } else {
            is_kept[t as usize] = false;
            cancelled += 1;
        }
    }
    draft.two_sided.sort_unstable();
    draft.retain_triangles(&is_kept);
    Ok(Changes {
        reason: reason(pairs.len() as u64, cancelled),
        effects: Effects { cancelled_opposite_pairs: cancelled > 0, ..Effects::default() },
        ..Changes::counted([("copies_dropped", copies - cancelled), ("opposite_pairs_cancelled", cancelled)])
    })
}

/// A face among others with the same vertices, by its first triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Copied {
    /// The largest of its vertices; of polygons, which one they are.
    last: u32,
    triangle: u32,
    /// True when it runs through its vertices in ascending order; of polygons, as the first of them does.
    is_ascending: bool,
}

/// Calls `visit` with the triangles of each set of vertices that several have, by id.
fn for_each_vertex_set(
    draft: &Draft,
    groups: &EdgeGroups,
    budget: &Budget,
    visit: &mut impl FnMut(&[Copied]),
) -> Result<(), Stopped> {
    let triangles = &draft.triangles;
    let mut on_edge = Vec::new();
    for (e, group) in groups.iter().enumerate() {
        if e % CHECK_EVERY == 0 {
            budget.check()?;
        }
        // Triangles with the same vertices are met together at the edge of their two smaller ones.
        on_edge.clear();
        on_edge.extend(group.iter().filter_map(|&h| {
            let ([a, b], last) = (edge_of(triangles, h), edge_of(triangles, prev_corner(h))[0]);
            let is_face = last > a.max(b) && !draft.polygons.is_part(triangle_of(h) as usize);
            is_face.then_some(Copied { last, triangle: triangle_of(h), is_ascending: a < b })
        }));
        on_edge.sort_unstable();
        on_edge.chunk_by(|a, b| a.last == b.last).filter(|same| same.len() > 1).for_each(&mut *visit);
    }
    Ok(())
}

/// Calls `visit` with the polygons of each outline that several have, from whichever corner and in either direction, by id.
fn for_each_outline(
    draft: &Draft,
    outlines: &Outlines,
    budget: &Budget,
    visit: &mut impl FnMut(&[Copied]),
) -> Result<(), Stopped> {
    let mut polygons = Polygons { starts: vec![0], ..Polygons::default() };
    for face in draft.polygons.faces(draft.polygons.len()).filter(|face| face.len() > 1) {
        let first = face.start as u32;
        polygons.faces.push(polygons.faces.len() as u32);
        polygons.corners.extend(outlines.along(first).map(|h| edge_of(&draft.triangles, h)[0]));
        polygons.starts.push(polygons.corners.len() as u32);
        polygons.first_triangles.push(first);
    }
    let copies = polygon_copies(&polygons, |v| v, budget)?;
    let mut all: Vec<Copied> = Vec::with_capacity(2 * copies.len());
    let triangle = |polygon: u32| polygons.first_triangles[polygon as usize];
    for copy in copies {
        let (last, is_ascending) = (copy.of, !copy.is_reversed);
        all.push(Copied { last, triangle: triangle(copy.of), is_ascending: true });
        all.push(Copied { last, triangle: triangle(copy.polygon), is_ascending });
    }
    all.sort_unstable();
    all.dedup();
    all.chunk_by(|a, b| a.last == b.last).for_each(visit);
    Ok(())
}

fn reason(pairs: u64, cancelled: u64) -> String {
    match (cancelled, pairs - cancelled) {
        (0, 0) => String::new(),
        (_, 0) => format!(
            "{cancelled} pairs of opposite triangles are walls inside a solid or without thickness: both went"
        ),
        (0, kept) => {
            format!("{kept} pairs of opposite triangles are a surface given in both directions: one stayed")
        }
        (_, kept) => format!(
            "{cancelled} pairs of opposite triangles are walls inside a solid or without thickness: both went; \
             {kept} pairs are the surface of a part of its own: one stayed"
        ),
    }
}

/// For each of the `pairs` (one triangle of each, ascending) whether it belongs to a surface that would be lost without
/// it: a closed one of nothing but pairs, or a component of nothing but pairs.
fn own_surfaces(
    draft: &Draft,
    groups: &EdgeGroups,
    pairs: &[u32],
    is_kept: &[bool],
    budget: &Budget,
) -> Result<Vec<bool>, Stopped> {
    if pairs.is_empty() {
        return Ok(Vec::new());
    }
    let walls: Vec<[u32; 3]> = pairs.iter().map(|&t| draft.triangles[t as usize]).collect();
    let wall_groups = EdgeGroups::build(&walls, draft.positions.len(), budget)?;
    let mut patches = UnionFind::new(walls.len());
    for group in wall_groups.iter() {
        if let &[g, h] = group {
            patches.unite(triangle_of(g), triangle_of(h));
        }
    }
    let patches = patches.into_components();
    let mut is_closed = vec![true; patches.count as usize];
    for h in wall_groups.iter().filter(|group| group.len() != 2).flatten() {
        is_closed[patches.of[triangle_of(*h) as usize] as usize] = false;
    }
    let is_alone = components_of_pairs(draft, groups, pairs, is_kept, budget)?;
    let of_patch = |i: usize| is_closed[patches.of[i] as usize];
    Ok((0..pairs.len()).map(|i| of_patch(i) || is_alone[i]).collect())
}

/// For each pair whether its component, connected by edges, holds nothing that stays but pairs.
fn components_of_pairs(
    draft: &Draft,
    groups: &EdgeGroups,
    pairs: &[u32],
    is_kept: &[bool],
    budget: &Budget,
) -> Result<Vec<bool>, Stopped> {
    let parts = groups.components(budget)?;
    let mut is_other = is_kept.to_vec();
    for &t in pairs {
        is_other[t as usize] = false;
    }
    let mut has_other = vec![false; parts.count as usize];
    for t in (0..draft.triangles.len()).filter(|&t| is_other[t]) {
        has_other[parts.of[t] as usize] = true;
    }
    Ok(pairs.iter().map(|&t| !has_other[parts.of[t as usize] as usize]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;

    const CUBE: [[u32; 3]; 12] = [
        [0, 2, 1],
        [0, 3, 2],
        [4, 5, 6],
        [4, 6, 7],
        [0, 1, 5],
        [0, 5, 4],
        [1, 2, 6],
        [1, 6, 5],
        [2, 3, 7],
        [2, 7, 6],
        [3, 0, 4],
        [3, 4, 7],
    ];

    fn flipped(triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
        triangles.iter().map(|&[a, b, c]| [a, c, b]).collect()
    }

    fn dropped(triangles: &[[u32; 3]], opposite: OppositePairs) -> (Draft, Changes) {
        let mut draft = Draft {
            positions: vec![DVec3::ZERO; 12],
            vertex_origin: (0..12).collect(),
            triangles: triangles.to_vec(),
            triangle_origin: (0..triangles.len() as u32).collect(),
            two_sided: Vec::new(),
            blends: Default::default(),
            polygons: Default::default(),
        };
        let changes = drop_duplicates(&mut draft, opposite, &Budget::unlimited()).unwrap();
        (draft, changes)
    }

    #[test]
    fn of_copies_in_one_direction_the_first_stays() {
        let (draft, changes) = dropped(&[[5, 6, 7], [0, 1, 2], [1, 2, 0], [2, 0, 1]], OppositePairs::Cancel);
        assert_eq!(draft.triangle_origin, [0, 1]);
        assert_eq!(changes.count("copies_dropped"), 2);
    }

    #[test]
    fn the_more_frequent_direction_stays() {
        let (draft, _) = dropped(&[[0, 2, 1], [0, 1, 2], [1, 2, 0]], OppositePairs::Cancel);
        assert_eq!(draft.triangle_origin, [1]);
    }

    #[test]
    fn a_wall_between_two_cubes_goes_on_both_sides() {
        // The second cube stands on the first: vertices 4..8 are its bottom.
        let upper: Vec<[u32; 3]> = CUBE.iter().map(|t| t.map(|v| v + 4)).collect();
        let both: Vec<[u32; 3]> = CUBE.iter().copied().chain(upper).collect();
        let (draft, changes) = dropped(&both, OppositePairs::Cancel);
        assert_eq!(draft.triangles.len(), 20);
        assert_eq!(changes.count("opposite_pairs_cancelled"), 2);
        assert_eq!(changes.count("copies_dropped"), 0);
        let (draft, changes) = dropped(&both, OppositePairs::KeepFirst);
        assert_eq!(draft.triangles.len(), 22);
        assert_eq!(changes.count("copies_dropped"), 2);
    }

    #[test]
    fn a_cube_given_in_both_directions_stays_a_cube() {
        let both: Vec<[u32; 3]> = CUBE.into_iter().chain(flipped(&CUBE)).collect();
        let (draft, changes) = dropped(&both, OppositePairs::Cancel);
        assert_eq!(draft.triangles, CUBE);
        assert_eq!(draft.two_sided, (0..12).collect::<Vec<u32>>());
        assert_eq!(changes.count("copies_dropped"), 12);
    }

    #[test]
    fn a_sheet_given_in_both_directions_stays_a_sheet_but_a_fin_of_a_cube_goes() {
        let (draft, _) = dropped(&[[0, 1, 2], [0, 2, 1]], OppositePairs::Cancel);
        assert_eq!(draft.triangles, [[0, 1, 2]]);
        let finned: Vec<[u32; 3]> = CUBE.into_iter().chain([[0, 1, 8], [0, 8, 1]]).collect();
        let (draft, _) = dropped(&finned, OppositePairs::Cancel);
        assert_eq!(draft.triangles, CUBE);
    }
}
