//! Figures against the limits of a process.

use super::{BuildDirection, BuildVolume, Figures, Limit, PrintingPolicy, PrintingWitness, Thickness};
use crate::geom::DVec3;

/// What is checked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CheckCode {
    /// Walls are thick enough. Measured: the thinnest.
    Wall,
    /// Gaps between walls are wide enough. Measured: the narrowest.
    Gap,
    /// Parts of their own are large enough. Measured: the longest side of the smallest.
    Feature,
    /// Faces that look down are steep enough. Measured: the smallest angle from the horizontal, in degrees.
    Overhang,
    /// Edges are blunt enough. Measured: the smallest angle of material, in degrees.
    SharpEdge,
    /// Nothing is trapped inside. Measured: the number of cavities.
    Cavity,
    /// The part fits the machine. Measured: its size as a share of the largest box, 1 when it just fits.
    BuildVolume,
}

/// How a figure stands to its limits, the worst last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Status {
    /// Within both.
    Ok,
    /// Beyond the limit of a warning.
    Warning,
    /// Beyond the limit of an error.
    Error,
}

/// How a part fits a box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Fit {
    /// With the build direction up, turned about it by a quarter at most.
    AsPlaced,
    /// With its sides along those of the box in another way.
    Turned,
    /// Only turned askew, by the small box around it.
    Tilted,
    /// In none of these ways.
    No,
}

/// One check.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    /// What was checked.
    pub code: CheckCode,
    /// What came of it; `None`: it cannot be told, because the mesh is not a valid solid.
    pub status: Option<Status>,
    /// The figure that decides; `None`: there is nothing to measure.
    pub measured: Option<f64>,
    /// Its limits.
    pub limit: Limit,
    /// Where the mesh goes beyond them.
    pub witnesses: Vec<PrintingWitness>,
}

/// Every check for which the policy has a limit.
pub(super) fn checks(
    figures: &Figures,
    policy: &PrintingPolicy,
    overhangs: Vec<PrintingWitness>,
) -> Vec<Check> {
    let parts = &figures.parts;
    let all = [
        thin(CheckCode::Wall, &figures.walls, policy.wall, figures.quote.area),
        thin(CheckCode::Gap, &figures.gaps, policy.gap, figures.quote.area),
        below(CheckCode::Feature, parts.smallest_side, policy.feature, parts.small.clone()),
        below(CheckCode::Overhang, overhang_angle(figures, policy), policy.overhang, overhangs),
        below(
            CheckCode::SharpEdge,
            figures.edges.angle_min,
            policy.sharp_edge,
            figures.edges.witnesses.clone(),
        ),
        cavity(figures, policy.cavities),
    ];
    let limited = all.into_iter().filter(|check| check.limit != Limit::default());
    limited.chain(build_volume(figures, policy)).collect()
}

fn overhang_angle(figures: &Figures, policy: &PrintingPolicy) -> Option<f64> {
    let placed = figures.overhangs.iter().find(|overhang| overhang.direction == policy.build_direction);
    placed.and_then(|overhang| overhang.angle_min)
}

/// A figure that may not be small.
fn below(code: CheckCode, measured: Option<f64>, limit: Limit, witnesses: Vec<PrintingWitness>) -> Check {
    let is_below =
        |bound: Option<f64>| matches!((measured, bound), (Some(m), Some(b)) if m < b * (1.0 - ROUNDING));
    let status = status(is_below(limit.warning), is_below(limit.error));
    let witnesses = if status == Status::Ok { Vec::new() } else { witnesses };
    Check { code, status: Some(status), measured, limit, witnesses }
}

/// What measures are rounded by at most, as a share of them: a wall as thick as the limit is not below it.
const ROUNDING: f64 = 1e-9;

/// Area of what is too thin, as a multiple of the square of the limit, up to which it is no more than a tip: that of a
/// cone with an angle of 30 degrees is 3 where it is below the limit. Sharper ones are pins.
const TIP_AREA: f64 = 4.0;

/// Share of the whole surface beyond which too thin is no tip either, however small the part.
const TIP_SHARE: f64 = 0.05;

/// A wall or gap. Tips run out to nothing, and printers round them: what is too thin is an error only where its area is
/// larger than that of a tip, which is a small share of a part.
fn thin(code: CheckCode, thickness: &Thickness, limit: Limit, area_of_all: f64) -> Check {
    let check = below(code, thickness.least(), limit, thickness.witnesses.clone());
    let is_tip = |area: f64, b: f64| area <= TIP_AREA * b * b && area <= TIP_SHARE * area_of_all;
    let is_small =
        thickness.area_below_error.zip(limit.error).is_some_and(|(area, bound)| is_tip(area, bound));
    let status = check.status.map(|status| if is_small { status.min(Status::Warning) } else { status });
    Check { status, ..check }
}

fn cavity(figures: &Figures, limit: Limit) -> Check {
    let cavities = figures.parts.cavities.as_ref();
    let measured = cavities.map(|cavities| cavities.count as f64);
    let is_above = |bound: Option<f64>| matches!((measured, bound), (Some(m), Some(b)) if m > b);
    let status = measured.map(|_| status(is_above(limit.warning), is_above(limit.error)));
    let is_ok = status.is_none_or(|status| status == Status::Ok);
    let witnesses = cavities.filter(|_| !is_ok).map(|cavities| cavities.witnesses.clone());
    Check { code: CheckCode::Cavity, status, measured, limit, witnesses: witnesses.unwrap_or_default() }
}

fn status(is_warned: bool, is_wrong: bool) -> Status {
    match (is_warned, is_wrong) {
        (_, true) => Status::Error,
        (true, false) => Status::Warning,
        (false, false) => Status::Ok,
    }
}

fn build_volume(figures: &Figures, policy: &PrintingPolicy) -> Option<Check> {
    let BuildVolume { warning, error } = policy.build_volume;
    let largest = error.or(warning)?;
    let fits = |sides: Option<[f64; 3]>| sides.map(|sides| fit(figures, policy.build_direction, sides));
    let is_tilted = fits(error) == Some(Fit::Tilted);
    let status = status(is_tilted || fits(warning) == Some(Fit::No), fits(error) == Some(Fit::No));
    let sides = (figures.quote.bounds.max - figures.quote.bounds.min).to_array();
    let (sides, largest) = (sorted(sides), sorted(largest));
    let measured = (0..3).map(|k| sides[k] / largest[k]).max_by(f64::total_cmp);
    let limit = Limit { warning: None, error: Some(1.0) };
    Some(Check { code: CheckCode::BuildVolume, status: Some(status), measured, limit, witnesses: Vec::new() })
}

/// How the part fits a box of these sides, the last one up.
pub(super) fn fit(figures: &Figures, up: BuildDirection, sides: [f64; 3]) -> Fit {
    let size: DVec3 = figures.quote.bounds.max - figures.quote.bounds.min;
    let (axis, _) = up.axis();
    let flat = sorted([size[(axis + 1) % 3], size[(axis + 2) % 3], 0.0]);
    let plate = sorted([sides[0], sides[1], 0.0]);
    let fits = |size: [f64; 3], sides: [f64; 3]| (0..3).all(|k| size[k] <= sides[k]);
    if size[axis] <= sides[2] && fits(flat, plate) {
        Fit::AsPlaced
    } else if fits(sorted(size.to_array()), sorted(sides)) {
        Fit::Turned
    } else if fits(sorted(figures.quote.oriented_box.size), sorted(sides)) {
        Fit::Tilted
    } else {
        Fit::No
    }
}

fn sorted(mut sides: [f64; 3]) -> [f64; 3] {
    sides.sort_unstable_by(f64::total_cmp);
    sides
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_as_thick_as_its_limit_but_for_rounding_is_not_below_it() {
        let limit = Limit { warning: Some(1.0), error: Some(0.7) };
        for (measured, expected) in [
            (1.0, Status::Ok),
            (1.0 - 2e-15, Status::Ok),
            (1.0 - 1e-6, Status::Warning),
            (0.7 - 1e-15, Status::Warning),
            (0.69, Status::Error),
        ] {
            let status = below(CheckCode::Wall, Some(measured), limit, Vec::new()).status;
            assert_eq!(status, Some(expected), "{measured}");
        }
    }
}
