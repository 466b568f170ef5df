//! Cutting and stitching of polygons against an oracle that knows polygons alone: the link of a vertex is made of the edges
//! of polygons, and the corners that stay together are united across the edges with exactly two faces.

use crate::polygon_meshes::{Mesh, break_up, disguise, prism, soup_of};
use crate::random::Random;
use crate::support::cases;
use meshmend::budget::Budget;
use meshmend::mesh::{
    AnyJoin, ChosenEdges, CutMarks, CutMethod, EdgeGroups, JoinRule, Outlines, PolygonRuns, StitchValidity,
    Stitched, cut as cut_at, edge_of, stitch_faces,
};
use meshmend::repair::cut::{CutOptions, cut};
use meshmend::repair::duplicates::{OppositePairs, drop_duplicates};
use meshmend::repair::polygons::{DegenerateFaces, split_polygons};
use meshmend::repair::snap::{SnapOptions, snap};
use meshmend::repair::{Draft, degenerate, orient, pinch, weld};
use std::collections::{BTreeMap, BTreeSet};

type Face = Vec<u32>;

/// Edges of a face in its direction.
fn edges(face: &Face) -> impl Iterator<Item = (u32, u32)> + '_ {
    (0..face.len()).map(|i| (face[i], face[(i + 1) % face.len()]))
}

/// Directed edges and the faces that have them.
fn directed(faces: &[Face]) -> BTreeMap<(u32, u32), Vec<usize>> {
    let mut all: BTreeMap<(u32, u32), Vec<usize>> = BTreeMap::new();
    for (f, face) in faces.iter().enumerate() {
        edges(face).for_each(|edge| all.entry(edge).or_default().push(f));
    }
    all
}

/// Faces on an edge in each direction: along, against.
fn counts(all: &BTreeMap<(u32, u32), Vec<usize>>, (a, b): (u32, u32)) -> [usize; 2] {
    [(a, b), (b, a)].map(|edge| all.get(&edge).map_or(0, Vec::len))
}

/// True when polygons are a coherently oriented manifold with boundary: no corner twice in a face, no directed edge twice,
/// and at every vertex one chain or one cycle of faces.
fn is_manifold(faces: &[Face]) -> bool {
    let all = directed(faces);
    let is_simple = |face: &Face| face.iter().collect::<BTreeSet<_>>().len() == face.len();
    if all.values().any(|f| f.len() > 1) || !faces.iter().all(is_simple) {
        return false;
    }
    let vertices: BTreeSet<u32> = faces.iter().flatten().copied().collect();
    vertices.into_iter().all(|v| {
        let star: Vec<usize> = (0..faces.len()).filter(|&f| faces[f].contains(&v)).collect();
        let mut reached = BTreeSet::from([star[0]]);
        let mut open = vec![star[0]];
        while let Some(f) = open.pop() {
            for (a, b) in edges(&faces[f]).filter(|&(a, b)| a == v || b == v) {
                let beyond = all.get(&(b, a)).into_iter().flatten();
                open.extend(beyond.filter(|&&g| reached.insert(g)).copied().collect::<Vec<_>>());
            }
        }
        reached.len() == star.len()
    })
}

/// What the cut must find and leave.
struct Oracle {
    /// The class of each corner of each face.
    class: Vec<Vec<usize>>,
    singular: u64,
    conflicting: u64,
    isolated: u64,
    components: usize,
}

fn oracle(faces: &[Face], chosen: &[[u32; 2]]) -> Oracle {
    let all = directed(faces);
    let is_chosen = |(a, b): (u32, u32)| chosen.iter().any(|&[c, d]| (a, b) == (c, d) || (a, b) == (d, c));
    let mut class: Vec<Vec<usize>> = Vec::new();
    let mut corners = 0;
    for face in faces {
        class.push((corners..corners + face.len()).collect());
        corners += face.len();
    }
    let mut part: Vec<usize> = (0..faces.len()).collect();
    let (mut singular, mut conflicting) = (0, 0);
    let mut ends = BTreeSet::new();
    let undirected: BTreeSet<(u32, u32)> = all.keys().map(|&(a, b)| (a.min(b), a.max(b))).collect();
    for edge in undirected {
        let (a, b) = edge;
        match counts(&all, edge) {
            _ if is_chosen(edge) => ends.extend([a, b]),
            [1, 1] => {
                let (f, g) = (all[&(a, b)][0], all[&(b, a)][0]);
                for v in [a, b] {
                    let at = |f: usize| faces[f].iter().position(|&u| u == v).unwrap();
                    let (x, y) = (class[f][at(f)], class[g][at(g)]);
                    class
                        .as_mut_slice()
                        .iter_mut()
                        .flatten()
                        .filter(|c| **c == x.max(y))
                        .for_each(|c| *c = x.min(y));
                }
                let (x, y) = (part[f], part[g]);
                part.iter_mut().filter(|p| **p == x.max(y)).for_each(|p| *p = x.min(y));
            }
            [along, against] if along + against > 2 => {
                singular += 1;
                ends.extend([a, b]);
            }
            [1, 0] | [0, 1] => {}
            _ => {
                conflicting += 1;
                ends.extend([a, b]);
            }
        }
    }
    let mut fans: BTreeMap<u32, BTreeSet<usize>> = BTreeMap::new();
    for (face, classes) in faces.iter().zip(&class) {
        for (&v, &c) in face.iter().zip(classes) {
            fans.entry(v).or_default().insert(c);
        }
    }
    let isolated = fans.iter().filter(|(v, fans)| fans.len() > 1 && !ends.contains(v)).count() as u64;
    let components = part.into_iter().collect::<BTreeSet<_>>().len();
    Oracle { class, singular, conflicting, isolated, components }
}

/// Polygons as runs of triangles.
#[derive(Clone)]
struct Split {
    triangles: Vec<[u32; 3]>,
    runs: PolygonRuns,
    /// First triangles of the faces.
    first: Vec<usize>,
}

impl Split {
    /// Each face split along any diagonals, its triangles from any corner.
    fn of(random: &mut Random, faces: &[Face]) -> Self {
        let (mut triangles, mut ranges) = (Vec::new(), Vec::new());
        for face in faces {
            let (start, mut left) = (triangles.len(), face.clone());
            while left.len() >= 3 {
                let i = random.below(left.len());
                let mut triangle =
                    [left[(i + left.len() - 1) % left.len()], left[i], left[(i + 1) % left.len()]];
                triangle.rotate_left(random.below(3));
                triangles.push(triangle);
                left.remove(i);
            }
            ranges.push(start..triangles.len());
        }
        let first = ranges.iter().map(|range| range.start).collect();
        Self { runs: PolygonRuns::of(triangles.len(), ranges), triangles, first }
    }

    fn outlines(&self) -> Outlines {
        Outlines::of(&self.triangles, &self.runs, &Budget::unlimited()).unwrap()
    }

    /// The half-edges of each face.
    fn half_edges(&self) -> Vec<Vec<u32>> {
        let outlines = self.outlines();
        self.first.iter().map(|&t| outlines.along(t as u32).collect()).collect()
    }

    fn faces(&self) -> Vec<Face> {
        let start = |h: &u32| edge_of(&self.triangles, *h)[0];
        self.half_edges().iter().map(|face| face.iter().map(start).collect()).collect()
    }

    fn marks(&self, vertex_count: usize, chosen: &[[u32; 2]]) -> CutMarks {
        let budget = Budget::unlimited();
        let groups = EdgeGroups::of_faces(&self.triangles, &self.outlines(), vertex_count, &budget).unwrap();
        let chosen = ChosenEdges::of(chosen.iter().copied());
        CutMarks::find(&self.triangles, vertex_count, &groups, &chosen, &budget).unwrap()
    }

    fn cut(&mut self, vertex_count: usize, chosen: &[[u32; 2]], method: CutMethod) -> Vec<u32> {
        let marks = self.marks(vertex_count, chosen);
        cut_at(&mut self.triangles, vertex_count, &marks, method, &Budget::unlimited()).unwrap()
    }

    fn stitch(
        &mut self,
        count: usize,
        pairs: &[(u32, u32)],
        validity: StitchValidity,
        rule: &mut dyn JoinRule,
    ) -> Stitched {
        let outlines = self.outlines();
        stitch_faces(&mut self.triangles, &outlines, count, pairs, validity, rule, &Budget::unlimited())
            .unwrap()
    }

    /// Pairs of boundary half-edges that were between the same two vertices, in opposite directions, before the cut.
    fn pairs_of_copies(&self, original: impl Fn(u32) -> u32) -> Vec<(u32, u32)> {
        let all = directed(&self.faces());
        let ends = |h: u32| edge_of(&self.triangles, h);
        let is_boundary = |&h: &u32| !all.contains_key(&(ends(h)[1], ends(h)[0]));
        let boundary: Vec<u32> = self.half_edges().into_iter().flatten().filter(is_boundary).collect();
        let mut pairs = Vec::new();
        for (i, &g) in boundary.iter().enumerate() {
            for &h in &boundary[i + 1..] {
                let [[a, b], [c, d]] = [g, h].map(|h| ends(h).map(&original));
                if (a, b) == (d, c) {
                    pairs.push((g.min(h), g.max(h)));
                }
            }
        }
        pairs
    }
}

/// Faces of three to six different vertices, some of them copies of others.
fn random_faces(random: &mut Random) -> (Vec<Face>, usize) {
    let vertex_count = 4 + random.below(7);
    let mut faces: Vec<Face> = Vec::new();
    for _ in 0..2 + random.below(9) {
        let mut face = Face::new();
        let size = (3 + random.below(4)).min(vertex_count);
        while face.len() < size {
            let v = random.below(vertex_count) as u32;
            if !face.contains(&v) {
                face.push(v);
            }
        }
        if random.one_in(8) && !faces.is_empty() {
            face = faces[random.below(faces.len())].clone();
            let start = random.below(face.len());
            face.rotate_left(start);
        }
        if random.one_in(4) {
            face.reverse();
        }
        faces.push(face);
    }
    (faces, vertex_count)
}

fn random_edges(random: &mut Random, vertex_count: usize) -> Vec<[u32; 2]> {
    let mut ends = || std::array::from_fn(|_| random.below(vertex_count) as u32);
    let edges: Vec<[u32; 2]> = (0..6).map(|_| ends()).collect();
    let count = random.below(7);
    edges.into_iter().take(count).filter(|[a, b]| a != b).collect()
}

/// The class of each corner by the vertex that it has after a cut.
fn assert_same_partition(
    before: &[Face],
    after: &[Face],
    oracle: &Oracle,
    original: impl Fn(u32) -> u32,
    case: &str,
) {
    let (mut vertex_of, mut class_of) = (BTreeMap::new(), BTreeMap::new());
    for (f, face) in after.iter().enumerate() {
        assert_eq!(face.len(), before[f].len(), "{case}");
        let shift = before[f].iter().position(|&v| v == original(face[0])).unwrap();
        for (k, &v) in face.iter().enumerate() {
            let place = (shift + k) % face.len();
            assert_eq!(before[f][place], original(v), "{case}");
            let class = oracle.class[f][place];
            assert_eq!(*vertex_of.entry(class).or_insert(v), v, "{case}");
            assert_eq!(*class_of.entry(v).or_insert(class), class, "{case}");
        }
    }
}

#[test]
fn both_cuts_of_polygons_part_the_corners_as_the_oracle_does() {
    let mut random = Random::new(81);
    let (mut isolated, mut singular, mut diagonals) = (0, 0, 0);
    for case in 0..cases(20_000, 100_000) {
        let (before, vertex_count) = random_faces(&mut random);
        let chosen = if random.one_in(2) { random_edges(&mut random, vertex_count) } else { Vec::new() };
        let split = Split::of(&mut random, &before);
        let text = format!("case {case}: {before:?} along {chosen:?}");
        let (want, marks) = (oracle(&before, &chosen), split.marks(vertex_count, &chosen));
        if chosen.is_empty() {
            assert_eq!(marks.singular_edges, want.singular, "{text}");
            assert_eq!(marks.conflicting_edges, want.conflicting, "{text}");
        }
        assert_eq!(marks.isolated_vertices, want.isolated, "{text}");
        let [(global, copies), local] = [CutMethod::Global, CutMethod::Local].map(|method| {
            let mut after = split.clone();
            let copies = after.cut(vertex_count, &chosen, method);
            (after, copies)
        });
        assert_eq!((&global.triangles, &copies), (&local.0.triangles, &local.1), "{text}");
        let original =
            |v: u32| if (v as usize) < vertex_count { v } else { copies[v as usize - vertex_count] };
        let after = global.faces();
        assert_same_partition(&before, &after, &want, original, &text);
        assert!(is_manifold(&after), "{text} became {after:?}");
        if chosen.is_empty() {
            assert_eq!(oracle(&after, &[]).components, want.components, "{text}");
        }
        isolated += u64::from(want.isolated > 0);
        singular += u64::from(want.singular > 0);
        // As triangles it is another mesh: a diagonal lies on an edge or another diagonal.
        let budget = Budget::unlimited();
        let groups = EdgeGroups::build(&global.triangles, vertex_count + copies.len(), &budget).unwrap();
        diagonals += u64::from(groups.iter().any(|group| group.len() > 2));
    }
    assert!(isolated > 1_000 && singular > 1_000, "{isolated} and {singular}");
    assert!(diagonals > 100, "only {diagonals} manifolds of polygons are none of triangles");
}

/// Copies of one vertex may become one.
struct CopiesOnly<'a>(&'a dyn Fn(u32) -> u32);

impl JoinRule for CopiesOnly<'_> {
    fn may_merge(&self, kept: u32, gone: u32) -> bool {
        (self.0)(kept) == (self.0)(gone)
    }

    fn may_change(&self, _before: [u32; 3], _after: [u32; 3]) -> bool {
        true
    }

    fn merged(&mut self, kept: u32, gone: u32) {
        assert_eq!((self.0)(kept), (self.0)(gone));
    }
}

/// Number of outlines, from whichever corner and in either direction.
fn outlines_of(faces: &[Face]) -> usize {
    let least = |face: &Face| {
        let reversed: Face = face.iter().rev().copied().collect();
        let rotations = |face: Face| (0..face.len()).map(move |i| [&face[i..], &face[..i]].concat());
        rotations(face.clone()).chain(rotations(reversed)).min().unwrap()
    };
    faces.iter().map(least).collect::<BTreeSet<_>>().len()
}

#[test]
fn stitched_polygons_are_a_manifold_and_what_is_left_could_not_be_joined() {
    let mut random = Random::new(82);
    let (mut joined, mut refused, mut implicit) = (0, 0, 0);
    for case in 0..cases(20_000, 100_000) {
        let (before, vertex_count) = random_faces(&mut random);
        let mut mesh = Split::of(&mut random, &before);
        let copies = mesh.cut(vertex_count, &[], CutMethod::Local);
        let original =
            |v: u32| if (v as usize) < vertex_count { v } else { copies[v as usize - vertex_count] };
        let pairs = mesh.pairs_of_copies(original);
        let cut = mesh.clone();
        let done = mesh.stitch(
            vertex_count + copies.len(),
            &pairs,
            StitchValidity::Exact,
            &mut CopiesOnly(&original),
        );
        let after = mesh.faces();
        assert!(is_manifold(&after), "case {case}: {before:?} became {after:?}");
        let recorded: Vec<(u32, u32)> = [done.explicit, done.implicit.clone()].concat();
        for &(g, h) in &recorded {
            let [[a, b], other] = [g, h].map(|h| edge_of(&mesh.triangles, h));
            assert_eq!(other, [b, a], "case {case}: {g} and {h} of {after:?}");
        }
        let boundary = |faces: &[Face]| {
            let all = directed(faces);
            all.keys().filter(|&&(a, b)| !all.contains_key(&(b, a))).count()
        };
        assert_eq!(boundary(&after) + 2 * recorded.len(), boundary(&cut.faces()), "case {case}: {before:?}");
        joined += recorded.len();
        implicit += done.implicit.len();
        for (g, h) in mesh.pairs_of_copies(original) {
            let [[a, b], [c, d]] = [g, h].map(|h| edge_of(&mesh.triangles, h));
            let rename = |v: u32| {
                if v == d {
                    a
                } else if v == c {
                    b
                } else {
                    v
                }
            };
            let naive: Vec<Face> =
                after.iter().map(|face| face.iter().map(|&v| rename(v)).collect()).collect();
            let is_right = !is_manifold(&naive) || outlines_of(&naive) < outlines_of(&after);
            assert!(is_right, "case {case}: {g} and {h} of {after:?}");
            refused += 1;
        }
    }
    assert!(joined > 1_000 && refused > 100 && implicit > 50, "{joined}, {refused}, {implicit}");
}

#[test]
fn a_manifold_of_polygons_that_is_cut_anywhere_and_stitched_is_itself_again() {
    let mut random = Random::new(83);
    let mut parted = 0;
    for case in 0..cases(10_000, 50_000) {
        let (mut soup, vertex_count) = random_faces(&mut random);
        // Two faces with one outline would be refused to become one again.
        let mut seen = Vec::new();
        soup.retain(|face| {
            seen.push(face.clone());
            let is_new = outlines_of(&seen) == seen.len();
            seen.truncate(seen.len() - usize::from(!is_new));
            is_new
        });
        let mut whole = Split::of(&mut random, &soup);
        let count = vertex_count + whole.cut(vertex_count, &[], CutMethod::Local).len();
        let chosen: Vec<[u32; 2]> = directed(&whole.faces()).keys().map(|&(a, b)| [a, b]).collect();
        let chosen: Vec<[u32; 2]> = chosen.into_iter().filter(|_| random.one_in(2)).collect();
        let mut mesh = whole.clone();
        let copies = mesh.cut(count, &chosen, CutMethod::Global);
        parted += copies.len();
        let original = |v: u32| if (v as usize) < count { v } else { copies[v as usize - count] };
        let pairs = mesh.pairs_of_copies(original);
        mesh.stitch(count + copies.len(), &pairs, StitchValidity::Exact, &mut AnyJoin);
        assert_eq!(mesh.triangles, whole.triangles, "case {case}: {:?} along {chosen:?}", whole.faces());
    }
    assert!(parted > 1_000, "only {parted} vertices came apart");
}

/// The faces of a draft.
fn faces_of(draft: &Draft) -> Vec<Face> {
    let outlines = draft.outlines(&Budget::unlimited()).unwrap();
    let faces = draft.polygons.faces(draft.triangles.len());
    let corners = |t: usize| outlines.along(t as u32).map(|h| edge_of(&draft.triangles, h)[0]).collect();
    faces.map(|face| corners(face.start)).collect()
}

/// The places of the corners of each face from the smallest on, in whichever direction is smaller.
fn places(faces: &[Face], at: impl Fn(u32) -> [i64; 3]) -> Vec<Vec<[i64; 3]>> {
    let least = |face: &Face| {
        let ahead: Vec<[i64; 3]> = face.iter().map(|&v| at(v)).collect();
        let back: Vec<[i64; 3]> = ahead.iter().rev().copied().collect();
        let rotations = |all: Vec<[i64; 3]>| (0..all.len()).map(move |i| [&all[i..], &all[..i]].concat());
        rotations(ahead).chain(rotations(back)).min().unwrap()
    };
    let mut all: Vec<_> = faces.iter().map(least).collect();
    all.sort_unstable();
    all
}

#[test]
fn the_steps_of_cut_stitch_leave_polygons_whole_and_part_them_as_the_oracle_does() {
    let mut random = Random::new(84);
    let budget = Budget::unlimited();
    let (mut singular, mut polygons) = (0, 0);
    for case in 0..cases(1_500, 40_000) {
        let mut mesh = Mesh::default();
        for _ in 0..1 + random.below(3) {
            let at = [0, 1, 2].map(|_| random.pick(&[0, 0, 4, 6, 20]));
            prism(&mut random, &mut mesh, at);
        }
        disguise(&mut random, &mut mesh);
        break_up(&mut random, &mut mesh);
        let soup = soup_of(&mesh);
        let (mut draft, _) = Draft::with_polygons(&soup);
        split_polygons(&mut draft, &soup, DegenerateFaces::Split, &budget).unwrap();
        weld::weld(&mut draft, &budget).unwrap();
        degenerate::drop_degenerate(&mut draft);
        drop_duplicates(&mut draft, OppositePairs::KeepFirst, &budget).unwrap();
        let text = format!("case {case}: {mesh:?}");
        let at = |draft: &Draft, v: u32| draft.positions[v as usize].to_array().map(|c| c as i64);
        let given = faces_of(&draft);
        let given_places = places(&given, |v| at(&draft, v));
        assert_eq!(outlines_of(&given), given.len(), "{text}");
        orient::orient(&mut draft, &budget).unwrap();
        let before = faces_of(&draft);
        assert_eq!(places(&before, |v| at(&draft, v)), given_places, "{text}");
        let (want, count) = (oracle(&before, &[]), draft.positions.len());
        let origin = draft.vertex_origin.clone();
        let mut other = draft.clone();
        let options = |method| CutOptions { method: Some(method), ..CutOptions::default() };
        let changes = cut(&mut draft, &options(CutMethod::Local), &budget).unwrap();
        cut(&mut other, &options(CutMethod::Global), &budget).unwrap();
        assert_eq!(draft, other, "{text}");
        assert_eq!(changes.count("singular_edges"), want.singular, "{text}");
        assert_eq!(changes.count("isolated_singular_vertices"), want.isolated, "{text}");
        let original = |v: u32| match (v as usize) < count {
            true => v,
            false => origin.iter().position(|&o| o == draft.vertex_origin[v as usize]).unwrap() as u32,
        };
        assert_same_partition(&before, &faces_of(&draft), &want, original, &text);
        assert!(is_manifold(&faces_of(&draft)), "{text}");
        let parts = oracle(&faces_of(&draft), &[]).components;
        pinch::pinch(&mut draft, &ChosenEdges::default(), StitchValidity::Exact, &budget).unwrap();
        assert!(is_manifold(&faces_of(&draft)), "{text}");
        assert_eq!(oracle(&faces_of(&draft), &[]).components, parts, "{text}");
        snap(&mut draft, &SnapOptions { epsilon: Some(0.0), ..SnapOptions::default() }, &budget).unwrap();
        assert_eq!(draft.check(), Vec::<String>::new(), "{text}");
        let after = faces_of(&draft);
        assert!(is_manifold(&after), "{text}");
        assert_eq!(places(&after, |v| at(&draft, v)), given_places, "{text}");
        singular += want.singular;
        polygons += after.iter().filter(|face| face.len() > 3).count();
    }
    assert!(singular > 400 && polygons > 5_000, "{singular} and {polygons}");
}
