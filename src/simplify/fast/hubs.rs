//! Vertices with very many triangles, which are told apart by their directions from there.
//!
//! The boxes of all triangles around a hub meet at it. But what has a point other than the hub in common with one of
//! them is seen from the hub in a common direction. So each hub has a tree of directions that is built once and follows
//! its triangles; only when the hub itself moves, whose collapse looks at all of them anyway, it is built again.

use crate::geom::{Aabb, DVec3, DirectionCone, arc_box, direction};

/// Triangles around one vertex up to which it is no hub.
const VALENCE_MAX: u32 = 64;

const NO_FAN: u32 = u32::MAX;

/// A triangle as it is now: the numbers of its corners and where they are.
pub(super) type PlacedTriangle = ([u32; 3], [DVec3; 3]);

/// The hubs of a part. Each triangle belongs to one at most, for good.
#[derive(Debug, Default)]
pub(super) struct Hubs {
    /// The fan of each triangle; empty without hubs.
    fan_of: Vec<u32>,
    /// The place of each triangle in its fan.
    place: Vec<u32>,
    /// The first fan of each vertex.
    fan_at: Vec<u32>,
    pub(super) fans: Vec<HubFan>,
}

/// The triangles of a hub.
#[derive(Debug)]
pub(super) struct HubFan {
    /// The hub, or what it was merged into.
    pub(super) vertex: u32,
    at: DVec3,
    /// Another fan of the vertex: hubs that were merged keep their triangles.
    next: u32,
    /// Around all triangles that it has had.
    pub(super) bounds: Aabb,
    /// Of the leaves.
    triangles: Vec<u32>,
    /// A binary tree in one array: node `i` has the children `2 i` and `2 i + 1`, and the second half are the leaves. What
    /// is gone has an empty box.
    nodes: Vec<Aabb>,
}

impl Hubs {
    /// The hubs of triangles given by their corners.
    pub(super) fn of(triangles: &[[u32; 3]], position: impl Fn(u32) -> DVec3) -> Self {
        let valence = valences(triangles);
        if valence.iter().all(|&count| count <= VALENCE_MAX) {
            return Self::default();
        }
        let mut fan_at = vec![NO_FAN; valence.len()];
        let (mut fan_of, mut fans) = (vec![NO_FAN; triangles.len()], Vec::new());
        for (t, &corners) in (0u32..).zip(triangles) {
            let Some(hub) = hub_of(corners, &valence) else { continue };
            if fan_at[hub as usize] == NO_FAN {
                fan_at[hub as usize] = fans.len() as u32;
                fans.push(HubFan::at(hub, position(hub)));
            }
            fan_of[t as usize] = fan_at[hub as usize];
            fans[fan_at[hub as usize] as usize].triangles.push(t);
        }
        let mut hubs = Self { fan_of, place: vec![0; triangles.len()], fan_at, fans };
        let corners = |t: u32| (triangles[t as usize], triangles[t as usize].map(&position));
        (0..hubs.fans.len()).for_each(|fan| hubs.build(fan, corners));
        hubs
    }

    /// Bytes that the hubs among `triangles` take.
    pub(super) fn bytes(triangles: &[[u32; 3]]) -> u64 {
        let valence = valences(triangles);
        let of_hubs = triangles.iter().filter(|&&corners| hub_of(corners, &valence).is_some()).count();
        (of_hubs * (4 + 2 * size_of::<Aabb>()) + if of_hubs > 0 { 8 * triangles.len() } else { 0 }) as u64
    }

    /// The fan that a triangle belongs to.
    #[inline]
    pub(super) fn fan_of(&self, triangle: u32) -> Option<usize> {
        self.fan_of.get(triangle as usize).filter(|&&fan| fan != NO_FAN).map(|&fan| fan as usize)
    }

    /// Sorts the triangles of a fan by their directions and builds its tree. O(n log n).
    fn build(&mut self, fan: usize, corners: impl Fn(u32) -> PlacedTriangle) {
        let fan = &mut self.fans[fan];
        let (hub, at) = (fan.vertex, fan.at);
        let key = |&t: &u32| {
            let (_, [a, b, c]) = corners(t);
            (direction(at, (a + b + c) / 3.0).map_or(0, along_curve), t)
        };
        fan.triangles.sort_by_cached_key(key);
        let leaves = fan.triangles.len();
        fan.nodes = vec![Aabb::EMPTY; 2 * leaves];
        for (leaf, &t) in (0u32..).zip(&fan.triangles) {
            let triangle = corners(t);
            fan.bounds = fan.bounds.union(Aabb::of(triangle.1));
            fan.nodes[leaves + leaf as usize] = directions(triangle, hub, at);
            self.place[t as usize] = leaf;
        }
        for node in (1..leaves).rev() {
            fan.nodes[node] = fan.nodes[2 * node].union(fan.nodes[2 * node + 1]);
        }
    }

    /// Says where a triangle of a fan is now.
    pub(super) fn set(&mut self, fan: usize, triangle: u32, now: PlacedTriangle) {
        let leaf = self.place[triangle as usize];
        let fan = &mut self.fans[fan];
        fan.bounds = fan.bounds.union(Aabb::of(now.1));
        fan.replace(leaf, directions(now, fan.vertex, fan.at));
    }

    /// Says that a triangle of a fan is gone.
    pub(super) fn forget(&mut self, fan: usize, triangle: u32) {
        self.fans[fan].replace(self.place[triangle as usize], Aabb::EMPTY);
    }

    /// Says that vertices `from` and `into` have become one, which is at `position`. After the triangles around them are
    /// set or forgotten. O(n log n) for the triangles of hubs among them.
    pub(super) fn merge(
        &mut self,
        from: u32,
        into: u32,
        position: DVec3,
        corners: impl Fn(u32) -> PlacedTriangle,
    ) {
        let first = |fan_at: &[u32], v: u32| fan_at.get(v as usize).copied().unwrap_or(NO_FAN);
        let [gone, kept] = [from, into].map(|v| first(&self.fan_at, v));
        if gone != NO_FAN && from != into {
            let mut last = gone;
            while self.fans[last as usize].next != NO_FAN {
                last = self.fans[last as usize].next;
            }
            self.fans[last as usize].next = kept;
            self.fan_at[from as usize] = NO_FAN;
            self.fan_at[into as usize] = gone;
        }
        let mut fan = first(&self.fan_at, into);
        while fan != NO_FAN {
            let of = &mut self.fans[fan as usize];
            (of.vertex, of.at) = (into, position);
            let nodes = &of.nodes[of.triangles.len()..];
            let mut leaves = nodes.iter();
            of.triangles.retain(|_| leaves.next().is_some_and(|leaf| !leaf.is_empty()));
            let next = of.next;
            self.build(fan as usize, &corners);
            fan = next;
        }
    }
}

impl HubFan {
    fn at(vertex: u32, at: DVec3) -> Self {
        Self { vertex, at, next: NO_FAN, bounds: Aabb::EMPTY, triangles: Vec::new(), nodes: Vec::new() }
    }

    /// Where the hub is.
    pub(super) fn place(&self) -> DVec3 {
        self.at
    }

    /// The triangles, some of which are gone.
    pub(super) fn triangles(&self) -> &[u32] {
        &self.triangles
    }

    fn replace(&mut self, leaf: u32, bounds: Aabb) {
        let mut node = self.triangles.len() + leaf as usize;
        let mut now = bounds;
        while std::mem::replace(&mut self.nodes[node], now) != now && node > 1 {
            node /= 2;
            now = self.nodes[2 * node].union(self.nodes[2 * node + 1]);
        }
    }

    /// Calls `visit` with all triangles that may be seen in a direction of one of the cones, until it says false. Gives the
    /// number of nodes that were looked at.
    pub(super) fn visit(&self, cones: &[DirectionCone], mut visit: impl FnMut(u32) -> bool) -> usize {
        let leaves = self.triangles.len();
        let may_meet = |node: usize| cones.iter().any(|cone| cone.may_meet(&self.nodes[node]));
        let mut stack = [0usize; 64];
        let (mut depth, mut looked_at) = (usize::from(leaves > 0), 0);
        stack[0] = 1;
        while depth > 0 {
            depth -= 1;
            looked_at += 1;
            let node = stack[depth];
            if !may_meet(node) {
                continue;
            }
            if node < leaves {
                stack[depth] = 2 * node + 1;
                stack[depth + 1] = 2 * node;
                depth += 2;
            } else if !visit(self.triangles[node - leaves]) {
                break;
            }
        }
        looked_at
    }
}

/// The number of triangles of each vertex.
fn valences(triangles: &[[u32; 3]]) -> Vec<u32> {
    let vertex_count = triangles.as_flattened().iter().max().map_or(0, |&v| v as usize + 1);
    let mut valence = vec![0u32; vertex_count];
    triangles.as_flattened().iter().for_each(|&v| valence[v as usize] += 1);
    valence
}

/// The corner with the most triangles, of several the one with the smallest number, if it is a hub.
fn hub_of(corners: [u32; 3], valence: &[u32]) -> Option<u32> {
    let [a, b, c] = corners.map(|v| (std::cmp::Reverse(valence[v as usize]), v));
    Some(a.min(b).min(c)).filter(|(count, _)| count.0 > VALENCE_MAX).map(|(_, v)| v)
}

/// The directions of a triangle from the hub, one of its corners.
fn directions((ids, [a, b, c]): PlacedTriangle, hub: u32, at: DVec3) -> Aabb {
    match ids.map(|v| v == hub) {
        [true, _, _] => arc_box(at, b, c),
        [_, true, _] => arc_box(at, c, a),
        _ => arc_box(at, a, b),
    }
}

/// The number of a direction along a Morton curve.
fn along_curve(unit: DVec3) -> u64 {
    // From 0 to 2, in steps of which there are 2^20 to 1: 21 bits.
    let cell = (unit + 1.0) * f64::from(1 << 20);
    let spread = |x: f64| {
        let x = (x as u64).min((1 << 21) - 1);
        let x = (x | x << 32) & 0x001f_0000_0000_ffff;
        let x = (x | x << 16) & 0x001f_0000_ff00_00ff;
        let x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
        let x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
        (x | x << 2) & 0x1249_2492_4924_9249
    };
    spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2
}
