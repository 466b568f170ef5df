//! One cluster of triangles that meet: its points, its carriers and their pieces.

use super::carrier::{Carrier, CarrierPieces, divide};
use super::constraints::CrossingAccount;
use super::error::ArrangementError;
use super::intern::first_at_place;
use super::kernel::{ClusterKernel, EXACT};
use super::pairs::{TriangleMeeting, meeting};
use super::point::{ArrangementPoint, Definition};
use crate::budget::{Budget, Charge};
use crate::geom::DVec3;
use crate::mesh::UnionFind;
use crate::par;
use crate::spatial::ContactKind;

/// Pairs and carriers that one thread takes at a time.
const CHUNK: usize = 32;

/// A pair of triangles of a cluster, by their numbers in it.
#[derive(Debug, Clone, Copy)]
pub(super) struct ContactPair {
    pub(super) triangles: [u32; 2],
    /// How they meet; [`ContactKind::Overlap`] also for copies.
    pub(super) kind: ContactKind,
}

/// The pieces of the triangles of a cluster.
#[derive(Debug)]
pub(super) struct DividedCluster<'b> {
    pub(super) kernel: ClusterKernel,
    /// The points; the first are the vertices of the kernel.
    pub(super) points: Vec<ArrangementPoint>,
    pub(super) pieces: Vec<PlanePiece>,
    /// The triangles that cover the pieces, one piece after the other, with `true` where they turn the other way.
    pub(super) sources: Vec<(u32, bool)>,
    /// What they take.
    pub(super) charges: Vec<Charge<'b>>,
}

/// A piece of the triangles of one plane.
#[derive(Debug)]
pub(super) struct PlanePiece {
    /// Points of which no two are at one place.
    pub(super) corners: [u32; 3],
    /// The triangle that names the plane and turns the same way.
    pub(super) plane: u32,
    /// How many triangles cover it.
    pub(super) source_count: u32,
}

/// Divides triangles by each other. `positions` are different, `triangles` have an area.
pub(super) fn divide_all<'b>(
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    pairs: &[ContactPair],
    account: &CrossingAccount<'b>,
) -> Result<DividedCluster<'b>, ArrangementError> {
    let budget = account.budget;
    let kernel = ClusterKernel::new(positions, triangles);
    let (plane_of, mut carriers) = group(&kernel, pairs);
    let (mut points, vertex_of) = points_of_pairs(&kernel, pairs, &plane_of, &mut carriers, budget)?;
    let parts = par::try_map_ranges(carriers.len(), CHUNK, |range| {
        range
            .map(|c| divide(&carriers[c], &kernel, &points, &vertex_of, account))
            .collect::<Result<Vec<_>, _>>()
    })?;
    let shared = points.len() as u32;
    let parts: Vec<CarrierPieces<'_>> = parts.into_iter().flatten().collect();
    let (mut pieces, mut sources, mut charges) = (Vec::new(), Vec::new(), Vec::new());
    points.reserve_exact(parts.iter().map(|part| part.own.len()).sum());
    pieces.reserve_exact(parts.iter().map(|part| part.corners.len()).sum());
    sources.reserve_exact(parts.iter().map(|part| part.sources.len()).sum());
    for (carrier, part) in carriers.iter().zip(parts) {
        charges.extend(part.charges);
        let shift = points.len() as u32 - shared;
        let moved = |p: u32| if p < shared { p } else { p + shift };
        let plane = carrier.triangles[0];
        let mut start = 0;
        for (corners, &end) in part.corners.into_iter().zip(&part.source_ends) {
            pieces.push(PlanePiece { corners: corners.map(moved), plane, source_count: end - start });
            start = end;
        }
        sources.extend(part.sources);
        points.extend(part.own);
    }
    unite(&kernel, &mut points, &mut pieces, shared, budget)?;
    Ok(DividedCluster { kernel, points, pieces, sources, charges })
}

/// The plane of each triangle, by the lowest triangle that it is connected with by overlaps, and the carriers of these.
fn group(kernel: &ClusterKernel, pairs: &[ContactPair]) -> (Vec<u32>, Vec<Carrier>) {
    let mut sets = UnionFind::new(kernel.triangles.len());
    for pair in pairs.iter().filter(|pair| pair.kind == ContactKind::Overlap) {
        sets.unite(pair.triangles[0], pair.triangles[1]);
    }
    let plane_of: Vec<u32> = (0..kernel.triangles.len() as u32).map(|t| sets.find(t)).collect();
    let components = sets.into_components();
    let mut carriers: Vec<Carrier> =
        std::iter::repeat_with(Carrier::default).take(components.count as usize).collect();
    for (t, &c) in components.of.iter().enumerate() {
        carriers[c as usize].triangles.push(t as u32);
    }
    (plane_of, carriers)
}

/// Finds where pairs meet, gives each carrier the points and segments in it, and the vertex that each vertex is.
fn points_of_pairs(
    kernel: &ClusterKernel,
    pairs: &[ContactPair],
    plane_of: &[u32],
    carriers: &mut [Carrier],
    budget: &Budget,
) -> Result<(Vec<ArrangementPoint>, Vec<u32>), ArrangementError> {
    let meetings = par::try_map_ranges(pairs.len(), CHUNK, |range| {
        budget.spend(4 * EXACT * range.len() as u64)?;
        pairs[range]
            .iter()
            .map(|pair| match pair.kind {
                ContactKind::Overlap => Ok(TriangleMeeting::Nowhere),
                _ => meeting(kernel, pair.triangles, |t| plane_of[t as usize]),
            })
            .collect::<Result<Vec<_>, ArrangementError>>()
    })?
    .concat();
    let mut names: Vec<Definition> = meetings
        .iter()
        .filter_map(|meeting| if let TriangleMeeting::Ends(ends) = meeting { Some(*ends) } else { None })
        .flatten()
        .filter(|name| !matches!(name, Definition::Vertex(_)))
        .collect();
    par::sort_unstable(&mut names);
    names.dedup();
    let vertex_count = kernel.positions.len() as u32;
    let mut points: Vec<ArrangementPoint> =
        (0..vertex_count).map(|v| kernel.point(Definition::Vertex(v))).collect();
    for (i, &name) in names.iter().enumerate() {
        if i % 1024 == 0 {
            // Most clusters have a few.
            budget.spend((names.len() - i).min(1024) as u64 * EXACT)?;
        }
        points.push(kernel.point(name));
    }
    let all: Vec<u32> = (0..points.len() as u32).collect();
    let first = first_at_place(kernel, &points, &all, budget)?;
    let find = |name: &Definition| match name {
        Definition::Vertex(v) => Some(first[*v as usize]),
        _ => names.binary_search(name).ok().map(|i| first[vertex_count as usize + i]),
    };
    // The carrier of each triangle.
    let mut carrier_of = vec![0u32; kernel.triangles.len()];
    for (c, carrier) in carriers.iter().enumerate() {
        for &t in &carrier.triangles {
            carrier_of[t as usize] = c as u32;
        }
    }
    for (pair, meeting) in pairs.iter().zip(&meetings) {
        let both = pair.triangles.map(|t| carrier_of[t as usize] as usize);
        match meeting {
            TriangleMeeting::Nowhere => {}
            TriangleMeeting::InPlane(vertices) => {
                for c in both {
                    carriers[c].points.extend(vertices.iter().map(|&v| first[v as usize]));
                }
            }
            TriangleMeeting::Ends(ends) => {
                let [Some(a), Some(b)] = ends.each_ref().map(find) else {
                    return Err(ArrangementError::Inconsistent("a point has no number"));
                };
                for (c, other) in [(both[0], both[1]), (both[1], both[0])] {
                    carriers[c].points.extend([a, b]);
                    if a != b {
                        let plane = carriers[other].triangles[0];
                        carriers[c].segments.push(([a.min(b), a.max(b)], plane));
                    }
                }
            }
        }
    }
    for carrier in carriers {
        carrier.points.sort_unstable();
        carrier.points.dedup();
        if carrier.triangles.len() == 1 {
            let own = kernel.triangles[carrier.triangles[0] as usize].map(|v| first[v as usize]);
            carrier.points.retain(|p| !own.contains(p));
            let is_own_edge = |ends: &[u32; 2]| ends.iter().all(|p| own.contains(p));
            carrier.segments.retain(|(ends, _)| !is_own_edge(ends));
        }
        carrier.segments.sort_unstable();
        carrier.segments.dedup();
    }
    let vertex_of = first[..vertex_count as usize].to_vec();
    Ok((points, vertex_of))
}

/// Keeps one of the points at one place that different carriers made: the first.
fn unite(
    kernel: &ClusterKernel,
    points: &mut Vec<ArrangementPoint>,
    pieces: &mut [PlanePiece],
    shared: u32,
    budget: &Budget,
) -> Result<(), ArrangementError> {
    if points.len() as u32 == shared {
        return Ok(());
    }
    let mut used: Vec<u32> = pieces.iter().flat_map(|piece| piece.corners).collect();
    par::sort_unstable(&mut used);
    used.dedup();
    let first = first_at_place(kernel, points, &used, budget)?;
    // The first of each place before the others, as both lists ascend.
    let mut renamed: Vec<u32> = (0..points.len() as u32).collect();
    let mut kept = shared;
    for (&point, &first) in used.iter().zip(&first) {
        renamed[point as usize] = if point < shared || first < point {
            renamed[first as usize]
        } else {
            points.swap(kept as usize, point as usize);
            kept += 1;
            kept - 1
        };
    }
    points.truncate(kept as usize);
    points.shrink_to_fit();
    for piece in pieces {
        piece.corners = piece.corners.map(|p| renamed[p as usize]);
    }
    Ok(())
}
