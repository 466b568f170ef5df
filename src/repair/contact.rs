//! Opens contacts: where bodies or sheets touch in a vertex or an edge, all but one are drawn back by some steps of the
//! print lattice, so that a reader that welds does not join them again.

use super::{Changes, Draft, Star};
use crate::budget::{Budget, Stopped};
use crate::figures::figure;
use crate::geom::print_pitch;
use crate::spatial::coincident_f64;

/// Steps of the lattice that a vertex is drawn back by: a quarter of a micrometre on a bed of 256 mm. Where that turns a triangle
/// over, less and then more is tried.
const STEPS: [f64; 5] = [16.0, 8.0, 4.0, 32.0, 64.0];

/// Draws every vertex that has the position of an earlier one away from that: into the solid behind its own triangles, or
/// out of it where the earlier one is inside of that. Where every distance would turn a triangle over, the earlier one is drawn away
/// instead, or both stay. The draft must be a manifold (see [`cut`](super::cut::cut)).
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
    let first_at = |v: u32| places.first[places.group[v as usize] as usize];
    let later: Vec<u32> = (0..draft.positions.len() as u32).filter(|&v| first_at(v) != v).collect();
    let reach = draft.positions.iter().fold(0.0, |reach, p| p.abs().max_element().max(reach));
    let (Some(pitch), false) = (print_pitch(reach), later.is_empty()) else {
        return Ok(Changes::counted([("vertices_moved", 0)]));
    };
    let (mut moved, mut move_max) = (0, 0.0f64);
    let mut firsts: Vec<u32> = later.iter().map(|&v| first_at(v)).collect();
    firsts.sort_unstable();
    firsts.dedup();
    let stars_of_firsts = Star::of_each(draft, &firsts, budget)?;
    for star in Star::of_each(draft, &later, budget)? {
        budget.spend(star.triangles.len() as u64 / 8 + 1)?;
        let from = draft.positions[star.vertex as usize];
        let first = firsts.binary_search(&first_at(star.vertex)).map_or(&star, |i| &stars_of_firsts[i]);
        let drawn = |one: &Star, other: &Star, draft: &Draft| {
            let away = one.away_from(other, draft);
            let places =
                STEPS.into_iter().filter_map(|steps| one.place(draft, from + away * (steps * pitch), pitch));
            places.filter(|&place| place != from).map(|place| (one.vertex, place)).next()
        };
        let is_where_it_was = draft.positions[first.vertex as usize] == from;
        let place = drawn(&star, first, draft).or_else(|| {
            drawn(first, &star, draft).filter(|_| is_where_it_was && first.vertex != star.vertex)
        });
        if let Some((vertex, place)) = place {
            move_max = move_max.max(place.distance(from));
            draft.positions[vertex as usize] = place;
            moved += 1;
        }
    }
    let most = (move_max / pitch).round();
    let reason = format!(
        "contacts were opened by drawing {moved} vertices back by up to {most} steps of {}",
        figure(pitch)
    );
    Ok(Changes { move_max, reason, ..Changes::counted([("vertices_moved", moved)]) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;

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
            blends: Default::default(),
            polygons: Default::default(),
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
}
