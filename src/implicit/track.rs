//! The zero set as triangles of marching cubes, followed from cube to cube from the rims into the hole.

use super::cubes::{CENTRE, corner_and_axis, triangles};
use super::field::Field;
use super::patch::Unmeshed;
use super::rim::RimLines;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::par;
use crate::spatial::NearestSearch;
use rustc_hash::{FxHashMap, FxHashSet};

/// The most cubes that are followed.
pub(super) const CELLS_MAX: usize = 1_000_000;
/// Cubes whose middle is beyond the rim by more than this many cells are not entered ...
const BEYOND_MIN: f64 = 2.0;
/// ... unless they are farther than this from the rim: then the surface has come from the hole's side.
pub(super) const BEYOND_MAX: f64 = 4.0;
/// Crossings are kept this share of an edge away from its ends, so that no triangle is without extent.
const END_SHARE: f64 = 0.05;
/// Points handled between two checks of the budget.
const POINTS: usize = 32;

type GridCell = [i32; 3];

/// A mesh of the zero set.
#[derive(Debug, Default)]
pub(super) struct Tracked {
    pub points: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
}

struct TrackingGrid {
    origin: DVec3,
    cell: f64,
}

impl TrackingGrid {
    fn point(&self, p: GridCell) -> DVec3 {
        self.origin + DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2])) * self.cell
    }

    fn place(&self, p: DVec3) -> GridCell {
        ((p - self.origin) / self.cell).floor().to_array().map(|x| x as i32)
    }
}

/// Follows the zero set from the rims, with cubes of side `cell`. Work in proportion to the cubes near the surface.
pub(super) fn track(
    field: &Field,
    lines: &RimLines,
    search: &NearestSearch<'_>,
    cell: f64,
    budget: &Budget,
) -> Result<Result<Tracked, Unmeshed>, Stopped> {
    let extent = crate::geom::Aabb::of(lines.points.iter().copied());
    if extent.diagonal() / cell > 1e6 {
        return Ok(Err(Unmeshed::TooFine { cells_max: CELLS_MAX }));
    }
    // Off the coordinates of the rim, which often lie in planes of a grid.
    let grid = TrackingGrid { origin: extent.min - DVec3::new(0.317, 0.411, 0.373) * cell, cell };
    let mut values: FxHashMap<GridCell, f64> = FxHashMap::default();
    let mut seen: FxHashSet<GridCell> = FxHashSet::default();
    let mut layer = Vec::new();
    for (n, place) in seeds(&grid, lines).enumerate() {
        if n.is_multiple_of(CHECK_EVERY) {
            budget.check()?;
            if seen.len() > CELLS_MAX {
                break;
            }
        }
        if seen.insert(place) {
            layer.push(place);
        }
    }
    let mut crossed: Vec<(GridCell, u8)> = Vec::new();
    while !layer.is_empty() {
        if seen.len() > CELLS_MAX {
            return Ok(Err(Unmeshed::TooFine { cells_max: CELLS_MAX }));
        }
        // In parts, so that the run can be stopped between them.
        for part in layer.chunks(CHECK_EVERY) {
            evaluate(field, &grid, part, &mut values, budget)?;
        }
        let mut next = Vec::new();
        for (n, &place) in layer.iter().enumerate() {
            if n.is_multiple_of(CHECK_EVERY) {
                budget.check()?;
            }
            let mask = (0..8).fold(0u8, |mask, k| mask | u8::from(values[&corner(place, k)] >= 0.0) << k);
            if mask == 0 || mask == u8::MAX {
                continue;
            }
            crossed.push((place, mask));
            for neighbour in crossed_neighbours(place, mask) {
                if seen.insert(neighbour) {
                    next.push(neighbour);
                }
            }
        }
        layer = enterable(&grid, lines, search, &next, budget)?;
    }
    mesh(field, &grid, &crossed, &values, budget).map(Ok)
}

fn corner(place: GridCell, k: u8) -> GridCell {
    std::array::from_fn(|a| place[a] + i32::from(k >> a & 1))
}

/// The cubes along the rims and around them, in the order of the rims.
fn seeds<'l>(grid: &'l TrackingGrid, lines: &'l RimLines) -> impl Iterator<Item = GridCell> + 'l {
    lines.segments.iter().flat_map(move |s| {
        let [a, b] = [lines.points[s[0] as usize], lines.points[s[1] as usize]];
        let steps = ((a.distance(b) / grid.cell * 2.0).ceil()).clamp(1.0, 1e6) as usize;
        (0..steps).flat_map(move |i| {
            let [x, y, z] = grid.place(a + (b - a) * (i as f64 / steps as f64));
            (0..27).map(move |n| [x + n % 3 - 1, y + n / 3 % 3 - 1, z + n / 9 - 1])
        })
    })
}

/// Cubes behind those faces of a cube that the surface crosses.
fn crossed_neighbours(place: GridCell, mask: u8) -> impl Iterator<Item = GridCell> {
    (0..3).flat_map(move |axis| (0..2).map(move |side| (axis, side))).filter_map(move |(axis, side)| {
        let of_face = (0..8u8).filter(|k| k >> axis & 1 == side).fold(0u8, |m, k| m | 1 << k);
        let is_crossed = mask & of_face != 0 && mask & of_face != of_face;
        let mut neighbour = place;
        neighbour[axis] += i32::from(side) * 2 - 1;
        is_crossed.then_some(neighbour)
    })
}

/// Those of `places` that are not beyond the rims.
fn enterable(
    grid: &TrackingGrid,
    lines: &RimLines,
    search: &NearestSearch<'_>,
    places: &[GridCell],
    budget: &Budget,
) -> Result<Vec<GridCell>, Stopped> {
    let is_in = |range: std::ops::Range<usize>| -> Result<Vec<bool>, Stopped> {
        let of = |place: &GridCell| {
            let middle = grid.point(*place) + DVec3::splat(0.5 * grid.cell);
            let side = lines.side(search, middle, budget)? / grid.cell;
            Ok(!(-BEYOND_MAX..-BEYOND_MIN).contains(&side))
        };
        places[range].iter().map(of).collect()
    };
    let keep = par::try_map_ranges(places.len(), POINTS, is_in)?.concat();
    Ok(places.iter().zip(keep).filter_map(|(place, keep)| keep.then_some(*place)).collect())
}

/// Adds the values at the corners of the cubes.
fn evaluate(
    field: &Field,
    grid: &TrackingGrid,
    places: &[GridCell],
    values: &mut FxHashMap<GridCell, f64>,
    budget: &Budget,
) -> Result<(), Stopped> {
    let mut missing: Vec<GridCell> = places
        .iter()
        .flat_map(|&place| (0..8).map(move |k| corner(place, k)))
        .filter(|corner| !values.contains_key(corner))
        .collect();
    missing.sort_unstable();
    missing.dedup();
    budget.spend(missing.len() as u64)?;
    let of = |range: std::ops::Range<usize>| -> Result<Vec<f64>, Stopped> {
        budget.check()?;
        Ok(missing[range].iter().map(|&p| field.value(grid.point(p))).collect())
    };
    let found = par::try_map_ranges(missing.len(), POINTS, of)?.concat();
    values.extend(missing.into_iter().zip(found));
    Ok(())
}

/// The triangles of the cubes, with every vertex moved onto the zero set.
fn mesh(
    field: &Field,
    grid: &TrackingGrid,
    crossed: &[(GridCell, u8)],
    values: &FxHashMap<GridCell, f64>,
    budget: &Budget,
) -> Result<Tracked, Stopped> {
    let mut mesh = Tracked::default();
    let mut on_edge: FxHashMap<(GridCell, usize), u32> = FxHashMap::default();
    for (n, &(place, mask)) in crossed.iter().enumerate() {
        if n.is_multiple_of(CHECK_EVERY) {
            budget.check()?;
        }
        let (triangles, centres) = triangles(mask);
        let first_centre = mesh.points.len() as u32;
        let mut middles = Vec::new();
        mesh.points.extend(centres.iter().map(|_| DVec3::ZERO));
        let mut vertex = |code: u8| {
            if code >= CENTRE {
                return first_centre + u32::from(code - CENTRE);
            }
            let (k, axis) = corner_and_axis(code);
            let from = corner(place, k);
            *on_edge.entry((from, axis)).or_insert_with(|| {
                let mut to = from;
                to[axis] += 1;
                let (a, b) = (values[&from], values[&to]);
                let share = (a / (a - b)).clamp(END_SHARE, 1.0 - END_SHARE);
                mesh.points.push(grid.point(from) + (grid.point(to) - grid.point(from)) * share);
                mesh.points.len() as u32 - 1
            })
        };
        mesh.triangles.extend(triangles.iter().map(|t| t.map(&mut vertex)));
        middles.extend(centres.iter().map(|ring| ring.iter().map(|&c| vertex(c)).collect::<Vec<_>>()));
        for (k, ring) in middles.iter().enumerate() {
            let sum: DVec3 = ring.iter().map(|&v| mesh.points[v as usize]).sum();
            mesh.points[first_centre as usize + k] = sum / ring.len() as f64;
        }
    }
    project_all(field, &mut mesh.points, grid.cell, budget)?;
    Ok(mesh)
}

/// Moves points onto the zero set; one that finds it not within `reach` stays.
pub(super) fn project_all(
    field: &Field,
    points: &mut [DVec3],
    reach: f64,
    budget: &Budget,
) -> Result<(), Stopped> {
    par::for_each_chunk_mut(points, POINTS, |_, points| {
        if budget.check().is_ok() {
            points.iter_mut().for_each(|p| *p = field.project(*p, reach).unwrap_or(*p));
        }
    });
    budget.spend(points.len() as u64)
}
