//! Raw soups as the bytes of a file, each format in its plainest form.

use crate::oracle::RawSoup;
use meshmend::formats::Encoding;
use std::fmt::Write;

/// Every encoding that [`encode`] can make.
pub(crate) const ENCODINGS: [Encoding; 7] = [
    Encoding::Obj,
    Encoding::Off,
    Encoding::PlyAscii,
    Encoding::PlyBinaryLittleEndian,
    Encoding::PlyBinaryBigEndian,
    Encoding::StlAscii,
    Encoding::StlBinary,
];

/// The bytes of `soup`. Text has the shortest decimal of each coordinate, binary PLY doubles, binary STL floats.
pub(crate) fn encode(soup: &RawSoup, encoding: Encoding) -> Vec<u8> {
    match encoding {
        Encoding::Obj => obj(soup).into_bytes(),
        Encoding::Off => off(soup).into_bytes(),
        Encoding::PlyAscii => {
            let mut text = ply_header(soup, "ascii");
            text.push_str(&points_and_faces(soup));
            text.into_bytes()
        }
        Encoding::PlyBinaryLittleEndian => {
            ply_binary(soup, "binary_little_endian", f64::to_le_bytes, u32::to_le_bytes)
        }
        Encoding::PlyBinaryBigEndian => {
            ply_binary(soup, "binary_big_endian", f64::to_be_bytes, u32::to_be_bytes)
        }
        Encoding::StlAscii => stl_ascii(soup).into_bytes(),
        Encoding::StlBinary => stl_binary(soup),
        Encoding::OffBinary | Encoding::Glb | Encoding::Gltf | Encoding::ThreeMf => {
            panic!("{encoding:?} is not written here")
        }
    }
}

fn obj(soup: &RawSoup) -> String {
    let mut text = String::new();
    for [x, y, z] in &soup.positions {
        writeln!(text, "v {x:?} {y:?} {z:?}").unwrap();
    }
    for t in &soup.triangles {
        let [a, b, c] = t.map(|v| v + 1);
        writeln!(text, "f {a} {b} {c}").unwrap();
    }
    text
}

fn points_and_faces(soup: &RawSoup) -> String {
    let mut text = String::new();
    for [x, y, z] in &soup.positions {
        writeln!(text, "{x:?} {y:?} {z:?}").unwrap();
    }
    for [a, b, c] in &soup.triangles {
        writeln!(text, "3 {a} {b} {c}").unwrap();
    }
    text
}

fn off(soup: &RawSoup) -> String {
    format!("OFF\n{} {} 0\n{}", soup.positions.len(), soup.triangles.len(), points_and_faces(soup))
}

fn ply_header(soup: &RawSoup, format: &str) -> String {
    let (vertices, faces) = (soup.positions.len(), soup.triangles.len());
    format!(
        "ply\nformat {format} 1.0\nelement vertex {vertices}\nproperty double x\nproperty double y\nproperty double z\n\
         element face {faces}\nproperty list uchar uint vertex_indices\nend_header\n"
    )
}

fn ply_binary(
    soup: &RawSoup,
    format: &str,
    double: impl Fn(f64) -> [u8; 8],
    index: impl Fn(u32) -> [u8; 4],
) -> Vec<u8> {
    let mut bytes = ply_header(soup, format).into_bytes();
    bytes.extend(soup.positions.iter().flatten().flat_map(|&x| double(x)));
    for t in &soup.triangles {
        bytes.push(3);
        bytes.extend(t.iter().flat_map(|&v| index(v)));
    }
    bytes
}

fn stl_ascii(soup: &RawSoup) -> String {
    let mut text = String::from("solid raw\n");
    for t in &soup.triangles {
        text.push_str("facet normal 0 0 0\nouter loop\n");
        for v in t {
            let [x, y, z] = soup.positions[*v as usize];
            writeln!(text, "vertex {x:?} {y:?} {z:?}").unwrap();
        }
        text.push_str("endloop\nendfacet\n");
    }
    text.push_str("endsolid raw\n");
    text
}

fn stl_binary(soup: &RawSoup) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend((soup.triangles.len() as u32).to_le_bytes());
    for t in &soup.triangles {
        bytes.extend([0; 12]);
        bytes.extend(
            t.iter().flat_map(|&v| soup.positions[v as usize]).flat_map(|x| (x as f32).to_le_bytes()),
        );
        bytes.extend([0; 2]);
    }
    bytes
}
