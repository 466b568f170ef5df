//! Divides a triangle at vertices on its edges. No coordinates here.

/// The parts of triangle `a b c` when the lists name the vertices inside its edges `ab`, `bc` and `ca`, each in the order
/// of its direction. The parts cover the triangle, use all the vertices and run in its direction, and none has its three
/// vertices on one edge. One part, the triangle itself, when nothing is on its edges.
///
/// ```text
///          c                  c
///         / \                //|\
///        /   \     gives    / | \\       a fan around c; vertices on bc and ca are then reached by
///       /     \            / /  | \      fans around v and u
///      a--u--v-b          a--u--v--b
/// ```
pub fn divide([a, b, c]: [u32; 3], [on_ab, on_bc, on_ca]: [&[u32]; 3]) -> Vec<[u32; 3]> {
    if on_ab.is_empty() {
        if on_bc.is_empty() && on_ca.is_empty() {
            return vec![[a, b, c]];
        }
        return divide([b, c, a], [on_bc, on_ca, on_ab]);
    }
    let (first, last) = (on_ab[0], on_ab[on_ab.len() - 1]);
    let mut parts = Vec::with_capacity(on_ab.len() + on_bc.len() + on_ca.len() + 1);
    fan(c, on_ab, &mut parts);
    fan(first, &[&[c], on_ca, &[a]].concat(), &mut parts);
    fan(last, &[&[b], on_bc, &[c]].concat(), &mut parts);
    parts
}

/// The triangles between `apex` and each step of `path`.
fn fan(apex: u32, path: &[u32], parts: &mut Vec<[u32; 3]>) {
    parts.extend(path.windows(2).map(|step| [step[0], step[1], apex]));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_on_the_edges_leaves_the_triangle() {
        assert_eq!(divide([0, 1, 2], [&[], &[], &[]]), [[0, 1, 2]]);
    }

    #[test]
    fn one_vertex_on_an_edge_gives_two_triangles() {
        assert_eq!(divide([0, 1, 2], [&[9], &[], &[]]), [[2, 0, 9], [1, 2, 9]]);
        assert_eq!(divide([0, 1, 2], [&[], &[], &[9]]), [[1, 2, 9], [0, 1, 9]]);
    }

    /// Vertices on the edges of the triangle (0,0) (12,0) (0,12) at whole steps: the parts must have the area of all and
    /// each a positive one, and use each step of the boundary once.
    #[test]
    fn parts_tile_the_triangle_whatever_is_on_its_edges() {
        let at = |v: u32| match v {
            0..12 => [i64::from(v), 0],
            12..24 => [24 - i64::from(v), i64::from(v) - 12],
            _ => [0, 36 - i64::from(v)],
        };
        for [i, j, k] in [[0, 0, 1], [1, 0, 1], [2, 3, 0], [0, 4, 4], [5, 5, 5], [11, 11, 11]] {
            let on = |from: u32, n: u32| (from + 1..=from + n).collect::<Vec<u32>>();
            let lists = [on(0, i), on(12, j), on(24, k)];
            let parts = divide([0, 12, 24], lists.each_ref().map(Vec::as_slice));
            let areas: Vec<i64> = parts
                .iter()
                .map(|t| t.map(at))
                .map(|[a, b, c]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
                .collect();
            assert!(areas.iter().all(|&area| area > 0), "{parts:?}");
            assert_eq!(areas.iter().sum::<i64>(), 144, "{parts:?}");
            let rim = [&[0][..], &lists[0], &[12], &lists[1], &[24], &lists[2], &[0]].concat();
            for step in rim.windows(2) {
                let has =
                    |t: &&[u32; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]].contains(&[step[0], step[1]]);
                assert_eq!(parts.iter().filter(has).count(), 1, "{step:?} in {parts:?}");
            }
        }
    }
}
