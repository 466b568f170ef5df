//! The triangles around a vertex, and where the vertex may go without turning one of them over.

use super::Draft;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{DVec3, are_collinear, closest_point_on_triangle};

/// The triangles around one vertex.
#[derive(Debug, Clone)]
pub struct Star {
    /// The vertex.
    pub vertex: u32,
    /// Its triangles, ascending.
    pub triangles: Vec<u32>,
}

/// Additions after which a direction is taken as it is.
const ROUNDS: usize = 32;

/// Cosine that is enough between a direction and each of those that it is to be in front of.
const ASIDE_MIN: f64 = 0.1;

impl Star {
    /// The stars of `vertices`, which must ascend. One pass over all triangles.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn of_each(draft: &Draft, vertices: &[u32], budget: &Budget) -> Result<Vec<Self>, Stopped> {
        let mut stars: Vec<Self> =
            vertices.iter().map(|&vertex| Self { vertex, triangles: Vec::new() }).collect();
        for (t, corners) in draft.triangles.iter().enumerate() {
            if t % CHECK_EVERY == 0 {
                budget.check()?;
            }
            for v in corners {
                if let Ok(i) = vertices.binary_search(v) {
                    stars[i].triangles.push(t as u32);
                }
            }
        }
        Ok(stars)
    }

    /// A direction in front of all its triangles if there is one; zero if they cancel out.
    pub fn outward(&self, draft: &Draft) -> DVec3 {
        let normals: Vec<DVec3> = self
            .triangles
            .iter()
            .map(|&t| unit_normal(draft.corners(t as usize)).normalize_or_zero())
            .collect();
        Self::in_front_of(&normals)
    }

    /// A direction on the side of all unit vectors if there is one: the one that is farthest from it is added until none
    /// is on the other side, but not for ever. Zero if they cancel out.
    pub fn in_front_of(directions: &[DVec3]) -> DVec3 {
        let mut sum: DVec3 = directions.iter().sum();
        for _ in 0..ROUNDS {
            let direction = sum.normalize_or_zero();
            let farthest = directions.iter().min_by(|a, b| a.dot(direction).total_cmp(&b.dot(direction)));
            match farthest {
                Some(normal) if normal.dot(direction) < ASIDE_MIN => sum += *normal,
                _ => break,
            }
        }
        sum.normalize_or_zero()
    }

    /// A direction away from `other`, another star at the same place: outward when that lies behind the triangles of this
    /// one, inward when it lies in front of them. Zero if there is none.
    pub fn away_from(&self, other: &Self, draft: &Draft) -> DVec3 {
        let outward = self.outward(draft);
        let Some(&t) = other.triangles.first() else { return outward };
        let [p, a, b] = other.corners(draft, t);
        if self.is_in_front((a - p).normalize_or_zero() + (b - p).normalize_or_zero(), draft) {
            -outward
        } else {
            outward
        }
    }

    /// True when `direction` points from the vertex to the front of its triangles. The side is that of the sum of the
    /// normals around the nearest point, by their angles where that is the vertex (Baerentzen and Aanaes 2005).
    fn is_in_front(&self, direction: DVec3, draft: &Draft) -> bool {
        let fan: Vec<[DVec3; 3]> = self.triangles.iter().map(|&t| self.corners(draft, t)).collect();
        let reach = fan.iter().map(|[p, a, _]| p.distance(*a)).fold(f64::INFINITY, f64::min);
        let p = draft.positions[self.vertex as usize] + direction.normalize_or_zero() * (reach / 16.0);
        let nearest: Vec<DVec3> = fan.iter().map(|&corners| closest_point_on_triangle(p, corners)).collect();
        let least = nearest.iter().map(|q| q.distance(p)).fold(f64::INFINITY, f64::min);
        let side = |([tip, a, b], q): (&[DVec3; 3], &DVec3)| {
            let (a, b) = ((*a - *tip).normalize_or_zero(), (*b - *tip).normalize_or_zero());
            let normal = a.cross(b).normalize_or_zero();
            let angle = libm::acos(a.dot(b).clamp(-1.0, 1.0));
            let weight = if q.distance(*tip) <= 1e-9 * reach { angle } else { 1.0 };
            if q.distance(p) <= least + 1e-9 * reach { normal.dot(p - *q) * weight } else { 0.0 }
        };
        fan.iter().zip(&nearest).map(side).sum::<f64>() > 0.0
    }

    /// Distance from the vertex to the nearest line through the other two corners of one of its triangles.
    pub fn room(&self, draft: &Draft) -> f64 {
        let height = |&t: &u32| {
            let [p, a, b] = self.corners(draft, t);
            (a - p).cross(b - p).length() / (b - a).length()
        };
        self.triangles.iter().map(height).fold(f64::INFINITY, f64::min)
    }

    /// `to`, rounded to multiples of `pitch`, unless a triangle would turn over there.
    pub fn place(&self, draft: &Draft, to: DVec3, pitch: f64) -> Option<DVec3> {
        let place = to.map(|x| (x / pitch).round_ties_even() * pitch);
        let is_kept = |&t: &u32| {
            let was = draft.corners(t as usize);
            let corners = draft.triangles[t as usize];
            let is = [0, 1, 2].map(|k| if corners[k] == self.vertex { place } else { was[k] });
            !are_collinear(is[0], is[1], is[2]) && unit_normal(was).dot(unit_normal(is)) > 0.0
        };
        self.triangles.iter().all(is_kept).then_some(place)
    }

    /// Its neighbours, each with the triangle to the next, in the direction of the triangles; `None` when they are not
    /// one cycle.
    pub fn ring(&self, draft: &Draft) -> Option<Vec<(u32, u32)>> {
        let of_triangle = |&t: &u32| {
            let [_, a, b] = self.ids(draft, t);
            (a, (b, t))
        };
        let steps: Vec<(u32, (u32, u32))> = self.triangles.iter().map(of_triangle).collect();
        let mut ring = Vec::with_capacity(steps.len());
        let mut at = steps.first()?.0;
        for _ in 0..steps.len() {
            let &(_, (next, t)) = steps.iter().find(|(from, _)| *from == at)?;
            ring.push((at, t));
            at = next;
        }
        (at == steps[0].0 && ring.iter().skip(1).all(|&(v, _)| v != at)).then_some(ring)
    }

    /// The corners of its triangle `t`, the vertex first.
    fn ids(&self, draft: &Draft, t: u32) -> [u32; 3] {
        let [a, b, c] = draft.triangles[t as usize];
        match self.vertex {
            v if v == a => [a, b, c],
            v if v == b => [b, c, a],
            _ => [c, a, b],
        }
    }

    fn corners(&self, draft: &Draft, t: u32) -> [DVec3; 3] {
        self.ids(draft, t).map(|v| draft.positions[v as usize])
    }
}

fn unit_normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).normalize_or_zero().cross((c - a).normalize_or_zero())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_direction_is_found_on_the_side_of_all_normals_although_most_point_one_way() {
        let mut normals = vec![DVec3::X; 50];
        normals.push(DVec3::new(-0.6, 0.8, 0.0));
        let direction = Star::in_front_of(&normals);
        assert!(normals.iter().all(|normal| normal.dot(direction) > 0.0), "{direction}");
        assert_eq!(Star::in_front_of(&[DVec3::X, -DVec3::X]), DVec3::ZERO);
    }

    /// A pyramid without its base, and a triangle that touches its tip.
    fn pyramid() -> Draft {
        let base = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
        let mut positions = vec![DVec3::Z * 2.0];
        positions.extend(base.map(|[x, y]| DVec3::new(x, y, 0.0)));
        positions.extend([DVec3::new(0.0, 1.0, 4.0), DVec3::new(1.0, 0.0, 4.0)]);
        Draft {
            vertex_origin: (0..7).collect(),
            positions,
            triangles: vec![[0, 1, 2], [3, 0, 2], [3, 4, 0], [0, 4, 1], [0, 5, 6]],
            triangle_origin: (0..5).collect(),
            two_sided: Vec::new(),
            blends: Default::default(),
            polygons: Default::default(),
        }
    }

    #[test]
    fn a_ring_is_one_cycle_or_none() {
        let mut draft = pyramid();
        let star = |draft: &Draft| Star::of_each(draft, &[0], &Budget::unlimited()).unwrap().remove(0);
        assert_eq!(star(&draft).ring(&draft), None, "another triangle touches the tip");
        draft.triangles.pop();
        let ring = star(&draft).ring(&draft);
        assert_eq!(ring, Some(vec![(1, 0), (2, 1), (3, 2), (4, 3)]));
        draft.triangles.pop();
        assert_eq!(star(&draft).ring(&draft), None, "open");
    }

    #[test]
    fn away_is_into_the_solid_from_what_is_in_front_and_out_of_it_from_what_is_behind() {
        let mut draft = pyramid();
        let stars = |draft: &Draft| Star::of_each(draft, &[0, 7], &Budget::unlimited()).unwrap();
        draft.positions.push(draft.positions[0]);
        draft.vertex_origin.push(7);
        draft.triangles[4] = [7, 5, 6];
        let [fan, beside] = &stars(&draft)[..] else { panic!() };
        assert_eq!(fan.away_from(beside, &draft), -DVec3::Z);
        [draft.positions[5], draft.positions[6]] = [DVec3::Y * 0.1, DVec3::X * 0.1];
        assert_eq!(fan.away_from(beside, &draft), DVec3::Z);
    }

    #[test]
    fn a_vertex_stays_on_its_side_of_the_lines_across_from_it() {
        let mut draft = pyramid();
        draft.triangles.pop();
        let star = Star::of_each(&draft, &[0], &Budget::unlimited()).unwrap().remove(0);
        assert_eq!(star.outward(&draft), DVec3::Z);
        assert!((star.room(&draft) - 4.5f64.sqrt()).abs() < 1e-12);
        assert_eq!(star.place(&draft, DVec3::new(0.0, 0.1, 1.3), 0.5), Some(DVec3::new(0.0, 0.0, 1.5)));
        assert_eq!(star.place(&draft, DVec3::new(0.0, 0.0, -1.0), 0.5), None);
    }
}
