//! What became of a file.

/// What became of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Outcome {
    /// Already valid; the same bytes.
    Identical,
    /// Valid; another format.
    Converted,
    /// Valid after local edits.
    Repaired,
    /// Valid; the surface was rebuilt within the distance that is reported.
    Rebuilt,
    /// Fewer triangles, as asked; the certificate says what holds.
    Simplified,
    /// Cut and stitched, as asked; the certificate says what holds.
    CutStitched,
    /// Holes closed, as asked and as far as sound patches were found; the certificate says what holds.
    Filled,
    /// Edited by its planes, as asked; the certificate says what holds.
    Modelled,
    /// Valid; several solids became one, as asked.
    Combined,
    /// Not valid; only on request.
    Partial,
    /// No result.
    Refused,
}
