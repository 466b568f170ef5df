//! P0: what the positions of each triangle and the index triples of all say.

use super::surface::ReadingSurface;
use super::verdict::ConditionCounts;
use super::{Condition, Violation};
use crate::budget::{Budget, CHECK_EVERY, Charge, Stopped};
use crate::geom;
use crate::mesh::{EdgeGroups, corners_from, edge_of, fan_heads, singular_vertices, triangle_of, twins};
use crate::par;
use std::borrow::Cow;

/// The degenerate triangles, ascending: a repeated vertex, or corners exactly on one line.
pub(super) fn degenerate(surface: &ReadingSurface<'_>, budget: &Budget) -> Result<Vec<u32>, Stopped> {
    let parts = par::try_map_ranges(surface.triangles.len(), CHECK_EVERY, |range| {
        budget.check()?;
        let is_degenerate = |&t: &u32| {
            let [a, b, c] = surface.corners(t);
            geom::are_collinear(a, b, c)
        };
        Ok((range.start as u32..range.end as u32).filter(is_degenerate).collect::<Vec<_>>())
    })?;
    Ok(parts.concat())
}

/// Notes the degenerate triangles of `surface`.
pub(super) fn note_degenerate(
    surface: &ReadingSurface<'_>,
    degenerate: &[u32],
    verdict: &mut ConditionCounts,
) {
    verdict.note(Condition::NonDegenerate, degenerate.len() as u64, |samples| {
        let witness =
            |&t: &u32| surface.violation(Condition::NonDegenerate, &[t], &surface.triangles[t as usize]);
        degenerate.iter().take(samples).map(witness).collect()
    });
}

/// Numbers of elements.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Census {
    pub(super) vertices: u64,
    pub(super) edges: u64,
    pub(super) triangles: u64,
}

impl Census {
    pub(super) fn euler_characteristic(self) -> i64 {
        self.vertices as i64 - self.edges as i64 + self.triangles as i64
    }
}

/// What the index triples with three distinct vertices say, whatever the positions.
pub(super) struct IndexTopology<'a> {
    triangles: Cow<'a, [[u32; 3]]>,
    /// Triangle of the surface behind each of `triangles`, where some were left out.
    ids: Option<Vec<u32>>,
    groups: EdgeGroups,
    twins: Vec<u32>,
    vertices: u64,
    faults: EdgeFaults,
    singular_vertices: Vec<u32>,
    _charge: Charge<'a>,
}

/// Edges and triangles that break a condition, ascending.
#[derive(Default)]
struct EdgeFaults {
    without_two_triangles: Vec<u32>,
    in_one_direction: Vec<u32>,
    duplicates: Vec<Duplicate>,
}

/// A triangle with the same three vertices as an earlier one.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Duplicate {
    triangle: u32,
    first: u32,
}

impl<'a> IndexTopology<'a> {
    pub(super) fn of(
        triangles: &'a [[u32; 3]],
        vertex_count: usize,
        budget: &'a Budget,
    ) -> Result<Self, Stopped> {
        let (triangles, ids) = with_distinct_vertices(triangles, budget)?;
        // Half-edges, starts of groups and twins.
        let charge = budget.charge(triangles.len() as u64 * (12 + 6 + 12))?;
        let groups = EdgeGroups::build(&triangles, vertex_count, budget)?;
        let faults = EdgeFaults::find(&triangles, &groups, budget)?;
        let twins = twins(&groups, triangles.len(), budget)?;
        let singular_vertices = singular_vertices(&triangles, vertex_count, &twins, budget)?;
        let vertices = used_vertices(&triangles, vertex_count, budget)?;
        Ok(Self { triangles, ids, groups, twins, vertices, faults, singular_vertices, _charge: charge })
    }

    pub(super) fn is_clean(&self) -> bool {
        self.faults.duplicates.is_empty()
            && self.faults.without_two_triangles.is_empty()
            && self.faults.in_one_direction.is_empty()
            && self.singular_vertices.is_empty()
    }

    /// The triangles of the surface with the same three vertices as an earlier one, ascending.
    pub(super) fn duplicates(&self) -> Vec<u32> {
        self.faults.duplicates.iter().map(|d| self.id(d.triangle)).collect()
    }

    /// The ends of the edges that have not exactly two triangles, one in each direction; some of them repeatedly.
    pub(super) fn open_vertices(&self) -> Vec<u32> {
        let EdgeFaults { without_two_triangles, in_one_direction, .. } = &self.faults;
        let edges = without_two_triangles.iter().chain(in_one_direction);
        edges.flat_map(|&e| edge_of(&self.triangles, self.groups.group(e as usize)[0])).collect()
    }

    pub(super) fn census(&self) -> Census {
        let (edges, triangles) = (self.groups.len() as u64, self.triangles.len() as u64);
        Census { vertices: self.vertices, edges, triangles }
    }

    /// Notes every condition decided here; `surface` is the one whose triangles were given.
    pub(super) fn note(
        &self,
        surface: &ReadingSurface<'_>,
        verdict: &mut ConditionCounts,
        budget: &Budget,
    ) -> Result<(), Stopped> {
        let faults = &self.faults;
        verdict.note(Condition::Distinct, faults.duplicates.len() as u64, |samples| {
            let witness = |d: &Duplicate| {
                let vertices = self.triangles[d.first as usize];
                surface.violation(Condition::Distinct, &[self.id(d.first), self.id(d.triangle)], &vertices)
            };
            faults.duplicates.iter().take(samples).map(witness).collect()
        });
        for (condition, edges) in [
            (Condition::TwoTrianglesPerEdge, &faults.without_two_triangles),
            (Condition::OppositeDirections, &faults.in_one_direction),
        ] {
            verdict.note(condition, edges.len() as u64, |samples| {
                edges.iter().take(samples).map(|&e| self.edge_violation(surface, condition, e)).collect()
            });
        }
        let singular = &self.singular_vertices;
        let shown = &singular[..singular.len().min(verdict.samples())];
        let heads = fan_heads(&self.triangles, shown, &self.twins, budget)?;
        verdict.note(Condition::OneFanPerVertex, singular.len() as u64, |_| {
            let witness = |(&v, corners): (&u32, &Vec<u32>)| {
                surface.violation(Condition::OneFanPerVertex, &self.ids_behind(corners), &[v])
            };
            shown.iter().zip(&heads).map(witness).collect()
        });
        Ok(())
    }

    fn edge_violation(&self, surface: &ReadingSurface<'_>, condition: Condition, edge: u32) -> Violation {
        let group = self.groups.group(edge as usize);
        surface.violation(condition, &self.ids_behind(group), &edge_of(&self.triangles, group[0]))
    }

    fn ids_behind(&self, half_edges: &[u32]) -> Vec<u32> {
        half_edges.iter().map(|&h| self.id(triangle_of(h))).collect()
    }

    fn id(&self, t: u32) -> u32 {
        self.ids.as_ref().map_or(t, |ids| ids[t as usize])
    }
}

/// Triangles, and their ids if some were left out.
type KeptTriangles<'a> = (Cow<'a, [[u32; 3]]>, Option<Vec<u32>>);

fn with_distinct_vertices<'a>(
    triangles: &'a [[u32; 3]],
    budget: &Budget,
) -> Result<KeptTriangles<'a>, Stopped> {
    let is_distinct = |[a, b, c]: [u32; 3]| a != b && b != c && c != a;
    let parts = par::try_map_ranges(triangles.len(), CHECK_EVERY, |range| {
        budget.check()?;
        Ok(triangles[range].iter().all(|&t| is_distinct(t)))
    })?;
    if parts.into_iter().all(|all_are_distinct| all_are_distinct) {
        return Ok((Cow::Borrowed(triangles), None));
    }
    let ids: Vec<u32> = (0..triangles.len() as u32).filter(|&t| is_distinct(triangles[t as usize])).collect();
    Ok((ids.iter().map(|&t| triangles[t as usize]).collect(), Some(ids)))
}

fn used_vertices(triangles: &[[u32; 3]], vertex_count: usize, budget: &Budget) -> Result<u64, Stopped> {
    let mut is_used = vec![false; vertex_count];
    for block in triangles.chunks(CHECK_EVERY) {
        budget.check()?;
        for &v in block.as_flattened() {
            is_used[v as usize] = true;
        }
    }
    Ok(is_used.into_iter().map(u64::from).sum())
}

impl EdgeFaults {
    fn find(triangles: &[[u32; 3]], groups: &EdgeGroups, budget: &Budget) -> Result<Self, Stopped> {
        let parts = par::try_map_ranges(groups.len(), CHECK_EVERY, |edges| {
            budget.check()?;
            let mut part = Self::default();
            for e in edges {
                part.look_at(triangles, e as u32, groups.group(e));
            }
            Ok(part)
        })?;
        let mut all = Self::default();
        for part in parts {
            all.without_two_triangles.extend(part.without_two_triangles);
            all.in_one_direction.extend(part.in_one_direction);
            all.duplicates.extend(part.duplicates);
        }
        all.duplicates.sort_unstable();
        Ok(all)
    }

    fn look_at(&mut self, triangles: &[[u32; 3]], edge: u32, group: &[u32]) {
        let &[a, b] = group else {
            self.without_two_triangles.push(edge);
            return self.look_for_duplicates(triangles, group);
        };
        let ([from, to, apex], [other_from, other_to, other_apex]) =
            (corners_from(triangles, a), corners_from(triangles, b));
        if [from, to] == [other_from, other_to] {
            self.in_one_direction.push(edge);
        }
        if apex == other_apex && apex > from.max(to) {
            self.duplicates.push(Duplicate { triangle: triangle_of(b), first: triangle_of(a) });
        }
    }

    /// Triangles with the same vertices share all three edges; they are taken at the edge across from the largest
    /// vertex, so that each counts once.
    fn look_for_duplicates(&mut self, triangles: &[[u32; 3]], group: &[u32]) {
        let apex_beyond = |&h: &u32| {
            let [from, to, apex] = corners_from(triangles, h);
            (apex > from.max(to)).then(|| (apex, triangle_of(h)))
        };
        let mut star: Vec<(u32, u32)> = group.iter().filter_map(apex_beyond).collect();
        star.sort_unstable();
        for same in star.chunk_by(|a, b| a.0 == b.0) {
            let first = same[0].1;
            self.duplicates.extend(same[1..].iter().map(|&(_, triangle)| Duplicate { triangle, first }));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    fn faults(triangles: &[[u32; 3]]) -> [usize; 4] {
        let budget = Budget::unlimited();
        let topology = IndexTopology::of(triangles, 8, &budget).unwrap();
        let faults = &topology.faults;
        let counts = [
            faults.duplicates.len(),
            faults.without_two_triangles.len(),
            faults.in_one_direction.len(),
            topology.singular_vertices.len(),
        ];
        assert_eq!(topology.is_clean(), counts == [0; 4]);
        counts
    }

    #[test]
    fn a_tetrahedron_is_clean_and_has_the_euler_characteristic_of_a_sphere() {
        assert_eq!(faults(&TETRAHEDRON), [0; 4]);
        let budget = Budget::unlimited();
        assert_eq!(IndexTopology::of(&TETRAHEDRON, 8, &budget).unwrap().census().euler_characteristic(), 2);
    }

    #[test]
    fn a_missing_face_leaves_three_edges_with_one_triangle() {
        assert_eq!(faults(&TETRAHEDRON[..3]), [0, 3, 0, 0]);
    }

    #[test]
    fn a_flipped_face_has_three_edges_in_one_direction() {
        let mut triangles = TETRAHEDRON;
        triangles[2].swap(0, 1);
        assert_eq!(faults(&triangles), [0, 0, 3, 0]);
    }

    #[test]
    fn each_copy_of_a_face_counts_once_in_whichever_direction_and_turn() {
        let mut triangles = TETRAHEDRON.to_vec();
        triangles.extend([[3, 1, 2], [2, 1, 3], [3, 0, 2]]);
        assert_eq!(faults(&triangles)[0], 3);
        let budget = Budget::unlimited();
        assert_eq!(IndexTopology::of(&triangles, 8, &budget).unwrap().duplicates(), [4, 5, 6]);
        assert_eq!(faults(&[[0, 1, 2], [2, 1, 0]]), [1, 0, 0, 0], "a pillow of two faces is closed");
    }

    #[test]
    fn triangles_that_name_a_vertex_twice_are_left_out_and_the_ids_of_others_stay() {
        let triangles = [[1, 1, 2], [0, 1, 2], [3, 3, 3], [0, 1, 2]];
        let budget = Budget::unlimited();
        let topology = IndexTopology::of(&triangles, 4, &budget).unwrap();
        assert_eq!(topology.duplicates(), [3]);
        assert_eq!(topology.census().euler_characteristic(), 2);
    }
}
