//! The zero set inside of the rims by marching cubes: clipped beside the rims and zipped to them.

use super::clip::clip;
use super::field::Field;
use super::patch::{Patch, Unmeshed};
use super::rim::RimLines;
use super::track::{BEYOND_MAX, CELLS_MAX, Tracked, project_all, track};
use super::zip::zip;
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::mesh::half_edge::{HalfEdgeId, HalfEdgeMesh};
use crate::par;
use crate::spatial::NearestSearch;

/// Where the mesh of cubes is cut, in cells from the rim; the next one is tried where what is left is not one piece
/// with a loop for each rim.
const LEVELS: [f64; 4] = [0.6, 0.9, 0.4, 1.3];
/// How often the cell is halved when no level is good.
const HALVINGS: usize = 2;
/// Points handled between two checks of the budget.
const POINTS: usize = 64;

/// The zero set of `field` inside of `rims` as triangles of marching cubes with cells of side `cell` (smaller ones where
/// those are too coarse for the hole). Each rim is a closed loop of points on the zero set, in the direction that has
/// the hole on its left, seen from outside; several rims bound one piece. The vertices of the rims keep their bits.
///
/// # Errors
/// When the budget stops the run; inside, why there are no triangles.
pub fn march(
    field: &Field,
    rims: &[Vec<DVec3>],
    cell: f64,
    budget: &Budget,
) -> Result<Result<Patch, Unmeshed>, Stopped> {
    let is_positive = cell > 0.0 && cell.is_finite();
    let lines = match RimLines::new(field, rims, budget)? {
        Ok(lines) if is_positive => lines,
        _ => return Ok(Err(Unmeshed::Input)),
    };
    let search = lines.search(budget)?;
    let mut cell = cell;
    for _ in 0..=HALVINGS {
        let tracked = match track(field, &lines, &search, cell, budget)? {
            Ok(tracked) => tracked,
            Err(refusal) => return Ok(Err(refusal)),
        };
        let sides = sides(&tracked, &lines, &search, cell, budget)?;
        for level in LEVELS {
            let mut inside = clip(&tracked, &sides, level * cell, cell, budget)?;
            project_all(field, &mut inside.points, cell, budget)?;
            if let Some(patch) = zipped(&lines, &inside, budget)? {
                return Ok(Ok(patch));
            }
        }
        cell *= 0.5;
    }
    Ok(Err(Unmeshed::Topology { rims: rims.len() }))
}

/// How far each vertex is inside of the rims. Vertices far from the rims are inside, whatever the sign there: cubes
/// far beyond a rim are not entered.
fn sides(
    mesh: &Tracked,
    lines: &RimLines,
    search: &NearestSearch<'_>,
    cell: f64,
    budget: &Budget,
) -> Result<Vec<f64>, Stopped> {
    let of = |range: std::ops::Range<usize>| -> Result<Vec<f64>, Stopped> {
        let side = |p: &DVec3| {
            let side = lines.side(search, *p, budget)?;
            Ok(if side < -(BEYOND_MAX - 0.5) * cell { -side } else { side })
        };
        mesh.points[range].iter().map(side).collect()
    };
    Ok(par::try_map_ranges(mesh.points.len(), POINTS, of)?.concat())
}

/// The mesh and strips from its loops to the rims; `None` unless it is one piece with a loop near each rim.
fn zipped(lines: &RimLines, inside: &Tracked, budget: &Budget) -> Result<Option<Patch>, Stopped> {
    let rim_count = lines.points.len() as u32;
    let mut points = lines.points.clone();
    points.extend_from_slice(&inside.points);
    let mut triangles: Vec<[u32; 3]> = inside.triangles.iter().map(|t| t.map(|v| v + rim_count)).collect();
    let Some(loops) = boundary(&triangles, points.len(), budget)? else { return Ok(None) };
    let rims = lines.starts.len() - 1;
    if loops.len() != rims {
        return Ok(None);
    }
    let mut of_rim: Vec<Option<Vec<u32>>> = vec![None; rims];
    for inner in loops {
        let start = points[inner[0] as usize];
        let nearest = (0..rim_count as usize).fold((f64::INFINITY, 0), |best, i| {
            let square = points[i].distance_squared(start);
            if square < best.0 { (square, i) } else { best }
        });
        let rim = lines.starts.partition_point(|&first| first <= nearest.1) - 1;
        if of_rim[rim].replace(inner).is_some() {
            return Ok(None);
        }
    }
    for (rim, inner) in of_rim.into_iter().enumerate() {
        let outer: Vec<u32> = (lines.starts[rim] as u32..lines.starts[rim + 1] as u32).collect();
        let Some(strip) = zip(&points, &outer, &inner.unwrap_or_default(), budget)? else { return Ok(None) };
        triangles.extend(strip);
    }
    let is_planned = match HalfEdgeMesh::from_triangles(&triangles, points.len(), budget) {
        Ok(mesh) => {
            let counts = mesh.counts();
            counts.boundary_loops == rims
                && counts.euler() == 2 - rims as i64
                && counts.vertices == points.len()
        }
        Err(_) => false,
    };
    budget.check()?;
    Ok((is_planned && triangles.len() <= 16 * CELLS_MAX).then_some(Patch { points, triangles }))
}

/// The boundary loops of triangles, in the direction in which the triangles run through them; `None` for triangles that
/// are no manifold.
fn boundary(
    triangles: &[[u32; 3]],
    vertex_count: usize,
    budget: &Budget,
) -> Result<Option<Vec<Vec<u32>>>, Stopped> {
    let built = HalfEdgeMesh::from_triangles(triangles, vertex_count, budget);
    budget.check()?;
    let Ok(mesh) = built else { return Ok(None) };
    let along = |h: HalfEdgeId| {
        // The empty side runs the other way.
        let mut vertices: Vec<u32> = mesh.loop_of(h).map(|h| mesh.origin(h).index() as u32).collect();
        vertices.reverse();
        vertices
    };
    Ok(Some(mesh.boundary_loops().into_iter().map(along).collect()))
}
