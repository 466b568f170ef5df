//! The plane that fits points best.

use crate::geom::{Aabb, DVec3};

/// The plane through the centroid of some points with the least sum of squared distances from them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BestPlane {
    /// Unit normal; which of the two is open.
    pub(super) normal: DVec3,
    /// Largest distance of a point, in the unit of the coordinates.
    pub(super) deviation: f64,
}

impl BestPlane {
    /// The plane of `points`, which must be finite.
    pub(super) fn of(points: impl Iterator<Item = DVec3> + Clone) -> Self {
        let bounds = Aabb::of(points.clone());
        let origin = bounds.min / 2.0 + bounds.max / 2.0;
        let half_size = (bounds.max / 2.0 - bounds.min / 2.0).max_element();
        if half_size.is_nan() || half_size <= 0.0 {
            return Self { normal: DVec3::Z, deviation: 0.0 };
        }
        // From -1 to 1, so that squares neither overflow nor vanish.
        let scaled = points.map(|p| (p - origin) / half_size);
        let (sum, count) = scaled.clone().fold((DVec3::ZERO, 0.0), |(sum, n), p| (sum + p, n + 1.0));
        let centroid = sum / count;
        let mut spread = [[0.0; 3]; 3];
        for d in scaled.clone().map(|p| p - centroid) {
            for (row, x) in spread.iter_mut().zip(d.to_array()) {
                for (sum, y) in row.iter_mut().zip(d.to_array()) {
                    *sum += x * y;
                }
            }
        }
        let normal = direction_of_least_spread(spread);
        let deviation = scaled.map(|p| (p - centroid).dot(normal).abs()).fold(0.0, f64::max);
        Self { normal, deviation: deviation * half_size }
    }
}

/// Sweeps after which the off-diagonal elements of a symmetric 3 by 3 matrix are below rounding; convergence is
/// quadratic and four or five do.
const SWEEPS: usize = 12;

/// Unit eigenvector of the smallest eigenvalue of a symmetric matrix, by Jacobi's rotations (Golub & Van Loan 2013,
/// section 8.5).
fn direction_of_least_spread(mut m: [[f64; 3]; 3]) -> DVec3 {
    let mut basis = [DVec3::X, DVec3::Y, DVec3::Z];
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if m[p][q] == 0.0 {
                continue;
            }
            let tau = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
            let t = tau.signum() / (tau.abs() + (1.0 + tau * tau).sqrt());
            let c = 1.0 / (1.0 + t * t).sqrt();
            let s = t * c;
            let rotated = |x: f64, y: f64| (c * x - s * y, s * x + c * y);
            for row in &mut m {
                (row[p], row[q]) = rotated(row[p], row[q]);
            }
            let (row_p, row_q) = (m[p], m[q]);
            for (k, (x, y)) in row_p.into_iter().zip(row_q).enumerate() {
                (m[p][k], m[q][k]) = rotated(x, y);
            }
            (basis[p], basis[q]) = (basis[p] * c - basis[q] * s, basis[p] * s + basis[q] * c);
        }
    }
    let least = (0..3).min_by(|&i, &j| m[i][i].total_cmp(&m[j][j])).unwrap_or(2);
    basis[least]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_in_a_plane_do_not_deviate_from_it_at_any_scale() {
        let normal = DVec3::new(1.0, 2.0, -2.0) / 3.0;
        let [u, v] = [normal.any_orthonormal_vector(), normal.cross(normal.any_orthonormal_vector())];
        for scale in [1e-200, 1.0, 1e300] {
            let points =
                [(0.0, 0.0), (1.0, 0.1), (0.7, 0.9), (-0.3, 0.5)].map(|(x, y)| (u * x + v * y) * scale);
            let plane = BestPlane::of(points.into_iter());
            assert!(plane.normal.dot(normal).abs() > 1.0 - 1e-12, "{plane:?}");
            assert!(plane.deviation <= 1e-15 * scale, "{plane:?}");
        }
    }

    #[test]
    fn a_saddle_deviates_by_half_its_height() {
        let saddle = [(1.0, 1.0, 0.25), (-1.0, 1.0, -0.25), (-1.0, -1.0, 0.25), (1.0, -1.0, -0.25)];
        let plane = BestPlane::of(saddle.into_iter().map(DVec3::from));
        assert!((plane.normal.z.abs() - 1.0).abs() < 1e-12);
        assert!((plane.deviation - 0.25).abs() < 1e-12);
    }

    #[test]
    fn points_on_a_line_or_at_one_place_have_a_plane_through_them() {
        for points in
            [vec![DVec3::ONE; 3], (0..5).map(|i| DVec3::new(1.0, 2.0, 3.0) * f64::from(i)).collect()]
        {
            let plane = BestPlane::of(points.into_iter());
            assert!(plane.deviation < 1e-14 && (plane.normal.length() - 1.0).abs() < 1e-12, "{plane:?}");
        }
    }
}
