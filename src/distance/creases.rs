//! How much of the creases of a surface another surface has too.
//!
//! A crease is an edge between two triangles that are folded against each other. Samples at even steps along all of them are
//! looked for in the other surface: there must be an edge nearby that is folded, too, and goes about the same way.

use super::Surface;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::mesh::{EdgeGroups, edge_of, triangle_of};
use crate::spatial::{Bvh, Coincident, coincident_f64};

/// Cosine of the least angle between the normals at a crease: 30 degrees.
const FOLDED: f64 = 0.866_025_403_784_438_6;

/// The same at an edge that stands for one, and of the greatest angle between the two: 20 degrees.
const ABOUT: f64 = 0.939_692_620_785_908_4;

/// Samples along all creases together.
const SAMPLES: usize = 1 << 13;

/// The share of the length of the creases of `from`, where `counts` is true, that edges of `to` recover: folded by more than 20 degrees,
/// within `reach`, and at an angle of less than 20 degrees. `None`: nothing counts.
///
/// # Errors
/// When the budget stops the run.
pub fn creases_recovered(
    from: Surface<'_>,
    to: Surface<'_>,
    reach: f64,
    counts: &mut dyn FnMut(DVec3, u32) -> Result<bool, Stopped>,
    budget: &Budget,
) -> Result<Option<f64>, Stopped> {
    let wanted = creases(from, FOLDED, budget)?;
    let length: f64 = wanted.iter().map(Crease::length).sum();
    let step = length / SAMPLES as f64;
    if step == 0.0 || !step.is_finite() {
        return Ok(None);
    }
    let found = creases(to, ABOUT, budget)?;
    let corners: Vec<DVec3> = found.iter().flat_map(|crease| [crease.ends[0], crease.ends[1]]).collect();
    let names: Vec<[u32; 3]> = (0..found.len() as u32).map(|n| [2 * n, 2 * n + 1, 2 * n + 1]).collect();
    let bvh = Bvh::build(&corners, &names, None, budget)?;
    let (mut seen, mut recovered, mut passed) = (0u32, 0u32, 0.0);
    for crease in &wanted {
        let end = passed + crease.length();
        // Samples are in the middle of steps, counted over all creases.
        let range = (passed / step + 0.5).floor() as usize..(end / step + 0.5).floor() as usize;
        for n in range {
            budget.spend(1)?;
            let share = ((n as f64 + 0.5) * step - passed) / crease.length();
            let place = crease.ends[0].lerp(crease.ends[1], share.clamp(0.0, 1.0));
            if !counts(place, crease.triangle)? {
                continue;
            }
            seen += 1;
            let around = Aabb { min: place - reach, max: place + reach };
            let along = crease.direction();
            recovered += u32::from(bvh.any_in_box(around, budget, |other| {
                let other = &found[other as usize];
                other.direction().dot(along).abs() >= ABOUT && other.distance(place) <= reach
            })?);
        }
        passed = end;
    }
    Ok((seen > 0).then(|| f64::from(recovered) / f64::from(seen)))
}

/// An edge between two triangles that are folded against each other.
#[derive(Debug, Clone, Copy)]
struct Crease {
    ends: [DVec3; 2],
    /// One of the triangles.
    triangle: u32,
}

impl Crease {
    fn length(&self) -> f64 {
        self.ends[0].distance(self.ends[1])
    }

    fn direction(&self) -> DVec3 {
        (self.ends[1] - self.ends[0]).normalize_or_zero()
    }

    fn distance(&self, place: DVec3) -> f64 {
        let [a, b] = self.ends;
        let along = b - a;
        let share = ((place - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        place.distance(a + along * share)
    }
}

/// The creases of a surface whose normals have a cosine of less than `fold_cos`. Vertices at one place are one; whether
/// both triangles at an edge run through it in opposite directions does not matter.
fn creases(surface: Surface<'_>, fold_cos: f64, budget: &Budget) -> Result<Vec<Crease>, Stopped> {
    let Coincident { group, first } = coincident_f64(surface.positions, budget)?;
    let place = |v: u32| surface.positions[v as usize];
    let mut triangles = Vec::with_capacity(surface.triangles.len());
    for block in surface.triangles.chunks(CHECK_EVERY) {
        budget.check()?;
        triangles.extend(block.iter().map(|t| t.map(|v| group[v as usize])));
    }
    let normal = |t: u32| {
        let [a, b, c] = surface.triangles[t as usize].map(place);
        (b - a).cross(c - a).normalize_or_zero()
    };
    let edges = EdgeGroups::build(&triangles, first.len(), budget)?;
    let mut creases = Vec::new();
    for (e, edge) in edges.iter().enumerate() {
        if e % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let &[g, h] = edge else { continue };
        let [from, to] = edge_of(&triangles, g);
        let turn = if edge_of(&triangles, h) == [from, to] { -1.0 } else { 1.0 };
        let [one, other] = [g, h].map(|h| normal(triangle_of(h)));
        let is_flat = one == DVec3::ZERO || other == DVec3::ZERO;
        if from != to && !is_flat && one.dot(other) * turn < fold_cos {
            let ends = [from, to].map(|v| place(first[v as usize]));
            creases.push(Crease { ends, triangle: triangle_of(g) });
        }
    }
    Ok(creases)
}
