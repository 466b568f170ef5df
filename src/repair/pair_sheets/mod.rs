//! Pairs the triangles at edges that have four or more by their angles, so that each pair bounds one wedge of the solid,
//! or of the empty space, and the surface comes apart there as it should.
//!
//! ```text
//!    solid \   / empty           across the solid: what belongs to one body stays together, bodies come apart
//!           \ /
//!  empty --- x --- solid         across the empty space: bodies become one, and what is empty on both sides of the edge
//!           / \                  comes apart
//! ```

mod inside_out;

use super::{Changes, Draft, Effects};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{print_pitch, radial_order};
use crate::mesh::{self, CutMarks, CutMethod, EdgeGroups, NO_TWIN, divide, edge_of, prev_corner};

/// What lies between the triangles that are paired.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Across {
    /// The solid behind them.
    #[default]
    Solid,
    /// The empty space in front of them.
    Void,
}

/// Pairs triangles and gives each fan that is left a vertex of its own. The draft must be welded and oriented. What is inside
/// out is turned first (see `inside_out`): otherwise the solid would be taken for the space around it. Edges
/// whose triangles do not alternate in direction around them, or lie on each other, are left to the cut. Where both pairs
/// of an edge would still have the same ends, it is divided in its middle.
///
/// # Errors
/// When the budget stops the run.
pub fn pair_sheets(draft: &mut Draft, across: Across, budget: &Budget) -> Result<Changes, Stopped> {
    let mut divided = 0;
    let mut paired = Pairing::find(draft, across, budget)?;
    if paired.edges.is_empty() {
        return Ok(changes(0, 0, 0, 0));
    }
    let turned = inside_out::turn(draft, budget)?;
    if turned > 0 {
        paired = Pairing::find(draft, across, budget)?;
    }
    let mut cut = paired.cut(draft, budget)?;
    let stuck = paired.stuck(&cut.triangles);
    if !stuck.is_empty() {
        divided = divide_edges(draft, &stuck, budget)?;
        paired = Pairing::find(draft, across, budget)?;
        cut = paired.cut(draft, budget)?;
    }
    let edges = paired.edges.len() as u64;
    draft.triangles = cut.triangles;
    draft.reserve_vertices(cut.copies.len());
    for &v in &cut.copies {
        draft.positions.push(draft.positions[v as usize]);
        draft.vertex_origin.push(draft.vertex_origin[v as usize]);
    }
    Ok(changes(edges, divided, cut.copies.len() as u64, turned))
}

fn changes(edges: u64, divided: u64, copies: u64, turned: u64) -> Changes {
    let counts = [
        ("edges_paired", edges),
        ("edges_divided", divided),
        ("vertices_copied", copies),
        ("triangles_flipped", turned),
    ];
    let reason =
        if turned > 0 { "bodies that touch were inside out and turned".to_owned() } else { String::new() };
    let effects = Effects { copied_vertices: copies > 0, turned_triangles: turned, ..Effects::default() };
    Changes { reason, effects, ..Changes::counted(counts) }
}

/// Which half-edges stay together.
struct Pairing {
    twins: Vec<u32>,
    /// The half-edges of each edge with four triangles or more that were paired.
    edges: Vec<Vec<u32>>,
}

/// The draft's triangles after the cut, and the vertex behind each copy.
struct Parted {
    triangles: Vec<[u32; 3]>,
    copies: Vec<u32>,
}

impl Pairing {
    fn find(draft: &Draft, across: Across, budget: &Budget) -> Result<Self, Stopped> {
        let groups = EdgeGroups::build(&draft.triangles, draft.positions.len(), budget)?;
        let mut pairing = Self { twins: vec![NO_TWIN; draft.triangles.len() * 3], edges: Vec::new() };
        for (e, group) in groups.iter().enumerate() {
            if e % CHECK_EVERY == 0 {
                budget.check()?;
            }
            match *group {
                [g, h] if edge_of(&draft.triangles, g)[0] != edge_of(&draft.triangles, h)[0] => {
                    pairing.join(g, h);
                }
                _ if group.len() >= 4 => {
                    budget.spend(group.len() as u64)?;
                    if let Some(pairs) = pairs_at(draft, group, across) {
                        pairs.into_iter().for_each(|[g, h]| pairing.join(g, h));
                        pairing.edges.push(group.to_vec());
                    }
                }
                _ => {}
            }
        }
        Ok(pairing)
    }

    fn join(&mut self, g: u32, h: u32) {
        self.twins[g as usize] = h;
        self.twins[h as usize] = g;
    }

    fn cut(&self, draft: &Draft, budget: &Budget) -> Result<Parted, Stopped> {
        let (mut triangles, vertex_count) = (draft.triangles.clone(), draft.positions.len());
        let marks = CutMarks::across(&triangles, vertex_count, self.twins.clone(), budget)?;
        let copies = mesh::cut(&mut triangles, vertex_count, &marks, CutMethod::Local, budget)?;
        Ok(Parted { triangles, copies })
    }

    /// The paired edges of which two pairs have the same ends in `triangles`.
    fn stuck(&self, triangles: &[[u32; 3]]) -> Vec<Vec<u32>> {
        let is_stuck = |group: &&Vec<u32>| {
            let mut ends: Vec<[u32; 2]> = group.iter().map(|&h| edge_of(triangles, h)).collect();
            ends.iter_mut().for_each(|ends| ends.sort_unstable());
            ends.sort_unstable();
            ends.chunk_by(|a, b| a == b).any(|same| same.len() > 2)
        };
        self.edges.iter().filter(is_stuck).cloned().collect()
    }
}

/// The pairs of the half-edges `group` of one edge; `None` where their triangles do not alternate.
///
/// A triangle whose half-edge runs with the edge has the empty space behind it in the order around the edge, one that
/// runs against it before it.
fn pairs_at(draft: &Draft, group: &[u32], across: Across) -> Option<Vec<[u32; 2]>> {
    let [a, b] = edge_of(&draft.triangles, group[0]);
    let place = |v: u32| draft.positions[v as usize];
    let apexes: Vec<_> =
        group.iter().map(|&h| place(draft.triangles[h as usize / 3][prev_corner(h) as usize % 3])).collect();
    let order: Vec<u32> = radial_order(place(a), place(b), &apexes)?.into_iter().map(|i| group[i]).collect();
    let is_with = |h: u32| edge_of(&draft.triangles, h)[0] == a;
    let after = |i: usize| order[(i + 1) % order.len()];
    let alternates = (0..order.len()).all(|i| is_with(order[i]) != is_with(after(i)));
    let opens = |h: u32| is_with(h) == (across == Across::Void);
    alternates.then(|| (0..order.len()).filter(|&i| opens(order[i])).map(|i| [order[i], after(i)]).collect())
}

/// Divides the edges of `groups` in their middle, on the print lattice; gives their number.
fn divide_edges(draft: &mut Draft, groups: &[Vec<u32>], budget: &Budget) -> Result<u64, Stopped> {
    let reach = draft.positions.iter().fold(0.0, |reach, p| p.abs().max_element().max(reach));
    let Some(pitch) = print_pitch(reach) else { return Ok(0) };
    let mut middles = Vec::new();
    let mut divided = 0;
    draft.reserve_vertices(groups.len());
    for group in groups {
        let ends = edge_of(&draft.triangles, group[0]).map(|v| draft.positions[v as usize]);
        let middle = ((ends[0] + ends[1]) / 2.0).map(|x| (x / pitch).round_ties_even() * pitch);
        if ends.contains(&middle) {
            continue;
        }
        let v = draft.positions.len() as u32;
        draft.vertex_origin.push(draft.vertex_origin[edge_of(&draft.triangles, group[0])[0] as usize]);
        draft.positions.push(middle);
        middles.extend(group.iter().map(|&h| (h, v)));
        divided += 1;
    }
    middles.sort_unstable();
    for of_triangle in middles.chunk_by(|a, b| a.0 / 3 == b.0 / 3) {
        budget.spend(1)?;
        let t = of_triangle[0].0 / 3;
        let on = [0, 1, 2].map(|c| {
            of_triangle.iter().filter(|&&(h, _)| h == 3 * t + c).map(|&(_, v)| v).collect::<Vec<u32>>()
        });
        draft.replace(t, &divide(draft.triangles[t as usize], on.each_ref().map(Vec::as_slice)));
    }
    Ok(divided)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;

    /// Two tetrahedra that share the edge from 0 to 1.
    fn sharing_an_edge() -> Draft {
        let positions = [[0, 0, 0], [0, 0, 4], [4, 0, 2], [4, 4, 2], [-4, 0, 2], [-4, -4, 2]];
        let solid = |a, b, c, d| [[a, c, b], [a, b, d], [b, c, d], [c, a, d]];
        Draft {
            positions: positions.map(|p| DVec3::from_array(p.map(f64::from))).to_vec(),
            vertex_origin: (0..6).collect(),
            triangles: [solid(0, 1, 2, 3), solid(0, 1, 4, 5)].concat(),
            triangle_origin: (0..8).collect(),
            two_sided: Vec::new(),
            blends: Default::default(),
            polygons: Default::default(),
        }
    }

    fn components(draft: &Draft) -> usize {
        let mut sets = mesh::UnionFind::new(draft.positions.len());
        for [a, b, c] in &draft.triangles {
            sets.unite(*a, *b);
            sets.unite(*a, *c);
        }
        sets.into_components().count as usize
    }

    fn edges_with_other_than_two(draft: &Draft) -> usize {
        let groups =
            EdgeGroups::build(&draft.triangles, draft.positions.len(), &Budget::unlimited()).unwrap();
        groups.iter().filter(|group| group.len() != 2).count()
    }

    #[test]
    fn across_the_solid_bodies_come_apart() {
        let mut draft = sharing_an_edge();
        let changes = pair_sheets(&mut draft, Across::Solid, &Budget::unlimited()).unwrap();
        assert_eq!(changes.counts[..3], [("edges_paired", 1), ("edges_divided", 0), ("vertices_copied", 2)]);
        assert_eq!((components(&draft), edges_with_other_than_two(&draft)), (2, 0));
    }

    #[test]
    fn bodies_that_are_inside_out_come_apart_as_well_and_are_turned() {
        let mut draft = sharing_an_edge();
        draft.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        let changes = pair_sheets(&mut draft, Across::Solid, &Budget::unlimited()).unwrap();
        assert_eq!((changes.count("triangles_flipped"), changes.count("vertices_copied")), (8, 2));
        assert_eq!((components(&draft), edges_with_other_than_two(&draft)), (2, 0));
        let mut outward = sharing_an_edge();
        pair_sheets(&mut outward, Across::Solid, &Budget::unlimited()).unwrap();
        assert_eq!(draft, outward);
    }

    #[test]
    fn across_the_empty_space_bodies_become_one_and_the_edge_is_divided() {
        let mut draft = sharing_an_edge();
        let changes = pair_sheets(&mut draft, Across::Void, &Budget::unlimited()).unwrap();
        // Both ends keep one fan, so that only a vertex between them can come apart.
        assert_eq!(changes.counts[..3], [("edges_paired", 2), ("edges_divided", 1), ("vertices_copied", 1)]);
        assert_eq!((components(&draft), edges_with_other_than_two(&draft)), (1, 0));
        assert_eq!(draft.positions[6..], [DVec3::Z * 2.0; 2]);
        assert_eq!(draft.triangles.len(), 12);
        assert!(draft.check().is_empty());
    }

    #[test]
    fn sheets_that_do_not_alternate_are_left_as_they_are() {
        let mut draft = sharing_an_edge();
        draft.triangles.iter_mut().skip(4).for_each(|t| t.swap(0, 1));
        let before = draft.clone();
        let changes = pair_sheets(&mut draft, Across::Solid, &Budget::unlimited()).unwrap();
        assert_eq!((changes.count("edges_paired"), draft), (0, before));
    }
}
