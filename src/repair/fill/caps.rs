//! Turns edges so that no triangle of a patch has its three corners on one line.
//!
//! Such a cap comes from corners of the rim along a straight edge of a part, or from vertices that were rounded. Its longest
//! edge is turned, so that the triangle beyond it is divided at the corner in the middle; nothing moves.

use super::patch::PatchMesh;
use crate::budget::{Budget, Stopped};
use crate::geom::are_collinear;
use crate::mesh::triangle_of;

/// Turns the longest edge of each cap where that leaves no cap. What cannot be turned stays. `is_free(a, b)` says whether
/// there may be an edge between two corners of the rim. Each turn ends a cap, so the work is in proportion to the triangles.
pub(super) fn turn_caps(
    mesh: &mut PatchMesh,
    is_free: &dyn Fn(u32, u32) -> bool,
    budget: &Budget,
) -> Result<(), Stopped> {
    budget.spend(mesh.triangles.len() as u64 / 4 + 1)?;
    let mut open: Vec<u32> = (0..mesh.triangles.len() as u32).filter(|&t| is_cap(mesh, t)).collect();
    while let Some(t) = open.pop() {
        budget.spend(1)?;
        if !is_cap(mesh, t) {
            continue;
        }
        let h = longest_edge(mesh, t);
        if !is_mended_by_turning(mesh, h, is_free) {
            continue;
        }
        // A cap beside a new triangle may be turned now that there is no cap beyond it.
        for edge in mesh.flip(h).into_iter().flatten() {
            open.extend(mesh.twin(edge).map(triangle_of).filter(|&beside| is_cap(mesh, beside)));
        }
    }
    Ok(())
}

fn is_cap(mesh: &PatchMesh, t: u32) -> bool {
    is_flat(mesh, mesh.triangles[t as usize])
}

fn is_flat(mesh: &PatchMesh, corners: [u32; 3]) -> bool {
    let [a, b, c] = corners.map(|v| mesh.point(v));
    are_collinear(a, b, c)
}

/// The half-edge of triangle `t` whose ends are farthest apart; the first of several.
fn longest_edge(mesh: &PatchMesh, t: u32) -> u32 {
    let length = |h: u32| {
        let [a, b] = mesh.ends(h).map(|v| mesh.point(v));
        a.distance_squared(b)
    };
    (3 * t + 1..3 * t + 3).fold(3 * t, |longest, h| if length(h) > length(longest) { h } else { longest })
}

fn is_mended_by_turning(mesh: &PatchMesh, h: u32, is_free: &dyn Fn(u32, u32) -> bool) -> bool {
    let Some(g) = mesh.twin(h) else { return false };
    let ([a, b], c, d) = (mesh.ends(h), mesh.apex(h), mesh.apex(g));
    let is_of_rim = |v: u32| (v as usize) < mesh.rim;
    let is_taken = c == d || mesh.has_edge(c, d) || (is_of_rim(c) && is_of_rim(d) && !is_free(c, d));
    !is_taken && !is_flat(mesh, [c, a, d]) && !is_flat(mesh, [d, b, c])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;

    fn caps(mesh: &PatchMesh) -> usize {
        (0..mesh.triangles.len() as u32).filter(|&t| is_cap(mesh, t)).count()
    }

    /// A square whose lower side has `n` corners between its ends, all of them cut off below the diagonal of the side.
    fn comb(n: u32) -> PatchMesh {
        let along = |i: u32| DVec3::new(f64::from(i) / f64::from(n + 1), 0.0, 0.0);
        let mut points: Vec<DVec3> = (0..n + 2).map(along).collect();
        points.extend([DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.0, 1.0, 0.0)]);
        let end = n + 1;
        let mut triangles = vec![[0, end, end + 1], [0, end + 1, end + 2]];
        triangles.extend((1..end).map(|i| [0, i, i + 1]));
        PatchMesh::new(points, triangles).unwrap()
    }

    #[test]
    fn caps_along_a_straight_side_are_turned_one_after_another() {
        for n in [1, 2, 7, 100] {
            let mut mesh = comb(n);
            assert_eq!(caps(&mesh), n as usize);
            turn_caps(&mut mesh, &|_, _| true, &Budget::unlimited()).unwrap();
            assert_eq!((caps(&mesh), mesh.check()), (0, Vec::new()), "{n} corners");
        }
    }

    #[test]
    fn a_cap_stays_where_no_edge_may_be() {
        let mut mesh = comb(1);
        turn_caps(&mut mesh, &|_, _| false, &Budget::unlimited()).unwrap();
        assert_eq!((caps(&mesh), mesh.check()), (1, Vec::new()));
    }
}
