//! Boundary loops: chains of edges with one triangle, the rims of holes and of open sheets.
//!
//! Where a boundary edge ends, the rim goes on at the other end of the fan of its triangle. So two rims that touch in a
//! vertex stay two, and each is traced as a finger would follow it. A fan that ends at an edge of three triangles or
//! more has no other rim; the ends left over at such a vertex are joined in the order of their faces, and a chain
//! whose last end finds no partner stays open.

use super::best_plane::BestPlane;
use super::welded::Welded;
use super::{Context, DefectCode, Finding, Witness};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::mesh::{NO_TWIN, edge_of, next_corner, prev_corner, triangle_of};

/// In the place of an end without partner.
const OPEN: u32 = u32::MAX;

/// The boundary edges and how they hang together. Edge `i` has the ends `2 i`, where its half-edge starts, and
/// `2 i + 1`, where it goes.
struct Rims {
    /// Half-edges with an edge of their own, ascending.
    half_edges: Vec<u32>,
    /// The end at which the rim goes on from each end, or [`OPEN`].
    partner: Vec<u32>,
}

pub(super) fn find(cx: &Context<'_>) -> Result<Vec<Finding>, Stopped> {
    let rims = Rims::of(&cx.mesh, cx.budget)?;
    let mut witnesses = Vec::new();
    let mut is_seen = vec![false; rims.half_edges.len()];
    let mut count = 0;
    for i in 0..rims.half_edges.len() {
        if i % CHECK_EVERY == 0 {
            cx.budget.check()?;
        }
        if is_seen[i] {
            continue;
        }
        let (chain, is_closed) = rims.trace(i as u32, &mut is_seen, cx.budget)?;
        if count < cx.samples {
            witnesses.push(rims.witness(&chain, is_closed, &cx.mesh));
        }
        count += 1;
    }
    Ok(Finding::with(DefectCode::BoundaryLoop, count as u64, witnesses))
}

impl Rims {
    fn of(mesh: &Welded<'_>, budget: &Budget) -> Result<Self, Stopped> {
        let edges = mesh.irregular_where(|triangles| triangles == 1);
        let mut half_edges: Vec<u32> = edges.iter().map(|&e| mesh.edges.group(e as usize)[0]).collect();
        half_edges.sort_unstable();
        let mut partner = vec![OPEN; half_edges.len() * 2];
        let mut left_over = Vec::new();
        for (i, &h) in half_edges.iter().enumerate() {
            if i % CHECK_EVERY == 0 {
                budget.check()?;
            }
            for (side, vertex) in edge_of(&mesh.triangles, h).into_iter().enumerate() {
                let end = 2 * i + side;
                let beyond = across_fan(mesh, h, vertex, budget)?;
                match half_edges.binary_search(&beyond) {
                    Ok(other) => {
                        let ends_here = edge_of(&mesh.triangles, beyond)[1] == vertex;
                        partner[end] = 2 * other as u32 + u32::from(ends_here);
                    }
                    Err(_) => left_over.push((vertex, end as u32)),
                }
            }
        }
        left_over.sort_unstable();
        for at_vertex in left_over.chunk_by(|a, b| a.0 == b.0) {
            for pair in at_vertex.chunks_exact(2) {
                let [a, b] = [pair[0].1, pair[1].1];
                partner[a as usize] = b;
                partner[b as usize] = a;
            }
        }
        Ok(Self { half_edges, partner })
    }

    /// The ends through which the chain of edge `first` enters its edges, in order, and whether it is closed. A closed
    /// chain begins with `first`, an open one with the last edge that is reached against its direction.
    fn trace(&self, first: u32, is_seen: &mut [bool], budget: &Budget) -> Result<(Vec<u32>, bool), Stopped> {
        let mut start = 2 * first;
        let mut steps = 0usize;
        while let partner = self.partner[start as usize]
            && partner != OPEN
            && partner != 2 * first + 1
        {
            start = partner ^ 1;
            steps += 1;
            if steps.is_multiple_of(CHECK_EVERY) {
                budget.check()?;
            }
        }
        let is_closed = self.partner[start as usize] != OPEN;
        let mut chain = vec![if is_closed { 2 * first } else { start }];
        is_seen[(chain[0] / 2) as usize] = true;
        while let Some(&enter) = chain.last() {
            let next = self.partner[(enter ^ 1) as usize];
            if next == OPEN || next == chain[0] {
                break;
            }
            is_seen[(next / 2) as usize] = true;
            chain.push(next);
            if chain.len().is_multiple_of(CHECK_EVERY) {
                budget.check()?;
            }
        }
        Ok((chain, is_closed))
    }

    fn witness(&self, chain: &[u32], is_closed: bool, mesh: &Welded<'_>) -> Witness {
        let faces = chain.iter().map(|end| mesh.face_of(triangle_of(self.half_edges[(end / 2) as usize])));
        let vertex =
            |end: u32| edge_of(&mesh.triangles, self.half_edges[(end / 2) as usize])[(end % 2) as usize];
        let mut vertices: Vec<u32> = chain.iter().map(|&end| vertex(end)).collect();
        if !is_closed {
            vertices.extend(chain.last().map(|&end| vertex(end ^ 1)));
        }
        let length = chain
            .iter()
            .map(|&end| mesh.position(vertex(end)).distance(mesh.position(vertex(end ^ 1))))
            .sum();
        let plane = BestPlane::of(vertices.iter().map(|&v| mesh.position(v)));
        let mut witness = mesh.names().witness(faces, vertices.iter().copied(), mesh.position(vertices[0]));
        witness.figures = vec![
            ("edges", chain.len() as f64),
            ("length", length),
            ("distance_from_plane", plane.deviation),
            ("is_closed", f64::from(u8::from(is_closed))),
        ];
        let h = self.half_edges[(chain[0] / 2) as usize];
        witness.anchor = Some(3 * mesh.source(triangle_of(h)) + h % 3);
        witness
    }
}

/// The half-edge at the other end of the fan to which boundary half-edge `h` belongs at its end `vertex`.
fn across_fan(mesh: &Welded<'_>, h: u32, vertex: u32, budget: &Budget) -> Result<u32, Stopped> {
    let (mut inward, mut steps) = (h, 0usize);
    loop {
        let starts_here = edge_of(&mesh.triangles, inward)[0] == vertex;
        let outward = if starts_here { prev_corner(inward) } else { next_corner(inward) };
        match mesh.twins[outward as usize] {
            NO_TWIN => return Ok(outward),
            twin => inward = twin,
        }
        steps += 1;
        if steps.is_multiple_of(CHECK_EVERY) {
            budget.check()?;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::tests::{found, soup};
    use crate::mesh::Soup;

    fn loops(mesh: &Soup) -> Vec<(Vec<u32>, bool)> {
        let finding = found(mesh, DefectCode::BoundaryLoop);
        let witnesses = finding.into_iter().flat_map(|f| f.witnesses);
        let figure = |w: &Witness, name| w.figures.iter().find(|f| f.0 == name).unwrap().1;
        witnesses
            .map(|w| (w.vertices.iter().map(|v| v.index).collect(), figure(&w, "is_closed") == 1.0))
            .collect()
    }

    #[test]
    fn a_tetrahedron_without_a_face_has_a_loop_of_three_edges() {
        let open = soup(4, &[[0, 2, 1], [0, 1, 3], [1, 2, 3]]);
        assert_eq!(loops(&open), [(vec![0, 2, 3], true)]);
    }

    #[test]
    fn the_rim_of_a_sheet_is_followed_across_a_face_that_is_turned_over() {
        assert_eq!(loops(&soup(4, &[[0, 1, 2], [0, 3, 2]])), [(vec![0, 1, 2, 3], true)]);
    }

    #[test]
    fn rims_that_touch_in_a_vertex_stay_two() {
        let bow_tie = soup(5, &[[0, 1, 2], [0, 3, 4]]);
        assert_eq!(loops(&bow_tie), [(vec![0, 1, 2], true), (vec![0, 3, 4], true)]);
    }

    #[test]
    fn pages_on_one_spine_are_joined_in_pairs_and_an_odd_one_stays_open() {
        let pages = [[0, 1, 2], [0, 1, 3], [0, 1, 4], [0, 1, 5]];
        assert_eq!(loops(&soup(6, &pages)), [(vec![1, 2, 0, 3], true), (vec![1, 4, 0, 5], true)]);
        assert_eq!(loops(&soup(5, &pages[..3])), [(vec![1, 2, 0, 3], true), (vec![1, 4, 0], false)]);
    }
}
