//! The local cut: the star of each vertex with more than one fan is taken apart, and nothing else is looked at.

use super::CutMarks;
use crate::budget::{Budget, Stopped};
use crate::mesh::Fan;

pub(super) fn cut(
    triangles: &mut [[u32; 3]],
    vertex_count: usize,
    marks: &CutMarks,
    budget: &Budget,
) -> Result<Vec<u32>, Stopped> {
    let _charge = budget.charge(marks.corner_count() as u64 * 8)?;
    // All is decided on the old vertices before anything is written.
    let mut parted = Vec::new();
    for star in marks.stars() {
        budget.spend(1 + star.len() as u64 / 8)?;
        part(triangles, marks.twins(), star, &mut parted);
    }
    parted.sort_unstable();
    let mut copies = Vec::new();
    for fan in parted.chunk_by(|(head, _), (other, _)| head == other) {
        let copy = (vertex_count + copies.len()) as u32;
        copies.push(triangles.as_flattened()[fan[0].0 as usize]);
        for &(_, corner) in fan {
            triangles.as_flattened_mut()[corner as usize] = copy;
        }
    }
    Ok(copies)
}

/// Appends the corners of every fan of `star` but the first, each with the smallest corner of its fan.
fn part(triangles: &[[u32; 3]], twins: &[u32], star: &[u32], parted: &mut Vec<(u32, u32)>) {
    let mut is_walked = vec![false; star.len()];
    for (i, &head) in star.iter().enumerate() {
        if is_walked[i] {
            continue;
        }
        for corner in Fan::around(triangles, twins, head) {
            // Ascending, so that a corner is found by halving.
            let place = star.partition_point(|&c| c < corner);
            is_walked[place] = true;
            if i > 0 {
                parted.push((head, corner));
            }
        }
    }
}
