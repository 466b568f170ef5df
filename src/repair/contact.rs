//! Opens contacts: where bodies or sheets touch in a vertex or an edge, all but one are drawn back by some steps of the
//! print lattice, so that a reader that welds does not join them again.

use super::{Changes, Draft};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{DVec3, are_collinear, print_pitch};
use crate::spatial::coincident_f64;

/// Steps of the lattice that a vertex is drawn back by: a quarter of a micrometre on a bed of 256 mm.
const STEPS: f64 = 16.0;

/// Draws every vertex that has the position of an earlier one into the solid behind its own triangles. One that would
/// turn a triangle over stays. The draft must be a manifold (see [`cut`](super::cut::cut)).
///
/// ```text
///      \   /             \   /
///       \ /               \ /        two fans at one position: the second is drawn into its own body
///        x       gives     x
///       / \                .
///      /   \              / \
/// ```
///
/// # Errors
/// When the budget stops the run.
pub fn open_contacts(draft: &mut Draft, budget: &Budget) -> Result<Changes, Stopped> {
    let places = coincident_f64(&draft.positions, budget)?;
    let later: Vec<u32> = (0..draft.positions.len() as u32)
        .filter(|&v| places.first[places.group[v as usize] as usize] != v)
        .collect();
    let reach = draft.positions.iter().fold(0.0, |reach, p| p.abs().max_element().max(reach));
    let (Some(pitch), false) = (print_pitch(reach), later.is_empty()) else {
        return Ok(Changes::counted([("vertices_moved", 0)]));
    };
    let stars = stars_of(draft, &later, budget)?;
    let (mut moved, mut move_max) = (0, 0.0f64);
    for (&v, star) in later.iter().zip(&stars) {
        budget.spend(star.len() as u64 / 8 + 1)?;
        if let Some(place) = drawn_back(draft, v, star, pitch) {
            move_max = move_max.max(place.distance(draft.positions[v as usize]));
            draft.positions[v as usize] = place;
            moved += 1;
        }
    }
    let reason =
        format!("contacts were opened by drawing {moved} vertices back by {STEPS} steps of {pitch:e}");
    Ok(Changes { move_max, reason, ..Changes::counted([("vertices_moved", moved)]) })
}

/// The triangles around each of `vertices`, which must ascend.
fn stars_of(draft: &Draft, vertices: &[u32], budget: &Budget) -> Result<Vec<Vec<u32>>, Stopped> {
    let mut stars = vec![Vec::new(); vertices.len()];
    for (t, corners) in draft.triangles.iter().enumerate() {
        if t % CHECK_EVERY == 0 {
            budget.check()?;
        }
        for v in corners {
            if let Ok(i) = vertices.binary_search(v) {
                stars[i].push(t as u32);
            }
        }
    }
    Ok(stars)
}

/// Where vertex `v` goes; `None` when there is no good place.
fn drawn_back(draft: &Draft, v: u32, star: &[u32], pitch: f64) -> Option<DVec3> {
    let unit_normal = |[a, b, c]: [DVec3; 3]| (b - a).normalize_or_zero().cross((c - a).normalize_or_zero());
    let normals: Vec<DVec3> =
        star.iter().map(|&t| unit_normal(draft.corners(t as usize)).normalize_or_zero()).collect();
    let inward = -middle(&normals);
    let on_lattice = |x: f64| (x / pitch).round_ties_even() * pitch;
    let place = (draft.positions[v as usize] + inward * (STEPS * pitch)).map(on_lattice);
    let is_kept = |&t: &u32| {
        let was = draft.corners(t as usize);
        let corners = draft.triangles[t as usize];
        let is = [0, 1, 2].map(|k| if corners[k] == v { place } else { was[k] });
        !are_collinear(is[0], is[1], is[2]) && unit_normal(was).dot(unit_normal(is)) > 0.0
    };
    (inward != DVec3::ZERO && star.iter().all(is_kept)).then_some(place)
}

/// A direction on the side of all `normals` if there is one: the one that is farthest from it is added until none is on
/// the other side, but not for ever. Zero if they cancel out.
fn middle(normals: &[DVec3]) -> DVec3 {
    let mut sum: DVec3 = normals.iter().sum();
    for _ in 0..ROUNDS {
        let direction = sum.normalize_or_zero();
        let farthest = normals.iter().min_by(|a, b| a.dot(direction).total_cmp(&b.dot(direction)));
        match farthest {
            Some(normal) if normal.dot(direction) < ASIDE_MIN => sum += *normal,
            _ => break,
        }
    }
    sum.normalize_or_zero()
}

/// Additions after which a direction is taken as it is.
const ROUNDS: usize = 32;

/// Cosine that is enough between the direction and each normal.
const ASIDE_MIN: f64 = 0.1;

#[cfg(test)]
mod tests {
    use super::*;

    /// A tetrahedron with its right angle at `tip` that opens this way along every axis.
    fn corner(tip: [f64; 3], open: f64) -> [DVec3; 4] {
        let tip = DVec3::from_array(tip);
        [tip, tip + DVec3::X * open, tip + DVec3::Y * open, tip + DVec3::Z * open]
    }

    fn touching() -> Draft {
        let positions = [corner([0.0; 3], 1.0), corner([0.0; 3], -1.0)].concat();
        let solid = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let mirrored = solid.map(|[a, b, c]: [u32; 3]| [a + 4, c + 4, b + 4]);
        Draft {
            vertex_origin: (0..8).collect(),
            positions,
            triangles: [solid, mirrored].concat(),
            triangle_origin: (0..8).collect(),
            two_sided: Vec::new(),
        }
    }

    #[test]
    fn the_second_of_two_tips_is_drawn_into_its_body_and_the_first_stays() {
        let mut draft = touching();
        let changes = open_contacts(&mut draft, &Budget::unlimited()).unwrap();
        assert_eq!(changes.count("vertices_moved"), 1);
        assert_eq!(draft.positions[0], DVec3::ZERO);
        let tip = draft.positions[4];
        assert!(tip.max_element() < 0.0, "{tip}");
        assert_eq!(tip.as_vec3().as_dvec3(), tip);
        assert!((changes.move_max - 16.0 * 2f64.powi(-23)).abs() < 2f64.powi(-23), "{}", changes.move_max);
    }

    #[test]
    fn nothing_moves_where_nothing_touches() {
        let mut draft = touching();
        draft.positions[4] = DVec3::splat(-0.01);
        let before = draft.clone();
        assert_eq!(open_contacts(&mut draft, &Budget::unlimited()).unwrap().count("vertices_moved"), 0);
        assert_eq!(draft, before);
    }

    #[test]
    fn a_direction_is_found_on_the_side_of_all_normals_although_most_point_one_way() {
        let mut normals = vec![DVec3::X; 50];
        normals.push(DVec3::new(-0.6, 0.8, 0.0));
        let direction = middle(&normals);
        assert!(normals.iter().all(|normal| normal.dot(direction) > 0.0), "{direction}");
        assert_eq!(middle(&[DVec3::X, -DVec3::X]), DVec3::ZERO);
    }
}
