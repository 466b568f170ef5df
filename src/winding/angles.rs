//! Sums of the solid angles under which triangles are seen, eight at a time.

use crate::geom::DVec3;

/// Triangles of a [`Block`].
pub(super) const BLOCK: usize = 8;

/// Products that are kept beside each other, so that one multiplication need not wait for the one before.
const CHAINS: usize = 2;

/// Up to [`BLOCK`] triangles side by side; absent ones are points, which are seen under no angle.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Block {
    /// By corner, axis and triangle.
    corners: [[[f64; BLOCK]; 3]; 3],
}

impl Block {
    pub(super) fn of(triangles: &[[DVec3; 3]]) -> Self {
        let mut block = Self::default();
        for (k, triangle) in triangles.iter().enumerate() {
            for (of_axes, corner) in block.corners.iter_mut().zip(triangle) {
                for (of_axis, x) in of_axes.iter_mut().zip(corner.to_array()) {
                    of_axis[k] = x;
                }
            }
        }
        block
    }

    /// For each triangle a complex number `(real, imaginary)` whose argument is half the signed solid angle under which
    /// it is seen from `p`, positive from behind (van Oosterom and Strackee 1983), and for which |real| + |imaginary| is 1.
    /// No angle in its plane, nor where the numbers are too large or too small.
    fn halves_from(&self, p: DVec3) -> ([f64; BLOCK], [f64; BLOCK]) {
        let [a, b, c] = &self.corners;
        let (mut real, mut imaginary) = ([1.0; BLOCK], [0.0; BLOCK]);
        // One loop without branches, so that several triangles share an instruction.
        for k in 0..BLOCK {
            let (ax, ay, az) = (a[0][k] - p.x, a[1][k] - p.y, a[2][k] - p.z);
            let (bx, by, bz) = (b[0][k] - p.x, b[1][k] - p.y, b[2][k] - p.z);
            let (cx, cy, cz) = (c[0][k] - p.x, c[1][k] - p.y, c[2][k] - p.z);
            let x = (ax * ax + ay * ay + az * az).sqrt();
            let y = (bx * bx + by * by + bz * bz).sqrt();
            let z = (cx * cx + cy * cy + cz * cz).sqrt();
            let determinant = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
            let (ab, bc, ca) =
                (ax * bx + ay * by + az * bz, bx * cx + by * cy + bz * cz, cx * ax + cy * ay + cz * az);
            let along = x * y * z + ab * z + bc * x + ca * y;
            let size = along.abs() + determinant.abs();
            let is_seen = (determinant != 0.0) & (f64::MIN_POSITIVE..=f64::MAX).contains(&size);
            real[k] = if is_seen { along / size } else { 1.0 };
            imaginary[k] = if is_seen { determinant / size } else { 0.0 };
        }
        (real, imaginary)
    }
}

/// A sum of angles between -pi and pi, as products of complex numbers with these arguments: an arc tangent for many.
#[derive(Debug, Clone, Copy)]
pub(super) struct AngleSum {
    real: [f64; CHAINS],
    imaginary: [f64; CHAINS],
    /// Whole turns.
    turns: [f64; CHAINS],
}

impl Default for AngleSum {
    fn default() -> Self {
        Self { real: [1.0; CHAINS], imaginary: [0.0; CHAINS], turns: [0.0; CHAINS] }
    }
}

impl AngleSum {
    /// Adds half the solid angles under which the triangles of a block are seen from `p`.
    pub(super) fn add_halves(&mut self, block: &Block, p: DVec3) {
        let (real, imaginary) = block.halves_from(p);
        self.add(&real, &imaginary);
    }

    /// Adds the arguments of complex numbers that are no smaller than 1/2 and no larger than 1.
    fn add(&mut self, real: &[f64; BLOCK], imaginary: &[f64; BLOCK]) {
        for first in (0..BLOCK).step_by(CHAINS) {
            for j in 0..CHAINS {
                let ([x, y], [re, im]) =
                    ([self.real[j], self.imaginary[j]], [real[first + j], imaginary[first + j]]);
                let (u, v) = (x * re - y * im, x * im + y * re);
                // Two angles of one sign come past half a turn where their sum seems to have the other one.
                let is_past = (y >= 0.0) & (im > 0.0) & (v < 0.0);
                let is_before = (y < 0.0) & (im < 0.0) & (v >= 0.0);
                self.turns[j] += if is_past { 1.0 } else { 0.0 } - if is_before { 1.0 } else { 0.0 };
                (self.real[j], self.imaginary[j]) = (u, v);
            }
        }
        // Only the direction matters. A product of so few numbers is far from the ends of the range.
        for j in 0..CHAINS {
            let size = self.real[j].abs() + self.imaginary[j].abs();
            (self.real[j], self.imaginary[j]) = (self.real[j] / size, self.imaginary[j] / size + 0.0);
        }
    }

    pub(super) fn total(self) -> f64 {
        let of_chain =
            |j: usize| libm::atan2(self.imaginary[j], self.real[j]) + self.turns[j] * std::f64::consts::TAU;
        (0..CHAINS).map(of_chain).sum()
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Half the solid angle of one triangle, by the formula as it is printed.
    pub(in crate::winding) fn half_solid_angle(p: DVec3, corners: [DVec3; 3]) -> f64 {
        let [a, b, c] = corners.map(|q| q - p);
        let (x, y, z) = (a.length(), b.length(), c.length());
        let determinant = a.dot(b.cross(c));
        let is_in_plane = determinant == 0.0;
        let along = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
        if is_in_plane { 0.0 } else { libm::atan2(determinant, along) }
    }

    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    #[test]
    fn a_product_adds_up_angles_over_many_turns() {
        let mut state = 5;
        for case in 0..2000 {
            // Mostly of one sign in half of the cases.
            let lean = if case % 2 == 0 { 0.0 } else { 0.9 };
            let (mut sum, mut expected) = (AngleSum::default(), 0.0);
            for _ in 0..25 {
                let numbers: [[f64; 2]; BLOCK] = std::array::from_fn(|_| {
                    let (re, im) = (random(&mut state), random(&mut state) + lean);
                    let size = re.abs() + im.abs();
                    [re / size, im / size]
                });
                sum.add(&numbers.map(|number| number[0]), &numbers.map(|number| number[1]));
                expected += numbers.iter().map(|&[re, im]| libm::atan2(im, re)).sum::<f64>();
            }
            assert!((sum.total() - expected).abs() < 1e-9, "{} {expected}", sum.total());
        }
    }

    #[test]
    fn blocks_give_what_their_triangles_give_also_where_they_are_not_full() {
        let mut state = 7;
        for case in 0..2000 {
            let scale = libm::exp2(60.0 * random(&mut state));
            let mut point = || DVec3::from_array([(); 3].map(|()| random(&mut state))) * scale;
            let p = point();
            let triangles: Vec<[DVec3; 3]> = (0..=case % BLOCK)
                .map(|k| [point(), if k % 5 == 4 { p } else { point() }, point()])
                .collect();
            let mut sum = AngleSum::default();
            sum.add_halves(&Block::of(&triangles), p);
            let expected: f64 = triangles.iter().map(|&t| half_solid_angle(p, t)).sum();
            assert!((sum.total() - expected).abs() < 1e-9, "{} {expected}", sum.total());
        }
    }

    #[test]
    fn numbers_out_of_range_count_as_no_angle() {
        let huge = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis * 1e200);
        // Its determinant is below the normal numbers.
        let tiny = huge.map(|corner| corner * 1e-307);
        let endless = [DVec3::INFINITY, DVec3::NAN, DVec3::ZERO];
        let mut sum = AngleSum::default();
        sum.add_halves(&Block::of(&[huge, tiny, endless]), DVec3::ZERO);
        assert_eq!(sum.total(), 0.0);
    }
}
