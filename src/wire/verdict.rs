//! The conclusion of a report, with its reasons.

use serde::Serialize;
use utoipa::ToSchema;

use super::fidelity::{FidelityChange, fidelity_of};
use super::printing::CheckCode;
use super::words::{Condition, Fidelity, Outcome, ReasonCode, Units};
use crate::figures::figure;
use crate::{certificate as judge, pipeline, printing};

/// The conclusion.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Verdict {
    /// The result (without one: the input) is a valid solid.
    pub printable: bool,
    /// What became of the file; null: the operation returns no file.
    #[schema(required)]
    pub outcome: Option<Outcome>,
    /// How true the result is to the file; null: there is no result.
    #[schema(required)]
    pub fidelity: Option<Fidelity>,
    /// What the result changed, bodies and loss first; empty unless `fidelity` is `changed`.
    pub changes: Vec<FidelityChange>,
    /// P3: it can be made with the process that `policy` names; null: none is named, or it cannot be told.
    #[schema(required)]
    pub p3_holds: Option<bool>,
    /// Checks of that policy that are errors.
    pub p3_breaches: Vec<CheckCode>,
    /// Why it is not printable or was refused; empty otherwise.
    pub reasons: Vec<Reason>,
}

/// Why a verdict is as it is.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct Reason {
    /// What kind of reason.
    pub code: ReasonCode,
    /// The condition that does not hold; null: the reason is another one.
    #[schema(required)]
    pub condition: Option<Condition>,
    /// The reason in a sentence.
    pub message: String,
}

impl Verdict {
    pub(super) fn of(inner: &pipeline::Report) -> Self {
        let judged = inner.certificate.as_ref().unwrap_or(&inner.input_certificate);
        let refusal = inner.refusal.iter().map(|refusal| Reason::of(refusal, inner.input.result_units));
        let printing = inner.printing.as_ref().map(|measured| &measured.printing);
        let checks = printing.map_or(&[][..], |printing| &printing.checks);
        let broken = checks.iter().filter(|check| check.status == Some(printing::Status::Error));
        let (fidelity, changes) = fidelity_of(inner.fidelity.as_ref(), inner.input.result_units.into());
        Self {
            printable: judged.is_printable(),
            outcome: inner.outcome.map(Outcome::from),
            fidelity: fidelity.filter(|_| inner.certificate.is_some()),
            changes,
            p3_holds: printing.and_then(printing::Printing::holds),
            p3_breaches: broken.map(|check| check.code.into()).collect(),
            reasons: refusal.chain(broken_conditions(judged)).collect(),
        }
    }
}

/// One reason for each condition of which `judged` holds a witness, in the order of the conditions.
fn broken_conditions(judged: &judge::Certificate) -> Vec<Reason> {
    let mut firsts: Vec<&judge::Violation> = Vec::new();
    for violation in &judged.witnesses {
        if firsts.iter().all(|first| first.condition != violation.condition) {
            firsts.push(violation);
        }
    }
    let reason = |violation: &judge::Violation| Reason {
        code: ReasonCode::ConditionBroken,
        condition: Some(violation.condition.into()),
        message: sentence(violation),
    };
    firsts.into_iter().map(reason).collect()
}

impl Reason {
    /// `units`: that of the result, in which the refusal has its lengths.
    pub(super) fn of(refusal: &pipeline::Refusal, units: pipeline::Units) -> Self {
        let (code, condition, message) = match refusal {
            pipeline::Refusal::NothingToRepair => (
                ReasonCode::NothingToRepair,
                None,
                "there is no finite triangle with three distinct corners off one line".to_owned(),
            ),
            pipeline::Refusal::OverBudget { units } => (
                ReasonCode::OverBudget,
                None,
                format!(
                    "no valid solid was found in the {units} units of work that a file of this size may take"
                ),
            ),
            pipeline::Refusal::NotRepairable { witness } => (
                ReasonCode::NotRepairable,
                witness.as_ref().map(|violation| violation.condition.into()),
                match witness {
                    Some(violation) => {
                        format!("the result is no valid solid: {}", sentence(violation))
                    }
                    None => "the result is no valid solid".to_owned(),
                },
            ),
            &pipeline::Refusal::BeyondFloat32 { pitch, diagonal } => (
                ReasonCode::NotRepresentable,
                None,
                format!(
                    "the mesh must be rebuilt, but coordinates of float32 are {} apart there: too coarse for \
                     a part with a diagonal of {}; move it to the origin, or set `recenter=true`",
                    figure(pitch),
                    figure(diagonal)
                ),
            ),
            &pipeline::Refusal::DeviationBeyondLimit { deviation, found, limit } => {
                let [deviation, found, limit] =
                    [deviation, found, limit].map(|length| length * units.millimetres());
                (ReasonCode::LimitExceeded, None, too_far(deviation, found, limit))
            }
            pipeline::Refusal::VolumeChangeBeyondLimit { change, limit } => (
                ReasonCode::LimitExceeded,
                None,
                format!(
                    "the closest valid result changes the volume by {:.2} %; `max_volume_change` allows {:.2} %",
                    change * 100.0,
                    limit * 100.0
                ),
            ),
            pipeline::Refusal::NotFaithful { changes, units } => {
                let unit = Units::from(*units);
                let told: Vec<_> =
                    changes.iter().map(|change| FidelityChange::new(change, unit).message).collect();
                (
                    ReasonCode::NotFaithful,
                    None,
                    format!("the closest valid result is not faithful to the file: {}", told.join("; ")),
                )
            }
            pipeline::Refusal::Modeller { reason, units } => {
                let code = match **reason {
                    pipeline::ModellerRefusal::Import(_) => ReasonCode::NotAPolyhedron,
                    pipeline::ModellerRefusal::Export(_) => ReasonCode::NotRepresentable,
                    _ => ReasonCode::OperatorRefused,
                };
                (code, None, super::modeller::sentence(reason, Units::from(*units).millimetres()))
            }
            pipeline::Refusal::Boolean { reason } => {
                let (code, message) = super::boolean::told(reason);
                (code, None, message)
            }
            pipeline::Refusal::NotRepresentable { reason } => {
                (ReasonCode::NotRepresentable, None, reason.to_string())
            }
        };
        Self { code, condition, message }
    }
}

/// What a result is farther away than, in millimetres: it is at least `found` and at most `deviation` away, and may be `limit`.
fn too_far(deviation: f64, found: f64, limit: f64) -> String {
    let [at_most, at_least, allowed] = [deviation, found, limit].map(figure);
    if found > limit {
        return format!(
            "the closest valid result is up to {at_most} mm from the file; `max_deviation_mm` allows {allowed} mm"
        );
    }
    let at_least = if found > 0.0 { format!(" and at least {at_least} mm") } else { String::new() };
    format!(
        "the closest valid result is at most {at_most} mm from the file{at_least}; that it keeps the {allowed} mm of \
         `max_deviation_mm` is not certain"
    )
}

/// A violation in a sentence, with its place.
fn sentence(violation: &judge::Violation) -> String {
    let what = match violation.condition {
        judge::Condition::Usable => "a face or coordinate cannot be used",
        judge::Condition::NonDegenerate => "a triangle is degenerate",
        judge::Condition::Distinct => "two triangles have the same three vertices",
        judge::Condition::TwoTrianglesPerEdge => "an edge does not have exactly two triangles",
        judge::Condition::OppositeDirections => {
            "the two triangles of an edge run through it in one direction"
        }
        judge::Condition::OneFanPerVertex => "the triangles of a vertex form more than one fan",
        judge::Condition::Embedded => "two triangles meet beyond a common vertex or edge",
        judge::Condition::NotEmpty => "there is no triangle",
        judge::Condition::Alternating => "a shell is inverted or nested wrongly",
    };
    let faces = match violation.faces.as_slice() {
        [] => String::new(),
        [face] => format!(" (face {face})"),
        faces => format!(" (faces {})", faces.iter().map(u32::to_string).collect::<Vec<_>>().join(", ")),
    };
    format!("{what}{faces}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(deviation: f64, found: f64, limit: f64, units: pipeline::Units) -> String {
        Reason::of(&pipeline::Refusal::DeviationBeyondLimit { deviation, found, limit }, units).message
    }

    #[test]
    fn a_deviation_and_its_limit_are_told_in_millimetres_whatever_the_unit() {
        let inch = told(0.75, 0.74, 0.5 / 25.4, pipeline::Units::Inch);
        assert_eq!(
            inch,
            "the closest valid result is up to 19.05 mm from the file; `max_deviation_mm` allows 0.5 mm"
        );
        let metre = told(0.002, 0.002, 0.001, pipeline::Units::Metre);
        assert!(metre.contains("up to 2 mm") && metre.ends_with("allows 1 mm"), "{metre}");
    }

    #[test]
    fn a_distance_whose_bounds_lie_around_the_limit_is_not_called_farther() {
        let text = told(0.505, 0.499, 0.5, pipeline::Units::Millimetre);
        assert_eq!(
            text,
            "the closest valid result is at most 0.505 mm from the file and at least 0.499 mm; \
             that it keeps the 0.5 mm of `max_deviation_mm` is not certain"
        );
        let unknown = told(0.505, 0.0, 0.5, pipeline::Units::Millimetre);
        assert!(
            unknown.starts_with("the closest valid result is at most 0.505 mm from the file; "),
            "{unknown}"
        );
    }
}
