//! A mesh parted into its volumes.

use super::model::{FaceAttributes, NO_NUMBER};
use super::read_volumes::ObjectVolume;
use crate::mesh::{FaceFault, Soup};
use std::sync::Arc;

/// The faces of one volume, with the vertices that they use in their order.
pub(super) fn volume_of(
    soup: &Soup,
    attributes: &FaceAttributes,
    volume: &ObjectVolume,
) -> (Soup, FaceAttributes) {
    let range = volume.triangles.start as usize..volume.triangles.end as usize;
    let is_inside = |face: u32| volume.triangles.contains(&face);
    let first = soup.face_faults.partition_point(|fault| fault.face < volume.triangles.start);
    // Faces without a triangle are few, and ascending.
    let triangles_before = range.start - first;
    let inside = (0..soup.triangles.len() - triangles_before)
        .map(|t| t + triangles_before)
        .take_while(|&t| is_inside(soup.face_of(t as u32)));
    let triangles: Vec<(u32, [u32; 3])> =
        inside.map(|t| (soup.face_of(t as u32) - volume.triangles.start, soup.triangles[t])).collect();
    let mut used: Vec<u32> = triangles.iter().flat_map(|(_, corners)| *corners).collect();
    used.sort_unstable();
    used.dedup();
    let place = |v: u32| used.partition_point(|&other| other < v) as u32;
    let face_faults: Vec<FaceFault> = soup.face_faults[first..]
        .iter()
        .take_while(|fault| is_inside(fault.face))
        .map(|fault| FaceFault { face: fault.face - volume.triangles.start, reason: fault.reason })
        .collect();
    let part = Soup {
        positions: used.iter().map(|&v| soup.positions[v as usize]).collect(),
        triangle_face: match face_faults.is_empty() {
            true => Vec::new(),
            false => triangles.iter().map(|&(face, _)| face).collect(),
        },
        triangles: triangles.into_iter().map(|(_, corners)| corners.map(place)).collect(),
        face_count: range.len() as u32,
        face_faults,
        is_f32_exact: soup.is_f32_exact,
        units: soup.units,
        ..Soup::default()
    };
    let properties = attributes.properties.get(range.clone()).map(<[_]>::to_vec).unwrap_or_default();
    let others = attributes.others.get(range).map(<[_]>::to_vec).unwrap_or_default();
    let has_others = others.iter().any(|&number| number != NO_NUMBER);
    let texts = if has_others { Arc::clone(&attributes.texts) } else { Arc::default() };
    (part, FaceAttributes { properties, others: if has_others { others } else { Vec::new() }, texts })
}
