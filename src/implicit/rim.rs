//! The rims as lines on the surface: which side of them is the hole.

use super::field::Field;
use super::patch::Unmeshed;
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::par;
use crate::spatial::NearestSearch;

/// Segments handled between two checks of the budget.
const SEGMENTS: usize = 32;

/// The segments of all rims, with the direction into the hole at each segment and vertex.
#[derive(Debug)]
pub(super) struct RimLines {
    /// The vertices of the rims, one rim after the other.
    pub points: Vec<DVec3>,
    /// Where each rim begins in `points`, and the end.
    pub starts: Vec<usize>,
    /// Each segment as a triangle without area.
    pub segments: Vec<[u32; 3]>,
    into_at_segment: Vec<DVec3>,
    into_at_vertex: Vec<DVec3>,
    /// The mean length of the two segments at each vertex.
    pub length_at: Vec<f64>,
}

impl RimLines {
    pub(super) fn new(
        field: &Field,
        rims: &[Vec<DVec3>],
        budget: &Budget,
    ) -> Result<Result<Self, Unmeshed>, Stopped> {
        if rims.is_empty() || rims.iter().any(|rim| rim.len() < 3 || rim.iter().any(|p| !p.is_finite())) {
            return Ok(Err(Unmeshed::Input));
        }
        let points = rims.concat();
        let mut starts = vec![0];
        let mut segments = Vec::with_capacity(points.len());
        for rim in rims {
            let first = starts[starts.len() - 1];
            let end = |i: usize| (first + (i + 1) % rim.len()) as u32;
            segments.extend((0..rim.len()).map(|i| [(first + i) as u32, end(i), end(i)]));
            starts.push(first + rim.len());
        }
        let into = |s: &[u32; 3]| {
            let [a, b] = [points[s[0] as usize], points[s[1] as usize]];
            let normal = field.normal(a * 0.5 + b * 0.5).unwrap_or(DVec3::ZERO);
            normal.cross(b - a).normalize_or_zero()
        };
        let of = |range: std::ops::Range<usize>| -> Result<Vec<DVec3>, Stopped> {
            budget.check()?;
            Ok(segments[range].iter().map(into).collect())
        };
        let into_at_segment = par::try_map_ranges(segments.len(), SEGMENTS, of)?.concat();
        let mut into_at_vertex = vec![DVec3::ZERO; points.len()];
        let mut length_at = vec![0.0; points.len()];
        for (s, into) in segments.iter().zip(&into_at_segment) {
            let length = points[s[0] as usize].distance(points[s[1] as usize]);
            for v in [s[0], s[1]] {
                into_at_vertex[v as usize] += *into;
                length_at[v as usize] += 0.5 * length;
            }
        }
        Ok(Ok(Self { points, starts, segments, into_at_segment, into_at_vertex, length_at }))
    }

    /// The search for the closest segment.
    pub(super) fn search(&self, budget: &Budget) -> Result<NearestSearch<'_>, Stopped> {
        NearestSearch::build(&self.points, &self.segments, budget)
    }

    /// How far `p` is from the rims: positive on the side of the hole, negative on the side of the surface. The sign
    /// means something near the rims only.
    pub(super) fn side(&self, search: &NearestSearch<'_>, p: DVec3, budget: &Budget) -> Result<f64, Stopped> {
        let Some(nearest) = search.find(p, None, budget)? else { return Ok(0.0) };
        let [a, b, _] = self.segments[nearest.triangle as usize].map(|v| v as usize);
        let at = nearest.point;
        let into = if at == self.points[a] {
            self.into_at_vertex[a]
        } else if at == self.points[b] {
            self.into_at_vertex[b]
        } else {
            self.into_at_segment[nearest.triangle as usize]
        };
        Ok(if (p - at).dot(into) < 0.0 { -nearest.distance } else { nearest.distance })
    }

    /// The edge length wanted at `p`: that of the rim at the rim, and `length` away from it.
    pub(super) fn wanted_length(
        &self,
        search: &NearestSearch<'_>,
        p: DVec3,
        length: f64,
        budget: &Budget,
    ) -> Result<f64, Stopped> {
        let Some(nearest) = search.find(p, None, budget)? else { return Ok(length) };
        let [a, b, _] = self.segments[nearest.triangle as usize].map(|v| v as usize);
        let [from, to] = [self.points[a], self.points[b]];
        let share = nearest.point.distance(from) / from.distance(to).max(f64::MIN_POSITIVE);
        let here = self.length_at[a] + (self.length_at[b] - self.length_at[a]) * share.min(1.0);
        // Lengths change by at most a third of the way, so neighbouring edges differ little.
        Ok(if length > here {
            length.min(here + nearest.distance / 3.0)
        } else {
            length.max(here - nearest.distance / 3.0)
        })
    }
}
