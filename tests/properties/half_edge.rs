//! The link condition against what a collapse really does, on all small meshes and on random larger ones, for the
//! half-edge mesh and the corner table alike.

use crate::random::Random;
use crate::support::cases;
use meshmend::budget::Budget;
use meshmend::mesh::corner_table::{CornerTable, EdgeRings};
use meshmend::mesh::half_edge::{Claims, HalfEdgeId, HalfEdgeMesh, SplitAt};
use std::collections::{BTreeMap, BTreeSet};

type Triangle = [u32; 3];

/// What a collapse must keep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Topology {
    pub(crate) euler: i64,
    pub(crate) components: usize,
    pub(crate) boundary_loops: usize,
}

/// Smallest member of the set of `x`.
fn find(parent: &mut [usize], mut x: usize) -> usize {
    while parent[x] != x {
        parent[x] = parent[parent[x]];
        x = parent[x];
    }
    x
}

/// The classes of `0..len` under `pairs`, counted.
fn classes(len: usize, pairs: impl IntoIterator<Item = (usize, usize)>) -> usize {
    let mut parent: Vec<usize> = (0..len).collect();
    for (a, b) in pairs {
        let (a, b) = (find(&mut parent, a), find(&mut parent, b));
        parent[a.max(b)] = a.min(b);
    }
    (0..len).filter(|&x| parent[x] == x).count()
}

/// The topology of a coherently oriented simplicial manifold with or without boundary; nothing when it is none.
pub(crate) fn topology(triangles: &[Triangle]) -> Option<Topology> {
    let mut faces = BTreeSet::new();
    let mut directed: BTreeMap<(u32, u32), usize> = BTreeMap::new();
    let mut stars: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (t, &[a, b, c]) in triangles.iter().enumerate() {
        let mut sorted = [a, b, c];
        sorted.sort_unstable();
        if a == b || b == c || c == a || !faces.insert(sorted) {
            return None;
        }
        for edge in [(a, b), (b, c), (c, a)] {
            if directed.insert(edge, t).is_some() {
                return None;
            }
        }
        [a, b, c].iter().for_each(|&v| stars.entry(v).or_default().push(t));
    }
    let inner = |&(&(a, b), &t): &(&(u32, u32), &usize)| Some((t, *directed.get(&(b, a))?, a, b));
    for (&v, star) in &stars {
        let place = |t: usize| star.iter().position(|&s| s == t);
        let joined = directed.iter().filter_map(|e| inner(&e)).filter(|&(.., a, b)| a == v || b == v);
        if classes(star.len(), joined.filter_map(|(t, u, ..)| Some((place(t)?, place(u)?)))) != 1 {
            return None;
        }
    }
    let pairs = directed.iter().filter_map(|e| inner(&e)).map(|(t, u, ..)| (t, u));
    let components = classes(triangles.len(), pairs);
    let border: Vec<(u32, u32)> =
        directed.keys().copied().filter(|&(a, b)| !directed.contains_key(&(b, a))).collect();
    let following = |i: usize| border.iter().position(|&(a, _)| a == border[i].1).map(|j| (i, j));
    let boundary_loops = classes(border.len(), (0..border.len()).filter_map(following));
    let edges = (directed.len() + border.len()) / 2;
    let euler = stars.len() as i64 - edges as i64 + triangles.len() as i64;
    Some(Topology { euler, components, boundary_loops })
}

/// The triangles after `a` has become `b`, and the topology, unless the image of an edge or vertex is in no triangle
/// or the triangles are no manifold.
fn collapsed(triangles: &[Triangle], a: u32, b: u32) -> (Vec<Triangle>, Option<Topology>) {
    let rename = |v: u32| if v == a { b } else { v };
    let is_whole = |t: &Triangle| !(t.contains(&a) && t.contains(&b));
    let after: Vec<Triangle> = triangles.iter().filter(|t| is_whole(t)).map(|t| t.map(rename)).collect();
    let edges = |list: &[Triangle]| -> BTreeSet<[u32; 2]> {
        let sides =
            |&[a, b, c]: &Triangle| [[a.min(b), a.max(b)], [b.min(c), b.max(c)], [c.min(a), c.max(a)]];
        list.iter().flat_map(sides).collect()
    };
    let image: BTreeSet<[u32; 2]> = edges(triangles)
        .into_iter()
        .map(|[p, q]| [rename(p).min(rename(q)), rename(p).max(rename(q))])
        .filter(|[p, q]| p != q)
        .collect();
    let is_pure = image == edges(&after) && after.iter().any(|t| t.contains(&b));
    let topology = if is_pure { topology(&after) } else { None };
    (after, topology)
}

/// Triangles as a set: each begins with its smallest corner.
fn as_set(triangles: impl IntoIterator<Item = Triangle>) -> BTreeSet<Triangle> {
    triangles
        .into_iter()
        .map(|t| {
            let first = (0..3).min_by_key(|&i| t[i]).unwrap();
            [t[first], t[(first + 1) % 3], t[(first + 2) % 3]]
        })
        .collect()
}

fn listed(mesh: &HalfEdgeMesh) -> Vec<Triangle> {
    let corners = |f| {
        let c: Vec<u32> = mesh.corners(f).map(|v| v.index() as u32).collect();
        [c[0], c[1], c[2]]
    };
    mesh.faces().map(corners).collect()
}

fn vertex_count(triangles: &[Triangle]) -> usize {
    triangles.as_flattened().iter().max().map_or(0, |&v| v as usize + 1)
}

/// Tries every half-edge of a manifold; gives how many collapses were allowed and refused.
fn assert_link_condition_is_exact(triangles: &[Triangle]) -> (usize, usize) {
    let budget = Budget::unlimited();
    let before = topology(triangles).unwrap_or_else(|| panic!("no manifold: {triangles:?}"));
    let mesh = HalfEdgeMesh::from_triangles(triangles, vertex_count(triangles), &budget).unwrap();
    let table = CornerTable::build(triangles, vertex_count(triangles), &budget).unwrap();
    let mut rings = EdgeRings::default();
    let (mut allowed, mut refused) = (0, 0);
    for h in mesh.half_edges() {
        let (a, b) = (mesh.origin(h).index() as u32, mesh.destination(h).index() as u32);
        let (after, topology_after) = collapsed(triangles, a, b);
        let is_kept = topology_after == Some(before);
        assert_eq!(
            mesh.can_collapse(h).is_ok(),
            is_kept,
            "{a} -> {b} of {triangles:?}: {:?}",
            mesh.can_collapse(h)
        );
        (allowed, refused) = (allowed + usize::from(is_kept), refused + usize::from(!is_kept));
        if is_kept {
            let mut mesh = mesh.clone();
            mesh.collapse(h).unwrap();
            let claims = Claims { is_triangular: true, euler: Some(before.euler), ..Claims::default() };
            assert_eq!(mesh.check(&claims, &budget).unwrap(), []);
            assert_eq!(as_set(listed(&mesh)), as_set(after.iter().copied()));
        }
        if mesh.is_boundary(h) {
            continue;
        }
        // The table's half-edges count by four.
        let g = (h.index() + h.index() / 3) as u32;
        assert_eq!((table.origin(g), table.destination(g)), (a, b));
        rings.walk(&table, g);
        assert_eq!(table.link_condition(g, &rings).is_ok(), is_kept, "{a} -> {b} of {triangles:?}");
        if is_kept {
            let mut table = table.clone();
            table.collapse(g, &rings);
            assert_same(&table, &after);
        }
    }
    (allowed, refused)
}

/// The triangles of `table` are those of the list, and its twins what the list says.
fn assert_same(table: &CornerTable, triangles: &[Triangle]) {
    let corners = (0..table.triangle_bound() as u32).filter_map(|t| table.corners(t));
    assert_eq!(as_set(corners), as_set(triangles.iter().copied()));
    assert_eq!(table.triangle_count(), triangles.len());
    let ends = |h: u32| (table.origin(h), table.destination(h));
    let by_ends: BTreeMap<(u32, u32), u32> = table.half_edges().map(|h| (ends(h), h)).collect();
    for (&(a, b), &h) in &by_ends {
        let twin = by_ends.get(&(b, a)).copied().unwrap_or(meshmend::mesh::corner_table::NONE);
        assert_eq!(table.twin(h), twin);
    }
}

/// Turns triangles around until neighbours agree; nothing when they cannot.
fn oriented(mut triangles: Vec<Triangle>) -> Option<Vec<Triangle>> {
    let mut is_fixed = vec![false; triangles.len()];
    for start in 0..triangles.len() {
        let mut open = if is_fixed[start] { vec![] } else { vec![start] };
        is_fixed[start] = true;
        while let Some(t) = open.pop() {
            let runs = |t: &Triangle, a: u32, b: u32| (0..3).any(|i| (t[i], t[(i + 1) % 3]) == (a, b));
            for i in 0..3 {
                let (a, b) = (triangles[t][i], triangles[t][(i + 1) % 3]);
                for u in (0..triangles.len()).filter(|&u| u != t) {
                    if runs(&triangles[u], a, b) {
                        if is_fixed[u] {
                            return None;
                        }
                        triangles[u].swap(1, 2);
                    } else if !runs(&triangles[u], b, a) {
                        continue;
                    }
                    if !std::mem::replace(&mut is_fixed[u], true) {
                        open.push(u);
                    }
                }
            }
        }
    }
    Some(triangles)
}

/// All sets of triangles on `n` vertices in which no edge has more than two.
fn with_two_faces_at_most(n: u32, mut visit: impl FnMut(&[Triangle])) {
    let all: Vec<Triangle> =
        (0..n).flat_map(|a| (a + 1..n).flat_map(move |b| (b + 1..n).map(move |c| [a, b, c]))).collect();
    let edge = |a: u32, b: u32| (a * n + b) as usize;
    let mut uses = vec![0u8; (n * n) as usize];
    let mut chosen: Vec<Triangle> = Vec::new();
    // A counter whose digits say which triangles are chosen, walked in order without recursion.
    let mut picks = vec![false; all.len()];
    let mut i = 0;
    loop {
        if i == all.len() {
            visit(&chosen);
            // Back to the last triangle that was chosen, and on without it.
            while i > 0 && !picks[i - 1] {
                i -= 1;
            }
            if i == 0 {
                return;
            }
            picks[i - 1] = false;
            let [a, b, c] = chosen.pop().unwrap();
            [edge(a, b), edge(b, c), edge(a, c)].iter().for_each(|&e| uses[e] -= 1);
            continue;
        }
        let [a, b, c] = all[i];
        let edges = [edge(a, b), edge(b, c), edge(a, c)];
        picks[i] = edges.iter().all(|&e| uses[e] < 2);
        if picks[i] {
            edges.iter().for_each(|&e| uses[e] += 1);
            chosen.push(all[i]);
        }
        i += 1;
    }
}

#[test]
fn on_all_small_meshes_the_link_condition_allows_exactly_the_collapses_that_keep_the_topology() {
    // All on up to five vertices; of those on six, one in so many, or all of them in a campaign.
    for (n, every) in [(3, 1), (4, 1), (5, 1), (6, cases(8, 1))] {
        let (mut meshes, mut allowed, mut refused) = (0, 0, 0);
        with_two_faces_at_most(n, |triangles| {
            let Some(mesh) = oriented(triangles.to_vec()).filter(|mesh| topology(mesh).is_some()) else {
                return;
            };
            meshes += 1;
            if meshes % every == 0 {
                let (a, r) = assert_link_condition_is_exact(&mesh);
                (allowed, refused) = (allowed + a, refused + r);
            }
        });
        println!("{n} vertices: {meshes} meshes, {allowed} collapses allowed, {refused} refused");
        assert!(n < 5 || (allowed > 500 && refused > 500), "{n}: {allowed} {refused}");
    }
}

/// A torus on seven vertices, an octahedron, and others to begin with.
fn seeds() -> Vec<Vec<Triangle>> {
    let torus = (0..7).flat_map(|i| [[i, (i + 1) % 7, (i + 3) % 7], [i, (i + 3) % 7, (i + 2) % 7]]).collect();
    let octahedron: Vec<Triangle> =
        vec![[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1], [5, 2, 1], [5, 3, 2], [5, 4, 3], [5, 1, 4]];
    let ring =
        (0..4).flat_map(|i| [[i, (i + 1) % 4, 4 + i], [(i + 1) % 4, 4 + (i + 1) % 4, 4 + i]]).collect();
    let two = octahedron.iter().copied().chain(octahedron.iter().map(|t| t.map(|v| v + 6))).collect();
    vec![torus, octahedron, ring, two, vec![[0, 1, 2]]]
}

/// A random manifold: a seed after random splits of vertices, flips of edges and, perhaps, losses of faces.
pub(crate) fn random_manifold(random: &mut Random, steps: usize) -> Vec<Triangle> {
    let all = seeds();
    let triangles = all[random.below(all.len())].clone();
    let loses_faces = random.one_in(2);
    edited(random, triangles, steps, loses_faces)
}

/// A random manifold without boundary.
pub(crate) fn random_closed_manifold(random: &mut Random, steps: usize) -> Vec<Triangle> {
    let mut all = seeds();
    all.retain(|mesh| topology(mesh).is_some_and(|t| t.boundary_loops == 0));
    let triangles = all.swap_remove(random.below(all.len()));
    edited(random, triangles, steps, false)
}

fn edited(
    random: &mut Random,
    mut triangles: Vec<Triangle>,
    steps: usize,
    loses_faces: bool,
) -> Vec<Triangle> {
    for _ in 0..steps {
        let budget = Budget::unlimited();
        let mut mesh = HalfEdgeMesh::from_triangles(&triangles, vertex_count(&triangles), &budget).unwrap();
        let h = HalfEdgeId::new(random.below(mesh.half_edge_bound()));
        match random.below(8) {
            0 if loses_faces => {
                let mut fewer = triangles.clone();
                fewer.swap_remove(random.below(triangles.len()));
                if topology(&fewer).is_some() && !fewer.is_empty() {
                    triangles = fewer;
                }
                continue;
            }
            1 | 2 => {
                // A refused flip is a step as well.
                let _ = mesh.flip(h);
            }
            _ => {
                let v = mesh.origin(h);
                let around: Vec<HalfEdgeId> = mesh.around(h).collect();
                let to = SplitAt::Edge(around[random.below(around.len())]);
                let from = if random.one_in(3) { SplitAt::Boundary } else { SplitAt::Edge(h) };
                let (from, to) = if random.one_in(2) { (from, to) } else { (to, from) };
                let _ = mesh.split_vertex(v, from, to);
            }
        }
        triangles = listed(&mesh);
    }
    triangles
}

#[test]
fn on_random_meshes_the_link_condition_allows_exactly_the_collapses_that_keep_the_topology() {
    let mut random = Random::new(41);
    let (mut allowed, mut refused, mut bordered, mut handles) = (0, 0, 0, 0);
    for _ in 0..cases(1_500, 20_000) {
        let steps = random.below(30);
        let mesh = random_manifold(&mut random, steps);
        let topology = topology(&mesh).unwrap();
        bordered += usize::from(topology.boundary_loops > 0);
        handles += usize::from(topology.euler <= 0 && topology.boundary_loops == 0);
        let (a, r) = assert_link_condition_is_exact(&mesh);
        (allowed, refused) = (allowed + a, refused + r);
    }
    assert!(allowed > 10_000 && refused > 5_000, "{allowed} {refused}");
    assert!(bordered > 100 && handles > 20, "{bordered} {handles}");
}

#[test]
fn collapses_keep_the_invariants_and_each_is_undone_by_its_split() {
    let mut random = Random::new(42);
    let budget = Budget::unlimited();
    let (mut collapses, mut undone) = (0, 0);
    for case in 0..cases(300, 5_000) {
        let start = random_manifold(&mut random, 20);
        let mut mesh = HalfEdgeMesh::from_triangles(&start, vertex_count(&start), &budget).unwrap();
        let claims = Claims { is_triangular: true, euler: Some(mesh.counts().euler()), ..Claims::default() };
        for _ in 0..100 {
            let h = HalfEdgeId::new(random.below(mesh.half_edge_bound()));
            if !mesh.contains(h) {
                continue;
            }
            let before = listed(&mesh);
            let Ok(done) = mesh.collapse(h) else { continue };
            collapses += 1;
            if random.one_in(3) {
                let back = mesh.split_vertex(done.kept, done.from, done.to).unwrap();
                let (new, old) = (mesh.origin(back).index() as u32, done.removed.index() as u32);
                let named = listed(&mesh).into_iter().map(|t| t.map(|v| if v == new { old } else { v }));
                assert_eq!(as_set(named), as_set(before), "case {case}: {start:?}");
                undone += 1;
            }
        }
        assert_eq!(mesh.check(&claims, &budget).unwrap(), [], "case {case}: {start:?}");
    }
    assert!(collapses > 500 && undone > 200, "{collapses} {undone}");
}
