//! The fans of triangles around each vertex: chains or cycles of triangles joined across edges that have exactly two.
//!
//! A vertex is regular when its triangles are one fan, which is the same as its link being one chain or one cycle: at
//! an edge with one triangle, or with three or more, every fan ends.

use super::corners::{edge_of, next_corner, prev_corner};
use super::edges::EdgeGroups;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::par;
use rustc_hash::FxHashSet;

/// In the place of a half-edge that has no twin.
pub const NO_TWIN: u32 = u32::MAX;

/// For each half-edge the other one of its edge, in whichever direction that runs; [`NO_TWIN`] where the edge has not
/// exactly two triangles.
///
/// # Errors
/// When the budget stops the run.
pub fn twins(groups: &EdgeGroups, triangle_count: usize, budget: &Budget) -> Result<Vec<u32>, Stopped> {
    let mut twins = vec![NO_TWIN; triangle_count * 3];
    for (e, group) in groups.iter().enumerate() {
        if e % CHECK_EVERY == 0 {
            budget.check()?;
        }
        if let &[a, b] = group {
            twins[a as usize] = b;
            twins[b as usize] = a;
        }
    }
    Ok(twins)
}

/// The corners at one vertex that are in one fan, starting anywhere in it. A corner is named by the half-edge that
/// leaves it.
#[derive(Debug, Clone)]
pub struct Fan<'a> {
    triangles: &'a [[u32; 3]],
    twins: &'a [u32],
    start: u32,
    /// The next corner to give and the half-edge through which the fan goes on from there.
    next: Option<(u32, u32)>,
    is_turned: bool,
}

impl<'a> Fan<'a> {
    /// The fan of `corner`. The triangles must have three distinct vertices each, or the walk may not end.
    pub fn around(triangles: &'a [[u32; 3]], twins: &'a [u32], corner: u32) -> Self {
        Self { triangles, twins, start: corner, next: Some((corner, prev_corner(corner))), is_turned: false }
    }

    /// The corner beyond half-edge `exit`, and where the fan goes on from there.
    fn beyond(&self, exit: u32) -> Option<(u32, u32)> {
        let twin = self.twins[exit as usize];
        if twin == NO_TWIN {
            return None;
        }
        let vertex = edge_of(self.triangles, self.start)[0];
        if edge_of(self.triangles, twin)[0] == vertex {
            Some((twin, prev_corner(twin)))
        } else {
            let corner = next_corner(twin);
            Some((corner, corner))
        }
    }
}

impl Iterator for Fan<'_> {
    type Item = u32;

    fn next(&mut self) -> Option<u32> {
        let (corner, exit) = self.next?;
        self.next = match self.beyond(exit) {
            Some((beyond, _)) if beyond == self.start => None,
            // A chain ends here: go on from the start through its other side.
            None if !self.is_turned => {
                self.is_turned = true;
                self.beyond(self.start)
            }
            step => step,
        };
        Some(corner)
    }
}

/// The vertices whose triangles form more than one fan, ascending. The triangles must have three distinct vertices
/// each; `twins` are those of their half-edges.
///
/// # Errors
/// When the budget stops the run.
pub fn singular_vertices(
    triangles: &[[u32; 3]],
    vertex_count: usize,
    twins: &[u32],
    budget: &Budget,
) -> Result<Vec<u32>, Stopped> {
    let _charge = budget.charge(vertex_count as u64 * size_of::<VertexCorners>() as u64)?;
    let stars = stars(triangles, vertex_count, budget)?;
    let parts = par::try_map_ranges(vertex_count, CHECK_EVERY, |range| {
        budget.check()?;
        let is_singular = |&v: &u32| {
            let VertexCorners { corner, valence } = stars[v as usize];
            valence > 1 && Fan::around(triangles, twins, corner).count() < valence as usize
        };
        Ok((range.start as u32..range.end as u32).filter(is_singular).collect::<Vec<_>>())
    })?;
    Ok(parts.concat())
}

/// For each of `vertices`, which must ascend, the smallest corner of each of its fans, ascending. One pass over all
/// triangles, which must have three distinct vertices each.
///
/// # Errors
/// When the budget stops the run.
pub fn fan_heads(
    triangles: &[[u32; 3]],
    vertices: &[u32],
    twins: &[u32],
    budget: &Budget,
) -> Result<Vec<Vec<u32>>, Stopped> {
    let mut stars = vec![Vec::new(); vertices.len()];
    let mut is_asked = vec![false; vertices.last().map_or(0, |&v| v as usize + 1)];
    vertices.iter().for_each(|&v| is_asked[v as usize] = true);
    for (t, corners) in triangles.iter().enumerate() {
        if t % CHECK_EVERY == 0 {
            budget.check()?;
        }
        for (c, v) in corners.iter().enumerate().filter(|(_, v)| is_asked.get(**v as usize) == Some(&true)) {
            if let Ok(i) = vertices.binary_search(v) {
                stars[i].push((t * 3 + c) as u32);
            }
        }
    }
    for corners in &mut stars {
        let mut walked = FxHashSet::default();
        corners.retain(|&corner| {
            let is_head = !walked.contains(&corner);
            if is_head {
                walked.extend(Fan::around(triangles, twins, corner));
            }
            is_head
        });
    }
    Ok(stars)
}

/// One corner at a vertex, and how many there are.
#[derive(Clone, Copy, Default)]
struct VertexCorners {
    corner: u32,
    valence: u32,
}

fn stars(
    triangles: &[[u32; 3]],
    vertex_count: usize,
    budget: &Budget,
) -> Result<Vec<VertexCorners>, Stopped> {
    let mut stars = vec![VertexCorners::default(); vertex_count];
    for (t, corners) in triangles.iter().enumerate() {
        if t % CHECK_EVERY == 0 {
            budget.check()?;
        }
        for (c, &v) in corners.iter().enumerate() {
            let star = &mut stars[v as usize];
            star.corner = (t * 3 + c) as u32;
            star.valence += 1;
        }
    }
    Ok(stars)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::UnionFind;

    fn singular(triangles: &[[u32; 3]], vertex_count: usize) -> Vec<u32> {
        let budget = Budget::unlimited();
        singular_vertices(triangles, vertex_count, &twins_of(triangles, vertex_count), &budget).unwrap()
    }

    fn twins_of(triangles: &[[u32; 3]], vertex_count: usize) -> Vec<u32> {
        let budget = Budget::unlimited();
        let groups = EdgeGroups::build(triangles, vertex_count, &budget).unwrap();
        twins(&groups, triangles.len(), &budget).unwrap()
    }

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    #[test]
    fn a_closed_surface_has_no_singular_vertex() {
        assert_eq!(singular(&TETRAHEDRON, 5), [0u32; 0]);
    }

    #[test]
    fn a_vertex_on_the_border_of_a_sheet_is_regular() {
        assert_eq!(singular(&[[0, 1, 2], [2, 1, 3], [3, 1, 4]], 5), [0u32; 0]);
    }

    #[test]
    fn two_cones_that_share_their_apex_make_it_singular() {
        let mut both = TETRAHEDRON.to_vec();
        both.extend(TETRAHEDRON.map(|t| t.map(|v| if v == 3 { 3 } else { v + 4 })));
        assert_eq!(singular(&both, 7), [3]);
    }

    #[test]
    fn the_ends_of_an_edge_with_three_sheets_are_singular() {
        assert_eq!(singular(&[[0, 1, 2], [0, 1, 3], [0, 1, 4]], 5), [0, 1]);
    }

    #[test]
    fn a_fan_goes_on_across_an_edge_whose_triangles_run_the_same_way() {
        let triangles = [[0, 1, 2], [0, 1, 3], [0, 3, 4]];
        let twins = twins_of(&triangles, 5);
        for corner in [0, 3, 6] {
            let mut fan: Vec<u32> = Fan::around(&triangles, &twins, corner).collect();
            fan.sort_unstable();
            assert_eq!(fan, [0, 3, 6], "from corner {corner}");
        }
    }

    #[test]
    fn random_soups_have_the_singular_vertices_that_uniting_corners_finds() {
        let mut state = 11u32;
        let mut random = |below: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) % below
        };
        for round in 0..2000 {
            let vertex_count = 3 + random(6);
            let mut triangles: Vec<[u32; 3]> =
                (0..random(14)).map(|_| std::array::from_fn(|_| random(vertex_count))).collect();
            triangles.retain(|[a, b, c]| a != b && b != c && c != a);
            let groups = EdgeGroups::build(&triangles, vertex_count as usize, &Budget::unlimited()).unwrap();
            let mut fans = UnionFind::new(triangles.len() * 3);
            for group in groups.iter().filter(|g| g.len() == 2) {
                let [a, b] = [group[0], group[1]];
                for v in edge_of(&triangles, a) {
                    let corner = |h: u32| if edge_of(&triangles, h)[0] == v { h } else { next_corner(h) };
                    fans.unite(corner(a), corner(b));
                }
            }
            let corners = 0..triangles.len() as u32 * 3;
            let mut heads = vec![Vec::new(); vertex_count as usize];
            for corner in corners.filter(|&c| fans.find(c) == c) {
                heads[edge_of(&triangles, corner)[0] as usize].push(corner);
            }
            let vertices: Vec<u32> = (0..vertex_count).collect();
            let twins = twins_of(&triangles, vertex_count as usize);
            assert_eq!(fan_heads(&triangles, &vertices, &twins, &Budget::unlimited()).unwrap(), heads);
            let want: Vec<u32> = vertices.into_iter().filter(|&v| heads[v as usize].len() > 1).collect();
            assert_eq!(singular(&triangles, vertex_count as usize), want, "round {round}: {triangles:?}");
        }
    }
}
