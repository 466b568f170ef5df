//! Directions, and how they turn around a normal: signs by rounded numbers where these are sure, by integers otherwise.

use super::exact::{IntegerVector, cross, dot, is_zero, sign};
use crate::geom::DVec3;
use num_bigint::BigInt;
use num_traits::ToPrimitive;
use std::cmp::Ordering;

/// How far a number of [`Direction::near`] may be from the true one: 2^-52 of numbers of at most 1, and more.
const ROUNDING: f64 = 5e-16;
/// The same for a component of the cross product of two: two products of two such numbers, which round too.
const CROSS_ERROR: f64 = 10.0 * ROUNDING;
/// The same for a determinant of three.
const DET_ERROR: f64 = 50.0 * ROUNDING;

/// A vector of integers and what it is near to. Its length means nothing.
#[derive(Debug, Clone)]
pub(super) struct Direction {
    pub(super) exact: IntegerVector,
    /// The vector divided by a power of two that no component is larger than, rounded.
    near: DVec3,
}

impl Direction {
    pub(super) fn new(exact: IntegerVector) -> Self {
        let bits = exact.iter().map(BigInt::bits).max().unwrap_or(0);
        // What is cut off is below 2^-61 of the largest.
        let cut = bits.saturating_sub(62);
        let leading = |x: &BigInt| if cut == 0 { x.to_i64() } else { (x >> cut).to_i64() };
        let scale = crate::geom::power_of_two(-(bits.min(62) as i32));
        let near = exact.each_ref().map(|x| leading(x).map_or(f64::NAN, |x| x as f64 * scale));
        Self { exact, near: DVec3::from_array(near) }
    }

    pub(super) fn is_zero(&self) -> bool {
        is_zero(&self.exact)
    }

    /// True when both are on one line, as zero is with everything.
    pub(super) fn is_parallel(&self, other: &Self) -> bool {
        let near = self.near.cross(other.near).abs();
        near.max_element() <= CROSS_ERROR && is_zero(&cross(&self.exact, &other.exact))
    }

    /// Greater for the same direction, less for the opposite one, equal for any other.
    fn along(&self, other: &Self) -> Ordering {
        if self.is_parallel(other) { sign(&dot(&self.exact, &other.exact)) } else { Ordering::Equal }
    }

    /// The sign of the scalar product.
    pub(super) fn dot_sign(&self, other: &Self) -> Ordering {
        sure_sign(self.near.dot(other.near), CROSS_ERROR)
            .unwrap_or_else(|| sign(&dot(&self.exact, &other.exact)))
    }

    /// The sign of the determinant of this, `to` and `normal`.
    fn turn(&self, to: &Self, normal: &Self) -> Ordering {
        sure_sign(self.near.cross(to.near).dot(normal.near), DET_ERROR)
            .unwrap_or_else(|| sign(&dot(&cross(&self.exact, &to.exact), &normal.exact)))
    }
}

fn sure_sign(value: f64, error: f64) -> Option<Ordering> {
    (value.abs() > error).then(|| value.total_cmp(&0.0))
}

/// The closed angle of a face at a vertex, counter-clockwise around its normal.
#[derive(Clone, Copy)]
pub(super) struct Sector<'d> {
    pub(super) normal: &'d Direction,
    pub(super) from: &'d Direction,
    pub(super) to: &'d Direction,
}

/// Where a direction of the plane of a sector is.
#[derive(Clone, Copy)]
struct Relation {
    /// Along the first ray and along the last.
    along: [Ordering; 2],
    /// The turn from the first ray to it, and from it to the last.
    turns: [Ordering; 2],
}

impl Relation {
    /// That of the opposite direction.
    fn reversed(self) -> Self {
        let reverse = |pair: [Ordering; 2]| pair.map(Ordering::reverse);
        Self { along: reverse(self.along), turns: reverse(self.turns) }
    }

    fn is_on_ray(self) -> bool {
        self.along.contains(&Ordering::Greater)
    }

    /// `whole`: the turn from the first ray to the last.
    fn is_inside(self, whole: Ordering) -> bool {
        let [from, to] = self.turns.map(|turn| turn == Ordering::Greater);
        self.is_on_ray()
            || match whole {
                Ordering::Greater => from && to,
                Ordering::Equal => from,
                Ordering::Less => from || to,
            }
    }
}

impl Sector<'_> {
    fn whole(self) -> Ordering {
        self.from.turn(self.to, self.normal)
    }

    fn relation(self, x: &Direction) -> Relation {
        Relation {
            along: [self.from.along(x), self.to.along(x)],
            turns: [self.from.turn(x, self.normal), x.turn(self.to, self.normal)],
        }
    }

    /// Whether direction `x`, perpendicular to the normal, is in the angle.
    pub(super) fn holds(self, x: &Direction) -> bool {
        self.relation(x).is_inside(self.whole())
    }
}

/// Whether the faces around a vertex meet in their common edges only. Face `i` has the normal `i` and takes the angle
/// counter-clockwise from ray `i` to ray `i - 1`. `line` of two faces: the cross product of their normals.
pub(super) fn is_link_simple<'d>(
    normals: &[&'d Direction],
    rays: &[&'d Direction],
    line: &dyn Fn(usize, usize) -> std::rc::Rc<Direction>,
) -> bool {
    let count = normals.len();
    let sector = |i: usize| Sector { normal: normals[i], from: rays[i], to: rays[(i + count - 1) % count] };
    let whole: Vec<Ordering> = (0..count).map(|i| sector(i).whole()).collect();
    let are_apart = |i: usize, j: usize| {
        let line = line(i, j);
        let is_one_plane = line.is_zero();
        let are_neighbours = (i + 1) % count == j || (j + 1) % count == i;
        let is_harmless = |[first, second]: [Relation; 2]| {
            // In one plane a common ray is no common edge unless the two are neighbours, which cannot be coplanar.
            if first.is_on_ray() && second.is_on_ray() {
                return are_neighbours && !is_one_plane;
            }
            !(first.is_inside(whole[i]) && second.is_inside(whole[j]))
        };
        let relations = |x: &Direction| [sector(i).relation(x), sector(j).relation(x)];
        if is_one_plane {
            // The angles overlap when a ray of one is inside the other.
            let rays = [sector(i).from, sector(i).to, sector(j).from, sector(j).to];
            return rays.into_iter().all(|ray| is_harmless(relations(ray)));
        }
        let there = relations(&line);
        is_harmless(there) && is_harmless(there.map(Relation::reversed))
    };
    (0..count)
        .all(|i| sector(i).from.along(sector(i).to) != Ordering::Greater && (0..i).all(|j| are_apart(i, j)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn direction(x: [i64; 3]) -> Direction {
        Direction::new(x.map(BigInt::from))
    }

    #[test]
    fn rounded_signs_are_those_of_the_integers() {
        let large = BigInt::from(3) << 200;
        let stretched = |x: [i64; 3], more: i64| Direction::new(x.map(|x| x * &large + more));
        let all: Vec<Direction> = (0..27)
            .map(|i| [i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1])
            .filter(|x| *x != [0; 3])
            .flat_map(|x| [direction(x), stretched(x, 0), stretched(x, 1), stretched(x, -1)])
            .collect();
        for a in &all {
            for b in &all {
                assert_eq!(a.is_parallel(b), is_zero(&cross(&a.exact, &b.exact)));
                assert_eq!(a.dot_sign(b), sign(&dot(&a.exact, &b.exact)));
                for c in &all {
                    assert_eq!(a.turn(b, c), sign(&dot(&cross(&a.exact, &b.exact), &c.exact)));
                }
            }
        }
    }

    #[test]
    fn a_sector_of_more_than_half_a_turn_holds_what_a_smaller_one_leaves() {
        let [x, y, z] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map(direction);
        let [small, large] =
            [Sector { normal: &z, from: &x, to: &y }, Sector { normal: &z, from: &y, to: &x }];
        let within = [direction([1, 1, 0]), direction([-1, -1, 0])];
        assert!(small.holds(&within[0]) && !small.holds(&within[1]));
        assert!(!large.holds(&within[0]) && large.holds(&within[1]));
        assert!([&x, &y].into_iter().all(|ray| small.holds(ray) && large.holds(ray)));
    }
}
