//! Patches of holes that a seam of the texture runs into: what is between the points at their rim is no place of the texture.

use super::{Draft, NEW};
use crate::mesh::UnionFind;
use rustc_hash::{FxHashMap, FxHashSet};

/// For each triangle of `draft` whether it is of a patch at whose rim triangles have different texture points at one vertex.
/// `points_of(t)` has the points at the corners of triangle `t`, if it is no patch and has some.
pub(super) fn are_over_seams(draft: &Draft, points_of: impl Fn(usize) -> Option<[[f64; 2]; 3]>) -> Vec<bool> {
    let mut over = vec![false; draft.triangles.len()];
    let mut is_of_patch = vec![false; draft.positions.len()];
    let mut beside: FxHashMap<[u32; 2], u32> = FxHashMap::default();
    let mut patches = UnionFind::new(draft.triangles.len());
    let is_new = |t: usize| draft.triangle_origin[t] == NEW;
    for t in (0..draft.triangles.len()).filter(|&t| is_new(t)) {
        for [a, b] in edges(draft.triangles[t]) {
            is_of_patch[a as usize] = true;
            beside.insert([a, b], t as u32);
            if let Some(&other) = beside.get(&[b, a]) {
                patches.unite(t as u32, other);
            }
        }
    }
    if beside.is_empty() {
        return over;
    }
    let mut point_at: FxHashMap<[u32; 2], [u64; 2]> = FxHashMap::default();
    let mut with_seam: FxHashSet<u32> = FxHashSet::default();
    for t in (0..draft.triangles.len()).filter(|&t| !is_new(t)) {
        let corners = draft.triangles[t];
        if corners.iter().filter(|&&v| is_of_patch[v as usize]).count() < 2 {
            continue;
        }
        let Some(points) = points_of(t) else { continue };
        for (c, [a, b]) in edges(corners).into_iter().enumerate() {
            // Faces that contradict their neighbours stay as they are, so the patch may run along them in either direction.
            let Some(&patch) = beside.get(&[b, a]).or_else(|| beside.get(&[a, b])) else { continue };
            let patch = patches.find(patch);
            for (v, point) in [(a, points[c]), (b, points[(c + 1) % 3])] {
                let point = point.map(f64::to_bits);
                if *point_at.entry([patch, v]).or_insert(point) != point {
                    with_seam.insert(patch);
                }
            }
        }
    }
    for t in (0..draft.triangles.len()).filter(|&t| is_new(t)) {
        over[t] = with_seam.contains(&patches.find(t as u32));
    }
    over
}

fn edges([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fan of four triangles around a square hole, which a patch of two closes.
    fn closed() -> Draft {
        let points = [
            [0.0, 0.0],
            [1.0, 0.0],
            [1.0, 1.0],
            [0.0, 1.0],
            [0.5, -1.0],
            [2.0, 0.5],
            [0.5, 2.0],
            [-1.0, 0.5],
        ];
        let points = points.map(|[x, y]| [x, y, 0.0]);
        let mut draft =
            Draft::of(&points, &[[1, 0, 4], [2, 1, 5], [3, 2, 6], [0, 3, 7], [0, 1, 2], [0, 2, 3]]);
        draft.triangle_origin[4..].fill(NEW);
        draft
    }

    #[test]
    fn a_patch_is_over_a_seam_where_points_at_a_vertex_of_its_rim_differ() {
        let draft = closed();
        let at = |v: u32| [f64::from(v), 0.5];
        let points = |t: usize| (t < 4).then(|| draft.triangles[t].map(at));
        assert_eq!(are_over_seams(&draft, points), [false; 6]);
        let torn = |t: usize| points(t).map(|p| if t == 3 { p.map(|[u, v]| [u + 1.0, v]) } else { p });
        assert_eq!(are_over_seams(&draft, torn), [false, false, false, false, true, true]);
        // A seam that ends in a triangle that only touches the rim is none of the patch.
        let mut beside = draft.clone();
        beside.triangles.push([4, 1, 5]);
        beside.triangle_origin.push(6);
        let only_beside = |t: usize| if t == 6 { Some([[9.0, 9.0]; 3]) } else { points(t) };
        assert_eq!(are_over_seams(&beside, only_beside), [false; 7]);
    }
}
