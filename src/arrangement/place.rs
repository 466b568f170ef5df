//! The triangles of a boundary with their new points on a lattice, and what that breaks mended nearby.
//!
//! Rounding moves a new point by at most half a pitch in each coordinate, which can push it through a triangle that is nearer. Where
//! triangles meet afterwards, each new point of theirs goes to the one of the lattice points around it at which its triangles
//! meet the fewest others. What is left is counted; the result is for the certificate to judge. Triangles that rounding does not
//! move meet nowhere in an arrangement, so that only those that it moves are looked at, and what is near them.

use super::error::ArrangementError;
use super::{Arrangement, MergedBoundary};
use crate::budget::{Budget, CHECK_EVERY};
use crate::geom::{Aabb, DVec3, Shared, ThreePointPlane, are_collinear, contact};
use crate::par;
use crate::spatial::{Bvh, Search, self_contacts};

/// A boundary in numbers of a file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PlacedBoundary {
    /// The position of each point of the arrangement; those that no triangle uses may be anywhere.
    pub positions: Vec<DVec3>,
    /// Corners, as points: of several at one position the first.
    pub triangles: Vec<[u32; 3]>,
    /// The triangle of the input that each is a part of.
    pub sources: Vec<u32>,
    /// Largest distance of a new point from where it is exactly.
    pub move_max: f64,
    /// Pairs of triangles that still meet, and triangles without an area.
    pub conflicts: u64,
}

/// Rounds in which conflicts are looked for and mended, at most.
const ROUNDS_MAX: usize = 5;

/// Conflicts beyond which no mending is tried.
const CONFLICTS_MAX: usize = 1 << 14;

/// Triangles near those of a star, beyond which its point stays where it is.
const NEIGHBORS_MAX: usize = 1 << 20;

/// Pitches that a point may be from where it is exactly, in each coordinate, and that two of them may be closer by.
const REACH: f64 = 4.0;

/// Puts the new points of `merged` on the lattice of this pitch, which must be a power of two.
///
/// # Errors
/// When the budget stops the run.
pub fn place(
    arrangement: &Arrangement,
    merged: MergedBoundary,
    pitch: f64,
    budget: &Budget,
) -> Result<PlacedBoundary, ArrangementError> {
    let first_new = arrangement.positions.len() as u32;
    let mut used: Vec<u32> =
        merged.triangles.as_flattened().iter().copied().filter(|&p| p >= first_new).collect();
    used.sort_unstable();
    used.dedup();
    let mut positions = Vec::with_capacity(arrangement.point_count());
    positions.extend_from_slice(&arrangement.positions);
    positions.resize(arrangement.point_count(), DVec3::ZERO);
    for &p in &used {
        positions[p as usize] = nearest(arrangement.position(p), pitch);
    }
    let mut placing = Placing {
        placed: PlacedBoundary {
            positions,
            triangles: merged.triangles,
            sources: merged.sources,
            ..PlacedBoundary::default()
        },
        is_near: Vec::new(),
        exact: &arrangement.new_positions,
        first_new,
        pitch,
        budget,
    };
    placing.is_near = placing.near(|p| p >= first_new)?;
    placing.weld(&used);
    let mut best = u64::MAX;
    for round in 0..=ROUNDS_MAX {
        let (conflicts, points) = placing.conflicts()?;
        placing.placed.conflicts = conflicts;
        if conflicts == 0 || conflicts >= best || points.is_empty() || round == ROUNDS_MAX {
            break;
        }
        best = conflicts;
        placing.mend(&points)?;
        // All others meet nowhere, and have not moved.
        placing.is_near = placing.near(|p| points.binary_search(&p).is_ok())?;
        placing.weld(&used);
    }
    let mut placed = placing.placed;
    for &p in &used {
        let moved = placed.positions[p as usize].distance(placing.exact[(p - first_new) as usize]);
        placed.move_max = placed.move_max.max(moved);
    }
    Ok(placed)
}

fn nearest(place: DVec3, pitch: f64) -> DVec3 {
    (place / pitch).round() * pitch + DVec3::ZERO
}

struct Placing<'b> {
    placed: PlacedBoundary,
    /// For each triangle, whether it is or may come to be on or through one that may meet others.
    is_near: Vec<bool>,
    /// Where the new points are, to the last place.
    exact: &'b [DVec3],
    first_new: u32,
    pitch: f64,
    budget: &'b Budget,
}

impl Placing<'_> {
    fn corners(&self, t: u32) -> [DVec3; 3] {
        self.placed.triangles[t as usize].map(|p| self.placed.positions[p as usize])
    }

    /// The triangles with such a point, wherever mending may put it, and those whose boxes come near theirs.
    fn near(&self, is_one: impl Fn(u32) -> bool) -> Result<Vec<bool>, ArrangementError> {
        let triangles = &self.placed.triangles;
        let has_one = |t: &u32| triangles[*t as usize].iter().any(|&p| is_one(p));
        let with_one: Vec<u32> = (0..triangles.len() as u32).filter(has_one).collect();
        let bvh = Bvh::build(&self.placed.positions, triangles, Some(&with_one), self.budget)?;
        let parts = par::try_map_ranges(triangles.len(), CHECK_EVERY, |range| {
            let is_near = |t: usize| {
                let bounds = self.with_margin(Aabb::of(self.corners(t as u32)), 2.0 * REACH);
                bvh.any_in_box(bounds, self.budget, |_| true)
            };
            self.budget.spend(range.len() as u64)?;
            range.map(is_near).collect::<Result<Vec<bool>, _>>()
        })?;
        Ok(parts.into_iter().flatten().collect())
    }

    /// A box that is larger by so many pitches on each side.
    fn with_margin(&self, bounds: Aabb, pitches: f64) -> Aabb {
        let margin = DVec3::splat(pitches * self.pitch);
        Aabb { min: bounds.min - margin, max: bounds.max + margin }
    }

    /// The triangles that may meet others, ascending.
    fn may_meet(&self) -> impl Iterator<Item = u32> {
        (0..).zip(&self.is_near).filter_map(|(t, &is_near)| is_near.then_some(t))
    }

    /// Makes new points one with the first point at their position, and drops the triangles that this leaves without three
    /// corners, and pairs of them that lie on each other the opposite way.
    fn weld(&mut self, used: &[u32]) {
        let key = |p: DVec3| (p + DVec3::ZERO).to_array().map(f64::to_bits);
        let positions = &self.placed.positions;
        let corners = |t: u32| self.placed.triangles[t as usize];
        let mut points: Vec<u32> = self.may_meet().flat_map(corners).collect();
        points.sort_unstable();
        points.dedup();
        let mut order: Vec<([u64; 3], u32)> =
            points.into_iter().map(|p| (key(positions[p as usize]), p)).collect();
        order.sort_unstable();
        let mut first: Vec<u32> = (0..positions.len() as u32).collect();
        let mut is_any = false;
        for same in order.chunk_by(|a, b| a.0 == b.0) {
            for &(_, p) in &same[1..] {
                first[p as usize] = same[0].1;
                is_any |= used.binary_search(&p).is_ok();
            }
        }
        if !is_any {
            return;
        }
        let near: Vec<u32> = self.may_meet().collect();
        let PlacedBoundary { triangles, sources, .. } = &mut self.placed;
        let mut is_kept = vec![true; triangles.len()];
        for &t in &near {
            let corners = &mut triangles[t as usize];
            *corners = corners.map(|p| first[p as usize]);
            let [a, b, c] = *corners;
            is_kept[t as usize] = a != b && b != c && c != a;
        }
        // Corners, ascending, and whether the triangle runs through them the other way.
        let mut by_corners: Vec<([u32; 3], bool, u32)> = near
            .into_iter()
            .filter(|&t| is_kept[t as usize])
            .map(|t| {
                let [a, b, c] = triangles[t as usize];
                let mut corners = [a, b, c];
                corners.sort_unstable();
                (corners, ![[a, b, c], [b, c, a], [c, a, b]].contains(&corners), t)
            })
            .collect();
        by_corners.sort_unstable();
        for same in by_corners.chunk_by(|a, b| a.0 == b.0) {
            let (ahead, against) = same.split_at(same.partition_point(|&(_, is_turned, _)| !is_turned));
            for (&(.., t), &(.., opposite)) in ahead.iter().zip(against) {
                is_kept[t as usize] = false;
                is_kept[opposite as usize] = false;
            }
        }
        let mut marks = is_kept.iter();
        triangles.retain(|_| marks.next() == Some(&true));
        let mut marks = is_kept.iter();
        sources.retain(|_| marks.next() == Some(&true));
        let mut marks = is_kept.iter();
        self.is_near.retain(|_| marks.next() == Some(&true));
    }

    /// How many pairs of triangles meet or have no area, and the new points of these, ascending.
    fn conflicts(&self) -> Result<(u64, Vec<u32>), ArrangementError> {
        let triangles = &self.placed.triangles;
        let has_area = |&t: &u32| {
            let [a, b, c] = self.corners(t);
            !are_collinear(a, b, c)
        };
        self.budget.spend(triangles.len() as u64)?;
        let (sound, flat): (Vec<u32>, Vec<u32>) = self.may_meet().partition(has_area);
        let bvh = Bvh::build(&self.placed.positions, triangles, Some(&sound), self.budget)?;
        let search = Search::All { keep: CONFLICTS_MAX };
        let found = self_contacts(&self.placed.positions, triangles, &bvh, None, search, self.budget)?;
        let count = found.count + flat.len() as u64;
        if count > CONFLICTS_MAX as u64 {
            return Ok((count, Vec::new()));
        }
        let mut points: Vec<u32> = found
            .list
            .iter()
            .flat_map(|pair| [pair.a, pair.b])
            .chain(flat)
            .flat_map(|t| triangles[t as usize])
            .filter(|&p| p >= self.first_new)
            .collect();
        points.sort_unstable();
        points.dedup();
        Ok((count, points))
    }

    /// Moves each of `points` to where its triangles meet the fewest others.
    fn mend(&mut self, points: &[u32]) -> Result<(), ArrangementError> {
        let mut stars: Vec<(u32, u32)> = Vec::new();
        let near: Vec<u32> = self.may_meet().collect();
        for &t in &near {
            let corners = self.placed.triangles[t as usize];
            stars.extend(corners.into_iter().filter(|p| points.binary_search(p).is_ok()).map(|p| (p, t)));
        }
        stars.sort_unstable();
        let bvh = Bvh::build(&self.placed.positions, &self.placed.triangles, Some(&near), self.budget)?;
        for star in stars.chunk_by(|a, b| a.0 == b.0) {
            let point = star[0].0;
            let places = self.around(point);
            let star: Vec<u32> = star.iter().map(|&(_, t)| t).collect();
            let Some(pairs) = self.pairs(point, &star, &places, &bvh)? else { continue };
            let mut best = (u64::MAX, self.placed.positions[point as usize]);
            for place in places {
                self.placed.positions[point as usize] = place;
                let meets = self.meets(&star, &pairs, best.0)?;
                if meets < best.0 {
                    best = (meets, place);
                }
                if meets == 0 {
                    break;
                }
            }
            self.placed.positions[point as usize] = best.1;
        }
        Ok(())
    }

    /// The lattice points around where a point is exactly, nearest first.
    fn around(&self, point: u32) -> Vec<DVec3> {
        let exact = self.exact[(point - self.first_new) as usize];
        let middle = nearest(exact, self.pitch);
        let step = |i: usize| (i % 3) as f64 - 1.0;
        let mut places: Vec<DVec3> =
            (0..27).map(|i| middle + DVec3::new(step(i), step(i / 3), step(i / 9)) * self.pitch).collect();
        places.sort_by(|a, b| a.distance_squared(exact).total_cmp(&b.distance_squared(exact)));
        places
    }

    /// Which triangles those of the `star` of a point may meet with it at any of these `places`; `None`: too many.
    fn pairs(
        &self,
        point: u32,
        star: &[u32],
        places: &[DVec3],
        bvh: &Bvh,
    ) -> Result<Option<Vec<StarPair>>, ArrangementError> {
        let mut pairs = Vec::new();
        for (n, &t) in (0..).zip(star) {
            let names = self.placed.triangles[t as usize];
            let stay = names.into_iter().filter(|&p| p != point).map(|p| self.placed.positions[p as usize]);
            let bounds = Aabb::of(stay.chain(places.iter().copied()));
            // Points may have moved by two pitches in each coordinate since the tree was built.
            let query = self.with_margin(bounds, REACH);
            // From where it is with its point at one of the places.
            let reach = REACH * self.pitch;
            let corners =
                names.map(|p| if p == point { places[0] } else { self.placed.positions[p as usize] });
            let mut seen = 0;
            bvh.visit_box(query, self.budget, |other| {
                seen += 1;
                if pairs.len() == NEIGHBORS_MAX || other == t {
                    return;
                }
                let moves = self.placed.triangles[other as usize].contains(&point);
                let others = self.corners(other);
                // One that moves may have an area at another place.
                if !moves
                    && (are_apart(corners, others, reach) || are_collinear(others[0], others[1], others[2]))
                {
                    return;
                }
                let shared = Shared::between(names, self.placed.triangles[other as usize]);
                pairs.push(StarPair { of_star: n, other, moves, shared });
            })?;
            self.budget.spend(1 + seen)?;
            if pairs.len() == NEIGHBORS_MAX {
                return Ok(None);
            }
        }
        Ok(Some(pairs))
    }

    /// How many of the `pairs` of a star meet beyond common vertices and edges, or `enough` and more; a triangle of it without an
    /// area counts for many.
    fn meets(&self, star: &[u32], pairs: &[StarPair], enough: u64) -> Result<u64, ArrangementError> {
        let (mut count, mut looks) = (0, 0);
        let mut pairs = pairs.chunk_by(|a, b| a.of_star == b.of_star).peekable();
        for (n, &t) in (0..).zip(star) {
            let near = pairs.next_if(|near| near[0].of_star == n).unwrap_or_default();
            let corners = self.corners(t);
            if are_collinear(corners[0], corners[1], corners[2]) {
                count += 1 << 20;
                continue;
            }
            let (bounds, plane) = (Aabb::of(corners), ThreePointPlane::through(corners));
            for pair in near {
                if count >= enough {
                    break;
                }
                looks += 1;
                let others = self.corners(pair.other);
                let [a, b, c] = others;
                if !bounds.meets(Aabb::of(others)) || pair.moves && are_collinear(a, b, c) {
                    continue;
                }
                let is_copy = matches!(pair.shared, Shared::Triangle);
                count += u64::from(is_copy || contact(&plane, [&a, &b, &c], pair.shared).is_some());
            }
        }
        self.budget.spend(star.len() as u64 + looks)?;
        Ok(count)
    }
}

/// Whether there is more than `gap` between two triangles along a normal of one of them or of an edge of each. Any direction
/// proves it, so rounded ones do.
fn are_apart(a: [DVec3; 3], b: [DVec3; 3], gap: f64) -> bool {
    let (a, b) = (a.map(|p| p - a[0]), b.map(|p| p - a[0]));
    let edges = |[p, q, r]: [DVec3; 3]| [q - p, r - q, p - r];
    let (of_a, of_b) = (edges(a), edges(b));
    let is_between = |axis: DVec3| {
        let span = |corners: [DVec3; 3]| {
            let [x, y, z] = corners.map(|p| p.dot(axis));
            [x.min(y).min(z), x.max(y).max(z)]
        };
        let ([low_a, high_a], [low_b, high_b]) = (span(a), span(b));
        (low_b - high_a).max(low_a - high_b) > gap * axis.length()
    };
    is_between(of_a[0].cross(of_a[1]))
        || is_between(of_b[0].cross(of_b[1]))
        || of_a.into_iter().any(|u| of_b.into_iter().any(|v| is_between(u.cross(v))))
}

/// A triangle of a star, and one near it.
struct StarPair {
    /// Which of the star.
    of_star: u32,
    other: u32,
    /// True when the other one is of the star too.
    moves: bool,
    /// What the first has in common with the other.
    shared: Shared,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_that_are_apart_are_so_from_each_place_within_the_gap() {
        let mut state = 7u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 20) / 256.0
        };
        let mut triangle = || [(); 3].map(|()| DVec3::new(random(), random(), random()));
        let (mut apart, mut near) = (0, 0);
        for _ in 0..4000 {
            let (a, b) = (triangle(), triangle());
            let contact = |a: [DVec3; 3]| {
                contact(&ThreePointPlane::through(a), b.each_ref(), Shared::Nothing).is_some()
            };
            let moved = |k: usize| {
                let step = DVec3::new((k % 3) as f64, (k / 3 % 3) as f64, (k / 9) as f64) - 1.0;
                [a[0] + step, a[1], a[2]]
            };
            let meets_anywhere = (0..27).any(|k| contact(moved(k)));
            assert!(!are_apart(a, b, 4.0) || !meets_anywhere, "{a} {b}", a = a[0], b = b[0]);
            apart += u32::from(are_apart(a, b, 4.0));
            near += u32::from(meets_anywhere);
        }
        assert!(apart > 500 && near > 500, "{apart} {near}");
    }
}
