//! The table of options: their names, their values, and what they do.

use super::OptionError;
use crate::wire::printing::{BuildDirection, PolicyName};
use crate::wire::words::{
    Contact, Criterion, Cut, Degenerate, Effort, FillHoles, Format, Mode, Nesting, OpenShells, Placement,
    Reader, Require, Stitch, StitchValidity, Units, VertexColors,
};

/// What values an option takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum OptionKind {
    /// One of these words.
    Word(&'static [&'static str]),
    /// A whole number in this range.
    Integer {
        /// Smallest value.
        min: u64,
        /// Largest value.
        max: u64,
    },
    /// A number in this range.
    Number {
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
    },
    /// `true` or `false`.
    Flag,
    /// A list of targets of a simplification.
    Targets,
    /// A list of edges by the numbers of their vertices.
    Edges,
    /// A plan, as `plan` and `repair` report it.
    Plan,
    /// An earlier job: `{"job":"ID"}`.
    Input,
}

/// One option.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OptionSpec {
    /// Name in queries and JSON; as a flag with hyphens.
    pub name: &'static str,
    /// Values.
    pub kind: OptionKind,
    /// What it does, and what holds when it is absent.
    pub about: &'static str,
    /// It has no meaning on the command line.
    pub is_for_service_only: bool,
}

const fn option(name: &'static str, kind: OptionKind, about: &'static str) -> OptionSpec {
    OptionSpec { name, kind, about, is_for_service_only: false }
}

/// Every option.
pub const SPECS: &[OptionSpec] = &[
    option("format", OptionKind::Word(Format::WORDS), "Format of the input. Default: told by the content."),
    option(
        "output_format",
        OptionKind::Word(Format::WORDS),
        "Format of the output. Default: that of the input.",
    ),
    option("reader", OptionKind::Word(Reader::WORDS), "Reader of OBJ files. Default: own."),
    option(
        "units",
        OptionKind::Word(Units::WORDS),
        "Unit of the coordinates. Default: mm, reported as assumed.",
    ),
    option(
        "require",
        OptionKind::Word(Require::WORDS),
        "What the result must be. Default: printable for repair, none for the other operations.",
    ),
    option(
        "fill_holes",
        OptionKind::Word(FillHoles::WORDS),
        "Whether repair fills simple holes. Default: simple.",
    ),
    option(
        "open_shells",
        OptionKind::Word(OpenShells::WORDS),
        "How open shells are read where repair must rebuild the surface. Default: auto.",
    ),
    option(
        "wrap_cells",
        OptionKind::Integer { min: 16, max: 1024 },
        "Cells along the longest side of a surface that repair must rebuild. Default: by the effort and its area.",
    ),
    option(
        "effort",
        OptionKind::Word(Effort::WORDS),
        "How fine and so how long to try where repair must rebuild the surface. Default: normal.",
    ),
    option(
        "wall_mm",
        OptionKind::Number { min: 0.0, max: 1e30 },
        "Thickness of the walls that open surfaces become, in millimetres. Default: 0.4 % of the diagonal.",
    ),
    option(
        "recenter",
        OptionKind::Flag,
        "Move a mesh that is too far from the origin for float32 there, instead of refusing it. Default: false.",
    ),
    option(
        "max_deviation_mm",
        OptionKind::Number { min: 0.0, max: 1e30 },
        "Refuse a repair farther than this from the file, in millimetres. Default: no limit.",
    ),
    option(
        "max_volume_change",
        OptionKind::Number { min: 0.0, max: 1.0 },
        "Refuse a repair that changes a defined volume by more than this share. Default: no limit.",
    ),
    option(
        "nesting",
        OptionKind::Word(Nesting::WORDS),
        "How shells inside shells are taken. Default: as_oriented.",
    ),
    option(
        "contact",
        OptionKind::Word(Contact::WORDS),
        "What repair does with bodies that touch in vertices or edges: draw them apart, or join them by necks of wall_mm. Default: open.",
    ),
    option(
        "plan",
        OptionKind::Plan,
        "What repair does about each defect: the plan that /v1/plan proposes, edited, or that of an earlier repair, whose steps then run again. Default: as /v1/plan proposes.",
    ),
    option(
        "faces",
        OptionKind::Integer { min: 1, max: u32::MAX as u64 },
        "Simplify to at most this many faces. At most one of faces, ratio, error_mm and targets.",
    ),
    option(
        "ratio",
        OptionKind::Number { min: 0.0, max: 1.0 },
        "Simplify to at most this share of the faces. Default of simplify: 0.5.",
    ),
    option(
        "error_mm",
        OptionKind::Number { min: 0.0, max: 1e30 },
        "Simplify as far as no collapse has an error above this, in millimetres.",
    ),
    option(
        "targets",
        OptionKind::Targets,
        "Several results from one run: [{\"ratio\":0.5},{\"faces\":1000},{\"error_mm\":0.1}].",
    ),
    option(
        "mode",
        OptionKind::Word(Mode::WORDS),
        "How a simplification works. Default: guarded, which a repair always uses.",
    ),
    option(
        "criterion",
        OptionKind::Word(Criterion::WORDS),
        "What the collapse of an edge costs. Default: quadric.",
    ),
    option(
        "placement",
        OptionKind::Word(Placement::WORDS),
        "Where the vertex goes that an edge becomes. Default: optimal.",
    ),
    option(
        "vertex_colors",
        OptionKind::Word(VertexColors::WORDS),
        "Colours of the vertices of a simplified mesh; priority needs format or output_format off or ply. Default: kept.",
    ),
    option(
        "cut",
        OptionKind::Word(Cut::WORDS),
        "How cut-stitch makes its cut; the result is the same. Default: auto.",
    ),
    option(
        "stitch",
        OptionKind::Word(Stitch::WORDS),
        "Which boundary edges cut-stitch joins after the cut. Default: pinch.",
    ),
    option(
        "snap_epsilon_mm",
        OptionKind::Number { min: 0.0, max: 1e30 },
        "How far apart vertices of rims may be that repair and stitch=snap join, in millimetres, but never more than half the shortest boundary edge. Default: 1e-5 of the diagonal for cut-stitch, 0 for repair.",
    ),
    option(
        "stitch_validity",
        OptionKind::Word(StitchValidity::WORDS),
        "When cut-stitch may join two boundary edges. Default: exact.",
    ),
    option(
        "degenerate",
        OptionKind::Word(Degenerate::WORDS),
        "What cut-stitch does with faces that pass a vertex more than once. Default: split.",
    ),
    option(
        "cut_edges",
        OptionKind::Edges,
        "Edges that cut-stitch cuts besides those that must be, by the numbers of their vertices from 0: [[0,1],[1,2]].",
    ),
    option(
        "policy",
        OptionKind::Word(PolicyName::WORDS),
        "Process whose limits the result, or else the file, is measured against; see /v1/policies. Default: none.",
    ),
    option(
        "build_direction",
        OptionKind::Word(BuildDirection::WORDS),
        "Direction of the file that is up in the machine; matters with policy. Default: z.",
    ),
    option(
        "near_mm",
        OptionKind::Number { min: 0.0, max: 1e30 },
        "How far apart vertices, edges and faces are at most that are reported as near, in millimetres, but never more than half the edges around them. Default: 1e-5 of the diagonal for analyze up to 100000 triangles; everything else is searched only when this is given.",
    ),
    option(
        "samples",
        OptionKind::Integer { min: 0, max: 10_000 },
        "Witnesses that the report keeps of each defect. Default: 16.",
    ),
    OptionSpec {
        is_for_service_only: true,
        ..option(
            "result_ttl",
            OptionKind::Integer { min: 1, max: 31_536_000 },
            "Seconds for which the result is kept, at most the server's own limit. Default: that limit.",
        )
    },
    OptionSpec {
        is_for_service_only: true,
        ..option("input", OptionKind::Input, "An earlier job whose upload is used again: {\"job\":\"ID\"}.")
    },
];

pub(super) fn spec_of(name: &str) -> Result<&'static OptionSpec, OptionError> {
    let names = || SPECS.iter().map(|spec| spec.name);
    SPECS
        .iter()
        .find(|spec| spec.name == name)
        .ok_or_else(|| OptionError::Unknown { name: name.to_owned(), suggestion: nearest(name, names()) })
}

/// The candidate that `word` was probably meant to be. The threshold is that of common command-line parsers: below a
/// Jaro similarity of 0.7 suggestions are noise.
pub(in crate::wire) fn nearest(
    word: &str,
    candidates: impl Iterator<Item = &'static str>,
) -> Option<&'static str> {
    let word = word.to_ascii_lowercase().replace('-', "_");
    candidates
        .map(|candidate| (strsim::jaro(&word, candidate), candidate))
        .filter(|&(similarity, _)| similarity > 0.7)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

impl OptionSpec {
    /// The option's name as a command-line flag, without the leading hyphens.
    pub fn flag(&self) -> String {
        self.name.replace('_', "-")
    }

    /// The words it takes; empty when it takes something else.
    pub fn words(&self) -> &'static [&'static str] {
        match self.kind {
            OptionKind::Word(words) => words,
            _ => &[],
        }
    }

    pub(super) fn expected(&self) -> String {
        match self.kind {
            OptionKind::Word(words) => words.join(", "),
            OptionKind::Integer { min, max } => format!("a whole number from {min} to {max}"),
            OptionKind::Number { min, max } => format!("a number from {min} to {max:e}"),
            OptionKind::Flag => "true or false".to_owned(),
            OptionKind::Edges => "1 to 100000 pairs of different vertex numbers in a list".to_owned(),
            OptionKind::Plan => "a plan as /v1/plan answers it, edited".to_owned(),
            OptionKind::Targets => {
                "1 to 16 of {\"faces\":N}, {\"ratio\":X} and {\"error_mm\":X} in a list".to_owned()
            }
            OptionKind::Input => "{\"job\":\"ID\"}".to_owned(),
        }
    }
}
