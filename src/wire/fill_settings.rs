//! How a step of a plan fills holes.

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};
use utoipa::ToSchema;

use super::holes::{BAND_RINGS_MAX, may_fit_a_field};
use super::whole_number::{whole, whole_number};
use super::words::{ConstraintValues, Extract, FillMethod, Kernel, LambdaFrom};
use crate::implicit::RbfOptions;
use crate::pipeline::ELEMENTS_MAX;
use crate::repair::Selection;
use crate::repair::fill::{FillOptions, HoleChoice};

/// How a step fills holes. What is left out is as in a repair without choices.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FillSettings {
    /// How those are filled that `single` does not name.
    method: FillMethod,
    /// Rings of neighbours around the rim that a surface of radial basis functions is fitted to.
    #[serde(deserialize_with = "whole")]
    #[schema(maximum = 8)]
    band_rings: u32,
    /// How triangles are made of such a surface.
    extract: Extract,
    /// The radial function of such a surface.
    kernel: Kernel,
    /// Distance of its offset constraints from their points, in the unit of the file; null: by `lambda_from`.
    lambda: Option<f64>,
    /// Whose box that distance is a share of.
    lambda_from: LambdaFrom,
    /// The values at the offset constraints.
    constraint_values: ConstraintValues,
    /// Share of the points that have offset constraints.
    #[schema(minimum = 0.01, maximum = 1.0)]
    constraints: f64,
    /// A hole whose method gives no sound patch is offered those of the plainer methods.
    falls_back: bool,
    /// Loops that face each other across a gap get one patch between them.
    bridges: bool,
    /// The method `auto` may make new vertices.
    refines: bool,
    /// Holes that are filled in a way of their own.
    #[schema(max_items = 10_000)]
    single: Vec<SingleHole>,
}

/// A hole that is filled in a way of its own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct SingleHole {
    /// A half-edge of the hole: three times the number of its triangle, plus the place of its corner in it.
    #[serde(deserialize_with = "whole")]
    half_edge: u32,
    /// How; null: as for all.
    #[serde(default)]
    method: Option<FillMethod>,
    /// Rings of neighbours; null: as for all.
    #[serde(default, deserialize_with = "rings")]
    #[schema(maximum = 8)]
    band_rings: Option<u32>,
}

impl Default for FillSettings {
    fn default() -> Self {
        Self::from(&FillOptions::plain(Selection::default()))
    }
}

impl From<&FillOptions> for FillSettings {
    fn from(inner: &FillOptions) -> Self {
        let single = |choice: &HoleChoice| SingleHole {
            half_edge: choice.half_edge,
            method: choice.method.map(Into::into),
            band_rings: choice.band_rings,
        };
        Self {
            method: inner.method.into(),
            band_rings: inner.band_rings,
            extract: inner.extract.into(),
            kernel: inner.rbf.kernel.into(),
            lambda: inner.rbf.lambda,
            lambda_from: inner.rbf.lambda_from.into(),
            constraint_values: inner.rbf.values.into(),
            constraints: inner.rbf.share,
            falls_back: inner.falls_back,
            bridges: inner.bridges,
            refines: inner.refines,
            single: inner.choices.iter().map(single).collect(),
        }
    }
}

impl FillSettings {
    pub(super) fn to_engine(&self, holes: Selection) -> FillOptions {
        let single = |hole: &SingleHole| HoleChoice {
            half_edge: hole.half_edge,
            method: hole.method.map(Into::into),
            band_rings: hole.band_rings,
        };
        let mut choices: Vec<HoleChoice> = self.single.iter().map(single).collect();
        choices.sort_by_key(|choice| choice.half_edge);
        FillOptions {
            holes,
            method: self.method.into(),
            band_rings: self.band_rings,
            extract: self.extract.into(),
            rbf: RbfOptions {
                kernel: self.kernel.into(),
                lambda: self.lambda,
                lambda_from: self.lambda_from.into(),
                values: self.constraint_values.into(),
                share: self.constraints,
                ..RbfOptions::default()
            },
            falls_back: self.falls_back,
            bridges: self.bridges,
            refines: self.refines,
            choices,
        }
    }

    pub(super) fn is_small(&self) -> bool {
        let rings = self.single.iter().filter_map(|hole| hole.band_rings).chain([self.band_rings]);
        let is_in_range = (0.01..=1.0).contains(&self.constraints)
            && self.lambda.is_none_or(|lambda| lambda > 0.0 && lambda <= 1e30);
        is_in_range
            && self.single.iter().all(|hole| hole.contradiction().is_none())
            && self.single.len() <= ELEMENTS_MAX
            && rings.max().is_none_or(|rings| rings <= BAND_RINGS_MAX)
    }
}

impl SingleHole {
    /// What is wrong with a choice whose members are right each by itself; `None`: nothing.
    pub(super) fn contradiction(&self) -> Option<&'static str> {
        contradiction(self.method, self.band_rings)
    }
}

/// What is wrong with a method and a number of rings for one hole; `None`: nothing.
pub(super) fn contradiction(method: Option<FillMethod>, band_rings: Option<u32>) -> Option<&'static str> {
    let is_vain = band_rings.is_some() && !method.is_none_or(may_fit_a_field);
    is_vain.then_some("`band_rings` needs the method rbf or auto")
}

/// A number of rings, or none.
pub(super) fn rings<'de, D: Deserializer<'de>>(from: D) -> Result<Option<u32>, D::Error> {
    let number = Option::<f64>::deserialize(from)?;
    let rings = number.map(|number| whole_number(number).filter(|&rings| rings <= BAND_RINGS_MAX));
    rings.map(|rings| rings.ok_or_else(|| D::Error::custom("not a number of rings"))).transpose()
}
