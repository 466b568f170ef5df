//! Triangulations of loops that are too long for a search of all of them: any first one, then made to bend less.
//!
//! A loop that does not cross itself as seen along its normal is triangulated in that view. Any other is divided: some
//! corners of it, evenly spread, are triangulated in the best way, and then each chain between two of them. Work in
//! proportion to the corners, where the search is cubic. Both are then improved edge by edge, by the weight that the search has.
//! What bends around several sides of a part often crosses itself when it is divided; some such loops may be searched.

use super::caps::turn_caps;
use super::minimal::{self, CORNERS_MAX, LONG_CORNERS_MAX};
use super::patch::PatchMesh;
use super::planar;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{DVec3, triangle_area};
use crate::mesh::prev_corner;

/// Corners that a loop is divided at.
const DIVISIONS: usize = 64;
/// Turns for each edge, at most.
const TURNS_PER_EDGE: usize = 4;
/// Weighings that searches of long loops may take each time the patches of a file are tried.
const WEIGHINGS_MAX: u64 = 1 << 26;

/// Of loops with so many corners, those of which all triangulations may be searched: the first, as far as the work allows.
pub(super) fn searched(corners: impl Iterator<Item = usize>) -> impl Iterator<Item = bool> {
    let mut left = WEIGHINGS_MAX;
    corners.map(move |n| {
        let weighings = (n as u64).pow(3) / 6;
        let is_searched = (CORNERS_MAX + 1..=LONG_CORNERS_MAX).contains(&n) && weighings <= left;
        left -= if is_searched { weighings } else { 0 };
        is_searched
    })
}

/// Triangles of the loop through `points`, in its direction; `None` when there are none. `normal` is the direction that
/// it is seen along; `rim_normals` and `is_free` are as in [`minimal::triangulate`]. `is_searched`: all triangulations of a
/// loop that crosses itself in that view are searched, if it is not too long for that.
pub(super) fn triangulate(
    points: &[DVec3],
    rim_normals: &[DVec3],
    normal: DVec3,
    is_searched: bool,
    is_free: impl Fn(usize, usize) -> bool,
    budget: &Budget,
) -> Result<Option<Vec<[usize; 3]>>, Stopped> {
    let seen = planar::triangulate(&[points.to_vec()], normal);
    if seen.is_none()
        && is_searched
        && let Some(found) = minimal::triangulate(points, rim_normals, &is_free, budget)?
    {
        return Ok(Some(found));
    }
    let first = match seen {
        Some(triangles) => Some(triangles),
        None => divided(points, rim_normals, &is_free, budget)?,
    };
    let Some(first) = first else { return Ok(None) };
    let triangles = first.iter().map(|t| t.map(|i| i as u32)).collect();
    let Some(mut mesh) = PatchMesh::new(points.to_vec(), triangles) else { return Ok(Some(first)) };
    turn_caps(&mut mesh, &|a, b| is_free(a as usize, b as usize), budget)?;
    improve(&mut mesh, rim_normals, is_free, budget)?;
    Ok(Some(mesh.triangles.iter().map(|t| t.map(|v| v as usize)).collect()))
}

/// Triangulates chosen corners, then each chain between two of them with the normal of the triangle beyond its chord.
fn divided(
    points: &[DVec3],
    rim_normals: &[DVec3],
    is_free: &impl Fn(usize, usize) -> bool,
    budget: &Budget,
) -> Result<Option<Vec<[usize; 3]>>, Stopped> {
    let mut triangles = Vec::with_capacity(points.len());
    // Corners of a polygon, and the normal beyond its last side.
    let mut open: Vec<(Vec<usize>, DVec3)> =
        vec![((0..points.len()).collect(), rim_normals[points.len() - 1])];
    while let Some((corners, closing)) = open.pop() {
        budget.spend(corners.len() as u64 / 16 + 1)?;
        let n = corners.len();
        let chosen: Vec<usize> = match n <= CORNERS_MAX {
            true => (0..n).collect(),
            false => (0..DIVISIONS).map(|i| i * n / DIVISIONS).chain([n - 1]).collect(),
        };
        let at: Vec<DVec3> = chosen.iter().map(|&i| points[corners[i]]).collect();
        let mut normals: Vec<DVec3> = chosen
            .windows(2)
            .map(|side| {
                let sum: DVec3 = (side[0]..side[1]).map(|i| rim_normals[corners[i]]).sum();
                sum.normalize_or_zero()
            })
            .collect();
        normals.push(closing);
        let may = |i: usize, k: usize| is_free(corners[chosen[i]], corners[chosen[k]]);
        let Some(own) = minimal::with_least_caps(&at, &normals, may, budget)? else { return Ok(None) };
        for t in &own.triangles {
            let [a, b, c] = t.map(|i| at[i]);
            let facing = (b - a).cross(c - a).normalize_or_zero();
            for (i, k) in [(t[0], t[1]), (t[1], t[2])] {
                let is_chain = k == i + 1 && chosen[k] - chosen[i] > 1;
                if is_chain {
                    if !may(i, k) {
                        return Ok(None);
                    }
                    open.push((corners[chosen[i]..=chosen[k]].to_vec(), facing));
                }
            }
            triangles.push(t.map(|i| corners[chosen[i]]));
        }
    }
    Ok(Some(triangles))
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
    fn a_divided_loop_has_each_side_once() {
        for n in [129, 200, 4_321, 10_000] {
            let (points, normals) = (ring(n), vec![DVec3::Z; n]);
            let budget = Budget::unlimited();
            let triangles = divided(&points, &normals, &|_, _| true, &budget).unwrap().unwrap();
            assert!(is_disk(n, &triangles), "{n} corners");
            let best =
                triangulate(&points, &normals, DVec3::Z, false, |_, _| true, &budget).unwrap().unwrap();
            assert!(is_disk(n, &best), "{n} corners");
        }
    }

    #[test]
    fn the_first_long_loops_are_searched_until_the_work_is_spent() {
        let corners = [3, CORNERS_MAX, CORNERS_MAX + 1, LONG_CORNERS_MAX + 1];
        assert_eq!(searched(corners.into_iter()).collect::<Vec<_>>(), [false, false, true, false]);
        let many = searched(std::iter::repeat_n(LONG_CORNERS_MAX, 100)).filter(|&is| is).count() as u64;
        assert_eq!(many, WEIGHINGS_MAX / ((LONG_CORNERS_MAX as u64).pow(3) / 6));
    }

    #[test]
    fn a_long_loop_that_can_be_searched_is_nearly_as_good_as_the_best() {
        let (points, normals) = (ring(CORNERS_MAX), vec![DVec3::Z; CORNERS_MAX]);
        let budget = Budget::unlimited();
        let area = |triangles: &[[usize; 3]]| {
            triangles.iter().map(|t| triangle_area(t.map(|i| points[i]))).sum::<f64>()
        };
        let best = minimal::triangulate(&points, &normals, |_, _| true, &budget).unwrap().unwrap();
        let found = triangulate(&points, &normals, DVec3::Z, false, |_, _| true, &budget).unwrap().unwrap();
        assert!(area(&found) < 1.05 * area(&best), "{} {}", area(&found), area(&best));
    }
}
