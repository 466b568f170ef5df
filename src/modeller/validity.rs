//! Whether a polyhedron is a solid: every rule a named check, decided exactly.

use super::contact::{Boxes, do_meet, grown, meets_beyond_shared};
use super::journal::Moves;
use super::near::{face_box, faces_near};
use super::nesting;
use super::point::PointLocation;
use super::rule::{BrokenRule, Rule};
use super::solid::Solid;
use crate::budget::{Budget, Stopped};
use crate::geom::Aabb;
use crate::mesh::polyhedron::{EulerCounts, FaceId, HalfEdgeId, TopologyFault, VertexId};
use std::cmp::Ordering;

/// What a check of the whole solid found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Validity {
    /// V, E, F, R and S.
    pub counts: EulerCounts,
    /// H, the number of through-holes, when Euler's formula has a solution.
    pub genus: Option<usize>,
    /// The first fault of each broken rule; none for a valid solid.
    pub faults: Vec<BrokenRule>,
}

impl Validity {
    /// True when no rule is broken.
    pub fn is_valid(&self) -> bool {
        self.faults.is_empty()
    }
}

/// Checks every rule on the whole solid. Later rules are not checked where an earlier one makes them meaningless.
///
/// # Errors
/// When the budget stops the run.
pub fn check(solid: &Solid, budget: &Budget) -> Result<Validity, Stopped> {
    let counts = solid.topology.counts();
    let genus = counts.genus();
    let mut faults = Vec::new();
    if let Some(fault) = solid.topology.check().first() {
        faults.push(topology_fault(solid, *fault));
    } else {
        if genus.is_none() {
            faults.push(BrokenRule { rule: Rule::Euler, faces: Vec::new(), vertices: Vec::new() });
        }
        let all: Vec<FaceId> = solid.topology.faces().collect();
        faults.extend(check_faces(solid, &all, budget)?);
        if faults.is_empty() {
            faults.extend(nesting::check(solid, budget)?);
        }
    }
    Ok(Validity { counts, genus, faults })
}

/// Checks the rules of `faces`, all of their vertices taken as moved, and that none of them meets any face.
fn check_faces(solid: &Solid, faces: &[FaceId], budget: &Budget) -> Result<Vec<BrokenRule>, Stopped> {
    if let Some(fault) = rules_of_faces(solid, faces, &|_| true, budget)? {
        return Ok(vec![fault]);
    }
    Ok(disjoint(solid, faces, budget)?.into_iter().collect())
}

/// Checks the rules that can be broken by what moved. Edges and loops without a moved vertex are as they were, and so are
/// faces without one that no moved edge comes near.
pub(super) fn check_changed(
    solid: &Solid,
    moves: &Moves,
    budget: &Budget,
) -> Result<Vec<BrokenRule>, Stopped> {
    let has_moved = |v: VertexId| moves.of(v).is_some();
    if let Some(fault) = rules_of_faces(solid, &moves.faces, &has_moved, budget)? {
        return Ok(vec![fault]);
    }
    if moves.faces.len() * 8 > solid.topology.face_count() {
        return Ok(disjoint(solid, &moves.faces, budget)?.into_iter().collect());
    }
    let fault = match moved_edge_on_face(solid, moves, budget)? {
        None => edge_on_moved_face(solid, moves, budget)?,
        found => found,
    };
    Ok(fault.into_iter().collect())
}

fn edge_box(solid: &Solid, h: HalfEdgeId) -> Aabb {
    grown(Aabb::of(solid.ends(h).map(|p| p.near)))
}

fn not_disjoint(solid: &Solid, h: HalfEdgeId, f: FaceId) -> BrokenRule {
    let topology = &solid.topology;
    let vertices = vec![topology.origin(h), topology.destination(h)];
    let faces = vec![f, topology.face(h), topology.face(topology.opposite(h))];
    BrokenRule { rule: Rule::Disjoint, faces, vertices }
}

/// An edge with a moved end that meets a face which it is not beside.
fn moved_edge_on_face(solid: &Solid, moves: &Moves, budget: &Budget) -> Result<Option<BrokenRule>, Stopped> {
    let topology = &solid.topology;
    let mut edges: Vec<HalfEdgeId> = moves
        .reach
        .iter()
        .filter_map(|(v, _)| topology.leaving(*v))
        .flat_map(|h| topology.around(h))
        .map(|h| h.min(topology.opposite(h)))
        .collect();
    edges.sort_unstable();
    edges.dedup();
    for h in edges {
        let beside = [topology.face(h), topology.face(topology.opposite(h))];
        let near = faces_near(solid, &edge_box(solid, h), budget)?;
        budget.spend(near.len() as u64 + 1)?;
        let met = near.into_iter().find(|f| !beside.contains(f) && meets_beyond_shared(solid, h, *f));
        if let Some(f) = met {
            return Ok(Some(not_disjoint(solid, h, f)));
        }
    }
    Ok(None)
}

/// An edge that stayed and meets a face that moved, or one that has grown by the move of its border.
fn edge_on_moved_face(solid: &Solid, moves: &Moves, budget: &Budget) -> Result<Option<BrokenRule>, Stopped> {
    let topology = &solid.topology;
    let everywhere = moves.reach.iter().fold(Aabb::EMPTY, |all, (_, reach)| all.union(*reach));
    for &f in &moves.faces {
        let bounds = face_box(solid, f);
        // What a face in its old plane covers anew lies between the old and the new places of its sides.
        let anew = if moves.planes.binary_search(&f).is_ok() {
            bounds
        } else {
            let of_side = |h: HalfEdgeId| {
                let ends = [topology.origin(h), topology.destination(h)];
                let place = |v: VertexId| {
                    let near = solid.point(v).near;
                    moves.of(v).copied().unwrap_or(Aabb { min: near, max: near })
                };
                ends.iter().any(|&v| moves.of(v).is_some()).then(|| ends.map(place))
            };
            let start = if moves.has_new_topology { everywhere } else { Aabb::EMPTY };
            let sides = topology.sides(f).filter_map(of_side).flatten();
            grown(sides.fold(start, Aabb::union))
        };
        let query = Aabb { min: anew.min.max(bounds.min), max: anew.max.min(bounds.max) };
        for g in faces_near(solid, &query, budget)?.into_iter().filter(|&g| g != f) {
            budget.spend(1)?;
            let meets = |h: &HalfEdgeId| {
                let has_moved = |v: VertexId| moves.of(v).is_some();
                topology.face(topology.opposite(*h)) != f
                    && !has_moved(topology.origin(*h))
                    && !has_moved(topology.destination(*h))
                    && do_meet(&edge_box(solid, *h), &query)
                    && meets_beyond_shared(solid, *h, f)
            };
            if let Some(h) = topology.sides(g).find(meets) {
                return Ok(Some(not_disjoint(solid, h, f)));
            }
        }
    }
    Ok(None)
}

/// The first broken rule of single faces.
fn rules_of_faces(
    solid: &Solid,
    faces: &[FaceId],
    has_moved: &dyn Fn(VertexId) -> bool,
    budget: &Budget,
) -> Result<Option<BrokenRule>, Stopped> {
    for &f in faces {
        budget.spend(solid.topology.sides(f).count() as u64)?;
        let fault = edges_and_vertices(solid, f, has_moved).or_else(|| loops(solid, f, has_moved));
        if fault.is_some() {
            return Ok(fault);
        }
    }
    Ok(None)
}

fn topology_fault(solid: &Solid, fault: TopologyFault) -> BrokenRule {
    let (faces, vertices) = match fault {
        TopologyFault::Opposite(h) | TopologyFault::Origin(h) | TopologyFault::Loop(h) => {
            (vec![solid.topology.face(h)], vec![])
        }
        TopologyFault::ShortLoop(f) => (vec![f], vec![]),
        TopologyFault::RepeatedVertex(f, v) => (vec![f], vec![v]),
        TopologyFault::Fan(v) | TopologyFault::FewFaces(v) => (vec![], vec![v]),
    };
    BrokenRule { rule: Rule::Closed, faces, vertices }
}

fn edges_and_vertices(solid: &Solid, f: FaceId, has_moved: &dyn Fn(VertexId) -> bool) -> Option<BrokenRule> {
    let topology = &solid.topology;
    for h in topology.sides(f) {
        let other = topology.face(topology.opposite(h));
        let v = topology.origin(h);
        if !has_moved(v) && !has_moved(topology.destination(h)) {
            continue;
        }
        if solid.plane(f).side(solid.point(v)) != Ordering::Equal {
            return Some(BrokenRule { rule: Rule::Vertices, faces: vec![f], vertices: vec![v] });
        }
        let [from, to] = solid.ends(h);
        if from == to || solid.plane(f).is_parallel(solid.plane(other)) {
            let vertices = vec![v, topology.destination(h)];
            return Some(BrokenRule { rule: Rule::Edges, faces: vec![f, other], vertices });
        }
    }
    None
}

/// The rules of the loops of one face.
fn loops(solid: &Solid, f: FaceId, has_moved: &dyn Fn(VertexId) -> bool) -> Option<BrokenRule> {
    let topology = &solid.topology;
    let mut sides = Vec::new();
    let mut has_loop_moved = Vec::new();
    for (i, start) in topology.loop_starts(f).enumerate() {
        let mut any = false;
        for h in topology.loop_of(start) {
            let moved = has_moved(topology.origin(h)) || has_moved(topology.destination(h));
            any |= moved;
            sides.push(FaceSide { h, in_loop: i, has_moved: moved });
        }
        has_loop_moved.push(any);
    }
    if let Some([a, b]) = first_crossing(solid, f, &sides) {
        let rule = if a.in_loop == b.in_loop { Rule::LoopsSimple } else { Rule::LoopsNested };
        let vertices = vec![topology.origin(a.h), topology.origin(b.h)];
        return Some(BrokenRule { rule, faces: vec![f], vertices });
    }
    let starts: Vec<HalfEdgeId> = topology.loop_starts(f).collect();
    let view = solid.view(f);
    let is_in = |inner: usize, outer: usize| {
        let at = solid.point(topology.origin(starts[inner]));
        view.locate(at, topology.loop_of(starts[outer]).map(|h| solid.ends(h))) == PointLocation::Inside
    };
    let fault = |rule: Rule, i: usize| {
        Some(BrokenRule { rule, faces: vec![f], vertices: vec![topology.origin(starts[i])] })
    };
    for i in (0..starts.len()).filter(|&i| has_loop_moved[i]) {
        if turns_counter_clockwise(solid, f, starts[i]) != (i == 0) {
            return fault(Rule::Orientation, i);
        }
        for j in (0..starts.len()).filter(|&j| j != i) {
            // Interior loops are inside the exterior one and outside each other. Of two that moved one way is asked
            // from either.
            if i > 0 && is_in(i, j) != (j == 0) {
                return fault(Rule::LoopsNested, i);
            }
            if !has_loop_moved[j] && is_in(j, i) != (i == 0) {
                return fault(Rule::LoopsNested, j);
            }
        }
    }
    None
}

/// A side of a face.
#[derive(Clone, Copy)]
struct FaceSide {
    h: HalfEdgeId,
    /// The loop, the exterior one first.
    in_loop: usize,
    has_moved: bool,
}

/// The turn of a simple loop: that at its first vertex in the order of the view.
fn turns_counter_clockwise(solid: &Solid, f: FaceId, start: HalfEdgeId) -> bool {
    let topology = &solid.topology;
    let view = solid.view(f);
    let order = |a: &HalfEdgeId, b: &HalfEdgeId| {
        let [p, q] = [a, b].map(|&h| solid.point(topology.origin(h)));
        p.compare(q, view.u).then_with(|| p.compare(q, view.v))
    };
    let Some(first) = topology.loop_of(start).min_by(order) else { return false };
    let before = solid.point(topology.origin(topology.previous(first)));
    let [at, after] = solid.ends(first);
    view.turn(before, at, after) == Ordering::Greater
}

/// Two sides of a face, one of them moved, that meet elsewhere than at the vertex between them.
fn first_crossing(solid: &Solid, f: FaceId, sides: &[FaceSide]) -> Option<[FaceSide; 2]> {
    let view = solid.view(f);
    let range = |h: HalfEdgeId, axis: usize| {
        let [a, b] = solid.ends(h).map(|p| p.near[axis]);
        let margin = (a.abs() + b.abs()) * f64::EPSILON;
        (a.min(b) - margin, a.max(b) + margin)
    };
    let boxes: Vec<[(f64, f64); 2]> =
        sides.iter().map(|side| [view.u, view.v].map(|axis| range(side.h, axis))).collect();
    let are_near =
        |i: usize, j: usize| (0..2).all(|k| boxes[i][k].0 <= boxes[j][k].1 && boxes[j][k].0 <= boxes[i][k].1);
    let meet = |i: usize, j: usize| are_near(i, j) && do_sides_meet(solid, f, sides[i].h, sides[j].h);
    let moved: Vec<usize> = (0..sides.len()).filter(|&i| sides[i].has_moved).collect();
    if moved.len() * 8 < sides.len() {
        let other = |&i: &usize| (0..sides.len()).find(|&j| j != i && meet(i, j)).map(|j| (i, j));
        return moved.iter().find_map(other).map(|(i, j)| [sides[i.min(j)], sides[i.max(j)]]);
    }
    let mut order: Vec<usize> = (0..sides.len()).collect();
    order.sort_unstable_by(|&i, &j| boxes[i][0].0.total_cmp(&boxes[j][0].0).then(i.cmp(&j)));
    for (k, &i) in order.iter().enumerate() {
        for &j in &order[k + 1..] {
            if boxes[j][0].0 > boxes[i][0].1 {
                break;
            }
            if (sides[i].has_moved || sides[j].has_moved) && meet(i, j) {
                return Some([sides[i.min(j)], sides[i.max(j)]]);
            }
        }
    }
    None
}

/// Whether two different sides of a face meet in more than a common end.
fn do_sides_meet(solid: &Solid, f: FaceId, g: HalfEdgeId, h: HalfEdgeId) -> bool {
    let topology = &solid.topology;
    let ids = |h| [topology.origin(h), topology.destination(h)];
    super::contact::do_segments_meet(solid, solid.view(f), ids(g), ids(h))
}

/// The first pair of faces, one of them changed, that meet in more than common vertices and edges: an edge of one meets
/// the other.
fn disjoint(solid: &Solid, changed: &[FaceId], budget: &Budget) -> Result<Option<BrokenRule>, Stopped> {
    let topology = &solid.topology;
    let boxes = Boxes::of(solid, budget)?;
    let mut is_changed = vec![false; topology.face_count()];
    changed.iter().for_each(|f| is_changed[f.index()] = true);
    let mut found = None;
    boxes.each_pair(&is_changed, budget, |f, h| {
        if found.is_none() && meets_beyond_shared(solid, h, f) {
            let vertices = vec![topology.origin(h), topology.destination(h)];
            let faces = vec![f, topology.face(h), topology.face(topology.opposite(h))];
            found = Some(BrokenRule { rule: Rule::Disjoint, faces, vertices });
        }
        found.is_none()
    })?;
    Ok(found)
}
