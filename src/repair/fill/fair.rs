//! Makes a patch as smooth as a thin plate that is clamped at the rim.
//!
//! Botsch and Kobbelt, "An intuitive framework for real-time freeform modeling" (2004): the sum of squared Laplacians
//! (with the cotangent weights of Pinkall and Polthier 1993, over the area of each vertex) is least, while the rim and
//! the vertices around it stay. Those make the patch leave the rim in the direction of the surface.

use super::patch::PatchMesh;
use super::sparse::Symmetric;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;

/// Cotangents are kept within this, about 0.6 degrees, so that a needle at the rim does not outweigh the rest.
const COTANGENT_MAX: f64 = 100.0;
/// Least weight of an edge, as a share of that of an edge between equilateral triangles.
const WEIGHT_MIN: f64 = 1e-3;

/// What is around a patch: the triangles at its rim that are not of it.
#[derive(Debug, Clone, Default)]
pub(super) struct PatchSurroundings {
    /// Vertices of those triangles that are not in the rim.
    pub(super) points: Vec<DVec3>,
    /// Below the number of corners of the rim: that corner; from there on: one of `points`.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Of each corner of the rim, whether the patch leaves it in the direction of the surface. About others it is free to
    /// turn, and their triangles need not be here.
    pub(super) is_clamped: Vec<bool>,
}

/// Moves the new vertices of `mesh`. `false`, and nothing moves: the system has no solution.
///
/// A plate that is clamped at a very uneven rim may swing out far beyond it. `tension` is how much it also counts how
/// large the patch is: 0 is a plate, far above 1 a membrane, which stays within its rim. Both count alike for bends as
/// narrow as a triangle when it is 1.
pub(super) fn fair(
    mesh: &mut PatchMesh,
    around: &PatchSurroundings,
    tension: f64,
    budget: &Budget,
) -> Result<bool, Stopped> {
    let unknown = mesh.points.len() - mesh.rim;
    if unknown == 0 {
        return Ok(true);
    }
    let plate = Plate::new(mesh, around, budget)?;
    let (matrix, right) = plate.system(tension, budget)?;
    let Some(factor) = matrix.factor(&mesh.points[mesh.rim..], budget)? else { return Ok(false) };
    let solution = factor.solve(&right);
    if !solution.iter().all(|p| p.is_finite()) {
        return Ok(false);
    }
    mesh.points[mesh.rim..].copy_from_slice(&solution);
    Ok(true)
}

/// The Laplacians of the rim and of the patch. Vertices are numbered: rim, patch, around.
struct Plate {
    rim: usize,
    inner: usize,
    points: Vec<DVec3>,
    /// Of each vertex of rim and patch: neighbours with their weights.
    weights: Vec<Vec<(u32, f64)>>,
    /// Of each vertex of rim and patch: a third of the area of its triangles.
    area: Vec<f64>,
    /// Of each corner of the rim.
    is_clamped: Vec<bool>,
}

impl Plate {
    fn new(mesh: &PatchMesh, around: &PatchSurroundings, budget: &Budget) -> Result<Self, Stopped> {
        let (rim, own) = (mesh.rim, mesh.points.len());
        let points: Vec<DVec3> = mesh.points.iter().chain(&around.points).copied().collect();
        let shifted = |v: u32| if (v as usize) < rim { v } else { v + (own - rim) as u32 };
        let outer = around.triangles.iter().map(|t| t.map(shifted));
        let mut area = vec![0.0; own];
        let mut entries: Vec<Vec<(u32, f64)>> = vec![Vec::new(); own];
        for (n, t) in mesh.triangles.iter().copied().chain(outer).enumerate() {
            if n.is_multiple_of(CHECK_EVERY) {
                budget.check()?;
            }
            for c in 0..3 {
                let [a, b, apex] = [t[c], t[(c + 1) % 3], t[(c + 2) % 3]];
                let [pa, pb, p] = [a, b, apex].map(|v| points[v as usize]);
                let (u, v) = (pa - p, pb - p);
                let double = u.cross(v).length();
                // The half of a cotangent for each side of the edge.
                let half = (u.dot(v) / double).clamp(-COTANGENT_MAX, COTANGENT_MAX) / 2.0;
                let half = if half.is_nan() { 0.0 } else { half };
                for (from, to) in [(a, b), (b, a)] {
                    if (from as usize) < own {
                        entries[from as usize].push((to, half));
                    }
                }
                if (apex as usize) < own {
                    area[apex as usize] += double / 6.0;
                }
            }
        }
        let weights = entries.into_iter().map(summed).collect();
        let mean = area.iter().sum::<f64>() / own as f64;
        // A vertex of needles has next to no area, and would be all that counts.
        let area = area.into_iter().map(|a| a.max(mean * 1e-3)).collect();
        Ok(Self { rim, inner: own - rim, points, weights, area, is_clamped: around.is_clamped.clone() })
    }

    /// The normal equations: the Laplacian of the Laplacian at each new vertex is 0.
    fn system(&self, tension: f64, budget: &Budget) -> Result<(Symmetric, Vec<DVec3>), Stopped> {
        let mut laplacians: Vec<Vec<(u32, f64)>> = Vec::with_capacity(self.weights.len());
        // For each unknown the Laplacians that it is in.
        let mut parts: Vec<Vec<(u32, f64)>> = vec![Vec::new(); self.inner];
        let mut right = vec![DVec3::ZERO; self.inner];
        let unknown = |v: u32| (v as usize).checked_sub(self.rim).filter(|&i| i < self.inner);
        let tension = tension * self.area.len() as f64 / self.area.iter().sum::<f64>();
        for (v, weights) in self.weights.iter().enumerate() {
            budget.spend((weights.len() * weights.len()) as u64 / 16 + 1)?;
            let sum: f64 = weights.iter().map(|&(_, weight)| weight).sum();
            let all = weights.iter().map(|&(w, weight)| (w, -weight)).chain([(v as u32, sum)]);
            let (mut moving, mut still) = (Vec::new(), DVec3::ZERO);
            for (w, weight) in all {
                match unknown(w) {
                    Some(i) => moving.push((i as u32, weight)),
                    None => still += weight * self.points[w as usize],
                }
            }
            let counts = self.is_clamped.get(v).is_none_or(|&is_clamped| is_clamped);
            for &(i, x) in moving.iter().filter(|_| counts) {
                let share = x / self.area[v];
                right[i as usize] -= share * still;
                parts[i as usize].push((v as u32, share));
            }
            // The Laplacian itself, at the vertex that it is of.
            if tension > 0.0
                && let Some(i) = unknown(v as u32)
            {
                right[i] -= tension * still;
                parts[i].push((v as u32, tension));
            }
            laplacians.push(moving);
        }
        Ok((Symmetric { rows: products(&parts, &laplacians, budget)? }, right))
    }
}

/// For each of `parts` the sum of the rows that it names, with its factors; sorted by column.
fn products(
    parts: &[Vec<(u32, f64)>],
    rows: &[Vec<(u32, f64)>],
    budget: &Budget,
) -> Result<Vec<Vec<(u32, f64)>>, Stopped> {
    let (mut sums, mut is_in) = (vec![0.0; parts.len()], vec![false; parts.len()]);
    let mut products = Vec::with_capacity(parts.len());
    for part in parts {
        let mut columns: Vec<u32> = Vec::new();
        for &(row, factor) in part {
            for &(column, x) in &rows[row as usize] {
                if !std::mem::replace(&mut is_in[column as usize], true) {
                    columns.push(column);
                }
                sums[column as usize] += factor * x;
            }
        }
        budget.spend(columns.len() as u64 / 4 + 1)?;
        columns.sort_unstable();
        let row = columns.into_iter().map(|column| {
            is_in[column as usize] = false;
            (column, std::mem::take(&mut sums[column as usize]))
        });
        products.push(row.collect());
    }
    Ok(products)
}

/// One entry for each neighbour, at least a little.
fn summed(entries: Vec<(u32, f64)>) -> Vec<(u32, f64)> {
    summed_exactly(entries).into_iter().map(|(v, weight)| (v, weight.max(WEIGHT_MIN))).collect()
}

fn summed_exactly(mut entries: Vec<(u32, f64)>) -> Vec<(u32, f64)> {
    // Stable, so that sums are made in the order of the triangles.
    entries.sort_by_key(|&(v, _)| v);
    entries.chunk_by(|a, b| a.0 == b.0).map(|same| (same[0].0, same.iter().map(|&(_, x)| x).sum())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of `n` by `n` cells whose rim is clamped to a surface that rises steeply around it.
    fn basin(n: u32) -> (PatchMesh, PatchSurroundings) {
        let rim: Vec<[u32; 2]> = (0..n)
            .map(|i| [i, 0])
            .chain((0..n).map(|i| [n, i]))
            .chain((0..n).map(|i| [n - i, n]))
            .chain((0..n).map(|i| [0, n - i]))
            .collect();
        let inner = (1..n).flat_map(|i| (1..n).map(move |k| [i, k]));
        let all: Vec<[u32; 2]> = rim.iter().copied().chain(inner).collect();
        let at = |[i, k]: [u32; 2]| DVec3::new(f64::from(i), f64::from(k), 0.0);
        let number = |p: [u32; 2]| all.iter().position(|&q| q == p).unwrap() as u32;
        let cells = (0..n).flat_map(|i| (0..n).map(move |k| [i, k]));
        let triangles = cells
            .flat_map(|[i, k]| {
                let [a, b, c, d] = [[i, k], [i + 1, k], [i + 1, k + 1], [i, k + 1]].map(number);
                [[a, b, c], [a, c, d]]
            })
            .collect();
        let mut mesh = PatchMesh::new(all.iter().map(|&p| at(p)).collect(), triangles).unwrap();
        mesh.rim = rim.len();
        // Beyond each side of the rim a triangle that stands upright.
        let middle = DVec3::new(f64::from(n), f64::from(n), 0.0) / 2.0;
        let corners = rim.len() as u32;
        let mut around =
            PatchSurroundings { is_clamped: vec![true; rim.len()], ..PatchSurroundings::default() };
        for i in 0..corners {
            let [p, q] = [i, (i + 1) % corners].map(|i| at(rim[i as usize]));
            around.points.push((p + q) / 2.0 + ((p + q) / 2.0 - middle) * 0.02 + 3.0 * DVec3::Z);
            around.triangles.push([(i + 1) % corners, i, corners + i]);
        }
        (mesh, around)
    }

    fn depth(tension: f64) -> f64 {
        let (mut mesh, around) = basin(12);
        assert!(fair(&mut mesh, &around, tension, &Budget::unlimited()).unwrap());
        mesh.points.iter().fold(0.0, |least: f64, p| least.min(p.z))
    }

    #[test]
    fn a_plate_swings_out_beyond_a_steep_rim_and_tension_draws_it_in() {
        let [plate, tense, membrane] = [0.0, 1.0, 1e6].map(depth);
        assert!(plate < -0.5, "{plate}");
        assert!(tense > 0.8 * plate && tense < -0.01, "{tense} of {plate}");
        assert!(membrane > -1e-3, "{membrane}");
    }
}
