//! Names of faces and edges, as a list of options says them.

use serde::{Deserialize, Deserializer, Serialize};
use utoipa::openapi::RefOr;
use utoipa::openapi::schema::{ArrayBuilder, ObjectBuilder, Schema, Type};
use utoipa::{PartialSchema, ToSchema};

use crate::geom::DVec3;
use crate::pipeline::{EdgeName, FaceName};
use crate::wire::whole_number::whole;

/// Largest coordinate or length.
const LENGTH_MAX: f64 = 1e30;

/// A length that may be negative.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Length(pub f64);

/// Three coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Vector(pub [f64; 3]);

fn in_range<E: serde::de::Error>(number: f64) -> Result<f64, E> {
    if number.abs() <= LENGTH_MAX { Ok(number) } else { Err(E::custom("a number beyond 1e30")) }
}

impl<'de> Deserialize<'de> for Length {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        Ok(Self(in_range(f64::deserialize(from)?)?))
    }
}

impl<'de> Deserialize<'de> for Vector {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let [x, y, z] = <[f64; 3]>::deserialize(from)?;
        Ok(Self([in_range(x)?, in_range(y)?, in_range(z)?]))
    }
}

fn number() -> ObjectBuilder {
    ObjectBuilder::new().schema_type(Type::Number).minimum(Some(-LENGTH_MAX)).maximum(Some(LENGTH_MAX))
}

impl PartialSchema for Length {
    fn schema() -> RefOr<Schema> {
        RefOr::T(Schema::Object(number().description(Some("A length that may be negative.")).build()))
    }
}

impl ToSchema for Length {}

impl PartialSchema for Vector {
    fn schema() -> RefOr<Schema> {
        let list = ArrayBuilder::new().items(number()).min_items(Some(3)).max_items(Some(3));
        RefOr::T(Schema::Array(list.description(Some("Three coordinates.")).build()))
    }
}

impl ToSchema for Vector {}

/// A face: its number in the report, its normal and a place on it, or a ray that meets it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(untagged)]
pub enum FaceRef {
    /// The number of the face, from 0.
    Id(#[serde(deserialize_with = "whole")] u32),
    /// The face with the nearest normal, and of those the nearest to a place.
    Normal(FaceByNormal),
    /// The first face that a ray meets from outside.
    Ray(FaceByRay),
}

/// The face with the nearest normal, and of those the nearest to a place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct FaceByNormal {
    /// The direction, of any length but 0.
    pub normal: Vector,
    /// The place, in the unit of the file.
    pub at: Vector,
}

/// The first face that a ray meets from outside.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct FaceByRay {
    /// The ray.
    pub ray: PickingRay,
}

/// A ray, in the unit of the file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct PickingRay {
    /// Where it starts.
    pub from: Vector,
    /// Where it goes, of any length but 0.
    pub direction: Vector,
}

/// An edge, by the faces beside it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct EdgeRef {
    /// The faces.
    #[schema(min_items = 2, max_items = 2)]
    pub faces: [FaceRef; 2],
    /// A place near the edge, in the unit of the file, where the faces share several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<Vector>,
}

impl Vector {
    pub(super) fn to_engine(self) -> DVec3 {
        DVec3::from_array(self.0)
    }
}

impl FaceRef {
    pub(super) fn to_engine(&self) -> FaceName {
        match self {
            Self::Id(id) => FaceName::Id(*id),
            Self::Normal(by) => FaceName::Normal { normal: by.normal.to_engine(), at: by.at.to_engine() },
            Self::Ray(by) => {
                FaceName::Ray { from: by.ray.from.to_engine(), direction: by.ray.direction.to_engine() }
            }
        }
    }
}

impl EdgeRef {
    pub(super) fn to_engine(&self) -> EdgeName {
        EdgeName {
            faces: [self.faces[0].to_engine(), self.faces[1].to_engine()],
            at: self.at.map(Vector::to_engine),
        }
    }
}
