//! Which holes a step is for, when the caller has chosen among them.

use super::Draft;
use crate::geom::{DVec3, are_collinear};
use crate::mesh::{Soup, edge_of, triangle_of};

/// Loops of boundary edges, each told by one half-edge of the soup in it, ascending.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Selection {
    /// All but these.
    AllBut(Vec<u32>),
    /// These alone.
    Only(Vec<u32>),
}

impl Default for Selection {
    fn default() -> Self {
        Self::AllBut(Vec::new())
    }
}

impl Selection {
    /// True when it takes the loop of these half-edges of `draft`, which was made of `soup`. An edge of the draft is the
    /// edge of the soup on which both its ends lie, in the triangle it comes from.
    pub fn takes(&self, half_edges: &[u32], draft: &Draft, soup: &Soup) -> bool {
        let (listed, if_found) = match self {
            Self::AllBut(listed) => (listed, false),
            Self::Only(listed) => (listed, true),
        };
        let is_listed = |&h: &u32| {
            let origin = draft.triangle_origin[triangle_of(h) as usize];
            let start = listed.partition_point(|&listed| triangle_of(listed) < origin);
            let of_triangle = listed[start..].iter().take_while(|&&listed| triangle_of(listed) == origin);
            let ends = edge_of(&draft.triangles, h).map(|v| draft.vertex_origin[v as usize]);
            of_triangle.into_iter().any(|&listed| is_on(ends, listed, soup))
        };
        let is_found = !listed.is_empty() && half_edges.iter().any(is_listed);
        is_found == if_found
    }
}

/// True when both vertices lie on the line of half-edge `listed`.
fn is_on(ends: [u32; 2], listed: u32, soup: &Soup) -> bool {
    if triangle_of(listed) as usize >= soup.triangles.len() {
        return false;
    }
    let [a, b] = edge_of(&soup.triangles, listed).map(|v| soup.positions[v as usize]);
    let on_line = |p: DVec3| p == a || p == b || are_collinear(a, b, p);
    // A vertex between others is not of the soup.
    ends.into_iter().all(|v| soup.positions.get(v as usize).is_some_and(|&p| on_line(p)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Soup {
        Soup {
            positions: [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [1.0, 0.0]]
                .map(|[x, y]| DVec3::new(x, y, 0.0))
                .to_vec(),
            triangles: vec![[0, 1, 2]],
            face_count: 1,
            ..Soup::default()
        }
    }

    #[test]
    fn a_part_of_a_divided_edge_is_still_that_edge_and_the_other_edges_are_not() {
        let soup = square();
        // The first edge was divided at vertex 3, and the second part is turned.
        let draft = Draft {
            positions: soup.positions.clone(),
            vertex_origin: vec![0, 1, 2, 3],
            triangles: vec![[0, 3, 2], [3, 2, 1]],
            triangle_origin: vec![0, 0],
            ..Draft::default()
        };
        let first = Selection::Only(vec![0]);
        assert!(first.takes(&[0], &draft, &soup), "0 to 3");
        assert!(first.takes(&[5], &draft, &soup), "1 to 3");
        assert!(!first.takes(&[4], &draft, &soup), "2 to 1");
        assert!(!Selection::AllBut(vec![0]).takes(&[4, 5], &draft, &soup));
        assert!(Selection::default().takes(&[5], &draft, &soup));
        assert!(!Selection::Only(vec![7]).takes(&[5], &draft, &soup));
    }
}
