//! The area that a part covers when it is seen along an axis.
//!
//! Rows across the view; on the middle line of each the stretches that triangles cover are found exactly and joined. The
//! error is that of the midpoint rule: of the order of the outline's length times half a row.

use super::BuildDirection;
use super::surface::WeldedSurface;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::par;
use std::ops::Range;

/// Rows, unless the triangles would cross them too often.
const ROWS: usize = 1 << 11;

/// Most crossings of triangles and rows; with more the rows are halved until there are fewer.
const CROSSINGS_MAX: u64 = 1 << 22;

/// The shadow along `direction`, in square units of the file. Of a solid only what faces the light is looked at.
pub(super) fn shadow(
    surface: &WeldedSurface<'_>,
    direction: BuildDirection,
    is_solid: bool,
    budget: &Budget,
) -> Result<f64, Stopped> {
    let (mut view, mut rows) = (ShadowView::new(surface, direction, is_solid, ROWS), ROWS);
    let mut starts = view.starts(budget)?;
    while starts[rows] > CROSSINGS_MAX && rows > 1 {
        rows /= 2;
        view = ShadowView::new(surface, direction, is_solid, rows);
        starts = view.starts(budget)?;
    }
    let total = starts[rows] as usize;
    let _charge = budget.charge(total as u64 * 16)?;
    let mut next: Vec<usize> = starts.iter().map(|&start| start as usize).collect();
    let mut stretches = vec![[0.0f64; 2]; total];
    for t in 0..surface.triangles.len() as u32 {
        if (t as usize).is_multiple_of(CHECK_EVERY) {
            budget.check()?;
        }
        for row in view.rows_of(t) {
            stretches[next[row]] = view.stretch(t, row);
            next[row] += 1;
        }
    }
    let lengths = par::try_map_ranges(rows, 16, |range| {
        let mut sum = 0.0;
        for row in range {
            let of_row = &stretches[starts[row] as usize..starts[row + 1] as usize];
            budget.spend(of_row.len() as u64 / 64)?;
            sum += covered(of_row.to_vec());
        }
        Ok(sum)
    })?;
    Ok(lengths.into_iter().sum::<f64>() * view.row_height)
}

/// Length of the union of stretches.
fn covered(mut stretches: Vec<[f64; 2]>) -> f64 {
    stretches.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let (mut sum, mut end) = (0.0, f64::NEG_INFINITY);
    for [from, to] in stretches {
        if to > end {
            sum += to - from.max(end);
            end = to;
        }
    }
    sum
}

/// The surface seen along an axis.
struct ShadowView<'v> {
    surface: &'v WeldedSurface<'v>,
    axis: usize,
    sign: f64,
    is_solid: bool,
    floor: f64,
    row_height: f64,
    rows: usize,
}

impl<'v> ShadowView<'v> {
    fn new(surface: &'v WeldedSurface<'v>, direction: BuildDirection, is_solid: bool, rows: usize) -> Self {
        let (axis, sign) = direction.axis();
        let up = (axis + 2) % 3;
        let (floor, height) = (surface.bounds.min[up], surface.bounds.max[up] - surface.bounds.min[up]);
        Self { surface, axis, sign, is_solid, floor, row_height: height / rows as f64, rows }
    }

    /// Across and up in the view.
    fn seen(&self, t: u32) -> [[f64; 2]; 3] {
        self.surface.corners(t).map(|p| [p[(self.axis + 1) % 3], p[(self.axis + 2) % 3]])
    }

    /// The rows whose middle lines cross triangle `t`.
    fn rows_of(&self, t: u32) -> Range<usize> {
        let facing = self.surface.normals[t as usize][self.axis] * self.sign;
        if self.row_height == 0.0 || facing == 0.0 || (self.is_solid && facing < 0.0) {
            return 0..0;
        }
        let heights = self.seen(t).map(|[_, up]| (up - self.floor) / self.row_height - 0.5);
        let low = heights.iter().copied().fold(f64::MAX, f64::min).ceil();
        let high = heights.iter().copied().fold(f64::MIN, f64::max).floor();
        // Casts of what is out of range saturate.
        (low.max(0.0) as usize)..((high + 1.0).max(0.0) as usize).min(self.rows)
    }

    /// Where the stretches of each row begin, and the end.
    fn starts(&self, budget: &Budget) -> Result<Vec<u64>, Stopped> {
        let mut starts = vec![0u64; self.rows + 1];
        for t in 0..self.surface.triangles.len() as u32 {
            if (t as usize).is_multiple_of(CHECK_EVERY) {
                budget.check()?;
            }
            // Counted at the ends, so that a large triangle costs no more than a small one.
            let rows = self.rows_of(t);
            if !rows.is_empty() {
                starts[rows.start] = starts[rows.start].wrapping_add(1);
                starts[rows.end] = starts[rows.end].wrapping_sub(1);
            }
        }
        let (mut open, mut sum) = (0u64, 0u64);
        for start in &mut starts {
            open = open.wrapping_add(*start);
            let here = sum;
            sum += open;
            *start = here;
        }
        Ok(starts)
    }

    /// From where to where triangle `t` covers the middle line of a row.
    fn stretch(&self, t: u32, row: usize) -> [f64; 2] {
        let height = row as f64 + 0.5;
        let corners = self.seen(t).map(|[across, up]| [across, (up - self.floor) / self.row_height]);
        let mut stretch = [f64::MAX, f64::MIN];
        for i in 0..3 {
            let [a, b] = [corners[i], corners[(i + 1) % 3]];
            if (a[1] <= height) != (b[1] <= height) || a[1] == height {
                let share = if a[1] == b[1] { 0.0 } else { (height - a[1]) / (b[1] - a[1]) };
                let across = a[0] + (b[0] - a[0]) * share.clamp(0.0, 1.0);
                stretch = [stretch[0].min(across), stretch[1].max(across)];
            }
        }
        if stretch[0] <= stretch[1] { stretch } else { [0.0, 0.0] }
    }
}
