//! How far apart rims lie that a repair joins by itself, and whether that may have joined the two sides of a thin wall.

use super::climb::{ATTEMPT_PART, Certified, Climb, Situation};
use crate::analysis::DefectCode;
use crate::budget::Stopped;
use crate::geom::{DVec3, print_pitch, triangle_area};
use crate::mesh::{Soup, UnionFind};
use crate::pipeline::fidelity::LOST_BEYOND;
use crate::pipeline::repair_choices::Walls;
use crate::pipeline::size::diagonal;
use crate::repair::{Draft, snap};

/// Steps of the print lattice by which rounding may take rims apart.
const ROUNDING_STEPS: f64 = 4.0;

/// Rims closer than this share of the thickness of a wall are a crack in it; what is farther apart may be its two sides.
const SHARE_OF_WALL: f64 = 0.25;

/// Shells with less than this share of the area of all do not count as walls.
const SHARE_OF_AREA: f64 = 0.01;

/// How far apart rims of the file lie that should be one, at most what counts as lost; 0 where none do, or where that was
/// chosen.
pub(super) fn gap_between_rims(climb: &Climb<'_>) -> Result<f64, Stopped> {
    let choices = climb.choices;
    if !choices.may_join_rims() || !climb.has_found(DefectCode::BoundaryLoop) || choices.walls == Walls::First
    {
        return Ok(0.0);
    }
    let soup = &climb.input.soup;
    let most = LOST_BEYOND * diagonal(soup);
    let gap = || snap::gap_between_rims(&Draft::from_soup(soup).0, most, climb.budget);
    let gap = climb.budget.within_part(ATTEMPT_PART, gap)?.flatten();
    // Coordinates that become float32 may come farther apart.
    let rounding = ROUNDING_STEPS * print_pitch(climb.reach()).unwrap_or(0.0);
    Ok(gap.map_or(0.0, |gap| (gap + rounding).min(most)))
}

/// True when rims that lie `gap` apart were joined, which is much for the thickness of a shell of the result.
pub(super) fn may_have_joined_across_walls(situation: &Situation, gap: f64) -> bool {
    let is_thin = |certified: &Certified| thinnest_shell(certified.candidate.soup()) < gap / SHARE_OF_WALL;
    gap > 0.0 && situation.certified.as_deref().is_some_and(is_thin)
}

/// True when something is certified that is not changed beyond the bounds.
pub(super) fn is_true(situation: &Situation, climb: &Climb<'_>) -> bool {
    let is_true = |certified: &Certified| {
        let verdict = certified.as_seen.verdict(&climb.input.soup, certified.candidate.soup());
        certified.fidelity.passes(&climb.options.limits) && !verdict.is_changed()
    };
    situation.certified.as_deref().is_some_and(is_true)
}

/// The least mean thickness of a shell that is no crumb: twice its volume by its area.
fn thinnest_shell(solid: &Soup) -> f64 {
    let mut parts = UnionFind::new(solid.positions.len());
    for &[a, b, c] in &solid.triangles {
        parts.unite(a, b);
        parts.unite(b, c);
    }
    let parts = parts.into_components();
    let origin = solid.positions.first().copied().unwrap_or(DVec3::ZERO);
    let mut shells = vec![(0.0, 0.0); parts.count as usize];
    for (t, corners) in solid.triangles.iter().enumerate() {
        let (volume, area) = &mut shells[parts.of[corners[0] as usize] as usize];
        let [a, b, c] = solid.corners(t as u32).map(|p| p - origin);
        *volume += a.cross(b).dot(c) / 6.0;
        *area += triangle_area([a, b, c]);
    }
    let all: f64 = shells.iter().map(|(_, area)| area).sum();
    let walls = shells.into_iter().filter(|(_, area)| *area > SHARE_OF_AREA * all);
    walls.map(|(volume, area): (f64, f64)| 2.0 * volume.abs() / area).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_thinnest_shell_is_the_plate_beside_a_block_and_crumbs() {
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let mut soup = Soup::default();
        for (x, size) in [(50.0, [9.0, 9.0, 9.0]), (70.0, [40.0, 40.0, 0.1]), (120.0, [0.01; 3])] {
            let base = soup.positions.len() as u32;
            let corner = |i: u32| DVec3::from([i & 1, i >> 1 & 1, i >> 2].map(f64::from));
            soup.positions.extend((0..8).map(|i| DVec3::from(size) * corner(i) + DVec3::X * x));
            let split = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
            soup.triangles.extend(split.map(|t: [u32; 3]| t.map(|v| v + base)));
        }
        let thickness = thinnest_shell(&soup);
        assert!((thickness - 0.1).abs() < 1e-3, "{thickness}");
        assert_eq!(thinnest_shell(&Soup::default()), f64::INFINITY);
    }
}
