//! Which triangles of an input are not in a result, and which of the result are not in the input.

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{are_collinear, closest_point_on_triangle, triangle_area};
use crate::mesh::Soup;
use crate::repair::NEW;

/// What is not the same in an input and a result.
pub(super) struct Changed {
    /// For each triangle of the input, whether the result has it.
    pub(super) stays: Vec<bool>,
    /// Triangles of the input that the result does not have, ascending. Those without area are no surface that could be
    /// lost, seen or be a body, so they are not among them.
    pub(super) gone: Vec<u32>,
    /// Triangles of the result that the input does not have.
    pub(super) new: Vec<u32>,
    /// Area of the others.
    pub(super) stayed_area: f64,
    /// Area of triangles of the result that are pieces of some of the input.
    pub(super) pieces_area: f64,
}

impl Changed {
    pub(super) fn of(input: &Soup, result: &Soup, origins: &[u32], budget: &Budget) -> Result<Self, Stopped> {
        let mut stays = vec![false; input.triangles.len()];
        let mut new = Vec::new();
        for (t, &origin) in origins.iter().enumerate().take(result.triangles.len()) {
            if t % CHECK_EVERY == 0 {
                budget.check()?;
            }
            let is_same = origin != NEW && {
                let before = input.corners(origin);
                result.corners(t as u32).iter().all(|corner| before.contains(corner))
            };
            if is_same {
                stays[origin as usize] = true;
            } else {
                new.push(t as u32);
            }
        }
        let all = 0..input.triangles.len() as u32;
        let (stayed, mut gone): (Vec<u32>, Vec<u32>) = all.partition(|&t| stays[t as usize]);
        gone.retain(|&t| {
            let [a, b, c] = input.corners(t);
            !are_collinear(a, b, c)
        });
        Ok(Self { stayed_area: area_of(input, &stayed), pieces_area: 0.0, stays, gone, new })
    }

    /// Takes those triangles out of `new` that are pieces of triangles of the input, up to a tenth of `lost_beyond`; gives the
    /// largest distance of one from its triangle, which is that of a corner: a triangle is convex.
    pub(super) fn drop_pieces(
        &mut self,
        input: &Soup,
        result: &Soup,
        origins: &[u32],
        lost_beyond: f64,
    ) -> f64 {
        let mut most: f64 = 0.0;
        let mut pieces_area = 0.0;
        self.new.retain(|&t| {
            let origin = origins[t as usize];
            if origin == NEW {
                return true;
            }
            let whole = input.corners(origin);
            let corners = result.corners(t);
            let far = corners.map(|corner| corner.distance(closest_point_on_triangle(corner, whole)));
            let far = far.into_iter().fold(0.0, f64::max);
            if far > lost_beyond / 10.0 {
                return true;
            }
            most = most.max(far);
            pieces_area += triangle_area(corners);
            false
        });
        self.pieces_area = pieces_area;
        most
    }
}

/// Area of these triangles of a mesh, in square units of its coordinates.
pub(super) fn area_of(mesh: &Soup, triangles: &[u32]) -> f64 {
    // From a zero without a sign, which the sum of nothing has.
    triangles.iter().fold(0.0, |area, &t| area + triangle_area(mesh.corners(t)))
}
