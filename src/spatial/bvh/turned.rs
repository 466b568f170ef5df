//! A tree in other coordinates, in which much of what is long or flat lies along an axis: the boxes of long thin triangles are mostly
//! empty otherwise, and meet many others.

use super::frame::{Box32, Frame};
use super::{Aabb, Bvh, IndexedTriangles, stars};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{DMat3, DVec3};
use crate::par;
use crate::spatial::bvh::{Elements, Tree};

/// A tree over triangles whose corners are turned.
#[derive(Debug)]
pub(in crate::spatial) struct TurnedTree {
    pub(in crate::spatial) tree: Tree,
    pub(in crate::spatial) frame: Frame,
    /// Where the vertices are then, up to `margin` in each coordinate.
    pub(in crate::spatial) positions: Vec<DVec3>,
    pub(in crate::spatial) margin: f64,
}

/// More than the rounding of a turned coordinate, in relation to the sum of all three.
const ROUNDING: f64 = 1e-15;

/// Coordinates beyond which nothing is turned.
const REACH_MAX: f64 = 1e100;

/// Directions nearer to each other than this, as unit vectors, are one.
const SAME: f64 = 0.03;

/// A direction as near to an axis as this, as unit vectors, is along it.
const ALONG: f64 = 1e-3;

/// A second direction is so square to the first at most: their product.
const SQUARE: f64 = 0.05;

/// Cells of a side of a cube onto which directions are put, in each of its two directions.
const CELLS: usize = 64;

/// Triangles that directions are taken from, at most.
const SAMPLES_MAX: usize = 1 << 16;

impl Bvh {
    /// A tree over the same triangles in other coordinates; `None` where no better ones are known.
    pub(in crate::spatial) fn turned(
        &self,
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        budget: &Budget,
    ) -> Result<Option<TurnedTree>, Stopped> {
        let ids = self.tree.ids();
        let step = ids.len().div_ceil(SAMPLES_MAX).max(1);
        budget.spend((ids.len() / step) as u64)?;
        let corners = |&t: &u32| triangles[t as usize].map(|v| positions[v as usize]);
        let directions: Vec<DVec3> = ids.iter().step_by(step).map(corners).flat_map(directions_of).collect();
        let Some(turn) = turn_to_axes(&directions) else { return Ok(None) };
        let _charge = budget.charge(size_of_val(positions) as u64)?;
        let parts = par::map_ranges(positions.len(), CHECK_EVERY, |range| {
            let sum = |p: &DVec3| p.abs().element_sum();
            let reach = positions[range.clone()].iter().map(sum).fold(0.0, f64::max);
            (reach, positions[range].iter().map(|&p| turn * p).collect::<Vec<_>>())
        });
        let reach = parts.iter().map(|&(reach, _)| reach).fold(0.0, f64::max);
        if reach >= REACH_MAX {
            return Ok(None);
        }
        // This never vanishes: the weights of directions are fourth powers of edges, and do so long before.
        let margin = reach * ROUNDING;
        let positions = parts.into_iter().flat_map(|(_, turned)| turned).collect::<Vec<_>>();
        let mut elements = Turned {
            triangles: IndexedTriangles {
                positions: &positions,
                triangles,
                ids: Some(&ids),
                frame: self.frame,
            },
            margin: DVec3::splat(margin),
        };
        let all = &mut elements.triangles;
        all.frame = Frame::around(all.len(), |place| positions[triangles[ids[place] as usize][0] as usize]);
        let frame = all.frame;
        let (tree, _) = stars::tree(&self.stars, triangles.len(), &positions, &elements, budget)?;
        Ok(Some(TurnedTree { tree, frame, positions, margin }))
    }
}

/// Triangles whose corners are known up to a margin.
struct Turned<'t> {
    triangles: IndexedTriangles<'t>,
    margin: DVec3,
}

impl Elements for Turned<'_> {
    fn len(&self) -> usize {
        self.triangles.len()
    }

    fn id(&self, place: usize) -> u32 {
        self.triangles.id(place)
    }

    fn bounds(&self, id: u32) -> Box32 {
        let IndexedTriangles { positions, frame, .. } = self.triangles;
        let bounds = Aabb::of(self.corners(id).map(|v| positions[v as usize]));
        frame.box_of([bounds.min - self.margin, bounds.max + self.margin])
    }

    fn corners(&self, id: u32) -> [u32; 3] {
        self.triangles.corners(id)
    }
}

/// The normal of a triangle and the direction of its longest edge, each as long as the square of that edge.
fn directions_of(corners: [DVec3; 3]) -> [DVec3; 2] {
    let [a, b, c] = corners;
    let edges = [b - a, c - b, a - c];
    let longest = edges.into_iter().fold(DVec3::ZERO, |best, edge| {
        if edge.length_squared() > best.length_squared() { edge } else { best }
    });
    let square = longest.length_squared();
    [edges[0].cross(edges[1]), longest].map(|d| d.normalize_or_zero() * square)
}

/// A rotation that puts the two most frequent directions that are square to each other on axes; `None` where they are there already.
/// Lengths are weights.
fn turn_to_axes(directions: &[DVec3]) -> Option<DMat3> {
    let x = most_frequent(directions)?;
    let is_square = |d: &&DVec3| d.dot(x).abs() < SQUARE * d.length();
    let square: Vec<DVec3> = directions.iter().filter(is_square).map(|&d| d - x * d.dot(x)).collect();
    let y = most_frequent(&square).unwrap_or_else(|| x.any_orthonormal_vector());
    let y = (y - x * y.dot(x)).try_normalize()?;
    let is_along = |d: DVec3| d.abs().max_element() > 1.0 - ALONG * ALONG / 2.0;
    (!(is_along(x) && is_along(y))).then(|| DMat3::from_cols(x, y, x.cross(y)).transpose())
}

/// The mean of the directions near the most frequent one, either way round.
fn most_frequent(directions: &[DVec3]) -> Option<DVec3> {
    let mut sums = vec![(0.0, DVec3::ZERO); 3 * CELLS * CELLS];
    for &d in directions {
        let length = d.length();
        let (Some(cell), true) = (cell_of(d), length.is_finite()) else { continue };
        let (weight, sum) = &mut sums[cell];
        *weight += length;
        *sum += if sum.dot(d) < 0.0 { -d } else { d };
    }
    let best =
        sums.into_iter().fold((0.0, DVec3::ZERO), |best, cell| if cell.0 > best.0 { cell } else { best });
    let middle = best.1.try_normalize()?;
    let near = directions.iter().map(|&d| if d.dot(middle) < 0.0 { -d } else { d });
    let near = near.filter(|d| d.is_finite() && d.dot(middle) > (1.0 - SAME * SAME / 2.0) * d.length());
    near.sum::<DVec3>().try_normalize()
}

/// The cell that a direction or its opposite is in, on three sides of a cube.
fn cell_of(d: DVec3) -> Option<usize> {
    let d = d.to_array();
    let side = (0..3).fold(0, |best, k| if d[k].abs() > d[best].abs() { k } else { best });
    let cell = |k: usize| {
        let share = d[(side + k) % 3] / d[side];
        ((share + 1.0) / 2.0 * CELLS as f64).min(CELLS as f64 - 1.0) as usize
    };
    (d[side] != 0.0).then(|| (side * CELLS + cell(1)) * CELLS + cell(2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    fn turn() -> DQuat {
        DQuat::from_scaled_axis(DVec3::new(0.4, -0.9, 0.3))
    }

    #[test]
    fn the_directions_of_a_turned_frame_come_to_lie_on_axes() {
        let around =
            |axis: DVec3| (0..50).map(move |i| turn() * (axis * 9.0 + DVec3::splat(0.001 * f64::from(i))));
        let mut directions: Vec<DVec3> = around(DVec3::X).chain(around(-DVec3::Y)).collect();
        directions.extend((0..50).map(|i| turn() * DVec3::new(1.0, f64::from(i) / 50.0, 0.7)));
        let to_axes = turn_to_axes(&directions).unwrap();
        assert!(
            (to_axes * to_axes.transpose() - DMat3::IDENTITY).to_cols_array().iter().all(|x| x.abs() < 1e-12)
        );
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            assert!((to_axes * (turn() * axis)).abs().max_element() > 0.999, "{axis}");
        }
        assert!(turn_to_axes(&[DVec3::X * 3.0, DVec3::Y, DVec3::Z, DVec3::ONE]).is_none());
        assert!(turn_to_axes(&[DVec3::ZERO, DVec3::NAN, DVec3::INFINITY]).is_none());
    }

    #[test]
    fn boxes_of_triangles_with_a_common_point_meet_wherever_they_are() {
        let mut state = 3u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 24)
        };
        // On a grid, so that middles are exact.
        for (scale, offset) in
            [(1.0, 0.0), (1.0, 1e3), (1.0, 1e9), (2f64.powi(-260), 0.0), (2f64.powi(-1050), 0.0)]
        {
            let mut place = || {
                let place = turn() * DVec3::new(100.0 * random(), random(), random()) * f64::from(1 << 20);
                (place.round() / f64::from(1 << 20) + offset) * scale
            };
            let (mut positions, mut triangles) = (Vec::new(), Vec::new());
            for _ in 0..300 {
                let [a, b, c] = [place(), place(), place()];
                let first = positions.len() as u32;
                positions.extend([a, b, c, (a + b) / 2.0, place(), place()]);
                triangles.extend([0, 3].map(|k| [first + k, first + k + 1, first + k + 2]));
            }
            let budget = Budget::unlimited();
            let bvh = Bvh::build(&positions, &triangles, None, &budget).unwrap();
            let turned = bvh.turned(&positions, &triangles, &budget).unwrap();
            assert_eq!(turned.is_some(), scale > 1e-100, "{scale} {offset}");
            let Some(turned) = turned else { continue };
            let mut boxes = vec![Box32::EMPTY; triangles.len()];
            for leaf in &turned.tree.leaves {
                (0..leaf.len()).for_each(|k| boxes[leaf.id(k) as usize] = leaf.bounds(k));
            }
            assert!(boxes.chunks(2).all(|pair| pair[0].meets(&pair[1])), "{scale} {offset}");
        }
    }
}
