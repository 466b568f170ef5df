//! The OBJ reader against the `tobj` crate: the same faces at the same float32 positions.

use crate::random::Random;
use crate::support::{cases, corpus_files};
use meshmend::budget::Budget;
use meshmend::formats::{Encoding, ObjReader, Precision, ReadOptions, read};
use meshmend::mesh::Soup;
use std::fmt::Write;

/// The corners' positions of every face that was read, face by face.
fn faces_by_position(soup: &Soup) -> Vec<Vec<[u64; 3]>> {
    let at = |v: u32| soup.positions[v as usize].to_array().map(f64::to_bits);
    let polygons = &soup.polygons;
    let mut faces = Vec::new();
    let (mut t, mut polygon) = (0, 0);
    while t < soup.triangles.len() {
        if polygons.first_triangles.get(polygon) == Some(&(t as u32)) {
            let corners = polygons.starts[polygon] as usize..polygons.starts[polygon + 1] as usize;
            (t, polygon) = (t + corners.len() - 2, polygon + 1);
            faces.push(polygons.corners[corners].iter().map(|&v| at(v)).collect());
        } else {
            faces.push(soup.triangles[t].map(at).to_vec());
            t += 1;
        }
    }
    faces
}

/// Whether both readers find the same faces; `None` if `tobj` refuses the file.
fn readers_agree(bytes: &[u8]) -> Option<bool> {
    let options =
        |obj_reader| ReadOptions { obj_reader, precision: Precision::F32, ..ReadOptions::default() };
    let read = |reader| read(bytes, Encoding::Obj, &options(reader), &Budget::unlimited());
    let theirs = read(ObjReader::Tobj).ok()?;
    let ours = read(ObjReader::Own).unwrap();
    Some(faces_by_position(&ours) == faces_by_position(&theirs))
}

#[test]
fn tobj_finds_the_same_faces_in_real_files() {
    let Some(files) = corpus_files(&["obj"]) else { return };
    let mut compared = 0;
    for path in &files {
        let bytes = std::fs::read(path).unwrap();
        // Lines of three and more points are faces for tobj.
        let is_kept = |line: &&[u8]| !line.trim_ascii_start().starts_with(b"l ");
        let kept: Vec<&[u8]> = bytes.split_inclusive(|&b| b == b'\n').filter(is_kept).collect();
        let agree = readers_agree(&kept.concat());
        assert_ne!(agree, Some(false), "{}", path.display());
        compared += usize::from(agree.is_some());
    }
    assert!(compared * 10 > files.len() * 9, "tobj read only {compared} of {} files", files.len());
}

#[test]
fn tobj_finds_the_same_faces_in_random_files() {
    for seed in 0..cases(2_000, 100_000) as u64 {
        let text = random_obj(&mut Random::new(seed));
        assert_eq!(readers_agree(text.as_bytes()), Some(true), "seed {seed}:\n{text}");
    }
}

/// A valid file with statements in random order and every notation that both readers know.
fn random_obj(random: &mut Random) -> String {
    let line_end = random.pick(&["\n", "\r\n"]);
    // tobj wants a colour for all vertices or for none.
    let after_position = random.pick(&["", " ", " 1 0.5 0.25"]);
    let mut text = String::new();
    let mut vertices = 0;
    for _ in 0..random.between(5, 60) {
        match random.below(10) {
            0..4 => {
                text.push('v');
                for _ in 0..3 {
                    text.push_str(random.pick(&[" ", "  ", "\t"]));
                    text.push_str(&random_decimal(random));
                }
                text.push_str(after_position);
                vertices += 1;
            }
            4..8 if vertices >= 3 => {
                text.push('f');
                for _ in 0..random.pick(&[3, 3, 3, 4, 5, 8]) {
                    let vertex = random.below(vertices) as i64;
                    let number = if random.below(2) == 0 { vertex + 1 } else { vertex - vertices as i64 };
                    write!(text, " {number}").unwrap();
                }
            }
            8 => text.push_str(random.pick(&["o a", "g b c", "usemtl m", "s off", "g"])),
            _ => text.push_str(random.pick(&["", "# v 1 2 3", "   ", "unknown 1 2"])),
        }
        text.push_str(line_end);
    }
    // tobj sees nothing in a file without faces.
    for statement in ["v 0 0 0", "v 1 0 0", "v 0 1 0"] {
        text.push_str(&[statement, after_position, line_end].concat());
    }
    text.push_str("f -3 -2 -1");
    text
}

fn random_decimal(random: &mut Random) -> String {
    let value = f32::from_bits(random.bits() as u32);
    let value = if value.is_finite() { value } else { 0.5 };
    match random.below(4) {
        0 => format!("{}", random.between(-20, 20)),
        1 => format!("{:.6}", (random.unit() - 0.5) * 1000.0),
        2 => format!("{value:e}"),
        // More digits than a float32 has.
        _ => format!("{:.17}", random.unit()),
    }
}
