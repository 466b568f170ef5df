//! Operators and ranges, as a list of options says them.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;
use utoipa::openapi::schema::{ArrayBuilder, Schema};
use utoipa::openapi::{Ref, RefOr};

use super::names::{EdgeRef, FaceRef, Length, Vector};
use crate::modeller::EventPolicy;
use crate::pipeline::{Edit, RangeName};

/// Most operators, ranges, and faces of one of them.
const LIST_MAX: usize = 1000;

/// A face and how far it moves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct FaceMove {
    /// The face.
    pub face: FaceRef,
    /// How far it moves outward, in millimetres; inward when negative.
    pub by_mm: Length,
}

/// Faces that move together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ShiftSpec {
    /// The faces.
    #[schema(min_items = 1, max_items = 1000)]
    pub faces: Vec<FaceMove>,
    /// Go on past events, with another topology where that is good, instead of being refused. Default: false.
    #[serde(default)]
    pub pass_events: bool,
}

/// A vertex of more than three faces that becomes several because a face moves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct SplitSpec {
    /// A place near the vertex, in the unit of the file.
    pub at: Vector,
    /// The face that moves.
    pub face: FaceRef,
    /// How far it moves outward, in millimetres; inward when negative.
    pub by_mm: Length,
}

/// A face that moves until an edge has no length.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct MergeSpec {
    /// The edge.
    pub edge: EdgeRef,
    /// The face that moves.
    pub face: FaceRef,
}

/// A face that moves until an edge has no length and on, so that the faces at its ends become neighbours.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct FlipSpec {
    /// The edge.
    pub edge: EdgeRef,
    /// The face that moves.
    pub face: FaceRef,
    /// How far it moves outward in all, in millimetres. Default: past the event by half of the way to it, or half of the
    /// way to the next event if that is less.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by_mm: Option<Length>,
}

/// The last operator that is not taken back is taken back.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct UndoSpec {}

/// An operator of the modeller: an object with one member.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum EditSpec {
    /// Move faces along their normals.
    Shift(ShiftSpec),
    /// Split a vertex by moving one of its faces.
    Split(SplitSpec),
    /// Merge the ends of an edge by moving a face.
    Merge(MergeSpec),
    /// Flip an edge by moving a face.
    Flip(FlipSpec),
    /// Take the last operator back.
    Undo(UndoSpec),
}

/// A face and how fast it moves outward.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct FaceRate {
    /// The face.
    pub face: FaceRef,
    /// Its speed, negative inward; the limits of the interval are those of a face of speed 1. Default: 1.
    #[serde(default = "one")]
    pub rate: Length,
}

fn one() -> Length {
    Length(1.0)
}

/// Faces that move together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct TogetherSpec {
    /// The faces.
    #[schema(min_items = 1, max_items = 1000)]
    pub together: Vec<FaceRate>,
}

/// What is to be moved: a face, or faces together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(untagged)]
pub enum RangeSpec {
    /// One face.
    Face(FaceRef),
    /// Faces together.
    Together(TogetherSpec),
}

impl EditSpec {
    fn is_valid(&self) -> bool {
        match self {
            Self::Shift(spec) => (1..=LIST_MAX).contains(&spec.faces.len()),
            _ => true,
        }
    }

    /// The engine's operator. Lengths are divided by `millimetres`, the length of the unit of the file.
    pub(in crate::wire) fn to_engine(&self, millimetres: f64) -> Edit {
        let length = |by: Length| by.0 / millimetres;
        match self {
            Self::Shift(spec) => Edit::Shift {
                faces: spec.faces.iter().map(|m| (m.face.to_engine(), length(m.by_mm))).collect(),
                events: if spec.pass_events { EventPolicy::Pass } else { EventPolicy::Refuse },
            },
            Self::Split(spec) => {
                Edit::Split { at: spec.at.to_engine(), face: spec.face.to_engine(), by: length(spec.by_mm) }
            }
            Self::Merge(spec) => Edit::Merge { edge: spec.edge.to_engine(), face: spec.face.to_engine() },
            Self::Flip(spec) => Edit::Flip {
                edge: spec.edge.to_engine(),
                face: spec.face.to_engine(),
                by: spec.by_mm.map(length),
            },
            Self::Undo(UndoSpec {}) => Edit::Undo,
        }
    }
}

impl RangeSpec {
    fn is_valid(&self) -> bool {
        match self {
            Self::Face(_) => true,
            Self::Together(spec) => (1..=LIST_MAX).contains(&spec.together.len()),
        }
    }

    pub(in crate::wire) fn to_engine(&self) -> RangeName {
        match self {
            Self::Face(face) => vec![(face.to_engine(), 1.0)],
            Self::Together(spec) => {
                spec.together.iter().map(|face| (face.face.to_engine(), face.rate.0)).collect()
            }
        }
    }
}

/// The operators of a JSON list, which may be empty; `None` when it is no such list.
pub(in crate::wire) fn edits_from_json(text: &str) -> Option<Vec<EditSpec>> {
    let edits: Vec<EditSpec> = serde_json::from_str(text).ok()?;
    (edits.len() <= LIST_MAX && edits.iter().all(EditSpec::is_valid)).then_some(edits)
}

/// The ranges of a JSON list, which may be empty; `None` when it is no such list.
pub(in crate::wire) fn ranges_from_json(text: &str) -> Option<Vec<RangeSpec>> {
    let ranges: Vec<RangeSpec> = serde_json::from_str(text).ok()?;
    (ranges.len() <= LIST_MAX && ranges.iter().all(RangeSpec::is_valid)).then_some(ranges)
}

fn list_schema(about: &str, item: &str) -> Schema {
    let items = RefOr::from(Ref::from_schema_name(item));
    Schema::Array(ArrayBuilder::new().description(Some(about)).items(items).max_items(Some(LIST_MAX)).build())
}

/// Schema of a list of operators.
pub(in crate::wire) fn edits_schema(about: &str) -> Schema {
    list_schema(about, &EditSpec::name())
}

/// Schema of a list of ranges.
pub(in crate::wire) fn ranges_schema(about: &str) -> Schema {
    list_schema(about, &RangeSpec::name())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline::FaceName;

    #[test]
    fn operators_name_faces_by_number_by_normal_and_by_ray() {
        let text = r#"[{"shift":{"faces":[{"face":3,"by_mm":0.2},{"face":{"normal":[0,0,1],"at":[1,2,3]},"by_mm":-1}]}},
            {"flip":{"edge":{"faces":[0,{"ray":{"from":[0,0,9],"direction":[0,0,-1]}}]},"face":2}},
            {"merge":{"edge":{"faces":[0,1],"at":[1,1,1]},"face":2.0}},
            {"split":{"at":[0,0,0],"face":1,"by_mm":0.5}},{"undo":{}}]"#;
        let edits = edits_from_json(text).unwrap();
        assert_eq!(edits.len(), 5);
        let Edit::Shift { faces, events } = edits[0].to_engine(10.0) else { panic!("a shift") };
        assert_eq!((faces[0], events), ((FaceName::Id(3), 0.02), EventPolicy::Refuse));
        assert_eq!(edits[4].to_engine(1.0), Edit::Undo);
        assert_eq!(edits_from_json("[]"), Some(vec![]));
        let again: Vec<EditSpec> = serde_json::from_value(serde_json::to_value(&edits).unwrap()).unwrap();
        assert_eq!(again, edits);
    }

    #[test]
    fn ranges_are_of_one_face_or_of_faces_together() {
        let text = r#"[3,{"normal":[1,0,0],"at":[0,0,0]},{"together":[{"face":1},{"face":2,"rate":-1}]}]"#;
        let ranges = ranges_from_json(text).unwrap();
        assert_eq!(ranges[0].to_engine(), [(FaceName::Id(3), 1.0)]);
        assert_eq!(ranges[2].to_engine(), [(FaceName::Id(1), 1.0), (FaceName::Id(2), -1.0)]);
        let again: Vec<RangeSpec> = serde_json::from_value(serde_json::to_value(&ranges).unwrap()).unwrap();
        assert_eq!(again, ranges);
        for text in ["[1.5]", r#"[{"together":[]}]"#, r#"[{"together":[1]}]"#, "3", r#"["3"]"#] {
            assert_eq!(ranges_from_json(text), None, "{text}");
        }
    }

    #[test]
    fn what_says_nothing_is_no_operator() {
        for text in [
            r#"[{"shift":{"faces":[]}}]"#,
            r#"[{"shift":{"faces":[{"face":-1,"by_mm":1}]}}]"#,
            r#"[{"shift":{"faces":[{"face":1}]}}]"#,
            r#"[{"turn":{}}]"#,
            r#"[{"shift":{"faces":[{"face":1,"by_mm":1e31}]}}]"#,
            r#"[{"split":{"at":[0,0],"face":1,"by_mm":1}}]"#,
            r#"[{"undo":{"steps":2}}]"#,
            "{}",
        ] {
            assert_eq!(edits_from_json(text), None, "{text}");
        }
    }
}
