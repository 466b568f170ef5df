//! What the triangles of a draft enclose becomes solid, whichever way they turn.

use super::bare::become_solid_and_copy_bare;
use super::{arrangement_options, become_solid, left_alone};
use crate::arrangement::{Arrangement, ArrangementError, SolidBoundary, arrange_enclosed};
use crate::budget::{Budget, Stopped};
use crate::geom::triangle_area;
use crate::mesh::EdgeGroups;
use crate::repair::{Changes, Draft};

/// A part of which this share of the boundary turns inward points inward.
const INWARD_SHARE: f64 = 0.9;

/// Makes solid what cannot be reached from outside without passing through a triangle, each connected part for itself. What encloses
/// nothing is gone. Parts inside others stay, and those that point inward stay so: they are cavities. A draft of which too many
/// triangles meet is left as it is.
///
/// # Errors
/// When the budget stops the run.
pub fn enclose(draft: &mut Draft, budget: &Budget) -> Result<Changes, Stopped> {
    enclose_by(draft, become_solid, budget)
}

/// As [`enclose`]; then adds a copy of every triangle of which a piece encloses nothing, as open parts of their own that walls can
/// be put behind.
///
/// # Errors
/// When the budget stops the run.
pub fn enclose_and_copy_bare(draft: &mut Draft, budget: &Budget) -> Result<Changes, Stopped> {
    enclose_by(draft, become_solid_and_copy_bare, budget)
}

fn enclose_by(
    draft: &mut Draft,
    become_solid: impl Fn(&mut Draft, &Arrangement, SolidBoundary, &Budget) -> Result<Changes, ArrangementError>,
    budget: &Budget,
) -> Result<Changes, Stopped> {
    let options = arrangement_options(draft, 1);
    let arranged = arrange_enclosed(&draft.positions, &draft.triangles, &options, budget);
    let enclosed = arranged.and_then(|arrangement| {
        let mut boundary = arrangement.boundary(|winding| winding[0] > 0);
        turn_inward(&mut boundary, &arrangement, budget)?;
        become_solid(draft, &arrangement, boundary, budget)
    });
    enclosed.or_else(left_alone)
}

/// Turns the connected parts of a boundary that point inward as they were drawn.
fn turn_inward(
    boundary: &mut SolidBoundary,
    arrangement: &Arrangement,
    budget: &Budget,
) -> Result<(), ArrangementError> {
    let corners: Vec<[u32; 3]> = boundary.pieces.iter().map(|piece| piece.corners).collect();
    let parts = EdgeGroups::build(&corners, arrangement.point_count(), budget)?.components(budget)?;
    // Area, and that of pieces that turn the other way than all triangles there.
    let mut areas = vec![[0.0; 2]; parts.count as usize];
    for (piece, &part) in boundary.pieces.iter().zip(&parts.of) {
        let area = triangle_area(piece.corners.map(|p| arrangement.position(p)));
        areas[part as usize][0] += area;
        areas[part as usize][1] += if piece.is_opposite { area } else { 0.0 };
    }
    for (piece, &part) in boundary.pieces.iter_mut().zip(&parts.of) {
        let [all, opposite] = areas[part as usize];
        if opposite > INWARD_SHARE * all {
            piece.corners.swap(1, 2);
            piece.is_opposite = !piece.is_opposite;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::tests::{cubes, volume_times_6};
    use super::super::unite;
    use super::*;
    use crate::geom::DVec3;
    use crate::mesh::EdgeGroups;
    use crate::repair::fill::span_odd_edges;

    fn is_closed(draft: &Draft) -> bool {
        let groups =
            EdgeGroups::build(&draft.triangles, draft.positions.len(), &Budget::unlimited()).unwrap();
        groups.iter().all(|group| group.len() % 2 == 0)
    }

    fn enclosed(mut draft: Draft) -> (Draft, Changes) {
        let changes = enclose(&mut draft, &Budget::unlimited()).unwrap();
        assert_eq!(draft.check(), Vec::<String>::new());
        assert!(is_closed(&draft));
        (draft, changes)
    }

    #[test]
    fn overlapping_cubes_are_one_solid_whichever_way_their_triangles_turn() {
        for pattern in 0..64 {
            let mut draft = cubes(&[(DVec3::ZERO, 2.0, false), (DVec3::new(1.0, 0.75, 0.5), 2.0, false)]);
            for t in 0..24 {
                if (pattern * (t + 7) * 2654435761usize) >> 9 & 1 == 1 {
                    draft.flip(t);
                }
            }
            let (mut draft, _) = enclosed(draft);
            // Where nearly all of it points inward, it does so still.
            unite(&mut draft, &Budget::unlimited()).unwrap();
            assert_eq!(volume_times_6(&draft), 6.0 * (16.0 - 1.25 * 1.5));
        }
    }

    #[test]
    fn a_cavity_stays_and_what_encloses_nothing_goes() {
        let mut draft = cubes(&[(DVec3::ZERO, 4.0, false), (DVec3::ONE, 1.0, true)]);
        let first = draft.positions.len() as u32;
        // A wall between corners of the cavity and the cube, a fin at an edge of the cube, and a sheet far away.
        draft.positions.extend([
            DVec3::new(2.0, 2.0, 2.0),
            DVec3::new(4.0, 4.0, 4.0),
            DVec3::new(3.0, 3.5, 2.0),
            DVec3::new(-2.0, -2.0, 2.0),
            DVec3::new(9.0, 9.0, 9.0),
            DVec3::new(9.0, 10.0, 9.0),
            DVec3::new(9.0, 9.0, 10.0),
        ]);
        draft.vertex_origin.extend(first..first + 7);
        draft.triangles.extend([[15, 7, first + 2], [4, 0, first + 3], [first + 4, first + 5, first + 6]]);
        draft.triangle_origin.extend([24, 25, 26]);
        let (mut draft, changes) = enclosed(draft);
        assert_eq!(changes.coverage.unwrap().bare, [24, 25, 26]);
        unite(&mut draft, &Budget::unlimited()).unwrap();
        assert_eq!((volume_times_6(&draft), draft.triangles.len()), (6.0 * 63.0, 24));
    }

    #[test]
    fn an_open_cube_is_spanned_and_filled() {
        let mut draft = cubes(&[(DVec3::ZERO, 2.0, false)]);
        draft.triangles.truncate(10);
        draft.triangle_origin.truncate(10);
        draft.flip(3);
        let spanned = span_odd_edges(&mut draft, &Budget::unlimited()).unwrap();
        let (draft, _) = enclosed(draft);
        assert_eq!((spanned.count("rims_spanned"), volume_times_6(&draft)), (1, 48.0));
    }
}
