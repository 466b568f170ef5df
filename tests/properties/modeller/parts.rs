//! Real parts, where the corpus is there: read as polyhedra, edited at random, written and judged.

use super::oracle::Model;
use crate::random::Random;
use meshmend::budget::Budget;
use meshmend::formats::{ReadOptions, read, sniff};
use meshmend::geom::DVec3;
use meshmend::mesh::polyhedron::FaceId;
use meshmend::modeller::{
    Events, Imported, Operator, Side, apply, check, distance_of_growth, import, offset_growth, range,
    rational,
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

#[test]
#[allow(clippy::print_stdout, reason = "the campaign's table")]
fn modeller_real_parts_stay_valid_under_random_shifts() {
    let Some(files) = crate::support::corpus_files(&["stl", "obj", "off", "ply"]) else { return };
    let (file_max, per_part) = (crate::support::cases(12, 4000), crate::support::cases(4, 200));
    let (mut read, mut refused, mut done, mut stopped, mut tolerant) = (0, 0, 0, 0, 0);
    for (k, path) in files.iter().enumerate().take(file_max) {
        let mut imported = match part(path) {
            None => continue,
            Some(Err(_)) => {
                refused += 1;
                continue;
            }
            Some(Ok(imported)) => imported,
        };
        read += 1;
        tolerant += usize::from(imported.tolerant_faces > 0);
        assert!(imported.moved.1 <= 8.0 * imported.tolerance, "{path:?}");
        let mut random = Random::new(k as u64);
        let solid = &mut imported.solid;
        for _ in 0..per_part {
            let face = FaceId::new(random.below(solid.topology().face_count()));
            let outward = random.below(2);
            let side = &range(solid, &[(face, rational(1.0))], &Budget::unlimited()).unwrap()[outward];
            let reach = match side {
                Side::Limit { limits, .. } => distance_of_growth(solid, face, &limits[0].1),
                Side::Unbounded => solid.diagonal() * if outward == 1 { 0.1 } else { -0.1 },
                Side::Blocked { .. } => {
                    stopped += 1;
                    continue;
                }
            };
            let share = (1 + random.below(7)) as f64 / 8.0;
            let by = offset_growth(solid, face, reach * share);
            let shift = Operator::Shift { faces: vec![(face, by)], events: Events::Refuse };
            match apply(solid, &shift, &Budget::unlimited()).unwrap() {
                Ok(applied) => {
                    done += 1;
                    // The whole solid, each time by the engine; small ones also by the oracle.
                    assert!(check(solid, &Budget::unlimited()).unwrap().is_valid(), "{path:?} {shift:?}");
                    if solid.topology().face_count() <= 300 && random.one_in(4) {
                        assert_eq!(Model::of(solid).unwrap().fault(), None, "{path:?} {shift:?}");
                    }
                    // Numbers would grow without end: every other shift is taken back.
                    if random.one_in(2) {
                        applied.undo(solid);
                    }
                }
                Err(refusal) => panic!("{path:?} {shift:?}: {refusal:?}"),
            }
        }
    }
    println!(
        "| real parts read | refused as no closed solid | with faces joined within the tolerance | shifts done | no split |"
    );
    println!("|---|---|---|---|---|");
    println!("| {read} | {refused} | {tolerant} | {done} | {stopped} |");
}
