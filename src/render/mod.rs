//! Pictures of triangles, made by computing alone: a z-buffer with standard views, creases, marks and PNG.
//!
//! Corners are snapped to 1/256 of a sample and edges are compared in integers, so neighbours leave no gap and no sample
//! depends on the number of threads. Of what lies at one depth the triangle with the smaller number is seen, and a front
//! before a back.

mod camera;
mod canvas;
mod encode;
mod letters;
mod model;
mod normals;
mod raster;
mod resolve;

pub use camera::{Camera, PictureAxes, Projection, View};
pub use canvas::{Canvas, Rgb};
pub use encode::{animation, picture};
pub use letters::{LETTER_HEIGHT, LETTER_WIDTH};
pub use model::{FramedScene, Line, Scene, SceneFrame, Shade, Spot};
pub use normals::first_at_position;
pub use resolve::{DrawnEdges, Style};

use crate::budget::{Budget, Stopped};

/// Samples of a pixel along each axis.
const SAMPLES: usize = 2;

/// Smallest and largest width and height of a picture, in pixels.
pub const SIDE_MIN: u32 = 16;
/// See [`SIDE_MIN`].
pub const SIDE_MAX: u32 = 4096;

/// Draws `model` as `camera` sees it, on a picture of `width` by `height` pixels; each side is taken as at least
/// [`SIDE_MIN`] and at most [`SIDE_MAX`].
///
/// # Errors
/// When the budget stops the run.
pub fn draw(
    model: &FramedScene<'_>,
    camera: &Camera,
    width: u32,
    height: u32,
    style: &Style,
    budget: &Budget,
) -> Result<Canvas, Stopped> {
    let [width, height] = [width, height].map(|side| side.clamp(SIDE_MIN, SIDE_MAX) as usize);
    let seen = raster::fill(model, camera, width * SAMPLES, height * SAMPLES, budget)?;
    resolve::resolve(model, camera, &seen, style, budget)
}

/// The triangle that is seen at the middle of each of `width` by `height` pixels, row by row from the top left; `None`
/// where there is none. Lines and spots are left out.
///
/// # Errors
/// When the budget stops the run.
pub fn visible_triangles(
    model: &FramedScene<'_>,
    camera: &Camera,
    width: u32,
    height: u32,
    budget: &Budget,
) -> Result<Vec<Option<u32>>, Stopped> {
    let [width, height] = [width, height].map(|side| side.clamp(SIDE_MIN, SIDE_MAX) as usize);
    let seen = raster::fill(&model.without_marks(), camera, width, height, budget)?;
    Ok(seen.samples.iter().map(|sample| sample.triangle()).collect())
}

#[cfg(test)]
mod tests;
