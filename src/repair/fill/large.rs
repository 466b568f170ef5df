//! Triangulations of loops that are too long for a search of all of them.
//!
//! A loop that does not cross itself as seen along its normal is triangulated in that view, and edges are turned by the
//! weight that the search has. Of any other, as one that bends around several sides of a part, the notches are closed, and
//! what is left is searched from coarse to fine: few of its corners, evenly spread, are triangulated in the best way, and then
//! twice as many, by chords near those of the coarser triangulation only. Work grows with the corners, where the search of
//! all chords is cubic. Chords that go through triangles are barred and the search is repeated.

use super::caps::turn_caps;
use super::chords::{All, Chords, Near};
use super::minimal::{self, CORNERS_MAX, Least};
use super::notches::{Smoothed, close_notches};
use super::patch::PatchMesh;
use super::planar;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{DVec3, triangle_area};
use crate::mesh::prev_corner;
use crate::spatial::{Bvh, Coincident, Search, coincident_f64, self_contacts};
use rustc_hash::FxHashSet;

/// Turns for each edge, at most.
const TURNS_PER_EDGE: usize = 4;

/// Searches for a triangulation that does not meet itself, at most, by each measure and each time that corners are added.
const SEARCHES: usize = 4;
/// Pairs of triangles that meet whose chords are barred before the next search, at most.
const CONTACTS_MAX: usize = 4096;

/// How many corners the ends of a chord may be away from those of an edge of the coarser triangulation, for a loop of so many
/// corners. Where loops are very long there is less choice, so that the work stays in bounds.
fn reach(corners: usize) -> usize {
    match corners {
        0..=2_048 => 3,
        2_049..=16_384 => 2,
        _ => 1,
    }
}

/// Triangles of the loop through `points`, in its direction; `None` when there are none. `normal` is the direction that
/// it is seen along; `rim_normals` and `is_free` are as in [`minimal::triangulate`].
pub(super) fn triangulate(
    points: &[DVec3],
    rim_normals: &[DVec3],
    normal: DVec3,
    is_free: impl Fn(usize, usize) -> bool,
    budget: &Budget,
) -> Result<Option<Vec<[usize; 3]>>, Stopped> {
    let is_sound = |triangles: &Vec<[usize; 3]>| {
        let mut edges = triangles.iter().flat_map(edges_of);
        edges.all(|[i, k]| !is_chord([i, k], points.len()) || is_free(i, k))
    };
    let seen = planar::triangulate(&[points.to_vec()], normal).filter(is_sound);
    let is_seen = seen.is_some();
    let first = match seen {
        Some(triangles) => Some(triangles),
        None => of_smoothed(points, rim_normals, &is_free, budget)?,
    };
    let Some(first) = first else { return Ok(None) };
    let triangles = first.iter().map(|t| t.map(|i| i as u32)).collect();
    let Some(mut mesh) = PatchMesh::new(points.to_vec(), triangles) else { return Ok(Some(first)) };
    turn_caps(&mut mesh, &|a, b| is_free(a as usize, b as usize), budget)?;
    if is_seen {
        improve(&mut mesh, rim_normals, is_free, budget)?;
    }
    Ok(Some(mesh.triangles.iter().map(|t| t.map(|v| v as usize)).collect()))
}

/// Closes the notches of a loop and triangulates the rest.
fn of_smoothed(
    points: &[DVec3],
    rim_normals: &[DVec3],
    is_free: &impl Fn(usize, usize) -> bool,
    budget: &Budget,
) -> Result<Option<Vec<[usize; 3]>>, Stopped> {
    let Smoothed { mut triangles, corners, rim_normals } =
        close_notches(points, rim_normals, is_free, budget)?;
    let left: Vec<DVec3> = corners.iter().map(|&i| points[i]).collect();
    let may = |i: usize, k: usize| is_free(corners[i], corners[k]);
    let Some(rest) = coarse_to_fine(&left, &rim_normals, &may, budget)? else { return Ok(None) };
    triangles.extend(rest.into_iter().map(|t| t.map(|i| corners[i])));
    Ok(Some(triangles))
}

/// Triangulates a loop by ever more of its corners, each time by chords near the edges of the triangulation before.
fn coarse_to_fine(
    points: &[DVec3],
    rim_normals: &[DVec3],
    is_free: &impl Fn(usize, usize) -> bool,
    budget: &Budget,
) -> Result<Option<Vec<[usize; 3]>>, Stopped> {
    let n = points.len();
    let mut step = 1;
    while n.div_ceil(step) > CORNERS_MAX {
        step *= 2;
    }
    let mut coarser: Option<Vec<[usize; 3]>> = None;
    while step > 0 {
        let chosen: Vec<usize> = (0..n).step_by(step).collect();
        let at: Vec<DVec3> = chosen.iter().map(|&i| points[i]).collect();
        let normals: Vec<DVec3> = chosen
            .iter()
            .map(|&from| rim_normals[from..n.min(from + step)].iter().sum::<DVec3>().normalize_or_zero())
            .collect();
        // The rim between two corners that are left out for now is no side of the loop yet, so nothing is in its way.
        let may = |i: usize, k: usize| is_free(chosen[i], chosen[k]);
        let corners = LoopCorners { points: &at, rim_normals: &normals };
        let found = match &coarser {
            None => without_crossings(corners, &All { corners: chosen.len() }, may, budget)?,
            Some(triangles) => {
                let edges: Vec<_> =
                    triangles.iter().flat_map(edges_of).map(|edge| edge.map(|i| 2 * i)).collect();
                let near = Near::new(chosen.len(), &edges, reach(n), budget)?;
                budget.spend(edges.len() as u64)?;
                without_crossings(corners, &near, may, budget)?
            }
        };
        let Some(found) = found else { return Ok(None) };
        coarser = Some(found);
        step /= 2;
    }
    Ok(coarser)
}

/// The corners of a loop, and the normal of the surface beyond each side.
#[derive(Clone, Copy)]
struct LoopCorners<'a> {
    points: &'a [DVec3],
    rim_normals: &'a [DVec3],
}

/// The best triangulation that does not meet itself: chords that go through triangles are barred, and it is searched again.
/// Of several that meet themselves the one that does so least.
fn without_crossings(
    corners: LoopCorners<'_>,
    chords: &impl Chords,
    is_free: impl Fn(usize, usize) -> bool,
    budget: &Budget,
) -> Result<Option<Vec<[usize; 3]>>, Stopped> {
    let LoopCorners { points, rim_normals } = corners;
    let mut barred: FxHashSet<[usize; 2]> = FxHashSet::default();
    let mut best: Option<(u64, Vec<[usize; 3]>)> = None;
    for least in [Least::Bend, Least::Area].into_iter().flat_map(|least| [least; SEARCHES]) {
        let may = |i: usize, k: usize| is_free(i, k) && !barred.contains(&[i, k]);
        let Some(found) = minimal::with_least_caps(points, rim_normals, chords, least, may, budget)? else {
            break;
        };
        let SelfMeeting { pairs, piercing } = meeting(points, &found.triangles, budget)?;
        if best.as_ref().is_none_or(|&(least, _)| pairs < least) {
            best = Some((pairs, found.triangles));
        }
        barred.extend(piercing);
        if pairs == 0 {
            break;
        }
    }
    Ok(best.map(|(_, triangles)| triangles))
}

/// How a triangulation meets itself.
struct SelfMeeting {
    /// Pairs of triangles.
    pairs: u64,
    /// The chords that go through a triangle.
    piercing: Vec<[usize; 2]>,
}

fn meeting(points: &[DVec3], triangles: &[[usize; 3]], budget: &Budget) -> Result<SelfMeeting, Stopped> {
    // A loop may pass a place several times.
    let Coincident { group, first } = coincident_f64(points, budget)?;
    let places: Vec<DVec3> = first.iter().map(|&i| points[i as usize]).collect();
    let by_place: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(|i| group[i])).collect();
    let bvh = Bvh::build(&places, &by_place, None, budget)?;
    let search = Search::All { keep: CONTACTS_MAX };
    let contacts = self_contacts(&places, &by_place, &bvh, None, search, budget)?;
    let mut piercing = Vec::new();
    for contact in &contacts.list {
        let pair = [contact.a, contact.b].map(|t| triangles[t as usize]);
        let before = piercing.len();
        for [one, other] in [pair, [pair[1], pair[0]]] {
            let through = edges_of(&one).into_iter().filter(|edge| is_chord(*edge, points.len()));
            piercing
                .extend(through.filter(|edge| pierces(edge.map(|i| points[i]), other.map(|i| points[i]))));
        }
        if piercing.len() == before {
            let length = |edge: &[usize; 2]| points[edge[0]].distance(points[edge[1]]);
            let all = pair.iter().flat_map(edges_of).filter(|edge| is_chord(*edge, points.len()));
            piercing.extend(all.max_by(|a, b| length(a).total_cmp(&length(b))));
        }
    }
    Ok(SelfMeeting { pairs: contacts.count, piercing })
}

/// The edges of a triangle, each from its first to its second corner.
fn edges_of(&[a, b, c]: &[usize; 3]) -> [[usize; 2]; 3] {
    [[a, b], [b, c], [a, c]].map(|[a, b]| [a.min(b), a.max(b)])
}

/// True for an edge that is no side of a loop of `n` corners.
fn is_chord([a, b]: [usize; 2], n: usize) -> bool {
    b - a != 1 && b - a != n - 1
}

/// True when the segment passes through the inside of the triangle; what touches it may count or not.
fn pierces([p, q]: [DVec3; 2], [a, b, c]: [DVec3; 3]) -> bool {
    let volume = |d: DVec3, e: DVec3, f: DVec3, g: DVec3| (e - d).cross(f - d).dot(g - d);
    let is_between = volume(a, b, c, p) * volume(a, b, c, q) < 0.0;
    let sides = [volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)];
    is_between && (sides.iter().all(|&v| v > 0.0) || sides.iter().all(|&v| v < 0.0))
}

/// Turns edges while that lessens the worst bend around, or the area.
fn improve(
    mesh: &mut PatchMesh,
    rim_normals: &[DVec3],
    is_free: impl Fn(usize, usize) -> bool,
    budget: &Budget,
) -> Result<(), Stopped> {
    let mut open: Vec<u32> = (0..3 * mesh.triangles.len() as u32).rev().collect();
    let mut left = TURNS_PER_EDGE * open.len();
    let mut looked = 0usize;
    while let Some(h) = open.pop() {
        looked += 1;
        if looked.is_multiple_of(CHECK_EVERY) {
            budget.spend(CHECK_EVERY as u64)?;
        }
        if left > 0
            && is_better_turned(mesh, h, rim_normals, &is_free)
            && let Some(around) = mesh.flip(h)
        {
            left -= 1;
            open.extend(around);
        }
    }
    Ok(())
}

fn is_better_turned(
    mesh: &PatchMesh,
    h: u32,
    rim_normals: &[DVec3],
    is_free: &impl Fn(usize, usize) -> bool,
) -> bool {
    let Some(g) = mesh.twin(h) else { return false };
    let ([a, b], c, d) = (mesh.ends(h), mesh.apex(h), mesh.apex(g));
    if c == d || mesh.has_edge(c, d) || !is_free(c as usize, d as usize) {
        return false;
    }
    let normal = |t: [u32; 3]| {
        let [p, q, r] = t.map(|v| mesh.point(v));
        (q - p).cross(r - p).normalize_or_zero()
    };
    let area = |t: [u32; 3]| triangle_area(t.map(|v| mesh.point(v)));
    let beyond = |h: u32| match mesh.twin(h) {
        Some(twin) => normal(mesh.triangles[(twin / 3) as usize]),
        // A half-edge of the rim starts at the corner whose side it is.
        None => rim_normals[mesh.ends(h)[0] as usize],
    };
    let next = crate::mesh::next_corner;
    let [bc, ca, ad, db] = [next(h), prev_corner(h), next(g), prev_corner(g)].map(beyond);
    let (was, is) = ([[a, b, c], [b, a, d]], [[c, a, d], [d, b, c]]);
    if is.iter().any(|t| area(*t) == 0.0) {
        return false;
    }
    let bend = minimal::bend;
    let ([p, q], [r, s]) = (was.map(normal), is.map(normal));
    let before = [(p, q), (p, bc), (p, ca), (q, ad), (q, db)];
    let after = [(r, s), (r, ca), (r, ad), (s, db), (s, bc)];
    let worst = |pairs: [(DVec3, DVec3); 5]| pairs.iter().map(|&(m, n)| bend(m, n)).fold(0.0, f64::max);
    let areas = |pair: [[u32; 3]; 2]| pair.iter().map(|t| area(*t)).sum::<f64>();
    let (was_bent, is_bent) = (worst(before), worst(after));
    // Less by more than rounding, so that no edge turns back and forth.
    is_bent < was_bent - 1e-9 || (is_bent < was_bent + 1e-9 && areas(is) < areas(was) * (1.0 - 1e-9))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(n: usize) -> Vec<DVec3> {
        let corner = |i: usize| {
            let turn = i as f64 * std::f64::consts::TAU / n as f64;
            DVec3::new(turn.cos(), turn.sin(), 0.2 * (3.0 * turn).sin())
        };
        (0..n).map(corner).collect()
    }

    fn is_disk(n: usize, triangles: &[[usize; 3]]) -> bool {
        let triangles: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(|i| i as u32)).collect();
        let sides = (0..n).all(|i| {
            let has =
                |t: &&[u32; 3]| (0..3).any(|c| (t[c], t[(c + 1) % 3]) == (i as u32, ((i + 1) % n) as u32));
            triangles.iter().filter(has).count() == 1
        });
        sides && triangles.len() + 2 == n && PatchMesh::new(vec![DVec3::ZERO; n], triangles).is_some()
    }

    #[test]
    fn a_loop_searched_from_coarse_to_fine_has_each_side_once() {
        for n in [129, 200, 4_321, 10_000, 20_000] {
            let (points, normals) = (ring(n), vec![DVec3::Z; n]);
            let budget = Budget::unlimited();
            let triangles = coarse_to_fine(&points, &normals, &|_, _| true, &budget).unwrap().unwrap();
            assert!(is_disk(n, &triangles), "{n} corners");
            let best = triangulate(&points, &normals, DVec3::Z, |_, _| true, &budget).unwrap().unwrap();
            assert!(is_disk(n, &best), "{n} corners");
        }
    }

    #[test]
    fn a_long_loop_that_can_be_searched_is_nearly_as_good_as_the_best() {
        let (points, normals) = (ring(CORNERS_MAX), vec![DVec3::Z; CORNERS_MAX]);
        let budget = Budget::unlimited();
        let area = |triangles: &[[usize; 3]]| {
            triangles.iter().map(|t| triangle_area(t.map(|i| points[i]))).sum::<f64>()
        };
        let best = minimal::triangulate(&points, &normals, |_, _| true, &budget).unwrap().unwrap();
        let found = triangulate(&points, &normals, DVec3::Z, |_, _| true, &budget).unwrap().unwrap();
        assert!(area(&found) < 1.05 * area(&best), "{} {}", area(&found), area(&best));
    }
}
