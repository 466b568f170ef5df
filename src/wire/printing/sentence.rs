//! The outcome of a check in a sentence for people.

use super::words::{CheckCode, Fit, Status};
use crate::printing::{Limit, Printing};

/// What came of the check, lengths in millimetres.
pub(super) fn of(code: CheckCode, status: Option<Status>, printing: &Printing, millimetres: f64) -> String {
    let Some(status) = status else {
        return "This cannot be told, because the mesh is not a valid solid.".to_owned();
    };
    let (figures, policy) = (&printing.figures, &printing.policy);
    let mm = |length: f64| figure(length * millimetres);
    let area = |area: Option<f64>| figure(area.unwrap_or(0.0) * millimetres.powi(2));
    match code {
        CheckCode::Wall => match figures.walls.least() {
            None => "There are no walls with two sides.".to_owned(),
            Some(least) => format!(
                "The thinnest wall is {} mm{}; {} mm\u{b2} are below the limit.",
                mm(least),
                limits(policy.wall, millimetres, "mm", "at least"),
                area(figures.walls.area_below_error.or(figures.walls.area_below_warning)),
            ),
        },
        CheckCode::Gap => match figures.gaps.least() {
            None => "There are no gaps between walls.".to_owned(),
            Some(least) => format!(
                "The narrowest gap is {} mm{}.",
                mm(least),
                limits(policy.gap, millimetres, "mm", "at least")
            ),
        },
        CheckCode::Feature => format!(
            "The longest side of the smallest part is {} mm{}.",
            mm(figures.parts.smallest_side.unwrap_or(0.0)),
            limits(policy.feature, millimetres, "mm", "at least")
        ),
        CheckCode::Overhang => overhang(printing, millimetres),
        CheckCode::SharpEdge => match figures.edges.angle_min {
            None => "There are no edges between two faces.".to_owned(),
            Some(angle) => format!(
                "The sharpest edge has {} degrees{}; edges below the limit: {}.",
                figure(angle),
                limits(policy.sharp_edge, 1.0, "degrees", "at least"),
                figures.edges.sharp_count
            ),
        },
        CheckCode::Cavity => match &figures.parts.cavities {
            Some(cavities) if cavities.count > 0 => format!(
                "Closed cavities: {}, with {} mm\u{b3} that cannot leave.",
                cavities.count,
                figure(cavities.volume * millimetres.powi(3))
            ),
            _ => "Nothing is trapped inside.".to_owned(),
        },
        CheckCode::BuildVolume => build_volume(status, printing, millimetres),
    }
}

fn overhang(printing: &Printing, millimetres: f64) -> String {
    let up = printing.policy.build_direction;
    let placed = printing.figures.overhangs.iter().find(|overhang| overhang.direction == up);
    let limit = figure(printing.figures.overhang_limit);
    match placed.and_then(|overhang| Some((overhang, overhang.angle_min?))) {
        None => format!("No face is flatter than {limit} degrees and hangs over nothing."),
        Some((overhang, angle)) => format!(
            "{} mm\u{b2} are flatter than {limit} degrees and need support; the flattest has {} degrees.",
            figure(overhang.area * millimetres.powi(2)),
            figure(angle)
        ),
    }
}

fn build_volume(status: Status, printing: &Printing, millimetres: f64) -> String {
    let bounds = printing.figures.quote.bounds;
    let size = sides((bounds.max - bounds.min).to_array(), millimetres);
    let volume = printing.policy.build_volume;
    let largest = volume.error.or(volume.warning).map_or_else(String::new, |box_| sides(box_, millimetres));
    match (printing.fit.map(Fit::from), status) {
        (Some(Fit::No), _) => format!("{size} mm do not fit {largest} mm."),
        (Some(Fit::Tilted), _) => format!("{size} mm fit {largest} mm only turned askew."),
        (_, Status::Ok) => format!("{size} mm fit."),
        _ => {
            let smaller = volume.warning.map_or_else(String::new, |box_| sides(box_, millimetres));
            format!("{size} mm fit {largest} mm, but not {smaller} mm.")
        }
    }
}

fn sides(sides: [f64; 3], millimetres: f64) -> String {
    sides.map(|side| figure(side * millimetres)).join(" x ")
}

/// The limits in brackets.
fn limits(limit: Limit, factor: f64, unit: &str, bound: &str) -> String {
    let value = |value: f64| figure(value * factor);
    match (limit.error, limit.warning) {
        (Some(error), Some(warning)) if error != warning => {
            format!(" ({bound} {} {unit}, better {})", value(error), value(warning))
        }
        (Some(limit), _) | (None, Some(limit)) => format!(" ({bound} {} {unit})", value(limit)),
        (None, None) => String::new(),
    }
}

/// A number for people: three decimals at most, without zeros at the end.
pub(super) fn figure(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e9).contains(&value.abs()) {
        return format!("{value:.2e}");
    }
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
