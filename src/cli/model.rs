//! What the modeller found and did, as tables for people.

use super::figures::counted;
use crate::figures::{figure, significant};
use crate::wire::{FaceInfo, FaceRangeInfo, Modeller, ModellerStep, RangeSideInfo};

/// Most faces of which a screen tells.
const FACES_TOLD: usize = 64;

/// Digits of how far a face moved: with fewer a move just inside an open interval reads as its end.
const LENGTH_DIGITS: usize = 12;

/// The polyhedron in a line; none where the mesh is none.
pub(super) fn size(model: &Modeller) -> Option<String> {
    let read = model.polyhedron.as_ref()?;
    let mut text = format!(
        "{}, {}, {}, {}",
        counted(read.faces, "face"),
        counted(read.edges, "edge"),
        counted(read.vertices, "vertex"),
        counted(read.shells, "shell")
    );
    for (count, name) in
        [(read.interior_loops, "interior loop"), (read.through_holes.unwrap_or(0), "through-hole")]
    {
        if count > 0 {
            text.push_str(&format!(", {}", counted(count, name)));
        }
    }
    if model.tolerant_faces > 0 {
        text.push_str(&format!(
            "; {} joined within {}, {} moved by at most {}",
            counted(model.tolerant_faces, "face"),
            figure(model.tolerance),
            counted(model.vertices_moved, "vertex"),
            figure(model.move_max)
        ));
    }
    Some(text)
}

/// An operator that was applied.
pub(super) fn step_row(step: &ModellerStep) -> [String; 3] {
    let moved: Vec<String> = step
        .moved
        .iter()
        .map(|m| format!("face {} by {} mm", m.face, significant(m.by_mm, LENGTH_DIGITS)))
        .collect();
    let changes = [(step.merged, "merged"), (step.split, "split")];
    let changes: Vec<String> = changes
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, what)| format!("{count} {what}"))
        .collect();
    let valid = match step.validity.is_valid {
        true => "valid".to_owned(),
        false => {
            let broken: Vec<&str> = step.validity.broken.iter().map(|rule| rule.word()).collect();
            format!("broken: {}", broken.join(", "))
        }
    };
    let told: Vec<String> = changes.into_iter().chain([valid]).collect();
    [step.operator.to_string(), moved.join(", "), told.join(", ")]
}

/// An interval.
pub(super) fn range_row(range: &FaceRangeInfo) -> [String; 3] {
    let faces: Vec<String> = range.faces.iter().map(|f| f.face.to_string()).collect();
    let side = |side: &RangeSideInfo| {
        let limit =
            side.limit_mm.map_or_else(|| "no limit".to_owned(), |limit| format!("{} mm", figure(limit)));
        let blocking = side.blocking.first().map(|b| format!(" ({})", b.kind)).unwrap_or_default();
        format!("{limit}{blocking}")
    };
    [format!("face {}", faces.join(" ")), side(&range.inward), side(&range.outward)]
}

/// The first faces.
pub(super) fn face_rows(faces: &[FaceInfo]) -> Vec<[String; 4]> {
    let row = |face: &FaceInfo| {
        [
            face.face.to_string(),
            format!("normal {}", face.normal.map(figure).join(" ")),
            format!("at {}", face.corner.map(figure).join(" ")),
            counted(face.sides, "side"),
        ]
    };
    faces.iter().take(FACES_TOLD).map(row).collect()
}
