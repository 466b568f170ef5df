//! Solids as small and as large as numbers get.

use crate::certificate_soups::{assert_agreement, verify};
use crate::oracle::RawSoup;
use crate::random::Random;
use crate::raw_files::ENCODINGS;
use crate::solids::{any_solid, cube, tetrahedron};
use crate::support::{cases, on_all_cores};
use meshmend::certificate::{Condition, Depth};
use meshmend::formats::Encoding;

const TEXT: [Encoding; 3] = [Encoding::Obj, Encoding::Off, Encoding::PlyAscii];

#[test]
fn certificate_accepts_solids_from_1e_minus_30_to_1e30_in_every_format() {
    let solids = [cube(), cube().scaled(4.0).with(&tetrahedron().moved([1.0; 3]).inside_out())];
    for scale in [1e-30, 1e-37, 1e-9, 1e9, 1e30, 1e37] {
        for (encoding, solid) in ENCODINGS.iter().flat_map(|&e| solids.iter().map(move |s| (e, s))) {
            let opinion = assert_agreement(&solid.clone().scaled(scale), encoding, &format!("scale {scale}"));
            assert!(opinion.is_valid(), "{scale} {}", encoding.name());
        }
    }
}

#[test]
fn certificate_names_the_reading_in_which_floats_overflow_or_vanish() {
    for (scale, condition) in [
        (1e300, Condition::Usable),
        (1e150, Condition::Usable),
        (1e39, Condition::Usable),
        (1e-46, Condition::NonDegenerate),
        (1e-150, Condition::NonDegenerate),
        (1e-300, Condition::NonDegenerate),
    ] {
        for encoding in TEXT.into_iter().chain([Encoding::PlyBinaryLittleEndian]) {
            let soup = cube().scaled(scale);
            assert_agreement(&soup, encoding, &format!("scale {scale}"));
            let first = verify(&soup, encoding, Depth::FirstViolation).witnesses.remove(0);
            assert_eq!((first.condition, first.reading.is_f32), (condition, true), "{scale}: {first:?}");
        }
    }
}

#[test]
fn certificate_is_right_about_a_pebble_beside_a_mountain() {
    let mountain = || cube().scaled(1e30);
    let beside = mountain().with(&cube().scaled(1e-30).moved([-1.0, 0.0, 0.0]));
    // One float beside 1: the pebble has become flat.
    assert!(!assert_agreement(&beside, Encoding::Obj, "pebble far from the origin").is_valid());
    let beside = mountain().with(&cube().scaled(-1e-30).inside_out());
    assert!(!assert_agreement(&beside, Encoding::Off, "pebble on a corner").is_valid());
    let outside = cube().scaled(-1e-30).inside_out().moved([-1e-30, 0.0, 0.0]);
    assert!(assert_agreement(&mountain().with(&outside), Encoding::Off, "pebble beside a corner").is_valid());
    let inside = cube().scaled(1e-30).moved([1e-30; 3]);
    let kept = mountain().with(&inside.clone().inside_out());
    assert!(assert_agreement(&kept, Encoding::PlyAscii, "bubble in a mountain").is_valid());
    assert!(
        !assert_agreement(&mountain().with(&inside), Encoding::PlyAscii, "pebble in a mountain").is_valid()
    );
}

#[test]
fn certificate_agrees_with_rational_arithmetic_at_extreme_exponents() {
    const STRETCHES: [f64; 10] = [1e-300, 1e-150, 1e-44, 1e-30, 1e-5, 1.0, 1e5, 1e30, 1e150, 1e300];
    let rounds = cases(100, 5_000);
    on_all_cores(rounds, |round| {
        let mut random = Random::new(round as u64);
        let scale: [f64; 3] = if random.one_in(2) {
            [random.pick(&STRETCHES); 3]
        } else {
            std::array::from_fn(|_| random.pick(&STRETCHES))
        };
        let soup: RawSoup = any_solid(&mut random).with(&any_solid(&mut random).moved([2.0, 1.0, 0.0]));
        let stretched = soup.map(|p| std::array::from_fn(|k| p[k] * scale[k]));
        let encoding = random.pick(&[Encoding::Obj, Encoding::Off, Encoding::PlyBinaryBigEndian]);
        assert_agreement(&stretched, encoding, &format!("round {round}"));
    });
    println!("| solids stretched by 1e-300 to 1e300 | {rounds} | all agree |");
}
