//! The ten polynomials of degree two or less, and which of them a set of centres can tell apart.

use crate::geom::DVec3;

/// Polynomials of degree 2 or less in three variables.
pub(super) const TERMS: usize = 10;
/// Polynomials of degree 1 or less; they are the first ones of [`terms`].
pub(super) const LINEAR_TERMS: usize = 4;
/// Columns whose part beside the others is a smaller share of them are taken as dependent: ten times the rounding of
/// coordinates to f32 (6e-8), so that a rim is not told from a circle by how its file was rounded.
const RANK_SHARE: f64 = 6e-7;

/// 1, x, y, z, x^2, y^2, z^2, xy, yz, xz at `p`.
pub(super) fn terms(p: DVec3) -> [f64; TERMS] {
    [1.0, p.x, p.y, p.z, p.x * p.x, p.y * p.y, p.z * p.z, p.x * p.y, p.y * p.z, p.x * p.z]
}

/// The gradients of [`terms`], each weighted, summed.
pub(super) fn gradient(weights: &[f64; TERMS], p: DVec3) -> DVec3 {
    let [_, x, y, z, xx, yy, zz, xy, yz, xz] = *weights;
    DVec3::new(
        x + 2.0 * xx * p.x + xy * p.y + xz * p.z,
        y + 2.0 * yy * p.y + xy * p.x + yz * p.z,
        z + 2.0 * zz * p.z + yz * p.y + xz * p.x,
    )
}

/// The rank of the first `count` polynomials at `points`, by QR with column pivoting of the columns scaled to length 1
/// (Businger and Golub 1965).
pub(super) fn rank(points: &[DVec3], count: usize) -> usize {
    let mut columns: Vec<Vec<f64>> =
        (0..count).map(|k| points.iter().map(|&p| terms(p)[k]).collect()).collect();
    for column in &mut columns {
        let length = dot(column, column).sqrt();
        if length > 0.0 {
            column.iter_mut().for_each(|x| *x /= length);
        }
    }
    let mut rank = 0;
    while !columns.is_empty() {
        let lengths: Vec<f64> = columns.iter().map(|c| dot(c, c).sqrt()).collect();
        let longest = (0..lengths.len()).fold(0, |best, i| if lengths[i] > lengths[best] { i } else { best });
        if lengths[longest] <= RANK_SHARE {
            break;
        }
        rank += 1;
        let mut pivot = columns.swap_remove(longest);
        pivot.iter_mut().for_each(|x| *x /= lengths[longest]);
        for column in &mut columns {
            // Twice, because once leaves a part of the pivot that is rounding.
            for _ in 0..2 {
                let share = dot(column, &pivot);
                column.iter_mut().zip(&pivot).for_each(|(x, p)| *x -= share * p);
            }
        }
    }
    rank
}

/// The inner product, in four lanes.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (quads, rest) = (a.chunks_exact(4).zip(b.chunks_exact(4)), a.len().min(b.len()) / 4 * 4);
    let mut sums = [0.0; 4];
    for (a, b) in quads {
        for l in 0..4 {
            sums[l] += a[l] * b[l];
        }
    }
    let last: f64 = a[rest..].iter().zip(&b[rest..]).map(|(a, b)| a * b).sum();
    (sums[0] + sums[2]) + (sums[1] + sums[3]) + last
}

/// P = Q [R; 0] for the first polynomials at some points, with Q as reflections: Q = H_0 H_1 ..., and
/// H_k = I - 2 v_k v_k^T.
pub(super) struct Reflections {
    /// The unit vectors v_k; v_k is 0 before place k.
    vectors: Vec<Vec<f64>>,
    /// R by rows.
    r: Vec<Vec<f64>>,
    /// T of the compact form, by columns.
    t: Vec<Vec<f64>>,
}

impl Reflections {
    /// Factors the n x `count` matrix, which has that rank.
    pub(super) fn new(points: &[DVec3], count: usize) -> Self {
        let mut columns: Vec<Vec<f64>> =
            (0..count).map(|k| points.iter().map(|&p| terms(p)[k]).collect()).collect();
        let mut vectors: Vec<Vec<f64>> = Vec::with_capacity(count);
        for k in 0..count {
            let mut v = columns[k].clone();
            v[..k].fill(0.0);
            let length = dot(&v, &v).sqrt();
            v[k] += if v[k] < 0.0 { -length } else { length };
            let length = dot(&v, &v).sqrt();
            v.iter_mut().for_each(|x| *x /= length);
            // Nothing reads what the columns before have below R.
            columns[k..].iter_mut().for_each(|column| reflect(column, &v));
            vectors.push(v);
        }
        let r = (0..count).map(|row| (0..count).map(|c| columns[c][row]).collect()).collect();
        let t = compact(&vectors);
        Self { vectors, r, t }
    }

    /// The number of polynomials.
    pub(super) fn count(&self) -> usize {
        self.vectors.len()
    }

    /// x becomes Q^T x.
    pub(super) fn turn_back(&self, x: &mut [f64]) {
        self.vectors.iter().for_each(|v| reflect(x, v));
    }

    /// x becomes Q x.
    pub(super) fn turn(&self, x: &mut [f64]) {
        self.vectors.iter().rev().for_each(|v| reflect(x, v));
    }

    /// The b with R b = x.
    pub(super) fn solve(&self, x: &[f64]) -> Vec<f64> {
        let mut b = x.to_vec();
        for k in (0..b.len()).rev() {
            let known = dot(&self.r[k][k + 1..], &b[k + 1..]);
            b[k] = (b[k] - known) / self.r[k][k];
        }
        b
    }

    /// Q = I - V T V^T with V the vectors as columns and T upper triangular (Schreiber and Van Loan 1989): V and T, each
    /// by columns.
    pub(super) fn compact(&self) -> (&[Vec<f64>], &[Vec<f64>]) {
        (&self.vectors, &self.t)
    }
}

/// T of the compact form of the reflections by `vectors`.
fn compact(vectors: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let count = vectors.len();
    let mut t = vec![vec![0.0; count]; count];
    for k in 0..count {
        let products: Vec<f64> = (0..k).map(|i| dot(&vectors[i], &vectors[k])).collect();
        let above = |row: usize| -2.0 * (row..k).map(|i| t[i][row] * products[i]).sum::<f64>();
        let column: Vec<f64> = (0..k).map(above).chain([2.0]).collect();
        t[k][..=k].copy_from_slice(&column);
    }
    t
}

/// x -= 2 v (v . x)
fn reflect(x: &mut [f64], v: &[f64]) {
    let share = 2.0 * dot(x, v);
    x.iter_mut().zip(v).for_each(|(x, v)| *x -= share * v);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scattered(count: u32) -> Vec<DVec3> {
        let part = |i: u32, k: u32| f64::from((i * k + 13) * 26_543 % 1000) / 500.0 - 1.0;
        (0..count).map(|i| DVec3::new(part(i, 71), part(i, 313), part(i, 1009))).collect()
    }

    #[test]
    fn scattered_points_tell_all_apart_and_a_sphere_and_a_plane_do_not() {
        let points = scattered(40);
        assert_eq!(rank(&points, TERMS), 10);
        assert_eq!(rank(&points, LINEAR_TERMS), 4);
        let sphere: Vec<DVec3> = points.iter().map(|p| p.normalize()).collect();
        assert_eq!(rank(&sphere, TERMS), 9);
        let rounded: Vec<DVec3> =
            sphere.iter().map(|p| DVec3::from_array(p.to_array().map(|x| f64::from(x as f32)))).collect();
        assert_eq!(rank(&rounded, TERMS), 9);
        let plane: Vec<DVec3> = points.iter().map(|p| DVec3::new(p.x, p.y, 0.0)).collect();
        assert_eq!(rank(&plane, TERMS), 6);
        assert_eq!(rank(&plane, LINEAR_TERMS), 3);
    }

    #[test]
    fn reflections_solve_for_polynomials_and_have_a_compact_form() {
        let points = scattered(25);
        let q = Reflections::new(&points, TERMS);
        let weights: Vec<f64> = (0..TERMS).map(|k| k as f64 - 4.2).collect();
        let mut values: Vec<f64> = points.iter().map(|&p| dot(&terms(p), &weights)).collect();
        q.turn_back(&mut values);
        assert!(values[TERMS..].iter().all(|x| x.abs() < 1e-13));
        let found = q.solve(&values[..TERMS]);
        assert!(found.iter().zip(&weights).all(|(a, b)| (a - b).abs() < 1e-11), "{found:?}");
        let mut x: Vec<f64> = (0..25).map(|i| f64::from(i % 7) - 2.5).collect();
        let (v, t) = q.compact();
        let products: Vec<f64> = v.iter().map(|v| dot(v, &x)).collect();
        let shares: Vec<f64> = (0..TERMS).map(|r| (0..TERMS).map(|c| t[c][r] * products[c]).sum()).collect();
        let expected: Vec<f64> =
            (0..25).map(|i| x[i] - v.iter().zip(&shares).map(|(v, s)| v[i] * s).sum::<f64>()).collect();
        q.turn(&mut x);
        assert!(x.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-13));
    }

    #[test]
    fn the_gradient_is_that_of_the_terms() {
        let weights = std::array::from_fn(|k| k as f64 * 0.3 - 1.0);
        let p = DVec3::new(0.3, -0.8, 0.5);
        let value = |p: DVec3| dot(&terms(p), &weights);
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            let slope = (value(p + axis * 1e-5) - value(p - axis * 1e-5)) / 2e-5;
            assert!((gradient(&weights, p).dot(axis) - slope).abs() < 1e-9);
        }
    }
}
