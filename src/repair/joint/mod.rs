//! Joins bodies that touch: where sheets lie on each other along edges each is drawn back from the solid, which leaves a
//! neck there; tips that meet in a point are cut off and the cuts joined.

mod tips;

use super::{Changes, Draft, Star};
use crate::budget::{Budget, Stopped};
use crate::figures::figure;
use crate::geom::{DVec3, print_pitch};
use crate::mesh::edge_of;
use crate::spatial::{Coincident, coincident_f64};

/// Share of the room around a vertex that it may be moved by.
const SHARE_OF_ROOM: f64 = 0.25;

/// Times that tips are looked for: those that share a triangle with one that was joined wait for the next time.
const ROUNDS: usize = 8;

/// Joins what touches by necks of thickness `size`, in the unit of the file, or less where there is no room. The draft
/// must be paired across the empty space (see [`pair_sheets`](super::pair_sheets::pair_sheets)). What cannot be joined
/// stays as it is.
///
/// ```text
///    \   /            \   /
///     \ /              | |         both sheets move away from each other, into the empty space, so that the solids
///      x       gives   | |         on the left and on the right (here: above and below) become one
///     / \              | |
///    /   \            /   \
/// ```
///
/// # Errors
/// When the budget stops the run.
pub fn join_contacts(draft: &mut Draft, size: f64, budget: &Budget) -> Result<Changes, Stopped> {
    let reach = draft.positions.iter().fold(0.0, |reach, p| p.abs().max_element().max(reach));
    let Some(pitch) = print_pitch(reach) else { return Ok(Changes::default()) };
    let places = coincident_f64(&draft.positions, budget)?;
    let at_edges = at_common_edges(draft, &places, budget)?;
    let (mut moved, mut move_max) = (0, 0.0f64);
    for star in Star::of_each(draft, &at_edges, budget)? {
        budget.spend(star.triangles.len() as u64 / 8 + 1)?;
        let from = draft.positions[star.vertex as usize];
        let outward = star.outward(draft);
        let length = (size / 2.0).min(SHARE_OF_ROOM * star.room(draft));
        let place = star.place(draft, from + outward * length, pitch);
        if let Some(place) = place.filter(|place| outward != DVec3::ZERO && *place != from) {
            move_max = move_max.max(place.distance(from));
            draft.positions[star.vertex as usize] = place;
            moved += 1;
        }
    }
    let mut tips = 0;
    for _ in 0..ROUNDS {
        let (joined, reach) = tips::join_tips(draft, size, pitch, budget)?;
        (tips, move_max) = (tips + joined, move_max.max(reach));
        if joined == 0 {
            break;
        }
    }
    let counts = [("vertices_moved", moved), ("tips_joined", tips)];
    let reason = format!("what touched was joined by necks of up to {}", figure(size));
    Ok(Changes { move_max, reason, ..Changes::counted(counts) })
}

/// The vertices, ascending, that have an edge which lies on an edge of other vertices.
fn at_common_edges(draft: &Draft, places: &Coincident, budget: &Budget) -> Result<Vec<u32>, Stopped> {
    let is_shared = shared(places);
    let place = |v: u32| places.group[v as usize];
    let mut edges = Vec::new();
    for h in 0..draft.triangles.len() as u32 * 3 {
        if h % 4096 == 0 {
            budget.check()?;
        }
        let mut ends = edge_of(&draft.triangles, h);
        if ends.iter().any(|&v| is_shared[place(v) as usize]) {
            ends.sort_by_key(|&v| place(v));
            edges.push((ends.map(place), ends));
        }
    }
    edges.sort_unstable();
    edges.dedup();
    let several = edges.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() > 1).flatten();
    let ends = several.flat_map(|&(_, ends)| ends).filter(|&v| is_shared[place(v) as usize]);
    let mut vertices: Vec<u32> = ends.collect();
    vertices.sort_unstable();
    vertices.dedup();
    Ok(vertices)
}

/// For each place, whether several vertices are there.
fn shared(places: &Coincident) -> Vec<bool> {
    let mut is_shared = vec![false; places.first.len()];
    for (v, &group) in places.group.iter().enumerate() {
        is_shared[group as usize] |= places.first[group as usize] != v as u32;
    }
    is_shared
}
