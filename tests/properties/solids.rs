//! Closed surfaces that enclose something, outward, and ways to break them.

use crate::oracle::RawSoup;
use crate::random::Random;
use std::collections::BTreeMap;

impl RawSoup {
    /// Both, side by side, without common vertices.
    pub(crate) fn with(mut self, other: &Self) -> Self {
        let first = self.positions.len() as u32;
        self.positions.extend(&other.positions);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|v| v + first)));
        self
    }

    /// Every position replaced by what `map` makes of it.
    pub(crate) fn map(mut self, map: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        for p in &mut self.positions {
            *p = map(*p);
        }
        self
    }

    pub(crate) fn scaled(self, factor: f64) -> Self {
        self.map(|p| p.map(|x| x * factor))
    }

    pub(crate) fn moved(self, by: [f64; 3]) -> Self {
        self.map(|p| std::array::from_fn(|i| p[i] + by[i]))
    }

    pub(crate) fn inside_out(mut self) -> Self {
        for t in &mut self.triangles {
            t.swap(1, 2);
        }
        self
    }
}

/// Faces with any number of corners, split as fans.
fn solid(positions: Vec<[f64; 3]>, faces: &[&[u32]]) -> RawSoup {
    let fan = |f: &&[u32]| (1..f.len() - 1).map(|i| [f[0], f[i], f[i + 1]]).collect::<Vec<_>>();
    RawSoup { positions, triangles: faces.iter().flat_map(fan).collect() }
}

/// Corner at the origin, legs of length 1.
pub(crate) fn tetrahedron() -> RawSoup {
    let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    solid(positions, &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]])
}

/// From 0 to `size` on each axis.
pub(crate) fn cuboid(size: [f64; 3]) -> RawSoup {
    let positions =
        (0..8).map(|i| std::array::from_fn(|k| if i >> k & 1 == 1 { size[k] } else { 0.0 })).collect();
    let faces: [&[u32]; 6] =
        [&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 4, 6, 2], &[1, 3, 7, 5]];
    solid(positions, &faces)
}

pub(crate) fn cube() -> RawSoup {
    cuboid([1.0; 3])
}

/// A triangle swept from z = 0 to `height`.
pub(crate) fn prism(height: f64) -> RawSoup {
    let foot = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let positions = [0.0, height].iter().flat_map(|&z| foot.map(|[x, y]| [x, y, z])).collect();
    solid(positions, &[&[0, 2, 1], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]])
}

/// An octahedron about the origin, each face split in four, each vertex at its own distance: seen from the origin no
/// triangle hides another, so it is embedded whatever the distances.
pub(crate) fn star(radius: &mut impl FnMut() -> f64) -> RawSoup {
    let axis = |i: usize, s: f64| std::array::from_fn(|k| if k == i { s } else { 0.0 });
    let mut soup = RawSoup {
        positions: (0..6).map(|i| axis(i / 2, if i % 2 == 0 { 1.0 } else { -1.0 })).collect(),
        triangles: Vec::new(),
    };
    let mut middles = BTreeMap::new();
    for (x, y, z) in (0..8).map(|i| (i & 1, 2 + (i >> 1 & 1), 4 + (i >> 2 & 1))) {
        let [a, b, c] = if (x + y + z) % 2 == 0 { [x, y, z] } else { [x, z, y] };
        let mut middle = |u: u32, v: u32| {
            *middles.entry((u.min(v), u.max(v))).or_insert_with(|| {
                let (p, q) = (soup.positions[u as usize], soup.positions[v as usize]);
                soup.positions.push(std::array::from_fn(|k| (p[k] + q[k]) / 2.0));
                soup.positions.len() as u32 - 1
            })
        };
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        soup.triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    for p in &mut soup.positions {
        let r = radius();
        *p = p.map(|x| x * r);
    }
    soup
}

/// The surface of a set of unit cells, with vertices shared by index. Closed; cells that touch in an edge or a corner
/// only make it singular there.
pub(crate) fn voxels(cells: &[[i64; 3]]) -> RawSoup {
    let mut soup = RawSoup::default();
    let mut ids = BTreeMap::new();
    for &cell in cells {
        for (axis, side) in [(0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1)] {
            let mut beyond = cell;
            beyond[axis] += 2 * side - 1;
            if cells.contains(&beyond) {
                continue;
            }
            let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
            let around =
                if side == 1 { [[0, 0], [1, 0], [1, 1], [0, 1]] } else { [[0, 0], [0, 1], [1, 1], [1, 0]] };
            let [a, b, c, d] = around.map(|[u, v]| {
                let mut corner = cell;
                corner[axis] += side;
                corner[j] += u;
                corner[k] += v;
                *ids.entry(corner).or_insert_with(|| {
                    soup.positions.push(corner.map(|x| x as f64));
                    soup.positions.len() as u32 - 1
                })
            });
            soup.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    soup
}

/// Eight cells around a hole: a torus.
pub(crate) fn ring() -> RawSoup {
    let cells: Vec<[i64; 3]> = (0..9).filter(|&i| i != 4).map(|i| [i % 3, i / 3, 0]).collect();
    voxels(&cells)
}

/// One of many small valid solids.
pub(crate) fn any_solid(random: &mut Random) -> RawSoup {
    match random.below(7) {
        0 => tetrahedron(),
        1 => cube(),
        2 => prism(random.pick(&[1.0, 0.125, 3.0])),
        3 => star(&mut || 1.0).scaled(2.0),
        4 => star(&mut || 1.0 + random.below(8) as f64 / 4.0),
        5 => ring(),
        _ => cuboid(std::array::from_fn(|_| f64::from(random.between(1, 3)))),
    }
}
