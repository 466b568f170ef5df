//! Closes gaps between an arc and its chord where one surface lies over the gap: the lid of a cylinder whose wall has fewer sides.
//!
//! ```text
//!         m                 the rim of the lid goes from a over m to b, that of the wall straight from a to b;
//!      ·     ·              the lid covers what is between them, so that a patch there would lie on it
//!    a---------b
//! ```
//!
//! The surface that lies over the gap ends at the other one afterwards: where it is the one with the arc, triangles between arc and
//! chord go and vertices of the arc go to the chord, whose triangle is divided there; where it is the one with the chord, its triangle is
//! divided so that its rim goes over the vertices of the arc.

use super::{Changes, Draft, Effects, VertexBeside};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3, print_pitch};
use crate::mesh::{EdgeGroups, edge_of, triangle_of};
use crate::spatial::coincident_f64;
use rustc_hash::{FxHashMap, FxHashSet};

/// Sides of such a gap, at most.
const SIDES_MAX: usize = 64;
/// Height of an arc over its chord, at most, as a share of the chord: a little more than that of a sixth of a turn (0.134).
const HEIGHT_SHARE_MAX: f64 = 0.14;
/// Boundary edges that begin at a place, at most; where there are more, they do not say which belong together.
const LEAVING_MAX: usize = 16;
/// Bytes that a round takes for each triangle.
const BYTES_PER_TRIANGLE: u64 = 96;
/// Height of an arc, at least, as a share of the diagonal; lower ones are slits, which are filled.
const HEIGHT_MIN: f64 = 1e-4;
/// A surface lies over a gap when it looks the other way than a patch would, as the cosine of the angle (20 degrees).
const OVER_COS_MIN: f64 = 0.94;
/// Rounds: a triangle is changed once in each.
const ROUNDS_MAX: usize = 16;

/// What was done.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Closed {
    gaps: u64,
    vertices: u64,
    dropped: u64,
    divided: u64,
    move_max: f64,
}

/// Closes the gaps between arcs and chords over which a surface lies. Looks at places, so vertices need not be welded; triangles must
/// not be degenerate.
///
/// # Errors
/// When the budget stops the run.
pub fn close_chordal_gaps(draft: &mut Draft, budget: &Budget) -> Result<Changes, Stopped> {
    let mut closed = Closed::default();
    let _charge = budget.charge(draft.triangles.len() as u64 * BYTES_PER_TRIANGLE)?;
    for _ in 0..ROUNDS_MAX {
        let before = closed.gaps;
        Round::of(draft, budget)?.run(draft, &mut closed, budget)?;
        if closed.gaps == before {
            break;
        }
    }
    let Closed { gaps, vertices, dropped, divided, move_max } = closed;
    let counts = [
        ("gaps_closed", gaps),
        ("vertices_moved", vertices),
        ("triangles_dropped", dropped),
        ("triangles_split", divided),
    ];
    let effects = Effects { closed_chordal_gaps: gaps > 0, ..Effects::default() };
    Ok(Changes { move_max, ..Changes::counted(counts) }.with(effects))
}

/// A draft with one vertex at each place.
struct Round {
    places: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// The vertices of the draft at each place, ascending by place.
    copies: Vec<(u32, u32)>,
    groups: EdgeGroups,
    /// The half-edges of boundary edges.
    rim: Vec<u32>,
    /// The same by the places where they begin, ascending.
    leaving: Vec<(u32, u32)>,
    diagonal: f64,
    pitch: Option<f64>,
    /// The triangles at places of the boundary.
    stars: FxHashMap<u32, Vec<u32>>,
    /// Triangles that were changed.
    is_changed: FxHashSet<u32>,
    /// Triangles that go.
    goes: Vec<u32>,
}

/// A gap: an edge, and the places from its first end over the arc to its second.
struct Gap {
    chord: u32,
    arc: Vec<u32>,
    /// The half-edge of each side of the arc.
    sides: Vec<u32>,
}

impl Round {
    fn of(draft: &Draft, budget: &Budget) -> Result<Self, Stopped> {
        let at = coincident_f64(&draft.positions, budget)?;
        let places: Vec<DVec3> = at.first.iter().map(|&v| draft.positions[v as usize]).collect();
        let triangles: Vec<[u32; 3]> =
            draft.triangles.iter().map(|t| t.map(|v| at.group[v as usize])).collect();
        let groups = EdgeGroups::build(&triangles, places.len(), budget)?;
        let rim: Vec<u32> =
            groups.iter().filter_map(|group| <[u32; 1]>::try_from(group).ok()).map(|[h]| h).collect();
        let mut leaving: Vec<(u32, u32)> = rim.iter().map(|&h| (edge_of(&triangles, h)[0], h)).collect();
        leaving.sort_unstable();
        let mut stars: FxHashMap<u32, Vec<u32>> = leaving.iter().map(|&(v, _)| (v, Vec::new())).collect();
        budget.spend(triangles.len() as u64 / 4)?;
        if !stars.is_empty() {
            for (corners, t) in triangles.iter().zip(0u32..) {
                if (t as usize).is_multiple_of(CHECK_EVERY) {
                    budget.check()?;
                }
                corners.iter().for_each(|v| {
                    if let Some(star) = stars.get_mut(v) {
                        star.push(t);
                    }
                });
            }
        }
        let mut copies: Vec<(u32, u32)> = at.group.iter().copied().zip(0..).collect();
        copies.sort_unstable();
        let reach = places.iter().fold(0.0, |reach, p| p.abs().max_element().max(reach));
        Ok(Self {
            diagonal: Aabb::of(places.iter().copied()).diagonal(),
            pitch: print_pitch(reach),
            places,
            triangles,
            copies,
            groups,
            rim,
            leaving,
            stars,
            is_changed: FxHashSet::default(),
            goes: Vec::new(),
        })
    }

    fn run(mut self, draft: &mut Draft, closed: &mut Closed, budget: &Budget) -> Result<(), Stopped> {
        for gap in self.gaps(budget)? {
            budget.spend(gap.arc.len() as u64)?;
            let lies_over = self.lies_over(&gap);
            let is_closed = match lies_over {
                Some(LiesOver::Arc) => self.trim(gap, draft, closed),
                Some(LiesOver::Chord) => self.bend(&gap, draft, closed),
                None => false,
            };
            closed.gaps += u64::from(is_closed);
        }
        if !self.goes.is_empty() {
            let mut is_kept = vec![true; draft.triangles.len()];
            self.goes.iter().for_each(|&t| is_kept[t as usize] = false);
            draft.retain_triangles(&is_kept);
        }
        Ok(())
    }

    fn ends(&self, h: u32) -> [DVec3; 2] {
        edge_of(&self.triangles, h).map(|v| self.places[v as usize])
    }

    /// The gaps between boundary edges and what runs from one end of them to the other beside them.
    fn gaps(&self, budget: &Budget) -> Result<Vec<Gap>, Stopped> {
        let mut gaps = Vec::new();
        let mut is_used: FxHashSet<u32> = FxHashSet::default();
        // Of three triangles at an edge, one may lie over the gap as a whole.
        let three = self.groups.iter().filter(|group| group.len() == 3).flatten();
        for &chord in self.rim.iter().chain(three) {
            let [_, to] = edge_of(&self.triangles, chord);
            let leaving = self.leaving(to);
            if leaving.len() > LEAVING_MAX {
                continue;
            }
            budget.spend(1 + 4 * leaving.len() as u64)?;
            let found = leaving.iter().find_map(|&(_, first)| self.gap(chord, first));
            if let Some(gap) = found.filter(|gap| !gap.sides.iter().any(|h| is_used.contains(h))) {
                is_used.extend(&gap.sides);
                gaps.push(gap);
            }
        }
        Ok(gaps)
    }

    /// The boundary half-edges that begin at a place.
    fn leaving(&self, place: u32) -> &[(u32, u32)] {
        let start = self.leaving.partition_point(|&(from, _)| from < place);
        let end = self.leaving.partition_point(|&(from, _)| from <= place);
        &self.leaving[start..end]
    }

    /// The gap between a boundary half-edge and those that lead back to its start, from `first` on, if they are an arc over it.
    fn gap(&self, chord: u32, first: u32) -> Option<Gap> {
        let [from, to] = edge_of(&self.triangles, chord);
        let [a, b] = self.ends(chord);
        let size = a.distance(b);
        let along = (b - a) / size;
        let share = |v: u32| (self.places[v as usize] - a).dot(along);
        let (mut arc, mut sides, mut at) = (vec![to], Vec::new(), first);
        let mut height: f64 = 0.0;
        loop {
            let [last, next] = edge_of(&self.triangles, at);
            if sides.len() == SIDES_MAX || share(next) >= share(last) {
                return None;
            }
            sides.push(at);
            arc.push(next);
            if next == from {
                break;
            }
            height = height.max(self.rise(next, [a, along]).length());
            match self.leaving(next) {
                &[(_, only)] if height <= HEIGHT_SHARE_MAX * size => at = only,
                _ => return None,
            }
        }
        arc.reverse();
        sides.reverse();
        let is_own = sides.iter().any(|&h| triangle_of(h) == triangle_of(chord));
        let is_gap = sides.len() > 1 && height >= HEIGHT_MIN * self.diagonal && !is_own;
        is_gap.then_some(Gap { chord, arc, sides })
    }

    /// From the chord, which goes from a place in a direction, to a place.
    fn rise(&self, v: u32, [from, along]: [DVec3; 2]) -> DVec3 {
        let side = self.places[v as usize] - from;
        side - along * side.dot(along)
    }

    /// Which surface lies over the gap: a patch would look the other way than it does.
    fn lies_over(&self, gap: &Gap) -> Option<LiesOver> {
        let points: Vec<DVec3> = gap.arc.iter().map(|&v| self.places[v as usize]).collect();
        let patch: DVec3 =
            points.windows(2).map(|pair| (pair[0] - points[0]).cross(pair[1] - points[0])).sum();
        let patch = patch.normalize_or_zero();
        let is_over = |h: u32| {
            let [a, b, c] = self.triangles[triangle_of(h) as usize].map(|v| self.places[v as usize]);
            (b - a).cross(c - a).normalize_or_zero().dot(patch) <= -OVER_COS_MIN
        };
        if gap.sides.iter().all(|&h| is_over(h)) {
            return Some(LiesOver::Arc);
        }
        is_over(gap.chord).then_some(LiesOver::Chord)
    }

    /// Ends the surface of the arc at the chord; `false`, and nothing is changed, where a triangle would turn.
    fn trim(&mut self, gap: Gap, draft: &mut Draft, closed: &mut Closed) -> bool {
        let Gap { chord, mut arc, mut sides } = gap;
        let mut goes = Vec::new();
        // Triangles between arc and chord: two sides of the arc are theirs.
        while let Some(i) = (1..sides.len()).find(|&i| triangle_of(sides[i - 1]) == triangle_of(sides[i])) {
            let t = triangle_of(sides[i]);
            let third =
                [3 * t, 3 * t + 1, 3 * t + 2].into_iter().find(|h| ![sides[i - 1], sides[i]].contains(h));
            let Some(beyond) = third.and_then(|h| self.beyond(h, chord)) else { return false };
            goes.push(t);
            sides.splice(i - 1..=i, [beyond]);
            arc.remove(i);
        }
        let t = triangle_of(chord);
        if goes.iter().any(|gone| *gone == t || self.is_changed.contains(gone)) {
            return false;
        }
        let [a, b] = self.ends(chord);
        let inner = &arc[1..arc.len() - 1];
        let Some(pitch) = self.pitch else { return false };
        let onto = |v: u32| {
            let share = (self.places[v as usize] - a).dot(b - a) / a.distance_squared(b);
            ((a + (b - a) * share) / pitch).round() * pitch + DVec3::ZERO
        };
        let moved: FxHashMap<u32, DVec3> = inner.iter().map(|&v| (v, onto(v))).collect();
        let stars: FxHashSet<u32> = inner.iter().flat_map(|v| &self.stars[v]).copied().collect();
        let keeps = |&t: &u32| {
            let corners = self.triangles[t as usize];
            let before = corners.map(|v| self.places[v as usize]);
            let after = corners.map(|v| moved.get(&v).copied().unwrap_or(self.places[v as usize]));
            Draft::goes_on(before, after)
        };
        let is_free = |t: &u32| !self.is_changed.contains(t);
        if !is_free(&t) || !stars.iter().filter(|t| !goes.contains(t)).all(|t| is_free(t) && keeps(t)) {
            return false;
        }
        let ends =
            inner.iter().map(|v| VertexBeside { half_edge: chord, place: moved[v], like: self.copy(*v) });
        if !inner.is_empty() && !draft.divide_beside(t, ends) {
            return false;
        }
        for (&v, &place) in &moved {
            let start = self.copies.partition_point(|&(at, _)| at < v);
            for &(_, copy) in self.copies[start..].iter().take_while(|(at, _)| *at == v) {
                draft.positions[copy as usize] = place;
            }
            closed.move_max = closed.move_max.max(place.distance(self.places[v as usize]));
        }
        closed.vertices += moved.len() as u64;
        closed.dropped += goes.len() as u64;
        closed.divided += u64::from(!inner.is_empty());
        self.is_changed.extend(stars);
        self.is_changed.extend(goes.iter().copied().chain([t]));
        self.goes.extend(goes);
        true
    }

    /// Divides the triangle of the chord so that its rim is the arc; `false`, and nothing is changed, where a part would turn.
    fn bend(&mut self, gap: &Gap, draft: &mut Draft, closed: &mut Closed) -> bool {
        let t = triangle_of(gap.chord);
        if self.is_changed.contains(&t) {
            return false;
        }
        let beside = |&v: &u32| VertexBeside {
            half_edge: gap.chord,
            place: self.places[v as usize],
            like: self.copy(v),
        };
        if !draft.divide_beside(t, gap.arc[1..gap.arc.len() - 1].iter().map(beside)) {
            return false;
        }
        let [a, b] = self.ends(gap.chord);
        let along = (b - a).normalize_or_zero();
        let rises = gap.arc.iter().map(|&v| self.rise(v, [a, along]).length());
        closed.move_max = rises.fold(closed.move_max, f64::max);
        closed.divided += 1;
        self.is_changed.insert(t);
        true
    }

    /// A vertex of the draft at a place.
    fn copy(&self, place: u32) -> u32 {
        self.copies[self.copies.partition_point(|&(at, _)| at < place)].1
    }

    /// The half-edge of the one other triangle at an edge, but for that of the chord.
    fn beyond(&self, h: u32, chord: u32) -> Option<u32> {
        let [a, b] = edge_of(&self.triangles, h);
        let group = self.groups.group(self.groups.find(&self.triangles, [a.min(b), a.max(b)])?);
        let mut others = group.iter().copied().filter(|&other| other != h && other != chord);
        others.next().filter(|_| others.next().is_none())
    }
}

/// Which surface lies over a gap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum LiesOver {
    Arc,
    Chord,
}
