//! What the triangles of a new mesh take over of the faces of the old one: its colours, paint and the like.

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::formats::threemf::{Body, FaceSource, NO_NUMBER};
use crate::geom::DVec3;
use crate::mesh::Soup;
use crate::repair::NEW;
use crate::spatial::NearestSearch;

/// What became of the attributes of faces, in triangles of the result.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AttributeCounts {
    /// They are faces of the file and keep all.
    pub kept: u64,
    /// They are parts of such faces, were turned around or moved, and take what is at the nearest corner.
    pub from_face: u64,
    /// They are new, and take what is on the nearest face of the file.
    pub from_nearest: u64,
    /// Share of the area of the result that keeps all, from 0 to 1.
    pub kept_area_share: f64,
}

/// What each triangle of `soup`, a result of `body`, takes over; `origins` name the triangles of the body behind them. The
/// counts are `None` where the file says nothing of the faces of the body.
pub(super) fn sources(
    body: &Body,
    soup: &Soup,
    origins: &[u32],
    budget: &Budget,
) -> Result<(Vec<FaceSource>, Option<AttributeCounts>), Stopped> {
    let (attributes, old) = (&body.attributes, &body.soup);
    let count = soup.triangles.len();
    if attributes.properties.is_empty() && attributes.others.is_empty() {
        return Ok((vec![FaceSource::Nothing; count], None));
    }
    let mut nearest: Option<NearestSearch<'_>> = None;
    let mut sources = Vec::with_capacity(count);
    let mut counts = AttributeCounts::default();
    let (mut area, mut kept_area) = (0.0, 0.0);
    for t in 0..count {
        if t % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let corners = soup.corners(t as u32);
        let size = crate::geom::triangle_area(corners);
        area += size;
        let origin = origins.get(t).copied().filter(|&origin| origin != NEW);
        let behind = match origin {
            Some(origin) => origin,
            None => {
                if nearest.is_none() {
                    nearest = Some(NearestSearch::build(&old.positions, &old.triangles, budget)?);
                }
                let middle = corners.iter().sum::<DVec3>() / 3.0;
                let found = match &nearest {
                    Some(search) => search.find(middle, None, budget)?,
                    None => None,
                };
                let Some(found) = found else {
                    sources.push(FaceSource::Nothing);
                    continue;
                };
                found.triangle
            }
        };
        let face = old.face_of(behind);
        let was = old.corners(behind);
        let is_whole = origin.is_some().then(|| whole(was, corners)).flatten();
        sources.push(match is_whole {
            Some(order) => {
                let keeps_all = is_turned(order) || !has_divided_paint(body, face);
                if keeps_all {
                    counts.kept += 1;
                    kept_area += size;
                } else {
                    counts.from_face += 1;
                }
                FaceSource::Whole { face, corners: order }
            }
            None => {
                let middle = corners.iter().sum::<DVec3>() / 3.0;
                if origin.is_some() {
                    counts.from_face += 1;
                } else {
                    counts.from_nearest += 1;
                }
                FaceSource::Corner { face, corner: nearest_corner(was, middle) }
            }
        });
    }
    counts.kept_area_share = if area > 0.0 { kept_area / area } else { 1.0 };
    Ok((sources, Some(counts)))
}

/// The corner of the old triangle at each corner of the new one, where both have the same.
fn whole(was: [DVec3; 3], corners: [DVec3; 3]) -> Option<[u8; 3]> {
    const ORDERS: [[u8; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
    ORDERS.into_iter().find(|order| (0..3).all(|k| corners[k] == was[usize::from(order[k])]))
}

/// True when the corners only begin at another place, and go around the same way.
fn is_turned(order: [u8; 3]) -> bool {
    matches!(order, [0, 1, 2] | [1, 2, 0] | [2, 0, 1])
}

/// True when a face has paint that is stated by its corners.
fn has_divided_paint(body: &Body, face: u32) -> bool {
    let attributes = &body.attributes;
    let number = attributes.others.get(face as usize).copied().filter(|&number| number != NO_NUMBER);
    number.is_some_and(|number| attributes.is_divided(number))
}

fn nearest_corner(was: [DVec3; 3], middle: DVec3) -> u8 {
    let distance = |k: u8| was[usize::from(k)].distance_squared(middle);
    [0, 1, 2].into_iter().min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
}
