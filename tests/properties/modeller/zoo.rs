//! Polyhedra of every kind that the modeller is tried on, with whole coordinates.

use meshmend::geom::DVec3;
use meshmend::modeller::{Solid, from_polygons};

/// Corners and faces as loops.
#[derive(Default, Clone)]
pub(crate) struct Shape {
    pub points: Vec<DVec3>,
    pub faces: Vec<Vec<Vec<u32>>>,
}

impl Shape {
    pub(crate) fn solid(&self) -> Solid {
        from_polygons(&self.points, &self.faces).unwrap()
    }

    fn point(&mut self, p: [f64; 3]) -> u32 {
        let p = DVec3::from_array(p);
        match self.points.iter().position(|&q| q == p) {
            Some(i) => i as u32,
            None => {
                self.points.push(p);
                self.points.len() as u32 - 1
            }
        }
    }

    fn face(&mut self, loops: &[Vec<[f64; 3]>]) {
        let face = loops.iter().map(|l| l.iter().map(|&p| self.point(p)).collect()).collect();
        self.faces.push(face);
    }

    /// The same seen from inside: a cavity.
    fn turned(mut self) -> Self {
        self.faces.iter_mut().flatten().for_each(|l| l.reverse());
        self
    }

    fn with(mut self, other: &Self) -> Self {
        let base = self.points.len() as u32;
        self.points.extend(&other.points);
        let moved = |l: &Vec<u32>| l.iter().map(|v| v + base).collect();
        self.faces.extend(other.faces.iter().map(|f| f.iter().map(moved).collect()));
        self
    }
}

/// A prism over a region, its exterior loop counter-clockwise first.
pub(crate) fn prism(loops: &[Vec<[f64; 2]>], low: f64, high: f64) -> Shape {
    let mut shape = Shape::default();
    let at = |z: f64| {
        loops.iter().map(|l| l.iter().map(|p| [p[0], p[1], z]).collect::<Vec<_>>()).collect::<Vec<_>>()
    };
    let mut bottom = at(low);
    bottom.iter_mut().for_each(|l| l.reverse());
    shape.face(&bottom);
    shape.face(&at(high));
    for l in loops {
        for i in 0..l.len() {
            let (p, q) = (l[i], l[(i + 1) % l.len()]);
            shape.face(&[vec![[p[0], p[1], low], [q[0], q[1], low], [q[0], q[1], high], [p[0], p[1], high]]]);
        }
    }
    shape
}

/// A pyramid over a convex polygon: the tip has as many faces.
pub(crate) fn pyramid(base: &[[f64; 2]], tip: [f64; 3], z: f64) -> Shape {
    let mut shape = Shape::default();
    shape.face(&[base.iter().rev().map(|p| [p[0], p[1], z]).collect()]);
    for i in 0..base.len() {
        let (p, q) = (base[i], base[(i + 1) % base.len()]);
        shape.face(&[vec![[p[0], p[1], z], [q[0], q[1], z], tip]]);
    }
    shape
}

fn bipyramid(base: &[[f64; 2]]) -> Shape {
    let mut shape = Shape::default();
    for i in 0..base.len() {
        let (p, q) = (base[i], base[(i + 1) % base.len()]);
        shape.face(&[vec![[p[0], p[1], 0.0], [q[0], q[1], 0.0], [0.0, 0.0, 40.0]]]);
        shape.face(&[vec![[q[0], q[1], 0.0], [p[0], p[1], 0.0], [0.0, 0.0, -30.0]]]);
    }
    shape
}

fn rectangle(x: [f64; 2], y: [f64; 2]) -> Vec<[f64; 2]> {
    vec![[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]]
}

fn hole(x: [f64; 2], y: [f64; 2]) -> Vec<[f64; 2]> {
    rectangle(x, y).into_iter().rev().collect()
}

/// A convex polygon with whole corners on a rough circle.
fn ring(corners: usize) -> Vec<[f64; 2]> {
    let all = [
        [40.0, 0.0],
        [38.0, 12.0],
        [32.0, 24.0],
        [24.0, 32.0],
        [12.0, 38.0],
        [0.0, 40.0],
        [-12.0, 38.0],
        [-24.0, 32.0],
        [-32.0, 24.0],
        [-38.0, 12.0],
        [-40.0, 0.0],
        [-38.0, -12.0],
        [-32.0, -24.0],
        [-24.0, -32.0],
        [-12.0, -38.0],
        [0.0, -40.0],
        [12.0, -38.0],
        [24.0, -32.0],
        [32.0, -24.0],
        [38.0, -12.0],
    ];
    (0..corners).map(|i| all[i * all.len() / corners]).collect()
}

/// A box whose top has a notch that ends in a vertex of two convex and two reflex edges.
fn saddle() -> Shape {
    let mut s = Shape::default();
    // Two steps that meet crosswise: heights 20 and 40 in opposite quarters, 30 in the others.
    let h = |x: usize, y: usize| [[20.0, 30.0], [30.0, 45.0]][x][y];
    let c = [0.0, 20.0, 45.0];
    let mut bottom: Vec<[f64; 3]> =
        vec![[0.0, 0.0, 0.0], [45.0, 0.0, 0.0], [45.0, 45.0, 0.0], [0.0, 45.0, 0.0]];
    bottom.reverse();
    s.face(&[bottom]);
    for x in 0..2 {
        for y in 0..2 {
            let z = h(x, y);
            if (x, y) == (1, 0) {
                continue;
            }
            if (x, y) == (0, 1) {
                // The two quarters of height 30 touch in the middle vertex: two faces in one plane.
                s.face(&[vec![[c[0], c[1], z], [c[1], c[1], z], [c[1], c[2], z], [c[0], c[2], z]]]);
                s.face(&[vec![[c[1], c[0], z], [c[2], c[0], z], [c[2], c[1], z], [c[1], c[1], z]]]);
                continue;
            }
            s.face(&[vec![
                [c[x], c[y], z],
                [c[x + 1], c[y], z],
                [c[x + 1], c[y + 1], z],
                [c[x], c[y + 1], z],
            ]]);
        }
    }
    // Outer walls.
    s.face(&[vec![
        [0.0, 0.0, 0.0],
        [45.0, 0.0, 0.0],
        [45.0, 0.0, 30.0],
        [20.0, 0.0, 30.0],
        [20.0, 0.0, 20.0],
        [0.0, 0.0, 20.0],
    ]]);
    s.face(&[vec![
        [45.0, 0.0, 0.0],
        [45.0, 45.0, 0.0],
        [45.0, 45.0, 45.0],
        [45.0, 20.0, 45.0],
        [45.0, 20.0, 30.0],
        [45.0, 0.0, 30.0],
    ]]);
    s.face(&[vec![
        [45.0, 45.0, 0.0],
        [0.0, 45.0, 0.0],
        [0.0, 45.0, 30.0],
        [20.0, 45.0, 30.0],
        [20.0, 45.0, 45.0],
        [45.0, 45.0, 45.0],
    ]]);
    s.face(&[vec![
        [0.0, 45.0, 0.0],
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 20.0],
        [0.0, 20.0, 20.0],
        [0.0, 20.0, 30.0],
        [0.0, 45.0, 30.0],
    ]]);
    // Inner steps.
    s.face(&[vec![[20.0, 0.0, 20.0], [20.0, 0.0, 30.0], [20.0, 20.0, 30.0], [20.0, 20.0, 20.0]]]);
    s.face(&[vec![[20.0, 20.0, 20.0], [20.0, 20.0, 30.0], [0.0, 20.0, 30.0], [0.0, 20.0, 20.0]]]);
    s.face(&[vec![[20.0, 20.0, 30.0], [20.0, 20.0, 45.0], [20.0, 45.0, 45.0], [20.0, 45.0, 30.0]]]);
    s.face(&[vec![[20.0, 20.0, 30.0], [45.0, 20.0, 30.0], [45.0, 20.0, 45.0], [20.0, 20.0, 45.0]]]);
    s
}

/// All kinds, with names.
pub(crate) fn zoo() -> Vec<(&'static str, Shape)> {
    let square = rectangle([0.0, 60.0], [0.0, 40.0]);
    let cavity = prism(&[rectangle([10.0, 50.0], [10.0, 30.0])], 10.0, 20.0).turned();
    let plate = |holes: usize| {
        let mut loops = vec![rectangle([0.0, 100.0], [0.0, 40.0])];
        loops.extend((0..holes).map(|i| {
            let x = 10.0 + 22.0 * i as f64;
            if i % 2 == 0 {
                hole([x, x + 12.0], [10.0, 30.0])
            } else {
                vec![[x, 20.0], [x + 6.0, 30.0], [x + 12.0, 20.0], [x + 6.0, 8.0]]
            }
        }));
        prism(&loops, 0.0, 12.0)
    };
    let mut all = vec![
        ("tetrahedron", pyramid(&ring(3), [3.0, 5.0, 50.0], 0.0)),
        ("box", prism(std::slice::from_ref(&square), 0.0, 30.0)),
        (
            "L",
            prism(
                &[vec![[0.0, 0.0], [60.0, 0.0], [60.0, 20.0], [25.0, 20.0], [25.0, 50.0], [0.0, 50.0]]],
                0.0,
                15.0,
            ),
        ),
        (
            "U",
            prism(
                &[vec![
                    [0.0, 0.0],
                    [60.0, 0.0],
                    [60.0, 50.0],
                    [45.0, 50.0],
                    [45.0, 12.0],
                    [15.0, 12.0],
                    [15.0, 50.0],
                    [0.0, 50.0],
                ]],
                0.0,
                20.0,
            ),
        ),
        ("frame", prism(&[square.clone(), hole([10.0, 50.0], [8.0, 32.0])], 0.0, 10.0)),
        ("plate with four holes", plate(4)),
        ("box with a cavity", prism(std::slice::from_ref(&square), 0.0, 30.0).with(&cavity)),
        (
            "frame in a box",
            prism(&[square], 0.0, 30.0).with(
                &prism(&[rectangle([5.0, 55.0], [5.0, 35.0]), hole([20.0, 40.0], [15.0, 25.0])], 6.0, 24.0)
                    .turned(),
            ),
        ),
        (
            "star",
            prism(
                &[vec![
                    [30.0, 0.0],
                    [12.0, 10.0],
                    [0.0, 40.0],
                    [-10.0, 11.0],
                    [-40.0, 2.0],
                    [-12.0, -9.0],
                    [3.0, -35.0],
                    [11.0, -12.0],
                ]],
                0.0,
                25.0,
            ),
        ),
        ("saddle", saddle()),
        ("prism of 20 sides", prism(&[ring(20)], -10.0, 15.0)),
        (
            "ring of 20 sides",
            prism(&[ring(20), ring(10).iter().rev().map(|p| [p[0] / 2.0, p[1] / 2.0]).collect()], 0.0, 9.0),
        ),
    ];
    for (name, degree) in [
        ("pyramid of 4", 4),
        ("pyramid of 5", 5),
        ("pyramid of 6", 6),
        ("pyramid of 7", 7),
        ("pyramid of 8", 8),
        ("pyramid of 20", 20),
    ] {
        all.push((name, pyramid(&ring(degree), [2.0, 3.0, 45.0], 0.0)));
    }
    for (name, degree) in [("bipyramid of 4", 4), ("bipyramid of 5", 5), ("bipyramid of 10", 10)] {
        all.push((name, bipyramid(&ring(degree))));
    }
    all
}
