//! Removes whole parts, as the caller chose them.

use super::{Changes, Draft};
use crate::budget::{Budget, Stopped};
use crate::mesh::EdgeGroups;

/// Removes the parts connected by edges in which one of `triangles` (of the soup) is. To be run on welded vertices.
///
/// # Errors
/// When the budget stops the run.
pub fn remove_parts(draft: &mut Draft, triangles: &[u32], budget: &Budget) -> Result<Changes, Stopped> {
    let parts = EdgeGroups::build(&draft.triangles, draft.positions.len(), budget)?.components(budget)?;
    let mut listed = triangles.to_vec();
    listed.sort_unstable();
    let mut removed_parts = Vec::new();
    let mut goes = vec![false; parts.count as usize];
    for (t, origin) in draft.triangle_origin.iter().enumerate() {
        let part = parts.of[t] as usize;
        if !goes[part] && listed.binary_search(origin).is_ok() {
            goes[part] = true;
            removed_parts.push(*origin);
        }
    }
    let is_kept: Vec<bool> = parts.of.iter().map(|&part| !goes[part as usize]).collect();
    let removed = is_kept.iter().filter(|&&kept| !kept).count() as u64;
    draft.retain_triangles(&is_kept);
    draft.drop_unused_vertices();
    let reason = match removed_parts.len() {
        0 => String::new(),
        count => format!("{count} parts were removed as chosen"),
    };
    let counts = [("parts_removed", removed_parts.len() as u64), ("part_triangles_removed", removed)];
    Ok(Changes { reason, removed_parts, ..Changes::counted(counts) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;

    #[test]
    fn a_part_goes_as_a_whole_and_is_listed_and_what_it_touches_in_a_vertex_stays() {
        let mut draft = Draft {
            positions: (0..6).map(|i| DVec3::splat(f64::from(i))).collect(),
            vertex_origin: (0..6).collect(),
            triangles: vec![[0, 1, 2], [2, 1, 3], [0, 4, 5]],
            triangle_origin: vec![7, 8, 9],
            ..Draft::default()
        };
        let changes = remove_parts(&mut draft, &[8, 100], &Budget::unlimited()).unwrap();
        assert_eq!((changes.count("parts_removed"), changes.count("part_triangles_removed")), (1, 2));
        assert_eq!(changes.removed_parts, [8]);
        assert_eq!((draft.triangle_origin.as_slice(), draft.positions.len()), (&[9][..], 3));
        assert!(draft.check().is_empty());
    }
}
