//! The six tests of vertices, edges and faces against each other, in three classes: what meets in an area or passes
//! through (`intersect`) and what touches (`touch`), exactly, and what is near without meeting (`near`).
//!
//! Every class counts pairs of features, each at the lowest dimension: exact classes those in whose inside faces meet
//! (see [`meeting_features`](super::meeting_features)), near ones those of which no smaller ones are within reach of each
//! other. Features of one face or with a common vertex are no pair: when they are close, the face is a needle or a cap.

use super::closed::is_closed;
use super::meeting_features::{FeatureMeeting, PolygonSides, meetings};
use super::welded::Welded;
use super::{Context, DefectCode, Finding, NearSearch, ProximityTest};
use crate::budget::{CHECK_EVERY, Stopped};
use crate::mesh::{edge_of, prev_corner, triangle_of};
use crate::spatial::{ContactKind, NearInput, NearKind, NearPair, NearPairs, near_pairs};

/// How many pairs each test found.
pub type TestCounts = [u64; 6];

/// What the six tests found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proximity {
    /// What is near, in the unit of the file, where no edge is shorter than twice that.
    pub epsilon: f64,
    /// Pairs of features in which triangles share an area or pass through each other; `None` when too many triangles meet
    /// to tell by which features.
    pub intersect: Option<TestCounts>,
    /// Pairs of features in which triangles only touch; `None` as above.
    pub touch: Option<TestCounts>,
    /// Pairs of features that are near each other.
    pub near: TestCounts,
}

/// Pairs of boxes of each triangle after which the search for what is near is given up; a plain mesh takes about 40.
const WORK_PER_TRIANGLE: u64 = 512;

/// And this much for any mesh.
const WORK_MIN: u64 = 1 << 24;

/// The search may use one such part of what is left of the bound of a run.
const SHARE_OF_BOUND: u64 = 2;

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
    let search = || near_pairs(input, |v, ends| is_face(mesh, v, ends), work_max, cx.budget);
    Ok(cx.budget.within_part(SHARE_OF_BOUND, search)?.flatten())
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
    pub(super) fn of(cx: &Context<'_>) -> Result<Option<Self>, Stopped> {
        let Some(near) = &cx.near else { return Ok(None) };
        let list = &cx.contacts.list;
        let is_complete = cx.contacts.are_all_listed();
        let (mut intersect, mut touch) = ([0; 6], [0; 6]);
        if is_complete {
            let sides = PolygonSides::of(cx, list.iter());
            let mut found: Vec<(FeatureMeeting, bool)> = Vec::new();
            for (i, contact) in list.iter().enumerate() {
                if i % CHECK_EVERY == 0 {
                    cx.budget.check()?;
                }
                let is_touch = contact.kind == ContactKind::Touch;
                found.extend(meetings(cx, &sides, contact).into_iter().map(|meeting| (meeting, is_touch)));
            }
            // Of a pair of features that some triangles show passing through and others touching, the first counts.
            found.sort_unstable();
            found.dedup_by_key(|&mut (meeting, _)| meeting);
            for (meeting, is_touch) in found {
                let counts = if is_touch { &mut touch } else { &mut intersect };
                counts[meeting.test as usize] += 1;
            }
        }
        intersect[ProximityTest::FaceFace as usize] += cx.repeats.len() as u64;
        let mut counts = [0; 6];
        for (kind, count) in NEAR_KINDS.into_iter().zip(near.counts) {
            counts[ProximityTest::from(kind) as usize] += count;
        }
        Ok(Some(Self {
            epsilon: cx.epsilon,
            intersect: is_complete.then_some(intersect),
            touch: is_complete.then_some(touch),
            near: counts,
        }))
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
    is_closed(&cx.mesh.triangles, |v| joined[v as usize], cx.budget).map(Some)
}
