//! An upper bound of the distance of a piece of a triangle from a surface that lies over it like a cloth.
//!
//! Seen along a direction `w`, the triangles of the surface over the piece are walked from one to the next across edges.
//! When no edge at which the walk ends is seen inside of the piece, the number of times that the walked triangles cover a
//! place of the piece, those that are seen from behind taken negatively, is the same everywhere (the degree of a map,
//! which changes only across the image of the border). It is the sum of what they cover over the area of the piece. When
//! it is not 0, each place of the piece has a place of the surface along `w`, and the length between them is linear over
//! what a triangle covers, so that it is largest at a corner of that.
//!
//! ```text
//!      ____----____            the surface over the piece, its corners at most h away along w
//!     /    | h     \
//!    p0------------p1          the piece
//! ```

use super::Surface;
use super::bound::Corner;
use crate::budget::{Budget, Stopped};
use crate::geom::{DVec2, DVec3};
use crate::mesh::{EdgeGroups, NO_TWIN, edge_of, next_corner, triangle_of, twins};
use rustc_hash::{FxBuildHasher, FxHashMap};

/// Triangles that one walk may reach.
const WALK_MAX: usize = 256;

/// Triangles that a walk has room for at first.
const WALK_ROOM: usize = 28;

/// The piece is made smaller by at most this share, so that triangles that only touch it need not be walked: by as much as
/// is told from rounding. The bound grows by that share of the longest edge.
const SHRINK_MAX: f64 = 1e-6;

/// Most of the area of a piece that rounding may take from what is covered.
const ROUNDING_MAX: f64 = 0.05;

/// Cosine between the direction and the normal of the piece below which the direction is not taken.
const COSINE_MIN: f64 = 0.5;

/// A surface whose triangles know their neighbours.
pub(super) struct Cloth<'s> {
    surface: Surface<'s>,
    /// For each half-edge the one other half-edge of its edge, or [`NO_TWIN`].
    twins: Vec<u32>,
    /// More than rounding moves a point.
    slack: f64,
}

impl<'s> Cloth<'s> {
    pub(super) fn of(surface: Surface<'s>, slack: f64, budget: &Budget) -> Result<Self, Stopped> {
        let _charge = budget.charge(surface.triangles.len() as u64 * 12)?;
        let groups = EdgeGroups::build(surface.triangles, surface.positions.len(), budget)?;
        let twins = twins(&groups, surface.triangles.len(), budget)?;
        Ok(Self { surface, twins, slack })
    }

    /// No point of the piece is farther from the surface than this; `None` when that is not seen, or is more than `most`.
    /// `seed` is the triangle from which the walk starts, `along` the direction to it if there is one. Gives the number of
    /// triangles that were walked, too.
    pub(super) fn bound(
        &self,
        piece: &[Corner; 3],
        along: DVec3,
        seed: u32,
        most: f64,
    ) -> (Option<f64>, u64) {
        let Some(view) = PieceFrame::of(piece, along, self.slack) else { return (None, 0) };
        let mut walk = CoverWalk { view, covered: 0.0, rounding: 0.0, farthest: 0.0 };
        let mut signs = FxHashMap::with_capacity_and_hasher(WALK_ROOM, FxBuildHasher);
        // With the half-edge across which a triangle was reached.
        let mut left = vec![(seed, 1.0, NO_TWIN)];
        signs.insert(seed, 1.0);
        while let Some((t, sign, entry)) = left.pop() {
            let corners = self.surface.triangles[t as usize].map(|v| self.surface.positions[v as usize]);
            let seen = corners.map(|corner| walk.view.seen(corner));
            walk.cover(seen, sign);
            if walk.farthest > most || signs.len() > WALK_MAX {
                return (None, signs.len() as u64);
            }
            for h in [3 * t, 3 * t + 1, 3 * t + 2].into_iter().filter(|&h| h != entry) {
                let ends = [h % 3, next_corner(h) % 3].map(|c| seen[c as usize]);
                if walk.view.misses(ends) {
                    continue;
                }
                let twin = self.twins[h as usize];
                if twin == NO_TWIN {
                    return (None, signs.len() as u64);
                }
                let of_twin = if self.runs_back(h, twin) { sign } else { -sign };
                match signs.insert(triangle_of(twin), of_twin) {
                    None => left.push((triangle_of(twin), of_twin, twin)),
                    Some(known) if known == of_twin => {}
                    Some(_) => return (None, signs.len() as u64),
                }
            }
        }
        (walk.bound(), signs.len() as u64)
    }

    /// Whether two half-edges of one edge run in opposite directions.
    fn runs_back(&self, g: u32, h: u32) -> bool {
        let [a, b] = edge_of(self.surface.triangles, g);
        [b, a] == edge_of(self.surface.triangles, h)
    }
}

/// A piece as it is seen along a direction.
struct PieceFrame {
    origin: DVec3,
    /// Across the direction.
    across: [DVec3; 2],
    /// Square to the piece, and so long that its product with a difference is the length along the direction.
    height: DVec3,
    /// The piece, shrunk, counter-clockwise.
    corners: [DVec2; 3],
    /// Lengths of its sides.
    sides: [f64; 3],
    area: f64,
    longest: f64,
    /// The share by which it was shrunk.
    shrink: f64,
    /// More than rounding moves a point.
    slack: f64,
}

impl PieceFrame {
    /// `None` for a piece that is too thin or too small to tell its area.
    fn of(piece: &[Corner; 3], along: DVec3, slack: f64) -> Option<Self> {
        let [a, b, c] = piece.each_ref().map(|corner| corner.place);
        let normal = (b - a).cross(c - a).try_normalize()?;
        let along =
            along.try_normalize().filter(|along| along.dot(normal).abs() >= COSINE_MIN).unwrap_or(normal);
        let along = if along.dot(normal) < 0.0 { -along } else { along };
        let (u, v) = along.any_orthonormal_pair();
        let turned = if u.cross(v).dot(along) < 0.0 { [v, u] } else { [u, v] };
        let flat = |p: DVec3| DVec2::new((p - a).dot(turned[0]), (p - a).dot(turned[1]));
        let corners = [a, b, c].map(flat);
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let area = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]) / 2.0;
        // The shrunk sides must be apart from the sides by more than rounding.
        let shrink = 8.0 * slack * longest / area;
        if area.is_nan() || area <= 0.0 || shrink > SHRINK_MAX {
            return None;
        }
        let corners = corners.map(|corner| corner + (middle - corner) * shrink);
        let sides = [0, 1, 2].map(|k| corners[k].distance(corners[(k + 1) % 3]));
        let area = area * (1.0 - shrink) * (1.0 - shrink);
        let height = normal / along.dot(normal);
        Some(Self { origin: a, across: turned, height, corners, sides, area, longest, shrink, slack })
    }

    fn seen(&self, p: DVec3) -> SeenCorner {
        let from = p - self.origin;
        let at = DVec2::new(from.dot(self.across[0]), from.dot(self.across[1]));
        SeenCorner { at, reach: at.length(), height: from.dot(self.height) }
    }

    /// How far inside of side `k` a place is seen, in relation to the length of the side.
    fn inside(&self, k: usize, p: DVec2) -> f64 {
        let (from, to) = (self.corners[k], self.corners[(k + 1) % 3]);
        (to - from).perp_dot(p - from)
    }

    /// Whether an edge is certainly seen outside of the piece.
    fn misses(&self, [u, v]: [SeenCorner; 2]) -> bool {
        let rounding = self.slack + f64::EPSILON * 8.0 * (self.longest + u.reach.max(v.reach));
        let (u, v) = (u.at, v.at);
        let is_beyond = |k: usize| self.inside(k, u).max(self.inside(k, v)) < -rounding * self.sides[k];
        if (0..3).any(is_beyond) {
            return true;
        }
        let along = v - u;
        let turns = self.corners.map(|corner| along.perp_dot(corner - u));
        let least = rounding * along.length();
        turns.iter().all(|&turn| turn > least) || turns.iter().all(|&turn| turn < -least)
    }
}

/// A corner of a walked triangle as it is seen along the direction.
#[derive(Clone, Copy)]
struct SeenCorner {
    at: DVec2,
    /// Its distance from the origin of the piece, as it is seen.
    reach: f64,
    /// How far it is from the piece along the direction.
    height: f64,
}

/// Corners that a triangle may have once it is cut at three lines, also where rounding makes what is cut not convex: of `n`
/// corners at most every second one is cut off by itself, which makes two of it.
const PART_CORNERS_MAX: usize = 9;

/// Part of a walked triangle: where its corners are seen, and how far they are from the piece.
struct CutPart {
    corners: [(DVec2, f64); PART_CORNERS_MAX],
    len: usize,
}

impl CutPart {
    const EMPTY: Self = Self { corners: [(DVec2::ZERO, 0.0); PART_CORNERS_MAX], len: 0 };

    fn of(corners: [SeenCorner; 3]) -> Self {
        let mut part = Self::EMPTY;
        corners.iter().for_each(|corner| part.push((corner.at, corner.height)));
        part
    }

    fn push(&mut self, corner: (DVec2, f64)) {
        self.corners[self.len] = corner;
        self.len += 1;
    }

    fn corners(&self) -> &[(DVec2, f64)] {
        &self.corners[..self.len]
    }

    /// What of it is where `inside` is not negative (Sutherland and Hodgman 1974).
    fn cut(self, inside: impl Fn(DVec2) -> f64) -> Self {
        let mut depths = [0.0; PART_CORNERS_MAX];
        depths.iter_mut().zip(self.corners()).for_each(|(depth, corner)| *depth = inside(corner.0));
        let depths = &depths[..self.len];
        if depths.iter().all(|&depth| depth >= 0.0) {
            return self;
        }
        let mut cut = Self::EMPTY;
        let mut last = self.len - 1;
        for (i, &to) in self.corners().iter().enumerate() {
            let from = self.corners[last];
            if (depths[last] < 0.0) != (depths[i] < 0.0) {
                let share = depths[last] / (depths[last] - depths[i]);
                cut.push((from.0 + (to.0 - from.0) * share, from.1 + (to.1 - from.1) * share));
            }
            if depths[i] >= 0.0 {
                cut.push(to);
            }
            last = i;
        }
        cut
    }
}

/// What was walked so far.
struct CoverWalk {
    view: PieceFrame,
    /// Area of the piece that is covered, as often as it is.
    covered: f64,
    /// More than the rounding of that.
    rounding: f64,
    /// Largest length along the direction over the piece.
    farthest: f64,
}

impl CoverWalk {
    /// Adds what a triangle covers: the part of it that is seen in the piece.
    fn cover(&mut self, corners: [SeenCorner; 3], sign: f64) {
        let view = &self.view;
        let reach = corners.iter().map(|corner| corner.reach).fold(view.longest, f64::max);
        let part = (0..3).fold(CutPart::of(corners), |part, k| part.cut(|p| view.inside(k, p)));
        let part = part.corners();
        let Some(&(first, _)) = part.first() else { return };
        let doubled: f64 = part.windows(2).map(|pair| (pair[0].0 - first).perp_dot(pair[1].0 - first)).sum();
        self.covered += sign * doubled / 2.0;
        self.rounding += (view.slack + 32.0 * f64::EPSILON * reach) * view.longest;
        self.farthest = part.iter().map(|&(_, height)| height.abs()).fold(self.farthest, f64::max);
    }

    fn bound(&self) -> Option<f64> {
        let PieceFrame { area, longest, shrink, slack, .. } = self.view;
        let times = (self.covered / area).abs();
        let is_certain =
            self.rounding <= ROUNDING_MAX * area && (times - times.round()).abs() <= 2.0 * ROUNDING_MAX;
        (is_certain && times.round() >= 1.0).then_some(self.farthest + longest * shrink + slack)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::closest_point_on_triangle;

    /// Numbers from -1 to 1 (Knuth's MMIX generator).
    struct Random(u64);

    impl Random {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }

        fn one_in(&mut self, n: f64) -> bool {
            self.next().abs() * n < 1.0
        }
    }

    const ACROSS: u32 = 6;

    /// A crumpled cloth over the square from -1 to 1, from which triangles may be missing, doubled or turned.
    fn cloth(random: &mut Random, crumple: f64, damage: bool) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let row = ACROSS + 1;
        let mut place = |i: u32| {
            let at = |k: u32| f64::from(k) / f64::from(ACROSS) * 2.0 - 1.0;
            let away = DVec3::new(random.next(), random.next(), random.next()) * crumple;
            DVec3::new(at(i % row), at(i / row), 0.0) + away
        };
        let positions: Vec<DVec3> = (0..row * row).map(&mut place).collect();
        let squares = (0..ACROSS * ACROSS).map(|i| i / ACROSS * row + i % ACROSS);
        let mut triangles: Vec<[u32; 3]> =
            squares.flat_map(|v| [[v, v + 1, v + row], [v + 1, v + row + 1, v + row]]).collect();
        if damage {
            triangles.retain(|_| !random.one_in(12.0));
            let copies: Vec<_> = triangles.iter().copied().filter(|_| random.one_in(20.0)).collect();
            triangles.extend(copies);
            for t in &mut triangles {
                if random.one_in(20.0) {
                    t.swap(1, 2);
                }
            }
        }
        (positions, triangles)
    }

    fn distance((positions, triangles): &(Vec<DVec3>, Vec<[u32; 3]>), p: DVec3) -> (f64, u32) {
        let to = |t: &[u32; 3]| closest_point_on_triangle(p, t.map(|v| positions[v as usize])).distance(p);
        let all = triangles.iter().enumerate().map(|(t, corners)| (to(corners), t as u32));
        all.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap()
    }

    #[test]
    fn no_place_of_a_piece_is_farther_than_what_covers_it_says() {
        let mut random = Random(5);
        let mut covered = [0; 4];
        for case in 0..3_000 {
            let kind = case % 4;
            let mesh = cloth(&mut random, [0.02, 0.1, 0.5, 0.1][kind], kind == 3);
            let surface = Surface { positions: &mesh.0, triangles: &mesh.1 };
            let cloth = Cloth::of(surface, 1e-14, &Budget::unlimited()).unwrap();
            let piece = [(); 3].map(|()| {
                let place = DVec3::new(random.next(), random.next(), random.next() * 0.3) * 0.9;
                let (distance, closest_triangle) = distance(&mesh, place);
                Corner { place, closest_triangle, distance }
            });
            let [a, b, c] = piece.map(|corner| corner.place);
            let (_, seed) = distance(&mesh, (a + b + c) / 3.0);
            let along = DVec3::new(random.next(), random.next(), 3.0 * random.next());
            let Some(bound) = cloth.bound(&piece, along, seed, f64::INFINITY).0 else { continue };
            covered[kind] += 1;
            for (i, j) in (0..=12).flat_map(|i| (0..=12 - i).map(move |j| (i, j))) {
                let place = a + (b - a) * (f64::from(i) / 12.0) + (c - a) * (f64::from(j) / 12.0);
                let found = distance(&mesh, place).0;
                assert!(found <= bound + 1e-12, "case {case}: {found} beyond {bound}");
            }
        }
        assert!(covered[0] > 300 && covered[1] > 200 && covered[2] > 20 && covered[3] > 30, "{covered:?}");
    }

    #[test]
    fn a_piece_over_the_end_of_a_cloth_or_a_hole_in_it_is_not_covered() {
        let square =
            |x: f64| [(x, 0.0), (x + 1.0, 0.0), (x + 1.0, 1.0), (x, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
        let positions = square(0.0);
        let surface = Surface { positions: &positions, triangles: &[[0, 1, 2], [0, 2, 3]] };
        let cloth = Cloth::of(surface, 1e-15, &Budget::unlimited()).unwrap();
        let over = |x: f64, size: f64| {
            let at = |dx: f64, dy: f64| DVec3::new(x + dx * size, 0.3 + dy * size, 0.25);
            let corner = |place| Corner { place, closest_triangle: 0, distance: 0.25 };
            cloth.bound(&[at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0)].map(corner), DVec3::ZERO, 0, 9.0).0
        };
        assert!((over(0.2, 0.5).unwrap() - 0.25).abs() < 1e-5);
        assert_eq!(over(0.7, 0.5), None, "beyond the end");
        assert_eq!(over(3.0, 0.5), None, "nowhere near");
        let one_gone = Surface { positions: &positions, triangles: &[[0, 1, 2]] };
        let holed = Cloth::of(one_gone, 1e-15, &Budget::unlimited()).unwrap();
        let at = |x: f64, y: f64| Corner { place: DVec3::new(x, y, 0.1), closest_triangle: 0, distance: 0.1 };
        assert_eq!(holed.bound(&[at(0.4, 0.2), at(0.8, 0.2), at(0.4, 0.7)], DVec3::Z, 0, 9.0).0, None);
    }
}
