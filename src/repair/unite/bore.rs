//! Takes contacts out of a solid: where it touches itself in a vertex or an edge, a body of some steps of the print lattice is
//! subtracted from it by the exact arrangement. What touched is apart then, however many sheets met there.

use super::unite_as_oriented;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::figures::figure;
use crate::geom::{DVec3, print_pitch};
use crate::mesh::{EdgeGroups, edge_of, singular_vertices, twins};
use crate::repair::{Changes, Draft, Effects, NEW};

/// Corners of the body around a vertex, in steps of the lattice from it for a body of 16 steps, one opposite the other. They are on no common plane
/// with the axes, so that faces of a part seldom lie in its sides.
const AROUND: [[f64; 3]; 3] = [[15.0, 4.0, -3.0], [-3.0, 14.0, 5.0], [4.0, -5.0, 15.0]];

/// Subtracts a small body from `draft` at every vertex and edge where it touches itself, of about `steps` steps of the lattice from
/// the middle out, in whole multiples of 16. The draft must be welded, closed and
/// with a winding number of 0 or 1 everywhere, as [`unite`](super::unite) makes it.
///
/// # Errors
/// When the budget stops the run.
pub fn bore_contacts(draft: &mut Draft, steps: u32, budget: &Budget) -> Result<Changes, Stopped> {
    let groups = EdgeGroups::build(&draft.triangles, draft.positions.len(), budget)?;
    let twins = twins(&groups, draft.triangles.len(), budget)?;
    let vertices = singular_vertices(&draft.triangles, draft.positions.len(), &twins, budget)?;
    let mut edges = Vec::new();
    for (e, group) in groups.iter().enumerate() {
        if e % CHECK_EVERY == 0 {
            budget.spend(CHECK_EVERY as u64)?;
        }
        if group.len() > 2 {
            edges.push(edge_of(&draft.triangles, group[0]));
        }
    }
    let reach = draft.positions.iter().fold(0.0, |reach, p| p.abs().max_element().max(reach));
    let count = (vertices.len() + edges.len()) as u64;
    let (Some(pitch), true) = (print_pitch(reach), count > 0) else {
        return Ok(Changes::counted([("contacts_bored", 0)]));
    };
    let mut bodies = Bodies { draft, pitch, size: f64::from((steps / 16).max(1)) };
    for v in vertices {
        bodies.push_around_vertex(v);
    }
    for edge in edges {
        bodies.push_along_edge(edge);
    }
    let united = unite_as_oriented(draft, budget)?;
    let reason = format!("bodies of {steps} steps of {} were taken out of {count} contacts", figure(pitch));
    let reason = if united.reason.is_empty() { reason } else { format!("{reason}; {}", united.reason) };
    let counts = [("contacts_bored", count)].into_iter().chain(united.counts).collect();
    // What touched is nowhere farther than that from what is left.
    let move_max = united.move_max.max(f64::from(steps.max(16)) * pitch);
    let effects = Effects { bored_contacts: Some(count), ..united.effects };
    Ok(Changes { counts, reason, move_max, effects, coverage: None, ..united })
}

/// Adds bodies to a draft that are turned inside out.
struct Bodies<'d> {
    draft: &'d mut Draft,
    pitch: f64,
    /// How large they are, in units of 16 steps.
    size: f64,
}

impl Bodies<'_> {
    /// An octahedron.
    fn push_around_vertex(&mut self, v: u32) {
        let middle = self.draft.positions[v as usize];
        let corners = AROUND.map(|offset| DVec3::from_array(offset) * self.size * self.pitch);
        let places = corners.iter().flat_map(|&corner| [middle + corner, middle - corner]);
        let first = self.push_places(places, v);
        // Corner `2 k` is along axis `k`, `2 k + 1` opposite.
        for signs in 0..8u32 {
            let [a, b, c] = [0, 1, 2].map(|k| first + 2 * k + (signs >> k & 1));
            let is_odd = signs.count_ones() % 2 == 1;
            self.push_triangle(if is_odd { [a, b, c] } else { [a, c, b] });
        }
    }

    /// A prism with the edge inside.
    fn push_along_edge(&mut self, [a, b]: [u32; 2]) {
        let ends = [a, b].map(|v| self.draft.positions[v as usize]);
        let along = (ends[1] - ends[0]).normalize_or(DVec3::X);
        let (across, beside) = along.any_orthonormal_pair();
        let size = 10.0 * self.size * self.pitch;
        let turned = |angle: f64| (across * libm::cos(angle) + beside * libm::sin(angle)) * size;
        let offsets = [0.3, 0.3 + std::f64::consts::TAU / 3.0, 0.3 + 2.0 * std::f64::consts::TAU / 3.0]
            .map(|angle| (turned(angle) / self.pitch).round() * self.pitch);
        let first = self.push_places(offsets.iter().flat_map(|&o| ends.map(|end| end + o)), a);
        // Corner `2 k` is at the first end, `2 k + 1` at the other.
        for k in 0..3 {
            let [low, next] = [first + 2 * k, first + 2 * ((k + 1) % 3)];
            self.push_triangle([low, low + 1, next]);
            self.push_triangle([next, low + 1, next + 1]);
        }
        self.push_triangle([first, first + 2, first + 4]);
        self.push_triangle([first + 1, first + 5, first + 3]);
    }

    fn push_places(&mut self, places: impl Iterator<Item = DVec3>, like: u32) -> u32 {
        let first = self.draft.positions.len() as u32;
        self.draft.positions.extend(places);
        let origin = self.draft.vertex_origin[like as usize];
        self.draft.vertex_origin.resize(self.draft.positions.len(), origin);
        first
    }

    fn push_triangle(&mut self, corners: [u32; 3]) {
        self.draft.triangles.push(corners);
        self.draft.triangle_origin.push(NEW);
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{cubes, volume_times_6};
    use super::super::unite;
    use super::*;
    use crate::repair::weld::weld;

    fn singular(draft: &Draft) -> (usize, usize) {
        let budget = Budget::unlimited();
        let groups = EdgeGroups::build(&draft.triangles, draft.positions.len(), &budget).unwrap();
        let twins = twins(&groups, draft.triangles.len(), &budget).unwrap();
        let vertices = singular_vertices(&draft.triangles, draft.positions.len(), &twins, &budget).unwrap();
        (groups.iter().filter(|group| group.len() != 2).count(), vertices.len())
    }

    #[test]
    fn cubes_that_touch_in_an_edge_or_a_vertex_come_apart_by_a_few_steps() {
        let tip = DVec3::ONE;
        let edge = DVec3::new(1.0, 1.0, 0.0);
        // Seven cubes of the eight around a vertex would fill it; these four touch in it and in no face.
        let four = [DVec3::ZERO, edge, DVec3::new(1.0, 0.0, 1.0), DVec3::new(0.0, 1.0, 1.0)];
        for (places, contacts) in
            [(&[DVec3::ZERO, tip][..], (0, 1)), (&[DVec3::ZERO, edge], (1, 2)), (&four, (6, 7))]
        {
            let budget = Budget::unlimited();
            let bodies: Vec<_> = places.iter().map(|&place| (place, 1.0, false)).collect();
            let mut draft = cubes(&bodies);
            weld(&mut draft, &budget).unwrap();
            unite(&mut draft, &budget).unwrap();
            assert_eq!(singular(&draft), contacts);
            let before = volume_times_6(&draft);
            let changes = bore_contacts(&mut draft, 16, &budget).unwrap();
            assert_eq!(changes.count("contacts_bored"), (contacts.0 + contacts.1) as u64);
            // A prism that ends at another's side may touch what is left there; a larger body takes that too.
            for steps in [64, 256] {
                bore_contacts(&mut draft, steps, &budget).unwrap();
            }
            weld(&mut draft, &budget).unwrap();
            assert_eq!(singular(&draft), (0, 0), "{}", changes.reason);
            let taken = before - volume_times_6(&draft);
            // Rounded corners tilt the faces that they are on.
            assert!(taken.abs() < 1e-5, "{taken}");
            assert_eq!(draft.check(), Vec::<String>::new());
        }
    }

    #[test]
    fn a_solid_that_does_not_touch_itself_stays_as_it_is() {
        let mut draft = cubes(&[(DVec3::ZERO, 1.0, false)]);
        let before = draft.clone();
        assert_eq!(bore_contacts(&mut draft, 16, &Budget::unlimited()).unwrap().count("contacts_bored"), 0);
        assert_eq!(draft, before);
    }
}
