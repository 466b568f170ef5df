//! Disjoint sets whose members are alike or opposite.

/// Disjoint sets over `0..len` in which every member is on one of two sides; the representative of a set is its smallest
/// member.
#[derive(Debug, Clone)]
pub struct ParityUnionFind {
    /// For each member twice its parent, and 1 more when it is on the other side than that.
    parents: Vec<u32>,
}

impl ParityUnionFind {
    /// `len` sets of one member; fewer than 2^31.
    pub fn new(len: usize) -> Self {
        Self { parents: (0..len as u32).map(|x| 2 * x).collect() }
    }

    /// The smallest member of the set of `x`, and whether `x` is on the other side than that.
    pub fn find(&mut self, mut x: u32) -> (u32, bool) {
        let mut side = 0;
        loop {
            let parent = self.parents[x as usize];
            if parent / 2 == x {
                return (x, side == 1);
            }
            // Every other member on the way now hangs from the parent of its parent.
            let grandparent = self.parents[parent as usize / 2] ^ (parent % 2);
            self.parents[x as usize] = grandparent;
            side ^= grandparent % 2;
            x = grandparent / 2;
        }
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
        self.parents[child as usize] = 2 * parent + u32::from(parity);
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
