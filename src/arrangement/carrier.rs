//! Plane carriers: the triangles of one plane that overlap share one triangulation, so that copies agree by construction.

use super::constraints::{Constrained, Constraint, ConstraintLine, CrossingAccount, TagSets};
use super::error::ArrangementError;
use super::kernel::{ClusterKernel, PlaneView};
use super::point::{ArrangementPoint, Definition};
use super::triangulation::{CarrierView, MANY, NONE, Triangulation};
use crate::budget::{Budget, Charge};
use crate::geom::Sign;
use rustc_hash::FxHashMap;

/// What one plane's triangles are to be divided by. Points are those of the cluster.
#[derive(Debug, Default)]
pub(super) struct Carrier {
    /// The triangles, ascending; the first names the plane.
    pub(super) triangles: Vec<u32>,
    /// Points on them, ascending, other than their corners.
    pub(super) points: Vec<u32>,
    /// Segments in the plane of the triangle, where others pass through it: their ends and a triangle that does; ascending.
    pub(super) segments: Vec<([u32; 2], u32)>,
}

/// The pieces of one carrier.
#[derive(Debug, Default)]
pub(super) struct CarrierPieces<'b> {
    /// Corners of each, as points; counter-clockwise as the first triangle of the carrier.
    pub(super) corners: Vec<[u32; 3]>,
    /// The triangles that cover them, one piece after the other, with `true` for those that turn the other way.
    pub(super) sources: Vec<(u32, bool)>,
    /// Where in `sources` those of each piece end.
    pub(super) source_ends: Vec<u32>,
    /// The points that are new, numbered after those of the cluster.
    pub(super) own: Vec<ArrangementPoint>,
    /// What they take.
    pub(super) charges: Vec<Charge<'b>>,
}

/// Divides the triangles of a carrier.
pub(super) fn divide<'b>(
    carrier: &Carrier,
    kernel: &ClusterKernel,
    shared: &[ArrangementPoint],
    vertex_of: &[u32],
    account: &CrossingAccount<'b>,
) -> Result<CarrierPieces<'b>, ArrangementError> {
    let budget = account.budget;
    let rep = carrier.triangles[0];
    let corners = |t: u32| kernel.triangles[t as usize].map(|v| vertex_of[v as usize]);
    let is_single = carrier.triangles.len() == 1;
    if is_single && carrier.points.is_empty() && carrier.segments.is_empty() {
        return Ok(CarrierPieces {
            corners: vec![corners(rep)],
            sources: vec![(rep, false)],
            source_ends: vec![1],
            ..CarrierPieces::default()
        });
    }
    let view =
        kernel.view(rep).ok_or(ArrangementError::Inconsistent("a degenerate triangle in a cluster"))?;
    let mut sight = CarrierView::new(kernel, view, shared);
    let start = if is_single {
        corners(rep)
    } else {
        [0, 1, 2].map(|corner| sight.push(kernel.point(Definition::Far(corner))))
    };
    let mut mesh = Triangulation::of_triangle(start);
    let mut vertices: FxHashMap<u32, u32> = (0..3).map(|v| (start[v as usize], v)).collect();
    let mut to_insert = carrier.points.clone();
    if !is_single {
        to_insert.extend(carrier.triangles.iter().flat_map(|&t| corners(t)));
        to_insert.sort_unstable();
        to_insert.dedup();
    }
    let are_many = to_insert.len() >= MANY;
    if are_many {
        sort_for_walks(&mut to_insert, shared, view);
    }
    for point in to_insert {
        if vertices.contains_key(&point) {
            continue;
        }
        let last = mesh.half_edges() - 1;
        let v = mesh.insert(&sight, point, last)?;
        if are_many {
            mesh.flip_around(&sight, v);
        }
        vertices.insert(point, v);
        budget.spend(sight.take_units() + 1)?;
    }
    let mut constrained = Constrained::new(sight, mesh, account);
    let find = |point: u32| {
        vertices
            .get(&point)
            .copied()
            .ok_or(ArrangementError::Inconsistent("an end of a segment is not there"))
    };
    let mut turns = Vec::with_capacity(carrier.triangles.len());
    for &t in &carrier.triangles {
        let turn = kernel.turn(view, t);
        let [a, b, c] = kernel.triangles[t as usize];
        let [a, b, c] = if turn == Sign::Positive { [a, b, c] } else { [a, c, b] };
        for [from, to] in [[a, b], [b, c], [c, a]] {
            let ends = [find(vertex_of[from as usize])?, find(vertex_of[to as usize])?];
            let line = ConstraintLine::Edge([from.min(to), from.max(to)]);
            constrained.insert(Constraint { ends, line })?;
        }
        turns.push(turn == Sign::Negative);
    }
    for &([from, to], other) in &carrier.segments {
        let ends = [find(from)?, find(to)?];
        constrained.insert(Constraint { ends, line: ConstraintLine::Plane(other) })?;
    }
    let Constrained { mesh, sets, sight, charges, .. } = constrained;
    let mut own = sight.own;
    // Integers take most of a point, and few of these are asked for again.
    own.iter_mut().for_each(ArrangementPoint::forget_integers);
    if is_single {
        let corners = mesh.faces();
        let sources = vec![(rep, false); corners.len()];
        let source_ends = (1..=corners.len() as u32).collect();
        return Ok(CarrierPieces { corners, sources, source_ends, own, charges });
    }
    let pieces = covered(&mesh, &sets, carrier, &turns, budget)?;
    Ok(CarrierPieces { own, charges, ..pieces })
}

/// The faces that triangles of the carrier cover: from inside along the border of each, as far as the border.
fn covered(
    mesh: &Triangulation,
    sets: &TagSets,
    carrier: &Carrier,
    turns: &[bool],
    budget: &Budget,
) -> Result<CarrierPieces<'static>, ArrangementError> {
    let count = mesh.half_edges();
    let is_border = |set: u32, t: usize| sets.of(set).iter().any(|&tag| tag as usize / 3 == t);
    // The lowest half-edge of each face stands for it.
    let face = |h: u32| h.min(mesh.next(h)).min(mesh.prev(h));
    let mut covers: Vec<Vec<(u32, bool)>> = vec![Vec::new(); count as usize];
    let mut seeds: Vec<Vec<u32>> = vec![Vec::new(); carrier.triangles.len()];
    for h in 0..count {
        budget.spend(1)?;
        let set = mesh.tags[h as usize];
        if set != 0 {
            for tag in sets.of(set) {
                // The borders of the triangles were put in first, three constraints for each.
                if let Some(seeds) = seeds.get_mut(*tag as usize / 3) {
                    seeds.push(h);
                }
            }
        }
    }
    let mut reached = vec![u32::MAX; count as usize];
    for (t, mut stack) in seeds.into_iter().enumerate() {
        while let Some(h) = stack.pop() {
            budget.spend(1)?;
            let f = face(h);
            if std::mem::replace(&mut reached[f as usize], t as u32) == t as u32 {
                continue;
            }
            covers[f as usize].push((carrier.triangles[t], turns[t]));
            for h in [f, mesh.next(f), mesh.prev(f)] {
                let twin = mesh.twin(h);
                let is_border = is_border(mesh.tags[h as usize], t)
                    || (twin != NONE && is_border(mesh.tags[twin as usize], t));
                if !is_border && twin != NONE {
                    stack.push(twin);
                }
            }
        }
    }
    let mut pieces = CarrierPieces::default();
    for (f, sources) in covers.into_iter().enumerate().filter(|(_, sources)| !sources.is_empty()) {
        let f = f as u32;
        let face = [f, mesh.next(f), mesh.prev(f)];
        pieces.corners.push(face.map(|h| mesh.points[mesh.from(h) as usize]));
        pieces.sources.extend(sources);
        pieces.source_ends.push(pieces.sources.len() as u32);
    }
    Ok(pieces)
}

/// Orders many points along a curve through the squares of a grid, so that walks from one to the next are short.
fn sort_for_walks(points: &mut [u32], shared: &[ArrangementPoint], view: PlaneView) {
    let place = |p: u32| [view.u, view.v].map(|k| shared[p as usize].near[k].mid);
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for &p in points.iter() {
        let x = place(p);
        for k in 0..2 {
            low[k] = low[k].min(x[k]);
            high[k] = high[k].max(x[k]);
        }
    }
    let key = |p: u32| {
        let x = place(p);
        let cell = |k: usize| {
            let share = (x[k] - low[k]) / (high[k] - low[k]).max(f64::MIN_POSITIVE);
            (share * 65535.0) as u64
        };
        (spread(cell(0)) | spread(cell(1)) << 1, p)
    };
    points.sort_by_cached_key(|&p| key(p));
}

/// The bits of a 16-bit number with a zero between each two.
fn spread(x: u64) -> u64 {
    (0..16).fold(0, |bits, k| bits | (x >> k & 1) << (2 * k))
}
