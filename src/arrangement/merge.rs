//! A boundary with few triangles: the pieces of one triangle become one region again, points that nothing needs go, and
//! what is a whole triangle of the input is that triangle.
//!
//! An edge stays where the pieces beside it are of different triangles, or more than two. A point goes when no edge that
//! stays ends there, or two that are on one line. The regions of all triangles then have the same points on common edges.

use super::constraints::{Constrained, Constraint, ConstraintLine, CrossingAccount};
use super::error::ArrangementError;
use super::extract::{BoundaryPiece, SolidBoundary};
use super::triangulation::{CarrierView, MANY, NONE, Triangulation};
use super::{Arrangement, Cluster};
use crate::budget::{Budget, CHECK_EVERY};
use crate::mesh::{EdgeGroups, edge_of, triangle_of};
use crate::par;
use rustc_hash::FxHashMap;

/// A boundary as triangles over the points of an arrangement.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct MergedBoundary {
    /// Corners, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// The triangle of the input that each is a part of.
    pub sources: Vec<u32>,
    /// True for each that is its source as it was, or that turned around.
    pub is_whole: Vec<bool>,
}

/// What is left of a triangle of a cluster.
struct Remnant {
    source: u32,
    is_opposite: bool,
    /// Its border, directed, between points that stay; in the direction of the source.
    border: Vec<[u32; 2]>,
    /// Points inside of it at which others touch.
    points: Vec<u32>,
}

impl Arrangement {
    /// The triangles of a boundary, as few as its edges between different triangles of the input allow.
    ///
    /// # Errors
    /// When the budget stops the run, or there is a fault.
    pub fn merged(
        &self,
        surface: &SolidBoundary,
        budget: &Budget,
    ) -> Result<MergedBoundary, ArrangementError> {
        let clusters = self.cluster_of_triangles();
        let cluster_of = |t: u32| clusters.get(&t).copied();
        budget.spend(surface.pieces.len() as u64)?;
        let mut merged = MergedBoundary::with_capacity(surface.pieces.len());
        // Where a whole triangle ends, two of its edges do, which are not on one line.
        let mut stays_for_triangle = vec![false; self.point_count()];
        let mut is_of_divided = vec![false; self.point_count()];
        let mut divided: Vec<&BoundaryPiece> = Vec::new();
        for piece in &surface.pieces {
            let of_points = if cluster_of(piece.source).is_some() {
                divided.push(piece);
                &mut is_of_divided
            } else {
                merged.push(piece.corners, piece.source, true);
                &mut stays_for_triangle
            };
            piece.corners.iter().for_each(|&p| of_points[p as usize] = true);
        }
        // Between whole triangles nothing is to be found: only what has an edge with a divided one is looked at.
        let may_touch = |piece: &&BoundaryPiece| {
            piece.corners.iter().filter(|&&p| is_of_divided[p as usize]).count() >= 2
        };
        let near: Vec<&BoundaryPiece> = surface.pieces.iter().filter(may_touch).collect();
        let corners: Vec<[u32; 3]> = near.iter().map(|piece| piece.corners).collect();
        let groups = EdgeGroups::build(&corners, self.point_count(), budget)?;
        // For each triangle of a cluster, either way round, the half-edges of its pieces that stay.
        let mut stays: Vec<(u32, bool, [u32; 2])> = Vec::new();
        let mut ends: Vec<(u32, u32, u32)> = Vec::new();
        for (e, group) in groups.iter().enumerate() {
            if e % CHECK_EVERY == 0 {
                budget.spend(CHECK_EVERY as u64)?;
            }
            let name = |&h: &u32| {
                let piece = near[triangle_of(h) as usize];
                (piece.source, piece.is_opposite)
            };
            if group.len() == 2 && name(&group[0]) == name(&group[1]) {
                continue;
            }
            for h in group {
                let (source, is_opposite) = name(h);
                let [from, to] = edge_of(&corners, *h);
                let cluster = cluster_of(source);
                if cluster.is_some() {
                    stays.push((source, is_opposite, if is_opposite { [to, from] } else { [from, to] }));
                }
                let cluster = cluster.unwrap_or(NONE);
                let both = [(from, to, cluster), (to, from, cluster)];
                ends.extend(both.into_iter().filter(|&(point, ..)| !stays_for_triangle[point as usize]));
            }
        }
        drop((groups, corners));
        let (needed, goes) = self.needless(ends, budget)?;
        let mut inside: Vec<(u32, bool, u32)> = Vec::new();
        for piece in divided {
            let is_needed = |p: &u32| stays_for_triangle[*p as usize] || needed.binary_search(p).is_ok();
            let needed = piece.corners.into_iter().filter(is_needed);
            inside.extend(needed.map(|p| (piece.source, piece.is_opposite, p)));
        }
        let regions = regions(stays, inside, &goes)?;
        let parts = par::try_map_ranges(regions.len(), 16, |range| {
            range
                .map(|i| {
                    let cluster = clusters.get(&regions[i].source).map(|&c| &self.clusters[c as usize]);
                    let cluster = cluster.ok_or(ArrangementError::Inconsistent("a region has no cluster"))?;
                    self.triangulated(&regions[i], cluster, budget)
                })
                .collect::<Result<Vec<_>, ArrangementError>>()
        })?;
        for (region, triangles) in regions.iter().zip(parts.into_iter().flatten()) {
            let is_whole = triangles.len() == 1 && region.border.len() == 3;
            for [a, b, c] in triangles {
                let corners = if region.is_opposite { [a, c, b] } else { [a, b, c] };
                merged.push(corners, region.source, is_whole);
            }
        }
        Ok(merged)
    }

    fn cluster_of_triangles(&self) -> FxHashMap<u32, u32> {
        let members = |(c, cluster): (usize, &Cluster)| {
            cluster.triangles.iter().map(move |&t| (t, c as u32)).collect::<Vec<_>>()
        };
        self.clusters.iter().enumerate().flat_map(members).collect()
    }

    /// The number of a point in a cluster.
    fn point_in(&self, cluster: &Cluster, point: u32) -> Option<u32> {
        match (point as usize).checked_sub(self.positions.len()) {
            Some(new) => self.new_points.get(new).map(|&[_, point]| point),
            None => cluster.vertices.binary_search(&point).ok().map(|v| v as u32),
        }
    }

    /// Of the points where edges end those that stay, ascending, and those where just two end that are on one line, which go. `ends`
    /// are points with another end of an edge that stays and the cluster of a triangle there.
    fn needless(
        &self,
        mut ends: Vec<(u32, u32, u32)>,
        budget: &Budget,
    ) -> Result<(Vec<u32>, FxHashMap<u32, ()>), ArrangementError> {
        par::sort_unstable(&mut ends);
        ends.dedup_by_key(|(point, other, _)| (*point, *other));
        let (mut needed, mut goes) = (Vec::new(), FxHashMap::default());
        for (i, at) in ends.chunk_by(|a, b| a.0 == b.0).enumerate() {
            if i % CHECK_EVERY == 0 {
                budget.spend(CHECK_EVERY as u64)?;
            }
            let point = at[0].0;
            if self.is_needless(at) {
                goes.insert(point, ());
            } else {
                needed.push(point);
            }
        }
        Ok((needed, goes))
    }

    fn is_needless(&self, ends: &[(u32, u32, u32)]) -> bool {
        let &[(point, a, in_a), (_, b, in_b)] = ends else { return false };
        let Some(cluster) = self.clusters.get(in_a.min(in_b) as usize) else { return false };
        let own = [point, a, b].map(|p| self.point_in(cluster, p));
        let [Some(point), Some(a), Some(b)] = own else { return false };
        let three = [point, a, b].map(|p| &cluster.points[p as usize]);
        cluster.kernel.are_collinear(three)
    }

    /// The triangles of a region, which turn as its source.
    fn triangulated(
        &self,
        region: &Remnant,
        cluster: &Cluster,
        budget: &Budget,
    ) -> Result<Vec<[u32; 3]>, ArrangementError> {
        let fault = ArrangementError::Inconsistent("a region is not of its triangle");
        let t = cluster.triangles.binary_search(&region.source).map_err(|_| fault)?;
        let source = cluster.kernel.triangles[t];
        let corners = source.map(|v| cluster.vertices[v as usize]);
        let is_side =
            |[from, to]: &[u32; 2]| (0..3).any(|k| corners[k] == *from && corners[(k + 1) % 3] == *to);
        if region.points.is_empty() && region.border.len() == 3 && region.border.iter().all(is_side) {
            return Ok(vec![corners]);
        }
        let view = cluster.kernel.view(t as u32).ok_or(fault)?;
        let sight = CarrierView::new(&cluster.kernel, view, &cluster.points);
        let mut mesh = Triangulation::of_triangle(source);
        let mut vertices: FxHashMap<u32, u32> = (0..3).map(|k| (corners[k as usize], k)).collect();
        let mut numbers: Vec<u32> = corners.to_vec();
        let are_many = region.border.len() + region.points.len() >= MANY;
        for &point in region.border.as_flattened().iter().chain(&region.points) {
            if vertices.contains_key(&point) {
                continue;
            }
            let own = self.point_in(cluster, point).ok_or(fault)?;
            let last = mesh.half_edges() - 1;
            let v = mesh.insert(&sight, own, last)?;
            if are_many {
                mesh.flip_around(&sight, v);
            }
            if v as usize != numbers.len() {
                return Err(ArrangementError::Inconsistent("a point of a border is there twice"));
            }
            numbers.push(point);
            vertices.insert(point, v);
            budget.spend(sight.take_units() + 1)?;
        }
        let account = CrossingAccount::new(usize::MAX, budget);
        let mut constrained = Constrained::new(sight, mesh, &account);
        for ends in &region.border {
            let ends = ends.map(|p| vertices[&p]);
            constrained.insert(Constraint { ends, line: ConstraintLine::Plane(t as u32) })?;
        }
        constrained.improve()?;
        let Constrained { mesh, sight, .. } = constrained;
        if !sight.own.is_empty() {
            return Err(ArrangementError::Inconsistent("the border of a region crosses itself"));
        }
        Ok(mesh.left_of_tags().into_iter().map(|face| face.map(|v| numbers[v as usize])).collect())
    }
}

impl MergedBoundary {
    fn with_capacity(triangles: usize) -> Self {
        Self {
            triangles: Vec::with_capacity(triangles),
            sources: Vec::with_capacity(triangles),
            is_whole: Vec::with_capacity(triangles),
        }
    }

    fn push(&mut self, corners: [u32; 3], source: u32, is_whole: bool) {
        self.triangles.push(corners);
        self.sources.push(source);
        self.is_whole.push(is_whole);
    }
}

/// Joins the half-edges of each region over the points that go.
fn regions(
    mut stays: Vec<(u32, bool, [u32; 2])>,
    mut inside: Vec<(u32, bool, u32)>,
    goes: &FxHashMap<u32, ()>,
) -> Result<Vec<Remnant>, ArrangementError> {
    par::sort_unstable(&mut stays);
    par::sort_unstable(&mut inside);
    inside.dedup();
    let mut regions = Vec::new();
    for own in stays.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let after = |point: u32| {
            let i = own.partition_point(|&(.., [from, _])| from < point);
            own.get(i).filter(|&&(.., [from, _])| from == point).map(|&(.., [_, to])| to)
        };
        let mut border = Vec::new();
        for &(.., [from, mut to]) in own.iter().filter(|(.., [from, _])| !goes.contains_key(from)) {
            let mut left = own.len();
            while goes.contains_key(&to) && left > 0 {
                left -= 1;
                to = after(to).ok_or(ArrangementError::Inconsistent("a border ends"))?;
            }
            border.push([from, to]);
        }
        let (source, is_opposite) = (own[0].0, own[0].1);
        let mut on_border: Vec<u32> = border.iter().map(|&[from, _]| from).collect();
        on_border.sort_unstable();
        let first = inside.partition_point(|&(s, o, _)| (s, o) < (source, is_opposite));
        let points = inside[first..].iter().take_while(|&&(s, o, _)| (s, o) == (source, is_opposite));
        let points = points.map(|&(.., p)| p).filter(|p| on_border.binary_search(p).is_err()).collect();
        regions.push(Remnant { source, is_opposite, border, points });
    }
    Ok(regions)
}
