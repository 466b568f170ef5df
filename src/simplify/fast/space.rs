//! Where the triangles of a part are, to find those that a collapse may meet.

use super::boxes::MovingBoxes;
use super::hubs::{Hubs, PlacedTriangle};
use super::sweep::Sweep;
use crate::geom::{Aabb, DVec3, DirectionCone};

/// The boxes of a part's triangles. Those around a hub have one box together, and are found by their directions.
#[derive(Debug)]
pub(super) struct PartBoxes {
    boxes: MovingBoxes,
    hubs: Hubs,
    /// Number of triangles; the numbers after them are the fans' in `boxes`.
    triangle_count: u32,
}

impl PartBoxes {
    /// The space of `triangles` whose vertices are numbered along a space-filling curve.
    pub(super) fn new(mut triangles: Vec<[u32; 3]>, position: impl Fn(u32) -> DVec3) -> Self {
        let hubs = Hubs::of(&triangles, &position);
        let triangle_count = triangles.len() as u32;
        triangles.extend(hubs.fans.iter().map(|fan| [fan.vertex; 3]));
        let mut boxes = MovingBoxes::new(&triangles, &position);
        for (fan, number) in hubs.fans.iter().zip(triangle_count..) {
            fan.triangles().iter().for_each(|&t| boxes.forget(t));
            boxes.set(number, fan.bounds);
        }
        Self { boxes, hubs, triangle_count }
    }

    /// Bytes that the space of `triangles` takes.
    pub(super) fn bytes(triangles: &[[u32; 3]]) -> u64 {
        MovingBoxes::bytes(triangles.len() as u64) + Hubs::bytes(triangles)
    }

    /// Calls `visit` with all triangles that may have a point in common with what is swept, which is inside of `bounds`,
    /// until it says false. Triangles around `ends`, the vertices that move, may be left out, and also those that have
    /// only a vertex in common with it that does not move. Gives the number of triangles and nodes that were looked at.
    pub(super) fn visit(
        &self,
        bounds: Aabb,
        sweep: &Sweep,
        ends: [u32; 2],
        mut visit: impl FnMut(u32) -> bool,
    ) -> usize {
        let (mut cones, mut looked_at): (Vec<DirectionCone>, usize) = (Vec::new(), 0);
        self.boxes.visit(bounds, |element| {
            looked_at += 1;
            let Some(fan) = element.checked_sub(self.triangle_count) else { return visit(element) };
            let fan = &self.hubs.fans[fan as usize];
            if ends.contains(&fan.vertex) {
                return true;
            }
            let mut goes_on = true;
            let mut visit = |t: u32| {
                goes_on = visit(t);
                goes_on
            };
            if sweep.seen_from(fan.vertex, fan.place(), &mut cones) {
                looked_at += fan.visit(&cones, visit);
            } else {
                looked_at += fan.triangles().iter().take_while(|&&t| visit(t)).count();
            }
            goes_on
        });
        looked_at
    }

    /// Says where a triangle is now.
    pub(super) fn set(&mut self, triangle: u32, now: PlacedTriangle) {
        match self.hubs.fan_of(triangle) {
            Some(fan) => {
                self.hubs.set(fan, triangle, now);
                self.boxes.set(self.triangle_count + fan as u32, self.hubs.fans[fan].bounds);
            }
            None => self.boxes.set(triangle, Aabb::of(now.1)),
        }
    }

    /// Says that a triangle is gone.
    pub(super) fn forget(&mut self, triangle: u32) {
        match self.hubs.fan_of(triangle) {
            Some(fan) => self.hubs.forget(fan, triangle),
            None => self.boxes.forget(triangle),
        }
    }

    /// Says that two vertices have become one; see [`Hubs::merge`].
    pub(super) fn merge(
        &mut self,
        from: u32,
        into: u32,
        position: DVec3,
        corners: impl Fn(u32) -> PlacedTriangle,
    ) {
        self.hubs.merge(from, into, position, corners);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simplify::fast::sweep::Outside;
    use std::f64::consts::TAU;

    struct Numbers(u64);

    impl Numbers {
        /// From -1 to 1 (Knuth's MMIX generator).
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }

        fn below(&mut self, n: u32) -> u32 {
            (self.next().abs() * f64::from(n)) as u32 % n
        }

        /// On a grid of a few places.
        fn place(&mut self) -> DVec3 {
            DVec3::from_array([(); 3].map(|()| (self.next() * 4.0).round()))
        }
    }

    type Mesh = (Vec<DVec3>, Vec<[u32; 3]>);

    /// Two fans of `rim` triangles with the same rim, around vertices 0 and 1.
    fn spindle(hubs: [DVec3; 2], rim: u32, at: impl FnMut(u32) -> DVec3) -> Mesh {
        let positions = hubs.into_iter().chain((0..rim).map(at)).collect();
        let sides = (0..rim).map(|i| [2 + i, 2 + (i + 1) % rim]);
        (positions, sides.flat_map(|[q, r]| [[0, q, r], [1, r, q]]).collect())
    }

    fn cone(sides: u32) -> Mesh {
        spindle([DVec3::Z * 80.0, DVec3::ZERO], sides, |i| {
            let angle = TAU * f64::from(i) / f64::from(sides) + 0.1;
            DVec3::new(30.0 * angle.cos(), 30.0 * angle.sin(), 0.0)
        })
    }

    fn space_of((positions, triangles): &Mesh) -> PartBoxes {
        PartBoxes::new(triangles.clone(), |v| positions[v as usize])
    }

    fn corners_of((positions, triangles): &Mesh, t: u32) -> PlacedTriangle {
        (triangles[t as usize], triangles[t as usize].map(|v| positions[v as usize]))
    }

    /// The collapse of an edge of the rim to a place.
    fn sweep(mesh: &Mesh, ends: [u32; 2], to: DVec3) -> (Sweep, Aabb) {
        let mut sweep = Sweep::default();
        sweep.begin(to, ends[1]);
        for end in ends {
            for ids in mesh.1.iter().filter(|ids| ids.contains(&end)) {
                let k = ids.iter().position(|&v| v == end).unwrap();
                let side = [ids[(k + 1) % 3], ids[(k + 2) % 3]];
                let stays = !ends.iter().all(|end| ids.contains(end));
                if stays || end == ends[0] {
                    sweep.add(mesh.0[end as usize], side.map(|v| mesh.0[v as usize]), side, stays);
                }
            }
        }
        let bounds = sweep.finish();
        (sweep, bounds)
    }

    /// Fails when a triangle is left out that the collapse must not be made for; how many there are.
    fn none_is_left_out(mesh: &Mesh, space: &PartBoxes, ends: [u32; 2], to: DVec3) -> usize {
        let (sweep, bounds) = sweep(mesh, ends, to);
        let mut visited = vec![false; mesh.1.len()];
        space.visit(bounds, &sweep, ends, |t| {
            visited[t as usize] = true;
            true
        });
        let in_the_way = (0..mesh.1.len() as u32).filter(|&t| {
            let (ids, corners) = corners_of(mesh, t);
            let is_there = ids[0] != ids[1];
            is_there
                && !ids.iter().any(|v| ends.contains(v))
                && sweep.passes(&Outside { ids, corners }).is_err()
        });
        let in_the_way: Vec<u32> = in_the_way.collect();
        assert!(in_the_way.iter().all(|&t| visited[t as usize]), "{ends:?} to {to}: {in_the_way:?}");
        in_the_way.len()
    }

    #[test]
    fn no_triangle_in_the_way_of_a_collapse_is_left_out() {
        let mut numbers = Numbers(11);
        let (mut in_the_way, mut free) = (0, 0);
        for case in 0..400 {
            let (scale, count) = ([1.0, 2f64.powi(-100), 2f64.powi(100)][case % 3], 70 + numbers.below(40));
            let mut mesh = if case % 2 == 0 {
                // Folded on itself, in a plane where many directions are the same, or in space.
                let flat = f64::from(u8::from(case % 4 == 0));
                let hubs = [DVec3::ZERO, numbers.place()];
                spindle(hubs, count, |_| numbers.place() * DVec3::new(1.0, 1.0, flat))
            } else {
                let mut cone = cone(count);
                cone.0[2 + numbers.below(count) as usize] += numbers.place();
                cone
            };
            mesh.0.iter_mut().for_each(|p| *p *= scale);
            let space = space_of(&mesh);
            for _ in 0..6 {
                let i = numbers.below(count);
                let ends = [2 + i, 2 + (i + 1) % count];
                let to = match numbers.below(3) {
                    0 => numbers.place() * scale,
                    1 => mesh.0[ends[0] as usize],
                    _ => (mesh.0[ends[0] as usize] + mesh.0[ends[1] as usize]) * 0.5,
                };
                let found = none_is_left_out(&mesh, &space, ends, to);
                in_the_way += found;
                free += usize::from(found == 0);
            }
        }
        assert!(in_the_way > 10_000 && free > 200, "{in_the_way} {free}");
    }

    #[test]
    fn what_moves_and_goes_is_followed_also_when_hubs_merge() {
        let mut numbers = Numbers(12);
        let mut mesh = cone(100);
        let mut space = space_of(&mesh);
        for round in 0..40 {
            // A vertex moves, a hub moves, or one is merged into a vertex of the rim.
            let v = if round % 4 == 0 { numbers.below(2) } else { 2 + numbers.below(100) };
            let into = if round == 20 { 50 } else { v };
            mesh.0[into as usize] += numbers.place();
            let around: Vec<u32> = (0..mesh.1.len() as u32)
                .filter(|&t| mesh.1[t as usize].iter().any(|w| [v, into].contains(w)))
                .collect();
            for &t in &around {
                mesh.1[t as usize].iter_mut().filter(|w| **w == v).for_each(|w| *w = into);
                let now = corners_of(&mesh, t);
                let is_gone = (0..3).any(|k| now.0[k] == now.0[(k + 1) % 3]);
                if is_gone { space.forget(t) } else { space.set(t, now) }
            }
            space.merge(v, into, mesh.0[into as usize], |t| corners_of(&mesh, t));
            mesh.1
                .iter_mut()
                .filter(|t| t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
                .for_each(|t| *t = [v; 3]);
            let i = numbers.below(99);
            none_is_left_out(&mesh, &space, [2 + i, 3 + i], numbers.place());
        }
    }

    #[test]
    fn the_rim_of_a_cone_is_collapsed_without_a_look_at_all_its_faces() {
        let most = [100u32, 1_000, 10_000].map(|sides| {
            let mesh = cone(sides);
            let space = space_of(&mesh);
            let looked_at = (0..sides).step_by(sides as usize / 50).map(|i| {
                let ends = [2 + i, 2 + (i + 1) % sides];
                let to = (mesh.0[ends[0] as usize] + mesh.0[ends[1] as usize]) * 0.5;
                let (sweep, bounds) = sweep(&mesh, ends, to);
                space.visit(bounds, &sweep, ends, |_| true)
            });
            looked_at.max().unwrap()
        });
        // A few more for each level of the trees.
        assert!(most[2] < 4 * most[0] && most[2] < 500, "{most:?}");
    }
}
