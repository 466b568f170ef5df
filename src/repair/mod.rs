//! Operations that change a mesh: one operation, one file; options in, what changed out. No step calls another.
//!
//! The steps work on a [`Draft`]. None of them moves a vertex except [`round`],
//! [`noise`], [`snap`], [`chordal_gaps`], [`contact`] and [`joint`], which say how far; [`unite`] says how far its new ones are from where
//! they are exactly.

pub mod chordal_gaps;
pub mod collinear;
pub mod contact;
pub mod crossing;
pub mod cut;
pub mod degenerate;
pub mod draft;
pub mod duplicates;
pub mod fill;
pub mod joint;
pub mod near_duplicates;
pub mod nest;
pub mod noise;
pub mod orient;
pub mod pair_sheets;
pub mod parts;
pub mod pinch;
pub mod polygons;
pub mod round;
pub mod selection;
pub mod snap;
pub mod stars;
pub mod stitches;
pub mod t_vertices;
pub mod thicken;
pub mod thin_faces;
pub mod unite;
pub mod weld;

use draft::VertexBeside;
pub use draft::{Blend, Blends, Draft, FIRST_BLEND, Faced, NEW};
pub use selection::Selection;
pub use stars::Star;
pub use stitches::{Join, Joins};

/// What a step changed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Changes {
    /// Named counts; all zero: nothing to do.
    pub counts: Vec<(&'static str, u64)>,
    /// Largest distance that a vertex moved, in the unit of the file.
    pub move_max: f64,
    /// What was decided, in a sentence, where there was a choice; empty otherwise.
    pub reason: String,
    /// A triangle of the soup out of each part that is gone as a whole.
    pub removed_parts: Vec<u32>,
    /// The boundary edges that became one.
    pub stitches: Joins,
    /// What became of the triangles of the soup, where bodies were united.
    pub coverage: Option<unite::Coverage>,
    /// What later attempts of a repair depend on.
    pub effects: Effects,
}

/// What steps did that decides what is tried after them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Effects {
    /// Both triangles of an opposite pair went.
    pub cancelled_opposite_pairs: bool,
    /// Vertices were copied where bodies touch or the surface is cut.
    pub copied_vertices: bool,
    /// Triangles went because they met others.
    pub removed_crossing: bool,
    /// Needles, caps or folds went.
    pub mended_thin_faces: bool,
    /// Rims that face each other got one patch between them.
    pub bridged_rims: bool,
    /// Gaps between arcs and chords were closed.
    pub closed_chordal_gaps: bool,
    /// Triangles that were turned.
    pub turned_triangles: u64,
    /// Vertices and edges in which the solid touched itself when that was bored last.
    pub bored_contacts: Option<u64>,
    /// Pairs of triangles that still meet, where bodies were united just now.
    pub meeting_pairs: u64,
}

impl Effects {
    /// Takes in those of a further step.
    pub fn add(&mut self, other: Self) {
        self.cancelled_opposite_pairs |= other.cancelled_opposite_pairs;
        self.copied_vertices |= other.copied_vertices;
        self.removed_crossing |= other.removed_crossing;
        self.mended_thin_faces |= other.mended_thin_faces;
        self.bridged_rims |= other.bridged_rims;
        self.closed_chordal_gaps |= other.closed_chordal_gaps;
        self.turned_triangles += other.turned_triangles;
        self.bored_contacts = other.bored_contacts.or(self.bored_contacts);
        self.meeting_pairs = other.meeting_pairs;
    }
}

impl Changes {
    /// These changes with their effects.
    pub fn with(self, effects: Effects) -> Self {
        Self { effects, ..self }
    }

    /// Changes that are counts alone.
    pub fn counted(counts: impl Into<Vec<(&'static str, u64)>>) -> Self {
        Self { counts: counts.into(), ..Self::default() }
    }

    /// The count of this name; 0 when the step does not count it.
    pub fn count(&self, name: &str) -> u64 {
        self.counts.iter().find(|(n, _)| *n == name).map_or(0, |&(_, count)| count)
    }
}
