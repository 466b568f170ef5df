//! Repair from bytes to bytes on broken solids: whatever is returned as a solid is one, and nothing else has changed.

use crate::oracle::{RawSoup, judge_welded};
use crate::random::Random;
use crate::raw_files::{ENCODINGS, encode};
use crate::solids::any_solid;
use crate::support::cases;
use meshmend::budget::Budget;
use meshmend::certificate::{Depth, certify};
use meshmend::formats::{self, Encoding, ReadOptions};
use meshmend::geom::DVec3;
use meshmend::mesh::Soup;
use meshmend::par;
use meshmend::pipeline::{Answer, Operation, Options, Outcome, WrapChoices, run};
use std::collections::{BTreeMap, BTreeSet};

fn repair(bytes: &[u8]) -> Answer {
    let wrap = WrapChoices { cells: Some(16), ..WrapChoices::default() };
    run(Operation::Repair, bytes, &Options { wrap, ..Options::default() }, &Budget::unlimited()).unwrap()
}

fn read(bytes: &[u8], encoding: Encoding) -> Soup {
    formats::read(bytes, encoding, &ReadOptions::default(), &Budget::unlimited()).unwrap()
}

/// One or two solids with a few defects of any kind, each common enough to meet the others.
pub(crate) fn broken(random: &mut Random) -> RawSoup {
    let mut soup = any_solid(random);
    if random.one_in(3) {
        let other = any_solid(random);
        let at = [0; 3].map(|_| f64::from(random.between(-2, 4)));
        soup = soup.with(&if random.one_in(2) { other.inside_out() } else { other }.moved(at));
    }
    for _ in 0..1 + random.below(4) {
        let t = random.below(soup.triangles.len());
        match random.below(7) {
            0 if soup.triangles.len() > 3 => drop(soup.triangles.remove(t)),
            1 => soup.triangles[t].swap(0, 1),
            2 => soup.triangles.push(soup.triangles[t]),
            3 => {
                let [a, b, c] = soup.triangles[t];
                soup.triangles.push([a, c, b]);
            }
            4 => soup = soup.inside_out(),
            5 => put_sliver(&mut soup, t),
            _ => {
                let stray = [0; 3].map(|_| random.below(soup.positions.len()) as u32);
                soup.triangles.push(stray);
            }
        }
    }
    soup
}

/// Divides triangle `t` in the middle of an edge and closes the edge with a triangle without area.
fn put_sliver(soup: &mut RawSoup, t: usize) {
    let [a, b, c] = soup.triangles[t];
    let (p, q) = (soup.positions[a as usize], soup.positions[b as usize]);
    let middle = soup.positions.len() as u32;
    soup.positions.push(std::array::from_fn(|k| (p[k] + q[k]) / 2.0));
    soup.triangles[t] = [a, middle, c];
    soup.triangles.extend([[middle, b, c], [a, b, middle]]);
}

/// The corners' bits, beginning with the smallest.
fn key(corners: [[u64; 3]; 3]) -> [[u64; 3]; 3] {
    let [a, b, c] = corners;
    [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().unwrap_or(corners)
}

fn keys(soup: &Soup) -> BTreeMap<[[u64; 3]; 3], usize> {
    let mut keys = BTreeMap::new();
    for t in 0..soup.triangles.len() as u32 {
        *keys.entry(key(soup.corners(t).map(|p| p.to_array().map(|x| (x + 0.0).to_bits())))).or_default() +=
            1;
    }
    keys
}

/// Triangles that both have, as a share of those of `before`, by comparing all.
fn common_share(before: &Soup, after: &Soup) -> f64 {
    let after = keys(after);
    let common: usize = keys(before).iter().map(|(k, n)| (*n).min(after.get(k).copied().unwrap_or(0))).sum();
    common as f64 / before.triangles.len() as f64
}

#[test]
fn what_is_returned_as_a_solid_is_one_and_only_opened_contacts_have_moved() {
    let mut random = Random::new(9);
    let (mut repaired, mut united, mut rebuilt, mut refused, mut opened) = (0, 0, 0, 0, 0);
    for case in 0..cases(1_000, 50_000) {
        let soup = broken(&mut random);
        let encoding = random.pick(&ENCODINGS);
        let bytes = encode(&soup, encoding);
        let answer = repair(&bytes);
        let is_valid = judge_welded(&soup).is_valid();
        match answer.report.outcome {
            Some(Outcome::Repaired) => repaired += 1,
            Some(Outcome::Rebuilt) => {
                assert!(!is_valid, "case {case}: {soup:?}");
                assert!(answer.report.certificate.unwrap().is_printable(), "case {case}: {soup:?}");
                rebuilt += 1;
                continue;
            }
            Some(Outcome::Refused) => {
                assert!(!is_valid, "case {case}: {soup:?}");
                refused += 1;
                continue;
            }
            other => {
                assert!(is_valid && other == Some(Outcome::Identical), "case {case}: {other:?} for {soup:?}");
                continue;
            }
        }
        let written = answer.output.unwrap().bytes.unwrap();
        let certificate =
            certify(&written, encoding, &ReadOptions::default(), Depth::FirstViolation, &Budget::unlimited())
                .unwrap();
        assert!(certificate.is_printable(), "case {case}: {soup:?}");
        let (before, after) = (read(&bytes, encoding), read(&written, encoding));
        let raw = RawSoup {
            positions: after.positions.iter().map(DVec3::to_array).collect(),
            triangles: after.triangles.clone(),
        };
        assert!(judge_welded(&raw).is_valid(), "case {case}: {soup:?}");

        let (opening, others): (Vec<_>, Vec<_>) =
            answer.report.actions.iter().partition(|action| action.step == "open-contacts");
        let is_united = others.iter().any(|action| action.step == "unite");
        united += u64::from(is_united);
        // New corners are where they are exactly up to half a step of the lattice in each direction, or a few after that is mended.
        let most = if is_united { 1e-4 } else { 0.0 };
        assert!(others.iter().all(|action| action.move_max <= most), "case {case}");
        let drawn_back: u64 =
            opening.iter().flat_map(|action| &action.changes).map(|&(_, count)| count).sum();
        let pairing = others.iter().filter(|action| action.step == "pair-sheets");
        let middles = pairing.flat_map(|action| &action.changes).filter(|(name, _)| *name == "edges_divided");
        let divided: u64 = middles.map(|&(_, count)| count).sum();
        let elsewhere: BTreeSet<_> = after
            .positions
            .iter()
            .filter(|p| !before.positions.contains(p))
            .map(|p| p.to_array().map(f64::to_bits))
            .collect();
        assert!(is_united || elsewhere.len() as u64 <= drawn_back + divided, "case {case}: {soup:?}");
        opened += u64::from(drawn_back > 0);
        let share = answer.report.identical_triangle_share.unwrap();
        assert!((share - common_share(&before, &after)).abs() < 1e-12, "case {case}: {share} of {soup:?}");

        let again = repair(&written);
        assert_eq!(again.report.outcome, Some(Outcome::Identical), "case {case}: {soup:?}");
    }
    assert!(
        repaired > 500 && united > 100 && opened > 0,
        "{repaired} repaired, {united} of them united, {opened} of them opened, {rebuilt} rebuilt, {refused} refused"
    );
}

#[test]
fn a_valid_solid_comes_back_as_it_is_in_every_encoding() {
    let mut random = Random::new(10);
    for case in 0..cases(100, 2_000) {
        let soup = any_solid(&mut random);
        for encoding in ENCODINGS {
            let answer = repair(&encode(&soup, encoding));
            assert_eq!(
                answer.report.outcome,
                Some(Outcome::Identical),
                "case {case}, {encoding:?}: {soup:?}"
            );
            assert_eq!(answer.output.unwrap().bytes, None);
        }
    }
}

#[test]
fn the_same_bytes_are_repaired_alike_again_and_with_any_number_of_threads() {
    let mut random = Random::new(11);
    for case in 0..cases(50, 2_000) {
        let bytes = encode(&broken(&mut random), random.pick(&ENCODINGS));
        let once = repair(&bytes);
        for threads in [1, 2, 8] {
            assert_eq!(par::with_threads(threads, || repair(&bytes)), once, "case {case}, {threads} threads");
        }
    }
}
