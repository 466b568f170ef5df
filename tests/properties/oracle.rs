//! A second opinion on index triples and positions: rational arithmetic, all pairs, the simplest code that can be right.
//! Shares nothing with the project but the conditions it judges.

use crate::rational::{Point, cross, dot, is_zero, minus, number};
use dashu_ratio::RBig;
use std::collections::{BTreeMap, BTreeSet};

/// Points and index triples; nothing is promised about them.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct RawSoup {
    pub(crate) positions: Vec<[f64; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// How often each condition is broken, in the words of the certificate.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Opinion {
    pub(crate) unusable: u64,
    pub(crate) degenerate: u64,
    pub(crate) duplicate: u64,
    pub(crate) edges_without_two_triangles: u64,
    pub(crate) edges_in_one_direction: u64,
    pub(crate) singular_vertices: u64,
    pub(crate) contacts: u64,
    /// Winding number 0 or 1 everywhere and not empty; `None` unless everything above is zero.
    pub(crate) is_solid: Option<bool>,
}

impl Opinion {
    pub(crate) fn p0(&self) -> bool {
        Self { contacts: 0, is_solid: None, ..*self } == Self::default()
    }

    pub(crate) fn is_valid(&self) -> bool {
        self.is_solid == Some(true)
    }
}

/// Judges `soup` as it is, after welding equal positions.
pub(crate) fn judge_welded(soup: &RawSoup) -> Opinion {
    let mut welded = weld(soup);
    let mut opinion = judge_indices(&welded);
    let exact = Exact::of(&welded);
    let is_finite = |v: &u32| welded.positions[*v as usize].iter().all(|x| x.is_finite());
    welded.triangles.retain(|t| t.iter().all(is_finite));
    let kept = exact.not_degenerate_nor_repeated(&welded.triangles);
    opinion.contacts = exact.contacts(&welded.triangles, &kept).len() as u64;
    if opinion.p0() && opinion.contacts == 0 {
        opinion.is_solid = Some(exact.is_solid(&welded.triangles));
    }
    opinion
}

/// Judges P0 of `soup` by its indices.
pub(crate) fn judge_indices(soup: &RawSoup) -> Opinion {
    let is_finite = |v: &u32| soup.positions[*v as usize].iter().all(|x| x.is_finite());
    let finite: Vec<[u32; 3]> = soup.triangles.iter().copied().filter(|t| t.iter().all(is_finite)).collect();
    let non_finite_vertices = (0..soup.positions.len() as u32).filter(|v| !is_finite(v)).count();
    let exact = Exact::of(soup);
    let simplices = simplices(soup);
    let edges = edges(&simplices);
    let sets: BTreeSet<[u32; 3]> = simplices.iter().map(sorted).collect();
    let vertices: BTreeSet<u32> = simplices.iter().flatten().copied().collect();
    Opinion {
        unusable: (soup.triangles.len() - finite.len() + non_finite_vertices) as u64,
        degenerate: finite.iter().filter(|t| exact.is_degenerate(**t)).count() as u64,
        duplicate: (simplices.len() - sets.len()) as u64,
        edges_without_two_triangles: edges.values().filter(|e| e.len() != 2).count() as u64,
        edges_in_one_direction: edges.values().filter(|e| e.len() == 2 && e[0].1 == e[1].1).count() as u64,
        singular_vertices: vertices.iter().filter(|&&v| fans(v, &simplices, &edges) > 1).count() as u64,
        ..Opinion::default()
    }
}

/// The faces named for a violation, judged: do they show it?
pub(crate) struct Doubt<'a> {
    soup: &'a RawSoup,
    exact: Exact,
}

impl<'a> Doubt<'a> {
    pub(crate) fn about(soup: &'a RawSoup) -> Self {
        Self { exact: Exact::of(soup), soup }
    }

    pub(crate) fn is_unusable(&self, t: u32) -> bool {
        let positions = self.soup.triangles[t as usize].map(|v| self.soup.positions[v as usize]);
        positions.iter().flatten().any(|x| !x.is_finite())
    }

    pub(crate) fn winding_in_front(&self, t: u32) -> i64 {
        self.exact.winding_in_front(t as usize, &self.soup.triangles)
    }

    pub(crate) fn is_degenerate(&self, t: u32) -> bool {
        self.exact.is_degenerate(self.soup.triangles[t as usize])
    }

    pub(crate) fn have_same_vertices(&self, a: u32, b: u32) -> bool {
        a != b && sorted(&self.soup.triangles[a as usize]) == sorted(&self.soup.triangles[b as usize])
    }

    pub(crate) fn meet(&self, a: u32, b: u32) -> bool {
        self.exact.meet(self.soup.triangles[a as usize], self.soup.triangles[b as usize])
    }

    /// Whether some edge of triangle `t` has not exactly two triangles, or two in one direction if that is asked.
    pub(crate) fn has_bad_edge(&self, t: u32, in_one_direction: bool) -> bool {
        let edges = edges(&simplices(self.soup));
        directed(self.soup.triangles[t as usize]).into_iter().any(|(a, b)| {
            let group = &edges[&(a.min(b), a.max(b))];
            if in_one_direction { group.len() == 2 && group[0].1 == group[1].1 } else { group.len() != 2 }
        })
    }

    /// Whether some corner of triangle `t` has more than one fan.
    pub(crate) fn has_singular_corner(&self, t: u32) -> bool {
        let simplices = simplices(self.soup);
        let edges = edges(&simplices);
        self.soup.triangles[t as usize].into_iter().any(|v| fans(v, &simplices, &edges) > 1)
    }
}

/// The same triangles over distinct positions, numbered by first occurrence; -0 equals 0.
pub(crate) fn weld(soup: &RawSoup) -> RawSoup {
    let mut ids = BTreeMap::new();
    let mut welded = RawSoup::default();
    let group: Vec<u32> = soup
        .positions
        .iter()
        .map(|p| {
            let key = p.map(|x| if x == 0.0 { 0 } else { x.to_bits() });
            *ids.entry(key).or_insert_with(|| {
                welded.positions.push(*p);
                welded.positions.len() as u32 - 1
            })
        })
        .collect();
    welded.triangles = soup.triangles.iter().map(|t| t.map(|v| group[v as usize])).collect();
    welded
}

/// The triangles with three distinct vertices, all finite.
fn simplices(soup: &RawSoup) -> Vec<[u32; 3]> {
    let is_finite = |v: &u32| soup.positions[*v as usize].iter().all(|x| x.is_finite());
    let is_kept = |t: &[u32; 3]| t.iter().all(is_finite) && t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
    soup.triangles.iter().copied().filter(is_kept).collect()
}

fn sorted(triangle: &[u32; 3]) -> [u32; 3] {
    let mut triangle = *triangle;
    triangle.sort_unstable();
    triangle
}

fn directed([a, b, c]: [u32; 3]) -> [(u32, u32); 3] {
    [(a, b), (b, c), (c, a)]
}

/// For each undirected edge its triangles, each with whether it runs upward.
fn edges(triangles: &[[u32; 3]]) -> BTreeMap<(u32, u32), Vec<(usize, bool)>> {
    let mut edges: BTreeMap<_, Vec<_>> = BTreeMap::new();
    for (t, &triangle) in triangles.iter().enumerate() {
        for (a, b) in directed(triangle) {
            edges.entry((a.min(b), a.max(b))).or_default().push((t, a < b));
        }
    }
    edges
}

/// Number of classes of triangles at `v` that are connected across edges with exactly two triangles.
fn fans(v: u32, triangles: &[[u32; 3]], edges: &BTreeMap<(u32, u32), Vec<(usize, bool)>>) -> usize {
    let mut left: BTreeSet<usize> = (0..triangles.len()).filter(|&t| triangles[t].contains(&v)).collect();
    let mut count = 0;
    while let Some(start) = left.pop_first() {
        count += 1;
        let mut queue = vec![start];
        while let Some(t) = queue.pop() {
            for (a, b) in directed(triangles[t]) {
                let group = &edges[&(a.min(b), a.max(b))];
                if (a == v || b == v) && group.len() == 2 {
                    queue.extend(group.iter().map(|e| e.0).filter(|t| left.remove(t)));
                }
            }
        }
    }
    count
}

/// Positions as rationals; those that are not finite stand at the origin and belong to no triangle that is asked about.
struct Exact {
    points: Vec<Point>,
    rounded: Vec<[f64; 3]>,
}

impl Exact {
    fn of(soup: &RawSoup) -> Self {
        let exact = |x: f64| number(if x.is_finite() { x } else { 0.0 });
        Self {
            points: soup.positions.iter().map(|p| p.map(exact)).collect(),
            rounded: soup.positions.clone(),
        }
    }

    fn corners(&self, triangle: [u32; 3]) -> [&Point; 3] {
        triangle.map(|v| &self.points[v as usize])
    }

    fn normal(&self, triangle: [u32; 3]) -> Point {
        let [a, b, c] = self.corners(triangle);
        cross(&minus(b, a), &minus(c, a))
    }

    fn is_degenerate(&self, triangle: [u32; 3]) -> bool {
        is_zero(&self.normal(triangle))
    }

    fn not_degenerate_nor_repeated(&self, triangles: &[[u32; 3]]) -> Vec<usize> {
        let mut seen = BTreeSet::new();
        (0..triangles.len())
            .filter(|&t| !self.is_degenerate(triangles[t]) && seen.insert(sorted(&triangles[t])))
            .collect()
    }

    /// All pairs of `kept` that meet in more than a common vertex or edge.
    fn contacts(&self, triangles: &[[u32; 3]], kept: &[usize]) -> Vec<[usize; 2]> {
        let mut contacts = Vec::new();
        for (i, &a) in kept.iter().enumerate() {
            for &b in &kept[i + 1..] {
                if self.meet(triangles[a], triangles[b]) {
                    contacts.push([a, b]);
                }
            }
        }
        contacts
    }

    /// Clips `a` by everything that bounds `b` and looks at the corners of what is left.
    fn meet(&self, a: [u32; 3], b: [u32; 3]) -> bool {
        let shared: Vec<u32> = a.into_iter().filter(|v| b.contains(v)).collect();
        if shared.len() == 3 || !self.boxes_meet(a, b) {
            return false;
        }
        let normal = self.normal(b);
        let back = normal.clone().map(|x| -x);
        let corners = self.corners(b);
        let mut left: Vec<Point> = self.corners(a).map(Clone::clone).to_vec();
        left = clip(&left, &normal, corners[0]);
        left = clip(&left, &back, corners[0]);
        for i in 0..3 {
            if left.is_empty() {
                return false;
            }
            let along = minus(corners[(i + 1) % 3], corners[i]);
            left = clip(&left, &cross(&normal, &along), corners[i]);
        }
        match shared[..] {
            [] => !left.is_empty(),
            [v] => left.iter().any(|p| p != &self.points[v as usize]),
            [u, v, ..] => {
                let (u, v) = (&self.points[u as usize], &self.points[v as usize]);
                left.iter().any(|p| !is_zero(&cross(&minus(p, u), &minus(v, u))))
            }
        }
    }

    /// Saves time only: triangles whose boxes are apart do not meet. Comparing floats is exact.
    fn boxes_meet(&self, a: [u32; 3], b: [u32; 3]) -> bool {
        (0..3).all(|i| {
            let [a, b] = [a, b].map(|t| t.map(|v| self.rounded[v as usize][i]));
            let low = |x: [f64; 3]| x.into_iter().fold(f64::INFINITY, f64::min);
            let high = |x: [f64; 3]| x.into_iter().fold(f64::NEG_INFINITY, f64::max);
            low(a) <= high(b) && low(b) <= high(a)
        })
    }

    /// Whether the winding number is 0 in front of the surface and 1 behind it, on every connected part, and there is
    /// a part. Every region of space borders some part, and P0 and P1 make each side of a part one region.
    fn is_solid(&self, triangles: &[[u32; 3]]) -> bool {
        let edges = edges(triangles);
        let mut left: BTreeSet<usize> = (0..triangles.len()).collect();
        let mut is_solid = !triangles.is_empty();
        while let Some(start) = left.pop_first() {
            is_solid &= self.winding_in_front(start, triangles) == 0;
            let mut queue = vec![start];
            while let Some(t) = queue.pop() {
                for (a, b) in directed(triangles[t]) {
                    queue.extend(edges[&(a.min(b), a.max(b))].iter().map(|e| e.0).filter(|t| left.remove(t)));
                }
            }
        }
        is_solid
    }

    /// The winding number just in front of triangle `t`, by a ray from its inside that meets no edge.
    fn winding_in_front(&self, t: usize, triangles: &[[u32; 3]]) -> i64 {
        for attempt in 0..1000u32 {
            let weights = [5 + attempt, 7 + 3 * attempt, 11 + attempt * attempt];
            let whole = RBig::from(weights.iter().sum::<u32>());
            let corners = self.corners(triangles[t]);
            let start: Point = std::array::from_fn(|i| {
                (0..3).fold(RBig::ZERO, |sum, c| sum + &corners[c][i] * RBig::from(weights[c])) / &whole
            });
            let ray = [13 + 2 * attempt, 29 + attempt, 71 + 5 * attempt].map(RBig::from);
            let side = dot(&ray, &self.normal(triangles[t]));
            let crossings: Option<Vec<i64>> = (0..triangles.len())
                .filter(|&other| other != t)
                .map(|other| self.crossing(&start, &ray, triangles[other]))
                .collect();
            if let (Some(crossings), true) = (crossings, side != RBig::ZERO) {
                // Behind the surface the winding number is one larger than in front of it.
                return crossings.iter().sum::<i64>() - i64::from(side < RBig::ZERO);
            }
        }
        panic!("no ray in general position")
    }

    /// 1 where the ray leaves through the triangle, -1 where it enters, 0 where it passes by; `None` where its line meets
    /// the line of an edge.
    fn crossing(&self, start: &Point, ray: &Point, triangle: [u32; 3]) -> Option<i64> {
        let corners = self.corners(triangle).map(|p| minus(p, start));
        let turns: [RBig; 3] = std::array::from_fn(|i| dot(ray, &cross(&corners[i], &corners[(i + 1) % 3])));
        if turns.contains(&RBig::ZERO) {
            return None;
        }
        if turns.iter().any(|x| (*x > RBig::ZERO) != (turns[0] > RBig::ZERO)) {
            return Some(0);
        }
        let normal = self.normal(triangle);
        let (slope, height) = (dot(ray, &normal), dot(&corners[0], &normal));
        let is_ahead = (slope > RBig::ZERO) == (height > RBig::ZERO);
        Some(if !is_ahead {
            0
        } else if slope > RBig::ZERO {
            1
        } else {
            -1
        })
    }
}

/// The part of a convex polygon (also a segment or a point) where `normal . (x - origin) >= 0`.
fn clip(polygon: &[Point], normal: &Point, origin: &Point) -> Vec<Point> {
    let heights: Vec<RBig> = polygon.iter().map(|p| dot(normal, &minus(p, origin))).collect();
    let mut kept = Vec::new();
    for i in 0..polygon.len() {
        let j = (i + 1) % polygon.len();
        if heights[i] >= RBig::ZERO {
            kept.push(polygon[i].clone());
        }
        if (heights[i] > RBig::ZERO && heights[j] < RBig::ZERO)
            || (heights[i] < RBig::ZERO && heights[j] > RBig::ZERO)
        {
            let share = &heights[i] / (&heights[i] - &heights[j]);
            let along = minus(&polygon[j], &polygon[i]);
            kept.push(std::array::from_fn(|k| &polygon[i][k] + &along[k] * &share));
        }
    }
    kept
}
