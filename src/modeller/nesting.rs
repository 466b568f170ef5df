//! Which shells lie inside which: one outward, all others cavities directly inside it.

use super::exact::{cross, det, dot, sign};
use super::point::{Point, PointLocation};
use super::rule::{BrokenRule, Rule};
use super::solid::Solid;
use crate::budget::{Budget, Stopped};
use crate::mesh::polyhedron::FaceId;
use num_bigint::BigInt;
use num_traits::Zero;
use std::cmp::Ordering;

/// Directions of rays; one along which no ray from a point touches an edge is soon found.
const DIRECTIONS: [[i64; 3]; 8] = [
    [2, 3, 1009],
    [4001, 5, 7],
    [11, 3001, 13],
    [-17, 19, 2003],
    [-1013, 23, 29],
    [31, -1511, 37],
    [101, 103, 107],
    [-1009, 1013, 1019],
];

/// The fault of the rule of one volume, if it is broken.
pub(super) fn check(solid: &Solid, budget: &Budget) -> Result<Option<BrokenRule>, Stopped> {
    let (shell_of, count) = solid.topology.shell_of_faces();
    let mut faces = vec![Vec::new(); count];
    for f in solid.topology.faces() {
        faces[shell_of[f.index()] as usize].push(f);
    }
    let mut outer = Vec::new();
    for (shell, faces) in faces.iter().enumerate() {
        if is_outward(solid, faces) {
            outer.push(shell);
        }
    }
    let fault = |shell: usize| {
        Some(BrokenRule { rule: Rule::OneVolume, faces: vec![faces[shell][0]], vertices: vec![] })
    };
    let &[outer] = outer.as_slice() else {
        return Ok(fault(outer.get(1).copied().unwrap_or(0)));
    };
    for inner in (0..count).filter(|&s| s != outer) {
        let start = solid.point(solid.topology.origin(solid.topology.loops(faces[inner][0]).exterior));
        for (shell, members) in faces.iter().enumerate().filter(|(s, _)| *s != inner) {
            budget.spend(members.len() as u64)?;
            if is_inside(solid, start, members) != Some(shell == outer) {
                return Ok(fault(inner));
            }
        }
    }
    Ok(None)
}

/// True when the material of a closed shell is on its inside: the enclosed volume is positive.
fn is_outward(solid: &Solid, faces: &[FaceId]) -> bool {
    let (mut sum, mut magnitude) = (0.0f64, 0.0f64);
    let Some(&first) = faces.first() else { return false };
    let base = solid.point(solid.topology.origin(solid.topology.loops(first).exterior)).near;
    for &f in faces {
        for start in solid.topology.loop_starts(f) {
            let corners: Vec<_> =
                solid.topology.loop_of(start).map(|h| solid.ends(h)[0].near - base).collect();
            for pair in corners.windows(2).skip(1) {
                let part = corners[0].dot(pair[0].cross(pair[1]));
                sum += part;
                magnitude += corners[0].length() * pair[0].length() * pair[1].length();
            }
        }
    }
    // Far more than all roundings of the products and the sum together.
    if sum.abs() > magnitude * 1e-10 {
        return sum > 0.0;
    }
    exact_volume_sign(solid, faces) == Ordering::Greater
}

fn exact_volume_sign(solid: &Solid, faces: &[FaceId]) -> Ordering {
    let mut sum = super::exact::Rational::from_integer(BigInt::ZERO);
    for &f in faces {
        for start in solid.topology.loop_starts(f) {
            let corners: Vec<&Point> = solid.topology.loop_of(start).map(|h| solid.ends(h)[0]).collect();
            for pair in corners.windows(2).skip(1) {
                let w = &corners[0].w * &pair[0].w * &pair[1].w;
                sum += super::exact::Rational::new(det(&corners[0].x, &pair[0].x, &pair[1].x), w);
            }
        }
    }
    sign(sum.numer())
}

/// Whether `p` is enclosed by a closed shell that it is not on; `None` when every ray touches an edge.
fn is_inside(solid: &Solid, p: &Point, faces: &[FaceId]) -> Option<bool> {
    DIRECTIONS.into_iter().find_map(|direction| parity(solid, p, &direction.map(BigInt::from), faces))
}

fn parity(solid: &Solid, p: &Point, direction: &[BigInt; 3], faces: &[FaceId]) -> Option<bool> {
    let mut is_odd = false;
    for &f in faces {
        let (normal, offset) = solid.plane(f).row();
        let speed = dot(&normal, direction);
        // The ray reaches the plane after `height / (speed w)` directions.
        let height = &offset * &p.w - dot(&normal, &p.x);
        if speed.is_zero() {
            if height.is_zero() && !is_clear(solid, f, p, direction) {
                return None;
            }
            continue;
        }
        if sign(&height) != sign(&speed) {
            continue;
        }
        let (height, speed) = if speed < BigInt::ZERO { (-height, -speed) } else { (height, speed) };
        let x = std::array::from_fn(|k| &p.x[k] * &speed + &direction[k] * &height);
        match solid.locate(f, &Point::new(x, &p.w * &speed)) {
            PointLocation::Border => return None,
            PointLocation::Inside => is_odd = !is_odd,
            PointLocation::Outside => {}
        }
    }
    Some(is_odd)
}

/// True when all corners of `f`, whose plane holds the ray, are strictly on one side of the ray's line.
fn is_clear(solid: &Solid, f: FaceId, p: &Point, direction: &[BigInt; 3]) -> bool {
    let across = cross(direction, &solid.plane(f).normal);
    let mut sides = solid.sides(f).map(|[a, _]| sign(&dot(&across, &p.to(a))));
    let first = sides.next();
    first != Some(Ordering::Equal) && sides.all(|s| Some(s) == first)
}
