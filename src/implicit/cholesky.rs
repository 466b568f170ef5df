//! The Cholesky factorization of a dense symmetric positive definite matrix, in tiles.
//!
//! Own code, because results must have the same bits on every machine and a run must end within 50 ms of being asked to
//! (see `docs/decisions/0029-own-dense-factorization.md`). Every sum runs in a fixed order without fused operations, so neither the number
//! of threads nor the processor changes a bit. Left-looking by columns of tiles; Golub and Van Loan, Matrix
//! Computations, section 4.2.

use crate::budget::{Budget, Charge, Stopped};
use crate::par;

/// Rows and columns of a tile: three tiles of f64 fit in a cache of 128 kB.
const TILE: usize = 64;
const TILE_AREA: usize = TILE * TILE;
/// Rows and columns that the innermost loop keeps in registers.
const BLOCK: usize = 4;

/// L with A = L L^T, as columns of tiles: `columns[j]` holds tiles j, j + 1, ... of that column, each row by row.
#[derive(Debug)]
pub(super) struct Cholesky<'b> {
    columns: Vec<Vec<f64>>,
    n: usize,
    _charge: Charge<'b>,
}

/// The matrix is not positive definite: the row whose pivot is not positive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct NotDefinite {
    pub row: usize,
}

impl<'b> Cholesky<'b> {
    /// Factors the n x n matrix whose rows `fill` writes: `fill(i, columns, row)` sets row i at these columns, all of
    /// them at most i. Rows past n are those of the identity. n^3 / 3 operations.
    ///
    /// # Errors
    /// When the budget stops the run; inside when the matrix is not positive definite in f64.
    pub(super) fn factor(
        n: usize,
        fill: impl Fn(usize, std::ops::Range<usize>, &mut Vec<f64>) + Sync,
        budget: &'b Budget,
    ) -> Result<Result<Self, NotDefinite>, Stopped> {
        let tiles = n.div_ceil(TILE);
        let charge = budget.charge((tiles * (tiles + 1) / 2 * TILE_AREA * size_of::<f64>()) as u64)?;
        let mut columns: Vec<Vec<f64>> = Vec::with_capacity(tiles);
        for j in 0..tiles {
            let mut column = vec![0.0; (tiles - j) * TILE_AREA];
            let facing: Vec<Vec<f64>> = (0..j).map(|k| transposed(tile(&columns[k], j - k))).collect();
            par::for_each_chunk_mut(&mut column, TILE_AREA, |at, out| {
                if budget.check().is_err() {
                    return;
                }
                let i = j + at / TILE_AREA;
                fill_tile(n, i, j, &fill, out);
                for (k, facing) in facing.iter().enumerate() {
                    subtract_product(out, tile(&columns[k], i - k), facing, rows_of(n, i), i == j);
                }
            });
            budget.spend((tiles - j) as u64 * (j as u64 + 1))?;
            let (diagonal, below) = column.split_at_mut(TILE_AREA);
            if let Err(row) = factor_tile(diagonal, rows_of(n, j)) {
                return Ok(Err(NotDefinite { row: j * TILE + row }));
            }
            let upper = transposed(diagonal);
            par::for_each_chunk_mut(below, TILE_AREA, |at, out| {
                solve_tile(&mut out[..rows_of(n, j + 1 + at / TILE_AREA) * TILE], &upper);
            });
            budget.check()?;
            columns.push(column);
        }
        Ok(Ok(Self { columns, n, _charge: charge }))
    }

    /// Solves A x = b in place. 2 n^2 operations.
    pub(super) fn solve(&self, b: &mut [f64]) {
        let mut x = vec![0.0; self.columns.len() * TILE];
        x[..self.n].copy_from_slice(b);
        for (j, column) in self.columns.iter().enumerate() {
            let (head, rest) = x[j * TILE..].split_at_mut(TILE);
            let diagonal = tile(column, 0);
            for r in 0..TILE {
                let known: f64 = (0..r).map(|c| diagonal[r * TILE + c] * head[c]).sum();
                head[r] = (head[r] - known) / diagonal[r * TILE + r];
            }
            for (row, value) in rest.iter_mut().enumerate() {
                let line = &column[TILE_AREA + row * TILE..][..TILE];
                *value -= line.iter().zip(&*head).map(|(l, x)| l * x).sum::<f64>();
            }
        }
        for (j, column) in self.columns.iter().enumerate().rev() {
            let (head, rest) = x[j * TILE..].split_at_mut(TILE);
            for (row, value) in rest.iter().enumerate() {
                let line = &column[TILE_AREA + row * TILE..][..TILE];
                head.iter_mut().zip(line).for_each(|(x, l)| *x -= l * value);
            }
            let diagonal = tile(column, 0);
            for c in (0..TILE).rev() {
                let known: f64 = (c + 1..TILE).map(|r| diagonal[r * TILE + c] * head[r]).sum();
                head[c] = (head[c] - known) / diagonal[c * TILE + c];
            }
        }
        b.copy_from_slice(&x[..self.n]);
    }
}

/// Tile `i` of a column.
fn tile(column: &[f64], i: usize) -> &[f64] {
    &column[i * TILE_AREA..(i + 1) * TILE_AREA]
}

fn transposed(tile: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; TILE_AREA];
    for (r, line) in tile.chunks_exact(TILE).enumerate() {
        for (c, &value) in line.iter().enumerate() {
            out[c * TILE + r] = value;
        }
    }
    out
}

/// Rows of the matrix in the tiles of row `i`; those past its end stay rows of the identity.
fn rows_of(n: usize, i: usize) -> usize {
    (n - i * TILE).min(TILE)
}

/// Tile (i, j) of the matrix; of a tile on the diagonal the upper part stays 0.
fn fill_tile(
    n: usize,
    i: usize,
    j: usize,
    fill: &impl Fn(usize, std::ops::Range<usize>, &mut Vec<f64>),
    out: &mut [f64],
) {
    let mut values = Vec::with_capacity(TILE + 16);
    for (r, line) in out.chunks_mut(TILE).enumerate() {
        let row = i * TILE + r;
        if row < n {
            let end = (j * TILE + TILE).min(row + 1);
            fill(row, j * TILE..end, &mut values);
            line[..values.len()].copy_from_slice(&values);
        } else if i == j {
            line[r] = 1.0;
        }
    }
}

/// out -= left * right, all row by row, in the first `rows` rows, or a few more. Of a tile on the diagonal what is above that is
/// not used, so it is left out.
fn subtract_product(out: &mut [f64], left: &[f64], right: &[f64], rows: usize, is_diagonal: bool) {
    let blocks = out.chunks_exact_mut(BLOCK * TILE).zip(left.chunks_exact(BLOCK * TILE));
    for (block, (rows, left)) in blocks.enumerate().take(rows.div_ceil(BLOCK)) {
        let end = if is_diagonal { (block + 1) * BLOCK } else { TILE };
        let mut packed = [[0.0; BLOCK]; TILE];
        for (k, lane) in packed.iter_mut().enumerate() {
            *lane = std::array::from_fn(|r| left[r * TILE + k]);
        }
        for first in (0..end).step_by(BLOCK) {
            let mut sums = [[0.0; BLOCK]; BLOCK];
            for (lane, line) in packed.iter().zip(right.chunks_exact(TILE)) {
                let line: &[f64; BLOCK] = line[first..first + BLOCK].try_into().unwrap_or(&[0.0; BLOCK]);
                for r in 0..BLOCK {
                    for c in 0..BLOCK {
                        sums[r][c] += lane[r] * line[c];
                    }
                }
            }
            for (r, sums) in sums.iter().enumerate() {
                let out = &mut rows[r * TILE + first..][..BLOCK];
                out.iter_mut().zip(sums).for_each(|(out, sum)| *out -= sum);
            }
        }
    }
}

/// Replaces the lower part of the first `rows` rows of a tile by its Cholesky factor; the row of the first pivot that is not
/// positive is the error.
fn factor_tile(a: &mut [f64], rows: usize) -> Result<(), usize> {
    for c in 0..rows {
        let pivot = a[c * TILE + c];
        if !(pivot > 0.0 && pivot.is_finite()) {
            return Err(c);
        }
        let root = pivot.sqrt();
        let mut column = [0.0; TILE];
        for r in c..rows {
            a[r * TILE + c] /= root;
            column[r] = a[r * TILE + c];
        }
        for r in c + 1..rows {
            let factor = column[r];
            let line = &mut a[r * TILE..][c + 1..=r];
            line.iter_mut().zip(&column[c + 1..=r]).for_each(|(x, l)| *x -= factor * l);
        }
    }
    Ok(())
}

/// Replaces X by X L^-T.
fn solve_tile(x: &mut [f64], upper: &[f64]) {
    for line in x.chunks_exact_mut(TILE) {
        for c in 0..TILE {
            let value = line[c] / upper[c * TILE + c];
            line[c] = value;
            let rest = &upper[c * TILE..][c + 1..TILE];
            line[c + 1..].iter_mut().zip(rest).for_each(|(x, l)| *x -= value * l);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::StopFlag;

    /// A symmetric matrix with a dominant diagonal.
    fn entry(i: usize, j: usize) -> f64 {
        let (i, j) = (i.max(j), i.min(j));
        if i == j { 40.0 + i as f64 } else { ((i * 7919 + j * 104_729) % 1000) as f64 / 1000.0 - 0.5 }
    }

    fn fill(i: usize, columns: std::ops::Range<usize>, row: &mut Vec<f64>) {
        row.clear();
        row.extend(columns.map(|j| entry(i, j)));
    }

    #[test]
    fn the_solution_solves_the_system_at_every_size_with_the_same_bits_for_all_threads() {
        for n in [1, 3, 63, 64, 65, 200] {
            let right: Vec<f64> = (0..n).map(|i| (i as f64 * 0.37) - 3.0).collect();
            let solutions = [1, 2, 8].map(|threads| {
                par::with_threads(threads, || {
                    let budget = Budget::unlimited();
                    let factor = Cholesky::factor(n, fill, &budget).unwrap().unwrap();
                    let mut x = right.clone();
                    factor.solve(&mut x);
                    x
                })
            });
            assert!(solutions[0] == solutions[1] && solutions[1] == solutions[2]);
            for (i, right) in right.iter().enumerate() {
                let sum: f64 = (0..n).map(|j| entry(i, j) * solutions[0][j]).sum();
                assert!((sum - right).abs() < 1e-11, "{n} {i} {sum} {right}");
            }
        }
    }

    #[test]
    fn an_indefinite_matrix_is_refused_with_the_row() {
        let budget = Budget::unlimited();
        let fill = |i: usize, columns: std::ops::Range<usize>, row: &mut Vec<f64>| {
            row.clear();
            row.extend(columns.map(|j| if i == j { if i == 70 { -1.0 } else { 1.0 } } else { 0.0 }));
        };
        assert_eq!(Cholesky::factor(100, fill, &budget).unwrap().err(), Some(NotDefinite { row: 70 }));
    }

    #[test]
    fn a_raised_flag_ends_the_factorization() {
        let stop = StopFlag::default();
        stop.cancel();
        let budget = Budget::new(stop, u64::MAX, u64::MAX);
        assert_eq!(Cholesky::factor(100, fill, &budget).err(), Some(Stopped::Cancelled));
    }
}
