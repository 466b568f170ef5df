//! Hole filling on torn solids, judged by all pairs in rational arithmetic.

use crate::oracle::{Opinion, RawSoup, judge_welded};
use crate::random::Random;
use crate::solids::{any_solid, star};
use crate::support::cases;
use meshmend::budget::Budget;
use meshmend::geom::DVec3;
use meshmend::par;
use meshmend::repair::{Draft, fill, weld};
use std::collections::BTreeMap;

fn draft(soup: &RawSoup) -> Draft {
    let mut draft = Draft {
        positions: soup.positions.iter().copied().map(DVec3::from_array).collect(),
        vertex_origin: (0..soup.positions.len() as u32).collect(),
        triangles: soup.triangles.clone(),
        triangle_origin: (0..soup.triangles.len() as u32).collect(),
        two_sided: Vec::new(),
        blends: Default::default(),
        polygons: Default::default(),
    };
    weld::weld(&mut draft, &Budget::unlimited()).unwrap();
    draft.drop_unused_vertices();
    draft
}

fn raw(draft: &Draft) -> RawSoup {
    RawSoup {
        positions: draft.positions.iter().map(DVec3::to_array).collect(),
        triangles: draft.triangles.clone(),
    }
}

/// Edges with one triangle, and edges with more than two.
fn open_and_crowded_edges(soup: &RawSoup) -> (usize, usize) {
    let mut edges: BTreeMap<(u32, u32), usize> = BTreeMap::new();
    for &[a, b, c] in &soup.triangles {
        for (u, v) in [(a, b), (b, c), (c, a)] {
            *edges.entry((u.min(v), u.max(v))).or_default() += 1;
        }
    }
    (edges.values().filter(|&&n| n == 1).count(), edges.values().filter(|&&n| n > 2).count())
}

/// A solid with some triangles gone, sometimes warped, sometimes with stray ones.
fn torn(random: &mut Random) -> RawSoup {
    let mut soup = any_solid(random);
    if random.one_in(3) {
        for x in soup.positions.iter_mut().flatten() {
            *x += f64::from(random.between(-2, 2)) / 16.0;
        }
    }
    for _ in 0..1 + random.below(soup.triangles.len() / 2) {
        soup.triangles.swap_remove(random.below(soup.triangles.len()));
    }
    if random.one_in(3) {
        for _ in 0..1 + random.below(2) {
            let mut corner = || random.below(soup.positions.len()) as u32;
            let stray = [corner(), corner(), corner()];
            if stray[0] != stray[1] && stray[1] != stray[2] && stray[2] != stray[0] {
                soup.triangles.push(stray);
            }
        }
        soup.triangles.retain({
            let soup = soup.clone();
            move |t| judge_welded(&RawSoup { triangles: vec![*t], ..soup.clone() }).degenerate == 0
        });
    }
    soup
}

#[test]
fn patches_close_holes_and_add_no_defect() {
    let mut random = Random::new(6);
    let (mut filled, mut left, mut valid) = (0, 0, 0);
    for case in 0..cases(600, 30_000) {
        let torn = torn(&mut random);
        let mut mesh = draft(&torn);
        let before = raw(&mesh);
        let changes = fill::fill_holes(&mut mesh, &Budget::unlimited()).unwrap();
        let after = raw(&mesh);
        assert_eq!(after.triangles[..before.triangles.len()], before.triangles, "case {case}");
        assert_eq!(after.positions, before.positions, "case {case}");

        let (was, is) = (judge_welded(&before), judge_welded(&after));
        let defects = |o: &Opinion| [o.degenerate, o.duplicate, o.edges_in_one_direction, o.contacts];
        assert_eq!(defects(&is), defects(&was), "case {case}: {torn:?}");
        let ((open, crowded), (still_open, still_crowded)) =
            (open_and_crowded_edges(&before), open_and_crowded_edges(&after));
        assert_eq!(crowded, still_crowded, "case {case}: {torn:?}");
        assert!(still_open + 3 * changes.count("holes_filled") as usize <= open, "case {case}: {torn:?}");
        filled += changes.count("holes_filled");
        left += changes.count("holes_left");
        valid += u64::from(is.is_valid());
    }
    assert!(filled > 400 && left > 50 && valid > 200, "{filled} filled, {left} left, {valid} valid");
}

#[test]
fn a_star_with_one_connected_hole_is_always_closed_into_a_solid_if_the_hole_is_small() {
    let mut random = Random::new(7);
    for case in 0..cases(300, 5_000) {
        let mut solid = star(&mut || 1.0 + random.below(8) as f64 / 8.0);
        let gone = random.below(solid.triangles.len());
        solid.triangles.remove(gone);
        let mut mesh = draft(&solid);
        fill::fill_holes(&mut mesh, &Budget::unlimited()).unwrap();
        assert!(judge_welded(&raw(&mesh)).is_valid(), "case {case}: {solid:?}");
    }
}

#[test]
fn patches_do_not_depend_on_the_number_of_threads() {
    let mut random = Random::new(8);
    for case in 0..cases(50, 1_000) {
        let torn = torn(&mut random);
        let fill = |threads: usize| {
            par::with_threads(threads, || {
                let mut mesh = draft(&torn);
                fill::fill_holes(&mut mesh, &Budget::unlimited()).unwrap();
                mesh
            })
        };
        let alone = fill(1);
        assert_eq!(alone, fill(2), "case {case}");
        assert_eq!(alone, fill(8), "case {case}");
    }
}
