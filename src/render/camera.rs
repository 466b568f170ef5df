//! From where a scene is seen, and where its points come to lie on the picture.

use super::model::FramedScene;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;

/// The side from which a scene is seen; z is up, and the front is the side of small y.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum View {
    /// From the front, the right and above, each axis shortened alike.
    Iso,
    /// From small y.
    Front,
    /// From large y.
    Back,
    /// From small x.
    Left,
    /// From large x.
    Right,
    /// From above, the front below.
    Top,
    /// From below, the front above.
    Bottom,
}

impl View {
    /// Every view.
    pub const ALL: [Self; 7] =
        [Self::Iso, Self::Front, Self::Right, Self::Back, Self::Left, Self::Top, Self::Bottom];

    /// Its name on a picture.
    pub fn name(self) -> &'static str {
        match self {
            Self::Iso => "iso",
            Self::Front => "front",
            Self::Back => "back",
            Self::Left => "left",
            Self::Right => "right",
            Self::Top => "top",
            Self::Bottom => "bottom",
        }
    }

    /// The same as a direction.
    pub fn direction(self) -> PictureAxes {
        let (toward, up) = match self {
            Self::Iso => (DVec3::new(1.0, -1.0, 1.0), DVec3::Z),
            Self::Front => (DVec3::NEG_Y, DVec3::Z),
            Self::Back => (DVec3::Y, DVec3::Z),
            Self::Left => (DVec3::NEG_X, DVec3::Z),
            Self::Right => (DVec3::X, DVec3::Z),
            Self::Top => (DVec3::Z, DVec3::Y),
            Self::Bottom => (DVec3::NEG_Z, DVec3::NEG_Y),
        };
        PictureAxes::of(toward, up)
    }
}

/// The axes of a picture in the scene: unit vectors at right angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PictureAxes {
    right: DVec3,
    up: DVec3,
    /// From the scene to the eye.
    toward: DVec3,
}

impl PictureAxes {
    /// Seen from `toward`, with `up` above; they must not be parallel.
    fn of(toward: DVec3, up: DVec3) -> Self {
        let toward = toward.normalize();
        let right = up.cross(toward).normalize();
        Self { right, up: toward.cross(right), toward }
    }

    /// Seen from `azimuth` degrees around z, counted from the front to the right, and `elevation` degrees above the
    /// horizon, which must be less than 90.
    pub fn around(azimuth: f64, elevation: f64) -> Self {
        let [(sin_a, cos_a), (sin_e, cos_e)] =
            [azimuth, elevation].map(|degrees| libm::sincos(degrees.to_radians()));
        Self::of(DVec3::new(sin_a * cos_e, -cos_a * cos_e, sin_e), DVec3::Z)
    }

    /// The vector along the picture's right, its upper side and toward the eye.
    fn turn(&self, p: DVec3) -> DVec3 {
        DVec3::new(self.right.dot(p), self.up.dot(p), self.toward.dot(p))
    }
}

/// How depth changes what is seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Projection {
    /// Not at all: parallel lines stay parallel.
    #[default]
    Orthographic,
    /// What is farther is smaller, as through a lens of about 80 mm on a full frame.
    Perspective,
}

/// Half the height of the picture of a perspective view, at distance 1.
const HALF_HEIGHT_AT_ONE: f64 = 0.15;
/// Share of the picture that the scene may take.
const FILLED: f64 = 0.9;

/// Where the points of a scene come to lie on a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    direction: PictureAxes,
    /// The middle of what is seen, along the axes of the picture.
    middle: [f64; 2],
    /// Half the height of the picture in units of the frame; of a perspective view at distance 1.
    half_height: f64,
    /// Distance of the eye from the middle of the frame; `None`: infinitely far.
    eye: Option<f64>,
    /// Least and largest depth, toward the eye.
    depths: [f64; 2],
}

impl Camera {
    /// Looks at all of `models`, which share a frame, on a picture whose width is `aspect` times its height.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn at(
        models: &[&FramedScene<'_>],
        direction: PictureAxes,
        projection: Projection,
        aspect: f64,
        budget: &Budget,
    ) -> Result<Self, Stopped> {
        let mut low = DVec3::INFINITY;
        let mut high = DVec3::NEG_INFINITY;
        let [tangent_x, tangent_y] = [HALF_HEIGHT_AT_ONE * aspect * FILLED, HALF_HEIGHT_AT_ONE * FILLED];
        let mut eye: f64 = 0.0;
        for model in models {
            for points in model.points().chunks(CHECK_EVERY) {
                budget.spend(points.len() as u64 / 16)?;
                for &p in points {
                    let p = direction.turn(p);
                    (low, high) = (low.min(p), high.max(p));
                    eye = eye.max(p.z + (p.x.abs() / tangent_x).max(p.y.abs() / tangent_y));
                }
            }
        }
        if low.x > high.x {
            (low, high) = (DVec3::ZERO, DVec3::ZERO);
        }
        let middle = [f64::midpoint(low.x, high.x), f64::midpoint(low.y, high.y)];
        let size = ((high.x - low.x) / aspect).max(high.y - low.y);
        let flat = Self {
            direction,
            middle,
            half_height: if size > 0.0 { 0.5 * size / FILLED } else { 1.0 },
            eye: None,
            depths: [low.z, high.z],
        };
        Ok(match projection {
            Projection::Orthographic => flat,
            // Never nearer than a tenth of the frame, so that nothing is behind the eye.
            Projection::Perspective => Self {
                middle: [0.0; 2],
                half_height: HALF_HEIGHT_AT_ONE,
                eye: Some(eye.max(high.z + 0.1)),
                ..flat
            },
        })
    }

    /// The same camera for every direction around z at `elevation` degrees, so that nothing grows or shrinks while the
    /// scene turns.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn turning(
        models: &[&FramedScene<'_>],
        elevation: f64,
        aspect: f64,
        budget: &Budget,
    ) -> Result<impl Fn(f64) -> Self + use<>, Stopped> {
        let (mut radius, mut low, mut high) = (0.0_f64, f64::INFINITY, f64::NEG_INFINITY);
        for model in models {
            for points in model.points().chunks(CHECK_EVERY) {
                budget.spend(points.len() as u64 / 16)?;
                for p in points {
                    radius = radius.max(libm::hypot(p.x, p.y));
                    (low, high) = (low.min(p.z), high.max(p.z));
                }
            }
        }
        if low > high {
            (low, high) = (0.0, 0.0);
        }
        let (sin, cos) = libm::sincos(elevation.to_radians());
        let half = radius * sin + 0.5 * (high - low) * cos;
        let size = half.max(radius / aspect);
        let depth = radius * cos + high.abs().max(low.abs()) * sin;
        Ok(move |azimuth: f64| Self {
            direction: PictureAxes::around(azimuth, elevation),
            middle: [0.0, f64::midpoint(low, high) * cos],
            half_height: if size > 0.0 { size / FILLED } else { 1.0 },
            eye: None,
            depths: [-depth, depth],
        })
    }

    /// Where `p`, a point of the frame, lies on a picture of `width` by `height` samples, in samples from the top left,
    /// and how near it is: 0 for the farthest depth, 1 for the nearest, linear on the picture for points of a plane.
    pub(super) fn project(&self, p: DVec3, width: usize, height: usize) -> (f64, f64, f64) {
        let p = self.direction.turn(p);
        let [far, near] = self.depths;
        let (shrink, depth) = match self.eye {
            None => (1.0, share(p.z, far, near)),
            Some(eye) => {
                let of = |z: f64| 1.0 / (eye - z);
                (of(p.z), share(of(p.z), of(far), of(near)))
            }
        };
        let [middle_x, middle_y] = self.middle;
        let scale = 0.5 * height as f64 / self.half_height;
        (
            0.5 * width as f64 + (p.x * shrink - middle_x) * scale,
            0.5 * height as f64 - (p.y * shrink - middle_y) * scale,
            depth,
        )
    }

    /// The ray through a place of a picture of `width` by `height` pixels, in pixels from the top left: a point of it in
    /// the frame, and the direction away from the eye.
    pub fn ray(&self, x: f64, y: f64, width: u32, height: u32) -> (DVec3, DVec3) {
        let (width, height) = (f64::from(width), f64::from(height));
        let step = 2.0 * self.half_height / height;
        let right = self.middle[0] + (x - 0.5 * width) * step;
        let up = self.middle[1] + (0.5 * height - y) * step;
        let PictureAxes { right: to_right, up: to_up, toward } = self.direction;
        match self.eye {
            // Begins before everything: the frame has half a diagonal of less than 2.
            None => (to_right * right + to_up * up + toward * 4.0, -toward),
            Some(eye) => (toward * eye, to_right * right + to_up * up - toward),
        }
    }

    /// True unless `p`, a point of the frame, is behind the eye.
    pub(super) fn is_before(&self, p: DVec3) -> bool {
        self.eye.is_none_or(|eye| self.direction.turn(p).z < eye)
    }

    /// True when a triangle with this normal at `corner` shows its front.
    pub(super) fn sees_front(&self, normal: DVec3, corner: DVec3) -> bool {
        let PictureAxes { toward, .. } = self.direction;
        match self.eye {
            None => normal.dot(toward) >= 0.0,
            Some(eye) => normal.dot(toward * eye - corner) >= 0.0,
        }
    }

    /// A normal along the axes of the picture.
    pub(super) fn turn(&self, normal: DVec3) -> DVec3 {
        self.direction.turn(normal)
    }
}

fn share(value: f64, low: f64, high: f64) -> f64 {
    if high > low { (value - low) / (high - low) } else { 0.5 }
}
