//! From the points of a band to its field.

use super::band::{Band, BandSurroundings};
use super::centres::{Site, UnitFrame, sites};
use super::field::{Field, FieldSolution, FitFacts, SolveMethod};
use super::offsets::{Offsets, offsets};
use super::options::{ConstraintValues, Kernel, RbfOptions};
use super::partition::Partition;
use super::system::{Solution, solve};
use super::unfit::Unfit;
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;

/// Fits a field to `band` (Carr et al. 2001; see `docs/rbf.md` for the mathematics).
///
/// The centres are the points X of the band, and for a share of them X + lambda n and X - lambda n; the field is 0 at
/// the first and +-lambda (or +-1) at the others. Moving, turning and scaling the band moves, turns and scales the
/// field, up to rounding. The cube of the centres up to [`RbfOptions::dense_centres_max`], in proportion to them beyond.
///
/// # Errors
/// When the budget stops the run; inside, why there is no field.
pub fn fit(
    band: &Band,
    around: &BandSurroundings<'_, '_>,
    options: &RbfOptions,
    budget: &Budget,
) -> Result<Result<Field, Unfit>, Stopped> {
    let is_positive = |x: f64| x > 0.0 && x.is_finite();
    if options.lambda.is_some_and(|lambda| !is_positive(lambda)) || !is_positive(options.share.min(1.0)) {
        return Ok(Err(Unfit::Options));
    }
    if let Err(refusal) = band.check() {
        return Ok(Err(refusal));
    }
    let frame = UnitFrame::of(&band.points);
    if !is_positive(frame.unit) {
        return Ok(Err(Unfit::NotFinite { point: 0 }));
    }
    let offsets = offsets(band, around, options, budget)?;
    let sites = sites(band, &offsets, options, &frame, budget)?;
    budget.spend(sites.len() as u64)?;
    if sites.iter().all(|site| site.has == [false; 2]) {
        return Ok(Err(Unfit::NoRoom));
    }
    let parts = match parts(&sites, options, budget)? {
        Ok(parts) => parts,
        Err(refusal) => return Ok(Err(refusal)),
    };
    let value_unit = if options.values == ConstraintValues::Unit { 1.0 } else { frame.unit };
    let facts = facts(band, options.kernel, &sites, &offsets, &parts);
    Ok(Ok(Field { kernel: options.kernel, values: options.values, frame, value_unit, parts, facts }))
}

fn parts(
    sites: &[Site],
    options: &RbfOptions,
    budget: &Budget,
) -> Result<Result<FieldSolution, Unfit>, Stopped> {
    let count = sites.iter().flat_map(Site::centres).count();
    if count > options.dense_centres_max {
        return Ok(Partition::fit(options.kernel, sites, budget)?.map(FieldSolution::Many));
    }
    let (points, values): (Vec<DVec3>, Vec<f64>) = sites.iter().flat_map(Site::centres).unzip();
    Ok(solve(options.kernel, &points, &values, budget)?
        .map(|solution| FieldSolution::One(Box::new(solution))))
}

fn facts(band: &Band, kernel: Kernel, sites: &[Site], offsets: &Offsets, parts: &FieldSolution) -> FitFacts {
    let solutions: Vec<&Solution> = match parts {
        FieldSolution::One(solution) => vec![solution],
        FieldSolution::Many(partition) => partition.solutions().collect(),
    };
    let centres_max = solutions.iter().map(|s| s.centres.len()).max().unwrap_or(0);
    let method = match parts {
        FieldSolution::One(_) => SolveMethod::Dense,
        FieldSolution::Many(_) => SolveMethod::Partition { parts: solutions.len(), centres_max },
    };
    let centres = sites.iter().flat_map(Site::centres).count();
    let with_offsets = sites.iter().filter(|site| site.has != [false; 2]);
    let coincident_offsets = with_offsets.filter(|site| site.has != [true; 2]).count();
    let lambdas = offsets.lambdas.iter().copied();
    let range = lambdas
        .filter(|&lambda| lambda > 0.0)
        .fold([f64::INFINITY, 0.0], |[least, most], l| [least.min(l), most.max(l)]);
    debug_assert!(sites.len() <= band.points.len(), "a site is a point of the band");
    FitFacts {
        kernel,
        points: sites.len(),
        centres,
        coincident_offsets,
        degree: solutions.iter().map(|s| s.degree).min().unwrap_or(1),
        rank: solutions.iter().map(|s| s.rank).min().unwrap_or(0),
        residual: solutions.iter().map(|s| s.residual).fold(0.0, f64::max),
        lambda: offsets.first,
        lambda_range: range,
        halved: offsets.halved,
        without_room: offsets.lambdas.iter().filter(|&&lambda| lambda == 0.0).count(),
        method,
    }
}
