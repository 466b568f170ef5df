//! How far a result is from its input, what of the input it lost, and whether that is little enough.

use super::changed::{Changed, area_of};
use super::plan::Covered;
use super::size::diagonal;
use super::{FidelityLimits, Refusal};
use crate::analysis::{Analysis, DefectCode, Finding};
use crate::budget::{Budget, CHECK_EVERY, Stage, Stopped};
use crate::distance::{
    DirectedDistance, DistanceOptions, FarPoint, Look, Surface, SurfaceDistance, VisibilitySearch,
    directed_distance,
};
use crate::geom::{DVec3, signed_volume};
use crate::mesh::{Components, Soup, UnionFind};
use crate::spatial::{NearestSearch, coincident_f64};
use crate::winding::{LookedFrom, Outlook, WindingSolid};

/// Visible surface farther than this from the result is lost, as a share of the diagonal of the input.
pub(super) const LOST_BEYOND: f64 = 2e-3;

/// Most of the visible surface that a result may lose for no other to be looked for.
pub(super) const LOSS_MAX: f64 = 0.01;

/// Most of the visible surface that a result may lose behind patches over openings for it to be chosen by what is seen with
/// these patches in the way. Where results were always chosen by what is seen past them, some lost more by an independent judge.
const LOSS_BEHIND_PATCHES_MAX: f64 = 0.1;

/// Patches that are at most this share of the surface close defects, not openings that are meant: what is seen through them is no
/// feature of the part. Bodies that pass through each other are all seen through a hole of one triangle.
pub(super) const DEFECTS_MAX: f64 = 0.1;

/// Samples that tell what is lost, of each surface.
pub(super) const LOSS_SAMPLES: u32 = 1 << 14;

/// What a measurement may cost, and how close it encloses a distance.
const DISTANCE: DistanceOptions = DistanceOptions {
    tolerance_relative: 0.05,
    tolerance_of_diagonal: 1e-5,
    samples: LOSS_SAMPLES,
    refinements_max: 1 << 20,
    refining_work_max: u64::MAX,
    lost_beyond: None,
};

/// The refinements of each direction take at most this part of the work that is left; the distance is enclosed more widely then.
const REFINING_PART: u64 = 8;

/// Bodies beyond which none is looked at alone.
const BODIES_MAX: u32 = 4096;

/// Places of a body that are looked at.
const PLACES_OF_BODY: usize = 8;

/// How far a result is from its input, and what it lost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FidelityMeasurement {
    /// Of what can be seen of the input to the result, and back. `None`: one of them has no triangle.
    pub(super) distance: Option<SurfaceDistance>,
    pub(super) losses: Losses,
}

/// What of its input a result lost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Losses {
    /// Share of the visible surface of the input that is farther from the result than 0.2 % of the diagonal.
    pub visible_loss: f64,
    /// Area of the input that is inside of it, in square units of the file.
    pub hidden_area: f64,
    /// Share of the surface of the result that is farther from the input than 0.2 % of the diagonal.
    pub invented: f64,
    /// Bodies of the input that can be seen and are lost as a whole.
    pub bodies_lost: u32,
    /// Share by which the volume changed; `None` where that of the input is not defined.
    pub volume_change: Option<f64>,
    /// Share of the length of the creases of the input that can be seen which a rebuilt surface has, too; `None`: nothing was
    /// rebuilt, or there are none.
    pub creases_recovered: Option<f64>,
}

impl FidelityMeasurement {
    /// What a result is chosen by, of what it is with patches over openings in the way and `as_seen` past them; `openings` is the
    /// share of its surface that these patches are.
    pub(super) fn to_choose_by(self, as_seen: Self, openings: f64, limits: &FidelityLimits) -> Self {
        let sees_past = as_seen.loses_much_behind(openings) || limits.deviation_max.is_some();
        if sees_past { as_seen } else { self }
    }

    /// True when so much is lost behind patches that the openings were better left open: they are that share of the surface, or hide
    /// whole bodies. What is seen through single missing triangles alone is no reason.
    pub(super) fn loses_much_behind(&self, openings: f64) -> bool {
        let closes_much = openings > DEFECTS_MAX || openings > 0.0 && self.losses.bodies_lost > 0;
        self.losses.visible_loss > LOSS_BEHIND_PATCHES_MAX && closes_much
    }

    /// True when no other result needs to be looked for.
    pub(super) fn passes(&self, limits: &FidelityLimits) -> bool {
        self.losses.visible_loss <= LOSS_MAX && self.losses.bodies_lost == 0 && self.breach(limits).is_none()
    }

    /// The limit of the caller that this exceeds.
    pub(super) fn breach(&self, limits: &FidelityLimits) -> Option<Refusal> {
        let deviation = self.distance.map_or(0.0, |distance| distance.upper());
        if let Some(limit) = limits.deviation_max.filter(|&limit| deviation > limit) {
            let found = self.distance.map_or(0.0, |distance| distance.lower());
            return Some(Refusal::DeviationBeyondLimit { deviation, found, limit });
        }
        let (change, limit) = (self.losses.volume_change?.abs(), limits.volume_change_max?);
        (change > limit).then_some(Refusal::VolumeChangeBeyondLimit { change, limit })
    }

    /// What makes one result worse than another, the first first.
    fn rank(&self, limits: &FidelityLimits) -> (bool, u32, f64, f64) {
        let deviation = self.distance.map_or(0.0, |distance| distance.upper());
        (self.breach(limits).is_some(), self.losses.bodies_lost, self.losses.visible_loss, deviation)
    }

    /// True when this is to be preferred to a later `other`.
    pub(super) fn is_no_worse(&self, other: &Self, limits: &FidelityLimits) -> bool {
        let (a, b) = (self.rank(limits), other.rank(limits));
        let order = a.0.cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.total_cmp(&b.2)).then(a.3.total_cmp(&b.3));
        order.is_le()
    }
}

/// The volume of an input, where it is defined: that of bodies which pass through each other counts what they share twice, and
/// so does that of a body inside another that turns the same way; that of bodies some of which are inside out is taken off. Where all are, it
/// is what they bound.
pub(super) fn defined_volume(before: Option<&Analysis>) -> Option<f64> {
    let embedded = before.filter(|analysis| analysis.properties.is_embedded != Some(false))?;
    let volume = embedded.measures.volume?;
    let found = |code: DefectCode| embedded.findings.iter().find(|finding: &&Finding| finding.code == code);
    if found(DefectCode::MisnestedShell).is_some() {
        return None;
    }
    match found(DefectCode::InvertedShell) {
        None => Some(volume),
        Some(inverted) => (inverted.count == embedded.counts.components).then_some(-volume),
    }
}

/// An input to measure results against.
pub(super) struct Original<'i> {
    pub(super) input: &'i Soup,
    /// Volume, where it is defined.
    volume: Option<f64>,
    /// What hides parts of it; `None`: nothing does.
    solid: Option<WindingSolid>,
    /// What is seen all the same.
    outlook: Option<Outlook>,
    /// Visible surface farther away than this is lost, surface of a result farther away than this invented.
    lost_beyond: f64,
}

impl<'i> Original<'i> {
    pub(super) fn new(input: &'i Soup, volume: Option<f64>, solid: Option<WindingSolid>) -> Self {
        Self::with_diagonal(input, volume, solid, diagonal(input))
    }

    /// As [`Self::new`] where the [`diagonal`] of the input is known.
    pub(super) fn with_diagonal(
        input: &'i Soup,
        volume: Option<f64>,
        solid: Option<WindingSolid>,
        diagonal: f64,
    ) -> Self {
        Self { input, volume, solid, outlook: None, lost_beyond: LOST_BEYOND * diagonal }
    }

    /// What a straight line leads to from outside of the input is seen, even if it is inside of the solid.
    pub(super) fn with_outlook(self, budget: &Budget) -> Result<Self, Stopped> {
        let triangles = (0..self.input.triangles.len() as u32).map(|t| self.input.corners(t));
        Ok(Self { outlook: Some(Outlook::past(triangles, budget)?), ..self })
    }

    /// Measures a result; `origins` name the triangle of the input that each of its triangles is, or [`NEW`](crate::repair::NEW).
    pub(super) fn measure(
        &self,
        result: &Soup,
        origins: &[u32],
        budget: &Budget,
    ) -> Result<FidelityMeasurement, Stopped> {
        self.measure_rest(result, origins, None, budget)
    }

    /// As [`Self::measure`], but what is known to be `covered` is not looked for.
    pub(super) fn measure_rest(
        &self,
        result: &Soup,
        origins: &[u32],
        covered: Option<&Covered>,
        budget: &Budget,
    ) -> Result<FidelityMeasurement, Stopped> {
        let refining_work_max = budget.work_left() / REFINING_PART;
        let care = DistanceOptions { refining_work_max, lost_beyond: Some(self.lost_beyond), ..DISTANCE };
        budget.stage(Stage::Measure, || {
            let mut changed = Changed::of(self.input, result, origins, budget)?;
            let mut moved = [0.0; 2];
            let (mut covered_area, mut buried_area) = (0.0, 0.0);
            if let Some(covered) = covered.filter(|covered| covered.moved <= self.lost_beyond / 10.0) {
                let (known, gone) = std::mem::take(&mut changed.gone)
                    .into_iter()
                    .partition(|t| covered.triangles.binary_search(t).is_ok());
                changed.gone = gone;
                covered_area = area_of(self.input, &known);
                buried_area = covered.buried_area.min(covered_area);
                moved = [covered.moved, changed.drop_pieces(self.input, result, origins, self.lost_beyond)];
            }
            let gone_area = area_of(self.input, &changed.gone);
            let area = gone_area + covered_area + changed.stayed_area;
            let forward = self.forward(result, &changed.gone, &care, budget)?;
            let seen = forward.and_then(|forward| forward.seen);
            let hidden_area = buried_area + gone_area * seen.map_or(0.0, |seen| seen.hidden_share);
            let lost_area =
                (gone_area + buried_area - hidden_area) * seen.map_or(0.0, |seen| seen.lost_share);
            let backward = self.backward(result, &changed.new, &care, budget)?;
            let invented = backward.and_then(|backward| backward.seen).map_or(0.0, |seen| seen.lost_share);
            let new_area = area_of(result, &changed.new);
            let share = |part: f64, all: f64| if all > 0.0 { part / all } else { 0.0 };
            let still = |mesh: &Soup| mesh.positions.first().map(|&place| at_rest(place));
            let seen_area = gone_area + buried_area - hidden_area;
            let forward = forward.map(|f| spread(f, share(seen_area, area - hidden_area)));
            let result_area = new_area + changed.pieces_area + changed.stayed_area;
            let backward = backward.map(|b| spread(b, share(new_area, result_area)));
            let directions = forward.or_else(|| still(self.input)).zip(backward.or_else(|| still(result)));
            let losses = Losses {
                visible_loss: share(lost_area, area - hidden_area),
                hidden_area,
                invented: share(new_area * invented, result_area),
                bodies_lost: self.bodies_lost(result, &changed, budget)?,
                volume_change: self.volume_change(result),
                creases_recovered: None,
            };
            let distance = directions.map(|(forward, backward)| SurfaceDistance {
                forward: at_least(forward, moved[0]),
                backward: at_least(backward, moved[1]),
            });
            Ok(FidelityMeasurement { distance, losses })
        })
    }

    /// What a result lost, of whose distance it was told what is lost of all of the input and of all of the result. Nothing hides
    /// anything.
    pub(super) fn losses_at(
        &self,
        distance: &SurfaceDistance,
        result: &Soup,
        origins: &[u32],
        budget: &Budget,
    ) -> Result<Losses, Stopped> {
        budget.stage(Stage::Measure, || {
            let changed = Changed::of(self.input, result, origins, budget)?;
            let lost = |of: &DirectedDistance| of.seen.map_or(0.0, |seen| seen.lost_share);
            Ok(Losses {
                visible_loss: lost(&distance.forward),
                hidden_area: 0.0,
                invented: lost(&distance.backward),
                bodies_lost: self.bodies_lost(result, &changed, budget)?,
                volume_change: self.volume_change(result),
                creases_recovered: None,
            })
        })
    }

    /// The first of these places on a triangle of the input that can be seen.
    pub(super) fn first_visible(
        &self,
        places: &mut dyn Iterator<Item = DVec3>,
        triangle: u32,
        nearby: &mut LookedFrom,
        budget: &Budget,
    ) -> Result<Option<DVec3>, Stopped> {
        let corners = self.input.corners(triangle);
        let Some(solid) = &self.solid else { return Ok(places.next()) };
        for place in places {
            let is_hidden = solid.hides(place, corners, nearby, budget)?;
            let sees = |outlook: &Outlook| outlook.sees(place, corners, nearby, budget);
            if !is_hidden || self.outlook.as_ref().map_or(Ok(false), sees)? {
                return Ok(Some(place));
            }
        }
        Ok(None)
    }

    /// The distance of what is gone from the result.
    fn forward(
        &self,
        result: &Soup,
        gone: &[u32],
        care: &DistanceOptions,
        budget: &Budget,
    ) -> Result<Option<DirectedDistance>, Stopped> {
        let triangles: Vec<[u32; 3]> = gone.iter().map(|&t| self.input.triangles[t as usize]).collect();
        let look = || -> VisibilitySearch<'_> {
            let mut nearby = LookedFrom::default();
            Box::new(move |places, triangle| {
                self.first_visible(places, gone[triangle as usize], &mut nearby, budget)
            })
        };
        let look: Option<Look<'_>> = if self.solid.is_some() { Some(&look) } else { None };
        let from = Surface { positions: &self.input.positions, triangles: &triangles };
        directed_distance(from, surface(result), look, care, budget)
    }

    /// The distance of what is new from the input, all of which counts.
    fn backward(
        &self,
        result: &Soup,
        new: &[u32],
        care: &DistanceOptions,
        budget: &Budget,
    ) -> Result<Option<DirectedDistance>, Stopped> {
        let triangles: Vec<[u32; 3]> = new.iter().map(|&t| result.triangles[t as usize]).collect();
        let from = Surface { positions: &result.positions, triangles: &triangles };
        directed_distance(from, surface(self.input), None, care, budget)
    }

    fn volume_change(&self, result: &Soup) -> Option<f64> {
        let before = self.volume.filter(|&volume| volume != 0.0)?;
        // Simplified alone, a file whose bodies are all inside out stays so; what it bounds is compared, as in `defined_volume`.
        let after = signed_volume((0..result.triangles.len() as u32).map(|t| result.corners(t))).abs();
        Some((after - before) / before.abs())
    }

    /// Parts of which every visible place that is looked at is lost.
    fn bodies_lost(&self, result: &Soup, changed: &Changed, budget: &Budget) -> Result<u32, Stopped> {
        let Changed { gone, stays, .. } = changed;
        if gone.is_empty() {
            return Ok(0);
        }
        let parts = parts(self.input, budget)?;
        if parts.count > BODIES_MAX {
            return Ok(0);
        }
        let mut of_part = vec![Vec::new(); parts.count as usize];
        for (n, &t) in gone.iter().enumerate() {
            if n % CHECK_EVERY == 0 {
                budget.check()?;
            }
            of_part[parts.of[t as usize] as usize].push(t);
        }
        // A part of which something stayed is not lost.
        for (t, &part) in parts.of.iter().enumerate() {
            if stays[t] {
                of_part[part as usize].clear();
            }
        }
        let near = NearestSearch::build(&result.positions, &result.triangles, budget)?;
        let mut lost = 0;
        for part in of_part.iter().filter(|part| !part.is_empty()) {
            let (mut seen, mut found, mut nearby) = (0, 0, LookedFrom::default());
            for &t in part.iter().step_by(part.len().div_ceil(PLACES_OF_BODY)) {
                let place = self.input.corners(t).iter().sum::<DVec3>() / 3.0;
                if self.first_visible(&mut std::iter::once(place), t, &mut nearby, budget)?.is_some() {
                    budget.spend(1)?;
                    let nearest = near.find(place, None, budget)?;
                    seen += 1;
                    found += u32::from(nearest.is_some_and(|nearest| nearest.distance <= self.lost_beyond));
                }
            }
            lost += u32::from(seen > 0 && found == 0);
        }
        Ok(lost)
    }
}

fn surface(mesh: &Soup) -> Surface<'_> {
    Surface { positions: &mesh.positions, triangles: &mesh.triangles }
}

/// A distance of which a part of the surface is known to be no farther than `moved`.
fn at_least(of: DirectedDistance, moved: f64) -> DirectedDistance {
    DirectedDistance { upper: of.upper.max(moved), ..of }
}

/// The distance of a surface of which nothing changed.
fn at_rest(place: DVec3) -> DirectedDistance {
    DirectedDistance {
        is_within_tolerance: true,
        upper: 0.0,
        lower: 0.0,
        farthest: FarPoint { place, triangle: 0, closest: place, closest_triangle: 0 },
        mean: Some(0.0),
        root_mean_square: Some(0.0),
        seen: None,
    }
}

/// Means over a part of a surface as means over all of it, of which the rest is at no distance.
fn spread(of: DirectedDistance, share: f64) -> DirectedDistance {
    DirectedDistance {
        mean: of.mean.map(|mean| mean * share),
        root_mean_square: of.root_mean_square.map(|root| root * share.sqrt()),
        ..of
    }
}

/// Triangles connected by places that they share.
fn parts(mesh: &Soup, budget: &Budget) -> Result<Components, Stopped> {
    let group = coincident_f64(&mesh.positions, budget)?.group;
    let mut sets = UnionFind::new(mesh.positions.len());
    for block in mesh.triangles.chunks(CHECK_EVERY) {
        budget.check()?;
        for corners in block {
            let [a, b, c] = corners.map(|v| group[v as usize]);
            sets.unite(a, b);
            sets.unite(b, c);
        }
    }
    let places = sets.into_components();
    let of = mesh.triangles.iter().map(|t| places.of[group[t[0] as usize] as usize]).collect();
    Ok(Components { of, count: places.count })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::repair::NEW;
    use crate::winding::OpenShells;

    /// Cubes with these lowest corners and sizes.
    fn cubes(of: &[([f64; 3], f64)]) -> Soup {
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let mut soup = Soup::default();
        for &(low, size) in of {
            let base = soup.positions.len() as u32;
            let corner = |i: u32| [i & 1, i >> 1 & 1, i >> 2].map(f64::from);
            soup.positions.extend((0..8).map(|i| DVec3::from(corner(i)) * size + DVec3::from(low)));
            let split = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
            soup.triangles.extend(split.map(|t: [u32; 3]| t.map(|v| v + base)));
        }
        soup
    }

    fn measured(input: &Soup, result: &Soup, origins: &[u32]) -> FidelityMeasurement {
        let budget = Budget::unlimited();
        let solid = WindingSolid::of(&input.positions, &input.triangles, OpenShells::Auto, &budget).unwrap();
        let volume = signed_volume((0..input.triangles.len() as u32).map(|t| input.corners(t)));
        Original::new(input, Some(volume), Some(solid)).measure(result, origins, &budget).unwrap()
    }

    #[test]
    fn what_stays_is_at_no_distance_and_loses_nothing() {
        let cube = cubes(&[([0.0; 3], 10.0)]);
        let found = measured(&cube, &cube, &(0..12).collect::<Vec<_>>());
        assert_eq!(found.distance.unwrap().upper(), 0.0);
        assert_eq!(
            (found.losses.visible_loss, found.losses.hidden_area, found.losses.bodies_lost),
            (0.0, 0.0, 0)
        );
        assert_eq!(found.losses.volume_change, Some(0.0));
        let again = measured(&cube, &cube, &[NEW; 12]);
        assert!(again.distance.unwrap().upper() < 1e-9 && again.losses.visible_loss == 0.0);
    }

    #[test]
    fn a_hidden_body_may_go_and_a_visible_one_may_not() {
        let outer = cubes(&[([0.0; 3], 10.0)]);
        let kept: Vec<u32> = (0..12).collect();
        let hidden = measured(&cubes(&[([0.0; 3], 10.0), ([4.0; 3], 2.0)]), &outer, &kept);
        assert_eq!((hidden.losses.visible_loss, hidden.losses.bodies_lost), (0.0, 0));
        assert!((hidden.losses.hidden_area - 24.0).abs() < 1e-9 && hidden.distance.unwrap().upper() < 1e-9);
        assert!(hidden.passes(&FidelityLimits::default()));
        let visible = measured(&cubes(&[([0.0; 3], 10.0), ([14.0; 3], 2.0)]), &outer, &kept);
        assert!((visible.losses.visible_loss - 24.0 / 624.0).abs() < 1e-9, "{}", visible.losses.visible_loss);
        assert_eq!(visible.losses.bodies_lost, 1);
        let farthest = 6.0 * 3.0f64.sqrt();
        assert!((visible.distance.unwrap().upper() - farthest).abs() < 0.06 * farthest);
        assert!(!visible.passes(&FidelityLimits::default()));
    }

    #[test]
    fn faces_without_area_are_no_bodies_and_at_no_distance() {
        let cube = cubes(&[([0.0; 3], 10.0)]);
        let mut littered = cube.clone();
        littered.positions.extend([20.0, 21.0, 23.0].map(|x| DVec3::new(x, 5.0, 5.0)));
        littered.triangles.extend([[8, 8, 8], [8, 9, 9], [8, 9, 10]]);
        let found = measured(&littered, &cube, &(0..12).collect::<Vec<_>>());
        assert_eq!((found.losses.bodies_lost, found.losses.visible_loss), (0, 0.0));
        assert_eq!(found.distance.unwrap().upper(), 0.0);
    }

    #[test]
    fn limits_name_what_exceeds_them() {
        let (cube, larger) = (cubes(&[([0.0; 3], 10.0)]), cubes(&[([0.0; 3], 11.0)]));
        let found = measured(&cube, &larger, &[NEW; 12]);
        assert!((found.losses.volume_change.unwrap() - 0.331).abs() < 1e-9);
        let far = FidelityLimits { deviation_max: Some(1.0), ..FidelityLimits::default() };
        assert!(matches!(found.breach(&far), Some(Refusal::DeviationBeyondLimit { limit: 1.0, .. })));
        let more = FidelityLimits { volume_change_max: Some(0.1), ..FidelityLimits::default() };
        assert!(matches!(found.breach(&more), Some(Refusal::VolumeChangeBeyondLimit { limit: 0.1, .. })));
        let both = FidelityLimits { deviation_max: Some(2.0), volume_change_max: Some(0.4) };
        assert_eq!(found.breach(&both), None);
    }
}
