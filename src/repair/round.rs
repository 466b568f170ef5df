//! Rounds coordinates to float32, for files that hold no more and for readers that keep no more.

use super::{Changes, Draft};
use crate::budget::{Budget, Stopped};
use crate::geom::{DVec3, are_collinear, closest_point_on_triangle, print_pitch};
use crate::spatial::{Bvh, Search, coincident_f64, self_contacts};

/// Triangles are clear of each other from so many steps of a coarser lattice on: more than two vertices may move there together.
const CLEAR_OF: f64 = 2.0;

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
    round_clusters(draft, in_f32, f64::INFINITY, budget)
}

/// Moves the vertices of triangles that meet others, or lose their area, when all coordinates are read as whole multiples of so many
/// `steps` of the print lattice, to such multiples: what is all but in one plane is in one plane then, or apart by more than
/// new vertices are rounded by. Two triangles that pass clearly through each other, so that no vertex of one is within two such
/// multiples of the other and no edge within that of another's, stay where they are. Vertices that fall together stay several.
///
/// # Errors
/// When the budget stops the run.
pub fn round_to_coarser(draft: &mut Draft, steps: u32, budget: &Budget) -> Result<Changes, Stopped> {
    let reach = draft.positions.iter().fold(0.0, |reach, p| p.abs().max_element().max(reach));
    match print_pitch(reach) {
        Some(pitch) => {
            let coarse = pitch * f64::from(steps.max(1));
            let rounded = |position: DVec3| (position / coarse).round() * coarse + DVec3::ZERO;
            round_clusters(draft, rounded, CLEAR_OF * coarse, budget)
        }
        None => Ok(Changes::counted([("vertices_moved", 0)])),
    }
}

/// Moves the vertices of triangles that meet others, or lose their area, when all positions are `rounded`, to where they are then;
/// those that pass through others and are `clear` of their vertices and edges stay.
fn round_clusters(
    draft: &mut Draft,
    rounded: impl Fn(DVec3) -> DVec3,
    clear: f64,
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
    budget.spend(contacts.list.len() as u64)?;
    let corners = |t: u32| draft.corners(t as usize);
    let close = contacts.list.iter().filter(|pair| come_within(corners(pair.a), corners(pair.b), clear));
    let meeting = close.flat_map(|contact| [contact.a, contact.b]);
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

/// True when a vertex of one triangle is no farther than `distance` from the other, or an edge of one from an edge of the other.
fn come_within(one: [DVec3; 3], other: [DVec3; 3], distance: f64) -> bool {
    let has_near_vertex = |of: [DVec3; 3], to: [DVec3; 3]| {
        of.iter().any(|&p| closest_point_on_triangle(p, to).distance(p) <= distance)
    };
    let edges = |[a, b, c]: [DVec3; 3]| [[a, b], [b, c], [c, a]];
    distance == f64::INFINITY
        || has_near_vertex(one, other)
        || has_near_vertex(other, one)
        || edges(one).iter().any(|&e| edges(other).iter().any(|&f| cross_within(e, f, distance)))
}

/// True when two edges come no farther than `distance` to each other between their ends.
fn cross_within([a, b]: [DVec3; 2], [c, d]: [DVec3; 2], distance: f64) -> bool {
    let (along, other, between) = (b - a, d - c, c - a);
    let normal = along.cross(other);
    let square = normal.length_squared();
    let shares = [other, along].map(|edge| between.cross(edge).dot(normal) / square);
    shares.iter().all(|share| (0.0..=1.0).contains(share))
        && between.dot(normal).abs() <= distance * square.sqrt()
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
    fn triangles_that_pass_clearly_through_each_other_stay_and_those_whose_edges_all_but_meet_move() {
        let step = 16.0 * print_pitch(8.0).unwrap();
        let through = |beside: f64| {
            // An upright triangle through the middle of a flat one, or with its edge beside one of its edges.
            let upright =
                [[1.0 / 3.0, beside, -1.03], [1.0 / 3.0, beside, 2.03], [1.0 / 3.0, 3.03 + beside, 0.01]];
            let flat = [[-7.01, -0.013, 0.007], [7.03, -0.013, 0.007], [0.1, 7.01, 0.007]];
            let positions = [flat, upright].as_flattened().iter().map(|&p| DVec3::from_array(p)).collect();
            let mut draft = Draft {
                vertex_origin: (0..6).collect(),
                triangle_origin: vec![0, 1],
                triangles: vec![[0, 1, 2], [3, 4, 5]],
                positions,
                ..Draft::default()
            };
            round_to_coarser(&mut draft, 16, &Budget::unlimited()).unwrap().count("vertices_moved")
        };
        assert_eq!(through(1.0), 0);
        assert_eq!(through(-0.013 + 1.5 * step), 6);
        assert_eq!(through(-0.013 + 8.0 * step), 0);
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
