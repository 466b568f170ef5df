//! Cutting and stitching against a manifold check of their own, on random soups.

use crate::random::Random;
use crate::support::cases;
use meshmend::budget::Budget;
use meshmend::mesh::{cut_singular, stitch};
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
    for case in 0..cases(5_000, 100_000) {
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

#[test]
fn stitching_keeps_a_manifold_and_leaves_no_pair_that_could_be_joined() {
    let mut random = Random::new(3);
    let (mut joined, mut refused) = (0, 0);
    for case in 0..cases(5_000, 100_000) {
        let (before, vertex_count) = random_soup(&mut random);
        let (mut mesh, copies) = cut(&before, vertex_count);
        let original =
            |v: u32| if (v as usize) < vertex_count { v } else { copies[v as usize - vertex_count] };
        let pairs = pairs_of_copies(&mesh, original);
        let done = stitch(&mut mesh, vertex_count + copies.len(), &pairs, &Budget::unlimited()).unwrap();
        assert!(is_manifold(&mesh), "case {case}: {before:?} became {mesh:?}");
        joined += done.explicit;
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
