//! The mesh under simplification: triangles, and what each vertex carries.

use super::marks::LINE;
use super::wedges::Wedges;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::mesh::corner_table::{CornerTable, NONE, next, prev};
use crate::par;

/// In the place of an origin: a position that the input does not have.
pub const NEW: u32 = u32::MAX;

/// A vertex, with what the criterion keeps there: whole cache lines, one or two.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct Vertex<S> {
    /// In working units: the input's times [`CollapseSurface::scale`].
    pub position: DVec3,
    pub state: S,
    /// The vertex of the input at this very position, or [`NEW`].
    pub origin: u32,
    /// Number of edges marked [`LINE`].
    pub lines: u32,
    /// Must stay where it is.
    pub is_held: bool,
    /// One of its edges may be set aside.
    pub has_aside: bool,
}

#[derive(Debug, Clone)]
pub(super) struct CollapseSurface<S> {
    pub table: CornerTable,
    pub vertices: Vec<Vertex<S>>,
    pub wedges: Wedges,
    /// It has face groups or texture, so that lines part it into regions, each of which stays.
    pub has_regions: bool,
    /// A power of two: the working copy is about a thousand units large, so that no square or fourth power leaves the
    /// range of f64, nor its order of magnitude that of f32.
    pub scale: f64,
    /// Adding and subtracting it rounds a coordinate to the lattice: `1.5 * 2^52` pitches, where a step of f64 is one.
    rounder: f64,
}

/// Where the vertex that an edge becomes may go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MergeRule {
    Anywhere,
    OntoOrigin,
    OntoDestination,
}

impl<S: Copy + Default> CollapseSurface<S> {
    /// A surface of `count` vertices, of which number `i` is that of the input with the number `origin_of(i)`.
    pub(super) fn new(
        positions: &[DVec3],
        count: usize,
        origin_of: impl Fn(usize) -> u32 + Sync,
        table: CornerTable,
        budget: &Budget,
    ) -> Result<Self, Stopped>
    where
        S: Send,
    {
        budget.check()?;
        let bounds = par::map_ranges(positions.len(), CHECK_EVERY, |range| {
            Aabb::of(positions[range].iter().copied().filter(|p| p.is_finite()))
        });
        let bounds = bounds.into_iter().fold(Aabb::EMPTY, Aabb::union);
        let scale = working_scale(bounds);
        let vertices = par::map_indices(count, CHECK_EVERY, |i| {
            let origin = origin_of(i);
            Vertex {
                position: positions[origin as usize] * scale,
                state: S::default(),
                origin,
                lines: 0,
                is_held: false,
                has_aside: false,
            }
        });
        budget.check()?;
        let wedges = Wedges::default();
        Ok(Self { table, vertices, wedges, has_regions: false, scale, rounder: rounder(bounds, scale) })
    }

    /// Some of its vertices and triangles, in the same units and on the same lattice.
    pub(super) fn of_part(&self, table: CornerTable, vertices: Vec<Vertex<S>>) -> Self {
        let Self { has_regions, scale, rounder, .. } = *self;
        Self { table, vertices, wedges: Wedges::default(), has_regions, scale, rounder }
    }

    #[inline]
    pub(super) fn vertex(&self, v: u32) -> &Vertex<S> {
        &self.vertices[v as usize]
    }

    #[inline]
    pub(super) fn position(&self, v: u32) -> DVec3 {
        self.vertices[v as usize].position
    }

    /// The nearest point whose coordinates are multiples of the pitch, in working units.
    #[inline]
    pub(super) fn on_lattice(&self, p: DVec3) -> DVec3 {
        let rounder = DVec3::splat(self.rounder);
        (p + rounder) - rounder
    }

    /// The corners of the triangle of `h`, the origin of `h` first.
    #[inline]
    pub(super) fn corners(&self, h: u32) -> [DVec3; 3] {
        [h, next(h), prev(h)].map(|g| self.position(self.table.origin(g)))
    }

    /// The ends of `h`.
    #[inline]
    pub(super) fn ends(&self, h: u32) -> [&Vertex<S>; 2] {
        [self.vertex(self.table.origin(h)), self.vertex(self.table.destination(h))]
    }

    /// Where the edge of `h` may be collapsed to: a vertex on a line stays on it, one where lines end or meet stays
    /// where it is. Nothing when that cannot be.
    #[inline]
    pub(super) fn rule(&self, h: u32) -> Option<MergeRule> {
        let [a, b] = self.ends(h);
        if a.lines == 0 && b.lines == 0 && !a.is_held && !b.is_held {
            return Some(MergeRule::Anywhere);
        }
        let is_line = self.table.marks(h) & LINE != 0;
        let stays = |v: &Vertex<S>| v.is_held || (v.lines != 0 && (!is_line || v.lines != 2));
        match (stays(a), stays(b)) {
            (false, false) => Some(MergeRule::Anywhere),
            (true, false) => Some(MergeRule::OntoOrigin),
            (false, true) => Some(MergeRule::OntoDestination),
            (true, true) => None,
        }
    }

    /// False when a region goes with the triangles of the edge of `h`: one of them is a region alone.
    #[inline]
    pub(super) fn keeps_regions(&self, h: u32) -> bool {
        let is_line = |g: u32| self.table.marks(g) & LINE != 0;
        let is_region = |g: u32| g != NONE && is_line(g) && is_line(next(g)) && is_line(prev(g));
        !self.has_regions || !(is_region(h) || is_region(self.table.twin(h)))
    }

    /// The edges of the origin of `h`, each once.
    #[inline]
    pub(super) fn star(&self, h: u32) -> impl Iterator<Item = u32> {
        self.table.fan(h).flat_map(|corner| {
            let before = prev(corner);
            let is_last = self.table.twin(before) == NONE;
            [Some(self.table.edge(corner)), is_last.then_some(before)].into_iter().flatten()
        })
    }
}

/// The power of two that makes the larger half-extent of the box 512 to 1024 units.
fn working_scale(bounds: Aabb) -> f64 {
    let half = (0.5 * bounds.max - 0.5 * bounds.min).max_element();
    if half.is_nan() || half <= 0.0 {
        return 1.0;
    }
    // The exponent of `half`, not less than that of the normal numbers.
    let exponent = ((half.to_bits() >> 52) as i64 - 1023).max(-1000);
    f64::from_bits(((1023 + 9 - exponent) as u64) << 52)
}

/// `1.5 * 2^52` pitches of the lattice, in working units: `2^(ceil(log2 M) - 23)` with the largest magnitude `M`, but
/// not less than the least float32.
fn rounder(bounds: Aabb, scale: f64) -> f64 {
    let largest = bounds.min.abs().max(bounds.max.abs()).max_element() * scale;
    let least = f64::from(f32::from_bits(1)) * scale;
    // Numbers up to a power of two, itself included, have the pitch of those below it.
    let power =
        if largest.is_normal() { f64::from_bits((largest.to_bits() - 1) >> 52 << 52) * 2.0 } else { 1.0 };
    1.5 * 2f64.powi(52) * (power * 2f64.powi(-23)).max(least)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_working_copy_is_about_a_thousand_units_large_whatever_the_input() {
        for size in [1e-300, 1e-30, 0.75, 1.0, 3.0, 1e30, 1e300, 1.7e308] {
            let bounds = Aabb { min: DVec3::splat(-size), max: DVec3::splat(size) };
            let scale = working_scale(bounds);
            assert!((512.0..1024.0).contains(&(size * scale)), "{size} {scale}");
            assert_eq!(scale.to_bits() << 12, 0, "a power of two");
        }
        assert_eq!(working_scale(Aabb::EMPTY), 1.0);
        assert_eq!(working_scale(Aabb::of([DVec3::ONE])), 1.0);
    }
    #[test]
    fn rounding_gives_the_nearest_of_at_most_2_to_the_24_float32_steps() {
        for largest in [1.0, 1.5, 3.0, 100.0, 255.99, 256.0, 1e-30, 1e30] {
            let bounds = Aabb::of([DVec3::ZERO, DVec3::new(largest, 0.0, -0.5 * largest)]);
            let (scale, mut pitch) = (working_scale(bounds), 2f64.powi(-200));
            while pitch * 2f64.powi(23) < largest {
                pitch *= 2.0;
            }
            let rounder = rounder(bounds, scale);
            for share in [1.0, 0.7, 0.1234567, 1e-9, -0.3, 1e-30] {
                let x = share * largest;
                let rounded = ((x * scale + rounder) - rounder) / scale;
                assert_eq!(rounded, (x / pitch).round_ties_even() * pitch, "{x} of {largest}");
                assert_eq!(f64::from(rounded as f32), rounded);
            }
        }
    }
}
