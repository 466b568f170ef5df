//! Real parts, where the corpus is there: read as polyhedra, edited at random, written and judged.

use super::oracle::Model;
use crate::random::Random;
use meshmend::budget::Budget;
use meshmend::formats::{ReadOptions, read, sniff};
use meshmend::geom::DVec3;
use meshmend::mesh::polyhedron::FaceId;
use meshmend::modeller::{
    EventPolicy, Imported, IntervalSide, Operator, apply, check, distance_of_growth, import, offset_growth,
    range, rational,
};
use meshmend::spatial::coincident_f64;
use std::path::Path;

/// The most triangles of a part that is tried.
const TRIANGLES_MAX: usize = 5000;

fn part(path: &Path) -> Option<Result<Imported, String>> {
    let budget = Budget::unlimited();
    let bytes = std::fs::read(path).ok()?;
    let encoding = sniff(&bytes, None).ok()?;
    let soup = read(&bytes, encoding, &ReadOptions::default(), &budget).ok()?;
    if soup.triangles.is_empty() || soup.triangles.len() > TRIANGLES_MAX {
        return None;
    }
    let places = coincident_f64(&soup.positions, &budget).unwrap();
    let points: Vec<DVec3> = places.first.iter().map(|&v| soup.positions[v as usize]).collect();
    let triangles: Vec<[u32; 3]> =
        soup.triangles.iter().map(|t| t.map(|v| places.group[v as usize])).collect();
    Some(import(&points, &triangles, None, &budget).unwrap().map_err(|refusal| {
        let text = format!("{refusal:?}");
        text.split([' ', '(', '{']).next().unwrap_or_default().to_owned()
    }))
}

/// What was done with one part, or with several.
#[derive(Default)]
struct Tally {
    read: usize,
    refused: usize,
    tolerant: usize,
    done: usize,
    /// Shifts that were not tried because a vertex has no good split.
    stopped: usize,
    /// States that the oracle judged too.
    judged: usize,
}

impl Tally {
    fn add(&mut self, other: &Self) {
        self.read += other.read;
        self.refused += other.refused;
        self.tolerant += other.tolerant;
        self.done += other.done;
        self.stopped += other.stopped;
        self.judged += other.judged;
    }
}

/// Shifts after which a part is taken as it was read: every walk inward halves it, and after hundreds nothing of it is
/// left that a rounded number could tell.
const SHIFTS_OF_A_WALK: usize = 40;

/// The most faces of a part that the oracle judges.
const JUDGED_FACES_MAX: usize = 300;

/// Random shifts of one part; the whole solid is judged after each.
fn edit(path: &Path, seed: u64, shifts: usize) -> Tally {
    let budget = Budget::unlimited();
    let imported = match part(path) {
        None => return Tally::default(),
        Some(Err(_)) => return Tally { refused: 1, ..Tally::default() },
        Some(Ok(imported)) => imported,
    };
    let mut tally = Tally { read: 1, tolerant: usize::from(imported.tolerant_faces > 0), ..Tally::default() };
    assert!(imported.moved.1 <= 8.0 * imported.tolerance, "{path:?}");
    let mut random = Random::new(seed);
    let mut solid = imported.solid.clone();
    for k in 0..shifts {
        if k % SHIFTS_OF_A_WALK == 0 {
            solid = imported.solid.clone();
        }
        let face = FaceId::new(random.below(solid.topology().face_count()));
        let outward = random.below(2);
        let side = &range(&solid, &[(face, rational(1.0))], &budget).unwrap()[outward];
        let reach = match side {
            IntervalSide::Limit { limits, .. } => distance_of_growth(&solid, face, &limits[0].1),
            IntervalSide::Unbounded => solid.diagonal() * if outward == 1 { 0.1 } else { -0.1 },
            IntervalSide::Blocked { .. } => {
                tally.stopped += 1;
                continue;
            }
        };
        let share = (1 + random.below(7)) as f64 / 8.0;
        let by = offset_growth(&solid, face, reach * share);
        let shift = Operator::Shift { faces: vec![(face, by)], events: EventPolicy::Refuse };
        let applied = apply(&mut solid, &shift, &budget)
            .unwrap()
            .unwrap_or_else(|refusal| panic!("{path:?} {shift:?}: {refusal:?}"));
        tally.done += 1;
        // The whole solid, each time by the engine; small ones also by the oracle.
        assert!(check(&solid, &budget).unwrap().is_valid(), "{path:?} {shift:?}");
        if solid.topology().face_count() <= JUDGED_FACES_MAX {
            tally.judged += 1;
            assert_eq!(Model::of(&solid).unwrap().fault(), None, "{path:?} {shift:?}");
        }
        // Numbers would grow without end: every other shift is taken back.
        if random.one_in(2) {
            applied.undo(&mut solid);
        }
    }
    tally
}

#[test]
#[allow(clippy::print_stdout, reason = "the campaign's table")]
fn modeller_real_parts_stay_valid_under_random_shifts() {
    let Some(mut files) = crate::support::corpus_files(&["stl", "obj", "off", "ply"]) else { return };
    files.truncate(crate::support::cases(12, files.len()));
    let shifts = crate::support::cases(4, 200);
    let mut all = Tally::default();
    crate::support::on_all_cores(files.len(), |k| edit(&files[k], k as u64, shifts))
        .iter()
        .for_each(|tally| all.add(tally));
    let Tally { read, refused, tolerant, done, stopped, judged } = all;
    println!(
        "| real parts read | refused as no closed solid | with faces joined within the tolerance | shifts done | no split | judged by the oracle too |"
    );
    println!("|---|---|---|---|---|---|");
    println!("| {read} | {refused} | {tolerant} | {done} | {stopped} | {judged} |");
}
