//! From triangles to their arrangement: what meets, the clusters, their pieces, and the cells around them.

use super::cells;
use super::cluster::{self, ContactPair, DividedCluster};
use super::constraints::CrossingAccount;
use super::enclosed;
use super::error::ArrangementError;
use super::point::Definition;
use super::welded::Welded;
use super::{Arrangement, Cluster};
use crate::budget::{Budget, CHECK_EVERY, Charge};
use crate::geom::DVec3;
use crate::mesh::UnionFind;
use crate::par;
use crate::spatial::Bvh;

/// Units of work of rounding a new point.
const ROUNDING: u64 = 4;

/// What an arrangement may cost, and of how many bodies it is.
#[derive(Debug, Clone, Copy)]
pub struct ArrangementOptions {
    /// Most pairs of triangles that may meet beyond common vertices and edges.
    pub pairs_max: usize,
    /// Most points inside of triangles where others that pass through cross each other, counted in each of the triangles.
    pub crossings_max: usize,
    /// Number of operands, each with its own winding numbers.
    pub operands: u8,
}

impl Default for ArrangementOptions {
    /// One operand, and two million pairs and points: about two gigabytes.
    fn default() -> Self {
        Self { pairs_max: 2_000_000, crossings_max: 2_000_000, operands: 1 }
    }
}

/// Divides `triangles` where they meet and finds the winding numbers on both sides of each piece. `operand_of` is the operand of a
/// triangle, below the number of operands.
///
/// Each operand must be closed: along every edge of the arrangement its triangles run as often one way as the other. Positions
/// that are equal are one; degenerate triangles are left out.
///
/// Spends work in proportion to the triangles, the pairs that meet and the steps of the triangulations.
///
/// # Errors
/// See [`ArrangementError`].
pub fn arrange(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    operand_of: impl Fn(u32) -> u8 + Sync,
    options: &ArrangementOptions,
    budget: &Budget,
) -> Result<Arrangement, ArrangementError> {
    arrange_in(None, positions, triangles, operand_of, options, budget)
}

/// As [`arrange`] where the hierarchy of all triangles may be `known`.
///
/// # Errors
/// See [`ArrangementError`].
pub fn arrange_in(
    known: Option<Bvh>,
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    operand_of: impl Fn(u32) -> u8 + Sync,
    options: &ArrangementOptions,
    budget: &Budget,
) -> Result<Arrangement, ArrangementError> {
    let Unwound { mut arrangement, triangles, bvh, _charges } =
        divide(known, positions, triangles, options, budget)?;
    cells::wind(&mut arrangement, &triangles, operand_of, bvh, budget)?;
    Ok(arrangement)
}

/// As [`arrange`], but it does not matter which way triangles turn or whether they are closed: the winding number of the only operand
/// is 0 on sides that can be reached from outside of the connected part that they are of, and 1 on all others.
///
/// # Errors
/// See [`ArrangementError`].
pub fn arrange_enclosed(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    options: &ArrangementOptions,
    budget: &Budget,
) -> Result<Arrangement, ArrangementError> {
    let Unwound { mut arrangement, triangles, _charges, .. } =
        divide(None, positions, triangles, options, budget)?;
    enclosed::enclose(&mut arrangement, &triangles, budget)?;
    Ok(arrangement)
}

/// An arrangement without winding numbers, and what finds them.
struct Unwound<'b> {
    arrangement: Arrangement,
    /// The triangles between the first of all vertices at one position.
    triangles: Vec<[u32; 3]>,
    bvh: Bvh,
    _charges: Vec<Charge<'b>>,
}

fn divide<'b>(
    known: Option<Bvh>,
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    options: &ArrangementOptions,
    budget: &'b Budget,
) -> Result<Unwound<'b>, ArrangementError> {
    let welded = Welded::of(positions, triangles, budget)?;
    let (pairs, bvh) = welded.meeting(known, options.pairs_max, budget)?;
    let Welded { triangles: welded, sound, .. } = welded;
    let mut arrangement = Arrangement {
        positions: positions.to_vec(),
        clusters: Vec::new(),
        new_points: Vec::new(),
        new_positions: Vec::new(),
        pieces: Vec::new(),
        planes: Vec::new(),
        source_starts: vec![0],
        sources: Vec::new(),
        operands: usize::from(options.operands.max(1)),
        windings: Vec::new(),
    };
    let charge = budget.charge(triangles.len() as u64 * 64 + pairs.len() as u64 * 600)?;
    let account = CrossingAccount::new(options.crossings_max, budget);
    let (is_met, mut charges) = divide_clusters(&mut arrangement, &welded, &pairs, &account)?;
    charges.push(charge);
    let whole = sound.iter().filter(|&&t| !is_met[t as usize]);
    arrangement.reserve_exact(whole.clone().count());
    for &t in whole {
        arrangement.push(welded[t as usize], t, [(t, false)]);
    }
    arrangement.new_positions = rounded(&arrangement, budget)?;
    Ok(Unwound { arrangement, triangles: welded, bvh, _charges: charges })
}

/// The positions of the new points.
fn rounded(arrangement: &Arrangement, budget: &Budget) -> Result<Vec<DVec3>, ArrangementError> {
    let parts = par::try_map_ranges(arrangement.new_points.len(), CHECK_EVERY / 16, |range| {
        budget.spend(ROUNDING * range.len() as u64)?;
        let rounded = |&[cluster, point]: &[u32; 2]| {
            let Cluster { kernel, points, .. } = &arrangement.clusters[cluster as usize];
            kernel.rounded(&points[point as usize])
        };
        Ok::<_, ArrangementError>(arrangement.new_points[range].iter().map(rounded).collect::<Vec<_>>())
    })?;
    Ok(parts.concat())
}

/// Divides the clusters of triangles that meet and adds their pieces; tells which triangles are in one, with what they all take.
fn divide_clusters<'b>(
    arrangement: &mut Arrangement,
    triangles: &[[u32; 3]],
    pairs: &[ContactPair],
    account: &CrossingAccount<'b>,
) -> Result<(Vec<bool>, Vec<Charge<'b>>), ArrangementError> {
    let mut is_met = vec![false; triangles.len()];
    let mut sets = UnionFind::new(triangles.len());
    for pair in pairs {
        let [a, b] = pair.triangles;
        (is_met[a as usize], is_met[b as usize]) = (true, true);
        sets.unite(a, b);
    }
    let mut met: Vec<(u32, u32)> =
        (0..triangles.len() as u32).filter(|&t| is_met[t as usize]).map(|t| (sets.find(t), t)).collect();
    met.sort_unstable();
    let mut of_cluster: Vec<(u32, ContactPair)> =
        pairs.iter().map(|&pair| (sets.find(pair.triangles[0]), pair)).collect();
    of_cluster.sort_by_key(|(cluster, pair)| (*cluster, pair.triangles));
    let groups: Vec<&[(u32, u32)]> = met.chunk_by(|a, b| a.0 == b.0).collect();
    let pair_groups: Vec<&[(u32, ContactPair)]> = of_cluster.chunk_by(|a, b| a.0 == b.0).collect();
    let positions = &arrangement.positions;
    let divided = par::try_map_ranges(groups.len(), 4, |range| {
        let one = |i: usize| {
            let members: Vec<u32> = groups[i].iter().map(|&(_, t)| t).collect();
            divide_cluster(positions, triangles, &members, pair_groups[i], account)
        };
        range.map(one).collect::<Result<Vec<_>, ArrangementError>>()
    })?;
    let mut charges = Vec::new();
    for (members, (vertices, mut divided)) in groups.iter().zip(divided.into_iter().flatten()) {
        charges.append(&mut divided.charges);
        arrangement.add(members, vertices, divided);
    }
    Ok((is_met, charges))
}

/// Divides the triangles `members`; gives their vertices, ascending, and the pieces.
fn divide_cluster<'b>(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    members: &[u32],
    pairs: &[(u32, ContactPair)],
    account: &CrossingAccount<'b>,
) -> Result<(Vec<u32>, DividedCluster<'b>), ArrangementError> {
    let mut vertices: Vec<u32> = members.iter().flat_map(|&t| triangles[t as usize]).collect();
    vertices.sort_unstable();
    vertices.dedup();
    let own = |list: &[u32], item: u32| list.binary_search(&item).unwrap_or(0) as u32;
    let corners = |&t: &u32| triangles[t as usize].map(|v| own(&vertices, v));
    let own_triangles: Vec<[u32; 3]> = members.iter().map(corners).collect();
    let own_positions = vertices.iter().map(|&v| positions[v as usize]).collect();
    let own_pairs: Vec<ContactPair> = pairs
        .iter()
        .map(|(_, pair)| ContactPair { triangles: pair.triangles.map(|t| own(members, t)), kind: pair.kind })
        .collect();
    let divided = cluster::divide_all(own_positions, own_triangles, &own_pairs, account)?;
    Ok((vertices, divided))
}

impl Arrangement {
    fn push(&mut self, corners: [u32; 3], plane: u32, sources: impl IntoIterator<Item = (u32, bool)>) {
        self.pieces.push(corners);
        self.planes.push(plane);
        self.sources.extend(sources);
        self.source_starts.push(self.sources.len() as u32);
    }

    /// Makes room for so many pieces more, each of one triangle.
    fn reserve_exact(&mut self, pieces: usize) {
        self.pieces.reserve_exact(pieces);
        self.planes.reserve_exact(pieces);
        self.sources.reserve_exact(pieces);
        self.source_starts.reserve_exact(pieces);
    }

    /// Adds the pieces of a cluster, whose new points are numbered in the order in which they are used.
    fn add(&mut self, members: &[(u32, u32)], vertices: Vec<u32>, divided: DividedCluster<'_>) {
        let DividedCluster { kernel, points, pieces, sources, .. } = divided;
        let cluster = self.clusters.len() as u32;
        let mut number = vec![u32::MAX; points.len()];
        let mut sources = sources.into_iter();
        for piece in pieces {
            let corners = piece.corners.map(|p| match points[p as usize].definition {
                Definition::Vertex(v) => vertices[v as usize],
                _ => {
                    let number = &mut number[p as usize];
                    if *number == u32::MAX {
                        *number = (self.positions.len() + self.new_points.len()) as u32;
                        self.new_points.push([cluster, p]);
                    }
                    *number
                }
            });
            let member = |t: u32| members[t as usize].1;
            let of_piece = sources.by_ref().take(piece.source_count as usize);
            self.push(corners, member(piece.plane), of_piece.map(|(t, is_turned)| (member(t), is_turned)));
        }
        let triangles = members.iter().map(|&(_, t)| t).collect();
        self.clusters.push(Cluster { kernel, points, vertices, triangles });
    }
}
