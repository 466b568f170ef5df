//! What is drawn, brought into a frame in which all numbers are small.

use super::canvas::Rgb;
use super::normals::CornerNormals;
use crate::budget::{Budget, CHECK_EVERY, Charge, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::par;
use std::borrow::Cow;

/// Colours of the faces of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Shade {
    /// One for each triangle.
    Flat,
    /// Rounded where neighbours meet at less than 40 degrees.
    #[default]
    Smooth,
}

/// A line over the surface, hidden where something is before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Its ends, in the unit of the scene.
    pub ends: [DVec3; 2],
    /// Its colour.
    pub color: Rgb,
}

/// A round mark; where something is before it, a ring of it shines through.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Its middle, in the unit of the scene.
    pub at: DVec3,
    /// Its colour.
    pub color: Rgb,
}

/// Triangles with colours, and marks over them.
#[derive(Debug, Clone, Copy, Default)]
pub struct Scene<'s> {
    /// Vertices; those that a triangle uses must be finite.
    pub positions: &'s [DVec3],
    /// Vertices of each triangle's corners, all of them in range.
    pub triangles: &'s [[u32; 3]],
    /// Number of each triangle's colour in the palette; empty: the first.
    pub paints: &'s [u8],
    /// Colours; at least as many as `paints` names, and at least one.
    pub palette: &'s [Rgb],
    /// Lines over the surface.
    pub lines: &'s [Line],
    /// Round marks.
    pub spots: &'s [Spot],
}

impl Scene<'_> {
    /// The box of what triangles use.
    pub fn bounds(&self) -> Aabb {
        let corners = self.triangles.iter().flatten();
        Aabb::of(corners.map(|&v| self.positions[v as usize]))
    }
}

/// A shift and a scale that bring scenes that are seen together into a box of at most 2 along each axis around the
/// origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneFrame {
    middle: DVec3,
    half: f64,
}

impl SceneFrame {
    /// Around these boxes.
    pub fn around(boxes: impl IntoIterator<Item = Aabb>) -> Self {
        let all = boxes.into_iter().filter(|b| !b.is_empty()).fold(Aabb::EMPTY, Aabb::union);
        if all.is_empty() {
            return Self { middle: DVec3::ZERO, half: 1.0 };
        }
        // Halved first: the sum of two coordinates may be out of range.
        let half = (0.5 * all.max - 0.5 * all.min).max_element();
        Self { middle: 0.5 * all.max + 0.5 * all.min, half: if half > 0.0 { half } else { 1.0 } }
    }

    fn place(&self, p: DVec3) -> DVec3 {
        (p - self.middle) / self.half
    }
}

/// A scene in its frame.
#[derive(Debug)]
pub struct FramedScene<'s> {
    pub(super) scene: Scene<'s>,
    points: Cow<'s, [DVec3]>,
    pub(super) marks: FrameMarks,
    pub(super) corner_normals: Option<CornerNormals>,
    _memory: Option<Charge<'s>>,
}

/// Marks in the frame.
#[derive(Debug, Clone, Default)]
pub(super) struct FrameMarks {
    pub(super) lines: Vec<Line>,
    pub(super) spots: Vec<Spot>,
}

impl<'s> FramedScene<'s> {
    /// Brings `scene` into `frame`.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn of(
        scene: Scene<'s>,
        frame: SceneFrame,
        shade: Shade,
        budget: &'s Budget,
    ) -> Result<Self, Stopped> {
        let (vertices, triangles) = (scene.positions.len(), scene.triangles.len());
        let of_normals = if shade == Shade::Smooth { CornerNormals::bytes(vertices, triangles) } else { 0 };
        let memory = budget.charge((vertices * (size_of::<DVec3>() + 1) + of_normals) as u64)?;
        // What no triangle uses may lie anywhere: it is put into the middle.
        let mut is_used = vec![false; scene.positions.len()];
        for (t, corners) in scene.triangles.iter().enumerate() {
            if t % CHECK_EVERY == 0 {
                budget.spend(CHECK_EVERY as u64 / 16)?;
            }
            corners.iter().for_each(|&v| is_used[v as usize] = true);
        }
        let place = |v: usize| if is_used[v] { frame.place(scene.positions[v]) } else { DVec3::ZERO };
        let points =
            par::map_ranges(scene.positions.len(), CHECK_EVERY, |range| range.map(place).collect::<Vec<_>>())
                .concat();
        let corner_normals = match shade {
            Shade::Flat => None,
            Shade::Smooth => Some(CornerNormals::of(&points, scene.triangles, budget)?),
        };
        let line = |line: &Line| Line { ends: line.ends.map(|end| frame.place(end)), ..*line };
        let spot = |spot: &Spot| Spot { at: frame.place(spot.at), ..*spot };
        let marks = FrameMarks {
            lines: scene
                .lines
                .iter()
                .filter(|line| line.ends.iter().all(|p| p.is_finite()))
                .map(line)
                .collect(),
            spots: scene.spots.iter().filter(|spot| spot.at.is_finite()).map(spot).collect(),
        };
        Ok(Self { scene, points: points.into(), marks, corner_normals, _memory: Some(memory) })
    }

    /// The same without lines and spots.
    pub(super) fn without_marks(&self) -> FramedScene<'_> {
        FramedScene {
            scene: self.scene,
            points: Cow::Borrowed(&self.points),
            marks: FrameMarks::default(),
            corner_normals: None,
            _memory: None,
        }
    }

    /// The vertices in the frame.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// The corners of triangle `t` in the frame.
    pub(super) fn corners(&self, t: u32) -> [DVec3; 3] {
        self.scene.triangles[t as usize].map(|v| self.points[v as usize])
    }

    /// The colour of triangle `t`.
    pub(super) fn paint(&self, t: u32) -> usize {
        self.scene.paints.get(t as usize).map_or(0, |&paint| usize::from(paint))
    }
}
