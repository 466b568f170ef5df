//! Why the modeller has no result, in a sentence and in figures.

use serde::Serialize;
use utoipa::ToSchema;

use super::blocker::{Blocker, MovedFace};
use super::words::OperatorReason;
use crate::mesh::polyhedron::FaceId;
use crate::modeller::{DualRefusal, ExportRefusal, ImportRefusal, OperatorRefusal, Rule};
use crate::pipeline::{ModellerRefusal, NameFault};

/// An operator that was refused.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct RefusedOperator {
    /// Its place in the list, from 0.
    pub operator: u64,
    /// The kind of reason.
    pub reason: OperatorReason,
    /// How far the faces may move at most: they must stay inside. Empty where there is no such limit.
    pub limits: Vec<MovedFace>,
    /// What is in the way.
    pub blocking: Vec<Blocker>,
}

impl RefusedOperator {
    pub(super) fn of(refusal: &ModellerRefusal, millimetres: f64) -> Option<Self> {
        let plain = |operator: usize, reason: OperatorReason| Self {
            operator: operator as u64,
            reason,
            limits: Vec::new(),
            blocking: Vec::new(),
        };
        match refusal {
            ModellerRefusal::Operator { operator, reason, limits, blocking } => Some(Self {
                limits: limits.iter().map(|m| MovedFace::of(*m, millimetres)).collect(),
                blocking: blocking.iter().map(Blocker::from).collect(),
                ..plain(*operator, reason.into())
            }),
            ModellerRefusal::Name { operator: Some(operator), .. } => {
                Some(plain(*operator, OperatorReason::UnknownElement))
            }
            ModellerRefusal::NothingToUndo { operator } => {
                Some(plain(*operator, OperatorReason::NothingToUndo))
            }
            _ => None,
        }
    }
}

/// The refusal in a sentence; `millimetres`: length of the unit of the result.
pub(in crate::wire) fn sentence(refusal: &ModellerRefusal, millimetres: f64) -> String {
    match refusal {
        ModellerRefusal::Import(reason) => {
            format!("the mesh cannot be read as a polyhedron: {}", import(reason))
        }
        ModellerRefusal::Name { operator: Some(k), fault } => {
            format!("operator {k} names {}", misnamed(*fault))
        }
        ModellerRefusal::Name { operator: None, fault } => format!("`ranges` names {}", misnamed(*fault)),
        ModellerRefusal::NothingToUndo { operator } => {
            format!("operator {operator} takes an operator back, and there is none left")
        }
        ModellerRefusal::Operator { operator, reason, limits, blocking } => {
            format!("operator {operator} is refused: {}", because(reason, limits, blocking, millimetres))
        }
        ModellerRefusal::Export(reason) => {
            format!("the polyhedron cannot be rounded to float32: {}", export(*reason))
        }
        ModellerRefusal::Dual(DualRefusal::PlaneThroughOrigin { face }) => {
            format!(
                "the plane of face {} passes through the origin and has no pole; `dual_recenter=true` takes the \
                 middle of the part as the origin",
                face.index()
            )
        }
        ModellerRefusal::Dual(DualRefusal::InteriorLoops { face }) => {
            format!("face {} has interior loops, so the polyhedron has no dual", face.index())
        }
    }
}

fn misnamed(fault: NameFault) -> String {
    match fault {
        NameFault::NoFace(id) => format!("face {id}, which the polyhedron does not have"),
        NameFault::NoFaces => "a face that the polyhedron does not have".to_owned(),
        NameFault::NoNormal => "a face by a normal that is zero and so has no direction".to_owned(),
        NameFault::NoDirection => "a face by a ray whose direction is zero".to_owned(),
        NameFault::RayMisses => "a face by a ray that meets no face from outside".to_owned(),
        NameFault::NoEdge([a, b]) => {
            format!("an edge between faces {a} and {b}, which have none in common")
        }
        NameFault::NoVertex => "a vertex that the polyhedron does not have".to_owned(),
        NameFault::FaceTwice(id) => format!("face {id} twice: each face once, with the whole distance"),
        NameFault::NoOperator => "an operator that is none".to_owned(),
    }
}

/// How far a face may move: between where it is and a limit that it must not reach.
fn within(distance: f64) -> String {
    match distance {
        d if d < 0.0 => format!("by more than {d} mm and less than 0 mm"),
        d if d > 0.0 => format!("by more than 0 mm and less than {d} mm"),
        _ => "not at all in this direction".to_owned(),
    }
}

fn import(refusal: &ImportRefusal) -> String {
    match refusal {
        ImportRefusal::Empty => "it has no triangle".to_owned(),
        ImportRefusal::DegenerateTriangle { triangle } => {
            format!("triangle {triangle} has its corners on one line; repair the mesh first")
        }
        ImportRefusal::NotClosed(fault) => format!("{fault}; repair the mesh first"),
        ImportRefusal::ExponentSpan { span } => format!("its coordinates span {span} powers of two"),
        ImportRefusal::VertexNotOnPlanes { position: p } => {
            format!("the planes around the vertex at {}, {}, {} do not meet in one point", p.x, p.y, p.z)
        }
        ImportRefusal::Invalid(validity) => match validity.faults.first() {
            Some(fault) if fault.rule == Rule::OneVolume => format!(
                "it is not one body with its cavities, for the shell of {}; repair the mesh first where it is inside out, or give each \
                 body a file of its own",
                named("face", &fault.faces)
            ),
            Some(fault) => format!(
                "the rule `{}` is broken at {}; repair the mesh first",
                fault.rule.name(),
                named("face", &fault.faces)
            ),
            None => "it is not valid".to_owned(),
        },
    }
}

fn export(refusal: ExportRefusal) -> String {
    match refusal {
        ExportRefusal::FaceFolds { face } => {
            format!("the rounded corners of face {} fold it over", face.index())
        }
        ExportRefusal::BeyondFloat32 { vertex } => format!("vertex {} is beyond its range", vertex.index()),
        ExportRefusal::FaceTooLarge { face, limit } => {
            format!("face {} has more than {limit} corners", face.index())
        }
    }
}

fn named(what: &str, faces: &[FaceId]) -> String {
    let numbers: Vec<String> = faces.iter().map(|f| f.index().to_string()).collect();
    format!("{what}{} {}", if numbers.len() == 1 { "" } else { "s" }, numbers.join(", "))
}

/// The twelve digits of a calculated length that its rounding leaves.
fn without_rounding(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

fn because(
    refusal: &OperatorRefusal,
    limits: &[(u32, f64)],
    blocking: &[crate::pipeline::Blocker],
    millimetres: f64,
) -> String {
    match refusal {
        OperatorRefusal::NothingMoves => "no face moves".to_owned(),
        OperatorRefusal::Limit { .. } => {
            let limits: Vec<String> = limits
                .iter()
                .map(|(f, distance)| format!("face {f} {}", within(without_rounding(distance * millimetres))))
                .collect();
            let meeting = blocking.first().map(|b| format!("; there {}", Blocker::from(b).sentence()));
            format!("an event is in the way: move {}{}", limits.join(", "), meeting.unwrap_or_default())
        }
        OperatorRefusal::NoSplit { faces, .. } => format!(
            "the vertex of the {} has no split for this direction that opens every new edge and keeps its faces apart",
            named("face", faces)
        ),
        OperatorRefusal::FaceVanishes { face } => {
            format!("face {} would shrink to a segment or a point", face.index())
        }
        OperatorRefusal::LinkNotADisk { face } => {
            format!("face {} would touch itself at the merged vertex", face.index())
        }
        OperatorRefusal::VertexIsTrihedral { .. } => "the vertex has three faces only".to_owned(),
        OperatorRefusal::NotThere { face } => {
            format!("face {} is not at the vertex or edge that is named", face.index())
        }
        OperatorRefusal::EdgeStays => {
            "the edge never loses its length, however far the face moves".to_owned()
        }
        OperatorRefusal::EndsAreOneFace { face } => {
            format!("both ends of the edge are on face {}", face.index())
        }
        OperatorRefusal::EndsAreNeighbours { faces } => {
            format!("the {} at the ends of the edge have an edge there already", named("face", faces))
        }
        OperatorRefusal::FaceHasThreeSides { face } => {
            format!("face {} has three sides, which vanish together: a merge, no flip", face.index())
        }
        OperatorRefusal::DoesNotOpen { faces } => {
            format!("the flipped edge between the {} would have no positive length", named("face", faces))
        }
        OperatorRefusal::SeveralVanish { count } => {
            format!("{count} edges lose their lengths at the same time")
        }
        OperatorRefusal::TooManyEvents { limit } => format!("more than {limit} events are in the way"),
        OperatorRefusal::Invalid(fault) => {
            format!("the rule `{}` would be broken at {}", fault.rule.name(), named("face", &fault.faces))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_inward_is_told_as_an_interval_of_numbers() {
        assert_eq!(within(-30.0), "by more than -30 mm and less than 0 mm");
        assert_eq!(within(2.5), "by more than 0 mm and less than 2.5 mm");
        assert_eq!(within(0.0), "not at all in this direction");
    }

    #[test]
    fn a_name_that_names_nothing_is_told_with_what_is_wrong() {
        for (fault, said) in [
            (NameFault::NoFace(9), "face 9, which the polyhedron does not have"),
            (NameFault::NoNormal, "a normal that is zero"),
            (NameFault::RayMisses, "a ray that meets no face"),
            (NameFault::FaceTwice(3), "face 3 twice"),
        ] {
            let refusal = ModellerRefusal::Name { operator: Some(1), fault };
            let told = sentence(&refusal, 1.0);
            assert!(told.starts_with("operator 1 names ") && told.contains(said), "{told}");
        }
    }

    #[test]
    fn lengths_are_told_without_the_last_digits_that_rounding_leaves() {
        assert_eq!(without_rounding(0.1 + 0.2), 0.3);
        assert_eq!(without_rounding(-1.0 / 3.0), -0.333_333_333_333);
        assert_eq!(without_rounding(0.0), 0.0);
    }
}
