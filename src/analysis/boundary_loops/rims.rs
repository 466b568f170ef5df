//! The edges with one triangle, and how they hang together.
//!
//! Where a boundary edge ends, the rim goes on at the other end of the fan of its triangle. So two rims that touch in a
//! vertex stay two, and each is traced as a finger would follow it. A fan that ends at an edge of three triangles or
//! more has no other rim; the ends left over at such a vertex are joined in the order of their faces, and a chain
//! whose last end finds no partner stays open.

use crate::analysis::welded::Welded;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::mesh::{NO_TWIN, edge_of, next_corner, prev_corner};

/// In the place of an end without partner.
const OPEN: u32 = u32::MAX;

/// The boundary edges and how they hang together. Edge `i` has the ends `2 i`, where its half-edge starts, and
/// `2 i + 1`, where it goes.
#[derive(Debug, Default)]
pub(super) struct BoundaryEdges {
    /// Half-edges with an edge of their own, ascending.
    pub(super) half_edges: Vec<u32>,
    /// The end at which the rim goes on from each end, or [`OPEN`].
    partner: Vec<u32>,
}

impl BoundaryEdges {
    pub(super) fn of(mesh: &Welded<'_>, budget: &Budget) -> Result<Self, Stopped> {
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
    pub(super) fn trace(
        &self,
        first: u32,
        is_seen: &mut [bool],
        budget: &Budget,
    ) -> Result<(Vec<u32>, bool), Stopped> {
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

    /// The vertex at an end.
    pub(super) fn vertex(&self, end: u32, mesh: &Welded<'_>) -> u32 {
        edge_of(&mesh.triangles, self.half_edge(end))[(end % 2) as usize]
    }

    /// The half-edge of the edge that has this end.
    pub(super) fn half_edge(&self, end: u32) -> u32 {
        self.half_edges[(end / 2) as usize]
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
