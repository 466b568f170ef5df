//! Triangles that lie in one plane, exactly or within a tolerance, as the faces of a polyhedron.

use crate::budget::{Budget, Stopped};
use crate::geom::{DVec3, Sign, orient3d};
use crate::mesh::UnionFind;

/// For each triangle the triangles beyond its three edges, edge `c` from corner `c` on.
pub(super) type TriangleNeighbours = Vec<[u32; 3]>;

/// The groups of triangles that are exactly coplanar with a neighbour and look to the same side.
pub(super) fn exact_groups(
    points: &[DVec3],
    triangles: &[[u32; 3]],
    neighbours: &TriangleNeighbours,
    budget: &Budget,
) -> Result<Vec<u32>, Stopped> {
    let mut joined = UnionFind::new(triangles.len());
    for (t, corners) in triangles.iter().enumerate() {
        if t % 1024 == 0 {
            budget.spend(1024)?;
        }
        let [a, b, c] = corners.map(|v| points[v as usize]);
        for &other in neighbours[t].iter().filter(|&&other| other > t as u32) {
            let opposite = triangles[other as usize].iter().find(|v| !corners.contains(v));
            let is_coplanar = opposite.is_some_and(|&v| orient3d(a, b, c, points[v as usize]) == Sign::Zero);
            if is_coplanar && normal(points, triangles[other as usize]).dot((b - a).cross(c - a)) > 0.0 {
                joined.unite(t as u32, other);
            }
        }
    }
    Ok((0..triangles.len() as u32).map(|t| joined.find(t)).collect())
}

/// Groups grown from the largest triangle on over neighbours whose corners are within `tolerance` of its plane.
pub(super) fn tolerant_groups(
    points: &[DVec3],
    triangles: &[[u32; 3]],
    neighbours: &TriangleNeighbours,
    tolerance: f64,
    budget: &Budget,
) -> Result<Vec<u32>, Stopped> {
    let normals: Vec<DVec3> = triangles.iter().map(|&t| normal(points, t)).collect();
    let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
    order.sort_by(|&a, &b| {
        let [x, y] = [a, b].map(|t| normals[t as usize].length_squared());
        y.total_cmp(&x).then(a.cmp(&b))
    });
    let mut group = vec![u32::MAX; triangles.len()];
    for seed in order {
        if group[seed as usize] != u32::MAX {
            continue;
        }
        let unit = normals[seed as usize].normalize_or_zero();
        let base = points[triangles[seed as usize][0] as usize];
        let mut open = vec![seed];
        group[seed as usize] = seed;
        while let Some(t) = open.pop() {
            budget.spend(1)?;
            for &other in &neighbours[t as usize] {
                let is_near = || {
                    triangles[other as usize]
                        .iter()
                        .all(|&v| (points[v as usize] - base).dot(unit).abs() <= tolerance)
                };
                // Needles have no direction to speak of; all others must look the same way.
                let n = normals[other as usize];
                let is_along = || {
                    n.dot(unit) > 0.5 * n.length()
                        || n.length() <= tolerance * longest(points, triangles[other as usize])
                };
                if group[other as usize] == u32::MAX && is_near() && is_along() {
                    group[other as usize] = seed;
                    open.push(other);
                }
            }
        }
    }
    Ok(group)
}

/// Twice the area, along the normal.
pub(super) fn normal(points: &[DVec3], corners: [u32; 3]) -> DVec3 {
    let [a, b, c] = corners.map(|v| points[v as usize]);
    (b - a).cross(c - a)
}

fn longest(points: &[DVec3], corners: [u32; 3]) -> f64 {
    let [a, b, c] = corners.map(|v| points[v as usize]);
    (b - a).length().max((c - b).length()).max((a - c).length())
}
