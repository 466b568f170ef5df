//! Samples to pixels: light, creases and silhouettes, and the mean of the samples of a pixel.

use super::SAMPLES;
use super::camera::Camera;
use super::canvas::{Canvas, Rgb};
use super::model::FramedScene;
use super::normals::normal;
use super::raster::{SampledScene, VisibleElement};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::par;

/// Which edges are drawn dark, beside silhouettes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum DrawnEdges {
    /// None, nor silhouettes.
    None,
    /// Those where the surface turns by more than 40 degrees, from which on shading does not round them.
    #[default]
    Creases,
    /// All edges of triangles.
    All,
}

/// How a picture looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Style {
    /// Edges that are drawn.
    pub edges: DrawnEdges,
    /// Colour behind everything.
    pub background: Rgb,
    /// Colour of backs; `None`: as their fronts.
    pub back: Option<Rgb>,
}

/// Cosine of the angle by which the surface turns at a crease: 40 degrees, as for normals.
const CREASE_COSINE: f32 = 0.766;
/// Change of the slope of the depth, in shares of the depth of the scene, that is a jump.
const JUMP: f32 = 0.012;
/// Colour of edges.
const INK: [f32; 3] = [32.0, 41.0, 50.0];
/// How much of it a crease, a silhouette and any other edge has.
const CREASE_INK: f32 = 0.62;
const OTHER_INK: f32 = 0.38;

/// Light from everywhere, and from the lamps: directions along the picture's right, its upper side and toward the eye,
/// with their strengths.
const AMBIENT: f32 = 0.46;
const LAMPS: [([f32; 3], f32); 3] =
    [([-0.346, 0.593, 0.727], 0.46), ([0.802, 0.107, 0.588], 0.2), ([0.0, 1.0, 0.0], 0.07)];

/// Rows of pixels that are made at once.
const ROWS: usize = 8;

/// The corners of a triangle whose normals are rounded.
#[derive(Debug, Clone, Copy)]
struct RoundedCorners {
    /// In parts of a sample.
    places: [[i32; 2]; 3],
    /// Toward the eye, along the axes of the picture.
    normals: [[f32; 3]; 3],
}

/// What is known of a triangle that is seen.
#[derive(Debug, Clone, Copy)]
struct VisibleFace {
    /// `None`: it is flat.
    rounded: Option<RoundedCorners>,
    is_back: bool,
}

/// What is known of the triangles that are seen.
struct VisibleFaces {
    /// Number of each triangle in the other lists; `u32::MAX` where it is not seen.
    numbers: Vec<u32>,
    /// Toward the eye, along the axes of the picture; zero where a triangle has none.
    normals: Vec<[f32; 3]>,
    list: Vec<VisibleFace>,
}

impl VisibleFaces {
    fn of(
        model: &FramedScene<'_>,
        camera: &Camera,
        seen: &SampledScene,
        budget: &Budget,
    ) -> Result<Self, Stopped> {
        let mut numbers = vec![u32::MAX; model.scene.triangles.len()];
        let mut triangles = Vec::new();
        for samples in seen.samples.chunks(CHECK_EVERY) {
            budget.spend(samples.len() as u64 / 16)?;
            for t in samples.iter().filter_map(|sample| sample.triangle()) {
                if numbers[t as usize] == u32::MAX {
                    numbers[t as usize] = triangles.len() as u32;
                    triangles.push(t);
                }
            }
        }
        let face = |t: u32| {
            let is_back = seen.is_back[t as usize];
            let toward = |outward: DVec3| {
                let outward = camera.turn(outward);
                (if is_back { -outward } else { outward }).as_vec3().to_array()
            };
            let corners = model.scene.triangles[t as usize];
            let rounded = model.corner_normals.as_ref().map(|normals| RoundedCorners {
                places: seen.places(corners),
                normals: normals.of_triangle(t, corners).map(toward),
            });
            (toward(normal(model.corners(t)).normalize_or_zero()), VisibleFace { rounded, is_back })
        };
        let made = par::try_map_ranges(triangles.len(), CHECK_EVERY, |range| {
            budget.spend(range.len() as u64)?;
            Ok(triangles[range].iter().map(|&t| face(t)).collect::<Vec<_>>())
        })?;
        let (normals, list) = made.into_iter().flatten().unzip();
        Ok(Self { numbers, normals, list })
    }

    /// Number of a triangle that is seen.
    fn number(&self, t: u32) -> usize {
        self.numbers[t as usize] as usize
    }
}

pub(super) fn resolve(
    model: &FramedScene<'_>,
    camera: &Camera,
    seen: &SampledScene,
    style: &Style,
    budget: &Budget,
) -> Result<Canvas, Stopped> {
    let (width, height) = (seen.width / SAMPLES, seen.height / SAMPLES);
    let triangles = model.scene.triangles.len();
    let of_faces = 2 * triangles.min(seen.samples.len()) * (size_of::<VisibleFace>() + 12)
        + triangles * size_of::<u32>();
    let _memory = budget.charge((of_faces + width * height * 3) as u64)?;
    let faces = VisibleFaces::of(model, camera, seen, budget)?;
    budget.spend((width * height) as u64 / 4)?;
    let light = Light { model, seen, style, faces: &faces };
    let mut canvas = Canvas::filled(width, height, style.background);
    par::for_each_chunk_mut(&mut canvas.bytes, width * 3 * ROWS, |begin, bytes| {
        let top = begin / (width * 3);
        for (at, pixel) in bytes.chunks_exact_mut(3).enumerate() {
            let (column, row) = (at % width, top + at / width);
            if let Some(color) = light.pixel(column, row) {
                pixel.copy_from_slice(&color);
            }
        }
    });
    Ok(canvas)
}

struct Light<'l> {
    model: &'l FramedScene<'l>,
    seen: &'l SampledScene,
    style: &'l Style,
    faces: &'l VisibleFaces,
}

impl Light<'_> {
    /// The mean of the samples of a pixel; `None`: nothing is there.
    fn pixel(&self, column: usize, row: usize) -> Option<Rgb> {
        let mut sum = [0.0; 3];
        let mut is_empty = true;
        for y in row * SAMPLES..(row + 1) * SAMPLES {
            for x in column * SAMPLES..(column + 1) * SAMPLES {
                let color = match self.seen.samples[y * self.seen.width + x].seen() {
                    VisibleElement::Nothing => self.style.background.map(f32::from),
                    VisibleElement::Triangle(t) => {
                        is_empty = false;
                        self.inked(self.lit(t, x, y), t, x, y)
                    }
                    VisibleElement::Line(number) => {
                        is_empty = false;
                        self.model.marks.lines[number].color.map(f32::from)
                    }
                    VisibleElement::Spot(number) => {
                        is_empty = false;
                        self.model.marks.spots[number].color.map(f32::from)
                    }
                };
                sum = [sum[0] + color[0], sum[1] + color[1], sum[2] + color[2]];
            }
        }
        let share = 1.0 / (SAMPLES * SAMPLES) as f32;
        (!is_empty).then(|| sum.map(|channel| (channel * share).round() as u8))
    }

    /// The colour of triangle `t` at a sample, in the light.
    fn lit(&self, t: u32, x: usize, y: usize) -> [f32; 3] {
        let number = self.faces.number(t);
        let face = &self.faces.list[number];
        let palette = self.model.scene.palette;
        let paint = self.model.paint(t);
        let color = match self.style.back {
            Some(back) if face.is_back && paint == 0 => back,
            _ => palette.get(paint).copied().unwrap_or([128; 3]),
        };
        let normal = smooth(face, x, y).unwrap_or(self.faces.normals[number]);
        let lamps = LAMPS.iter().map(|(toward, strength)| strength * dot(*toward, normal).max(0.0));
        let light = AMBIENT + lamps.sum::<f32>();
        color.map(|channel| (f32::from(channel) * light).min(255.0))
    }

    /// `color` with ink where an edge passes the sample.
    fn inked(&self, color: [f32; 3], t: u32, x: usize, y: usize) -> [f32; 3] {
        let ink = if self.style.edges == DrawnEdges::None { 0.0 } else { self.ink(t, x, y) };
        let mut inked = color;
        for (channel, dark) in inked.iter_mut().zip(INK) {
            *channel += (dark - *channel) * ink;
        }
        inked
    }

    fn ink(&self, t: u32, x: usize, y: usize) -> f32 {
        let SampledScene { width, height, samples, .. } = self.seen;
        let own = samples[y * width + x];
        let normal = self.faces.normals[self.faces.number(t)];
        let mut ink: f32 = 0.0;
        for (dx, dy) in [(1, 0), (0, 1)] {
            let before = (x >= dx && y >= dy).then(|| samples[(y - dy) * width + x - dx]);
            let after = (x + dx < *width && y + dy < *height).then(|| samples[(y + dy) * width + x + dx]);
            let (Some(before), Some(after)) = (before, after) else { continue };
            // The depth of a plane is linear on the picture, so its second difference shows where one ends.
            let bend = before.near - 2.0 * own.near + after.near;
            for other in [before, after] {
                match other.seen() {
                    VisibleElement::Nothing => ink = ink.max(CREASE_INK),
                    VisibleElement::Triangle(neighbour) if neighbour != t => {
                        let turn = dot(normal, self.faces.normals[self.faces.number(neighbour)]);
                        // Of the two sides of a jump the nearer one is inked.
                        let is_jump = bend.abs() > JUMP && own.near > other.near;
                        if turn < CREASE_COSINE || is_jump {
                            ink = ink.max(CREASE_INK);
                        } else if self.style.edges == DrawnEdges::All {
                            ink = ink.max(OTHER_INK);
                        }
                    }
                    _ => {}
                }
            }
        }
        ink
    }
}

/// The normal between those of the corners at the middle of a sample.
fn smooth(face: &VisibleFace, x: usize, y: usize) -> Option<[f32; 3]> {
    let RoundedCorners { places, normals } = face.rounded.as_ref()?;
    let weights = SampledScene::weights(*places, x, y)?;
    let between = [0, 1, 2]
        .map(|k| weights[0] * normals[0][k] + weights[1] * normals[1][k] + weights[2] * normals[2][k]);
    let length = dot(between, between).sqrt();
    (length > 0.0).then(|| between.map(|along| along / length))
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
