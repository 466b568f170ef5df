//! Finds the edges along which vertices must stay: borders, creases, seams and borders between face groups.

use super::marks::LINE;
use super::options::{Borders, SimplifyOptions};
use super::surface::CollapseSurface;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::mesh::corner_table::{NONE, triangle_of};

/// Marks the lines of `surface`. `groups` has a number for each triangle, or is empty.
pub(super) fn mark_lines<S: Copy + Default>(
    surface: &mut CollapseSurface<S>,
    groups: &[u32],
    options: &SimplifyOptions<'_>,
    budget: &Budget,
) -> Result<(), Stopped> {
    for t in 0..surface.table.triangle_bound() as u32 {
        if (t as usize).is_multiple_of(CHECK_EVERY) {
            budget.check()?;
        }
        for h in [4 * t, 4 * t + 1, 4 * t + 2] {
            let twin = surface.table.twin(h);
            if h > twin || !is_line(surface, h, twin, groups, options.crease_cos_max) {
                continue;
            }
            surface.table.mark(h, LINE);
            let is_held = twin == NONE && options.borders == Borders::Keep;
            for v in [surface.table.origin(h), surface.table.destination(h)] {
                let vertex = &mut surface.vertices[v as usize];
                vertex.lines += 1;
                vertex.is_held |= is_held;
            }
        }
    }
    Ok(())
}

fn is_line<S: Copy + Default>(
    surface: &CollapseSurface<S>,
    h: u32,
    twin: u32,
    groups: &[u32],
    crease_cos_max: f64,
) -> bool {
    if twin == NONE {
        return true;
    }
    if surface.wedges.is_seam(h, twin) {
        return true;
    }
    let group = |h: u32| groups.get(triangle_of(h) as usize);
    if group(h) != group(twin) {
        return true;
    }
    if crease_cos_max < -1.0 {
        return false;
    }
    let [n, m] = [h, twin].map(|g| {
        let [p, q, r] = surface.corners(g);
        (q - p).cross(r - p)
    });
    n.dot(m) <= crease_cos_max * (n.length() * m.length())
}
