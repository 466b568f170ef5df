//! What a printing process can do, as plain numbers.

/// Bounds of one figure; `None`: no bound.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Limit {
    /// Beyond it the process may fail or the part may be weak.
    pub warning: Option<f64>,
    /// Beyond it the process fails.
    pub error: Option<f64>,
}

impl Limit {
    /// The bound that is met first when a figure gets smaller.
    pub fn first_below(&self) -> Option<f64> {
        match (self.warning, self.error) {
            (Some(warning), Some(error)) => Some(warning.max(error)),
            (warning, error) => warning.or(error),
        }
    }
}

/// Sides of the largest box that can be printed; `None`: no bound.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BuildVolume {
    /// Larger parts do not fit every machine, or only at its edge.
    pub warning: Option<[f64; 3]>,
    /// Larger parts fit no machine.
    pub error: Option<[f64; 3]>,
}

/// An axis of the file, in one of its two directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum BuildDirection {
    /// Along x.
    X,
    /// Against x.
    MinusX,
    /// Along y.
    Y,
    /// Against y.
    MinusY,
    /// Along z.
    #[default]
    Z,
    /// Against z.
    MinusZ,
}

impl BuildDirection {
    /// Every direction.
    pub const ALL: [Self; 6] = [Self::X, Self::MinusX, Self::Y, Self::MinusY, Self::Z, Self::MinusZ];

    /// Its axis, and 1 along or -1 against it.
    pub(super) fn axis(self) -> (usize, f64) {
        match self {
            Self::X => (0, 1.0),
            Self::MinusX => (0, -1.0),
            Self::Y => (1, 1.0),
            Self::MinusY => (1, -1.0),
            Self::Z => (2, 1.0),
            Self::MinusZ => (2, -1.0),
        }
    }
}

/// The limits of a process. Lengths are in the unit of the file, angles in degrees.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PrintingPolicy {
    /// Name of the process, for reports.
    pub name: &'static str,
    /// Version of the limits, for reports.
    pub version: u32,
    /// Least thickness of a wall.
    pub wall: Limit,
    /// Least clearance between walls.
    pub gap: Limit,
    /// Least longest side of the box around a part of its own.
    pub feature: Limit,
    /// Least angle from the horizontal of a surface that faces down.
    pub overhang: Limit,
    /// Least angle of the material at an edge.
    pub sharp_edge: Limit,
    /// Most cavities without a way out.
    pub cavities: Limit,
    /// Largest part.
    pub build_volume: BuildVolume,
    /// Where up is in the machine.
    pub build_direction: BuildDirection,
}

impl PrintingPolicy {
    /// The same limits where a length has `factor` times as many units.
    pub fn scaled(&self, factor: f64) -> Self {
        let limit = |limit: Limit| Limit {
            warning: limit.warning.map(|length| length * factor),
            error: limit.error.map(|length| length * factor),
        };
        let sides = |sides: Option<[f64; 3]>| sides.map(|sides| sides.map(|side| side * factor));
        let volume = &self.build_volume;
        Self {
            wall: limit(self.wall),
            gap: limit(self.gap),
            feature: limit(self.feature),
            build_volume: BuildVolume { warning: sides(volume.warning), error: sides(volume.error) },
            ..*self
        }
    }
}
