//! Cuts singular edges and vertices. The copies stay at their positions, so a reader that welds joins them again.

use super::{Changes, Draft};
use crate::budget::{Budget, Stopped};
use crate::mesh;

/// Makes the draft a coherently oriented manifold with boundary by copying singular vertices.
///
/// # Errors
/// When the budget stops the run.
pub fn cut_singular(draft: &mut Draft, budget: &Budget) -> Result<Changes, Stopped> {
    let cut = mesh::cut_singular(&mut draft.triangles, draft.positions.len(), budget)?;
    for &v in &cut.copies {
        draft.positions.push(draft.positions[v as usize]);
        draft.vertex_origin.push(draft.vertex_origin[v as usize]);
    }
    Ok(Changes::counted([
        ("singular_edges", cut.singular_edges),
        ("vertices_copied", cut.copies.len() as u64),
    ]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;

    #[test]
    fn copies_keep_position_and_origin() {
        let mut draft = Draft {
            positions: (0..5).map(|i| DVec3::splat(f64::from(i))).collect(),
            vertex_origin: vec![10, 11, 12, 13, 14],
            triangles: vec![[0, 1, 2], [0, 3, 4]],
            triangle_origin: vec![0, 1],
            two_sided: Vec::new(),
        };
        let changes = cut_singular(&mut draft, &Budget::unlimited()).unwrap();
        assert_eq!(changes.count("vertices_copied"), 1);
        assert_eq!((draft.positions[5], draft.vertex_origin[5]), (DVec3::ZERO, 10));
        assert!(draft.check().is_empty());
    }
}
