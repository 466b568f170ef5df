//! Cutting and stitching against a manifold check of their own, on random soups.

use crate::random::Random;
use crate::support::cases;
use meshmend::budget::Budget;
use meshmend::mesh::{
    AnyJoin, ChosenEdges, CutMarks, CutMethod, EdgeGroups, JoinRule, StitchValidity, Stitched, cut as cut_at,
    cut_singular, stitch,
};
use std::collections::{BTreeMap, BTreeSet};

type Triangle = [u32; 3];

/// Directed edges and the triangles that have them.
fn directed(triangles: &[Triangle]) -> BTreeMap<(u32, u32), Vec<usize>> {
    let mut edges: BTreeMap<(u32, u32), Vec<usize>> = BTreeMap::new();
    for (t, &[a, b, c]) in triangles.iter().enumerate() {
        for edge in [(a, b), (b, c), (c, a)] {
            edges.entry(edge).or_default().push(t);
        }
    }
    edges
}

/// True when the triangles are a coherently oriented manifold with boundary: no directed edge twice, and at every vertex
/// one chain or one cycle.
fn is_manifold(triangles: &[Triangle]) -> bool {
    let edges = directed(triangles);
    if edges.values().any(|t| t.len() > 1) || triangles.iter().any(|[a, b, c]| a == b || b == c || c == a) {
        return false;
    }
    let vertices: BTreeSet<u32> = triangles.iter().flatten().copied().collect();
    vertices.into_iter().all(|v| {
        let star: Vec<usize> = (0..triangles.len()).filter(|&t| triangles[t].contains(&v)).collect();
        let mut reached = BTreeSet::from([star[0]]);
        let mut open = vec![star[0]];
        while let Some(t) = open.pop() {
            for &w in triangles[t].iter().filter(|&&w| w != v) {
                for edge in [(v, w), (w, v)] {
                    for &other in edges.get(&edge).into_iter().flatten() {
                        if reached.insert(other) {
                            open.push(other);
                        }
                    }
                }
            }
        }
        reached.len() == star.len()
    })
}

/// Components of triangles across edges that have exactly two, in opposite directions.
fn regular_components(triangles: &[Triangle]) -> usize {
    let edges = directed(triangles);
    let mut part: Vec<usize> = (0..triangles.len()).collect();
    for (&(a, b), ahead) in &edges {
        let back = edges.get(&(b, a)).map_or(&[][..], Vec::as_slice);
        if let (&[t], &[u]) = (&ahead[..], back) {
            let (from, to) = (part[t].max(part[u]), part[t].min(part[u]));
            part.iter_mut().filter(|p| **p == from).for_each(|p| *p = to);
        }
    }
    part.into_iter().collect::<BTreeSet<_>>().len()
}

fn random_soup(random: &mut Random) -> (Vec<Triangle>, usize) {
    let vertex_count = 4 + random.below(7);
    let mut triangles = Vec::new();
    while triangles.len() < 3 + random.below(14) {
        let t: Triangle = std::array::from_fn(|_| random.below(vertex_count) as u32);
        if t[0] != t[1] && t[1] != t[2] && t[2] != t[0] {
            triangles.push(t);
        }
    }
    (triangles, vertex_count)
}

fn cut(triangles: &[Triangle], vertex_count: usize) -> (Vec<Triangle>, Vec<u32>) {
    let mut after = triangles.to_vec();
    let cut = cut_singular(&mut after, vertex_count, &Budget::unlimited()).unwrap();
    (after, cut.copies)
}

#[test]
fn what_is_cut_is_a_manifold_of_the_same_triangles_and_components() {
    let mut random = Random::new(1);
    let mut singular = 0;
    for case in 0..cases(20_000, 100_000) {
        let (before, vertex_count) = random_soup(&mut random);
        let (after, copies) = cut(&before, vertex_count);
        singular += usize::from(!is_manifold(&before));
        assert!(is_manifold(&after), "case {case}: {before:?} became {after:?}");
        let original =
            |v: u32| if (v as usize) < vertex_count { v } else { copies[v as usize - vertex_count] };
        assert_eq!(after.iter().map(|t| t.map(original)).collect::<Vec<_>>(), before, "case {case}");
        assert_eq!(regular_components(&after), regular_components(&before), "case {case}: {before:?}");
    }
    assert!(singular > 1_000, "only {singular} soups were singular");
}

#[test]
fn a_manifold_is_not_cut() {
    let mut random = Random::new(2);
    for case in 0..cases(2_000, 20_000) {
        let (soup, vertex_count) = random_soup(&mut random);
        let (manifold, copies) = cut(&soup, vertex_count);
        let (again, more) = cut(&manifold, vertex_count + copies.len());
        assert_eq!((again, more), (manifold, vec![]), "case {case}");
    }
}

fn vertex_sets(triangles: &[Triangle]) -> usize {
    triangles.iter().map(|t| t.iter().collect::<BTreeSet<_>>()).collect::<BTreeSet<_>>().len()
}

/// Where half-edge `h` starts and where it goes.
fn ends(triangles: &[Triangle], h: u32) -> (u32, u32) {
    let t = triangles[h as usize / 3];
    (t[h as usize % 3], t[(h as usize + 1) % 3])
}

/// Pairs of boundary half-edges that were between the same two vertices, in opposite directions, before the cut.
fn pairs_of_copies(after: &[Triangle], original: impl Fn(u32) -> u32) -> Vec<(u32, u32)> {
    let ends = |h| ends(after, h);
    let edges = directed(after);
    let boundary: Vec<u32> =
        (0..after.len() as u32 * 3).filter(|&h| !edges.contains_key(&(ends(h).1, ends(h).0))).collect();
    let mut pairs = Vec::new();
    for (i, &g) in boundary.iter().enumerate() {
        for &h in &boundary[i + 1..] {
            let ((a, b), (c, d)) = (ends(g), ends(h));
            if (original(a), original(b)) == (original(d), original(c)) {
                pairs.push((g, h));
            }
        }
    }
    pairs
}

fn stitched(mesh: &mut [Triangle], vertex_count: usize, pairs: &[(u32, u32)]) -> Stitched {
    stitch(mesh, vertex_count, pairs, StitchValidity::Exact, &mut AnyJoin, &Budget::unlimited()).unwrap()
}

fn marks(triangles: &[Triangle], vertex_count: usize, chosen: &[[u32; 2]]) -> CutMarks {
    let budget = Budget::unlimited();
    let groups = EdgeGroups::build(triangles, vertex_count, &budget).unwrap();
    CutMarks::find(triangles, vertex_count, &groups, &ChosenEdges::of(chosen.iter().copied()), &budget)
        .unwrap()
}

fn cut_by(
    method: CutMethod,
    triangles: &[Triangle],
    vertex_count: usize,
    chosen: &[[u32; 2]],
) -> (Vec<Triangle>, Vec<u32>) {
    let mut after = triangles.to_vec();
    let marks = marks(triangles, vertex_count, chosen);
    let copies = cut_at(&mut after, vertex_count, &marks, method, &Budget::unlimited()).unwrap();
    (after, copies)
}

/// A few edges by their ends, some of which the mesh has not.
fn random_edges(random: &mut Random, vertex_count: usize) -> Vec<[u32; 2]> {
    let ends = |random: &mut Random| std::array::from_fn(|_| random.below(vertex_count) as u32);
    (0..random.below(6)).map(|_| ends(random)).filter(|[a, b]| a != b).collect()
}

#[test]
fn the_local_and_the_global_cut_are_the_same_and_leave_a_manifold_whatever_is_chosen() {
    let mut random = Random::new(4);
    let mut with_chosen = 0;
    for case in 0..cases(20_000, 100_000) {
        let (before, vertex_count) = random_soup(&mut random);
        let chosen = random_edges(&mut random, vertex_count);
        let (global, copies) = cut_by(CutMethod::Global, &before, vertex_count, &chosen);
        let local = cut_by(CutMethod::Local, &before, vertex_count, &chosen);
        assert_eq!(local, (global.clone(), copies), "case {case}: {before:?} along {chosen:?}");
        assert!(is_manifold(&global), "case {case}: {before:?} along {chosen:?} became {global:?}");
        with_chosen += u64::from(marks(&before, vertex_count, &chosen).chosen_edges > 0);
    }
    assert!(with_chosen > 1_000, "only {with_chosen} soups had an edge that was chosen");
}

#[test]
fn parts_after_a_cut_are_those_that_unmarked_edges_join() {
    let mut random = Random::new(5);
    for case in 0..cases(20_000, 100_000) {
        let (before, vertex_count) = random_soup(&mut random);
        let chosen = random_edges(&mut random, vertex_count);
        let (after, _) = cut_by(CutMethod::Local, &before, vertex_count, &chosen);
        // A chosen edge may come back where both its ends stay whole: adjacency is that of the marks, not of the result.
        let marks = marks(&before, vertex_count, &chosen);
        let mut part: Vec<usize> = (0..before.len()).collect();
        for (g, &h) in marks.twins().iter().enumerate().filter(|&(_, &h)| h != u32::MAX) {
            let (a, b) = (part[g / 3], part[h as usize / 3]);
            part.iter_mut().filter(|p| **p == a.max(b)).for_each(|p| *p = a.min(b));
        }
        let joined: BTreeSet<usize> = part.into_iter().collect();
        assert!(regular_components(&after) <= joined.len(), "case {case}: {before:?} along {chosen:?}");
        if chosen.is_empty() {
            assert_eq!(regular_components(&after), joined.len(), "case {case}: {before:?}");
        }
    }
}

#[test]
fn without_the_isolated_singular_vertices_many_soups_stay_singular() {
    let mut random = Random::new(6);
    let (mut isolated, mut broken) = (0, 0);
    for _ in 0..cases(20_000, 100_000) {
        let (before, vertex_count) = random_soup(&mut random);
        let marks = marks(&before, vertex_count, &[]);
        let (mut after, copies) = cut_by(CutMethod::Local, &before, vertex_count, &[]);
        isolated += usize::from(marks.isolated_vertices > 0);
        // The ends of edges with three triangles or more, or with two in one direction.
        let edges = directed(&before);
        let count = |edge| edges.get(&edge).map_or(0, Vec::len);
        let is_marked = |a, b| count((a, b)) > 1 || count((a, b)) + count((b, a)) > 2;
        let ends: BTreeSet<u32> = edges
            .keys()
            .filter(|&&(a, b)| is_marked(a, b) || is_marked(b, a))
            .flat_map(|&(a, b)| [a, b])
            .collect();
        for v in after.as_flattened_mut().iter_mut().filter(|v| **v as usize >= vertex_count) {
            let old = copies[*v as usize - vertex_count];
            *v = if ends.contains(&old) { *v } else { old };
        }
        broken += usize::from(!is_manifold(&after));
    }
    assert_eq!(broken, isolated);
    assert!(broken > 1_000, "only {broken} soups tell the difference");
}

/// Copies of one vertex may become one.
struct CopiesOnly<'a>(&'a dyn Fn(u32) -> u32);

impl JoinRule for CopiesOnly<'_> {
    fn may_merge(&self, kept: u32, gone: u32) -> bool {
        (self.0)(kept) == (self.0)(gone)
    }

    fn may_change(&self, _before: Triangle, _after: Triangle) -> bool {
        true
    }

    fn merged(&mut self, kept: u32, gone: u32) {
        assert_eq!((self.0)(kept), (self.0)(gone));
    }
}

#[test]
fn every_edge_that_a_stitch_closes_is_recorded_once_by_either_rule() {
    let mut random = Random::new(7);
    let (mut implicit, mut stricter) = (0, 0);
    for case in 0..cases(20_000, 100_000) {
        let (before, vertex_count) = random_soup(&mut random);
        let (mesh, copies) = cut(&before, vertex_count);
        let original =
            |v: u32| if (v as usize) < vertex_count { v } else { copies[v as usize - vertex_count] };
        let pairs = pairs_of_copies(&mesh, original);
        let boundary = |mesh: &[Triangle]| {
            let edges = directed(mesh);
            edges.keys().filter(|&&(a, b)| !edges.contains_key(&(b, a))).count()
        };
        let joined = [StitchValidity::Exact, StitchValidity::Paper].map(|validity| {
            let mut after = mesh.clone();
            let (count, budget) = (vertex_count + copies.len(), Budget::unlimited());
            let mut rule = CopiesOnly(&original);
            let done = stitch(&mut after, count, &pairs, validity, &mut rule, &budget).unwrap();
            assert!(is_manifold(&after), "case {case} by {validity:?}: {before:?} became {after:?}");
            let recorded: Vec<(u32, u32)> = [done.explicit, done.implicit.clone()].concat();
            for &(g, h) in &recorded {
                let ((a, b), other) = (ends(&after, g), ends(&after, h));
                assert_eq!(other, (b, a), "case {case}: {g} and {h} of {after:?}");
            }
            let half_edges: BTreeSet<u32> = recorded.iter().flat_map(|&(g, h)| [g, h]).collect();
            assert_eq!(half_edges.len(), 2 * recorded.len(), "case {case}: {recorded:?}");
            assert_eq!(boundary(&after) + 2 * recorded.len(), boundary(&mesh), "case {case}: {recorded:?}");
            implicit += done.implicit.len();
            recorded.len()
        });
        stricter += usize::from(joined[1] < joined[0]);
    }
    assert!(implicit > 200, "only {implicit} implicit stitches");
    assert!(stricter > 30, "only {stricter} soups are joined less by the published conditions");
}

/// The vertices that edges join to both.
fn common_neighbours(triangles: &[Triangle], a: u32, b: u32) -> BTreeSet<u32> {
    let neighbours = |v: u32| -> BTreeSet<u32> {
        triangles.iter().filter(|t| t.contains(&v)).flatten().copied().filter(|&u| u != v).collect()
    };
    neighbours(a).intersection(&neighbours(b)).copied().collect()
}

/// The published conditions, as they are read here: for each of the two pairs of vertices that become one, no edge between
/// them, no triangle with both, and no vertex joined to both but the one around which they fold. A pair that folds around a
/// vertex of its own merges first.
fn holds_by_the_paper(triangles: &[Triangle], g: u32, h: u32) -> bool {
    let ((u, v), (v2, u2)) = (ends(triangles, g), ends(triangles, h));
    let mut pairs = vec![(u, u2), (v, v2)];
    let mut folds_around: Option<u32> = pairs.iter().find(|(a, b)| a == b).map(|pair| pair.0);
    pairs.retain(|(a, b)| a != b);
    pairs.sort_by_key(|&(a, b)| common_neighbours(triangles, a, b).is_empty());
    let mut mesh = triangles.to_vec();
    pairs.into_iter().all(|(a, b)| {
        let common = common_neighbours(&mesh, a, b);
        let is_apart = !mesh.iter().any(|t| t.contains(&a) && t.contains(&b));
        let folds = folds_around.take().or_else(|| common.first().copied());
        mesh.as_flattened_mut().iter_mut().filter(|v| **v == b).for_each(|v| *v = a);
        folds_around = folds.map(|_| a);
        is_apart && common.iter().all(|&w| Some(w) == folds)
    })
}

#[test]
fn the_published_conditions_refuse_some_pairs_that_the_exact_test_takes_and_take_none_that_it_refuses() {
    let mut random = Random::new(7);
    let (mut taken, mut refused) = (0, 0);
    for case in 0..cases(20_000, 100_000) {
        let (before, vertex_count) = random_soup(&mut random);
        let (mesh, copies) = cut(&before, vertex_count);
        let original =
            |v: u32| if (v as usize) < vertex_count { v } else { copies[v as usize - vertex_count] };
        // Pairs of copies, and any two boundary edges that run in opposite directions.
        let edges = directed(&mesh);
        let boundary: Vec<u32> = (0..mesh.len() as u32 * 3)
            .filter(|&h| !edges.contains_key(&(ends(&mesh, h).1, ends(&mesh, h).0)))
            .collect();
        let mut pairs = pairs_of_copies(&mesh, original);
        if let [_, _, ..] = boundary[..] {
            pairs.extend(
                (0..4)
                    .map(|_| (random.pick(&boundary), random.pick(&boundary)))
                    .filter(|(g, h)| g / 3 != h / 3),
            );
        }
        for pair in pairs {
            let joins = [StitchValidity::Exact, StitchValidity::Paper].map(|validity| {
                let mut after = mesh.clone();
                let (count, budget) = (vertex_count + copies.len(), Budget::unlimited());
                let done = stitch(&mut after, count, &[pair], validity, &mut AnyJoin, &budget).unwrap();
                assert!(is_manifold(&after), "case {case} by {validity:?}: {pair:?} of {mesh:?}");
                !done.explicit.is_empty()
            });
            let want = joins[0] && holds_by_the_paper(&mesh, pair.0, pair.1);
            assert_eq!(joins[1], want, "case {case}: {pair:?} of {mesh:?}, exact {}", joins[0]);
            taken += usize::from(joins[1]);
            refused += usize::from(joins[0] && !joins[1]);
        }
    }
    assert!(taken > 10_000 && refused > 50, "{taken} taken, {refused} refused that the exact test takes");
}

#[test]
fn stitching_keeps_a_manifold_and_leaves_no_pair_that_could_be_joined() {
    let mut random = Random::new(3);
    let (mut joined, mut refused) = (0, 0);
    for case in 0..cases(20_000, 100_000) {
        let (before, vertex_count) = random_soup(&mut random);
        let (mut mesh, copies) = cut(&before, vertex_count);
        let original =
            |v: u32| if (v as usize) < vertex_count { v } else { copies[v as usize - vertex_count] };
        let pairs = pairs_of_copies(&mesh, original);
        let done = stitched(&mut mesh, vertex_count + copies.len(), &pairs);
        assert!(is_manifold(&mesh), "case {case}: {before:?} became {mesh:?}");
        joined += done.explicit.len();
        // Every pair that is left was rightly refused: joining it would break the manifold or double a triangle.
        for (g, h) in pairs_of_copies(&mesh, original) {
            let ((a, b), (c, d)) = (ends(&mesh, g), ends(&mesh, h));
            let rename = |v: u32| {
                if v == d {
                    a
                } else if v == c {
                    b
                } else {
                    v
                }
            };
            let naive: Vec<Triangle> = mesh.iter().map(|t| t.map(rename)).collect();
            let is_right = !is_manifold(&naive) || vertex_sets(&naive) < vertex_sets(&mesh);
            assert!(is_right, "case {case}: {g} and {h} of {mesh:?}");
            refused += 1;
        }
    }
    assert!(joined > 1_000 && refused > 100, "{joined} joined, {refused} refused");
}
