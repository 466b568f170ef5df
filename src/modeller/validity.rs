//! Whether a polyhedron is a solid: every rule a named check, decided exactly.

use super::contact::{Boxes, meets_beyond_shared};
use super::nesting;
use super::point::Place;
use super::solid::Solid;
use crate::budget::{Budget, Stopped};
use crate::mesh::polyhedron::{Counts, FaceId, HalfEdgeId, TopologyFault, VertexId};
use std::cmp::Ordering;

/// A rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Rule {
    /// Half-edges, loops and fans are sound: every edge has two faces, so the surface is closed, manifold and without
    /// border.
    Closed,
    /// Each vertex is the one point of the planes of all its faces.
    Vertices,
    /// Each edge has two different ends and two planes that are not parallel.
    Edges,
    /// The loops of a face do not touch themselves.
    LoopsSimple,
    /// The loops of a face do not touch each other, and the interior ones lie inside the exterior one.
    LoopsNested,
    /// The exterior loop of a face turns counter-clockwise around its normal, the interior ones clockwise.
    Orientation,
    /// V - E + F - R = 2 (S - H) has a whole solution H that is not negative.
    Euler,
    /// No face meets another but in common vertices and edges.
    Disjoint,
    /// One shell points outward, and all others bound cavities inside it.
    OneVolume,
}

impl Rule {
    /// All rules, in the order in which they are checked.
    pub const ALL: [Self; 9] = [
        Self::Closed,
        Self::Vertices,
        Self::Edges,
        Self::LoopsSimple,
        Self::LoopsNested,
        Self::Orientation,
        Self::Euler,
        Self::Disjoint,
        Self::OneVolume,
    ];

    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Closed => "closed",
            Self::Vertices => "vertices",
            Self::Edges => "edges",
            Self::LoopsSimple => "loops-simple",
            Self::LoopsNested => "loops-nested",
            Self::Orientation => "orientation",
            Self::Euler => "euler",
            Self::Disjoint => "disjoint",
            Self::OneVolume => "one-volume",
        }
    }
}

/// A broken rule, with the first elements that show it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// The rule.
    pub rule: Rule,
    /// Faces that show it.
    pub faces: Vec<FaceId>,
    /// Vertices that show it.
    pub vertices: Vec<VertexId>,
}

/// What a check of the whole solid found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Validity {
    /// V, E, F, R and S.
    pub counts: Counts,
    /// H, the number of through-holes, when Euler's formula has a solution.
    pub genus: Option<usize>,
    /// The first fault of each broken rule; none for a valid solid.
    pub faults: Vec<Fault>,
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
            faults.push(Fault { rule: Rule::Euler, faces: Vec::new(), vertices: Vec::new() });
        }
        let all: Vec<FaceId> = solid.topology.faces().collect();
        faults.extend(check_faces(solid, &all, budget)?);
        if faults.is_empty() {
            faults.extend(nesting::check(solid, budget)?);
        }
    }
    Ok(Validity { counts, genus, faults })
}

/// Checks the rules that `changed` faces can break: those of the faces, and that none of them meets any face.
pub(super) fn check_faces(solid: &Solid, changed: &[FaceId], budget: &Budget) -> Result<Vec<Fault>, Stopped> {
    for &f in changed {
        budget.spend(solid.topology.sides(f).count() as u64)?;
        if let Some(fault) = edges_and_vertices(solid, f) {
            return Ok(vec![fault]);
        }
        if let Some(fault) = loops(solid, f) {
            return Ok(vec![fault]);
        }
    }
    Ok(disjoint(solid, changed, budget)?.into_iter().collect())
}

fn topology_fault(solid: &Solid, fault: TopologyFault) -> Fault {
    let (faces, vertices) = match fault {
        TopologyFault::Opposite(h) | TopologyFault::Origin(h) | TopologyFault::Loop(h) => {
            (vec![solid.topology.face(h)], vec![])
        }
        TopologyFault::ShortLoop(f) => (vec![f], vec![]),
        TopologyFault::RepeatedVertex(f, v) => (vec![f], vec![v]),
        TopologyFault::Fan(v) | TopologyFault::FewFaces(v) => (vec![], vec![v]),
    };
    Fault { rule: Rule::Closed, faces, vertices }
}

fn edges_and_vertices(solid: &Solid, f: FaceId) -> Option<Fault> {
    let topology = &solid.topology;
    for h in topology.sides(f) {
        let other = topology.face(topology.opposite(h));
        let v = topology.origin(h);
        if solid.plane(f).side(solid.point(v)) != Ordering::Equal {
            return Some(Fault { rule: Rule::Vertices, faces: vec![f], vertices: vec![v] });
        }
        let [from, to] = solid.ends(h);
        if from == to || solid.plane(f).is_parallel(solid.plane(other)) {
            let vertices = vec![v, topology.destination(h)];
            return Some(Fault { rule: Rule::Edges, faces: vec![f, other], vertices });
        }
    }
    None
}

/// The rules of the loops of one face.
fn loops(solid: &Solid, f: FaceId) -> Option<Fault> {
    let topology = &solid.topology;
    let sides: Vec<(HalfEdgeId, usize)> = topology
        .loop_starts(f)
        .enumerate()
        .flat_map(|(i, h)| topology.loop_of(h).map(move |h| (h, i)))
        .collect();
    if let Some([a, b]) = first_crossing(solid, f, &sides) {
        let rule = if a.1 == b.1 { Rule::LoopsSimple } else { Rule::LoopsNested };
        let vertices = vec![topology.origin(a.0), topology.origin(b.0)];
        return Some(Fault { rule, faces: vec![f], vertices });
    }
    let view = solid.view(f);
    for (i, start) in topology.loop_starts(f).enumerate() {
        let is_counter_clockwise = turns_counter_clockwise(solid, f, start);
        let at = topology.origin(start);
        if is_counter_clockwise != (i == 0) {
            return Some(Fault { rule: Rule::Orientation, faces: vec![f], vertices: vec![at] });
        }
        let is_in = |loop_start: HalfEdgeId| {
            view.locate(solid.point(at), topology.loop_of(loop_start).map(|h| solid.ends(h))) == Place::Inside
        };
        let is_nested = i == 0
            || topology.loop_starts(f).enumerate().all(|(j, other)| j == i || is_in(other) == (j == 0));
        if !is_nested {
            return Some(Fault { rule: Rule::LoopsNested, faces: vec![f], vertices: vec![at] });
        }
    }
    None
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

/// Two sides of a face that meet elsewhere than at the vertex between them.
fn first_crossing(
    solid: &Solid,
    f: FaceId,
    sides: &[(HalfEdgeId, usize)],
) -> Option<[(HalfEdgeId, usize); 2]> {
    let view = solid.view(f);
    let range = |h: HalfEdgeId| {
        let [a, b] = solid.ends(h).map(|p| p.near[view.u]);
        let margin = (a.abs() + b.abs()) * f64::EPSILON;
        (a.min(b) - margin, a.max(b) + margin)
    };
    let mut order: Vec<(f64, f64, usize)> =
        sides.iter().enumerate().map(|(i, &(h, _))| (range(h).0, range(h).1, i)).collect();
    order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.2.cmp(&b.2)));
    for (k, &(_, high, i)) in order.iter().enumerate() {
        for &(low, _, j) in &order[k + 1..] {
            if low > high {
                break;
            }
            if do_sides_meet(solid, f, sides[i].0, sides[j].0) {
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
fn disjoint(solid: &Solid, changed: &[FaceId], budget: &Budget) -> Result<Option<Fault>, Stopped> {
    let topology = &solid.topology;
    let boxes = Boxes::of(solid, budget)?;
    let mut is_changed = vec![false; topology.face_count()];
    changed.iter().for_each(|f| is_changed[f.index()] = true);
    let mut found = None;
    boxes.each_pair(&is_changed, budget, |f, h| {
        if found.is_none() && meets_beyond_shared(solid, h, f) {
            let vertices = vec![topology.origin(h), topology.destination(h)];
            let faces = vec![f, topology.face(h), topology.face(topology.opposite(h))];
            found = Some(Fault { rule: Rule::Disjoint, faces, vertices });
        }
        found.is_none()
    })?;
    Ok(found)
}
