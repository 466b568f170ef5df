//! Which ways of filling a hole are tried, and in which order.

use super::creased::HoleDivision;
use super::make::Way;
use super::options::{FillOptions, Method};
use super::regions::Region;
use super::surface::FillSurface;
use crate::budget::{Budget, Stopped};

/// The surface goes on in the plane of a flat loop when it leaves it by less, as the sine of the angle (about a degree).
const COPLANAR_SINE: f64 = 0.02;
/// A flat loop is where a body was cut off when the surface meets its plane more steeply on average, as the sine of the
/// angle (45 degrees). Below, it is the rim of a missing dome.
const CUT_SINE: f64 = 0.7;
/// Holes with fewer corners get a faired patch from `auto` and no field: it comes closer to what was removed, and takes less time
/// (`docs/holes.md`).
const CORNERS_TO_FIT: usize = 26;
/// Loops with fewer corners have no room for a new vertex.
const CORNERS_TO_REFINE: usize = 5;

/// The ways to try for a hole that is to be filled by `method`, the first first, and how creases divide it if they may;
/// [`Method::Auto`] makes new vertices only where it `refines`.
pub(super) fn ways(
    region: &Region,
    method: Method,
    refines: bool,
    surface: &FillSurface,
    options: &FillOptions,
    budget: &Budget,
) -> Result<(Vec<Way>, Option<HoleDivision>), Stopped> {
    budget.spend(region.rim().len() as u64)?;
    let plain: &[Way] = match (region.walks.len(), region.is_flat) {
        (1, true) => &[Way::Planar, Way::Minimal, Way::Ears],
        (1, false) => &[Way::Minimal, Way::Planar, Way::Ears],
        (_, true) if !options.bridges => &[Way::Planar],
        (_, true) => &[Way::Planar, Way::Minimal],
        (2, false) => &[Way::Zipped, Way::Minimal, Way::Planar],
        (_, false) => &[Way::Minimal, Way::Planar],
    };
    let is_plain = method == Method::Auto && (!refines || is_to_be_plain(region, surface));
    let may_be_creased = method == Method::Creased || (method == Method::Auto && !is_plain);
    let division = if may_be_creased { HoleDivision::of(region, surface, budget)? } else { None };
    let is_small = region.rim().len() < CORNERS_TO_FIT;
    let own: &[Way] = match method {
        Method::Auto if is_plain => &[],
        Method::Flat => &[Way::Planar],
        Method::Minimal if region.is_bridge => &[Way::Zipped, Way::Minimal, Way::Ears],
        Method::Minimal => &[Way::Minimal, Way::Ears],
        Method::Smooth => &[Way::Smooth],
        Method::Creased => &[Way::Creased, Way::Smooth],
        Method::Auto if division.is_some() && is_small => &[Way::Creased, Way::Smooth],
        Method::Auto if division.is_some() => &[Way::Creased, Way::Rbf, Way::Smooth],
        Method::Auto if is_small => &[Way::Smooth],
        Method::Auto | Method::Rbf => &[Way::Rbf, Way::Smooth],
    };
    let mut ways = own.to_vec();
    if matches!(method, Method::Rbf | Method::Creased) && !options.falls_back {
        ways.truncate(1);
    }
    if options.falls_back || ways.is_empty() {
        let others = plain.iter().filter(|way| !own.contains(way));
        ways.extend(others);
    }
    Ok((ways, division))
}

/// True when new vertices would not make a better patch.
fn is_to_be_plain(region: &Region, surface: &FillSurface) -> bool {
    if region.rim().len() < CORNERS_TO_REFINE {
        return true;
    }
    if !region.is_flat {
        return false;
    }
    let sines: Vec<f64> = region.rim().iter().map(|&h| surface.outward(h).dot(region.normal).abs()).collect();
    let mean = sines.iter().sum::<f64>() / sines.len() as f64;
    sines.iter().all(|&sine| sine <= COPLANAR_SINE) || mean > CUT_SINE
}
