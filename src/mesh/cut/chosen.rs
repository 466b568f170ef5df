//! Edges that a caller wants cut whatever they are.

/// Edges by the vertices at their ends, in any order.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ChosenEdges(Vec<[u32; 2]>);

impl ChosenEdges {
    /// The edges with these ends.
    pub fn of(ends: impl IntoIterator<Item = [u32; 2]>) -> Self {
        let mut all: Vec<[u32; 2]> = ends.into_iter().map(|[a, b]| [a.min(b), a.max(b)]).collect();
        all.sort_unstable();
        all.dedup();
        Self(all)
    }

    /// True when the edge with these ends is one of them.
    pub fn contains(&self, [a, b]: [u32; 2]) -> bool {
        self.0.binary_search(&[a.min(b), a.max(b)]).is_ok()
    }

    /// The edges, the smaller end first, ascending.
    pub fn iter(&self) -> impl Iterator<Item = [u32; 2]> {
        self.0.iter().copied()
    }
}
