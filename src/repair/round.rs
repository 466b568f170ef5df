//! Rounds coordinates to float32, for files that hold no more and for readers that keep no more.

use super::{Changes, Draft};
use crate::budget::{Budget, Stopped};
use crate::geom::{DVec3, are_collinear, print_pitch};
use crate::spatial::{Bvh, Search, coincident_f64, self_contacts};

/// Pairs of triangles that meet beyond which every coordinate is rounded.
const CONTACTS_MAX: usize = 1 << 16;

/// Moves every vertex to the nearest float32 point, at most half a float32 step on each axis. A coordinate beyond the
/// range of float32 stays as it is.
pub fn round_to_f32(draft: &mut Draft) -> Changes {
    round_those(draft, |_| true, in_f32)
}

/// As [`round_to_f32`], but only vertices of triangles that meet others or lose their area when all coordinates are read as
/// float32. What that does to the others is not looked at; vertices that fall together stay several.
///
/// # Errors
/// When the budget stops the run.
pub fn round_where_it_matters(draft: &mut Draft, budget: &Budget) -> Result<Changes, Stopped> {
    round_clusters(draft, in_f32, budget)
}

/// Moves the vertices of triangles that meet others, or lose their area, when all coordinates are read as whole multiples of so many
/// `steps` of the print lattice, to such multiples: what is all but in one plane is in one plane then, or apart by more than
/// new vertices are rounded by. Vertices that fall together stay several.
///
/// # Errors
/// When the budget stops the run.
pub fn round_to_coarser(draft: &mut Draft, steps: u32, budget: &Budget) -> Result<Changes, Stopped> {
    let reach = draft.positions.iter().fold(0.0, |reach, p| p.abs().max_element().max(reach));
    match print_pitch(reach) {
        Some(pitch) => {
            let coarse = pitch * f64::from(steps.max(1));
            round_clusters(draft, |position| (position / coarse).round() * coarse + DVec3::ZERO, budget)
        }
        None => Ok(Changes::counted([("vertices_moved", 0)])),
    }
}

/// Moves the vertices of triangles that meet others, or lose their area, when all positions are `rounded`, to where they are then.
fn round_clusters(
    draft: &mut Draft,
    rounded: impl Fn(DVec3) -> DVec3,
    budget: &Budget,
) -> Result<Changes, Stopped> {
    let read: Vec<DVec3> = draft.positions.iter().map(|&position| rounded(position)).collect();
    let places = coincident_f64(&read, budget)?;
    let triangles: Vec<[u32; 3]> =
        draft.triangles.iter().map(|t| t.map(|v| places.first[places.group[v as usize] as usize])).collect();
    let has_area = |&t: &u32| {
        let [a, b, c] = triangles[t as usize].map(|v| read[v as usize]);
        !are_collinear(a, b, c)
    };
    budget.spend(triangles.len() as u64)?;
    let (sound, flat): (Vec<u32>, Vec<u32>) = (0..triangles.len() as u32).partition(has_area);
    let bvh = Bvh::build(&read, &triangles, Some(&sound), budget)?;
    let search = Search::All { keep: CONTACTS_MAX };
    let contacts = self_contacts(&read, &triangles, &bvh, None, search, budget)?;
    if contacts.count > CONTACTS_MAX as u64 {
        return Ok(round_those(draft, |_| true, rounded));
    }
    let mut matters = vec![false; read.len()];
    let meeting = contacts.list.iter().flat_map(|contact| [contact.a, contact.b]);
    for v in meeting.chain(flat).flat_map(|t| draft.triangles[t as usize]) {
        matters[v as usize] = true;
    }
    // Vertices that fall together matter, although no triangle of theirs may meet another.
    for (v, &group) in places.group.iter().enumerate() {
        let first = places.first[group as usize] as usize;
        if first != v && draft.positions[first] != draft.positions[v] {
            (matters[v], matters[first]) = (true, true);
        }
    }
    Ok(round_those(draft, |v| matters[v], rounded))
}

/// A position as a reader of float32 has it. One beyond the range of float32 stays as it is.
fn in_f32(position: DVec3) -> DVec3 {
    let rounded = position.as_vec3().as_dvec3();
    if rounded.is_finite() { rounded } else { position }
}

fn round_those(
    draft: &mut Draft,
    is_chosen: impl Fn(usize) -> bool,
    rounded: impl Fn(DVec3) -> DVec3,
) -> Changes {
    let (mut moved, mut move_max) = (0, 0.0f64);
    for (_, position) in draft.positions.iter_mut().enumerate().filter(|&(v, _)| is_chosen(v)) {
        let place = rounded(*position);
        if place != *position {
            moved += 1;
            move_max = move_max.max(place.distance(*position));
            *position = place;
        }
    }
    Changes { move_max, ..Changes::counted([("vertices_moved", moved)]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_vertices_of_triangles_that_meet_in_float32_are_rounded() {
        // Two triangles over each other whose distance is less than a step of float32 there, and one beside them.
        let step = 2f64.powi(-26);
        let flat = |z: f64, x: f64| [[x, 0.1, z], [x + 1.0, 0.1, z], [x, 1.1, z]];
        let corners = [flat(1.0, 0.0), flat(1.0 + step, 0.25), flat(1.0, 5.1)];
        let positions: Vec<DVec3> = corners.as_flattened().iter().map(|&p| DVec3::from_array(p)).collect();
        let mut draft = Draft {
            vertex_origin: (0..9).collect(),
            triangle_origin: (0..3).collect(),
            triangles: vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]],
            positions: positions.clone(),
            ..Draft::default()
        };
        let changes = round_where_it_matters(&mut draft, &Budget::unlimited()).unwrap();
        assert_eq!(changes.count("vertices_moved"), 6);
        assert_eq!(draft.positions[3].z, 1.0);
        assert_eq!(draft.positions[6..], positions[6..]);
        assert!(changes.move_max < 1e-7);
    }

    #[test]
    fn only_vertices_of_triangles_that_all_but_meet_go_to_a_coarser_lattice() {
        // Two triangles over each other, less than half a coarse step apart, and one a step and a half above them.
        let pitch = print_pitch(6.1).unwrap();
        let step = 16.0 * pitch;
        let flat = |z: f64, x: f64| [[x, 0.1, z], [x + 1.0, 0.1, z], [x, 1.1, z]];
        let corners = [flat(step, 0.0), flat(step * 1.375, 0.25), flat(step * 2.75, 0.125), flat(0.0, 5.1)];
        let positions: Vec<DVec3> = corners.as_flattened().iter().map(|&p| DVec3::from_array(p)).collect();
        let mut draft = Draft {
            vertex_origin: (0..12).collect(),
            triangle_origin: (0..4).collect(),
            triangles: (0..4).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
            positions: positions.clone(),
            ..Draft::default()
        };
        let changes = round_to_coarser(&mut draft, 16, &Budget::unlimited()).unwrap();
        assert_eq!(changes.count("vertices_moved"), 6);
        assert!(draft.positions[..6].iter().all(|p| p.z == step && (*p / step).fract() == DVec3::ZERO));
        assert_eq!(draft.positions[6..], positions[6..]);
        assert!(changes.move_max <= step, "{}", changes.move_max / step);
    }

    #[test]
    fn only_what_float32_cannot_hold_moves_and_the_distance_is_told() {
        let mut draft = Draft {
            positions: vec![
                DVec3::new(0.5, 1.0, 2.0),
                DVec3::new(0.1, 0.0, 0.0),
                DVec3::new(1e300, 0.0, 0.0),
            ],
            ..Draft::default()
        };
        let changes = round_to_f32(&mut draft);
        assert_eq!(changes.count("vertices_moved"), 1);
        assert_eq!(draft.positions[1].x, f64::from(0.1f32));
        assert_eq!(changes.move_max, f64::from(0.1f32) - 0.1);
        assert_eq!(draft.positions[2].x, 1e300);
    }
}
