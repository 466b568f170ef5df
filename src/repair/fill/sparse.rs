//! Solves sparse symmetric positive definite systems that belong to points in space.
//!
//! The rows are put in the order of a nested dissection of the points (George 1973), then factored row by row as L D Lᵀ
//! along the elimination tree (Liu 1990). Plain arithmetic in a fixed order, so every machine gives the same bits, and
//! the budget is asked after each row. `docs/decisions/0031-own-sparse-factorization.md` has the reasons.

use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;

/// Parts with fewer points are not divided.
const LEAF: usize = 24;
/// Multiplications that are one unit of work.
const FLOPS_PER_UNIT: u64 = 256;
const NONE: u32 = u32::MAX;

/// A symmetric matrix: for each row its entries, also those above the diagonal, each column once.
pub(super) struct Symmetric {
    pub(super) rows: Vec<Vec<(u32, f64)>>,
}

/// L D Lᵀ of a matrix whose rows were put in another order.
pub(super) struct Factor {
    /// The row of the matrix at each place of the order.
    order: Vec<u32>,
    start: Vec<usize>,
    row: Vec<u32>,
    value: Vec<f64>,
    diagonal: Vec<f64>,
}

impl Symmetric {
    /// Factors the matrix, whose rows belong to `points`. `None`: it is not positive definite.
    pub(super) fn factor(&self, points: &[DVec3], budget: &Budget) -> Result<Option<Factor>, Stopped> {
        let order = self.dissect(points, budget)?;
        let mut place = vec![0u32; order.len()];
        for (at, &row) in order.iter().enumerate() {
            place[row as usize] = at as u32;
        }
        let (parent, start) = self.tree(&order, &place, budget)?;
        let _charge = budget.charge(*start.last().unwrap_or(&0) as u64 * 12)?;
        self.eliminate(order, &place, &parent, start, budget)
    }

    /// An order in which what separates two halves comes after both.
    fn dissect(&self, points: &[DVec3], budget: &Budget) -> Result<Vec<u32>, Stopped> {
        let n = self.rows.len();
        let mut order: Vec<u32> = (0..n as u32).collect();
        // The half that each row was last put in.
        let mut half = vec![NONE; n];
        let mut open: Vec<std::ops::Range<usize>> = std::iter::once(0..n).collect();
        let mut halves = 0;
        while let Some(range) = open.pop() {
            budget.spend(range.len() as u64 / 16 + 1)?;
            let part = &mut order[range.clone()];
            if part.len() <= LEAF {
                continue;
            }
            let axis = widest(part, points);
            let middle = part.len() / 2;
            let key = |&row: &u32| points[row as usize][axis];
            part.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
            for &row in &part[middle..] {
                half[row as usize] = halves;
            }
            let touches =
                |row: &u32| self.rows[*row as usize].iter().any(|&(other, _)| half[other as usize] == halves);
            let (separating, inner): (Vec<u32>, Vec<u32>) =
                part[..middle].iter().partition(|row| touches(row));
            halves += 1;
            let outer = part[middle..].to_vec();
            let (a, b) = (inner.len(), inner.len() + outer.len());
            part[..a].copy_from_slice(&inner);
            part[a..b].copy_from_slice(&outer);
            part[b..].copy_from_slice(&separating);
            open.extend([range.start..range.start + a, range.start + a..range.start + b]);
        }
        Ok(order)
    }

    /// The elimination tree, and where the entries of each column of L begin.
    fn tree(&self, order: &[u32], place: &[u32], budget: &Budget) -> Result<(Vec<u32>, Vec<usize>), Stopped> {
        let n = order.len();
        let (mut parent, mut seen, mut count) = (vec![NONE; n], vec![NONE; n], vec![0usize; n]);
        for k in 0..n as u32 {
            seen[k as usize] = k;
            let mut steps = 0;
            for &(other, _) in &self.rows[order[k as usize] as usize] {
                let mut i = place[other as usize];
                while i < k && seen[i as usize] != k {
                    if parent[i as usize] == NONE {
                        parent[i as usize] = k;
                    }
                    count[i as usize] += 1;
                    seen[i as usize] = k;
                    i = parent[i as usize];
                    steps += 1;
                }
            }
            budget.spend(steps / FLOPS_PER_UNIT + 1)?;
        }
        let mut start = Vec::with_capacity(n + 1);
        start.push(0);
        for count in count {
            start.push(start[start.len() - 1] + count);
        }
        Ok((parent, start))
    }

    fn eliminate(
        &self,
        order: Vec<u32>,
        place: &[u32],
        parent: &[u32],
        start: Vec<usize>,
        budget: &Budget,
    ) -> Result<Option<Factor>, Stopped> {
        let n = order.len();
        let (mut row, mut value) = (vec![0u32; start[n]], vec![0.0; start[n]]);
        let mut end = start[..n].to_vec();
        let (mut diagonal, mut work, mut seen) = (vec![0.0; n], vec![0.0; n], vec![NONE; n]);
        let (mut path, mut pattern) = (Vec::new(), Vec::<u32>::new());
        for k in 0..n as u32 {
            seen[k as usize] = k;
            pattern.clear();
            for &(other, a) in &self.rows[order[k as usize] as usize] {
                let mut i = place[other as usize];
                if i > k {
                    continue;
                }
                work[i as usize] += a;
                path.clear();
                while seen[i as usize] != k {
                    path.push(i);
                    seen[i as usize] = k;
                    i = parent[i as usize];
                }
                // Read from its end, the pattern has every row of L before those that depend on it.
                pattern.extend(path.iter().rev());
            }
            let mut pivot = std::mem::take(&mut work[k as usize]);
            let largest = pivot.abs();
            let mut flops = 0;
            for &i in pattern.iter().rev() {
                let i = i as usize;
                let y = std::mem::take(&mut work[i]);
                let column = start[i]..end[i];
                for (&r, &l) in row[column.clone()].iter().zip(&value[column]) {
                    work[r as usize] -= l * y;
                }
                flops += (end[i] - start[i]) as u64;
                let l = y / diagonal[i];
                pivot -= l * y;
                (row[end[i]], value[end[i]]) = (k, l);
                end[i] += 1;
            }
            budget.spend(flops / FLOPS_PER_UNIT + 1)?;
            // Below that the pivot is rounding alone.
            if pivot.partial_cmp(&(largest * 1e-14)) != Some(std::cmp::Ordering::Greater) {
                return Ok(None);
            }
            diagonal[k as usize] = pivot;
        }
        Ok(Some(Factor { order, start, row, value, diagonal }))
    }
}

/// The axis along which the points of `part` are spread most.
fn widest(part: &[u32], points: &[DVec3]) -> usize {
    let bounds = crate::geom::Aabb::of(part.iter().map(|&row| points[row as usize]));
    let size = bounds.max - bounds.min;
    if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    }
}

impl Factor {
    /// Solves for three right-hand sides at once.
    pub(super) fn solve(&self, right: &[DVec3]) -> Vec<DVec3> {
        let mut x: Vec<DVec3> = self.order.iter().map(|&row| right[row as usize]).collect();
        for k in 0..x.len() {
            let known = x[k];
            for p in self.start[k]..self.start[k + 1] {
                x[self.row[p] as usize] -= self.value[p] * known;
            }
        }
        for k in (0..x.len()).rev() {
            let mut sum = x[k] / self.diagonal[k];
            for p in self.start[k]..self.start[k + 1] {
                sum -= self.value[p] * x[self.row[p] as usize];
            }
            x[k] = sum;
        }
        let mut solution = vec![DVec3::ZERO; x.len()];
        for (at, &row) in self.order.iter().enumerate() {
            solution[row as usize] = x[at];
        }
        solution
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The squared Laplacian of a grid, plus a little.
    fn grid(n: usize) -> (Symmetric, Vec<DVec3>) {
        let points: Vec<DVec3> =
            (0..n * n).map(|i| DVec3::new((i % n) as f64, (i / n) as f64, 0.0)).collect();
        let laplacian = |i: usize| {
            let (x, y) = (i % n, i / n);
            let near = [(x > 0).then(|| i - 1), (x + 1 < n).then_some(i + 1), (y > 0).then(|| i - n)];
            let near = near.into_iter().chain([(y + 1 < n).then_some(i + n)]).flatten();
            near.map(|j| (j, -1.0)).chain([(i, 4.1)]).collect::<Vec<_>>()
        };
        let mut dense = vec![vec![0.0; n * n]; n * n];
        for i in 0..n * n {
            for (a, x) in laplacian(i) {
                for (b, y) in laplacian(i) {
                    dense[a][b] += x * y;
                }
            }
        }
        let sparse = |row: Vec<f64>| {
            row.into_iter().enumerate().filter(|&(_, x)| x != 0.0).map(|(j, x)| (j as u32, x)).collect()
        };
        (Symmetric { rows: dense.into_iter().map(sparse).collect() }, points)
    }

    #[test]
    fn the_solution_gives_back_the_right_hand_side() {
        for n in [1, 2, 5, 9, 17] {
            let (matrix, points) = grid(n);
            let right: Vec<DVec3> =
                (0..n * n).map(|i| DVec3::new(i as f64, (i * i % 17) as f64, 1.0)).collect();
            let factor = matrix.factor(&points, &Budget::unlimited()).unwrap().unwrap();
            let x = factor.solve(&right);
            for (row, right) in matrix.rows.iter().zip(&right) {
                let sum: DVec3 = row.iter().map(|&(j, a)| a * x[j as usize]).sum();
                assert!(sum.distance(*right) < 1e-9 * (1.0 + right.length()), "{sum} {right}");
            }
        }
    }

    #[test]
    fn a_matrix_that_is_not_positive_definite_has_no_factor() {
        let rows = vec![vec![(0, 1.0), (1, 2.0)], vec![(0, 2.0), (1, 1.0)]];
        let points = [DVec3::ZERO, DVec3::X];
        assert!(Symmetric { rows }.factor(&points, &Budget::unlimited()).unwrap().is_none());
    }
}
