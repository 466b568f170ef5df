//! Turns parts whose rims belong with those of other parts but run the same way: how a part is wound says nothing about where it
//! belongs, and loops that run alike have no common patch.

use super::facing::{RimPair, Rims};
use super::pinched::Walk;
use super::shape::{LoopPolyline, shape};
use super::{sheets, surface_of};
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::mesh::{Boundary, BoundaryLoop, ParityUnionFind, triangle_of};
use crate::repair::{Changes, Draft, Effects};

/// Turns whole parts (triangles connected by edges) so that rims which face each other, lips of two skins and rims of flat sheets
/// back to back run in opposite directions. Of parts that are related so, those with more area stay. Looks at places, so vertices need
/// not be welded; triangles must not be degenerate.
///
/// # Errors
/// When the budget stops the run.
pub fn turn_to_bridge(draft: &mut Draft, budget: &Budget) -> Result<Changes, Stopped> {
    let surface = surface_of(draft, budget)?;
    let boundary = Boundary::trace(&surface.triangles, surface.positions.len(), &surface.groups, budget)?;
    let parts = surface.groups.components(budget)?;
    let walks: Vec<Walk> = boundary.loops.into_iter().map(Walk::of_one).collect();
    let loops: Vec<&BoundaryLoop> = walks.iter().map(|walk| &walk.half_edges).collect();
    let points = |own: &&BoundaryLoop| own.iter().map(|&h| surface.point(h)).collect();
    let shapes: Vec<LoopPolyline> = loops.iter().map(|own| shape(points(own))).collect();
    let sheets = sheets::of_flat_sheets(&walks, &surface, budget)?;
    let outward: &dyn Fn(u32) -> DVec3 = &|h| surface.outward(h);
    let rims = Rims { shapes: &shapes, loops: &loops, sheets: &sheets, outward };
    let part = |of: usize| parts.of[triangle_of(loops[of][0]) as usize];
    let pairs = rims.pairs_of_parts(part, budget)?;
    let mut turned = 0;
    if pairs.iter().any(|pair| pair.run_alike) {
        let mut sides = ParityUnionFind::new(parts.count as usize);
        for RimPair { inner, outer, run_alike } in pairs {
            sides.relate(part(inner), part(outer), run_alike);
        }
        turned = draft.turn_smaller(&parts, &mut sides, budget)?;
    }
    let changes = Changes::counted([("triangles_flipped", turned)]);
    Ok(changes.with(Effects { turned_triangles: turned, ..Effects::default() }))
}
