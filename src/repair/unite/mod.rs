//! Bodies that pass through each other or overlap become one: the exact arrangement of all triangles, and of its cells those with
//! a positive winding number.
//!
//! Triangles stay as they are where they bound the solid; those that others pass through are cut there. New vertices are where
//! they are exactly up to half a pitch of the lattice on which every coordinate is a float32.

mod bare;
mod bore;
mod cavities;
mod combine;
mod enclose;

pub use bare::unite_and_copy_bare;
pub use bore::bore_contacts;
pub use combine::{NotCombined, NotSolid, SetOperation, combine};
pub use enclose::{enclose, enclose_and_copy_bare};

use self::cavities::{CavityShells, TurnedShells, turn_inverted};
use super::{Changes, Draft, Effects, FIRST_BLEND, NEW};
use crate::arrangement::{
    self, Arrangement, ArrangementError, ArrangementOptions, PlacedBoundary, SolidBoundary, arrange,
    arrange_in,
};
use crate::budget::{Budget, Stopped};
use crate::geom::{DVec3, print_pitch, triangle_area};
use crate::par;
use crate::spatial::Bvh;

/// Most pairs of triangles that may meet, for each triangle of the draft, and the least that a draft of any size may have.
const PAIRS_PER_TRIANGLE: usize = 128;
const PAIRS_MIN: usize = 1 << 16;

/// Most pairs in drafts of up to about 100,000 triangles: each pair takes about a kilobyte, and files of 4 MB should do with a gibibyte.
const PAIRS_OF_SMALL_MAX: usize = 3 << 18;

/// Most pairs in larger drafts: for each triangle, and in all.
const PAIRS_PER_TRIANGLE_OF_LARGE: usize = 8;
const PAIRS_OF_LARGE_MAX: usize = 1 << 21;

/// Most points where triangles cross each other inside of others, in drafts of up to about 100,000 triangles, and in larger ones
/// for each triangle and in all: each takes about 250 bytes.
const CROSSINGS_OF_SMALL_MAX: usize = 5 << 19;
const CROSSINGS_PER_TRIANGLE_OF_LARGE: usize = 32;
const CROSSINGS_OF_LARGE_MAX: usize = 1 << 23;

/// Share of the surface of a body that may be mouths.
const MOUTHS_MAX: f64 = 0.5;

/// What became of the triangles of the soup when bodies were united. Every place of one that is `present` and not `bare` is on the
/// surface of the solid or inside of it, up to what the rounding of new vertices moves.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Coverage {
    /// Triangles of the soup that were in the draft, ascending.
    pub present: Vec<u32>,
    /// Those of which some piece has void on both sides, so that it is gone, ascending.
    pub bare: Vec<u32>,
    /// Those of which some piece is gone because it is inside the solid, or on that of another one, ascending.
    pub buried: Vec<u32>,
    /// Area of the pieces inside the solid, in square units of the file.
    pub buried_area: f64,
    /// Pieces that are mouths: where a cavity reaches the surface of its body, triangles of both lie on each other, turn opposite ways
    /// and bound nothing.
    pub mouths: u64,
    /// Those of `bare` of which a piece is gone that is no mouth and not where cavities pass into each other, ascending.
    pub bare_beside_mouths: Vec<u32>,
}

impl Coverage {
    fn of(draft: &Draft, arrangement: &Arrangement, shells: Option<&CavityShells>) -> Self {
        // Area of each shell, and that of its mouths.
        let mut areas = vec![[0.0; 2]; shells.map_or(0, CavityShells::count)];
        let mut mouths = Vec::new();
        let of_file = |t: u32| Some(draft.triangle_origin[t as usize]).filter(|&origin| origin != NEW);
        let mut coverage = Self { present: Vec::with_capacity(draft.triangles.len()), ..Self::default() };
        coverage.present.extend((0..draft.triangles.len() as u32).filter_map(of_file));
        for (f, corners) in arrangement.pieces().iter().enumerate() {
            let [front, back] = arrangement.windings(f).map(|winding| winding[0] > 0);
            let sources = || arrangement.sources(f).iter().filter_map(|&(t, _)| of_file(t));
            let count = sources().count();
            if front && back {
                let area = triangle_area(corners.map(|p| arrangement.position(p)));
                coverage.buried_area += area * count as f64;
            } else if !front && !back {
                coverage.bare.extend(sources());
            }
            if let Some(shells) = shells {
                let is_mouth = !front && !back && shells.have_mouth(arrangement.sources(f));
                if is_mouth {
                    mouths.push(f);
                } else if !front && !back && !shells.have_passage(arrangement.sources(f)) {
                    coverage.bare_beside_mouths.extend(sources());
                }
                let area = triangle_area(corners.map(|p| arrangement.position(p)));
                for &(t, _) in arrangement.sources(f) {
                    let [of_shell, of_mouths] = &mut areas[shells.of(t)];
                    *of_shell += area;
                    *of_mouths += if is_mouth { area } else { 0.0 };
                }
            }
            // Of several on each other, one stands for all from here on.
            if front && back || count > 1 {
                coverage.buried.extend(sources());
            }
        }
        // What is mostly mouth is no body with a cavity.
        let is_left = |shells: &CavityShells, t: u32| {
            let [of_shell, of_mouths] = areas[shells.of(t)];
            !shells.is_body(t) || of_mouths <= MOUTHS_MAX * of_shell
        };
        for (f, shells) in mouths.into_iter().zip(shells.into_iter().cycle()) {
            let sources = arrangement.sources(f);
            if sources.iter().all(|&(t, _)| is_left(shells, t)) {
                coverage.mouths += 1;
            } else {
                coverage.bare_beside_mouths.extend(sources.iter().filter_map(|&(t, _)| of_file(t)));
            }
        }
        let Self { present, bare, buried, bare_beside_mouths, .. } = &mut coverage;
        for list in [present, bare, buried, bare_beside_mouths] {
            list.sort_unstable();
            list.dedup();
        }
        coverage
    }
}

/// Unites the bodies of a draft whose surface is closed. Shells that point inward and are no cavities are turned first. A draft that
/// is open, or of which too many triangles meet, is left as it is.
///
/// # Errors
/// When the budget stops the run.
pub fn unite(draft: &mut Draft, budget: &Budget) -> Result<Changes, Stopped> {
    let TurnedShells { count, with_cavities, bvh } = turn_inverted(draft, budget)?;
    let united = unite_shells(draft, with_cavities.as_ref(), bvh, budget)?;
    let counts = [("shells_turned", count)].into_iter().chain(united.counts).collect();
    Ok(Changes { counts, ..united })
}

/// As [`unite`], but no shell is turned: what points inward is taken out of the others.
///
/// # Errors
/// When the budget stops the run.
pub fn unite_as_oriented(draft: &mut Draft, budget: &Budget) -> Result<Changes, Stopped> {
    unite_shells(draft, None, None, budget)
}

/// As [`unite_as_oriented`]; `shells` tell what is a cavity, and the hierarchy of the triangles may be `known`.
fn unite_shells(
    draft: &mut Draft,
    shells: Option<&CavityShells>,
    known: Option<Bvh>,
    budget: &Budget,
) -> Result<Changes, Stopped> {
    let options = arrangement_options(draft, 1);
    let arranged = arrange_in(known, &draft.positions, &draft.triangles, |_| 0, &options, budget);
    let united = arranged.and_then(|arrangement| {
        let boundary = arrangement.boundary(|winding| winding[0] > 0);
        become_covered(draft, &arrangement, boundary, shells, budget)
    });
    united.or_else(left_alone)
}

/// The boundary of a solid takes the place of the draft, which is left as it is where float32 does not go so far.
fn become_solid(
    draft: &mut Draft,
    arrangement: &Arrangement,
    boundary: SolidBoundary,
    budget: &Budget,
) -> Result<Changes, ArrangementError> {
    become_covered(draft, arrangement, boundary, None, budget)
}

/// As [`become_solid`]; `shells` tell what is a cavity.
fn become_covered(
    draft: &mut Draft,
    arrangement: &Arrangement,
    boundary: SolidBoundary,
    shells: Option<&CavityShells>,
    budget: &Budget,
) -> Result<Changes, ArrangementError> {
    let covered = || Coverage::of(draft, arrangement, shells);
    let (coverage, placed) = par::join(covered, || placed(draft, arrangement, boundary, budget));
    Ok(match placed? {
        Some(placed) => {
            let mut changes = replace(draft, placed);
            if coverage.mouths > 0 {
                let why = "a cavity reaches the surface of its body and stays open there";
                changes.reason = [why, &changes.reason]
                    .into_iter()
                    .filter(|why| !why.is_empty())
                    .collect::<Vec<_>>()
                    .join("; ");
            }
            Changes { coverage: Some(coverage), ..changes }
        }
        None => not_united("float32 does not go so far"),
    })
}

fn arranged(draft: &Draft, budget: &Budget) -> Result<Arrangement, ArrangementError> {
    arranged_by(draft, 1, |_| 0, budget)
}

/// The arrangement with winding numbers for each of so many operands; `operand_of` tells that of a triangle.
fn arranged_by(
    draft: &Draft,
    operands: u8,
    operand_of: impl Fn(u32) -> u8 + Sync,
    budget: &Budget,
) -> Result<Arrangement, ArrangementError> {
    let options = arrangement_options(draft, operands);
    arrange(&draft.positions, &draft.triangles, operand_of, &options, budget)
}

/// What the arrangement of a draft may cost.
fn arrangement_options(draft: &Draft, operands: u8) -> ArrangementOptions {
    let triangles = draft.triangles.len();
    let crossings_max =
        (triangles * CROSSINGS_PER_TRIANGLE_OF_LARGE).clamp(CROSSINGS_OF_SMALL_MAX, CROSSINGS_OF_LARGE_MAX);
    ArrangementOptions { pairs_max: pairs_of(triangles), crossings_max, operands }
}

fn pairs_of(triangles: usize) -> usize {
    let most = (triangles * PAIRS_PER_TRIANGLE_OF_LARGE).clamp(PAIRS_OF_SMALL_MAX, PAIRS_OF_LARGE_MAX);
    (triangles * PAIRS_PER_TRIANGLE).clamp(PAIRS_MIN, most)
}

/// A boundary on the print lattice; `None`: float32 does not go so far.
fn placed(
    draft: &Draft,
    arrangement: &Arrangement,
    boundary: SolidBoundary,
    budget: &Budget,
) -> Result<Option<PlacedBoundary>, ArrangementError> {
    let merged = arrangement.merged(&boundary, budget)?;
    drop(boundary);
    let reach = draft.positions.iter().fold(0.0f64, |reach, p| reach.max(p.abs().max_element()));
    let pitch = print_pitch(reach);
    pitch.map(|pitch| arrangement::place(arrangement, merged, pitch, budget)).transpose()
}

/// Puts what is placed into the draft.
fn replace(draft: &mut Draft, placed: PlacedBoundary) -> Changes {
    let before = draft.triangles.len() as u64;
    let points_before = draft.positions.len();
    let move_max = placed.move_max;
    let reason = match placed.conflicts {
        0 => String::new(),
        conflicts => format!("{conflicts} pairs of triangles still meet after rounding"),
    };
    let is_first = first_of_each(&placed.triangles, placed.positions.len());
    let blends = new_vertices(draft, &placed, &is_first);
    draft.vertex_origin.extend(blends);
    draft.positions = placed.positions;
    draft.triangle_origin = placed.sources.iter().map(|&t| draft.triangle_origin[t as usize]).collect();
    draft.triangles = placed.triangles;
    draft.polygons = Default::default();
    let new = is_first[points_before..].iter().filter(|&&t| t != NEW).count() as u64;
    draft.drop_unused_vertices();
    let after = draft.triangles.len() as u64;
    let counts = [("triangles_before", before), ("triangles_after", after), ("vertices_added", new)];
    let effects = Effects { meeting_pairs: placed.conflicts, ..Effects::default() };
    Changes { move_max, reason, effects, ..Changes::counted(counts) }
}

/// What is told of a draft that is left as it is because there is no arrangement.
fn left_alone(error: ArrangementError) -> Result<Changes, Stopped> {
    match error {
        ArrangementError::Stopped(stopped) => Err(stopped),
        error => Ok(not_united(&error.to_string())),
    }
}

fn not_united(why: &str) -> Changes {
    let reason = format!("bodies were not united: {why}");
    Changes { reason, ..Changes::counted([("triangles_after", 0)]) }
}

/// A triangle at each point, or [`NEW`].
fn first_of_each(triangles: &[[u32; 3]], points: usize) -> Vec<u32> {
    let mut first = vec![NEW; points];
    for (t, corners) in triangles.iter().enumerate().rev() {
        for &p in corners {
            first[p as usize] = t as u32;
        }
    }
    first
}

/// The origins of the points that are new: blends of the corners of the triangle that they are on.
fn new_vertices(draft: &mut Draft, placed: &PlacedBoundary, is_first: &[u32]) -> Vec<u32> {
    let old = draft.positions.len();
    let mut origins = Vec::with_capacity(placed.positions.len() - old);
    for (&place, &t) in placed.positions[old..].iter().zip(&is_first[old..]) {
        if t == NEW {
            origins.push(0);
            continue;
        }
        let source = placed.sources[t as usize] as usize;
        let soup_triangle = draft.triangle_origin[source];
        if soup_triangle == NEW {
            origins.push(draft.vertex_origin[draft.triangles[source][0] as usize]);
            continue;
        }
        let shares = shares(draft.corners(source), place);
        let blend = (0..3).filter(|&k| shares[k] > 0.0).map(|k| (3 * soup_triangle + k as u32, shares[k]));
        draft.blends.vertices.push(blend.collect());
        origins.push(FIRST_BLEND + draft.blends.vertices.len() as u32 - 1);
    }
    origins
}

/// The shares of the corners of a triangle in a place on it, rounded.
fn shares([a, b, c]: [DVec3; 3], place: DVec3) -> [f64; 3] {
    let normal = (b - a).cross(c - a);
    let part = |p: DVec3, q: DVec3| (p - place).cross(q - place).dot(normal).max(0.0);
    let parts = [part(b, c), part(c, a), part(a, b)];
    let sum: f64 = parts.iter().sum();
    if sum > 0.0 && sum.is_finite() { parts.map(|part| part / sum) } else { [1.0, 0.0, 0.0] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::EdgeGroups;

    /// Cubes of these sides from these corners on; `true`: turned inside out.
    pub(super) fn cubes(of: &[(DVec3, f64, bool)]) -> Draft {
        const SIDES: [[u32; 3]; 12] = [
            [0, 2, 1],
            [1, 2, 3],
            [4, 5, 6],
            [5, 7, 6],
            [0, 1, 4],
            [1, 5, 4],
            [2, 6, 3],
            [3, 6, 7],
            [0, 4, 2],
            [2, 4, 6],
            [1, 3, 5],
            [3, 7, 5],
        ];
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        for &(low, size, is_turned) in of {
            let first = positions.len() as u32;
            let bit = |i: u32, k: u32| f64::from(i >> k & 1);
            positions.extend((0..8).map(|i| low + size * DVec3::new(bit(i, 0), bit(i, 1), bit(i, 2))));
            let turn = |[a, b, c]: [u32; 3]| if is_turned { [a, c, b] } else { [a, b, c] };
            triangles.extend(SIDES.map(turn).map(|t| t.map(|v| first + v)));
        }
        Draft {
            vertex_origin: (0..positions.len() as u32).collect(),
            triangle_origin: (0..triangles.len() as u32).collect(),
            positions,
            triangles,
            two_sided: Vec::new(),
            blends: Default::default(),
            polygons: Default::default(),
        }
    }

    /// Six times the volume, which is exact for these.
    pub(super) fn volume_times_6(draft: &Draft) -> f64 {
        let of = |t: usize| {
            let [a, b, c] = draft.corners(t);
            a.cross(b).dot(c)
        };
        (0..draft.triangles.len()).map(of).sum()
    }

    #[test]
    fn overlapping_cubes_become_one_body_and_keep_what_nothing_passes_through() {
        let middle = DVec3::new(1.0, 0.75, 0.5);
        for is_turned in [false, true] {
            let mut draft = cubes(&[(DVec3::ZERO, 2.0, false), (middle, 2.0, is_turned)]);
            let before = draft.triangles.clone();
            let changes = unite(&mut draft, &Budget::unlimited()).unwrap();
            assert_eq!(changes.count("shells_turned"), u64::from(is_turned));
            assert_eq!((volume_times_6(&draft), changes.move_max), (6.0 * (16.0 - 1.25 * 1.5), 0.0));
            let groups =
                EdgeGroups::build(&draft.triangles, draft.positions.len(), &Budget::unlimited()).unwrap();
            assert!(groups.iter().all(|group| group.len() == 2));
            // The three sides of each cube that the other one does not reach stay as they are.
            let places = |t: [u32; 3], of: &Draft| t.map(|v| of.positions[v as usize].to_array());
            let first = cubes(&[(DVec3::ZERO, 2.0, false), (middle, 2.0, false)]);
            let kept = |t: &&[u32; 3]| {
                let old = places(**t, &first);
                let is_old = |own: &[u32; 3]| {
                    (0..3).any(|k| {
                        let new = places(*own, &draft);
                        [new[k], new[(k + 1) % 3], new[(k + 2) % 3]] == old
                    })
                };
                draft.triangles.iter().any(is_old)
            };
            assert_eq!(before.len(), 24);
            assert!(first.triangles.iter().filter(kept).count() >= 12);
            assert_eq!(draft.check(), Vec::<String>::new());
        }
    }

    #[test]
    fn small_drafts_may_have_no_more_pairs_than_fit_in_a_gibibyte() {
        let expected = [
            (12, 65_536),
            (1_000, 128_000),
            (7_200, 786_432),
            (83_000, 786_432),
            (200_000, 1_600_000),
            (1_000_000, 2_097_152),
        ];
        for (triangles, pairs) in expected {
            assert_eq!(pairs_of(triangles), pairs, "{triangles} triangles");
        }
    }

    #[test]
    fn a_draft_that_is_open_is_left_as_it_is() {
        let mut draft = cubes(&[(DVec3::ZERO, 2.0, false), (DVec3::ONE, 2.0, false)]);
        draft.triangles.pop();
        draft.triangle_origin.pop();
        let before = draft.triangles.clone();
        let changes = unite(&mut draft, &Budget::unlimited()).unwrap();
        assert_eq!((draft.triangles, changes.count("vertices_added")), (before, 0));
        assert!(changes.reason.starts_with("bodies were not united"), "{}", changes.reason);
    }
}
