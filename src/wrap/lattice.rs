//! The lattice: whole multiples of a pitch that are all float32, with room around the surface.

use crate::geom::{Aabb, DVec3, exponent_above, power_of_two};

/// Cells between the surface and the border of the lattice. More than the thickness of a sheet (at most `sqrt(3)`
/// cells) and two cells, so that the border is outside.
const MARGIN: i64 = 4;

/// Most cells along a side, whatever is asked.
pub(super) const CELLS_MAX: u32 = 1024;

/// Least share of the diagonal that the pitch must resolve.
const PITCH_OF_DIAGONAL_MAX: f64 = 1.0 / 16384.0;

/// Largest multiple of the pitch that is a float32 whatever the pitch.
const MULTIPLE_MAX: i64 = 1 << 24;

/// Cubes with corners at whole multiples of the pitch. A place is a lattice *unit* coordinate: cells from the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lattice {
    /// Every coordinate is a multiple of this power of two.
    pub(super) pitch: f64,
    /// First vertex, in pitches.
    origin: [i64; 3],
    /// Side of a cube, in pitches: a multiple of `1 << steps_log2`.
    spacing: i64,
    /// An edge is cut at a multiple of its length over `1 << steps_log2`.
    pub(super) steps_log2: u32,
    /// Number of vertices along each side.
    pub(super) dims: [usize; 3],
}

/// The pitch of float32 is too coarse for the part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TooCoarse {
    /// The pitch, in the unit of the coordinates.
    pub pitch: f64,
    /// The diagonal of the part, in the same unit.
    pub diagonal: f64,
}

impl Lattice {
    /// A lattice around `bounds`, which must have an extent, with about `cells` cubes along its longest side but not
    /// more than `vertices_max` vertices.
    ///
    /// # Errors
    /// When float32 cannot hold the part: its pitch there exceeds 2^-14 of the diagonal.
    pub(super) fn around(bounds: Aabb, cells: u32, vertices_max: usize) -> Result<Self, TooCoarse> {
        let mut cells = f64::from(cells.clamp(4, CELLS_MAX));
        loop {
            let lattice = Self::with_cells(bounds, cells)?;
            let is_small = lattice.dims.iter().product::<usize>() <= vertices_max;
            if is_small || cells <= 4.0 {
                return Ok(lattice);
            }
            cells *= 0.875;
        }
    }

    fn with_cells(bounds: Aabb, cells: f64) -> Result<Self, TooCoarse> {
        let extent = bounds.max - bounds.min;
        let side = extent.max_element() / cells;
        let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
        let diagonal = bounds.diagonal();
        let mut exponent = exponent_above(reach + side * (MARGIN + 2) as f64) - 23;
        loop {
            exponent = exponent.max(-149);
            let pitch = power_of_two(exponent);
            if !diagonal.is_finite() || exponent > 104 || pitch > diagonal * PITCH_OF_DIAGONAL_MAX {
                return Err(TooCoarse { pitch, diagonal });
            }
            if let Some(lattice) = Self::of_pitch(bounds, side, pitch) {
                return Ok(lattice);
            }
            exponent += 1;
        }
    }

    fn of_pitch(bounds: Aabb, side: f64, pitch: f64) -> Option<Self> {
        let pitches = (side / pitch).ceil().max(8.0);
        // Fine steps of the cuts, but a spacing within a sixteenth of what was asked.
        let steps_log2 = (exponent_above(pitches) - 5).clamp(3, 10) as u32;
        let spacing = (pitches as i64 + (1 << steps_log2) - 1) >> steps_log2 << steps_log2;
        let in_pitches = |p: DVec3| p.to_array().map(|x| (x / pitch).floor() as i64);
        let (min, max) = (in_pitches(bounds.min), in_pitches(bounds.max));
        // Half a cell more: faces of the box are then as far from the vertices as can be.
        let origin = min.map(|x| x - MARGIN * spacing - spacing / 2);
        let counts = [0, 1, 2].map(|a| (max[a] - origin[a]) / spacing + MARGIN + 2);
        let is_float32 =
            (0..3).all(|a| origin[a] >= -MULTIPLE_MAX && origin[a] + counts[a] * spacing <= MULTIPLE_MAX);
        is_float32.then_some(Self { pitch, origin, spacing, steps_log2, dims: counts.map(|n| n as usize) })
    }

    /// Side of a cube, in the unit of the coordinates.
    pub(super) fn side(&self) -> f64 {
        self.spacing as f64 * self.pitch
    }

    /// Number of vertices.
    pub(super) fn len(&self) -> usize {
        self.dims.iter().product()
    }

    /// `p` in lattice units, rounded.
    pub(super) fn units_of(&self, p: DVec3) -> DVec3 {
        let spacing = self.spacing as f64;
        let along = |x: f64, a: usize| (x / self.pitch - self.origin[a] as f64) / spacing;
        DVec3::new(along(p.x, 0), along(p.y, 1), along(p.z, 2))
    }

    /// The place at whole `steps` of `1 << steps_log2` to a cell, exactly.
    pub(super) fn place(&self, steps: [i64; 3]) -> DVec3 {
        let step = self.spacing >> self.steps_log2;
        DVec3::from_array([0, 1, 2].map(|a| (self.origin[a] + steps[a] * step) as f64 * self.pitch))
    }

    /// The multiple of the pitch nearest to the place at `units`.
    pub(super) fn nearest(&self, units: DVec3) -> DVec3 {
        let u = units.to_array();
        DVec3::from_array([0, 1, 2].map(|a| {
            let pitches = self.origin[a] as f64 + (u[a] * self.spacing as f64).round();
            pitches.clamp(-(MULTIPLE_MAX as f64), MULTIPLE_MAX as f64) * self.pitch
        }))
    }

    /// Number of the vertex at these coordinates: the last one varies fastest.
    pub(super) fn index(&self, [i, j, k]: [usize; 3]) -> usize {
        (i * self.dims[1] + j) * self.dims[2] + k
    }

    /// Coordinates of vertex `index`.
    pub(super) fn coordinates(&self, index: usize) -> [usize; 3] {
        let (rest, k) = (index / self.dims[2], index % self.dims[2]);
        [rest / self.dims[1], rest % self.dims[1], k]
    }

    /// The place of vertex `index`, in lattice units.
    pub(super) fn units(&self, index: usize) -> DVec3 {
        DVec3::from_array(self.coordinates(index).map(|n| n as f64))
    }

    /// What to add to a vertex number to go by `offset`.
    pub(super) fn stride(&self, [i, j, k]: [isize; 3]) -> isize {
        (i * self.dims[1] as isize + j) * self.dims[2] as isize + k
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_float32(p: DVec3) -> bool {
        p.as_vec3().as_dvec3() == p
    }

    #[test]
    fn every_place_of_a_lattice_is_float32_at_every_scale_and_offset() {
        for (offset, size) in
            [(0.0, 1.0), (100.0, 1.0), (-3e3, 9.0), (0.0, 1e-30), (0.0, 1e30), (1e30, 1e29), (3.0, 1e-2)]
        {
            let min = DVec3::splat(offset);
            let bounds = Aabb { min, max: min + DVec3::new(size, size * 0.3, size * 0.01) };
            let lattice = Lattice::around(bounds, 64, usize::MAX).unwrap();
            assert!(
                (60.0..=68.0).contains(&(size / lattice.side())) || lattice.side() == 8.0 * lattice.pitch,
                "{lattice:?}"
            );
            let last = lattice.dims.map(|n| ((n - 1) as i64) << lattice.steps_log2);
            for steps in [[0; 3], last, [1, 2, 3], [last[0] - 1, 5, last[2] / 3]] {
                assert!(is_float32(lattice.place(steps)), "{offset} {size} {steps:?}");
            }
            let units = lattice.units_of(bounds.min);
            assert!(units.min_element() >= MARGIN as f64);
            let end = lattice.units_of(bounds.max) + MARGIN as f64;
            assert!((0..3).all(|a| end[a] <= (lattice.dims[a] - 1) as f64));
            assert!(is_float32(lattice.nearest(units)));
        }
    }

    #[test]
    fn a_part_that_float32_cannot_hold_is_told() {
        let at = |offset: f64, size: f64| {
            let min = DVec3::splat(offset);
            Lattice::around(Aabb { min, max: min + size }, 64, usize::MAX)
        };
        assert!(at(1e6, 1.0).is_err());
        assert!(at(500.0, 1.0).is_ok());
        assert!(at(0.0, 1e39).is_err());
        assert!(at(0.0, 1e-45).is_err());
        assert!(at(0.0, 1e-200).is_err());
        assert!(at(0.0, 1e200).is_err());
    }

    #[test]
    fn a_lattice_has_no_more_vertices_than_allowed() {
        let bounds = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
        assert!(Lattice::around(bounds, 256, 100_000).unwrap().len() <= 100_000);
    }

    #[test]
    fn exponents_are_the_least_that_hold() {
        for (x, e) in [(1.0, 0), (1.5, 1), (2.0, 1), (0.75, 0), (1e-30, -99), (0.0, -1022)] {
            assert_eq!(exponent_above(x), e, "{x}");
        }
    }
}
