//! The first word of an OFF file, which says what stands with each vertex.

/// A header word: `[ST][C][N][4][n]OFF`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::formats) struct HeaderWord<'a> {
    /// Two texture coordinates follow everything else of a vertex.
    pub(in crate::formats) has_texture: bool,
    /// A colour follows position and normal.
    pub(in crate::formats) has_colors: bool,
    /// A normal follows the position.
    pub(in crate::formats) has_normals: bool,
    /// Points have other than three coordinates, which no printable mesh has.
    pub(in crate::formats) has_other_dimension: bool,
    /// Digits that follow without a blank: the number of vertices.
    pub(in crate::formats) glued: &'a [u8],
}

impl<'a> HeaderWord<'a> {
    /// The parts of `word`, if it is a header word.
    pub(in crate::formats) fn parse(word: &'a [u8]) -> Option<Self> {
        let mut rest = word;
        let mut take = |prefix: &[u8]| {
            let after = rest.strip_prefix(prefix);
            rest = after.unwrap_or(rest);
            after.is_some()
        };
        let has_texture = take(b"ST");
        let has_colors = take(b"C");
        let has_normals = take(b"N");
        let is_4d = take(b"4");
        let is_nd = take(b"n");
        if !(take(b"OFF") || take(b"off")) || !rest.iter().all(u8::is_ascii_digit) {
            return None;
        }
        Some(Self { has_texture, has_colors, has_normals, has_other_dimension: is_4d || is_nd, glued: rest })
    }
}
