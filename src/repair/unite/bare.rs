//! Unites bodies and keeps a copy of what that would lose: triangles of which a part has void on both sides.

use super::cavities::turn_inverted;
use super::{arranged, become_solid, left_alone};
use crate::arrangement::{Arrangement, ArrangementError, SolidBoundary};
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::mesh::cut_singular;
use crate::repair::{Changes, Draft, NEW};

/// As [`unite`](super::unite); then adds a copy of every triangle of which a piece had void on both sides, as open parts of
/// their own that walls can be put behind.
///
/// # Errors
/// When the budget stops the run.
pub fn unite_and_copy_bare(draft: &mut Draft, budget: &Budget) -> Result<Changes, Stopped> {
    let turned = turn_inverted(draft, budget)?.count;
    let united = arranged(draft, budget).and_then(|arrangement| {
        let boundary = arrangement.boundary(|winding| winding[0] > 0);
        become_solid_and_copy_bare(draft, &arrangement, boundary, budget)
    });
    let united = united.or_else(left_alone)?;
    let counts = [("shells_turned", turned)].into_iter().chain(united.counts).collect();
    Ok(Changes { counts, ..united })
}

/// As [`become_solid`]; then adds the copies.
pub(super) fn become_solid_and_copy_bare(
    draft: &mut Draft,
    arrangement: &Arrangement,
    boundary: SolidBoundary,
    budget: &Budget,
) -> Result<Changes, ArrangementError> {
    let copies = Copies::of_bare(draft, arrangement, budget)?;
    let united = become_solid(draft, arrangement, boundary, budget)?;
    let Some(coverage) = united.coverage else { return Ok(united) };
    let counts = [("triangles_copied", copies.triangles.len() as u64)].into_iter().chain(united.counts);
    let counts = counts.collect();
    copies.add_to(draft);
    // What is copied is still there.
    let coverage = Some(super::Coverage { bare: Vec::new(), ..coverage });
    Ok(Changes { counts, coverage, ..united })
}

/// Copies of triangles, cut into manifold parts.
struct Copies {
    /// Their vertices: where they are and their origins.
    vertices: Vec<(DVec3, u32)>,
    /// Their corners, as numbers of these vertices, and their origins.
    triangles: Vec<([u32; 3], u32)>,
}

impl Copies {
    /// Of the triangles of which a piece has void on both sides.
    fn of_bare(draft: &Draft, arrangement: &Arrangement, budget: &Budget) -> Result<Self, Stopped> {
        let is_bare = |f: &usize| arrangement.windings(*f).iter().all(|winding| winding[0] <= 0);
        let pieces = (0..arrangement.pieces().len()).filter(is_bare);
        let mut bare: Vec<u32> = pieces.map(|f| source(draft, arrangement, f)).collect();
        bare.sort_unstable();
        bare.dedup();
        let mut corners: Vec<u32> = bare.iter().flat_map(|&t| draft.triangles[t as usize]).collect();
        corners.sort_unstable();
        corners.dedup();
        let number = |v: u32| corners.partition_point(|&c| c < v) as u32;
        let mut triangles: Vec<[u32; 3]> =
            bare.iter().map(|&t| draft.triangles[t as usize].map(number)).collect();
        let cut = cut_singular(&mut triangles, corners.len(), budget)?;
        corners.extend(cut.copies.iter().map(|&v| corners[v as usize]).collect::<Vec<u32>>());
        let origins = bare.iter().map(|&t| draft.triangle_origin[t as usize]);
        let triangles = triangles.into_iter().zip(origins).collect();
        let vertex = |v: u32| (draft.positions[v as usize], draft.vertex_origin[v as usize]);
        Ok(Self { vertices: corners.into_iter().map(vertex).collect(), triangles })
    }

    fn add_to(self, draft: &mut Draft) {
        let first = draft.positions.len() as u32;
        for (place, origin) in self.vertices {
            draft.positions.push(place);
            draft.vertex_origin.push(origin);
        }
        for (corners, origin) in self.triangles {
            draft.triangles.push(corners.map(|v| first + v));
            draft.triangle_origin.push(origin);
        }
    }
}

/// Of the triangles that cover a piece the first one that is of the file, or else the first.
fn source(draft: &Draft, arrangement: &Arrangement, piece: usize) -> u32 {
    let sources = arrangement.sources(piece);
    let is_of_file = |&&(t, _): &&(u32, bool)| draft.triangle_origin[t as usize] != NEW;
    sources.iter().find(is_of_file).unwrap_or(&sources[0]).0
}

#[cfg(test)]
mod tests {
    use super::super::tests::{cubes, volume_times_6};
    use super::super::{unite, unite_as_oriented};
    use super::*;
    use crate::repair::thicken::thicken;

    #[test]
    fn a_fin_on_a_cube_is_copied_and_the_cube_is_not() {
        let mut draft = cubes(&[(DVec3::ZERO, 1.0, false)]);
        let first = draft.positions.len() as u32;
        draft.positions.extend([
            DVec3::new(0.5, 0.5, 0.5),
            DVec3::new(0.75, 0.5, 2.0),
            DVec3::new(0.25, 0.5, 2.0),
        ]);
        draft.vertex_origin.extend([8, 9, 10]);
        // A triangle that sticks out of the cube, on both sides.
        draft.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 1]]);
        draft.triangle_origin.extend([12, NEW]);
        let budget = Budget::unlimited();
        let changes = unite_and_copy_bare(&mut draft, &budget).unwrap();
        assert_eq!((changes.count("triangles_copied"), draft.triangles.len()), (1, 13));
        assert_eq!(draft.triangle_origin[12..], [12]);
        assert_eq!(draft.check(), Vec::<String>::new());
        thicken(&mut draft, 0.125, unite_as_oriented, &budget).unwrap();
        unite(&mut draft, &budget).unwrap();
        // The wall has its whole thickness outside of the cube.
        let fin = (0.5 - 0.5 / 9.0) / 2.0 * 0.125;
        let volume = volume_times_6(&draft) / 6.0;
        assert!(volume > 1.0 + 0.5 * fin && volume < 1.0 + 2.0 * fin, "{volume}");
        assert!(draft.triangle_origin.contains(&12));
    }
}
