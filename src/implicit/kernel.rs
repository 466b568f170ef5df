//! The radial functions, and weighted sums of them over many centres.

use super::logarithm::ln;
use super::options::Kernel;
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::par;

/// Centres handled side by side. Sums run in so many lanes on every machine, so their bits are the same.
const LANES: usize = 8;

/// A radial function of the squared distance q = r^2.
trait Radial {
    /// phi(r).
    fn value(q: f64) -> f64;
    /// phi'(r) / r, so that the gradient is this times the difference of the points; 0 where it has no value.
    fn slope(q: f64) -> f64;
}

struct ThinPlate;
struct Cubic;
struct Linear;

impl Radial for ThinPlate {
    #[inline(always)]
    fn value(q: f64) -> f64 {
        0.5 * q * ln(q)
    }

    #[inline(always)]
    fn slope(q: f64) -> f64 {
        ln(q) + 1.0
    }
}

impl Radial for Cubic {
    #[inline(always)]
    fn value(q: f64) -> f64 {
        q * q.sqrt()
    }

    #[inline(always)]
    fn slope(q: f64) -> f64 {
        3.0 * q.sqrt()
    }
}

impl Radial for Linear {
    #[inline(always)]
    fn value(q: f64) -> f64 {
        -q.sqrt()
    }

    #[inline(always)]
    fn slope(q: f64) -> f64 {
        // The difference of the points is 0 at a centre, so any finite number does there.
        -1.0 / (q + f64::MIN_POSITIVE).sqrt()
    }
}

/// Centres with their weights, coordinate by coordinate, filled up to whole lanes with weights of 0.
#[derive(Debug, Clone, Default)]
pub(super) struct WeightedCentres {
    x: Vec<[f64; LANES]>,
    y: Vec<[f64; LANES]>,
    z: Vec<[f64; LANES]>,
    weights: Vec<[f64; LANES]>,
    len: usize,
}

/// phi between all centres, row by row, filled up to whole lanes.
#[derive(Debug)]
pub(super) struct KernelTable {
    values: Vec<[f64; LANES]>,
    /// Lanes of a row.
    blocks: usize,
}

impl KernelTable {
    /// The row of centre `i`.
    pub(super) fn row(&self, i: usize) -> &[[f64; LANES]] {
        &self.values[i * self.blocks..(i + 1) * self.blocks]
    }
}

impl WeightedCentres {
    /// `points` with weights of 0.
    pub(super) fn new(points: &[DVec3]) -> Self {
        let of = |coordinate: fn(&DVec3) -> f64| -> Vec<[f64; LANES]> {
            let lanes = |chunk: &[DVec3]| {
                let mut lanes = [0.0; LANES];
                chunk.iter().zip(&mut lanes).for_each(|(p, lane)| *lane = coordinate(p));
                lanes
            };
            points.chunks(LANES).map(lanes).collect()
        };
        let (x, y, z) = (of(|p| p.x), of(|p| p.y), of(|p| p.z));
        let weights = vec![[0.0; LANES]; x.len()];
        Self { x, y, z, weights, len: points.len() }
    }

    pub(super) fn len(&self) -> usize {
        self.len
    }

    #[cfg(test)]
    fn point(&self, i: usize) -> DVec3 {
        let (block, lane) = (i / LANES, i % LANES);
        DVec3::new(self.x[block][lane], self.y[block][lane], self.z[block][lane])
    }

    /// Sets the weight of each centre.
    pub(super) fn set_weights(&mut self, weights: &[f64]) {
        for (chunk, lanes) in weights.chunks(LANES).zip(&mut self.weights) {
            lanes[..chunk.len()].copy_from_slice(chunk);
        }
    }

    /// The sum of weight times phi at `p`.
    pub(super) fn sum(&self, kernel: Kernel, p: DVec3) -> f64 {
        match kernel {
            Kernel::ThinPlate => self.sum_of::<ThinPlate>(p),
            Kernel::Cubic => self.sum_of::<Cubic>(p),
            Kernel::Linear => self.sum_of::<Linear>(p),
        }
    }

    fn sum_of<R: Radial>(&self, p: DVec3) -> f64 {
        let mut sums = [0.0; LANES];
        for (((x, y), z), weights) in self.x.iter().zip(&self.y).zip(&self.z).zip(&self.weights) {
            for l in 0..LANES {
                let (dx, dy, dz) = (p.x - x[l], p.y - y[l], p.z - z[l]);
                sums[l] += weights[l] * R::value(dx * dx + dy * dy + dz * dz);
            }
        }
        total(sums)
    }

    /// The sum of weight times phi at `p`, and its gradient.
    pub(super) fn sum_and_gradient(&self, kernel: Kernel, p: DVec3) -> (f64, DVec3) {
        match kernel {
            Kernel::ThinPlate => self.gradient_of::<ThinPlate>(p),
            Kernel::Cubic => self.gradient_of::<Cubic>(p),
            Kernel::Linear => self.gradient_of::<Linear>(p),
        }
    }

    fn gradient_of<R: Radial>(&self, p: DVec3) -> (f64, DVec3) {
        let mut sums = [0.0; LANES];
        let mut gradients = [[0.0; LANES]; 3];
        for (((x, y), z), weights) in self.x.iter().zip(&self.y).zip(&self.z).zip(&self.weights) {
            for l in 0..LANES {
                let (dx, dy, dz) = (p.x - x[l], p.y - y[l], p.z - z[l]);
                let q = dx * dx + dy * dy + dz * dz;
                sums[l] += weights[l] * R::value(q);
                let slope = weights[l] * R::slope(q);
                gradients[0][l] += slope * dx;
                gradients[1][l] += slope * dy;
                gradients[2][l] += slope * dz;
            }
        }
        (total(sums), DVec3::from_array(gradients.map(total)))
    }

    /// phi between `p` and each centre, in order, into `row`.
    pub(super) fn row(&self, kernel: Kernel, p: DVec3, range: std::ops::Range<usize>, row: &mut Vec<f64>) {
        match kernel {
            Kernel::ThinPlate => self.row_of::<ThinPlate>(p, range, row),
            Kernel::Cubic => self.row_of::<Cubic>(p, range, row),
            Kernel::Linear => self.row_of::<Linear>(p, range, row),
        }
    }

    /// Bytes of [`Self::table`].
    pub(super) fn table_bytes(&self) -> u64 {
        (self.len * self.x.len() * size_of::<[f64; LANES]>()) as u64
    }

    /// phi between all centres, which are at `points`; `rows` of them are made between two checks of the budget.
    pub(super) fn table(
        &self,
        kernel: Kernel,
        points: &[DVec3],
        rows: usize,
        budget: &Budget,
    ) -> Result<KernelTable, Stopped> {
        let blocks = self.x.len();
        let mut values = vec![[0.0; LANES]; self.len * blocks];
        par::for_each_chunk_mut(&mut values, rows * blocks, |at, out| {
            if budget.check().is_ok() {
                for (line, &p) in out.chunks_mut(blocks).zip(&points[at / blocks..]) {
                    match kernel {
                        Kernel::ThinPlate => self.fill_line::<ThinPlate>(p, line),
                        Kernel::Cubic => self.fill_line::<Cubic>(p, line),
                        Kernel::Linear => self.fill_line::<Linear>(p, line),
                    }
                }
            }
        });
        budget.check()?;
        Ok(KernelTable { values, blocks })
    }

    /// The sum of weight times phi, given phi between a point and each centre.
    pub(super) fn sum_of_row(&self, row: &[[f64; LANES]]) -> f64 {
        let mut sums = [0.0; LANES];
        for (values, weights) in row.iter().zip(&self.weights) {
            for l in 0..LANES {
                sums[l] += weights[l] * values[l];
            }
        }
        total(sums)
    }

    /// phi between `p` and the centres, in their order.
    fn fill_line<R: Radial>(&self, p: DVec3, line: &mut [[f64; LANES]]) {
        for (((x, y), z), values) in self.x.iter().zip(&self.y).zip(&self.z).zip(line) {
            for l in 0..LANES {
                let (dx, dy, dz) = (p.x - x[l], p.y - y[l], p.z - z[l]);
                values[l] = R::value(dx * dx + dy * dy + dz * dz);
            }
        }
    }

    fn row_of<R: Radial>(&self, p: DVec3, range: std::ops::Range<usize>, row: &mut Vec<f64>) {
        row.clear();
        let first = range.start / LANES;
        for block in first..range.end.div_ceil(LANES) {
            let (x, y, z) = (&self.x[block], &self.y[block], &self.z[block]);
            let mut values = [0.0; LANES];
            for l in 0..LANES {
                let (dx, dy, dz) = (p.x - x[l], p.y - y[l], p.z - z[l]);
                values[l] = R::value(dx * dx + dy * dy + dz * dz);
            }
            row.extend_from_slice(&values);
        }
        row.truncate(range.end - first * LANES);
        row.drain(..range.start - first * LANES);
    }
}

fn total(lanes: [f64; LANES]) -> f64 {
    let half: [f64; 4] = std::array::from_fn(|l| lanes[l] + lanes[l + 4]);
    (half[0] + half[2]) + (half[1] + half[3])
}

#[cfg(test)]
mod tests {
    use super::*;

    const KERNELS: [Kernel; 3] = [Kernel::ThinPlate, Kernel::Cubic, Kernel::Linear];

    fn centres() -> WeightedCentres {
        let points: Vec<DVec3> = (0..21)
            .map(|i| DVec3::new(f64::from(i * 7 % 10), f64::from(i * 3 % 11), f64::from(i % 4)) * 0.1)
            .collect();
        let mut centres = WeightedCentres::new(&points);
        centres.set_weights(&(0..21).map(|i| f64::from(i % 5) - 1.5).collect::<Vec<_>>());
        centres
    }

    #[test]
    fn sums_are_those_of_the_formulas() {
        let centres = centres();
        let p = DVec3::new(0.31, 0.17, 0.53);
        for kernel in KERNELS {
            let phi = |r: f64| match kernel {
                Kernel::ThinPlate => r * r * libm::log(r),
                Kernel::Cubic => r * r * r,
                Kernel::Linear => -r,
            };
            let plain: f64 =
                (0..21).map(|i| (f64::from(i % 5) - 1.5) * phi(p.distance(centres.point(i as usize)))).sum();
            assert!((centres.sum(kernel, p) - plain).abs() < 1e-13, "{kernel:?}");
            assert_eq!(centres.sum_and_gradient(kernel, p).0, centres.sum(kernel, p));
            let mut row = Vec::new();
            centres.row(kernel, p, 3..17, &mut row);
            assert_eq!(row.len(), 14);
            assert!((row[4] - phi(p.distance(centres.point(7)))).abs() < 1e-14);
        }
    }

    #[test]
    fn gradients_are_those_of_differences_and_finite_at_a_centre() {
        let centres = centres();
        let p = DVec3::new(0.31, 0.17, 0.53);
        for kernel in KERNELS {
            let gradient = centres.sum_and_gradient(kernel, p).1;
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let step = axis * 1e-5;
                let slope = (centres.sum(kernel, p + step) - centres.sum(kernel, p - step)) / 2e-5;
                assert!((gradient.dot(axis) - slope).abs() < 1e-7, "{kernel:?}");
            }
            let (value, gradient) = centres.sum_and_gradient(kernel, centres.point(4));
            assert!(value.is_finite() && gradient.is_finite());
        }
    }
}
