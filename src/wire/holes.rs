//! Holes: which are to be filled and how, as options and plans say it, and what became of each.

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;
use utoipa::openapi::RefOr;
use utoipa::openapi::schema::{
    AdditionalProperties, ArrayBuilder, ObjectBuilder, OneOfBuilder, Schema, Type,
};
use utoipa::{PartialSchema, ToSchema};

use super::finite::finite;
use super::whole_number::whole_number;
use super::words::{FillMethod, HoleClass, HoleFate, Kernel, Rejection};
use crate::implicit::FitFacts;
use crate::pipeline::{self, ELEMENTS_MAX};

/// Most rings of neighbours around a rim that a patch is fitted to.
pub(super) const BAND_RINGS_MAX: u32 = 8;

/// Which holes are filled: all, or those that are listed.
#[derive(Debug, Clone, PartialEq)]
pub enum Holes {
    /// All.
    All,
    /// These alone.
    Listed(Vec<ChosenHole>),
}

/// A hole that is to be filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ChosenHole {
    /// Place among the witnesses of the boundary loops, from 0.
    pub number: u32,
    /// How; `None`: as for all.
    pub method: Option<FillMethod>,
    /// Rings of neighbours around the rim that the patch is fitted to; `None`: as for all.
    pub band_rings: Option<u32>,
}

impl Holes {
    /// The holes that a text says: `all`, or a JSON list of numbers and of objects with `number` and perhaps `method` and
    /// `band_rings`; `None` when it says something else.
    pub(super) fn from_text(text: &str) -> Option<Self> {
        if text == "all" {
            return Some(Self::All);
        }
        let items: Vec<Value> = serde_json::from_str(text).ok()?;
        let holes = items.iter().map(ChosenHole::from_json).collect::<Option<Vec<_>>>()?;
        (1..=ELEMENTS_MAX).contains(&holes.len()).then_some(Self::Listed(holes))
    }

    /// The engine's choice.
    pub(super) fn to_engine(&self) -> Option<Vec<pipeline::ChosenHole>> {
        match self {
            Self::All => None,
            Self::Listed(holes) => Some(holes.iter().map(|hole| hole.to_engine()).collect()),
        }
    }
}

impl ChosenHole {
    fn from_json(value: &Value) -> Option<Self> {
        let number = |value: &Value| {
            let number = whole_number(value.as_f64()?)?;
            ((number as usize) < ELEMENTS_MAX).then_some(number)
        };
        let Some(members) = value.as_object() else {
            return Some(Self { number: number(value)?, method: None, band_rings: None });
        };
        if members.keys().any(|name| !["number", "method", "band_rings"].contains(&name.as_str())) {
            return None;
        }
        let method = match value.get("method").filter(|value| !value.is_null()) {
            Some(word) => Some(FillMethod::from_word(word.as_str()?)?),
            None => None,
        };
        let band_rings = match value.get("band_rings").filter(|value| !value.is_null()) {
            Some(rings) => Some(whole_number(rings.as_f64()?).filter(|&rings| rings <= BAND_RINGS_MAX)?),
            None => None,
        };
        Some(Self { number: number(value.get("number")?)?, method, band_rings })
    }

    /// The engine's choice.
    pub(super) fn to_engine(self) -> pipeline::ChosenHole {
        let Self { number, method, band_rings } = self;
        pipeline::ChosenHole { number, method: method.map(Into::into), band_rings }
    }
}

impl Serialize for Holes {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::All => to.serialize_str("all"),
            Self::Listed(holes) => holes.serialize(to),
        }
    }
}

impl Serialize for ChosenHole {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let Self { number, method, band_rings } = self;
        if method.is_none() && band_rings.is_none() {
            return number.serialize(to);
        }
        let value = serde_json::json!({"number": number, "method": method, "band_rings": band_rings});
        value.serialize(to)
    }
}

impl<'de> Deserialize<'de> for Holes {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let value = Value::deserialize(from)?;
        let text = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
        Self::from_text(&text).ok_or_else(|| D::Error::custom("neither `all` nor a list of holes"))
    }
}

/// True for a method that may fit a field to the rings around a hole.
pub(super) fn may_fit_a_field(method: FillMethod) -> bool {
    matches!(method, FillMethod::Auto | FillMethod::Rbf)
}

/// Schema of the holes to fill.
pub(super) fn holes_schema(about: &str) -> Schema {
    let number = || {
        let last = ELEMENTS_MAX as f64 - 1.0;
        ObjectBuilder::new().schema_type(Type::Integer).minimum(Some(0)).maximum(Some(last))
    };
    let rings =
        ObjectBuilder::new().schema_type(Type::Integer).minimum(Some(0)).maximum(Some(BAND_RINGS_MAX));
    let hole = ObjectBuilder::new()
        .schema_type(Type::Object)
        .property("number", number().description(Some("Place among the witnesses of the boundary loops.")))
        .property("method", FillMethod::schema())
        .property("band_rings", rings.description(Some("Rings of neighbours that the patch is fitted to.")))
        .required("number")
        .additional_properties(Some(AdditionalProperties::FreeForm(false)));
    let item = OneOfBuilder::new().item(number()).item(hole);
    let list = ArrayBuilder::new().items(RefOr::T(Schema::OneOf(item.build()))).min_items(Some(1));
    let all = ObjectBuilder::new().schema_type(Type::String).enum_values(Some(["all"]));
    let either =
        OneOfBuilder::new().description(Some(about)).item(all).item(list.max_items(Some(ELEMENTS_MAX)));
    Schema::OneOf(either.build())
}

impl PartialSchema for Holes {
    fn schema() -> RefOr<Schema> {
        RefOr::T(holes_schema("Which holes are filled."))
    }
}

impl ToSchema for Holes {}

/// What became of one hole: a boundary loop, several that get one patch, or a gap between loops that meet in several vertices.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Hole {
    /// The part that it is in, as its place in `parts` from 0; null: the file was taken as one mesh.
    #[schema(required)]
    pub part: Option<u32>,
    /// Places of its loops among the witnesses of `boundary-loop` when all are listed, from 0; in each part anew.
    pub loops: Vec<u32>,
    /// What the first of them most likely is; null: it does not close.
    #[schema(required)]
    pub class: Option<HoleClass>,
    /// How sure that is, from 0 to 1.
    #[schema(required)]
    pub confidence: Option<f64>,
    /// Edges of the loops.
    pub edges: u64,
    /// What happened.
    pub fate: HoleFate,
    /// The method that was asked for; null: none, the hole stays.
    #[schema(required)]
    pub asked: Option<FillMethod>,
    /// The method whose patch it has; null: it stays open.
    #[schema(required)]
    pub used: Option<FillMethod>,
    /// Patches that were made before and not taken, in their order.
    pub rejected: Vec<RejectedPatch>,
    /// Triangles of the patch.
    pub triangles: u64,
    /// New vertices of the patch.
    pub vertices: u64,
    /// Area of the patch, in square units of the file; null: it has none.
    #[schema(required)]
    pub area: Option<f64>,
    /// The field whose surface the patch is; null: it is of another method, or has no new vertex.
    #[schema(required)]
    pub field: Option<FieldFit>,
}

/// A field of radial functions that was fitted to the surroundings of a hole.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct FieldFit {
    /// The radial function; `thin-plate` also where `cubic` was asked for and did not fit, which `rejected` tells too.
    pub kernel: Kernel,
    /// Points of the band around the hole.
    pub points: u64,
    /// Centres of the system: the points and the offset constraints.
    pub centres: u64,
    /// Degree of the polynomial, 1 or 2.
    pub degree: u32,
    /// The least and the largest distance at which offset constraints fit, over all points, in the unit of the file.
    pub lambda: [f64; 2],
    /// Points at which only nearer offset constraints fit, or none, because another part of the surface is near.
    pub halved: u64,
    /// Those of them at which none fit, because another part of the surface is at them.
    pub without_room: u64,
    /// The largest difference of the field from a value that it should take, over the largest value.
    pub residual: f64,
}

impl From<&FitFacts> for FieldFit {
    fn from(facts: &FitFacts) -> Self {
        Self {
            kernel: facts.kernel.into(),
            points: facts.points as u64,
            centres: facts.centres as u64,
            degree: facts.degree,
            lambda: facts.lambda_range,
            halved: facts.halved as u64,
            without_room: facts.without_room as u64,
            residual: facts.residual,
        }
    }
}

/// A patch that was not taken.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct RejectedPatch {
    /// How it was made.
    pub method: FillMethod,
    /// Why it was not taken.
    pub reason: Rejection,
    /// Near where it meets something, in the unit of the file; null: that was not what was wrong, or not told.
    #[schema(required)]
    pub position: Option<[f64; 3]>,
}

impl From<&pipeline::HoleOutcome> for Hole {
    fn from(inner: &pipeline::HoleOutcome) -> Self {
        let told = inner.told.as_ref();
        let patch = told.filter(|told| told.used.is_some());
        let rejected = |one: &crate::repair::fill::Rejected| RejectedPatch {
            method: one.method.into(),
            reason: one.reason.into(),
            position: one.at.filter(|at| at.is_finite()).map(|at| at.to_array()),
        };
        Self {
            part: inner.part,
            loops: inner.loops.clone(),
            class: inner.guess.map(|guess| guess.class.into()),
            confidence: inner.guess.map(|guess| guess.confidence),
            edges: inner.edges,
            fate: inner.fate.into(),
            asked: told.map(|told| told.asked.into()),
            used: told.and_then(|told| told.used).map(Into::into),
            rejected: inner.rejected.iter().map(rejected).collect(),
            triangles: patch.map_or(0, |told| told.triangles),
            vertices: patch.map_or(0, |told| told.vertices),
            area: patch.and_then(|told| finite(told.area)),
            field: patch.and_then(|told| told.field.as_ref()).map(Into::into),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_or_a_list_of_numbers_and_choices_is_taken_and_nothing_else() {
        assert_eq!(Holes::from_text("all"), Some(Holes::All));
        let flat = ChosenHole { number: 7, method: Some(FillMethod::Flat), band_rings: Some(3) };
        let plain = ChosenHole { number: 0, method: None, band_rings: None };
        let list = r#"[0, {"number": 7, "method": "flat", "band_rings": 3}]"#;
        assert_eq!(Holes::from_text(list), Some(Holes::Listed(vec![plain, flat])));
        for wrong in [
            "",
            "none",
            "[]",
            "{}",
            "3",
            "[-1]",
            "[1.5]",
            "[10000]",
            r#"["0"]"#,
            r#"[{"method":"flat"}]"#,
            r#"[{"number":0,"method":"best"}]"#,
            r#"[{"number":0,"band_rings":9}]"#,
            r#"[{"number":0,"rings":2}]"#,
        ] {
            assert_eq!(Holes::from_text(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn a_choice_is_read_back_as_it_was_written() {
        for text in ["\"all\"", "[3]", r#"[{"band_rings":null,"method":"rbf","number":3},4]"#] {
            let holes: Holes = serde_json::from_str(text).unwrap();
            let written = serde_json::to_string(&holes).unwrap();
            assert_eq!(serde_json::from_str::<Holes>(&written).unwrap(), holes, "{written}");
        }
    }
}
