//! The smallest rectangle around points of a plane.
//!
//! It has a side along an edge of the convex hull (Freeman and Shapira 1975); rotating calipers (Toussaint 1983) look at
//! all of them in linear time.

use crate::geom::DVec2;

/// The direction of a side of the rectangle of least area around `points`, of length 1, and that area.
pub(super) fn least_rectangle(points: &mut Vec<DVec2>) -> (DVec2, f64) {
    hull_of(points);
    let count = points.len();
    let at = |i: usize| points[i % count];
    let mut best = (DVec2::X, f64::INFINITY);
    // The points farthest along an edge, off it, and against it.
    let (mut ahead, mut off, mut behind) = (1, 1, 1);
    for i in 0..count {
        let Some(along) = (at(i + 1) - at(i)).try_normalize() else { continue };
        let side = along.perp();
        let advance = |from: usize, direction: DVec2| {
            let mut place = from;
            while place < 3 * count && direction.dot(at(place + 1)) > direction.dot(at(place)) {
                place += 1;
            }
            place
        };
        ahead = advance(ahead.max(i + 1), along);
        off = advance(off.max(ahead), side);
        behind = advance(behind.max(off), -along);
        let width = along.dot(at(ahead)) - along.dot(at(behind));
        let area = width * (side.dot(at(off)) - side.dot(at(i)));
        if area < best.1 {
            best = (along, area);
        }
    }
    best
}

/// Leaves the corners of the convex hull, counter-clockwise (monotone chain, Andrew 1979). Rounded: a corner that is off
/// by rounding may be left out.
fn hull_of(points: &mut Vec<DVec2>) {
    points.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    if points.len() < 3 {
        return;
    }
    let sorted = std::mem::take(points);
    let mut chain = |ordered: &mut dyn Iterator<Item = DVec2>| {
        let start = points.len();
        for p in ordered {
            while points.len() >= start + 2 {
                let [a, b] = [points[points.len() - 2], points[points.len() - 1]];
                if (b - a).perp_dot(p - b) > 0.0 {
                    break;
                }
                points.pop();
            }
            points.push(p);
        }
        // The last point begins the other chain.
        points.pop();
    };
    chain(&mut sorted.iter().copied());
    chain(&mut sorted.iter().rev().copied());
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(points: &[(f64, f64)]) -> f64 {
        let mut points: Vec<DVec2> = points.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
        least_rectangle(&mut points).1
    }

    #[test]
    fn a_turned_rectangle_is_found_and_a_line_has_no_area() {
        let (s, c) = (0.6, 0.8);
        let turned = [(0.0, 0.0), (3.0, 0.0), (3.0, 2.0), (0.0, 2.0), (1.0, 1.0)]
            .map(|(x, y)| (c * x - s * y + 7.0, s * x + c * y - 5.0));
        assert!((area(&turned) - 6.0).abs() < 1e-12);
        assert!(area(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)]).abs() < 1e-12);
        assert_eq!(area(&[(1.0, 1.0)]), f64::INFINITY, "a point has no side");
    }

    #[test]
    fn no_edge_of_random_hulls_gives_a_smaller_rectangle() {
        let mut state = 3u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 24)
        };
        for round in 0..300 {
            let mut points: Vec<DVec2> =
                (0..4 + round % 40).map(|_| DVec2::new(random(), random())).collect();
            let all = points.clone();
            let (_, found) = least_rectangle(&mut points);
            let extent = |d: DVec2| {
                let along = all.iter().map(|p| p.dot(d));
                along.clone().fold(f64::MIN, f64::max) - along.fold(f64::MAX, f64::min)
            };
            let edges = (0..points.len()).map(|i| points[(i + 1) % points.len()] - points[i]);
            let least =
                edges.map(|e| extent(e.normalize()) * extent(e.normalize().perp())).fold(f64::MAX, f64::min);
            assert!((found - least).abs() < 1e-12, "{round}: {found} {least}");
        }
    }
}
