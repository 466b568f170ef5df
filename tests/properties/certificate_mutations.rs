//! Every single face and every single vertex of valid solids, spoiled in turn.

use crate::certificate_soups::{assert_agreement, verify};
use crate::oracle::RawSoup;
use crate::random::Random;
use crate::solids::{cube, prism, ring, star, tetrahedron, voxels};
use crate::support::on_all_cores;
use meshmend::certificate::Depth;
use meshmend::formats::Encoding;

/// Small solids of every kind there is: convex and not, round and thin, with a hole, with a cavity, in several parts.
fn valid_solids() -> Vec<(&'static str, RawSoup)> {
    let mut random = Random::new(7);
    let bumpy = star(&mut || 1.0 + random.below(8) as f64 / 4.0);
    let stair = voxels(&[[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 0, 1]]);
    let hollow = cube().scaled(4.0).with(&cube().scaled(2.0).moved([1.0; 3]).inside_out());
    let island = hollow.clone().with(&tetrahedron().scaled(0.5).moved([1.5; 3]));
    let pair = cube().with(&tetrahedron().moved([1.5, 0.0, 0.0]));
    vec![
        ("tetrahedron", tetrahedron()),
        ("cube", cube()),
        ("octahedron", star(&mut || 1.0)),
        ("bumpy ball", bumpy),
        ("ring", ring()),
        ("stair", stair),
        ("thin prism", prism(1e-3)),
        ("cube with a cavity", hollow),
        ("solid in a cavity", island),
        ("two parts", pair),
        ("cube of thirds", cube().scaled(1.0 / 3.0).moved([0.1, 100.7, -3.3])),
    ]
}

/// Indices as they are, and none.
const ENCODINGS: [Encoding; 2] = [Encoding::Off, Encoding::StlBinary];

fn is_valid(soup: &RawSoup, encoding: Encoding) -> bool {
    verify(soup, encoding, Depth::FirstViolation).is_printable()
}

#[test]
fn certificate_accepts_the_solids_that_are_spoiled_here() {
    for (name, solid) in valid_solids() {
        for encoding in ENCODINGS {
            assert!(assert_agreement(&solid, encoding, name).is_valid(), "{name}");
        }
    }
}

#[test]
fn certificate_rejects_every_solid_without_one_of_its_faces_or_with_one_flipped_or_doubled() {
    let mut count = 0;
    for (name, solid) in valid_solids() {
        for t in 0..solid.triangles.len() {
            let [a, b, c] = solid.triangles[t];
            let mut without = solid.clone();
            without.triangles.remove(t);
            let mut flipped = solid.clone();
            flipped.triangles[t] = [a, c, b];
            let mut doubled = solid.clone();
            doubled.triangles.push([b, c, a]);
            let mut lined = solid.clone();
            lined.triangles.push([a, c, b]);
            for (i, spoiled) in [without, flipped, doubled, lined].iter().enumerate() {
                for encoding in ENCODINGS {
                    assert!(!is_valid(spoiled, encoding), "{name}, face {t}, change {i}: {spoiled:?}");
                    count += 1;
                }
            }
        }
    }
    println!("| single faces removed, flipped or doubled | {count} | all rejected |");
}

#[test]
fn certificate_rejects_or_rightly_accepts_every_solid_with_one_vertex_moved() {
    let moved: Vec<(&str, RawSoup)> = valid_solids()
        .into_iter()
        .flat_map(|(name, solid)| {
            (0..solid.positions.len()).flat_map(move |v| moves(&solid, v)).map(move |soup| (name, soup))
        })
        .collect();
    let verdicts = on_all_cores(moved.len(), |i| {
        let (name, soup) = &moved[i];
        assert_agreement(soup, ENCODINGS[i % 2], name).is_valid()
    });
    let accepted = verdicts.iter().filter(|&&is_valid| is_valid).count();
    let rejected = verdicts.len() - accepted;
    println!("| single vertices moved | {} | {rejected} rejected, {accepted} proved valid |", moved.len());
    assert!(
        accepted * 10 > moved.len() && rejected * 10 > moved.len(),
        "{accepted} of {} valid",
        moved.len()
    );
}

/// The solid with vertex `v` on other vertices, on and through faces, in the middle of everything, and hardly moved.
fn moves(solid: &RawSoup, v: usize) -> Vec<RawSoup> {
    let here = solid.positions[v];
    let mut places = vec![solid.positions[(v + 1) % solid.positions.len()], solid.positions[0]];
    for t in solid.triangles.iter().step_by(1 + solid.triangles.len() / 4) {
        let corners = t.map(|w| solid.positions[w as usize]);
        let middle: [f64; 3] = std::array::from_fn(|k| corners.iter().map(|p| p[k] / 3.0).sum());
        let edge: [f64; 3] = std::array::from_fn(|k| (corners[0][k] + corners[1][k]) / 2.0);
        let through = std::array::from_fn(|k| here[k] + 1.25 * (middle[k] - here[k]));
        places.extend([middle, edge, through]);
    }
    for (axis, by) in [(0, 1e-7), (1, -1e-7), (2, 0.25), (0, -0.25), (1, 3.0), (2, -40.0)] {
        let mut place = here;
        place[axis] += by;
        places.push(place);
    }
    let moved = |place| {
        let mut soup = solid.clone();
        soup.positions[v] = place;
        soup
    };
    places.into_iter().filter(|&place| place != here).map(moved).collect()
}
