//! Where two triangles that are not in one plane meet: a segment or a point, by its ends' names.
//!
//! Each triangle cuts the line of both planes in an interval whose ends are corners on the other plane or points of edges that
//! pass through it. What is common to both intervals is where the triangles meet.

use super::error::ArrangementError;
use super::kernel::ClusterKernel;
use super::point::{ArrangementPoint, Definition};
use crate::geom::{AxisProjection, Sign, ThreePointPlane};
use std::cmp::Ordering;

/// How two triangles of a cluster meet.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum TriangleMeeting {
    /// Nowhere.
    Nowhere,
    /// In a point or a segment.
    Ends([Definition; 2]),
    /// In one plane, at these vertices of one that are on the other.
    InPlane(Vec<u32>),
}

/// How triangles `s` and `t`, which do not overlap in one plane, meet. `plane_of` names the plane of a triangle.
pub(super) fn meeting(
    kernel: &ClusterKernel,
    [s, t]: [u32; 2],
    plane_of: impl Fn(u32) -> u32,
) -> Result<TriangleMeeting, ArrangementError> {
    let sides = |of: u32, to: u32| {
        let plane = ThreePointPlane::through(kernel.corners(to));
        kernel.corners(of).map(|p| plane.side(p))
    };
    let sides_s = sides(s, t);
    if sides_s == [Sign::Zero; 3] {
        return Ok(TriangleMeeting::InPlane([touching(kernel, s, t), touching(kernel, t, s)].concat()));
    }
    let ends_s = interval(kernel, s, sides_s, plane_of(t));
    let ends_t = interval(kernel, t, sides(t, s), plane_of(s));
    let (Some(ends_s), Some(ends_t)) = (ends_s, ends_t) else { return Ok(TriangleMeeting::Nowhere) };
    let axes = axes_by_extent(kernel, s, t);
    let compare = |a: &ArrangementPoint, b: &ArrangementPoint| {
        axes.iter().fold(Ordering::Equal, |order, &axis| order.then_with(|| kernel.compare(axis, a, b)))
    };
    let [a, b] = [ends_s, ends_t].map(|ends| {
        let mut ends = ends.map(|definition| kernel.point(definition));
        if compare(&ends[0], &ends[1]) == Ordering::Greater {
            ends.swap(0, 1);
        }
        ends
    });
    // Of equal ends the one with the lower name: a vertex, if one is there.
    let inner = |p, q, outer: Ordering| match compare(p, q) {
        Ordering::Equal => {
            if p.definition <= q.definition {
                p
            } else {
                q
            }
        }
        order => {
            if order == outer {
                q
            } else {
                p
            }
        }
    };
    let low = inner(&a[0], &b[0], Ordering::Less);
    let high = inner(&a[1], &b[1], Ordering::Greater);
    Ok(match compare(low, high) {
        Ordering::Less => TriangleMeeting::Ends([low.definition, high.definition]),
        Ordering::Equal => TriangleMeeting::Ends([low.definition.min(high.definition); 2]),
        Ordering::Greater => TriangleMeeting::Nowhere,
    })
}

/// The interval of the line of both planes that triangle `t` holds, if it meets the other `plane`; its corners are on these
/// sides of that, not all on it.
fn interval(kernel: &ClusterKernel, t: u32, sides: [Sign; 3], plane: u32) -> Option<[Definition; 2]> {
    let corners = kernel.triangles[t as usize];
    let mut ends = Vec::with_capacity(2);
    for k in 0..3 {
        let next = (k + 1) % 3;
        if sides[k].is_zero() {
            ends.push(Definition::Vertex(corners[k]));
        } else if sides[k] * sides[next] == Sign::Negative {
            let [a, b] = [corners[k], corners[next]];
            ends.push(Definition::EdgePlane { edge: [a.min(b), a.max(b)], plane });
        }
    }
    Some([*ends.first()?, *ends.last()?])
}

/// The vertices of triangle `s` on triangle `t` of the same plane, other than its corners.
fn touching(kernel: &ClusterKernel, s: u32, t: u32) -> Vec<u32> {
    let [a, b, c] = kernel.corners(t);
    let Some((view, turn)) = AxisProjection::showing([a, b, c]) else { return Vec::new() };
    let is_on = |v: &u32| {
        let p = kernel.positions[*v as usize];
        [[a, b], [b, c], [c, a]].into_iter().all(|[from, to]| view.turn(from, to, p) != -turn)
    };
    let own = kernel.triangles[t as usize];
    kernel.triangles[s as usize].into_iter().filter(|v| !own.contains(v)).filter(is_on).collect()
}

/// The coordinate axes, the one along which the line of two planes is longest first, as far as f64 can tell.
fn axes_by_extent(kernel: &ClusterKernel, s: u32, t: u32) -> [usize; 3] {
    let [n, m] = [s, t].map(|t| {
        let [a, b, c] = kernel.corners(t);
        (b - a).cross(c - a).normalize_or_zero()
    });
    let along = n.cross(m).abs();
    let mut axes = [0, 1, 2];
    axes.sort_by(|&i, &j| along[j].total_cmp(&along[i]));
    axes
}
