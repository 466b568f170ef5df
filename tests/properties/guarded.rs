//! Guarded simplification of valid solids: what comes out is a valid solid, with the shells of the input.

use crate::oracle::RawSoup;
use crate::random::Random;
use crate::raw_files::encode;
use crate::solids::star;
use crate::support::cases;
use meshmend::budget::Budget;
use meshmend::certificate::Certificate;
use meshmend::formats::Encoding;
use meshmend::pipeline::{Operation, Options, Report, SimplifyChoices, run};
use meshmend::simplify::{CriterionKind, Mode, Target};

fn simplified(bytes: &[u8], mode: Mode, criterion: CriterionKind) -> Report {
    let targets = vec![Target::Ratio(0.5), Target::Faces(8)];
    let simplify = SimplifyChoices { targets, mode: Some(mode), criterion, ..SimplifyChoices::default() };
    let options = Options { simplify, ..Options::default() };
    run(Operation::Simplify, bytes, &options, &Budget::unlimited()).unwrap().report
}

/// A star and, just inside of it, its copy: a thin wall around a cavity, sometimes with a core and a neighbour.
fn thin_walled(random: &mut Random) -> RawSoup {
    let radii: Vec<f64> = (0..32).map(|_| 0.5 + random.unit()).collect();
    let shell = || {
        let mut radii = radii.iter().copied().cycle();
        star(&mut || radii.next().unwrap_or(1.0))
    };
    let thickness = random.pick(&[0.3, 0.1, 0.03]);
    let mut soup = shell().with(&shell().scaled(1.0 - thickness).inside_out());
    if random.one_in(2) {
        soup = soup.with(&shell().scaled(0.5));
    }
    if random.one_in(2) {
        soup = soup.with(&shell().scaled(0.4).moved([1.1, 0.9, 0.2]));
    }
    soup.map(|p| p.map(|x| f64::from(x as f32)))
}

/// Depth and direction of the shells, sorted.
fn shells(certificate: &Certificate) -> Vec<(u32, bool, u32)> {
    let mut shells: Vec<_> =
        certificate.shells.iter().map(|shell| (shell.depth, shell.volume > 0.0, shell.genus)).collect();
    shells.sort_unstable();
    shells
}

#[test]
fn guarded_results_of_valid_solids_are_valid_and_have_the_same_shells() {
    let mut random = Random::new(0x6a4d);
    let (mut valid, mut broken_by_fast, mut smaller) = (0, 0, 0);
    for _ in 0..cases(400, 10_000) {
        let bytes = encode(&thin_walled(&mut random), Encoding::Off);
        let criterion =
            random.pick(&[CriterionKind::Quadric, CriterionKind::Memoryless, CriterionKind::Length]);
        let guarded = simplified(&bytes, Mode::Guarded, criterion);
        if !guarded.input_certificate.is_printable() {
            continue;
        }
        valid += 1;
        for level in &guarded.levels {
            assert!(level.certificate.is_printable(), "{:?}", level.certificate.witnesses.first());
            assert_eq!(shells(&level.certificate), shells(&guarded.input_certificate));
            smaller += usize::from(level.simplified.faces_after < level.simplified.faces_before);
        }
        let fast = simplified(&bytes, Mode::Fast, criterion);
        broken_by_fast += usize::from(!fast.levels.iter().all(|level| level.certificate.is_printable()));
    }
    println!(
        "| guarded | {valid} solids | {broken_by_fast} broken by the fast mode | {smaller} of {} results smaller |",
        2 * valid
    );
    assert!(
        valid > 100 && broken_by_fast * 10 > valid && smaller > valid,
        "{valid} {broken_by_fast} {smaller}"
    );
}
