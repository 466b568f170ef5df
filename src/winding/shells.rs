//! What each part of the input says about inside and outside: closed shells, open ones that nearly bound a volume, and
//! sheets that bound none.

use super::OpenShells;
use super::WindingTree;
use super::covered::are_covered;
use super::rims::{ConnectedParts, UnbalancedEdge, parts};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{DVec3, Sign, upward_crossing};
use crate::mesh::{Components, UnionFind};
use crate::par;
use crate::spatial::Bvh;
use rustc_hash::FxHashMap;

/// Triangles by what they say.
#[derive(Debug, Default)]
pub struct Shells {
    /// Closed, outward where they bound a body and inward where a cavity. With them, open ones whose openings closed ones cover, and
    /// cones over these.
    pub closed: Vec<[DVec3; 3]>,
    /// The part of each.
    pub closed_part: Vec<u32>,
    /// Open, read as the boundary of a volume.
    pub open: Vec<[DVec3; 3]>,
    /// The part of each.
    pub open_part: Vec<u32>,
    /// Cones over the rims of the open ones; with them they are closed.
    pub cones: Vec<[DVec3; 3]>,
    /// Open, read as sheets.
    pub sheets: Vec<[DVec3; 3]>,
    /// The part of each.
    pub sheet_part: Vec<u32>,
    /// Number of parts in each list.
    pub parts: [u32; 3],
    /// How clearly the open parts bound a volume, by area: 1 for a closed shell, 0 for a flat sheet.
    pub closedness: Option<f64>,
}

/// An open part is the boundary of a volume when on average the winding numbers of both of its sides are not around
/// zero, as for a sheet (-1/2 and 1/2), but nearer to 0 and 1.
const BOUNDS_A_VOLUME: f64 = 0.25;

/// From this mean on, an open part is no flat sheet: where closed bodies cover its openings it stands on them, and bounds a volume
/// with them.
const BULGES: f64 = 1e-3;

/// Samples of an open part.
const SAMPLES_OF_PART: usize = 64;

/// Sorts the triangles by what they say. Bit-equal `positions` must be one. The sides of a triangle are looked at `beside`
/// it, a length far below that of any feature.
///
/// # Errors
/// When the budget stops the run.
pub fn sort(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    open_shells: OpenShells,
    beside: f64,
    budget: &Budget,
) -> Result<Shells, Stopped> {
    let ConnectedParts { parts, is_closed, rims } = parts(positions.len(), triangles, budget)?;
    let corners = |t: usize| triangles[t].map(|v| positions[v as usize]);
    let turns = turned(positions, triangles, &parts, &is_closed, budget)?;
    let mut shells = Shells::default();
    let (mut open, mut open_part) = (Vec::new(), Vec::new());
    for t in 0..triangles.len() {
        if t % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let part = parts.of[t] as usize;
        let [a, b, c] = corners(t);
        if is_closed[part] {
            shells.closed_part.push(part as u32);
            shells.closed.push(if turns[part] { [a, c, b] } else { [a, b, c] });
        } else {
            open.push([a, b, c]);
            open_part.push(part as u32);
        }
    }
    shells.parts[0] = is_closed.iter().filter(|&&is_closed| is_closed).count() as u32;
    let covered = |is_asked: &[bool], closed: &[[DVec3; 3]]| {
        are_covered(positions, &rims, is_asked, (closed, beside), budget)
    };
    let reading = (open_shells, beside);
    let readings = read_open(open, &open_part, parts.count as usize, reading, covered, &mut shells, budget)?;
    for (part, cone) in cones(positions, &rims, &readings, beside) {
        match readings.of_part[part as usize] {
            PartReading::Covered => {
                shells.closed.push(cone);
                shells.closed_part.push(part);
            }
            PartReading::Volume | PartReading::Sheet => shells.cones.push(cone),
        }
    }
    Ok(shells)
}

/// How an open part is read, in the order of the lists of [`Shells::parts`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum PartReading {
    /// As the boundary of a volume, with the closed bodies that cover all of its openings.
    Covered,
    /// As the boundary of a volume by itself.
    Volume,
    Sheet,
}

/// How the open parts are read.
struct OpenReadings {
    of_part: Vec<PartReading>,
    /// Together they are inside out.
    are_turned: bool,
}

/// Triangles that close the parts that bound a volume, with the part of each: from each rim edge to a place in the middle of the rim
/// edges that it is connected with, which form a cycle of their own.
fn cones(
    positions: &[DVec3],
    rims: &[UnbalancedEdge],
    readings: &OpenReadings,
    beside: f64,
) -> Vec<(u32, [DVec3; 3])> {
    let mut sets = UnionFind::new(positions.len());
    let is_sheet = |part: u32| readings.of_part[part as usize] == PartReading::Sheet;
    let rims: Vec<&UnbalancedEdge> = rims.iter().filter(|rim| !is_sheet(rim.part)).collect();
    for rim in &rims {
        sets.unite(rim.from, rim.to);
    }
    let mut middles: FxHashMap<u32, (DVec3, f64)> = FxHashMap::default();
    for rim in &rims {
        let [a, b] = [rim.from, rim.to].map(|v| positions[v as usize]);
        let length = a.distance(b) + f64::MIN_POSITIVE;
        let (sum, weight) = middles.entry(sets.find(rim.from)).or_insert((DVec3::ZERO, 0.0));
        (*sum, *weight) = (*sum + (a + b) / 2.0 * length, *weight + length);
    }
    let mut cones = Vec::new();
    for rim in &rims {
        let (sum, weight) = middles[&sets.find(rim.from)];
        // Off every plane that others are likely to lie in.
        let apex = sum / weight + DVec3::new(0.37, 0.61, 0.47) * beside;
        let [a, b] = [rim.from, rim.to].map(|v| positions[v as usize]);
        let cone = if readings.are_turned { [a, b, apex] } else { [b, a, apex] };
        cones.extend(std::iter::repeat_n((rim.part, cone), rim.times as usize));
    }
    cones
}

/// Closed parts that must be turned around: those of a tree whose outermost part points inward.
fn turned(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    parts: &Components,
    is_closed: &[bool],
    budget: &Budget,
) -> Result<Vec<bool>, Stopped> {
    let count = is_closed.len();
    let mut volume = vec![0.0; count];
    let mut top = vec![DVec3::NEG_INFINITY; count];
    for (t, &part) in parts.of.iter().enumerate() {
        if t % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let corners = triangles[t].map(|v| positions[v as usize]);
        let base = top[part as usize];
        top[part as usize] = corners.into_iter().fold(base, |top, p| if p.z > top.z { p } else { top });
        volume[part as usize] += corners[0].dot(corners[1].cross(corners[2]));
    }
    if volume.iter().zip(is_closed).all(|(&v, &is_closed)| v >= 0.0 || !is_closed) {
        return Ok(vec![false; count]);
    }
    let bvh = Bvh::build(positions, triangles, None, budget)?;
    // The outermost part around each, and itself when there is none.
    let around = par::try_map_ranges(count, 1, |range| {
        let part = range.start;
        let mut crossings: Vec<(u32, i32)> = Vec::new();
        if is_closed[part] {
            bvh.visit_upward_ray(top[part], budget, |t| {
                let other = parts.of[t as usize];
                if other as usize != part && is_closed[other as usize] {
                    let corners = triangles[t as usize].map(|v| positions[v as usize]);
                    if let Some(turn) = upward_crossing(top[part], corners) {
                        crossings.push((other, if turn == Sign::Positive { 1 } else { -1 }));
                    }
                }
            })?;
        }
        crossings.sort_unstable();
        let sums = crossings.chunk_by(|a, b| a.0 == b.0);
        let around: Vec<u32> =
            sums.filter(|same| same.iter().map(|c| c.1).sum::<i32>() != 0).map(|same| same[0].0).collect();
        Ok(around)
    })?;
    let root = |part: usize| {
        around[part].iter().copied().find(|&o| around[o as usize].is_empty()).map_or(part, |o| o as usize)
    };
    Ok((0..count).map(|part| volume[root(part)] < 0.0).collect())
}

/// Sorts the open parts into those that bound a volume and sheets, and says how each part is read. `covered` says of which parts
/// closed bodies cover all openings: these are closed with their cones.
fn read_open(
    open: Vec<[DVec3; 3]>,
    part: &[u32],
    part_count: usize,
    (open_shells, beside): (OpenShells, f64),
    covered: impl FnOnce(&[bool], &[[DVec3; 3]]) -> Result<Vec<bool>, Stopped>,
    shells: &mut Shells,
    budget: &Budget,
) -> Result<OpenReadings, Stopped> {
    if open.is_empty() {
        return Ok(OpenReadings { of_part: vec![PartReading::Sheet; part_count], are_turned: false });
    }
    let tree = WindingTree::build(open.clone(), budget)?;
    let mut taken = vec![0usize; part_count];
    let mut of_open = vec![0usize; part_count];
    part.iter().for_each(|&p| of_open[p as usize] += 1);
    // Every n-th triangle of a part.
    let mut samples = Vec::new();
    for (t, &p) in part.iter().enumerate() {
        let step = of_open[p as usize].div_ceil(SAMPLES_OF_PART);
        if taken[p as usize].is_multiple_of(step) {
            samples.push(t);
        }
        taken[p as usize] += 1;
    }
    let sides = par::try_map_ranges(samples.len(), 256, |range| {
        budget.spend(range.len() as u64 * 8)?;
        samples[range]
            .iter()
            .map(|&t| both_sides(&tree, open[t], beside, budget))
            .collect::<Result<Vec<_>, _>>()
    })?;
    let (mut sum, mut area) = (vec![0.0; part_count], vec![0.0; part_count]);
    for (&t, (mean, size)) in samples.iter().zip(sides.into_iter().flatten()) {
        sum[part[t] as usize] += mean * size;
        area[part[t] as usize] += size;
    }
    let overall = sum.iter().sum::<f64>() / area.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    // As a whole inside out.
    let are_turned = overall < -BOUNDS_A_VOLUME;
    let sign = if are_turned { -1.0 } else { 1.0 };
    let is_from = |p: usize, mean: f64| sign * sum[p] / area[p].max(f64::MIN_POSITIVE) >= mean;
    let by_itself = |p: usize| match open_shells {
        OpenShells::Close => PartReading::Volume,
        OpenShells::Auto if is_from(p, BOUNDS_A_VOLUME) => PartReading::Volume,
        OpenShells::Auto | OpenShells::Thicken => PartReading::Sheet,
    };
    let mut of_part: Vec<PartReading> = (0..part_count).map(by_itself).collect();
    if open_shells == OpenShells::Auto {
        let may_stand = |p: usize| of_part[p] == PartReading::Sheet && of_open[p] > 0 && is_from(p, BULGES);
        let may_stand: Vec<bool> = (0..part_count).map(may_stand).collect();
        let is_covered =
            if may_stand.contains(&true) { covered(&may_stand, &shells.closed)? } else { may_stand };
        for (reading, _) in of_part.iter_mut().zip(is_covered).filter(|&(_, is_covered)| is_covered) {
            *reading = PartReading::Covered;
        }
    }
    for p in (0..part_count).filter(|&p| of_open[p] > 0) {
        shells.parts[of_part[p] as usize] += 1;
    }
    for ([a, b, c], &p) in open.into_iter().zip(part) {
        let (list, part, is_turned) = match of_part[p as usize] {
            PartReading::Covered => (&mut shells.closed, &mut shells.closed_part, are_turned),
            PartReading::Volume => (&mut shells.open, &mut shells.open_part, are_turned),
            PartReading::Sheet => (&mut shells.sheets, &mut shells.sheet_part, false),
        };
        list.push(if is_turned { [a, c, b] } else { [a, b, c] });
        part.push(p);
    }
    shells.closedness = Some((2.0 * overall.abs()).clamp(0.0, 1.0));
    Ok(OpenReadings { of_part, are_turned })
}

/// Which parts of an open surface are sheets rather than boundaries of a volume by themselves, by the rule of
/// [`OpenShells::Auto`]; `part` names the part of each triangle, below `part_count`. The sides of a triangle are looked at `beside`
/// it.
///
/// # Errors
/// When the budget stops the run.
pub fn are_sheets(
    triangles: Vec<[DVec3; 3]>,
    part: &[u32],
    part_count: usize,
    beside: f64,
    budget: &Budget,
) -> Result<Vec<bool>, Stopped> {
    let reading = (OpenShells::Auto, beside);
    let nothing = |_: &[bool], _: &[[DVec3; 3]]| Ok(vec![false; part_count]);
    let readings = read_open(triangles, part, part_count, reading, nothing, &mut Shells::default(), budget)?;
    Ok(readings.of_part.into_iter().map(|reading| reading == PartReading::Sheet).collect())
}

/// The mean of the winding numbers on both sides of a triangle, and its area.
fn both_sides(
    tree: &WindingTree,
    [a, b, c]: [DVec3; 3],
    beside: f64,
    budget: &Budget,
) -> Result<(f64, f64), Stopped> {
    let normal = (b - a).cross(c - a);
    let twice_area = normal.length();
    if twice_area == 0.0 {
        return Ok((0.0, 0.0));
    }
    let (middle, step) = ((a + b + c) / 3.0, normal * (beside / twice_area));
    let sum = tree.at(middle + step, 0.0, budget)? + tree.at(middle - step, 0.0, budget)?;
    Ok((sum / 2.0, twice_area))
}
