//! The second word of a verdict: how true the result is to the file, and what it changed.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::finite::finite;
use super::words::{ChangeKind, Fidelity, Units};
use crate::figures::significant;
use crate::pipeline;

/// A bound of faithful results that a result exceeds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct FidelityChange {
    /// What was measured.
    pub reason: ChangeKind,
    /// How much of it.
    #[schema(required)]
    pub measured: Option<f64>,
    /// How much a faithful result may have.
    #[schema(required)]
    pub limit: Option<f64>,
    /// The same in a sentence.
    pub message: String,
}

impl FidelityChange {
    /// `unit`: that of the file.
    pub(super) fn new(inner: &pipeline::FidelityChange, unit: Units) -> Self {
        let reason = ChangeKind::from(inner.kind);
        let percent = |share: f64| format!("{} %", short(share * 100.0));
        let (measured, limit) = (inner.measured, inner.limit);
        let message = match reason {
            ChangeKind::Lost => format!(
                "{} of the visible surface is lost (faithful: at most {})",
                percent(measured),
                percent(limit)
            ),
            ChangeKind::Invented => format!(
                "{} of the surface is invented (faithful: at most {})",
                percent(measured),
                percent(limit)
            ),
            ChangeKind::Moved => format!(
                "up to {} {unit} from the file (faithful: at most {} {unit})",
                short(measured),
                short(limit)
            ),
            ChangeKind::Bodies => format!("bodies lost: {measured}"),
            ChangeKind::Volume => {
                format!("the volume changed by {} (faithful: at most {})", percent(measured), percent(limit))
            }
        };
        Self { reason, measured: finite(measured), limit: finite(limit), message }
    }
}

/// The word and what was changed; without a result neither.
pub(super) fn fidelity_of(
    inner: Option<&pipeline::FidelityVerdict>,
    unit: Units,
) -> (Option<Fidelity>, Vec<FidelityChange>) {
    let changes = inner.map_or(&[][..], |inner| &inner.changes);
    let word = inner.map(|inner| Fidelity::from(inner.word));
    (word, changes.iter().map(|change| FidelityChange::new(change, unit)).collect())
}

/// A figure of a headline.
fn short(value: f64) -> String {
    significant(value, 3)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline::ChangeKind as Kind;

    #[test]
    fn a_change_says_how_much_and_how_much_may_be() {
        let message = |kind, measured, limit| {
            FidelityChange::new(&pipeline::FidelityChange { kind, measured, limit }, Units::Millimetre)
                .message
        };
        assert_eq!(
            message(Kind::Lost, 0.03512, 0.01),
            "3.51 % of the visible surface is lost (faithful: at most 1 %)"
        );
        assert_eq!(
            message(Kind::Moved, 75.04, 1.7320508),
            "up to 75 mm from the file (faithful: at most 1.73 mm)"
        );
        assert_eq!(message(Kind::Bodies, 2.0, 0.0), "bodies lost: 2");
    }
}
