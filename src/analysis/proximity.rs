//! The six tests of vertices, edges and faces against each other, in three classes: what meets in an area or passes
//! through (`intersect`) and what touches (`touch`), exactly, and what is near without meeting (`near`).
//!
//! Exact classes count pairs of triangles, each at the features of the lowest dimension in which they meet; near ones
//! count pairs of features of which no smaller ones are within reach of each other. Features of one triangle or with a
//! common vertex are no pair: when they are close, the triangle is a needle or a cap.

use super::welded::Welded;
use super::{Context, DefectCode, Finding, NearSearch};
use crate::budget::{CHECK_EVERY, Stopped};
use crate::geom::{DVec3, Projection, Sign, is_on_segment, orient3d};
use crate::mesh::{edge_of, prev_corner, triangle_of};
use crate::spatial::{Contact, ContactKind, NearInput, NearKind, NearPair, NearPairs, near_pairs};

/// Which kinds of features meet or are near each other, lowest dimension first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ProximityTest {
    /// Two vertices.
    VertexVertex,
    /// A vertex and an edge.
    VertexEdge,
    /// A vertex and a face.
    VertexFace,
    /// Two edges.
    EdgeEdge,
    /// An edge and a face.
    EdgeFace,
    /// Two faces.
    FaceFace,
}

/// How many pairs each test found.
pub type TestCounts = [u64; 6];

/// What the six tests found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proximity {
    /// What is near, in the unit of the file, where no edge is shorter than twice that.
    pub epsilon: f64,
    /// Pairs of triangles that share an area or pass through each other; `None` when too many meet to tell by which
    /// features.
    pub intersect: Option<TestCounts>,
    /// Pairs of triangles that touch; `None` as above.
    pub touch: Option<TestCounts>,
    /// Pairs of features that are near each other.
    pub near: TestCounts,
}

/// Pairs of boxes of each triangle after which the search for what is near is given up; a plain mesh takes about 40.
const WORK_PER_TRIANGLE: u64 = 512;

/// And this much for any mesh.
const WORK_MIN: u64 = 1 << 24;

/// Beyond these sizes of a mesh squares of what is near leave the range of f64.
const SIZES: std::ops::Range<f64> = 1e-100..1e100;

/// Searches what is near; `None` when it was not asked for or given up.
pub(super) fn search(cx: &Context<'_>, asked: NearSearch) -> Result<Option<NearPairs>, Stopped> {
    let size = cx.bounds.map_or(0.0, crate::geom::Aabb::diagonal);
    if asked == NearSearch::Off || !SIZES.contains(&size) {
        return Ok(None);
    }
    let mesh = &cx.mesh;
    let is_left_out = |t: &u32| {
        cx.collinear.binary_search(t).is_ok() || cx.repeats.binary_search_by_key(t, |r| r.triangle).is_ok()
    };
    let ids: Vec<u32> = (0..mesh.triangles.len() as u32).filter(|t| !is_left_out(t)).collect();
    let vertex_count = mesh.soup.positions.len() as u64;
    let _charge = cx.budget.charge(vertex_count * 8 + mesh.triangles.len() as u64 * 5)?;
    let (reach, owned) = (reach(cx, &ids)?, owned(mesh, &ids, cx)?);
    let input = NearInput {
        positions: &mesh.soup.positions,
        triangles: &mesh.triangles,
        ids: &ids,
        reach: &reach,
        owned: &owned,
    };
    let work_max = (WORK_PER_TRIANGLE * ids.len() as u64).max(WORK_MIN);
    near_pairs(input, |v, ends| is_face(mesh, v, ends), work_max, cx.budget)
}

/// How far the features of each vertex reach: epsilon, and at most half of its shortest edge.
fn reach(cx: &Context<'_>, ids: &[u32]) -> Result<Vec<f64>, Stopped> {
    let mut reach = vec![cx.epsilon; cx.mesh.soup.positions.len()];
    for (i, &t) in ids.iter().enumerate() {
        if i % CHECK_EVERY == 0 {
            cx.budget.check()?;
        }
        let vertices = cx.mesh.triangles[t as usize];
        let corners = cx.mesh.corners(t);
        for (k, next) in [(0, 1), (1, 2), (2, 0)] {
            let half = corners[k].distance(corners[next]) / 2.0;
            for v in [vertices[k], vertices[next]] {
                let reach = &mut reach[v as usize];
                *reach = reach.min(half);
            }
        }
    }
    Ok(reach)
}

/// The features that each triangle speaks for: those that no earlier one of `ids` has.
fn owned(mesh: &Welded<'_>, ids: &[u32], cx: &Context<'_>) -> Result<Vec<u8>, Stopped> {
    let mut owned = vec![0u8; mesh.triangles.len()];
    let mut is_seen = vec![false; mesh.soup.positions.len()];
    for (i, &t) in ids.iter().enumerate() {
        if i % CHECK_EVERY == 0 {
            cx.budget.check()?;
        }
        for (k, &v) in mesh.triangles[t as usize].iter().enumerate() {
            if !std::mem::replace(&mut is_seen[v as usize], true) {
                owned[t as usize] |= 1 << k;
            }
        }
    }
    let has_all = ids.len() == mesh.triangles.len();
    for e in 0..mesh.edges.len() {
        if e % CHECK_EVERY == 0 {
            cx.budget.check()?;
        }
        let is_in = |h: &&u32| has_all || ids.binary_search(&triangle_of(**h)).is_ok();
        if let Some(&h) = mesh.edges.group(e).iter().find(is_in) {
            owned[triangle_of(h) as usize] |= 8 << (h % 3);
        }
    }
    Ok(owned)
}

/// Whether `v` and the edge with these ends are of one triangle.
fn is_face(mesh: &Welded<'_>, v: u32, [a, b]: [u32; 2]) -> bool {
    let edge = mesh.edges.find(&mesh.triangles, [a.min(b), a.max(b)]);
    let opposite = |&h: &u32| edge_of(&mesh.triangles, prev_corner(h))[0];
    edge.is_some_and(|e| mesh.edges.group(e).iter().any(|h| opposite(h) == v))
}

impl Proximity {
    pub(super) fn of(cx: &Context<'_>) -> Option<Self> {
        let near = cx.near.as_ref()?;
        let is_complete = cx.contacts.list.len() as u64 == cx.contacts.count;
        let (mut intersect, mut touch) = ([0; 6], [0; 6]);
        for contact in &cx.contacts.list {
            let counts = if contact.kind == ContactKind::Touch { &mut touch } else { &mut intersect };
            counts[lowest_test(cx, contact) as usize] += 1;
        }
        intersect[ProximityTest::FaceFace as usize] += cx.repeats.len() as u64;
        let mut counts = [0; 6];
        for (kind, count) in NEAR_KINDS.into_iter().zip(near.counts) {
            counts[ProximityTest::from(kind) as usize] += count;
        }
        Some(Self {
            epsilon: cx.epsilon,
            intersect: is_complete.then_some(intersect),
            touch: is_complete.then_some(touch),
            near: counts,
        })
    }
}

const NEAR_KINDS: [NearKind; 5] = [
    NearKind::VertexVertex,
    NearKind::VertexEdge,
    NearKind::VertexFace,
    NearKind::EdgeEdge,
    NearKind::FaceFace,
];

impl From<NearKind> for ProximityTest {
    fn from(kind: NearKind) -> Self {
        match kind {
            NearKind::VertexVertex => Self::VertexVertex,
            NearKind::VertexEdge => Self::VertexEdge,
            NearKind::VertexFace => Self::VertexFace,
            NearKind::EdgeEdge => Self::EdgeEdge,
            NearKind::FaceFace => Self::FaceFace,
        }
    }
}

/// The features of the lowest dimension, beyond common vertices, in which two triangles of the soup meet.
pub(super) fn lowest_test(cx: &Context<'_>, contact: &Contact) -> ProximityTest {
    let [f, g] =
        [contact.a, contact.b].map(|t| cx.mesh.soup.triangles[t as usize].map(|v| cx.mesh.first_at(v)));
    let at = |v: u32| cx.mesh.position(v);
    let pairs = [(f, g), (g, f)];
    let is_any_corner = |test: &dyn Fn(DVec3, [DVec3; 3]) -> bool| {
        pairs.iter().any(|(f, g)| f.iter().any(|v| !g.contains(v) && test(at(*v), g.map(at))))
    };
    if is_any_corner(&|p, [a, b, c]| {
        is_on_segment(p, a, b) || is_on_segment(p, b, c) || is_on_segment(p, c, a)
    }) {
        return ProximityTest::VertexEdge;
    }
    if is_any_corner(&is_inside) {
        return ProximityTest::VertexFace;
    }
    let sides = |t: [u32; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
    let do_cross =
        |e: [u32; 2], h: [u32; 2]| !e.iter().any(|v| h.contains(v)) && are_crossing([e.map(at), h.map(at)]);
    if sides(f).into_iter().any(|e| sides(g).into_iter().any(|h| do_cross(e, h))) {
        return ProximityTest::EdgeEdge;
    }
    match contact.kind {
        ContactKind::Overlap => ProximityTest::FaceFace,
        ContactKind::Cross | ContactKind::Touch => ProximityTest::EdgeFace,
    }
}

/// True when `p` is exactly in the triangle and on none of its edges.
fn is_inside(p: DVec3, [a, b, c]: [DVec3; 3]) -> bool {
    let turns = |(view, turn): (Projection, Sign)| {
        [(a, b), (b, c), (c, a)].into_iter().all(|(from, to)| view.turn(from, to, p) == turn)
    };
    orient3d(a, b, c, p).is_zero() && Projection::showing([a, b, c]).is_some_and(turns)
}

/// True when two segments meet exactly in a point inside both.
fn are_crossing([[a, b], [c, d]]: [[DVec3; 2]; 2]) -> bool {
    let Some((view, _)) = Projection::showing([a, b, c]).filter(|_| orient3d(a, b, c, d).is_zero()) else {
        return false;
    };
    let are_apart = |s: Sign, t: Sign| !s.is_zero() && !t.is_zero() && s != t;
    are_apart(view.turn(a, b, c), view.turn(a, b, d)) && are_apart(view.turn(c, d, a), view.turn(c, d, b))
}

pub(super) fn find(cx: &Context<'_>) -> Result<Vec<Finding>, Stopped> {
    let Some(near) = &cx.near else { return Ok(Vec::new()) };
    let mut pairs: Vec<&NearPair> = near.list.iter().collect();
    pairs.sort_by_key(|pair| (pair.kind, pair.faces, pair.a, pair.b));
    let witness = |pair: &&NearPair| {
        let [a, b] = match pair.kind {
            NearKind::VertexVertex => [1, 1],
            NearKind::VertexEdge => [1, 2],
            NearKind::VertexFace => [1, 3],
            NearKind::EdgeEdge => [2, 2],
            NearKind::FaceFace => [3, 3],
        };
        let vertices = pair.a[..a].iter().chain(&pair.b[..b]).copied();
        let faces = pair.faces.map(|t| cx.mesh.face_of(t));
        let mut witness = cx.mesh.names().witness(faces, vertices, pair.place);
        witness.figures = vec![("distance", pair.distance)];
        witness.test = Some(pair.kind.into());
        witness
    };
    let count = near.counts.iter().sum();
    Ok(Finding::with(DefectCode::Near, count, pairs.iter().take(cx.samples).map(witness).collect()))
}

/// Whether every edge has two triangles when vertices that are near each other are one; `None` when that was not
/// searched or there are more pairs than are kept.
pub(super) fn is_closed_when_joined(cx: &Context<'_>) -> Result<Option<bool>, Stopped> {
    let Some(near) = &cx.near else { return Ok(None) };
    let pairs = || near.list.iter().filter(|pair| pair.kind == NearKind::VertexVertex);
    if pairs().count() as u64 != near.counts[NearKind::VertexVertex as usize] {
        return Ok(None);
    }
    let mut sets = crate::mesh::UnionFind::new(cx.mesh.soup.positions.len());
    for pair in pairs() {
        sets.unite(pair.a[0], pair.b[0]);
    }
    let joined = sets.into_components().of;
    super::watertight::is_closed(&cx.mesh.triangles, |v| joined[v as usize], cx.budget).map(Some)
}
