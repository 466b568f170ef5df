//! What is behind new triangles: the nearest triangle of the source, over edges.

use super::{Draft, NEW};
use rustc_hash::FxHashMap;

impl Draft {
    /// The triangle of the source behind each triangle. Of new ones that of a triangle beside them, and so on inwards, ring by
    /// ring; of several the smallest. [`NEW`] where no way over edges leads to one.
    pub fn triangles_behind(&self) -> Vec<u32> {
        let mut behind = self.triangle_origin.clone();
        let mut around: FxHashMap<[u32; 2], Vec<u32>> = FxHashMap::default();
        let all = || self.triangle_origin.iter().zip(&self.triangles).zip(0u32..);
        for ((_, &corners), t) in all().filter(|((origin, _), _)| **origin == NEW) {
            for edge in edges(corners) {
                around.entry(edge).or_default().push(t);
            }
        }
        if around.is_empty() {
            return behind;
        }
        // New triangles beside those that were reached last, with what is behind these.
        let mut next: Vec<(u32, u32)> = Vec::new();
        let reach = |corners: [u32; 3], origin: u32, next: &mut Vec<(u32, u32)>| {
            let beside = edges(corners).into_iter().filter_map(|edge| around.get(&edge)).flatten();
            next.extend(beside.map(|&t| (t, origin)));
        };
        for ((&origin, &corners), _) in all().filter(|((origin, _), _)| **origin != NEW) {
            reach(corners, origin, &mut next);
        }
        while !next.is_empty() {
            next.retain(|&(t, _)| behind[t as usize] == NEW);
            next.sort_unstable();
            next.dedup_by_key(|&mut (t, _)| t);
            for (t, origin) in std::mem::take(&mut next) {
                behind[t as usize] = origin;
                reach(self.triangles[t as usize], origin, &mut next);
            }
        }
        behind
    }
}

/// The edges of a triangle, whichever way they are passed.
fn edges([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_patch_has_what_is_beside_it_and_its_middle_what_its_rim_has() {
        // A strip of five triangles, the second to fourth of them new, and a new one apart.
        let points: Vec<[f64; 3]> = (0..10).map(|i| [f64::from(i), f64::from(i % 2), 0.0]).collect();
        let triangles = [[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4], [4, 5, 6], [7, 8, 9]];
        let mut draft = Draft::of(&points, &triangles);
        draft.triangle_origin = vec![8, NEW, NEW, NEW, 3, NEW];
        assert_eq!(draft.triangles_behind(), [8, 8, 3, 3, 3, NEW]);
        draft.triangle_origin[1..4].copy_from_slice(&[5, 6, 7]);
        assert_eq!(draft.triangles_behind(), draft.triangle_origin);
    }
}
