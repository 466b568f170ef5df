//! Codes of reports in the words of somebody who wants a print.

/// What a defect means for the print.
pub(super) fn defect(code: &str) -> &'static str {
    match code {
        "no-triangle" => "The file has no surface at all.",
        "non-finite-vertex" => "Some points have no proper position.",
        "non-finite-face" => "Some faces use points without a proper position.",
        "index-out-of-range" => "Some faces name points that are not in the file.",
        "too-few-corners" => "Some faces have fewer than three corners.",
        "non-planar-polygon" => "Some faces are not flat, so programs may read them differently.",
        "concave-polygon" => "Some faces have notches, so programs may read them differently.",
        "coincident-corners" => "Some faces have two corners at one place.",
        "collinear-face" => "Some faces are as thin as a line.",
        "needle" => "Some faces are as thin as needles.",
        "cap" => "Some faces are almost as thin as a line.",
        "duplicate-face" => "Some faces are there more than once.",
        "opposite-duplicate-face" => "Some walls have two sides and nothing between them.",
        "isolated-vertex" => "Some points belong to no face.",
        "isolated-edge" => "Some lines belong to no face.",
        "duplicate-vertex" => "Some points are there more than once.",
        "isolated-face" => "Some faces hang in the air on their own.",
        "boundary-loop" => "The surface has holes or open rims: it is not watertight.",
        "non-manifold-edge" => "At some edges more than two faces meet.",
        "non-manifold-vertex" => "At some points several parts touch in nothing but the point.",
        "orientation-conflict" => "Neighbouring faces do not agree which side is outside.",
        "non-orientable" => "The surface has one side only, like a twisted band.",
        "folded-edge" => "Some neighbouring faces are folded onto each other.",
        "inverted-shell" => "A part is inside out.",
        "misnested-shell" => "A part lies hidden inside another one.",
        "zero-volume-shell" => "A part encloses no volume.",
        "double-skin" => "A part has two sides with next to nothing between them.",
        "open-sheet" => "A part is a surface without thickness.",
        "noise-shell" => "Some parts are tiny beside the rest.",
        "self-intersection" => "Parts of the surface pass through each other.",
        "overlap" => "Parts of the surface lie on each other.",
        "touch" => "Parts of the surface touch each other.",
        "near" => "Parts of the surface almost touch each other.",
        "unsound-reading" => "The file is sound only for some programs.",
        _ => "Something else is wrong.",
    }
}

/// A defect as the cause of a change, in a few words; of another code its words.
pub(super) fn cause(code: &str) -> String {
    let told = match code {
        "boundary-loop" => "open rims",
        "self-intersection" => "parts that pass through each other",
        "overlap" => "parts that lie on each other",
        "touch" => "parts that touch",
        "near" => "parts that almost touch",
        "duplicate-vertex" => "points that are there more than once",
        "duplicate-face" => "faces that are there more than once",
        "opposite-duplicate-face" => "walls without thickness",
        "non-manifold-edge" => "edges of more than two faces",
        "non-manifold-vertex" => "points where parts touch",
        "orientation-conflict" => "neighbours that disagree which side is outside",
        "folded-edge" => "folded faces",
        "inverted-shell" => "parts inside out",
        "misnested-shell" => "parts hidden inside others",
        "zero-volume-shell" => "parts without volume",
        "double-skin" => "two sides with next to nothing between them",
        "open-sheet" => "surfaces without thickness",
        "noise-shell" => "tiny parts",
        "needle" | "cap" | "collinear-face" => "faces as thin as a line",
        "coincident-corners" => "faces with two corners at one place",
        "isolated-vertex" => "points without a face",
        "isolated-edge" => "lines without a face",
        "isolated-face" => "single faces",
        "non-planar-polygon" | "concave-polygon" => "faces that programs read differently",
        "unsound-reading" => "programs that read the file differently",
        code => return code.replace(['-', '_'], " "),
    };
    told.to_owned()
}

/// What a boundary loop may be.
pub(super) fn hole(class: &str) -> &'static str {
    match class {
        "crack" => "A crack: two rims that nearly meet",
        "missing-face" => "A face is missing",
        "planar-cut" => "A flat hole",
        "missing-region" => "A part of the surface is missing",
        "intended-opening" => "An opening that may be meant: the border of a sheet, or a mouth",
        _ => "A rim that ends where more than two faces meet",
    }
}

/// Why a patch was not taken.
pub(super) fn rejection(reason: &str) -> &'static str {
    match reason {
        "no-patch" => "no triangles could be made",
        "too-large" => "the hole is too large for it",
        "no-fit" => "no smooth surface fits",
        "too-few-points" => "too little is around the hole",
        "no-room" => "another wall lies in the same place",
        "singular" | "inexact" => "the surface could not be computed well enough",
        "no-zero" => "the surface does not span the hole",
        "flat-sheet" => "it would lie on the flat surface that the hole is the rim of",
        "degenerate-triangle" => "a face without area",
        "topology" => "its edge would not be exactly that of the hole",
        "edge-in-use" => "it would double an edge or a face",
        "meets-other" => "it would meet the rest of the part",
        "meets-itself" => "it would meet itself",
        _ => "its corners cannot be written",
    }
}

/// What became of the file.
pub(super) fn outcome(word: &str) -> &'static str {
    match word {
        "identical" => "The file was sound already and is returned unchanged.",
        "converted" => "The file was sound and is returned in another format.",
        "repaired" => "The file was mended in a few places.",
        "rebuilt" => "The surface was rebuilt, because mending single places was not enough.",
        "simplified" => "The file was written with fewer triangles.",
        "cut-stitched" => "The surface was cut where more than two faces meet, and joined again as asked.",
        "filled" => "Holes were closed as asked, where a sound patch was found.",
        "modelled" => "The solid was edited by its planes, as asked.",
        "combined" => "Several solids were combined into one, as asked.",
        "partial" => "The best result there is was returned, although it is not sound.",
        "refused" => "No result is returned.",
        _ => "The file was only looked at.",
    }
}

/// How true the result is to the file, or of several solids to what they become; empty without a result.
pub(super) fn fidelity(word: &str, is_combined: bool) -> &'static str {
    match word {
        "exact" if is_combined => "It is exactly what they become.",
        "faithful" if is_combined => "It is what they become, moved by no more than small limits.",
        "exact" => "Its surface is exactly that of your file.",
        "faithful" => "Nothing that can be seen was lost, made up or moved beyond small limits.",
        "changed" => "It is not the same as your file:",
        _ => "",
    }
}

/// What a step of a repair does; of another code its words.
pub(super) fn step(code: &str) -> String {
    let told = match code {
        "take-usable" => "What programs cannot use was left out.",
        "taken_over" => "New faces have the colours, texture and materials of those beside them.",
        "left_out" => "What the new file cannot hold was left out.",
        "split-polygons" => "Faces that programs read differently were split into triangles.",
        "join-over-noise" => "Points that only rounding kept apart were made one.",
        "clear-noise" => "Coordinates that are all but zero became zero.",
        "round-to-float32" | "round-where-it-matters" => {
            "Positions were rounded to what the format can hold."
        }
        "weld" => "Points at one place became one.",
        "drop-degenerate" => "Faces without area were left out.",
        "split-collinear" | "split-t-vertices" => "Faces were split where a point lies on their edge.",
        "drop-duplicates" | "drop-near-duplicates" => "Faces that were there more than once were left out.",
        "orient" => "Faces were turned so that all show their outside.",
        "cut" => "The surface was cut where more than two faces meet.",
        "pinch" | "snap" => "Edges that belong together were joined.",
        "remove-crossing" => "Faces that pass through others were taken out.",
        "pair-sheets" => "Two sides of a wall were joined at their rims.",
        "join-contacts" => "Parts that touch were joined by necks.",
        "span-rims" | "span-odd-edges" => "Open rims were spanned.",
        "unite" | "unite-and-copy-bare" => "Parts that pass through each other became one.",
        "enclose" | "enclose-and-copy-bare" => "What the surface encloses became solid.",
        "bore-contacts" | "open-contacts" => "Parts that touch were drawn apart a little.",
        "round-to-coarser" => "Corners where parts touch were moved a little.",
        "close-chordal-gaps" => "Narrow gaps beside round edges were closed.",
        "turn-to-bridge" => "Parts were turned so that their open edges fit those of others.",
        "fill-holes" => "Holes were closed.",
        "mend-thin-faces" => "Faces as thin as needles were mended.",
        "thicken" => "Surfaces without thickness became walls.",
        "join-copies" => "Copies of one part were joined.",
        "nest" => "Parts inside others were turned the right way or left out.",
        "remove-parts" => "Parts were removed as asked.",
        "rebuild" | "wrap" => "The surface was rebuilt.",
        "recenter" => "Everything was moved to the origin, as allowed.",
        "union" => "The solids were united.",
        "intersection" => "What all solids share was kept.",
        "difference" => "The further solids were taken out of the first.",
        "simplify" => "The surface was written with fewer triangles.",
        code => return code.replace(['-', '_'], " "),
    };
    told.to_owned()
}

/// What a check for printing is about.
pub(super) fn check(code: &str) -> &'static str {
    match code {
        "wall-thickness" => "Wall thickness",
        "gap" => "Gaps",
        "small-feature" => "Small parts",
        "overhang" => "Overhangs",
        "sharp-edge" => "Sharp edges",
        "trapped-cavity" => "Trapped cavities",
        "build-volume" => "Size",
        _ => "Other",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::{CheckCode, DefectCode, HoleClass, Outcome};

    #[test]
    fn every_code_has_plain_words_of_its_own() {
        assert!(DefectCode::WORDS.iter().all(|code| defect(code) != defect("")));
        assert!(HoleClass::WORDS.iter().all(|class| hole(class) != hole("")));
        assert!(Outcome::WORDS.iter().all(|word| outcome(word) != outcome("")));
        assert!(CheckCode::WORDS.iter().all(|code| check(code) != check("")));
    }
}
