//! Disjoint sets whose members are alike or opposite.

/// Disjoint sets over `0..len` in which every member is on one of two sides; the representative of a set is its smallest
/// member.
#[derive(Debug, Clone)]
pub struct ParityUnionFind {
    parent: Vec<u32>,
    /// True when a member is on the other side than its parent.
    is_opposite: Vec<bool>,
}

impl ParityUnionFind {
    /// `len` sets of one member.
    pub fn new(len: usize) -> Self {
        Self { parent: (0..len as u32).collect(), is_opposite: vec![false; len] }
    }

    /// The smallest member of the set of `x`, and whether `x` is on the other side than that.
    pub fn find(&mut self, x: u32) -> (u32, bool) {
        let (mut root, mut is_opposite) = (x, false);
        while self.parent[root as usize] != root {
            is_opposite ^= self.is_opposite[root as usize];
            root = self.parent[root as usize];
        }
        // Every member on the way now hangs from the root, with what is left of the parity.
        let (mut y, mut rest) = (x, is_opposite);
        while y != root {
            let parent = std::mem::replace(&mut self.parent[y as usize], root);
            let step = std::mem::replace(&mut self.is_opposite[y as usize], rest);
            rest ^= step;
            y = parent;
        }
        (root, is_opposite)
    }

    /// Says that `a` and `b` are on opposite sides, or on the same one. False when that contradicts what was said
    /// before; then nothing changes.
    pub fn relate(&mut self, a: u32, b: u32, are_opposite: bool) -> bool {
        let ((root_a, side_a), (root_b, side_b)) = (self.find(a), self.find(b));
        let parity = side_a ^ side_b ^ are_opposite;
        if root_a == root_b {
            return !parity;
        }
        let (child, parent) = (root_a.max(root_b), root_a.min(root_b));
        self.parent[child as usize] = parent;
        self.is_opposite[child as usize] = parity;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_follow_from_relations_in_any_order() {
        let mut sets = ParityUnionFind::new(6);
        assert!(sets.relate(4, 5, true));
        assert!(sets.relate(1, 2, true));
        assert!(sets.relate(2, 4, false));
        assert_eq!(sets.find(5), (1, false));
        assert_eq!(sets.find(4), (1, true));
        assert_eq!(sets.find(0), (0, false));
        assert!(sets.relate(1, 4, true));
        assert!(!sets.relate(1, 4, false), "contradicts");
        assert_eq!(sets.find(5), (1, false));
    }
}
