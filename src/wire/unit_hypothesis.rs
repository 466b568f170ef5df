//! Which unit the coordinates of a file may be in, judged by its size. A hypothesis to show to somebody, never a rescale.

use serde::Serialize;
use utoipa::ToSchema;

use super::words::Units;
use crate::geom::Aabb;

/// Longest sides that printed parts have, in millimetres: from a bead to what large-format machines hold.
const PRINTED_MM: std::ops::RangeInclusive<f64> = 2.0..=2000.0;

/// The longest side that the most likely unit comes nearest to, by ratio, where millimetres are not plausible.
const TYPICAL_MM: f64 = 100.0;

/// A guess at the unit of the coordinates. Nothing is rescaled by it.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct UnitHypothesis {
    /// The most likely one: mm where plausible; null: none is plausible.
    #[schema(required)]
    pub unit: Option<Units>,
    /// All units in which the longest side is from 2 mm to 2 m.
    pub plausible: Vec<Units>,
    /// Why, in a sentence.
    pub reason: String,
    /// What to ask whoever made the file; null: the unit is stated, or there is little doubt.
    #[schema(required)]
    pub question: Option<String>,
}

/// Units that files without one are made in.
const GUESSED: [Units; 4] = [Units::Millimetre, Units::Centimetre, Units::Metre, Units::Inch];

impl UnitHypothesis {
    /// A guess from the box around a mesh; `None` without a size.
    pub(super) fn of(bounds: Aabb) -> Option<Self> {
        let longest = (bounds.max - bounds.min).max_element();
        if !(longest.is_normal() && longest > 0.0) {
            return None;
        }
        let in_mm = |unit: &Units| longest * unit.millimetres();
        let plausible: Vec<Units> =
            GUESSED.iter().copied().filter(|unit| PRINTED_MM.contains(&in_mm(unit))).collect();
        let oddity = |unit: &&Units| oddity(in_mm(unit));
        let unit = if plausible.contains(&Units::Millimetre) {
            Some(Units::Millimetre)
        } else {
            plausible.iter().min_by(|a, b| oddity(a).total_cmp(&oddity(b))).copied()
        };
        let as_mm = in_mm(&Units::Millimetre);
        let reason = match unit {
            Some(Units::Millimetre) => {
                format!("As millimetres the longest side is {} mm, a size that is printed.", figure(as_mm))
            }
            Some(unit) => format!(
                "As millimetres the longest side would be {} mm, too {} to print; as {} it would be {} mm.",
                figure(as_mm),
                if as_mm < *PRINTED_MM.start() { "small" } else { "large" },
                name(unit),
                figure(in_mm(&unit)),
            ),
            None => format!(
                "The longest side is {} units, which is no size of a print in mm, cm, m or in.",
                figure(longest)
            ),
        };
        let question = is_doubtful(longest, &plausible).then(|| question(longest, &plausible));
        Some(Self { unit, plausible, reason, question })
    }

    /// Without the question where nobody is to be asked.
    pub(super) fn asking(self, asks: bool) -> Self {
        Self { question: self.question.filter(|_| asks), ..self }
    }
}

/// How many times as large or small as is typical.
fn oddity(longest_mm: f64) -> f64 {
    let ratio = longest_mm / TYPICAL_MM;
    ratio.max(1.0 / ratio)
}

/// Sizes in millimetres up to this many times smaller or larger than typical ones are not asked about: 20 mm to 500 mm.
const USUAL: f64 = 5.0;

/// True when the size is unusual in millimetres, and more usual in another unit.
fn is_doubtful(longest: f64, plausible: &[Units]) -> bool {
    let in_mm = oddity(longest);
    in_mm > USUAL && plausible.iter().any(|unit| oddity(longest * unit.millimetres()) < in_mm)
}

fn question(longest: f64, plausible: &[Units]) -> String {
    let sizes: Vec<String> = plausible
        .iter()
        .map(|&unit| match unit {
            Units::Millimetre => format!("{} mm", figure(longest)),
            unit => format!("{} mm (if the unit is {unit})", figure(longest * unit.millimetres())),
        })
        .collect();
    format!(
        "No unit is stated: is the longest side {}? Say so with `units`; without it the file is taken in millimetres.",
        sizes.join(" or ")
    )
}

fn name(unit: Units) -> &'static str {
    match unit {
        Units::Micrometre => "micrometres",
        Units::Millimetre => "millimetres",
        Units::Centimetre => "centimetres",
        Units::Metre => "metres",
        Units::Inch => "inches",
        Units::Foot => "feet",
    }
}

/// Three digits.
fn figure(value: f64) -> String {
    let short: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    if (1e-3..1e6).contains(&short) { format!("{short}") } else { format!("{short:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;

    fn of(longest: f64) -> Option<UnitHypothesis> {
        UnitHypothesis::of(Aabb { min: DVec3::ZERO, max: DVec3::new(longest / 2.0, longest, 0.0) })
    }

    #[test]
    fn millimetres_are_taken_where_they_are_plausible_and_the_most_usual_size_elsewhere() {
        assert_eq!(of(50.0).unwrap().unit, Some(Units::Millimetre));
        let small = of(0.12).unwrap();
        assert_eq!((small.unit, small.plausible), (Some(Units::Metre), vec![Units::Metre, Units::Inch]));
        assert!(
            small.reason.contains("0.12 mm, too small to print; as metres it would be 120 mm"),
            "{}",
            small.reason
        );
        assert_eq!(of(1.5).unwrap().unit, Some(Units::Inch));
    }

    #[test]
    fn an_unusual_size_is_asked_about_and_a_usual_one_is_not() {
        let asked = of(5.0).unwrap().question.unwrap();
        assert!(asked.contains("5 mm or 50 mm (if the unit is cm) or 127 mm (if the unit is in)"), "{asked}");
        assert_eq!(of(5.0).unwrap().asking(false).question, None);
        assert_eq!(of(80.0).unwrap().question, None);
        assert!(of(0.12).unwrap().question.is_some(), "too small to print in millimetres");
        assert_eq!(of(1e9).unwrap().question, None);
    }

    #[test]
    fn what_is_no_size_of_a_print_in_any_unit_has_no_unit() {
        for longest in [1e-9, 1e9, 1e300] {
            let told = of(longest).unwrap();
            assert_eq!((told.unit, told.plausible), (None, Vec::new()));
        }
        assert_eq!(of(0.0), None);
        assert_eq!(UnitHypothesis::of(Aabb::EMPTY), None);
    }
}
