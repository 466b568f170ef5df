//! Reading what was written gives the same soup, bit for bit, in every encoding.

use crate::random::Random;
use crate::support::cases;
use meshmend::budget::Budget;
use meshmend::formats::{Encoding, Precision, ReadOptions, read, sniff, write};
use meshmend::geom::DVec3;
use meshmend::mesh::{Color, Soup};

const ENCODINGS: [Encoding; 8] = [
    Encoding::Obj,
    Encoding::StlBinary,
    Encoding::StlAscii,
    Encoding::Off,
    Encoding::OffBinary,
    Encoding::PlyAscii,
    Encoding::PlyBinaryLittleEndian,
    Encoding::PlyBinaryBigEndian,
];

#[test]
fn every_encoding_gives_back_what_was_written() {
    for seed in 0..cases(1_000, 50_000) as u64 {
        for encoding in ENCODINGS {
            let soup = random_soup(&mut Random::new(seed), encoding);
            let bytes = write(&soup, encoding, &Budget::unlimited()).unwrap();
            assert_eq!(sniff(&bytes, None), Ok(encoding), "seed {seed}");
            let back = read(&bytes, encoding, &ReadOptions::default(), &Budget::unlimited()).unwrap();
            assert_same(&soup, &back, encoding, seed);
            assert_eq!(
                write(&back, encoding, &Budget::unlimited()).unwrap(),
                bytes,
                "seed {seed}, {encoding:?}"
            );
            let options = ReadOptions { precision: Precision::F32, ..ReadOptions::default() };
            let as_f32 = read(&bytes, encoding, &options, &Budget::unlimited()).unwrap();
            if soup.is_f32_exact {
                assert_eq!(as_f32, back, "seed {seed}, {encoding:?}");
            } else {
                assert!(as_f32.is_f32_exact, "seed {seed}, {encoding:?}");
            }
        }
    }
}

fn bits(positions: &[DVec3]) -> Vec<[u64; 3]> {
    positions.iter().map(|p| p.to_array().map(f64::to_bits)).collect()
}

fn assert_same(soup: &Soup, back: &Soup, encoding: Encoding, seed: u64) {
    let context = format!("seed {seed}, {encoding:?}");
    assert_eq!(back.check(), Vec::<String>::new(), "{context}");
    assert_eq!(back.is_f32_exact, soup.is_f32_exact, "{context}");
    let corners = |soup: &Soup| (0..soup.triangles.len() as u32).map(|t| soup.corners(t)).collect::<Vec<_>>();
    if back.is_welded_by_format {
        // Bit for bit but for the sign of zero, which is lost where both zeros meet in one vertex.
        assert_eq!(corners(back), corners(soup), "{context}");
        return;
    }
    assert_eq!(bits(&back.positions), bits(&soup.positions), "{context}");
    assert_eq!(back.triangles, soup.triangles, "{context}");
    assert_eq!(back.vertex_colors, soup.vertex_colors, "{context}");
    if encoding.format() != meshmend::formats::Format::Obj {
        assert_eq!(back.face_colors, soup.face_colors, "{context}");
    }
}

/// A soup with coordinates of every size and with colours that `encoding` can hold exactly.
fn random_soup(random: &mut Random, encoding: Encoding) -> Soup {
    let holds_only_f32 = matches!(encoding, Encoding::StlBinary | Encoding::OffBinary);
    let is_f32_exact = holds_only_f32 || random.below(2) == 0;
    let is_stl = matches!(encoding, Encoding::StlBinary | Encoding::StlAscii);
    let vertex_count = 3 + random.below(20);
    let positions: Vec<DVec3> = (0..vertex_count)
        .map(|_| DVec3::from([(); 3].map(|()| random_coordinate(random, is_f32_exact))))
        .collect();
    let triangles: Vec<[u32; 3]> =
        (0..1 + random.below(20)).map(|_| [(); 3].map(|()| random.below(vertex_count) as u32)).collect();
    // STL holds only vertices that are used.
    let counted: Vec<DVec3> = if is_stl {
        triangles.as_flattened().iter().map(|&v| positions[v as usize]).collect()
    } else {
        positions.clone()
    };
    let is_exact = |p: &DVec3| p.to_array().iter().all(|&c| f64::from(c as f32) == c);
    let (vertex_kind, face_kind) = color_kinds(random, encoding);
    Soup {
        is_f32_exact: counted.iter().all(is_exact),
        face_count: triangles.len() as u32,
        vertex_colors: random_colors(random, vertex_kind, positions.len()),
        face_colors: random_colors(random, face_kind, triangles.len()),
        positions,
        triangles,
        ..Soup::default()
    }
}

fn random_coordinate(random: &mut Random, is_f32_exact: bool) -> f64 {
    let small = f64::from(random.between(-3, 3));
    let value = match random.below(4) {
        0 => small,
        1 => -small,
        2 => f64::from(f32::from_bits(random.bits() as u32)),
        _ => (random.unit() - 0.5) * 2f64.powi(random.between(-60, 60)),
    };
    let value = if value.is_finite() { value } else { 0.1 };
    if is_f32_exact { f64::from(value as f32) } else { value }
}

#[derive(Clone, Copy)]
enum Kind {
    None,
    Bytes(bool),
    Floats(bool),
}

fn color_kinds(random: &mut Random, encoding: Encoding) -> (Kind, Kind) {
    let any = [Kind::None, Kind::Bytes(false), Kind::Bytes(true), Kind::Floats(false), Kind::Floats(true)];
    match encoding {
        Encoding::StlBinary | Encoding::StlAscii => (Kind::None, Kind::None),
        Encoding::Obj => (random.pick(&[Kind::None, Kind::Floats(false)]), Kind::None),
        // Vertices of a COFF have four channels.
        Encoding::Off => {
            (random.pick(&[Kind::None, Kind::Bytes(true), Kind::Floats(true)]), random.pick(&any))
        }
        Encoding::OffBinary => (
            random.pick(&[Kind::None, Kind::Floats(true)]),
            random.pick(&[Kind::None, Kind::Floats(false), Kind::Floats(true)]),
        ),
        _ => (random.pick(&any), random.pick(&any)),
    }
}

fn random_colors(random: &mut Random, kind: Kind, len: usize) -> Vec<Option<Color>> {
    let len = if matches!(kind, Kind::None) { 0 } else { len };
    let color = |random: &mut Random| match kind {
        Kind::Floats(has_alpha) => {
            let mut channel = || random.unit() as f32;
            Color::Floats([channel(), channel(), channel()], has_alpha.then(&mut channel))
        }
        Kind::None | Kind::Bytes(_) => {
            let mut channel = || random.bits() as u8;
            let rgb = [channel(), channel(), channel()];
            Color::Bytes(rgb, matches!(kind, Kind::Bytes(true)).then(channel))
        }
    };
    (0..len).map(|_| Some(color(random))).collect()
}
