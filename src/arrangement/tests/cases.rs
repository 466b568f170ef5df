//! Small bodies on a grid, so that every way of touching and overlapping occurs.

use crate::geom::DVec3;

/// SplitMix64, so that every case can be run again by its seed.
pub(super) struct Random(u64);

impl Random {
    pub(super) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x6172_7261)
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub(super) fn below(&mut self, end: u64) -> i64 {
        ((u128::from(self.bits()) * u128::from(end)) >> 64) as i64
    }

    fn place(&mut self, end: u64) -> [i64; 3] {
        [0; 3].map(|_| self.below(end))
    }
}

/// Triangles of closed bodies, each of one operand.
#[derive(Debug, Default, Clone)]
pub(super) struct Bodies {
    pub(super) positions: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) operands: Vec<u8>,
}

type Body = Vec<[[i64; 3]; 3]>;

impl Bodies {
    /// Those of one operand.
    pub(super) fn only(&self, operand: u8) -> Self {
        let triangles = self.triangles.iter().zip(&self.operands).filter(|&(_, &of)| of == operand);
        let triangles: Vec<[u32; 3]> = triangles.map(|(&t, _)| t).collect();
        Self { positions: self.positions.clone(), operands: vec![operand; triangles.len()], triangles }
    }

    pub(super) fn add(&mut self, body: Body, operand: u8) {
        for corners in body {
            let first = self.positions.len() as u32;
            self.positions.extend(corners.map(|p| DVec3::from_array(p.map(|x| x as f64))));
            self.triangles.push([first, first + 1, first + 2]);
            self.operands.push(operand);
        }
        self.weld();
    }

    pub(super) fn add_turned(&mut self, body: Body, operand: u8) {
        self.add(body.into_iter().map(|[a, b, c]| [a, c, b]).collect(), operand);
    }

    /// Names the first vertex at each place, as [`super::arrange`] does.
    fn weld(&mut self) {
        let first = |v: u32| {
            let p = self.positions[v as usize];
            self.positions.iter().position(|q| *q == p).unwrap() as u32
        };
        self.triangles = self.triangles.iter().map(|t| t.map(first)).collect();
    }
}

/// A box whose faces have the diagonals that `diagonals` says.
pub(super) fn cube(low: [i64; 3], high: [i64; 3], diagonals: i64) -> Body {
    let corner = |i: usize| [0, 1, 2].map(|k| if i >> k & 1 == 1 { high[k] } else { low[k] });
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = |(i, [a, b, c, d]): (usize, [usize; 4])| match diagonals >> i & 1 {
        0 => [[a, b, c], [a, c, d]],
        _ => [[a, b, d], [b, c, d]],
    };
    quads.into_iter().enumerate().flat_map(triangles).map(|t| t.map(corner)).collect()
}

/// A tetrahedron of these corners, outward for whoever sees the first three counter-clockwise from outside.
pub(super) fn tetrahedron([a, b, c, d]: [[i64; 3]; 4]) -> Body {
    vec![[a, b, c], [a, d, b], [b, d, c], [c, d, a]]
}

/// A quad and its copy turned around with the other diagonal: a closed body of no volume. The quad is in one plane.
fn doubled_quad(random: &mut Random) -> Body {
    let [a, u, v] = [random.place(3), random.place(3), random.place(3)];
    let plus = |p: [i64; 3], q: [i64; 3]| [0, 1, 2].map(|k| p[k] + q[k]);
    let (b, c, d) = (plus(a, u), plus(plus(a, u), v), plus(a, v));
    vec![[a, b, c], [a, c, d], [a, d, b], [b, d, c]]
}

/// A tetrahedron with an edge on the line x = y = 2.
pub(super) fn wedge(random: &mut Random) -> Body {
    let mut on = || [2, 2, random.below(5)];
    let (a, b) = (on(), on());
    tetrahedron([a, b, random.place(5), random.place(5)])
}

/// A plate with tetrahedra through it.
pub(super) fn pierced_plate(random: &mut Random, tetrahedra: usize) -> Bodies {
    let mut bodies = Bodies::default();
    bodies.add(cube([0, 0, 2], [16, 16, 4], random.below(64)), 0);
    for _ in 0..tetrahedra {
        let (x, y) = (random.below(13), random.below(13));
        let mut corner = |z: i64| [x + random.below(5), y + random.below(5), z];
        let (below, above) = ([corner(0), corner(1)], [corner(5), corner(6)]);
        bodies.add(tetrahedron([below[0], below[1], above[0], above[1]]), 1);
    }
    bodies
}

/// A long beam with so many across it, in equal steps.
pub(super) fn crossed_beam(beams: i64) -> Bodies {
    let mut bodies = Bodies::default();
    bodies.add(cube([-1, 0, 0], [4 * beams, 4, 4], 0), 0);
    for x in (0..beams).map(|i| 4 * i) {
        bodies.add(cube([x, -4, 1], [x + 2, 8, 3], 0), 1);
    }
    bodies
}

/// A few bodies of one or two operands.
pub(super) fn random(random: &mut Random) -> Bodies {
    let mut bodies = Bodies::default();
    let count = 2 + random.below(3);
    let mut last: Body = Vec::new();
    for _ in 0..count {
        let body = match random.below(8) {
            0..=2 => {
                let (a, b) = (random.place(5), random.place(5));
                let [low, high] = [[0, 1, 2].map(|k| a[k].min(b[k])), [0, 1, 2].map(|k| a[k].max(b[k]) + 1)];
                cube(low, high, random.below(64))
            }
            3 | 4 => tetrahedron([random.place(5), random.place(5), random.place(5), random.place(5)]),
            5 => wedge(random),
            6 => doubled_quad(random),
            _ => last.clone(),
        };
        last = body.clone();
        let operand = random.below(2) as u8;
        if random.below(4) == 0 {
            bodies.add_turned(body, operand);
        } else {
            bodies.add(body, operand);
        }
    }
    bodies
}

/// Two solids of up to three boxes and tetrahedra each, which may share planes, edges and vertices, on a grid of `end` steps.
pub(super) fn pair(random: &mut Random, end: u64) -> Bodies {
    let mut bodies = Bodies::default();
    for operand in 0..2 {
        for _ in 0..=random.below(3) {
            let body = match random.below(3) {
                0 => {
                    let (a, b) = (random.place(end), random.place(end));
                    let [low, high] =
                        [[0, 1, 2].map(|k| a[k].min(b[k])), [0, 1, 2].map(|k| a[k].max(b[k]) + 1)];
                    cube(low, high, random.below(64))
                }
                _ => outward(random, end),
            };
            bodies.add(body, operand);
        }
    }
    bodies
}

/// A tetrahedron with a volume that points outward.
fn outward(random: &mut Random, end: u64) -> Body {
    loop {
        let [a, b, c, d] = [0; 4].map(|_| random.place(end));
        let [u, v, w] = [b, c, d].map(|p| [0, 1, 2].map(|k| p[k] - a[k]));
        let minor = |i: usize, j: usize| v[i] * w[j] - v[j] * w[i];
        match u[0] * minor(1, 2) + u[1] * minor(2, 0) + u[2] * minor(0, 1) {
            0 => {}
            ..0 => return tetrahedron([a, b, c, d]),
            1.. => return tetrahedron([b, a, c, d]),
        }
    }
}

/// Many tetrahedra on a larger grid.
pub(super) fn crowd(random: &mut Random, count: usize) -> Bodies {
    let mut bodies = Bodies::default();
    for _ in 0..count {
        let at = random.place(40);
        let corner = |random: &mut Random| {
            let by = random.place(25);
            [0, 1, 2].map(|k| at[k] + by[k])
        };
        let corners = [0; 4].map(|_| corner(random));
        bodies.add(tetrahedron(corners), random.below(2) as u8);
    }
    bodies
}
