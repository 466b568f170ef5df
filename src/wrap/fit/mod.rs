//! Moves the vertices of a wrap onto the input and its creases.
//!
//! A vertex whose cut was clamped goes to the point of the input that it stands for; one beside a crease to the point
//! that is nearest to the planes of the input around it (a quadratic error function, as in Kobbelt et al. 2001 and Ju et
//! al. 2002); one that grew from a thin wall back to that wall; one behind a sheet to the thickness of walls. A move must not
//! turn a triangle around, and what then meets anything goes back step by step, until nothing does.

mod normals;
mod undo;

use super::cut::{LatticeCut, NONE};
use super::lattice::Lattice;
use super::signs::{Inside, Signs, THIN};
use super::surface::{InputSurface, separate};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::par;
use crate::spatial::NearestSearch;
use normals::Stars;
use undo::Moves;

/// Normals around a vertex that differ by more than 30 degrees make it a vertex beside a crease.
const CREASE_COS: f64 = 0.866;

/// A vertex farther than this from a crease, in cells, leaves it to its neighbours. A crease that goes through a cell near a vertex of the
/// lattice has cuts on all sides that are up to 7/8 of a cell away, and cuts that were clamped are farther.
const CREASE_REACH: f64 = 1.2;

/// Times that vertices are moved toward their own goals.
const PASSES: usize = 10;

/// Times that vertices beside creases are moved toward them: some can only after their neighbours.
const CREASE_PASSES: usize = 4;

/// Weight that keeps the point near the middle of those around it where planes do not determine it.
const HOLD: f64 = 1e-3;

/// What a fit did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FitCounts {
    /// Vertices that moved.
    pub moved: u64,
    /// Of those, onto a crease or corner.
    pub onto_creases: u64,
    /// Vertices whose move was taken back, because the surface would have met itself.
    pub taken_back: u64,
}

/// Moves `positions` of the wrap with these cuts.
///
/// # Errors
/// When the budget stops the run.
pub(super) fn fit(
    lattice: &Lattice,
    signs: &Signs<'_>,
    surface: &InputSurface,
    cuts: &[LatticeCut],
    positions: &mut [DVec3],
    triangles: &[[u32; 3]],
    budget: &Budget,
) -> Result<FitCounts, Stopped> {
    let _charge = budget.charge(positions.len() as u64 * 240 + triangles.len() as u64 * 16)?;
    let stars = Stars::of(triangles, positions.len(), budget)?;
    let mut places: Vec<DVec3> = positions.iter().map(|&p| lattice.units_of(p)).collect();
    // Clamped cuts, and thin walls.
    let belongs = plain_goals(signs, surface, cuts, &places, budget)?;
    let (goals, planes): (Vec<_>, Vec<_>) = belongs.into_iter().map(|goal| (goal.place, goal.plane)).unzip();
    let mut moved = move_all(&stars, triangles, &mut places, &goals, budget)?;
    // Long ways, of walls that grew, are gone in steps, each with its neighbours.
    for _ in 1..PASSES {
        let again = move_all(&stars, triangles, &mut places, &goals, budget)?;
        moved.iter_mut().zip(&again).for_each(|(all, &one)| *all |= one);
    }
    let goals = crease_goals(&planes, &stars, triangles, &places, budget)?;
    let mut onto = move_all(&stars, triangles, &mut places, &goals, budget)?;
    for _ in 1..CREASE_PASSES {
        let again = move_all(&stars, triangles, &mut places, &goals, budget)?;
        onto.iter_mut().zip(&again).for_each(|(all, &one)| *all |= one);
    }
    moved.iter_mut().zip(&onto).for_each(|(all, &one)| *all |= one);
    let before = positions.to_vec();
    for (v, place) in places.iter().enumerate().filter(|&(v, _)| moved[v]) {
        positions[v] = lattice.nearest(*place);
    }
    let moves = Moves { before: &before, goals: positions, triangles, stars: &stars, lattice, budget };
    let settled = moves.without_contacts()?;
    let taken_back = settled.iter().zip(&*positions).filter(|(settled, goal)| settled != goal).count() as u64;
    let count = |flags: &[bool]| flags.iter().filter(|&&flag| flag).count() as u64;
    positions.copy_from_slice(&settled);
    Ok(FitCounts { moved: count(&moved), onto_creases: count(&onto), taken_back })
}

/// A point of the input and the unit normal there.
type Plane = (DVec3, DVec3);

/// Where a vertex belongs by itself.
#[derive(Debug, Clone, Copy)]
struct PlainGoal {
    /// Unless it is there.
    place: Option<DVec3>,
    /// What of the input it belongs to.
    plane: Option<Plane>,
}

/// Where each vertex belongs by itself.
fn plain_goals(
    signs: &Signs<'_>,
    surface: &InputSurface,
    cuts: &[LatticeCut],
    places: &[DVec3],
    budget: &Budget,
) -> Result<Vec<PlainGoal>, Stopped> {
    let (thin_names, sheet_names) = (separate(signs.thin.len()), separate(surface.sheets().len()));
    let thin = NearestSearch::build(signs.thin.as_flattened(), &thin_names, budget)?;
    let sheets = NearestSearch::build(surface.sheets().as_flattened(), &sheet_names, budget)?;
    let goals = par::try_map_ranges(places.len(), 1024, |range| {
        budget.spend(range.len() as u64)?;
        let goal = |v: usize| {
            let (cut, place) = (&cuts[v], places[v]);
            if cut.triangle != NONE {
                let is_clamped = cut.point.distance_squared(place) > 1e-6;
                let plane = Some((cut.point, surface.normal(cut.triangle)));
                return Ok(PlainGoal { place: is_clamped.then_some(cut.point), plane });
            }
            match cut.why {
                Inside::NearSheet => {
                    let place = behind_sheet(&sheets, signs.wall, place, budget)?;
                    Ok(PlainGoal { place, plane: None })
                }
                Inside::Wound | Inside::NearThin => {
                    let plane = onto_thin(&thin, place, cut.why, budget)?;
                    Ok(PlainGoal { place: plane.map(|(point, _)| point), plane })
                }
            }
        };
        range.map(goal).collect::<Result<Vec<_>, Stopped>>()
    })?;
    Ok(goals.concat())
}

/// The place at the thickness of a `wall` from the sheet.
fn behind_sheet(
    sheets: &NearestSearch<'_>,
    wall: f64,
    place: DVec3,
    budget: &Budget,
) -> Result<Option<DVec3>, Stopped> {
    let nearest = sheets.find(place, None, budget)?.filter(|nearest| nearest.distance > wall);
    Ok(nearest.map(|nearest| nearest.point.lerp(place, wall / nearest.distance)))
}

/// The place on a thin wall that a vertex before it grew from, and the normal there.
fn onto_thin(
    thin: &NearestSearch<'_>,
    place: DVec3,
    why: Inside,
    budget: &Budget,
) -> Result<Option<Plane>, Stopped> {
    let Some(nearest) = thin.find(place, None, budget)? else { return Ok(None) };
    let [a, b, c] = thin.corners(nearest.triangle);
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let is_before = why == Inside::NearThin || normal.dot(place - nearest.point) > 0.0;
    Ok((is_before && nearest.distance < THIN * 2.5).then_some((nearest.point, normal)))
}

/// Where vertices beside creases belong.
fn crease_goals(
    of_vertex: &[Option<Plane>],
    stars: &Stars,
    triangles: &[[u32; 3]],
    places: &[DVec3],
    budget: &Budget,
) -> Result<Vec<Option<DVec3>>, Stopped> {
    let goals = par::try_map_ranges(places.len(), 1024, |range| {
        budget.spend(range.len() as u64)?;
        let mut planes = Vec::new();
        Ok(range
            .map(|v| {
                planes.clear();
                let mut add = |v: usize| planes.extend(of_vertex[v]);
                add(v);
                for &t in stars.of_vertex(v) {
                    triangles[t as usize].iter().filter(|&&w| w as usize != v).for_each(|&w| add(w as usize));
                }
                let goal = crease_point(&planes)?;
                (goal.distance(places[v]) <= CREASE_REACH).then_some(goal)
            })
            .collect::<Vec<_>>())
    })?;
    Ok(goals.concat())
}

/// The point nearest to the planes (a point and a unit normal each), unless they are all about the same.
fn crease_point(planes: &[Plane]) -> Option<DVec3> {
    let least =
        planes.iter().flat_map(|(_, n)| planes.iter().map(move |(_, m)| n.dot(*m))).fold(1.0f64, f64::min);
    if least > CREASE_COS {
        return None;
    }
    let middle = planes.iter().map(|&(p, _)| p).sum::<DVec3>() / planes.len() as f64;
    let hold = HOLD * planes.len() as f64;
    let mut columns = [DVec3::X * hold, DVec3::Y * hold, DVec3::Z * hold];
    let mut right = DVec3::ZERO;
    for &(p, n) in planes {
        columns[0] += n * n.x;
        columns[1] += n * n.y;
        columns[2] += n * n.z;
        right += n * n.dot(p - middle);
    }
    // Cramer's rule; the hold keeps the determinant positive.
    let [x, y, z] = columns;
    let determinant = x.dot(y.cross(z));
    let shift = DVec3::new(right.dot(y.cross(z)), x.dot(right.cross(z)), x.dot(y.cross(right))) / determinant;
    shift.is_finite().then_some(middle + shift)
}

/// Moves each vertex to its goal, or half the way, where no triangle turns around; tells which moved.
fn move_all(
    stars: &Stars,
    triangles: &[[u32; 3]],
    places: &mut [DVec3],
    goals: &[Option<DVec3>],
    budget: &Budget,
) -> Result<Vec<bool>, Stopped> {
    let mut moved = vec![false; places.len()];
    for v in 0..places.len() {
        if v % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let Some(goal) = goals[v].filter(|&goal| goal != places[v]) else { continue };
        let from = places[v];
        for share in [1.0, 0.5, 0.25] {
            let to = from.lerp(goal, share);
            if stars.may_move(v, to, triangles, places) {
                places[v] = to;
                moved[v] = true;
                break;
            }
        }
    }
    Ok(moved)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_of_an_edge_and_of_a_corner_give_points_on_them() {
        let planes = [
            (DVec3::new(0.2, 0.0, 0.3), DVec3::NEG_Y),
            (DVec3::new(0.9, 0.5, 0.0), DVec3::X),
            (DVec3::new(0.4, 0.0, 0.6), DVec3::NEG_Y),
        ];
        let on_edge = crease_point(&planes).unwrap();
        assert!((on_edge.x - 0.9).abs() < 0.01 && on_edge.y.abs() < 0.01, "{on_edge}");
        let with_top = [planes[0], planes[1], planes[2], (DVec3::new(0.1, 0.3, 0.7), DVec3::Z)];
        let corner = crease_point(&with_top).unwrap();
        assert!(corner.distance(DVec3::new(0.9, 0.0, 0.7)) < 0.01, "{corner}");
        assert_eq!(crease_point(&planes[..1]), None);
    }
}
