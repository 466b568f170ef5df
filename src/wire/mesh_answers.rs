//! Answers about a mesh as a whole: is it watertight, what volume does it hold, what meets or nearly meets.

use serde::Serialize;
use utoipa::ToSchema;

use super::finite::finite;
use crate::analysis;

/// Whether every edge has exactly two triangles, under four definitions of what a vertex is; tools differ in which they
/// use. Triangles with two equal vertices are left out.
#[derive(Debug, Clone, Copy, Serialize, ToSchema)]
pub struct Watertight {
    /// By the vertex numbers as written; null: the format has none.
    #[schema(required)]
    pub by_index: Option<bool>,
    /// With vertices at bit-equal positions joined.
    pub after_exact_weld: bool,
    /// With vertices joined that are near each other (test `vv` of `proximity`); null: not searched.
    #[schema(required)]
    pub after_epsilon_weld: Option<bool>,
    /// With coordinates rounded to float32 and equal positions joined.
    pub in_float32: bool,
}

/// Where the enclosed volume lies, in cubic units of the file.
#[derive(Debug, Clone, Copy, Serialize, ToSchema)]
pub struct VolumeInterval {
    /// Not less than this.
    pub low: f64,
    /// Not more than this.
    pub high: f64,
    /// How it was found.
    pub method: VolumeMethod,
}

/// How a volume was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "kebab-case")]
pub enum VolumeMethod {
    /// As the sum over closed, coherently oriented shells; `low` and `high` are equal.
    Exact,
    /// By sampling the generalized winding number: `low` counts space where it is at least 3/4, `high` where it is at least
    /// 1/4, each widened by three standard deviations.
    WindingNumber,
}

/// The six tests of vertices, edges and faces against each other.
#[derive(Debug, Clone, Copy, Serialize, ToSchema)]
pub struct Proximity {
    /// What is near, in the unit of the file; around edges shorter than twice that, half of the shortest one.
    #[schema(required)]
    pub epsilon: Option<f64>,
    /// Pairs of features in which triangles pass through each other or share an area, exactly, each pair once; null: too
    /// many triangles meet.
    #[schema(required)]
    pub intersect: Option<TestCounts>,
    /// Pairs of features in which triangles only touch, exactly, each pair once.
    #[schema(required)]
    pub touch: Option<TestCounts>,
    /// Pairs of features that do not meet but are near each other, and of which no smaller ones are.
    pub near: TestCounts,
}

/// How many pairs each test found. After the weld vertices at one position are one, so `vv` is exact nowhere.
#[derive(Debug, Clone, Copy, Serialize, ToSchema)]
pub struct TestCounts {
    /// Two vertices.
    pub vv: u64,
    /// A vertex and an edge.
    pub ve: u64,
    /// A vertex and a face.
    pub vf: u64,
    /// Two edges.
    pub ee: u64,
    /// An edge and a face; always 0 among near ones, because closest points of what does not meet are of the tests before.
    pub ef: u64,
    /// Two faces: duplicates; among near ones, faces of which each vertex is near one of the other.
    pub ff: u64,
}

impl From<&analysis::Watertight> for Watertight {
    fn from(inner: &analysis::Watertight) -> Self {
        Self {
            by_index: inner.by_index,
            after_exact_weld: inner.after_exact_weld,
            after_epsilon_weld: inner.after_epsilon_weld,
            in_float32: inner.in_float32,
        }
    }
}

impl VolumeInterval {
    /// `None` when a bound is not finite.
    pub(super) fn of(inner: &analysis::VolumeInterval) -> Option<Self> {
        let method = if inner.is_exact { VolumeMethod::Exact } else { VolumeMethod::WindingNumber };
        Some(Self { low: finite(inner.low)?, high: finite(inner.high)?, method })
    }
}

impl From<&analysis::Proximity> for Proximity {
    fn from(inner: &analysis::Proximity) -> Self {
        Self {
            epsilon: finite(inner.epsilon),
            intersect: inner.intersect.map(TestCounts::from),
            touch: inner.touch.map(TestCounts::from),
            near: inner.near.into(),
        }
    }
}

impl From<analysis::TestCounts> for TestCounts {
    fn from([vv, ve, vf, ee, ef, ff]: analysis::TestCounts) -> Self {
        Self { vv, ve, vf, ee, ef, ff }
    }
}
