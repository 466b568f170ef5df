//! Connected parts by union-find.

/// Disjoint sets over `0..len`; the representative of a set is its smallest member, so results do not depend on the
/// order of the unions.
#[derive(Debug, Clone)]
pub struct UnionFind {
    parent: Vec<u32>,
}

impl UnionFind {
    /// `len` sets of one member.
    pub fn new(len: usize) -> Self {
        Self { parent: (0..len as u32).collect() }
    }

    /// The smallest member of the set of `x`.
    pub fn find(&mut self, mut x: u32) -> u32 {
        while self.parent[x as usize] != x {
            let grandparent = self.parent[self.parent[x as usize] as usize];
            self.parent[x as usize] = grandparent;
            x = grandparent;
        }
        x
    }

    /// Joins the sets of `a` and `b`; false when they were one already.
    pub fn unite(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.find(a), self.find(b));
        self.parent[a.max(b) as usize] = a.min(b);
        a != b
    }

    /// Numbers the sets from 0 in the order of their smallest members.
    pub fn into_components(mut self) -> Components {
        let mut count = 0;
        let mut of = vec![0; self.parent.len()];
        for x in 0..self.parent.len() as u32 {
            let root = self.find(x);
            of[x as usize] = if root == x {
                count += 1;
                count - 1
            } else {
                of[root as usize]
            };
        }
        Components { of, count }
    }
}

/// The component of every element, numbered from 0 by smallest element.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Components {
    /// Component of element `i`.
    pub of: Vec<u32>,
    /// Number of components.
    pub count: u32,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn components_are_numbered_by_their_smallest_member_whatever_the_order_of_unions() {
        for pairs in [[(4, 2), (2, 5), (3, 1)], [(1, 3), (5, 4), (4, 2)]] {
            let mut sets = UnionFind::new(6);
            for (a, b) in pairs {
                assert!(sets.unite(a, b));
            }
            assert_eq!(sets.into_components(), Components { of: vec![0, 1, 2, 1, 2, 2], count: 3 });
        }
    }
}
