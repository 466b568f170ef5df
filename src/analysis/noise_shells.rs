//! Noise shells: parts that are tiny beside the largest one, as scanners and careless cuts leave them.

use super::around::part_boxes;
use super::sum::CompensatedSum;
use super::{Context, DefectCode, Finding};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, triangle_area};
use crate::par;

/// A noise shell has less than this share of the largest diagonal of a part.
const DIAGONAL_SHARE: f64 = 0.01;

/// And less than this share of the largest area of a part: what is left of an area at that share of a length.
const AREA_SHARE: f64 = DIAGONAL_SHARE * DIAGONAL_SHARE;

pub(super) fn find(cx: &Context<'_>) -> Result<Vec<Finding>, Stopped> {
    let mesh = &cx.mesh;
    if mesh.parts.len() < 2 {
        return Ok(Vec::new());
    }
    let diagonals: Vec<f64> =
        part_boxes(mesh, &cx.members, cx.budget)?.into_iter().map(Aabb::diagonal).collect();
    let areas = part_areas(cx, cx.budget)?;
    let largest = |of: &[f64]| of.iter().copied().fold(0.0, f64::max);
    let (diagonal, area) = (largest(&diagonals), largest(&areas));
    let is_noise = |p: &u32| {
        let p = *p as usize;
        diagonals[p] < DIAGONAL_SHARE * diagonal && areas[p] < AREA_SHARE * area
    };
    let noise: Vec<u32> = (0..mesh.parts.len() as u32).filter(is_noise).collect();
    Ok(Finding::of(DefectCode::NoiseShell, &noise, cx.samples, |&p| {
        let volume = cx.shells.binary_search_by_key(&p, |shell| shell.part).map(|i| cx.shells[i].volume);
        let mut witness = cx.part_witness(p);
        witness.figures.extend([
            ("diagonal", diagonals[p as usize]),
            ("area", areas[p as usize]),
            ("volume", volume.unwrap_or(f64::NAN)),
        ]);
        witness
    }))
}

/// The area of each part.
fn part_areas(cx: &Context<'_>, budget: &Budget) -> Result<Vec<f64>, Stopped> {
    par::try_map_ranges(cx.mesh.parts.len(), 1, |range| {
        let mut area = CompensatedSum::default();
        for block in cx.members.part(range.start as u32).chunks(CHECK_EVERY) {
            budget.check()?;
            block.iter().for_each(|&t| area.add(triangle_area(cx.mesh.corners(t))));
        }
        Ok(area.value())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::tests::{found, joined, tetrahedron};
    use crate::geom::DVec3;

    #[test]
    fn a_part_is_noise_when_it_is_small_beside_the_largest_in_length_and_in_area() {
        let beside =
            |size: f64| joined(&[tetrahedron(DVec3::splat(500.0), size), tetrahedron(DVec3::ZERO, 100.0)]);
        let finding = found(&beside(0.99), DefectCode::NoiseShell).unwrap();
        assert_eq!((finding.count, finding.witnesses[0].faces[0].index), (1, 0));
        assert_eq!(found(&beside(1.01), DefectCode::NoiseShell), None);
    }

    #[test]
    fn a_pile_of_equal_small_parts_is_no_noise() {
        let pile: Vec<_> = (0..300).map(|i| tetrahedron(DVec3::X * f64::from(2 * i), 1.0)).collect();
        assert_eq!(found(&joined(&pile), DefectCode::NoiseShell), None);
    }
}
