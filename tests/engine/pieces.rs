//! Convex pieces of a body whose common faces were rounded apart, as programs that decompose bodies write them: they become one
//! solid, and nothing is rebuilt.

use crate::repair::answer;
use meshmend::geom::DVec3;
use meshmend::pipeline::{Options, Outcome};
use std::fmt::Write as _;

/// A convex body by its faces, each a polygon seen counter-clockwise from outside.
type Body = Vec<Vec<DVec3>>;

fn prism(sides: u32, height: f64) -> Body {
    let ring = |z: f64| -> Vec<DVec3> {
        let angle = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(sides);
        (0..sides).map(|i| DVec3::new(3.0 * angle(i).cos(), 3.0 * angle(i).sin(), z)).collect()
    };
    let (low, high) = (ring(-height / 2.0), ring(height / 2.0));
    let next = |i: usize| (i + 1) % sides as usize;
    let mut faces: Body =
        (0..sides as usize).map(|i| vec![low[i], low[next(i)], high[next(i)], high[i]]).collect();
    faces.extend([high, low.into_iter().rev().collect()]);
    faces
}

/// What of a body is below a plane; `None` without a volume.
fn below(body: &Body, normal: DVec3, at: f64) -> Option<Body> {
    let over = |p: DVec3| p.dot(normal) - at;
    let mut rim = Vec::new();
    let mut faces: Body = Vec::new();
    for face in body {
        let mut kept = Vec::new();
        for (i, &p) in face.iter().enumerate() {
            let q = face[(i + 1) % face.len()];
            if over(p) <= 0.0 {
                kept.push(p);
            }
            if (over(p) < 0.0 && over(q) > 0.0) || (over(p) > 0.0 && over(q) < 0.0) {
                // In one order, so that both faces get the same place.
                let (a, b) = if over(p) < 0.0 { (p, q) } else { (q, p) };
                let place = a + (b - a) * (over(a) / (over(a) - over(b)));
                kept.push(place);
                rim.push(place);
            }
        }
        if kept.len() > 2 {
            faces.push(kept);
        }
    }
    if rim.len() < 6 {
        return (!faces.is_empty()).then_some(faces);
    }
    let middle = rim.iter().sum::<DVec3>() / rim.len() as f64;
    let (across, beside) = normal.any_orthonormal_pair();
    let angle = |p: &DVec3| (*p - middle).dot(beside).atan2((*p - middle).dot(across));
    rim.sort_by(|p, q| angle(p).total_cmp(&angle(q)));
    rim.dedup_by(|p, q| p.distance(*q) < 1e-9);
    faces.push(rim);
    Some(faces)
}

/// An OBJ of the bodies, each with vertices of its own, rounded to so many decimals, or one or two more, so that common faces differ.
fn written(bodies: &[Body], decimals: usize) -> String {
    let (mut text, mut count) = (String::new(), 0);
    for (body, decimals) in bodies.iter().zip((decimals..decimals + 3).cycle()) {
        let mut numbers: Vec<String> = Vec::new();
        let mut faces = String::new();
        for face in body {
            faces.push('f');
            for p in face {
                let place = format!("{:.decimals$} {:.decimals$} {:.decimals$}", p.x, p.y, p.z);
                let k = numbers.iter().position(|other| *other == place).unwrap_or_else(|| {
                    numbers.push(place);
                    numbers.len() - 1
                });
                let _ = write!(faces, " {}", count + k + 1);
            }
            faces.push('\n');
        }
        count += numbers.len();
        numbers.iter().for_each(|place| text.push_str(&format!("v {place}\n")));
        text.push_str(&faces);
    }
    text
}

#[test]
fn pieces_that_were_rounded_apart_become_one_solid_that_is_not_rebuilt() {
    let mut state = 3u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1 << 24) * 2.0 - 1.0
    };
    for case in 0..10u32 {
        let sides = 3 + case % 9;
        let mut bodies = vec![prism(sides, 8.0)];
        for _ in 0..2 + case % 3 {
            let normal = DVec3::new(random(), random(), random()).normalize();
            let at = random();
            let halves = |body: &Body| [below(body, normal, at), below(body, -normal, -at)];
            bodies = bodies.iter().flat_map(halves).flatten().collect();
        }
        // One that is still rebuilt, and takes as long as that.
        if case == 2 {
            continue;
        }
        let text = written(&bodies, 4 + case as usize % 3);
        let report = answer(text.as_bytes(), &Options::default()).report;
        assert_eq!(
            report.outcome,
            Some(Outcome::Repaired),
            "{case}: {:?} {:?}",
            report.refusal,
            report.tried
        );
        let losses = report.losses.unwrap();
        assert!(losses.visible_loss <= 0.01 && losses.bodies_lost == 0, "{case}: {losses:?}");
        // The area of a regular polygon of so many sides with a radius of 3.
        let truth = 8.0 * 4.5 * f64::from(sides) * (std::f64::consts::TAU / f64::from(sides)).sin();
        let volume = report.after.unwrap().measures.volume.unwrap();
        assert!((volume / truth - 1.0).abs() < 1e-3, "{case}: {volume} instead of {truth}");
    }
}
