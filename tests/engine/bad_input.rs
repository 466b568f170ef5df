//! Broken and hostile files: a clear error or a sound soup, in bounded memory, never a panic.

use crate::support::cases;
use meshmend::budget::{Budget, StopFlag, Stopped};
use meshmend::formats::{
    Encoding, Format, ObjReader, Place, ReadError, ReadErrorKind, ReadLimits, ReadOptions, read, sniff, write,
};
use meshmend::geom::DVec3;
use meshmend::mesh::{Color, FaceFaultReason, Soup};

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

/// What a reader may charge for a file: the largest blow-up is that of the shortest face in text (three bytes).
fn bytes_max(file: &[u8]) -> u64 {
    (1 << 20) + 64 * file.len() as u64
}

/// Reads and checks what must hold whatever the file is.
fn read_safely(bytes: &[u8], encoding: Encoding, options: &ReadOptions) -> Result<Soup, ReadError> {
    let budget = Budget::new(StopFlag::default(), u64::MAX, bytes_max(bytes));
    let result = read(bytes, encoding, options, &budget);
    match &result {
        Ok(soup) => assert_eq!(soup.check(), Vec::<String>::new(), "{encoding:?}"),
        Err(error) => {
            assert!(!matches!(error.kind, ReadErrorKind::Stopped(_)), "{encoding:?}: {error}");
            let within = match error.place {
                Place::Whole => true,
                Place::Line(line) => line >= 1 && line <= bytes.len() as u64 + 1,
                Place::Byte(offset) => offset <= bytes.len() as u64,
            };
            assert!(within, "{encoding:?}: {error} in a file of {} bytes", bytes.len());
        }
    }
    result
}

/// As [`read_safely`], in every encoding that sniffing gives and in every one it does not.
fn read_in_every_way(bytes: &[u8]) {
    for named in [None, Some(Format::Obj), Some(Format::Stl), Some(Format::Off), Some(Format::Ply)] {
        if let Ok(encoding) = sniff(bytes, named) {
            let _ = read_safely(bytes, encoding, &ReadOptions::default());
        }
    }
    for encoding in ENCODINGS {
        let _ = read_safely(bytes, encoding, &ReadOptions::default());
    }
    let tobj = ReadOptions { obj_reader: ObjReader::Tobj, ..ReadOptions::default() };
    let _ = read_safely(bytes, Encoding::Obj, &tobj);
}

/// A grid of quads cut into triangles, with a colour on everything.
fn colored_grid(side: u32) -> Soup {
    let mut soup = Soup::default();
    for v in 0..side * side {
        let (x, y) = (f64::from(v % side), f64::from(v / side));
        soup.positions.push(DVec3::new(x * 0.1, y, x * y));
        soup.vertex_colors.push(Some(Color::Bytes([v as u8, 0, 255], Some(7))));
        if v % side + 1 < side && v / side + 1 < side {
            soup.triangles.extend([[v, v + 1, v + side], [v + side, v + 1, v + side + 1]]);
        }
    }
    soup.face_count = soup.triangles.len() as u32;
    soup.face_colors = vec![Some(Color::Floats([0.5, 0.25, 1.0], None)); soup.triangles.len()];
    soup
}

fn sample(encoding: Encoding) -> Vec<u8> {
    write(&colored_grid(6), encoding, &Budget::unlimited()).unwrap()
}

/// A small seeded generator (SplitMix64).
fn random_bits(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[test]
fn empty_and_blank_files_say_so() {
    for bytes in [&b""[..], b" ", b"\n\n\r\n", &vec![b' '; 8 << 20], &vec![b'\n'; 1 << 20]] {
        assert_eq!(sniff(bytes, None).unwrap_err().kind, ReadErrorKind::Empty);
        for encoding in ENCODINGS {
            assert!(read_safely(bytes, encoding, &ReadOptions::default()).is_err(), "{encoding:?}");
        }
    }
}

#[test]
fn a_file_cut_off_anywhere_is_an_error_or_a_shorter_mesh() {
    for encoding in ENCODINGS {
        let bytes = sample(encoding);
        for sixteenth in 0..16 {
            let cut = &bytes[..bytes.len() * sixteenth / 16];
            let result = read_safely(cut, encoding, &ReadOptions::default());
            // Nothing in an OBJ file says how long it is, nor does an ASCII STL file between two facets.
            if !matches!(encoding, Encoding::Obj | Encoding::StlAscii) {
                let kind = result.unwrap_err().kind;
                let is_expected =
                    matches!(kind, ReadErrorKind::Truncated | ReadErrorKind::Unparseable { .. });
                assert!(is_expected, "{encoding:?} cut at {sixteenth}/16: {kind:?}");
            }
            read_in_every_way(cut);
        }
    }
}

#[test]
fn random_bytes_and_random_changes_never_panic() {
    const TELLING: &[u8] = b"0123456789-+.eE \n\r#\\/nanif";
    let mut state = 1;
    for _ in 0..cases(300, 30_000) {
        let len = random_bits(&mut state) as usize % 2000;
        let bytes: Vec<u8> = (0..len).map(|_| random_bits(&mut state) as u8).collect();
        read_in_every_way(&bytes);
    }
    for encoding in ENCODINGS {
        let original = sample(encoding);
        for _ in 0..cases(300, 30_000) {
            let mut bytes = original.clone();
            for _ in 0..=random_bits(&mut state) % 4 {
                let at = random_bits(&mut state) as usize % bytes.len();
                match random_bits(&mut state) % 4 {
                    0 => bytes[at] = random_bits(&mut state) as u8,
                    1 => bytes[at] = TELLING[random_bits(&mut state) as usize % TELLING.len()],
                    2 => drop(bytes.remove(at)),
                    _ => {
                        let to = (at + random_bits(&mut state) as usize % 64).min(bytes.len());
                        let part = bytes[at..to].to_vec();
                        bytes.splice(at..at, part);
                    }
                }
            }
            read_in_every_way(&bytes);
        }
    }
}

#[test]
fn a_file_in_the_wrong_format_is_refused_or_empty() {
    for encoding in ENCODINGS {
        let bytes = sample(encoding);
        for named in Format::ALL {
            if named == encoding.format() {
                assert_eq!(sniff(&bytes, Some(named)), Ok(encoding));
                continue;
            }
            let result =
                sniff(&bytes, Some(named)).and_then(|e| read_safely(&bytes, e, &ReadOptions::default()));
            let error = result.expect_err(&format!("{encoding:?} as {named:?}"));
            assert!(
                !matches!(error.kind, ReadErrorKind::TooLarge { .. }),
                "{encoding:?} as {named:?}: {error}"
            );
        }
    }
}

#[test]
fn counts_of_all_ones_are_refused_by_the_name_of_the_limit() {
    let ones = u32::MAX;
    let off = format!("OFF\n{ones} {ones} 0\n0 0 0\n");
    let ply = format!(
        "ply\nformat ascii 1.0\nelement vertex {ones}\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
    );
    let mut stl = vec![0; 184];
    stl[80..84].fill(0xFF);
    let mut off_binary = b"OFF BINARY\n".to_vec();
    off_binary.extend([0xFF; 64]);
    for (bytes, encoding) in [
        (off.into_bytes(), Encoding::Off),
        (ply.clone().into_bytes(), Encoding::PlyAscii),
        (ply.replace("ascii", "binary_big_endian").into_bytes(), Encoding::PlyBinaryBigEndian),
        (off_binary, Encoding::OffBinary),
    ] {
        let error = read_safely(&bytes, encoding, &ReadOptions::default()).unwrap_err();
        assert!(error.to_string().contains("vertices_max"), "{encoding:?}: {error}");
    }
    let error = read_safely(&stl, Encoding::StlBinary, &ReadOptions::default()).unwrap_err();
    assert_eq!((error.kind, error.place), (ReadErrorKind::Truncated, Place::Byte(184)));
}

/// A face of `corners` corners in every text format.
fn polygon_files(corners: usize) -> [(String, Encoding); 3] {
    let indices = |first: usize| (0..corners).map(|i| format!(" {}", first + i % 3)).collect::<String>();
    let vertices = "0 0 0\n1 0 0\n0 1 0\n";
    let obj_vertices = vertices.lines().map(|line| format!("v {line}\n")).collect::<String>();
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        element face 1\nproperty list uint uint vertex_indices\nend_header\n";
    [
        (format!("{obj_vertices}f{}\n", indices(1)), Encoding::Obj),
        (format!("OFF\n3 1\n{vertices}{corners}{}\n", indices(0)), Encoding::Off),
        (format!("{ply}{vertices}{corners}{}\n", indices(0)), Encoding::PlyAscii),
    ]
}

#[test]
fn a_polygon_over_the_limit_is_refused_and_one_at_the_limit_is_read() {
    for (text, encoding) in polygon_files(65_537) {
        let error = read_safely(text.as_bytes(), encoding, &ReadOptions::default()).unwrap_err();
        let ReadErrorKind::TooLarge { limit_name, actual, .. } = error.kind else { panic!("{error}") };
        assert_eq!((limit_name, actual), ("polygon_corners_max", 65_537), "{encoding:?}");
        assert!(matches!(error.place, Place::Line(_)));
    }
    for (text, encoding) in polygon_files(65_536) {
        let soup = read_safely(text.as_bytes(), encoding, &ReadOptions::default()).unwrap();
        assert_eq!(soup.triangles.len(), 65_534, "{encoding:?}");
    }
}

#[test]
fn a_comb_of_as_many_corners_as_allowed_is_split() {
    const TEETH: u32 = 16_384;
    let mut text = String::new();
    for tooth in 0..2 * TEETH {
        text += &format!("v {tooth} {} 0\n", 100 * (tooth % 2));
    }
    for tooth in (0..2 * TEETH).rev() {
        text += &format!("v {tooth} {} 0\n", 100 * (tooth % 2) + 50);
    }
    text += "f";
    for corner in 1..=4 * TEETH {
        text += &format!(" {corner}");
    }
    let soup = read_safely(text.as_bytes(), Encoding::Obj, &ReadOptions::default()).unwrap();
    assert_eq!((soup.triangles.len(), &soup.polygons.not_fans[..]), (65_534, &[0][..]));
    let area = |t: u32| {
        let [a, b, c] = soup.corners(t);
        (b - a).cross(c - a).z
    };
    assert!((0..soup.triangles.len() as u32).all(|t| area(t) > 0.0));
}

#[test]
fn a_hub_with_65536_triangles_is_read() {
    let rim: Vec<DVec3> =
        (0..65_536).map(|i| DVec3::new(f64::from(i), f64::from(i * (i % 7)), 1.0)).collect();
    let triangles: Vec<[u32; 3]> = (1..=65_536).map(|i| [0, i, i % 65_536 + 1]).collect();
    let positions = [vec![DVec3::ZERO], rim].concat();
    let soup = Soup { positions, triangles, face_count: 65_536, ..Soup::default() };
    for encoding in ENCODINGS {
        let bytes = write(&soup, encoding, &Budget::unlimited()).unwrap();
        let back = read_safely(&bytes, encoding, &ReadOptions::default()).unwrap();
        assert_eq!(back.triangles.len(), 65_536, "{encoding:?}");
    }
}

#[test]
fn nan_everywhere_is_a_soup_without_triangles_that_names_every_vertex_and_face() {
    for encoding in ENCODINGS {
        let bytes = nan_for_every_coordinate(encoding);
        let soup = read_safely(&bytes, encoding, &ReadOptions::default()).unwrap();
        assert!(soup.triangles.is_empty(), "{encoding:?}");
        assert_eq!(soup.face_faults.len(), soup.face_count as usize, "{encoding:?}");
        assert!(soup.face_faults.iter().all(|f| f.reason == FaceFaultReason::NonFinite), "{encoding:?}");
        assert_eq!(soup.non_finite_vertices.len(), soup.positions.len(), "{encoding:?}");
    }
}

/// A mesh of two triangles written with a recognisable number as every coordinate, which is then replaced.
fn nan_for_every_coordinate(encoding: Encoding) -> Vec<u8> {
    const MARK: f32 = 123.5;
    let soup = Soup {
        positions: vec![DVec3::splat(MARK.into()); 4],
        triangles: vec![[0, 1, 2], [2, 1, 3]],
        face_count: 2,
        ..Soup::default()
    };
    let bytes = write(&soup, encoding, &Budget::unlimited()).unwrap();
    let little = (MARK.to_le_bytes().to_vec(), f32::NAN.to_le_bytes().to_vec());
    let big = (MARK.to_be_bytes().to_vec(), f32::NAN.to_be_bytes().to_vec());
    let (from, to) = match encoding {
        Encoding::StlBinary | Encoding::PlyBinaryLittleEndian => little,
        Encoding::OffBinary | Encoding::PlyBinaryBigEndian => big,
        _ => (b"123.5".to_vec(), b"nan".to_vec()),
    };
    let mut out = Vec::new();
    let mut rest = &bytes[..];
    while let Some((&first, later)) = rest.split_first() {
        if let Some(after) = rest.strip_prefix(&from[..]) {
            out.extend(&to);
            rest = after;
        } else {
            out.push(first);
            rest = later;
        }
    }
    out
}

#[test]
fn limits_on_triangles_and_vertices_hold_in_every_encoding() {
    for encoding in ENCODINGS {
        let bytes = sample(encoding);
        for (limits, name) in [
            (ReadLimits { triangles_max: 49, ..ReadLimits::default() }, "triangles_max"),
            (ReadLimits { vertices_max: 35, ..ReadLimits::default() }, "vertices_max"),
        ] {
            let options = ReadOptions { limits, ..ReadOptions::default() };
            let error = read_safely(&bytes, encoding, &options).unwrap_err().to_string();
            assert!(error.contains(name), "{encoding:?}: {error}");
        }
        let limits = ReadLimits { triangles_max: 50, vertices_max: 36, ..ReadLimits::default() };
        assert!(read_safely(&bytes, encoding, &ReadOptions { limits, ..ReadOptions::default() }).is_ok());
    }
}

#[test]
fn a_stopped_run_reads_and_writes_nothing() {
    for encoding in ENCODINGS {
        let bytes = sample(encoding);
        let stop = StopFlag::default();
        let budget = Budget::new(stop.clone(), u64::MAX, u64::MAX);
        stop.cancel();
        let error = read(&bytes, encoding, &ReadOptions::default(), &budget).unwrap_err();
        assert_eq!(error.kind, ReadErrorKind::Stopped(Stopped::Cancelled), "{encoding:?}");
        assert!(write(&colored_grid(6), encoding, &budget).is_err(), "{encoding:?}");
        let poor = Budget::new(StopFlag::default(), u64::MAX, 100);
        let error = read(&bytes, encoding, &ReadOptions::default(), &poor).unwrap_err();
        assert!(
            matches!(error.kind, ReadErrorKind::Stopped(Stopped::Memory { limit: 100, .. })),
            "{encoding:?}"
        );
    }
}
