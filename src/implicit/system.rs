//! The dense system [[Phi, P], [P^T, 0]] [alpha; beta] = [sigma; 0], solved in the null space of P^T.
//!
//! P = Q [R; 0], Q = [Y Z]. The columns of Z span the weights that meet the side conditions P^T alpha = 0, and Z^T Phi Z
//! is positive definite for every kernel here (Micchelli 1986; Wendland, Scattered Data Approximation, chapter 8), so
//! alpha = Z gamma with Z^T Phi Z gamma = Z^T sigma by Cholesky, and R beta = Y^T (sigma - Phi alpha). Phi is stored for
//! few centres only: the entries of Q^T Phi Q = Phi - V W^T - W V^T come from the compact form Q = I - V T V^T.

use super::cholesky::Cholesky;
use super::kernel::{KernelTable, WeightedCentres};
use super::options::Kernel;
use super::polynomial::{LINEAR_TERMS, Reflections, TERMS, dot, rank, terms};
use super::unfit::Unfit;
use crate::budget::{Budget, Charge, Stopped};
use crate::geom::DVec3;
use crate::par;

/// The largest difference at a centre, over the largest value, that a solution may have.
const RESIDUAL_MAX: f64 = 1e-9;
/// A residual that is not worth another step of refinement.
const RESIDUAL_GOOD: f64 = 1e-14;
/// Steps of refinement. Each is one evaluation at all centres; the first two or three bring all there is.
const REFINEMENTS: usize = 6;
/// What is added to the diagonal when the matrix is not definite in f64; refinement takes its effect out again.
const SHIFTS: [f64; 2] = [0.0, 1e-13];
/// Rows handled between two checks of the budget.
const ROWS: usize = 32;
/// Centres up to which all values of the kernel between them are kept: 2 MB. They are asked for four times or more.
const KEPT_MAX: usize = 512;

/// A sum of radial functions and a polynomial of degree 2 or less.
#[derive(Debug, Clone)]
pub(super) struct Solution {
    pub centres: WeightedCentres,
    pub polynomial: [f64; TERMS],
    /// 2, or 1 where the centres do not determine a polynomial of degree 2.
    pub degree: u32,
    /// The rank of the ten polynomials at the centres.
    pub rank: usize,
    /// The largest difference at a centre over the largest value.
    pub residual: f64,
}

/// Solves for the field that takes `values` at `points`, which lie within about a unit of the origin. About n^3 / 3
/// operations.
pub(super) fn solve(
    kernel: Kernel,
    points: &[DVec3],
    values: &[f64],
    budget: &Budget,
) -> Result<Result<Solution, Unfit>, Stopped> {
    let quadratic = rank(points, TERMS);
    let (degree, count) = if quadratic == TERMS { (2, TERMS) } else { (1, LINEAR_TERMS) };
    if degree == 1 {
        let linear = rank(points, LINEAR_TERMS);
        if linear < LINEAR_TERMS {
            return Ok(Err(Unfit::Rank { rank: linear }));
        }
    }
    if points.len() <= count {
        return Ok(Err(Unfit::Rank { rank: quadratic.min(LINEAR_TERMS) }));
    }
    let system = System::new(kernel, points, count, budget)?;
    let mut last = Unfit::Singular { centres: points.len() };
    for shift in SHIFTS {
        let Ok(factor) = system.factor(shift, budget)? else { continue };
        let (centres, polynomial, residual) = system.refine(&factor, values, budget)?;
        if residual <= RESIDUAL_MAX {
            return Ok(Ok(Solution { centres, polynomial, degree, rank: quadratic, residual }));
        }
        last = Unfit::Residual { residual };
    }
    Ok(Err(last))
}

struct System<'p> {
    kernel: Kernel,
    points: &'p [DVec3],
    centres: WeightedCentres,
    /// Phi, where there are few centres.
    table: Option<KernelTable>,
    _charge: Charge<'p>,
    q: Reflections,
    /// W of Q^T Phi Q = Phi - V W^T - W V^T, by columns.
    w: Vec<Vec<f64>>,
}

impl<'p> System<'p> {
    fn new(kernel: Kernel, points: &'p [DVec3], count: usize, budget: &'p Budget) -> Result<Self, Stopped> {
        let centres = WeightedCentres::new(points);
        let is_kept = points.len() <= KEPT_MAX;
        let _charge = budget.charge(if is_kept { centres.table_bytes() } else { 0 })?;
        let table = if is_kept { Some(centres.table(kernel, points, ROWS, budget)?) } else { None };
        let q = Reflections::new(points, count);
        let (n, (v, t)) = (points.len(), q.compact());
        let rows = |range: std::ops::Range<usize>| -> Result<Vec<Vec<f64>>, Stopped> {
            budget.check()?;
            let mut row = Vec::new();
            let products = |i: usize| {
                let row = match &table {
                    Some(table) => &table.row(i).as_flattened()[..n],
                    None => {
                        centres.row(kernel, points[i], 0..n, &mut row);
                        &row[..]
                    }
                };
                v.iter().map(|v| dot(row, v)).collect()
            };
            Ok(range.map(products).collect())
        };
        let phi_v: Vec<Vec<f64>> = par::try_map_ranges(n, ROWS, rows)?.into_iter().flatten().collect();
        // Phi V T, by columns, and S = T^T V^T Phi V T.
        let phi_vt: Vec<Vec<f64>> = t.iter().map(|t| phi_v.iter().map(|row| dot(row, t)).collect()).collect();
        let v_phi_vt: Vec<Vec<f64>> =
            phi_vt.iter().map(|column| v.iter().map(|v| dot(v, column)).collect()).collect();
        let s = |a: usize, b: usize| dot(&t[a], &v_phi_vt[b]);
        let column = |b: usize| -> Vec<f64> {
            let mut column = phi_vt[b].clone();
            for (a, v) in v.iter().enumerate() {
                let half = 0.5 * s(a, b);
                column.iter_mut().zip(v).for_each(|(x, v)| *x -= half * v);
            }
            column
        };
        let w = (0..count).map(column).collect();
        Ok(Self { kernel, points, centres, table, _charge, q, w })
    }

    /// Z^T Phi Z with `shift` on its diagonal, factored.
    fn factor<'b>(
        &self,
        shift: f64,
        budget: &'b Budget,
    ) -> Result<Result<Cholesky<'b>, super::cholesky::NotDefinite>, Stopped> {
        let count = self.q.count();
        let (v, _) = self.q.compact();
        let fill = |i: usize, columns: std::ops::Range<usize>, row: &mut Vec<f64>| {
            let (i, from, to) = (i + count, columns.start + count, columns.end + count);
            match &self.table {
                Some(table) => {
                    row.clear();
                    row.extend_from_slice(&table.row(i).as_flattened()[from..to]);
                }
                None => self.centres.row(self.kernel, self.points[i], from..to, row),
            }
            for (v, w) in v.iter().zip(&self.w) {
                let (vi, wi) = (v[i], w[i]);
                for ((x, v), w) in row.iter_mut().zip(&v[from..to]).zip(&w[from..to]) {
                    *x -= vi * w + wi * v;
                }
            }
            if (from..to).contains(&i) {
                row[i - from] += shift;
            }
        };
        Cholesky::factor(self.points.len() - count, fill, budget)
    }

    /// Solves and corrects the solution by what it misses, while that gets less. Gives the weighted centres, the
    /// polynomial and the residual.
    fn refine(
        &self,
        factor: &Cholesky<'_>,
        values: &[f64],
        budget: &Budget,
    ) -> Result<(WeightedCentres, [f64; TERMS], f64), Stopped> {
        let count = self.q.count();
        let largest = values.iter().fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
        let mut alpha = vec![0.0; values.len()];
        let mut rest = values.to_vec();
        let mut best = (self.centres.clone(), [0.0; TERMS], f64::INFINITY);
        for _ in 0..REFINEMENTS {
            budget.check()?;
            self.q.turn_back(&mut rest);
            rest[..count].fill(0.0);
            factor.solve(&mut rest[count..]);
            self.q.turn(&mut rest);
            alpha.iter_mut().zip(&rest).for_each(|(a, step)| *a += step);
            let mut centres = self.centres.clone();
            centres.set_weights(&alpha);
            rest = self.missing(&centres, values, budget)?;
            let mut turned = rest.clone();
            self.q.turn_back(&mut turned);
            let mut polynomial = [0.0; TERMS];
            polynomial[..count].copy_from_slice(&self.q.solve(&turned[..count]));
            let miss = |(x, &p): (&f64, &DVec3)| (x - dot(&terms(p), &polynomial)).abs();
            // Not a number counts as infinite.
            let worst = rest
                .iter()
                .zip(self.points)
                .map(miss)
                .fold(0.0, |most: f64, x| if x <= most { most } else { x });
            let residual = if worst.is_nan() { f64::INFINITY } else { worst / largest };
            let is_stuck = residual > 0.5 * best.2;
            if residual < best.2 {
                best = (centres, polynomial, residual);
            }
            if is_stuck || residual <= RESIDUAL_GOOD {
                break;
            }
        }
        Ok(best)
    }

    /// sigma - Phi alpha.
    fn missing(
        &self,
        centres: &WeightedCentres,
        values: &[f64],
        budget: &Budget,
    ) -> Result<Vec<f64>, Stopped> {
        let rows = |range: std::ops::Range<usize>| -> Result<Vec<f64>, Stopped> {
            budget.check()?;
            let sum = |i: usize| match &self.table {
                Some(table) => centres.sum_of_row(table.row(i)),
                None => centres.sum(self.kernel, self.points[i]),
            };
            Ok(range.map(|i| values[i] - sum(i)).collect())
        };
        Ok(par::try_map_ranges(values.len(), ROWS, rows)?.concat())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Random(u64);

    impl Random {
        fn unit(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1u64 << 53) as f64
        }

        fn point(&mut self) -> DVec3 {
            DVec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0
        }
    }

    /// Gaussian elimination with partial pivoting of the whole system.
    fn plain(kernel: Kernel, points: &[DVec3], values: &[f64], count: usize) -> (Vec<f64>, Vec<f64>) {
        let (n, size) = (points.len(), points.len() + count);
        let phi = |r: f64| match kernel {
            Kernel::ThinPlate if r == 0.0 => 0.0,
            Kernel::ThinPlate => r * r * libm::log(r),
            Kernel::Cubic => r * r * r,
            Kernel::Linear => -r,
        };
        let entry = |i: usize, j: usize| match (i < n, j < n) {
            (true, true) => phi(points[i].distance(points[j])),
            (true, false) => terms(points[i])[j - n],
            (false, true) => terms(points[j])[i - n],
            (false, false) => 0.0,
        };
        let mut a: Vec<Vec<f64>> = (0..size)
            .map(|i| (0..size).map(|j| entry(i, j)).chain([if i < n { values[i] } else { 0.0 }]).collect())
            .collect();
        for k in 0..size {
            let pivot = (k..size).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs())).unwrap();
            a.swap(k, pivot);
            let top = a[k].clone();
            for row in &mut a[k + 1..] {
                let factor = row[k] / top[k];
                row.iter_mut().zip(&top).skip(k).for_each(|(x, t)| *x -= factor * t);
            }
        }
        let mut x = vec![0.0; size];
        for k in (0..size).rev() {
            x[k] = (a[k][size] - (k + 1..size).map(|j| a[k][j] * x[j]).sum::<f64>()) / a[k][k];
        }
        let beta = x.split_off(n);
        (x, beta)
    }

    #[test]
    fn the_solution_is_that_of_gaussian_elimination_for_every_kernel_and_degree() {
        let mut random = Random(11);
        for kernel in [Kernel::ThinPlate, Kernel::Cubic, Kernel::Linear] {
            for round in 0..20 {
                let n = 12 + 3 * round;
                let on_sphere = round % 4 == 3;
                let points: Vec<DVec3> = (0..n)
                    .map(|_| if on_sphere { random.point().normalize() } else { random.point() })
                    .collect();
                let values: Vec<f64> = (0..n).map(|_| random.unit() - 0.5).collect();
                let solved = solve(kernel, &points, &values, &Budget::unlimited()).unwrap().unwrap();
                assert_eq!(solved.degree, if on_sphere { 1 } else { 2 });
                let count = if on_sphere { LINEAR_TERMS } else { TERMS };
                let (alpha, beta) = plain(kernel, &points, &values, count);
                let mut truth = WeightedCentres::new(&points);
                truth.set_weights(&alpha);
                for _ in 0..20 {
                    let p = random.point();
                    let expected = truth.sum(kernel, p) + dot(&terms(p)[..count], &beta);
                    let found = solved.centres.sum(kernel, p) + dot(&terms(p), &solved.polynomial);
                    assert!((found - expected).abs() < 1e-8, "{kernel:?} {round}: {found} {expected}");
                }
            }
        }
    }

    #[test]
    fn coincident_centres_of_different_values_are_refused() {
        let mut random = Random(3);
        let mut points: Vec<DVec3> = (0..30).map(|_| random.point()).collect();
        points.push(points[4]);
        let values: Vec<f64> = (0..31).map(f64::from).collect();
        let refusal = solve(Kernel::ThinPlate, &points, &values, &Budget::unlimited()).unwrap().unwrap_err();
        assert!(matches!(refusal, Unfit::Singular { .. } | Unfit::Residual { .. }), "{refusal}");
    }

    #[test]
    fn centres_in_a_plane_are_refused_with_their_rank() {
        let mut random = Random(3);
        let points: Vec<DVec3> = (0..30).map(|_| random.point().with_z(0.0)).collect();
        let refusal = solve(Kernel::Cubic, &points, &[1.0; 30], &Budget::unlimited()).unwrap().unwrap_err();
        assert_eq!(refusal, Unfit::Rank { rank: 3 });
    }
}
