//! Which triangle, line or spot is seen at each sample.
//!
//! The picture is filled in bands of rows that do not depend on each other. A band looks at every triangle that meets its
//! rows, in order; edges are compared exactly in integers (J. Pineda, A parallel algorithm for polygon rasterization,
//! 1988), so that of triangles that share an edge one at least takes each sample on it.

use super::camera::Camera;
use super::model::{FramedScene, Line, Spot};
use super::normals::normal;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::par;
use std::ops::Range;

/// Parts of a sample to which corners are snapped.
const GRID: i64 = 256;
/// Corners farther from the picture than this lie at this distance, in samples: products stay within 64 bits.
const FAR_AWAY: f64 = 32768.0;
/// Rows of a band.
const BAND: usize = 32;
/// Width of a box in samples up to which each sample is asked.
const NARROW: i64 = 16;

/// By how much a back is moved away, so that at a silhouette, where both lie at one depth, the front is seen. In shares
/// of the depth of the scene, as the two below.
const BACK_BEHIND: f64 = 1e-6;
/// By how much lines are moved nearer than the surface that they lie on.
const LINE_BEFORE: f32 = 0.004;
/// As much for spots.
const SPOT_BEFORE: f32 = 0.01;

const NOTHING: u32 = u32::MAX;
const LINE: u32 = 1 << 31;
const SPOT: u32 = 3 << 30;

/// What is seen at a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PixelSample {
    /// How near it is, from 0 to 1.
    pub(super) near: f32,
    what: u32,
}

/// What may be seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum VisibleElement {
    Nothing,
    Triangle(u32),
    Line(usize),
    Spot(usize),
}

impl PixelSample {
    pub(super) const EMPTY: Self = Self { near: f32::NEG_INFINITY, what: NOTHING };

    pub(super) fn seen(self) -> VisibleElement {
        match self.what {
            NOTHING => VisibleElement::Nothing,
            what if what & SPOT == SPOT => VisibleElement::Spot((what & !SPOT) as usize),
            what if what & LINE == LINE => VisibleElement::Line((what & !LINE) as usize),
            what => VisibleElement::Triangle(what),
        }
    }

    pub(super) fn triangle(self) -> Option<u32> {
        match self.seen() {
            VisibleElement::Triangle(t) => Some(t),
            _ => None,
        }
    }
}

/// What is seen of a scene.
#[derive(Debug)]
pub(super) struct SampledScene {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Row by row from the top left.
    pub(super) samples: Vec<PixelSample>,
    /// Vertices in parts of a sample.
    pub(super) corners: Vec<[i32; 2]>,
    /// By triangle, true when its back is toward the eye.
    pub(super) is_back: Vec<bool>,
}

impl SampledScene {
    /// The places of the corners of a triangle, in parts of a sample.
    pub(super) fn places(&self, corners: [u32; 3]) -> [[i32; 2]; 3] {
        corners.map(|v| self.corners[v as usize])
    }

    /// The weights of corners at such places at the middle of a sample; `None` when they have no area on the picture.
    pub(super) fn weights(places: [[i32; 2]; 3], column: usize, row: usize) -> Option<[f32; 3]> {
        let flat = Flat::of(places)?;
        let [x, y] = [column, row].map(|at| at as i64 * GRID + GRID / 2);
        let area = flat.area as f32;
        let [a, b, c] = [0, 1, 2].map(|edge| flat.edge(edge, x, y) as f32 / area);
        // The edge `i` begins at corner `i`; the weight of a corner is that of the edge on its other side.
        let turned = [b, c, a];
        Some(if flat.is_turned { [turned[0], turned[2], turned[1]] } else { turned })
    }
}

/// Fills a picture of so many samples.
pub(super) fn fill(
    model: &FramedScene<'_>,
    camera: &Camera,
    width: usize,
    height: usize,
    budget: &Budget,
) -> Result<SampledScene, Stopped> {
    let triangles = model.scene.triangles;
    let bytes = width * height * size_of::<PixelSample>() + model.points().len() * 12 + triangles.len() * 5;
    let _memory = budget.charge(bytes as u64)?;
    let points = model.points();
    let projected = par::try_map_ranges(points.len(), CHECK_EVERY, |range| {
        budget.spend(range.len() as u64 / 8)?;
        Ok(range.map(|v| place(camera, points[v], width, height)).collect::<Vec<_>>())
    })?;
    let (corners, depths): (Vec<[i32; 2]>, Vec<f32>) = projected.into_iter().flatten().unzip();
    let facts = par::try_map_ranges(triangles.len(), CHECK_EVERY, |range| {
        budget.spend(range.len() as u64 / 8)?;
        let of = |t: usize| {
            let places = triangles[t].map(|v| corners[v as usize]);
            let in_frame = model.corners(t as u32);
            (rows(places, height), !camera.sees_front(normal(in_frame), in_frame[0]))
        };
        Ok(range.map(of).collect::<Vec<_>>())
    })?;
    let (rows, is_back): (Vec<[u16; 2]>, Vec<bool>) = facts.into_iter().flatten().unzip();
    let filling =
        TriangleFill { triangles, corners: &corners, depths: &depths, rows: &rows, is_back: &is_back, width };
    let bands: Vec<_> = (0..height).step_by(BAND).map(|row| row..(row + BAND).min(height)).collect();
    let filled = par::map_items(bands, |_, band| {
        let mut samples = vec![PixelSample::EMPTY; band.len() * width];
        filling.fill(&mut samples, &band, budget)?;
        for (number, line) in model.marks.lines.iter().enumerate() {
            if number % CHECK_EVERY == 0 {
                budget.spend(CHECK_EVERY as u64 / 16)?;
            }
            draw_line(&mut samples, &band, line, number, &|p| camera.project(p, width, height), width);
        }
        for (number, spot) in model.marks.spots.iter().enumerate() {
            if number % 64 == 0 {
                budget.spend(64)?;
            }
            // A place that no triangle has may be anywhere.
            if !camera.is_before(spot.at) {
                continue;
            }
            draw_spot(
                &mut samples,
                &band,
                spot,
                number,
                &|p| camera.project(p, width, height),
                [width, height],
            );
        }
        Ok(samples)
    });
    let mut samples = Vec::with_capacity(width * height);
    for band in filled {
        samples.extend(band?);
    }
    Ok(SampledScene { width, height, samples, corners, is_back })
}

/// A point in parts of a sample, and how near it is.
fn place(camera: &Camera, p: DVec3, width: usize, height: usize) -> ([i32; 2], f32) {
    let (x, y, near) = camera.project(p, width, height);
    let snap = |at: f64| (at.clamp(-FAR_AWAY, FAR_AWAY) * GRID as f64).round() as i32;
    ([snap(x), snap(y)], near as f32)
}

/// The first and the last of the samples in a row or column whose middles lie from `low` to `high`.
fn samples_between(low: i32, high: i32) -> [i64; 2] {
    let [low, high] = [low, high].map(|at| i64::from(at) - GRID / 2);
    [(low + GRID - 1).div_euclid(GRID), high.div_euclid(GRID)]
}

/// The first and the last row that a triangle may meet; the first is larger when there is none.
fn rows(corners: [[i32; 2]; 3], height: usize) -> [u16; 2] {
    let [a, b, c] = corners.map(|[_, y]| y);
    let [first, last] = samples_between(a.min(b).min(c), a.max(b).max(c));
    let last = last.min(height as i64 - 1);
    if first.max(0) > last { [1, 0] } else { [first.max(0) as u16, last as u16] }
}

/// A triangle on the picture, its corners so ordered that it has a positive area.
struct Flat {
    corners: [[i64; 2]; 3],
    area: i64,
    /// The second and the third corner have changed places.
    is_turned: bool,
}

impl Flat {
    fn of(corners: [[i32; 2]; 3]) -> Option<Self> {
        let [a, b, c] = corners.map(|corner| corner.map(i64::from));
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        match area {
            0 => None,
            1.. => Some(Self { corners: [a, b, c], area, is_turned: false }),
            _ => Some(Self { corners: [a, c, b], area: -area, is_turned: true }),
        }
    }

    /// Positive inside of the edge that begins at a corner, zero on it.
    fn edge(&self, i: usize, x: i64, y: i64) -> i64 {
        let ([ax, ay], [bx, by]) = (self.corners[i], self.corners[(i + 1) % 3]);
        (bx - ax) * (y - ay) - (by - ay) * (x - ax)
    }

    /// Change of [`edge`](Self::edge) from one sample to the next in its row.
    fn step(&self, i: usize) -> i64 {
        let ([_, ay], [_, by]) = (self.corners[i], self.corners[(i + 1) % 3]);
        (ay - by) * GRID
    }

    /// The samples of a row that are inside, between `first` and `last`.
    fn span(&self, y: i64, mut first: i64, mut last: i64) -> [i64; 2] {
        let x = GRID / 2;
        for i in 0..3 {
            let (value, step) = (self.edge(i, x, y), self.step(i));
            match step {
                // Inside where value + column * step >= 0.
                1.. => first = first.max(-value.div_euclid(step)),
                0 if value < 0 => return [0, -1],
                0 => {}
                _ => last = last.min(value.div_euclid(-step)),
            }
        }
        [first, last]
    }
}

struct TriangleFill<'f> {
    triangles: &'f [[u32; 3]],
    corners: &'f [[i32; 2]],
    depths: &'f [f32],
    rows: &'f [[u16; 2]],
    is_back: &'f [bool],
    width: usize,
}

impl TriangleFill<'_> {
    fn fill(&self, samples: &mut [PixelSample], band: &Range<usize>, budget: &Budget) -> Result<(), Stopped> {
        let mut work = 0;
        for (part, rows) in self.rows.chunks(CHECK_EVERY).enumerate() {
            budget.check()?;
            for (at, &[first, last]) in rows.iter().enumerate() {
                let (first, last) = (usize::from(first).max(band.start), usize::from(last).min(band.end - 1));
                if first > last || rows[at][0] > rows[at][1] {
                    continue;
                }
                work += self.fill_triangle(samples, band.start, part * CHECK_EVERY + at, [first, last]);
                if work > CHECK_EVERY {
                    budget.spend(work as u64 / 16)?;
                    work = 0;
                }
            }
        }
        budget.spend(work as u64 / 16)
    }

    /// Puts a triangle into the rows `first` to `last`; the number of samples that were asked.
    fn fill_triangle(
        &self,
        samples: &mut [PixelSample],
        top: usize,
        t: usize,
        [first, last]: [usize; 2],
    ) -> usize {
        let ids = self.triangles[t];
        let corners = ids.map(|v| self.corners[v as usize]);
        let [xa, xb, xc] = corners.map(|[x, _]| x);
        let [left, right] = samples_between(xa.min(xb).min(xc), xa.max(xb).max(xc));
        let (left, right) = (left.max(0), right.min(self.width as i64 - 1));
        if left > right {
            return 1;
        }
        let Some(flat) = Flat::of(corners) else { return 1 };
        let [a, b, c] = ids.map(|v| f64::from(self.depths[v as usize]));
        let [near_a, near_b, near_c] = if flat.is_turned { [a, c, b] } else { [a, b, c] };
        let scale = 1.0 / flat.area as f64;
        let behind = if self.is_back[t] { BACK_BEHIND } else { 0.0 };
        let steps = [0, 1, 2].map(|i| flat.step(i));
        // Weights as in `SampledScene::weights`: corner 0 by edge 1, corner 1 by edge 2, corner 2 by edge 0.
        let depth = |edges: [i64; 3]| {
            (near_a * edges[1] as f64 + near_b * edges[2] as f64 + near_c * edges[0] as f64) * scale
        };
        let along = depth(steps);
        let is_narrow = right - left <= NARROW;
        let mut work = 1;
        for row in first..=last {
            let y = row as i64 * GRID + GRID / 2;
            let [from, to] = if is_narrow { [left, right] } else { flat.span(y, left, right) };
            if from > to {
                continue;
            }
            work += (to - from + 1) as usize;
            let x = from * GRID + GRID / 2;
            let mut edges = [0, 1, 2].map(|i| flat.edge(i, x, y));
            let mut near = depth(edges) - behind;
            let begin = (row - top) * self.width;
            for sample in &mut samples[begin + from as usize..=begin + to as usize] {
                if edges[0] | edges[1] | edges[2] >= 0 && near as f32 > sample.near {
                    *sample = PixelSample { near: near as f32, what: t as u32 };
                }
                edges = [edges[0] + steps[0], edges[1] + steps[1], edges[2] + steps[2]];
                near += along;
            }
        }
        work
    }
}

type ProjectionFunction<'p> = &'p dyn Fn(DVec3) -> (f64, f64, f64);

/// Half the width of a line in samples.
const LINE_HALF_WIDTH: f64 = 2.2;

fn draw_line(
    samples: &mut [PixelSample],
    band: &Range<usize>,
    line: &Line,
    number: usize,
    project: ProjectionFunction<'_>,
    width: usize,
) {
    let [(ax, ay, a_near), (bx, by, b_near)] = line.ends.map(project);
    let (dx, dy) = (bx - ax, by - ay);
    let length2 = dx * dx + dy * dy;
    for row in rows_within(ay.min(by), ay.max(by), LINE_HALF_WIDTH, band) {
        let y = row as f64 + 0.5;
        // The part of the line that passes this row, and with it the columns that it may reach.
        let (mut low, mut high) = (ax.min(bx), ax.max(bx));
        if dy.abs() > 1e-9 {
            let ends = [y - LINE_HALF_WIDTH, y + LINE_HALF_WIDTH].map(|y| ax + (y - ay) / dy * dx);
            (low, high) = (low.max(ends[0].min(ends[1])), high.min(ends[0].max(ends[1])));
        }
        for column in rows_within(low, high, 2.0 * LINE_HALF_WIDTH, &(0..width)) {
            let x = column as f64 + 0.5;
            let along = if length2 > 0.0 { ((x - ax) * dx + (y - ay) * dy) / length2 } else { 0.0 };
            let along = along.clamp(0.0, 1.0);
            let (off_x, off_y) = (x - ax - along * dx, y - ay - along * dy);
            let near = (a_near + along * (b_near - a_near)) as f32;
            let sample = &mut samples[(row - band.start) * width + column];
            let is_within = off_x * off_x + off_y * off_y <= LINE_HALF_WIDTH * LINE_HALF_WIDTH;
            if is_within && near + LINE_BEFORE >= sample.near {
                *sample = PixelSample { near: near.max(sample.near), what: LINE | number as u32 };
            }
        }
    }
}

/// Radius of a spot as a share of the smaller side of the picture, and its least in samples.
const SPOT_RADIUS: (f64, f64) = (0.009, 4.0);
/// Inner radius of the ring of a hidden spot as a share of the outer one.
const RING: f64 = 0.7;

fn draw_spot(
    samples: &mut [PixelSample],
    band: &Range<usize>,
    spot: &Spot,
    number: usize,
    project: ProjectionFunction<'_>,
    [width, height]: [usize; 2],
) {
    let (x, y, near) = project(spot.at);
    let (share, least) = SPOT_RADIUS;
    let radius = (share * width.min(height) as f64).max(least);
    let middle = [x, y].map(|at| at.floor().max(0.0) as usize);
    let is_on_picture = x >= 0.0 && y >= 0.0 && middle[0] < width && middle[1] < height;
    // The middle may belong to another band: then the spot is asked for at its nearest row here.
    let row = middle[1].clamp(band.start, band.end - 1);
    let before = samples.get((row - band.start) * width + middle[0].min(width - 1)).map(|sample| sample.near);
    let is_hidden = is_on_picture && before.is_some_and(|before| near as f32 + SPOT_BEFORE < before);
    for row in rows_within(y, y, radius, band) {
        for column in rows_within(x, x, radius, &(0..width)) {
            let (off_x, off_y) = (column as f64 + 0.5 - x, row as f64 + 0.5 - y);
            let off = (off_x * off_x + off_y * off_y).sqrt();
            if off <= radius && (!is_hidden || off >= RING * radius) {
                let near = near as f32 + SPOT_BEFORE;
                samples[(row - band.start) * width + column] =
                    PixelSample { near, what: SPOT | number as u32 };
            }
        }
    }
}

/// The rows of `band` (or columns of such a range) that reach from `low` to `high`, `margin` more on both sides.
fn rows_within(low: f64, high: f64, margin: f64, band: &Range<usize>) -> Range<usize> {
    let clamp = |at: f64| at.clamp(band.start as f64, band.end as f64) as usize;
    clamp((low - margin).floor())..clamp((high + margin).ceil())
}
