//! Joins pairs of boundary edges where the mesh stays a manifold. No coordinates here: the caller offers the pairs.
//!
//! After Guéziec, Taubin, Lazarus and Horn, "Cutting and stitching" (2001), with an exact test in place of their
//! sufficient conditions: a pair is joined unless an edge would be degenerate, get a third triangle or two in one
//! direction, or two triangles would get the same vertices.

use super::{edge_of, triangle_of};
use crate::budget::{Budget, Stopped};

/// What [`stitch`] did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Stitched {
    /// Pairs of edges that were joined because they were offered.
    pub explicit: u64,
    /// Offered pairs that had become one edge when their turn came, because vertices of others were joined.
    pub implicit: u64,
}

/// Joins the offered `pairs` of half-edges, in their order, again and again until none can be joined any more.
/// `triangles` must be a manifold with boundary (see [`cut_singular`](super::cut_singular)) and stays one; the half-edges
/// must be of boundary edges, each pair running in opposite directions. Of two joined vertices the smaller id stays.
///
/// ```text
///     \   /                  \   /
///      u u'                    u
///      | |        gives        |        u u' and v v' are one vertex each, or two without a common edge
///      v v'                    v
///     /   \                  /   \
/// ```
///
/// # Errors
/// When the budget stops the run.
pub fn stitch(
    triangles: &mut [[u32; 3]],
    vertex_count: usize,
    pairs: &[(u32, u32)],
    budget: &Budget,
) -> Result<Stitched, Stopped> {
    let mut stars = Stars::of_ends(triangles, vertex_count, pairs);
    let mut done = Stitched::default();
    let mut open = pairs.to_vec();
    loop {
        let mut left = Vec::with_capacity(open.len());
        for &(g, h) in &open {
            budget.spend(1)?;
            match join(triangles, &mut stars, g, h, budget)? {
                Verdict::Joined => done.explicit += 1,
                Verdict::OneAlready => done.implicit += 1,
                Verdict::NotNow => left.push((g, h)),
            }
        }
        if left.len() == open.len() || left.is_empty() {
            return Ok(done);
        }
        open = left;
    }
}

/// The triangles around each vertex that a pair could join; other vertices have none here.
struct Stars {
    slot: Vec<u32>,
    stars: Vec<Vec<u32>>,
}

const NO_SLOT: u32 = u32::MAX;

impl Stars {
    fn of_ends(triangles: &[[u32; 3]], vertex_count: usize, pairs: &[(u32, u32)]) -> Self {
        let mut slot = vec![NO_SLOT; vertex_count];
        let mut stars = Vec::new();
        for h in pairs.iter().flat_map(|&(g, h)| [g, h]) {
            for v in edge_of(triangles, h) {
                if slot[v as usize] == NO_SLOT {
                    slot[v as usize] = stars.len() as u32;
                    stars.push(Vec::new());
                }
            }
        }
        for (t, corners) in triangles.iter().enumerate() {
            for &v in corners {
                if slot[v as usize] != NO_SLOT {
                    stars[slot[v as usize] as usize].push(t as u32);
                }
            }
        }
        Self { slot, stars }
    }

    fn of(&self, v: u32) -> &[u32] {
        &self.stars[self.slot[v as usize] as usize]
    }

    /// Makes `gone` the vertex `kept`.
    fn merge(&mut self, triangles: &mut [[u32; 3]], kept: u32, gone: u32) {
        let star = std::mem::take(&mut self.stars[self.slot[gone as usize] as usize]);
        for &t in &star {
            for v in &mut triangles[t as usize] {
                if *v == gone {
                    *v = kept;
                }
            }
        }
        self.stars[self.slot[kept as usize] as usize].extend(star);
    }
}

enum Verdict {
    Joined,
    OneAlready,
    NotNow,
}

fn join(
    triangles: &mut [[u32; 3]],
    stars: &mut Stars,
    g: u32,
    h: u32,
    budget: &Budget,
) -> Result<Verdict, Stopped> {
    let ([u, v], [v2, u2]) = (edge_of(triangles, g), edge_of(triangles, h));
    if (u, v) == (u2, v2) {
        return Ok(Verdict::OneAlready);
    }
    let merges = [(u.min(u2), u.max(u2)), (v.min(v2), v.max(v2))];
    let reach = merges.iter().map(|&(a, b)| stars.of(a).len() + stars.of(b).len()).sum::<usize>();
    budget.spend(reach as u64 / 8)?;
    if !merges.iter().all(|&(kept, gone)| is_valid_after(triangles, stars, kept, gone, merges)) {
        return Ok(Verdict::NotNow);
    }
    debug_assert_ne!(triangle_of(g), triangle_of(h), "a triangle cannot be joined to itself");
    for (kept, gone) in merges {
        if kept != gone {
            stars.merge(triangles, kept, gone);
        }
    }
    Ok(Verdict::Joined)
}

/// True when the star of `kept` and `gone` together, renamed by `merges`, has no degenerate triangle, no edge used
/// twice in one direction (which forbids a third triangle as well), and no two triangles with the same vertices.
fn is_valid_after(
    triangles: &[[u32; 3]],
    stars: &Stars,
    kept: u32,
    gone: u32,
    merges: [(u32, u32); 2],
) -> bool {
    let rename = |v: u32| merges.iter().fold(v, |v, &(kept, gone)| if v == gone { kept } else { v });
    let others: &[u32] = if kept == gone { &[] } else { stars.of(gone) };
    let mut links = Vec::with_capacity(stars.of(kept).len() + others.len());
    for &t in stars.of(kept).iter().chain(others) {
        let [a, b, c] = triangles[t as usize].map(rename);
        if a == b || b == c || c == a {
            return false;
        }
        links.push(if a == kept {
            [b, c]
        } else if b == kept {
            [c, a]
        } else {
            [a, b]
        });
    }
    is_unique(links.iter().map(|l| l[0]).collect())
        && is_unique(links.iter().map(|l| l[1]).collect())
        && is_unique(links.into_iter().map(|[a, b]| (a.min(b), a.max(b))).collect())
}

fn is_unique<T: Ord>(mut items: Vec<T>) -> bool {
    items.sort_unstable();
    items.windows(2).all(|pair| pair[0] != pair[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stitched(
        triangles: &[[u32; 3]],
        vertex_count: usize,
        pairs: &[(u32, u32)],
    ) -> (Vec<[u32; 3]>, Stitched) {
        let mut triangles = triangles.to_vec();
        let done = stitch(&mut triangles, vertex_count, pairs, &Budget::unlimited()).unwrap();
        (triangles, done)
    }

    #[test]
    fn two_triangles_are_joined_along_an_edge() {
        let (triangles, done) = stitched(&[[0, 1, 2], [3, 4, 5]], 6, &[(0, 3)]);
        assert_eq!(triangles, [[0, 1, 2], [1, 0, 5]]);
        assert_eq!(done, Stitched { explicit: 1, implicit: 0 });
    }

    #[test]
    fn two_triangles_are_not_joined_into_a_double_face() {
        // All three edges are offered; after two of them, the triangles would have the same three vertices.
        let (triangles, done) = stitched(&[[0, 1, 2], [3, 4, 5]], 6, &[(0, 3), (1, 5), (2, 4)]);
        assert_eq!(triangles, [[0, 1, 2], [1, 0, 5]]);
        assert_eq!(done.explicit, 1);
    }

    #[test]
    fn a_third_page_is_not_joined_to_a_book_of_two() {
        let (triangles, done) = stitched(&[[0, 1, 2], [4, 3, 5], [7, 6, 8]], 9, &[(0, 3), (0, 6)]);
        assert_eq!(triangles, [[0, 1, 2], [1, 0, 5], [7, 6, 8]]);
        assert_eq!(done, Stitched { explicit: 1, implicit: 0 });
    }

    #[test]
    fn the_last_gap_of_a_cone_closes_as_a_pinch() {
        // Four triangles around 0, cut open between 4 and 1: the edges 0-4 and 0-5 are one afterwards.
        let (triangles, done) = stitched(&[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]], 6, &[(0, 11)]);
        assert_eq!(triangles[3], [0, 4, 1]);
        assert_eq!(done.explicit, 1);
    }

    #[test]
    fn an_edge_whose_ends_others_have_joined_is_an_implicit_stitch() {
        // Two quads whose outer edges coincide: a tube is closed by two joins, the third pair is joined by then.
        let a = [[0, 1, 2], [0, 2, 3]];
        let b = [[5, 4, 7], [5, 7, 6]];
        let tube: Vec<_> = a.into_iter().chain(b).collect();
        let (_, done) = stitched(&tube, 8, &[(0, 6), (0, 6)]);
        assert_eq!(done, Stitched { explicit: 1, implicit: 1 });
    }
}
