//! Drops triangles with a repeated corner. No gap opens: the two other edges of such a triangle are one edge.

use super::{Changes, Draft};

/// Drops triangles that name a vertex twice. To be run on welded vertices.
pub fn drop_degenerate(draft: &mut Draft) -> Changes {
    let is_kept: Vec<bool> = draft.triangles.iter().map(|&[a, b, c]| a != b && b != c && c != a).collect();
    let dropped = is_kept.iter().filter(|&&kept| !kept).count() as u64;
    if dropped > 0 {
        draft.retain_triangles(&is_kept);
    }
    Changes::counted([("triangles_dropped", dropped)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_that_names_a_vertex_twice_goes_and_the_others_stay() {
        let mut draft = Draft {
            triangles: vec![[0, 1, 1], [0, 1, 2], [2, 0, 2], [3, 3, 3]],
            triangle_origin: vec![0, 1, 2, 3],
            ..Draft::default()
        };
        assert_eq!(drop_degenerate(&mut draft).count("triangles_dropped"), 3);
        assert_eq!((draft.triangles, draft.triangle_origin), (vec![[0, 1, 2]], vec![1]));
    }
}
