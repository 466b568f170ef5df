//! Joins vertices at one position. No vertex moves.

use super::{Changes, Draft};
use crate::budget::{Budget, Stopped};
use crate::spatial::coincident_f64;

/// Gives all vertices with equal coordinates one id; of those, the first keeps its place.
///
/// # Errors
/// When the budget stops the run.
pub fn weld(draft: &mut Draft, budget: &Budget) -> Result<Changes, Stopped> {
    let coincident = coincident_f64(&draft.positions, budget)?;
    let joined = draft.positions.len() - coincident.first.len();
    if joined > 0 {
        for v in draft.triangles.as_flattened_mut() {
            *v = coincident.group[*v as usize];
        }
        draft.positions = coincident.first.iter().map(|&v| draft.positions[v as usize]).collect();
        draft.vertex_origin = coincident.first.iter().map(|&v| draft.vertex_origin[v as usize]).collect();
    }
    Ok(Changes::counted([("vertices_joined", joined as u64)]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;

    #[test]
    fn two_triangles_along_a_seam_share_its_two_vertices_afterwards() {
        let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
        let mut draft = Draft {
            positions: vec![
                at(0.0, 0.0),
                at(1.0, 0.0),
                at(0.0, 1.0),
                at(1.0, -0.0),
                at(0.0, 1.0),
                at(1.0, 1.0),
            ],
            vertex_origin: (0..6).collect(),
            triangles: vec![[0, 1, 2], [3, 5, 4]],
            triangle_origin: vec![0, 1],
            two_sided: Vec::new(),
            blends: Default::default(),
            polygons: Default::default(),
        };
        let changes = weld(&mut draft, &Budget::unlimited()).unwrap();
        assert_eq!(changes.count("vertices_joined"), 2);
        assert_eq!(draft.triangles, [[0, 1, 2], [1, 3, 2]]);
        assert_eq!(draft.vertex_origin, [0, 1, 2, 5]);
        assert!(draft.check().is_empty());
    }
}
