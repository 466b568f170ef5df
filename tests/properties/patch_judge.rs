//! What filling may do to a mesh, judged by counting and by all pairs in rational arithmetic.
//!
//! A pair of triangles whose separation shows in rounded numbers beyond any doubt is not looked at again.

use crate::oracle::{Doubt, RawSoup, weld};
use meshmend::geom::DVec3;
use meshmend::repair::fill::FillReport;
use std::collections::{BTreeMap, BTreeSet};

type Edge = (u32, u32);

/// Triangles with one vertex at each place, and what is at their edges.
struct Surface {
    soup: RawSoup,
    /// For each edge its triangles, each with whether it runs upward.
    edges: BTreeMap<Edge, Vec<(usize, bool)>>,
}

fn directed([a, b, c]: [u32; 3]) -> [Edge; 3] {
    [(a, b), (b, c), (c, a)]
}

fn sorted(mut t: [u32; 3]) -> [u32; 3] {
    t.sort_unstable();
    t
}

impl Surface {
    fn of(soup: &RawSoup) -> Self {
        let soup = weld(soup);
        let mut edges: BTreeMap<Edge, Vec<(usize, bool)>> = BTreeMap::new();
        for (t, &triangle) in soup.triangles.iter().enumerate() {
            for (a, b) in directed(triangle) {
                edges.entry((a.min(b), a.max(b))).or_default().push((t, a < b));
            }
        }
        Self { soup, edges }
    }

    /// Edges with one triangle, in the direction in which it runs along them.
    fn boundary(&self) -> BTreeSet<Edge> {
        let open = self.edges.iter().filter(|(_, own)| own.len() == 1);
        open.map(|(&(a, b), own)| if own[0].1 { (a, b) } else { (b, a) }).collect()
    }

    /// The classes of the triangles at vertices that are connected over edges with two triangles, for each vertex.
    fn fans(&self, among: impl Fn(usize) -> bool) -> BTreeMap<u32, usize> {
        let mut at: BTreeMap<u32, BTreeSet<usize>> = BTreeMap::new();
        for (t, corners) in self.soup.triangles.iter().enumerate().filter(|&(t, _)| among(t)) {
            corners.iter().for_each(|&v| {
                at.entry(v).or_default().insert(t);
            });
        }
        let count = |(v, mut left): (u32, BTreeSet<usize>)| {
            let mut fans = 0;
            while let Some(start) = left.pop_first() {
                fans += 1;
                let mut open = vec![start];
                while let Some(t) = open.pop() {
                    for (a, b) in
                        directed(self.soup.triangles[t]).into_iter().filter(|e| e.0 == v || e.1 == v)
                    {
                        let group = &self.edges[&(a.min(b), a.max(b))];
                        if group.len() == 2 {
                            open.extend(group.iter().map(|e| e.0).filter(|t| left.remove(t)));
                        }
                    }
                }
            }
            (v, fans)
        };
        at.into_iter().map(count).collect()
    }
}

/// A mesh with holes, of which filled ones are made.
pub(crate) struct Torn<'a> {
    soup: &'a RawSoup,
    boundary: BTreeSet<Edge>,
    fans: BTreeMap<u32, usize>,
}

impl<'a> Torn<'a> {
    /// The positions of `soup` are distinct.
    pub(crate) fn new(soup: &'a RawSoup) -> Self {
        let surface = Surface::of(soup);
        assert_eq!(surface.soup.positions, soup.positions, "vertices are welded");
        Self { soup, boundary: surface.boundary(), fans: surface.fans(|_| true) }
    }

    /// Everything that is wrong with `filled`, in sentences. `filled` has the triangles of this mesh first; the rest are
    /// patches, of which `report` says how they are planned.
    pub(crate) fn faults(&self, filled: &RawSoup, report: &FillReport) -> Vec<String> {
        let first = self.soup.triangles.len();
        let mut faults = Vec::new();
        let bits = |p: &[f64; 3]| p.map(f64::to_bits);
        let old = filled.positions.iter().take(self.soup.positions.len()).map(bits);
        if !old.eq(self.soup.positions.iter().map(bits)) {
            faults.push("a vertex moved".into());
        }
        if filled.triangles[..first] != self.soup.triangles {
            faults.push("a triangle changed".into());
        }
        let surface = Surface::of(filled);
        faults.extend(self.edge_faults(&surface));
        faults.extend(self.plan_faults(&surface, report));
        faults.extend(meetings(&surface.soup, first));
        faults
    }

    fn edge_faults(&self, surface: &Surface) -> Vec<String> {
        let first = self.soup.triangles.len();
        let mut faults = Vec::new();
        for (edge, own) in surface.edges.iter().filter(|(_, own)| own.iter().any(|e| e.0 >= first)) {
            if own.len() != 2 || own[0].1 == own[1].1 {
                faults.push(format!("edge {edge:?} of a patch has triangles {own:?}"));
            }
        }
        let mut seen = BTreeSet::new();
        for (t, &corners) in surface.soup.triangles.iter().enumerate() {
            if !seen.insert(sorted(corners)) && t >= first {
                faults.push(format!("triangle {t} is there twice"));
            }
        }
        for (v, fans) in surface.fans(|_| true) {
            if fans > self.fans.get(&v).copied().unwrap_or(1) {
                faults.push(format!("{fans} fans at vertex {v}"));
            }
        }
        faults
    }

    /// Of each patch: a surface with exactly loops of the boundary as its own, with as many triangles, vertices and loops
    /// as planned. A sphere with so many holes has the Euler characteristic 2 less their number.
    fn plan_faults(&self, surface: &Surface, report: &FillReport) -> Vec<String> {
        let first = self.soup.triangles.len();
        let mut faults = Vec::new();
        let mut left: BTreeSet<usize> = (first..surface.soup.triangles.len()).collect();
        let is_patch = |own: &[(usize, bool)]| own.len() == 2 && own.iter().all(|e| e.0 >= first);
        let mut patches: Vec<[i64; 3]> = Vec::new();
        while let Some(start) = left.pop_first() {
            let (mut open, mut own) = (vec![start], BTreeSet::from([start]));
            let (mut edges, mut rim) = (BTreeSet::new(), 0);
            while let Some(t) = open.pop() {
                for (a, b) in directed(surface.soup.triangles[t]) {
                    let edge = (a.min(b), a.max(b));
                    edges.insert(edge);
                    if is_patch(&surface.edges[&edge]) {
                        let beside = surface.edges[&edge].iter().map(|e| e.0).filter(|t| left.remove(t));
                        beside.for_each(|t| {
                            own.insert(t);
                            open.push(t);
                        });
                    } else {
                        rim += 1;
                        if !self.boundary.contains(&(b, a)) {
                            faults.push(format!("edge ({a}, {b}) of a patch is not of the rim"));
                        }
                    }
                }
            }
            // A place that the rim passes twice counts as often as the patch has fans there.
            let vertices: usize = own_fans(surface, &own, first).values().sum();
            let euler = vertices as i64 - edges.len() as i64 + own.len() as i64;
            patches.push([own.len() as i64, rim, euler]);
        }
        let filled = report.holes.iter().filter(|hole| hole.used.is_some());
        let mut planned: Vec<[i64; 3]> = filled
            .map(|hole| {
                let rim: u32 = hole.rims.iter().map(|rim| rim.edges).sum();
                [hole.triangles as i64, i64::from(rim), 2 - hole.borders as i64]
            })
            .collect();
        patches.sort_unstable();
        planned.sort_unstable();
        if patches != planned {
            faults.push(format!("triangles, rim and Euler characteristic {patches:?}, planned {planned:?}"));
        }
        faults
    }
}

/// The fans of a patch alone at each of its vertices: over edges that two of its triangles have.
fn own_fans(surface: &Surface, own: &BTreeSet<usize>, first: usize) -> BTreeMap<u32, usize> {
    let mut alone = Surface { soup: surface.soup.clone(), edges: BTreeMap::new() };
    for &t in own {
        for (a, b) in directed(surface.soup.triangles[t]) {
            let edge = (a.min(b), a.max(b));
            let group = surface.edges[&edge].iter().copied().filter(|e| e.0 >= first);
            alone.edges.entry(edge).or_insert_with(|| group.collect());
        }
    }
    alone.fans(|t| own.contains(&t))
}

/// Triangles from `first` on that have no area or meet any triangle in more than a common vertex or edge.
fn meetings(soup: &RawSoup, first: usize) -> Vec<String> {
    let doubt = Doubt::about(soup);
    let corners = |t: usize| soup.triangles[t].map(|v| DVec3::from_array(soup.positions[v as usize]));
    let boxes: Vec<[DVec3; 2]> =
        (0..soup.triangles.len()).map(corners).map(|[a, b, c]| [a.min(b).min(c), a.max(b).max(c)]).collect();
    let mut faults = Vec::new();
    for t in first..soup.triangles.len() {
        if doubt.is_degenerate(t as u32) {
            faults.push(format!("triangle {t} has no area"));
        }
        for other in (0..soup.triangles.len()).filter(|&other| other < first || other < t) {
            let ([low, high], [from, to]) = (boxes[t], boxes[other]);
            if low.cmpgt(to).any() || from.cmpgt(high).any() {
                continue;
            }
            if !are_surely_apart(soup, t, other) && doubt.meet(t as u32, other as u32) {
                faults.push(format!("triangles {t} and {other} meet"));
            }
        }
    }
    faults
}

/// `true` only when two triangles have no point in common but their common corners and what is between these: a plane
/// through the one, or through an edge of it and along its normal, has every other corner of the other on one side, by more
/// than rounding may be wrong.
fn are_surely_apart(soup: &RawSoup, one: usize, other: usize) -> bool {
    let [one, other] = [one, other].map(|t| soup.triangles[t]);
    is_beyond(soup, one, other) || is_beyond(soup, other, one)
}

fn is_beyond(soup: &RawSoup, base: [u32; 3], of: [u32; 3]) -> bool {
    let at = |v: u32| DVec3::from_array(soup.positions[v as usize]);
    let [p, q, r] = base.map(at);
    let (normal, size) = ((q - p).cross(r - p), (q - p).length() * (r - p).length());
    // Of a sum of products of a few differences of numbers the relative error is some 1e-15 of the product of lengths.
    let side = |from: DVec3, direction: DVec3, size: f64, v: u32| {
        let to = at(v) - from;
        let height = direction.dot(to);
        if height.abs() > 1e-13 * size * to.length() { height } else { 0.0 }
    };
    let all = |from: DVec3, direction: DVec3, size: f64, shared: &dyn Fn(u32) -> bool| {
        let own = of.into_iter().filter(|&v| !shared(v));
        let heights: Vec<f64> = own.map(|v| side(from, direction, size, v)).collect();
        !heights.is_empty() && (heights.iter().all(|&h| h > 0.0) || heights.iter().all(|&h| h < 0.0))
    };
    if all(p, normal, size, &|v| base.contains(&v)) {
        return true;
    }
    (0..3).any(|i| {
        let [a, b, c] = [0, 1, 2].map(|k| base[(i + k) % 3]);
        let along = at(b) - at(a);
        let inward = normal.cross(along);
        // Corners on the edge are common; the third corner of the base is on the inner side.
        let is_outside = |v: u32| side(at(a), inward, size * along.length(), v) < 0.0;
        !of.contains(&c) && of.into_iter().all(|v| v == a || v == b || is_outside(v))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use meshmend::repair::fill::{HoleReport, HoleRim, Method};

    #[test]
    fn no_pair_that_is_surely_apart_meets_in_rational_arithmetic() {
        let mut random = Random::new(41);
        let (mut apart, mut met) = (0, 0);
        for case in 0..4_000 {
            let flat = random.one_in(3);
            let coordinate = |random: &mut Random| match case % 3 {
                0 => f64::from(random.between(-3, 3)),
                1 => f64::from(random.unit() as f32),
                _ => f64::from(random.between(-2, 2)) + f64::from((random.unit() * 1e-6) as f32),
            };
            let positions: Vec<[f64; 3]> = (0..6)
                .map(|_| [0, 1, 2].map(|k| if flat && k == 2 { 0.0 } else { coordinate(&mut random) }))
                .collect();
            let shared = random.below(3) as u32;
            let soup =
                RawSoup { positions, triangles: vec![[0, 1, 2], [3 - shared, 4 - shared, 5 - shared]] };
            let doubt = Doubt::about(&soup);
            if doubt.is_degenerate(0) || doubt.is_degenerate(1) {
                continue;
            }
            let meets = doubt.meet(0, 1);
            if are_surely_apart(&soup, 0, 1) {
                assert!(!meets, "case {case}: {soup:?}");
                apart += 1;
            }
            met += usize::from(meets);
        }
        assert!(apart > 500 && met > 500, "{apart} apart, {met} meet");
    }

    /// A tetrahedron without a face, and that face as a patch.
    fn patched() -> (RawSoup, RawSoup, FillReport) {
        let whole = crate::solids::tetrahedron();
        let mut torn = whole.clone();
        torn.triangles.pop();
        let hole = HoleReport {
            used: Some(Method::Flat),
            rims: vec![HoleRim { half_edges: Vec::new(), edges: 3 }],
            borders: 1,
            triangles: 1,
            ..HoleReport::default()
        };
        (torn, whole, FillReport { holes: vec![hole], ..FillReport::default() })
    }

    #[test]
    fn every_fault_is_found() {
        let (torn, whole, report) = patched();
        let faults = |filled: &RawSoup| Torn::new(&torn).faults(filled, &report);
        assert_eq!(faults(&whole), Vec::<String>::new());
        let has = |filled: &RawSoup, what: &str| {
            let found = faults(filled);
            assert!(found.iter().any(|fault| fault.contains(what)), "{what}: {found:?}");
        };
        let changed = |change: &dyn Fn(&mut RawSoup)| {
            let mut filled = whole.clone();
            change(&mut filled);
            filled
        };
        has(&changed(&|m| m.positions[3][0] = -0.0), "a vertex moved");
        has(&changed(&|m| m.triangles[0].reverse()), "a triangle changed");
        has(&changed(&|m| m.triangles[3].reverse()), "of a patch has triangles");
        has(&changed(&|m| m.triangles.push(m.triangles[0])), "is there twice");
        has(&changed(&|m| m.triangles.push(m.triangles[3])), "planned");
        let with = |place: [f64; 3]| {
            changed(&|m| {
                let [a, b, c] = m.triangles[3];
                m.positions.push(place);
                m.triangles.truncate(3);
                m.triangles.extend([[a, b, 4], [b, c, 4], [c, a, 4]]);
            })
        };
        // A patch with a peak that goes through the opposite face.
        let peak = with([0.5, 0.5, 0.5]);
        has(&peak, "meet");
        has(&peak, "planned");
        let place = |v: u32| DVec3::from_array(whole.positions[v as usize]);
        // A new vertex on an old one, and one in the middle of an edge of the rim.
        let [a, b, _] = whole.triangles[3];
        has(&with(whole.positions[1]), "is there twice");
        has(&with(((place(a) + place(b)) / 2.0).to_array()), "has no area");
    }
}
