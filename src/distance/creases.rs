//! How much of the creases of a surface another surface has too.
//!
//! A crease is an edge between two triangles that are folded against each other. Samples at even steps along all of them are
//! looked for in the other surface: there must be an edge nearby that is folded, too, and goes about the same way.

use super::Surface;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::mesh::{EdgeGroups, edge_of, prev_corner, triangle_of};
use crate::spatial::{Bvh, Coincident, coincident_f64};

/// Cosine of the least angle between the normals at a crease: 30 degrees.
const FOLDED: f64 = 0.866_025_403_784_438_6;

/// The same at an edge that stands for one, and of the greatest angle between the two: 20 degrees.
const ABOUT: f64 = 0.939_692_620_785_908_4;

/// How far beside a crease its triangles are looked at, as a share of the distance within which it is recovered.
const BESIDE: f64 = 0.125;

/// Samples along all creases together.
const SAMPLES: usize = 1 << 13;

/// The share of the length of the creases of `from`, where `counts` is true of a place beside it on either side, with the triangle that it is on, that edges of `to` recover: folded by more than 20 degrees,
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
            if !counts(crease.beside(0, place, reach), crease.triangles[0])?
                || !counts(crease.beside(1, place, reach), crease.triangles[1])?
            {
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
    triangles: [u32; 2],
    /// The corners of the triangles that are not on it.
    apexes: [DVec3; 2],
}

impl Crease {
    fn length(&self) -> f64 {
        self.ends[0].distance(self.ends[1])
    }

    /// A place at most `BESIDE` times `reach` from one on the crease, on the first or second triangle.
    fn beside(&self, side: usize, place: DVec3, reach: f64) -> DVec3 {
        let way = self.apexes[side] - place;
        let length = way.length();
        if length == 0.0 { place } else { place + way * (reach * BESIDE / length).min(0.5) }
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
            let apexes = [g, h]
                .map(|h| place(surface.triangles[triangle_of(h) as usize][prev_corner(h) as usize % 3]));
            creases.push(Crease { ends, triangles: [g, h].map(triangle_of), apexes });
        }
    }
    Ok(creases)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The faces of a cube with sides of 2 around the origin, outward, whose corners are moved.
    fn cube(moved: impl Fn(DVec3) -> DVec3) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let corner =
            |n: usize| moved(DVec3::from_array([0, 1, 2].map(|a| if n >> a & 1 == 1 { 1.0 } else { -1.0 })));
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
        ((0..8).map(corner).collect(), triangles.collect())
    }

    fn share(
        from: &(Vec<DVec3>, Vec<[u32; 3]>),
        to: &(Vec<DVec3>, Vec<[u32; 3]>),
        reach: f64,
    ) -> Option<f64> {
        let [from, to] = [from, to].map(|(positions, triangles)| Surface { positions, triangles });
        creases_recovered(from, to, reach, &mut |_, _| Ok(true), &Budget::unlimited()).unwrap()
    }

    #[test]
    fn the_creases_of_a_cube_are_found_where_they_are_and_nowhere_else() {
        let whole = cube(|p| p);
        assert_eq!(share(&whole, &whole, 1e-9), Some(1.0));
        assert_eq!(share(&whole, &cube(|p| p * 1.01), 0.02), Some(1.0));
        assert_eq!(share(&whole, &cube(|p| p * 1.01), 0.005), Some(0.0));
        // Of the four edges at the top that are higher, and the others, which go on to there.
        let taller = cube(|p| if p.z > 0.0 { p + DVec3::Z } else { p });
        let found = share(&whole, &taller, 0.05).unwrap();
        assert!((found - 8.0 / 12.0).abs() < 0.02, "{found}");
        // All turned by 30 degrees, so that only those along the axis of the turn go the same way, and are elsewhere.
        let turned = cube(|p| DVec3::new(p.x * FOLDED - p.y * 0.5, p.x * 0.5 + p.y * FOLDED, p.z));
        assert_eq!(share(&whole, &turned, 0.1), Some(0.0));
        // One face of two triangles has no crease.
        assert_eq!(share(&(whole.0.clone(), whole.1[..2].to_vec()), &whole, 1.0), None);
        // Nor does it matter which way triangles run.
        let mixed = (
            whole.0.clone(),
            whole
                .1
                .iter()
                .enumerate()
                .map(|(n, &[a, b, c])| if n % 3 == 0 { [a, c, b] } else { [a, b, c] })
                .collect(),
        );
        assert_eq!(share(&mixed, &whole, 1e-9), Some(1.0));
    }

    #[test]
    fn what_does_not_count_is_left_out() {
        let whole = cube(|p| p);
        let half = (whole.0.clone(), whole.1[..8].to_vec());
        let [from, to] = [&whole, &half].map(|(positions, triangles)| Surface { positions, triangles });
        let only = |is_counted: &dyn Fn(DVec3) -> bool| {
            creases_recovered(from, to, 1e-9, &mut |place, _| Ok(is_counted(place)), &Budget::unlimited())
                .unwrap()
        };
        // Without the faces toward -x and +x, the four edges along x stay.
        let along_x = |p: DVec3| p.x.abs() < 0.99;
        assert_eq!(only(&along_x), Some(1.0));
        assert_eq!(only(&|p| !along_x(p) && p.x.abs() <= 1.0 && p.y.abs() < 0.99), Some(0.0));
        assert_eq!(only(&|_| false), None);
    }
}
