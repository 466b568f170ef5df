//! Refines a patch to the edge length of its rim, with triangles near to equilateral.
//!
//! Liepa, "Filling holes in meshes" (2003), divides triangles at their centroids. Here long edges are divided at their
//! middle and the new vertices spread evenly, which leaves fewer small angles; edges are turned by the Delaunay rule as
//! there. The edge length may grow away from the rim, so that a patch has vertices in proportion to its rim.

use super::patch::PatchMesh;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::mesh::triangle_of;
use std::f64::consts::PI;

/// An edge is divided when it is longer than so many of the lengths wanted at its ends: halves are then as near to that
/// length as the whole was.
const LONG: f64 = 4.0 / 3.0;
/// Rounds of dividing; each halves what is too long.
const ROUNDS_MAX: usize = 40;
/// Steps in which new vertices go to the middle of their neighbours, after each round.
const SPREADINGS: usize = 4;
/// How much longer an edge may be for each unit of distance from the rim; tried in this order.
const GROWTHS: [f64; 7] = [0.0, 0.05, 0.1, 0.2, 0.4, 0.8, 1.6];
/// New vertices that a patch may be expected to get for each corner of its rim, and at most: patches of several
/// thousand vertices already bend as smoothly as their rim.
const VERTICES_PER_CORNER: f64 = 32.0;
const VERTICES_EXPECTED_MAX: f64 = 6_000.0;
/// New vertices that a patch may have at most, for each that it would have if all edges of its rim were equally long: the
/// patch may become a dome, and its triangles are not all alike.
const VERTICES_PER_EXPECTED: f64 = 4.0;
/// As above for each corner of the rim, where that is more: between edges of very different lengths triangles have to
/// grow from the shortest on.
const VERTICES_PER_UNEVEN_CORNER: f64 = 8.0;
/// Beyond this nothing is divided, whatever was expected.
pub(super) const VERTICES_MAX: usize = 16_384;
/// Neighbouring triangles that bend more than they do (or 60 degrees) are not made by turning an edge.
const TURN_COS_MIN: f64 = 0.5;
/// Sine of an angle that is surely below half a turn, whatever rounding did.
const SURE_SINE: f64 = 1e-6;
/// Turns for each edge, at most. Delaunay turns of a flat patch end by themselves.
const TURNS_PER_EDGE: usize = 8;

/// Divides what is too long; `false` when nothing had to be, or what is divided already would become too many vertices.
/// `is_free(a, b)` says whether there may be an edge between two corners of the rim.
pub(super) fn refine(
    mesh: &mut PatchMesh,
    lengths: &mut Lengths,
    is_free: &dyn Fn(u32, u32) -> bool,
    budget: &Budget,
) -> Result<bool, Stopped> {
    loop {
        let (before, known) = (mesh.clone(), lengths.at.len());
        if let Some(has_divided) = divide_all(mesh, lengths, is_free, budget)? {
            return Ok(has_divided);
        }
        let is_divided = before.points.len() > before.rim;
        let growth = GROWTHS.into_iter().find(|&growth| growth > lengths.growth);
        if growth.is_none() && !is_divided {
            // As many as there may be.
            spread_and_turn(mesh, is_free, budget)?;
            return Ok(true);
        }
        *mesh = before;
        lengths.at.truncate(known);
        match growth {
            Some(growth) if !is_divided => lengths.growth = growth,
            _ => return Ok(false),
        }
    }
}

/// Whether something was divided; `None`: there would be too many vertices, and as many as there may be are there.
fn divide_all(
    mesh: &mut PatchMesh,
    lengths: &mut Lengths,
    is_free: &dyn Fn(u32, u32) -> bool,
    budget: &Budget,
) -> Result<Option<bool>, Stopped> {
    turn_edges(mesh, is_free, budget)?;
    for round in 0..ROUNDS_MAX {
        match divide(mesh, lengths, budget)? {
            Some(0) => return Ok(Some(round > 0)),
            Some(_) => spread_and_turn(mesh, is_free, budget)?,
            None => return Ok(None),
        }
    }
    Ok(Some(true))
}

fn spread_and_turn(
    mesh: &mut PatchMesh,
    is_free: &dyn Fn(u32, u32) -> bool,
    budget: &Budget,
) -> Result<(), Stopped> {
    turn_edges(mesh, is_free, budget)?;
    spread(mesh, SPREADINGS, budget)?;
    turn_edges(mesh, is_free, budget)
}

/// The edge length wanted at each vertex.
pub(super) struct Lengths {
    at: Vec<f64>,
    /// How much longer an edge may be for each unit of distance from the rim.
    growth: f64,
    /// New vertices that there may be.
    vertices_max: usize,
}

impl Lengths {
    /// Those of the rim, whose next corners are `next`.
    pub(super) fn of_rim(mesh: &PatchMesh, next: &[u32]) -> Self {
        let mut at = vec![0.0; mesh.rim];
        let mut perimeter = 0.0;
        for (i, &j) in next.iter().enumerate() {
            let length = mesh.point(i as u32).distance(mesh.point(j));
            perimeter += length;
            at[i] += length / 2.0;
            at[j as usize] += length / 2.0;
        }
        let (growth, expected) = growth(mesh.area(), perimeter, mesh.rim);
        let corners = mesh.rim as f64;
        let most = (VERTICES_PER_EXPECTED * expected).max(VERTICES_PER_UNEVEN_CORNER * corners);
        let vertices_max = (most.min(VERTICES_PER_CORNER * corners) as usize).min(VERTICES_MAX);
        Self { at, growth, vertices_max }
    }

    /// True for an edge that is to be divided.
    fn is_long(&self, mesh: &PatchMesh, [a, b]: [u32; 2]) -> bool {
        let wanted = (self.at[a as usize] + self.at[b as usize]) / 2.0;
        mesh.point(a).distance_squared(mesh.point(b)) > (LONG * wanted) * (LONG * wanted)
    }

    /// True for an edge that is shorter than so many of the lengths wanted at its ends.
    pub(super) fn is_below(&self, share: f64, mesh: &PatchMesh, [a, b]: [u32; 2]) -> bool {
        let least = share * (self.at[a as usize] + self.at[b as usize]) / 2.0;
        mesh.point(a).distance_squared(mesh.point(b)) < least * least
    }

    /// The most that an edge is longer than wanted at its ends, as a factor.
    pub(super) fn largest_stretch(&self, mesh: &PatchMesh) -> f64 {
        let stretch = |[a, b]: [u32; 2]| {
            2.0 * mesh.point(a).distance(mesh.point(b)) / (self.at[a as usize] + self.at[b as usize])
        };
        (0..3 * mesh.triangles.len() as u32).map(|h| stretch(mesh.ends(h))).fold(0.0, f64::max)
    }

    /// The length wanted at one vertex more.
    pub(super) fn push(&mut self, length: f64) {
        self.at.push(length);
    }

    /// Leaves out vertices that are gone.
    pub(super) fn keep(&mut self, is_kept: &[bool]) {
        let mut kept = is_kept.iter();
        self.at.retain(|_| kept.next().is_none_or(|&is_kept| is_kept));
    }

    fn between(&self, mesh: &PatchMesh, [a, b]: [u32; 2]) -> f64 {
        let (x, y) = (self.at[a as usize], self.at[b as usize]);
        let half = mesh.point(a).distance(mesh.point(b)) / 2.0;
        (x.min(y) + self.growth * half).max((x + y) / 2.0)
    }
}

/// The least growth with which a patch of this area gets a fair number of vertices, and that number. Seen as a disk with the
/// same ratio of area to perimeter, unrolled along its rim, whose edges are equally long.
fn growth(area: f64, perimeter: f64, corners: usize) -> (f64, f64) {
    let length = perimeter / corners as f64;
    let most = (VERTICES_PER_CORNER * corners as f64).min(VERTICES_EXPECTED_MAX);
    let radius = 2.0 * area / perimeter;
    let expected = |growth: f64| {
        const STEPS: u32 = 64;
        let step = radius / f64::from(STEPS);
        let ring = |i: u32| {
            let depth = (f64::from(i) + 0.5) * step;
            let edge = length + growth * depth;
            perimeter * (1.0 - depth / radius) * step / (edge * edge * 0.75f64.sqrt())
        };
        (0..STEPS).map(ring).sum::<f64>()
    };
    let mut all = GROWTHS.into_iter().map(|growth| (growth, expected(growth)));
    let last = GROWTHS[GROWTHS.len() - 1];
    all.find(|&(_, expected)| expected <= most).unwrap_or((last, most))
}

/// Divides every long edge once; gives how many. `None`: there are as many vertices as there may be, and more is long.
fn divide(mesh: &mut PatchMesh, lengths: &mut Lengths, budget: &Budget) -> Result<Option<usize>, Stopped> {
    let mut divided = 0;
    for h in 0..3 * mesh.triangles.len() as u32 {
        if h.is_multiple_of(CHECK_EVERY as u32) {
            budget.spend(CHECK_EVERY as u64 / 16)?;
        }
        let ends = mesh.ends(h);
        let is_first = mesh.twin(h).is_some_and(|twin| h < twin);
        if !is_first || !lengths.is_long(mesh, ends) {
            continue;
        }
        if mesh.points.len() - mesh.rim >= lengths.vertices_max {
            return Ok(None);
        }
        let length = lengths.between(mesh, ends);
        let [a, b] = ends.map(|v| mesh.point(v));
        if mesh.split(h, (a + b) / 2.0).is_some() {
            lengths.push(length);
            divided += 1;
        }
    }
    Ok(Some(divided))
}

/// Turns edges until each triangle's circle is empty of the neighbour's corner, as far as that bends nothing.
pub(super) fn turn_edges(
    mesh: &mut PatchMesh,
    is_free: &dyn Fn(u32, u32) -> bool,
    budget: &Budget,
) -> Result<(), Stopped> {
    let mut open: Vec<u32> = (0..3 * mesh.triangles.len() as u32).rev().collect();
    // Half-edges whose circles are empty as long as their triangles stay.
    let mut is_settled = vec![false; open.len()];
    let mut left = TURNS_PER_EDGE * open.len();
    let mut looked = 0usize;
    while let Some(h) = open.pop() {
        looked += 1;
        if looked.is_multiple_of(CHECK_EVERY) {
            budget.spend(CHECK_EVERY as u64 / 4)?;
        }
        let Some(g) = mesh.twin(h).filter(|_| !is_settled[h as usize]) else { continue };
        if is_circle_empty(mesh, h, g) {
            (is_settled[h as usize], is_settled[g as usize]) = (true, true);
            continue;
        }
        if left > 0
            && may_turn(mesh, h, g, is_free)
            && let Some(around) = mesh.flip(h)
        {
            left -= 1;
            for changed in [triangle_of(h), triangle_of(g)].into_iter().flat_map(|t| 3 * t..3 * t + 3) {
                is_settled[changed as usize] = false;
                if let Some(twin) = mesh.twin(changed) {
                    is_settled[twin as usize] = false;
                }
            }
            open.extend(around);
        }
    }
    Ok(())
}

/// Whether the angles across the edge between half-edges `h` and `g` are no more than half a turn together, so that the circle
/// of each triangle leaves out the corner of the other.
fn is_circle_empty(mesh: &PatchMesh, h: u32, g: u32) -> bool {
    let [pa, pb] = mesh.ends(h).map(|v| mesh.point(v));
    let sine_and_cosine = |p: DVec3| {
        let (u, v) = (pa - p, pb - p);
        (u.cross(v).length(), u.dot(v))
    };
    let [(s, c), (t, d)] = [mesh.apex(h), mesh.apex(g)].map(|v| sine_and_cosine(mesh.point(v)));
    // The sine of both angles together, times the lengths of their sides: clearly positive in most cases.
    let sine = s * d + t * c;
    if sine > 0.0 && sine * sine > SURE_SINE * SURE_SINE * (s * s + c * c) * (t * t + d * d) {
        return true;
    }
    // 1e-9: so that rounding does not turn an edge back and forth.
    libm::atan2(s, c) + libm::atan2(t, d) <= PI * (1.0 + 1e-9)
}

/// Whether the edge between half-edges `h` and `g` can be turned and that bends nothing.
fn may_turn(mesh: &PatchMesh, h: u32, g: u32, is_free: &dyn Fn(u32, u32) -> bool) -> bool {
    let ([a, b], c, d) = (mesh.ends(h), mesh.apex(h), mesh.apex(g));
    if c == d || mesh.has_edge(c, d) {
        return false;
    }
    let [pa, pb, pc, pd] = [a, b, c, d].map(|v| mesh.point(v));
    let bend = |n: DVec3, m: DVec3| n.normalize_or_zero().dot(m.normalize_or_zero());
    let normal = |x: DVec3, y: DVec3, z: DVec3| (y - x).cross(z - x);
    let was = bend(normal(pa, pb, pc), normal(pb, pa, pd));
    let turned = [normal(pc, pa, pd), normal(pd, pb, pc)];
    if turned.contains(&DVec3::ZERO) {
        return false;
    }
    let is = bend(turned[0], turned[1]);
    let is_of_rim = |v: u32| (v as usize) < mesh.rim;
    is >= was.min(TURN_COS_MIN) && (!(is_of_rim(c) && is_of_rim(d)) || is_free(c, d))
}

/// The angle at `p` between two others, in radians.
#[cfg(test)]
fn angle(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let (u, v) = (a - p, b - p);
    libm::atan2(u.cross(v).length(), u.dot(v))
}

/// Moves every new vertex to the middle of its neighbours, some times.
pub(super) fn spread(mesh: &mut PatchMesh, times: usize, budget: &Budget) -> Result<(), Stopped> {
    let (start, others) = mesh.neighbours();
    for _ in 0..times {
        budget.spend(others.len() as u64 / 16 + 1)?;
        for v in mesh.rim..mesh.points.len() {
            let own = &others[start[v] as usize..start[v + 1] as usize];
            let sum: DVec3 = own.iter().map(|&other| mesh.points[other as usize]).sum();
            mesh.points[v] = sum / own.len() as f64;
        }
    }
    Ok(())
}

/// The smallest angle of all triangles, in degrees.
#[cfg(test)]
pub(super) fn smallest_angle(mesh: &PatchMesh) -> f64 {
    let of = |t: usize| {
        let [a, b, c] = mesh.triangles[t].map(|v| mesh.point(v));
        angle(a, b, c).min(angle(b, c, a)).min(angle(c, a, b)).to_degrees()
    };
    (0..mesh.triangles.len()).map(of).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fan(n: u32) -> (PatchMesh, Vec<u32>) {
        let corner = |i: u32| {
            let turn = f64::from(i) * std::f64::consts::TAU / f64::from(n);
            DVec3::new(turn.cos(), turn.sin(), 0.0)
        };
        let triangles = (1..n - 1).map(|i| [0, i, i + 1]).collect();
        let mesh = PatchMesh::new((0..n).map(corner).collect(), triangles).unwrap();
        (mesh, (0..n).map(|i| (i + 1) % n).collect())
    }

    #[test]
    fn a_disk_is_refined_to_the_edges_of_its_rim_without_small_angles() {
        let (mut mesh, next) = fan(48);
        let mut lengths = Lengths::of_rim(&mesh, &next);
        assert!(refine(&mut mesh, &mut lengths, &|_, _| true, &Budget::unlimited()).unwrap());
        assert_eq!(mesh.check(), Vec::<String>::new());
        let inner = mesh.points.len() - mesh.rim;
        assert!((100..400).contains(&inner), "{inner} new vertices");
        assert!(smallest_angle(&mesh) > 15.0, "{} degrees", smallest_angle(&mesh));
    }

    #[test]
    fn a_large_disk_gets_vertices_in_proportion_to_its_rim() {
        let (mut mesh, next) = fan(2_000);
        let mut lengths = Lengths::of_rim(&mesh, &next);
        refine(&mut mesh, &mut lengths, &|_, _| true, &Budget::unlimited()).unwrap();
        let inner = mesh.points.len() - mesh.rim;
        assert!((2_000..VERTICES_MAX).contains(&inner), "{inner} new vertices");
    }

    /// A round rim of which each third corner is next to no way from the two beside it.
    fn crowded(groups: u32) -> (PatchMesh, Vec<u32>) {
        let corner = |i: u32| {
            let turn = f64::from(i / 3) + 0.01 * f64::from(i % 3);
            let turn = turn * std::f64::consts::TAU / f64::from(groups);
            DVec3::new(turn.cos(), turn.sin(), 0.0)
        };
        let n = 3 * groups;
        let triangles = (1..n - 1).map(|i| [0, i, i + 1]).collect();
        let mesh = PatchMesh::new((0..n).map(corner).collect(), triangles).unwrap();
        (mesh, (0..n).map(|i| (i + 1) % n).collect())
    }

    #[test]
    fn a_rim_of_uneven_edges_gets_no_more_vertices_than_its_corners_allow() {
        let inner = |vertices_max: Option<usize>| {
            let (mut mesh, next) = crowded(25);
            let mut lengths = Lengths::of_rim(&mesh, &next);
            lengths.vertices_max = vertices_max.unwrap_or(lengths.vertices_max);
            assert!(refine(&mut mesh, &mut lengths, &|_, _| true, &Budget::unlimited()).unwrap());
            assert_eq!(mesh.check(), Vec::<String>::new());
            mesh.points.len() - mesh.rim
        };
        let (free, bounded) = (inner(Some(VERTICES_MAX)), inner(None));
        assert!(free > 32 * 75, "{free} new vertices");
        assert!((50..=32 * 75).contains(&bounded), "{bounded} new vertices");
    }

    #[test]
    fn a_patch_that_would_get_too_many_vertices_when_it_is_divided_again_stays_as_it_is() {
        let (mut mesh, next) = fan(48);
        let mut lengths = Lengths::of_rim(&mesh, &next);
        refine(&mut mesh, &mut lengths, &|_, _| true, &Budget::unlimited()).unwrap();
        let before = mesh.triangles.clone();
        for v in mesh.rim..mesh.points.len() {
            mesh.points[v].z = 100.0 * f64::from(v as u32 % 2);
        }
        assert!(!refine(&mut mesh, &mut lengths, &|_, _| true, &Budget::unlimited()).unwrap());
        assert_eq!((&mesh.triangles, lengths.at.len()), (&before, mesh.points.len()));
    }
}
