//! The parts that loops belong to, as far as the class of a loop depends on them.

use super::BoundaryLoops;
use super::classify::{FLAT_SHARE_MAX, LoopContext, MOUTH_SHARE_MIN, classify, is_mouth};
use super::gaps::gaps;
use super::shape::LoopShape;
use crate::analysis::Context;
use crate::budget::{CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3, triangle_area};
use crate::par;

/// The longest loops of a part that may be mouths; each may cost a look at all of the part's vertices.
const MOUTHS_MAX: usize = 8;

/// How far beyond the plane of its mouth a part may reach, as a share of the mouth's radius: lips are not quite flat.
const BEYOND_MAX: f64 = 0.01;

/// Gives each closed loop its class.
pub(super) fn classify_all(loops: &mut BoundaryLoops, cx: &Context<'_>) -> Result<(), Stopped> {
    let gaps = gaps(loops, cx)?;
    let mut of_parts: Vec<(u32, u32)> = (0..loops.len())
        .filter(|&i| loops.known[i].is_some())
        .map(|i| (loops.part(i, cx), i as u32))
        .collect();
    of_parts.sort_unstable();
    let polygon_corners = polygon_corners_max(cx);
    for of_part in of_parts.chunk_by(|a, b| a.0 == b.0) {
        let part = of_part[0].0;
        let mut numbers: Vec<usize> = of_part.iter().map(|&(_, number)| number as usize).collect();
        let length = |number: &usize| loops.shape(*number).map_or(0.0, |shape| shape.length);
        // Longest first; the order of the file decides between equal ones.
        numbers.sort_by(|a, b| length(b).total_cmp(&length(a)));
        let (area, diagonal) = size(part, cx)?;
        let around = LoopContext {
            is_sheet: cx.is_sheet(part),
            area,
            diagonal,
            longest: length(&numbers[0]),
            polygon_corners,
            gap: f64::INFINITY,
            mouth_share: 0.0,
            has_other_mouth: false,
        };
        let mut mouths = vec![0.0; numbers.len()];
        for (place, number) in numbers.iter().enumerate().take(MOUTHS_MAX) {
            mouths[place] = mouth_share(*number, part, loops, cx)?;
        }
        let is_open = |share: f64| is_mouth(&LoopContext { mouth_share: share, ..around });
        let mouth_count = mouths.iter().filter(|&&share| is_open(share)).count();
        for (&number, mouth_share) in numbers.iter().zip(mouths) {
            let has_other_mouth = mouth_count > usize::from(is_open(mouth_share));
            let around = LoopContext { gap: gaps[number], mouth_share, has_other_mouth, ..around };
            if let Some((shape, guess)) = &mut loops.known[number] {
                if around.gap.is_finite() {
                    shape.width = shape.width.min(around.gap);
                }
                *guess = classify(shape, &around);
            }
        }
    }
    Ok(())
}

/// Corners of the largest polygon of the file.
fn polygon_corners_max(cx: &Context<'_>) -> u32 {
    let starts = &cx.mesh.soup.polygons.starts;
    starts.windows(2).map(|pair| pair[1] - pair[0]).max().unwrap_or(3)
}

/// Area of part `part`, and the diagonal of its box.
fn size(part: u32, cx: &Context<'_>) -> Result<(f64, f64), Stopped> {
    let members = cx.members.part(part);
    let blocks = par::try_map_ranges(members.len(), CHECK_EVERY, |range| {
        cx.budget.check()?;
        let (mut area, mut bounds) = (0.0, Aabb::EMPTY);
        for &t in &members[range] {
            let corners = cx.mesh.corners(t);
            area += triangle_area(corners);
            bounds = bounds.union(Aabb::of(corners));
        }
        Ok((area, bounds))
    })?;
    let bounds = blocks.iter().fold(Aabb::EMPTY, |all, &(_, bounds)| all.union(bounds));
    Ok((blocks.iter().map(|&(area, _)| area).sum(), bounds.diagonal()))
}

/// Radius of loop `number` by that of its part, both about the axis of the loop, where the loop is flat and the part lies on
/// one side of its plane; 0 elsewhere, and where it is too small for a mouth.
fn mouth_share(number: usize, part: u32, loops: &BoundaryLoops, cx: &Context<'_>) -> Result<f64, Stopped> {
    let Some(&LoopShape { normal, deviation, length, .. }) = loops.shape(number) else { return Ok(0.0) };
    if deviation > FLAT_SHARE_MAX * length {
        return Ok(0.0);
    }
    let points = loops.points(number, cx);
    let bounds = Aabb::of(points.iter().copied());
    let origin = bounds.min / 2.0 + bounds.max / 2.0;
    let half = (bounds.max / 2.0 - bounds.min / 2.0).max_element();
    if half.is_nan() || half <= 0.0 {
        return Ok(0.0);
    }
    let unit = |p: DVec3| (p - origin) / half;
    let center = points.iter().map(|&p| unit(p)).sum::<DVec3>() / points.len() as f64;
    let height_and_radius = |p: DVec3| {
        let from = unit(p) - center;
        let height = from.dot(normal);
        (height, (from - normal * height).length())
    };
    let of_loop = points.iter().map(|&p| height_and_radius(p).1).fold(0.0, f64::max);
    let (mut of_part, mut low, mut high) = (0.0f64, 0.0f64, 0.0f64);
    for block in cx.members.part(part).chunks(CHECK_EVERY) {
        cx.budget.check()?;
        for (height, radius) in block.iter().flat_map(|&t| cx.mesh.corners(t)).map(height_and_radius) {
            of_part = of_part.max(radius);
            (low, high) = (low.min(height), high.max(height));
        }
        let is_on_one_side = (-low).min(high) <= BEYOND_MAX * of_loop;
        if !is_on_one_side || of_loop < MOUTH_SHARE_MIN * of_part {
            return Ok(0.0);
        }
    }
    Ok(of_loop / of_part)
}
