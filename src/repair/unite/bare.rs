//! Copies what bounds nothing: triangles of which a part has void on both sides, which a union would lose.

use super::arranged;
use crate::arrangement::{Arrangement, ArrangementError};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::mesh::cut_singular;
use crate::repair::{Changes, Draft, NEW};

/// Adds a copy of every triangle of which a piece has void on both sides, as open parts of their own, which walls can be put
/// behind. Triangles that cancel each other exactly go. The surface must be closed; where there is no arrangement, nothing changes.
///
/// # Errors
/// When the budget stops the run.
pub fn copy_bare(draft: &mut Draft, budget: &Budget) -> Result<Changes, Stopped> {
    let arrangement = match arranged(draft, budget) {
        Ok(arrangement) => arrangement,
        Err(ArrangementError::Stopped(stopped)) => return Err(stopped),
        Err(error) => {
            let reason = format!("nothing was copied: {error}");
            return Ok(Changes { reason, ..Changes::counted([("triangles_copied", 0)]) });
        }
    };
    let is_bare = |f: &usize| arrangement.windings(*f).iter().all(|winding| winding[0] <= 0);
    let bare = (0..arrangement.pieces().len()).filter(is_bare);
    let mut bare: Vec<u32> = bare.map(|f| source(draft, &arrangement, f)).collect();
    drop(arrangement);
    bare.sort_unstable();
    bare.dedup();
    let mut corners: Vec<u32> = bare.iter().flat_map(|&t| draft.triangles[t as usize]).collect();
    corners.sort_unstable();
    corners.dedup();
    let number = |v: u32| corners.partition_point(|&c| c < v) as u32;
    let mut copies: Vec<[u32; 3]> = bare.iter().map(|&t| draft.triangles[t as usize].map(number)).collect();
    let cut = cut_singular(&mut copies, corners.len(), budget)?;
    corners.extend(cut.copies.iter().map(|&v| corners[v as usize]).collect::<Vec<u32>>());
    let origins: Vec<u32> = bare.iter().map(|&t| draft.triangle_origin[t as usize]).collect();
    let cancelled = drop_cancelling(draft, budget)?;
    let first = draft.positions.len() as u32;
    for v in corners {
        draft.positions.push(draft.positions[v as usize]);
        draft.vertex_origin.push(draft.vertex_origin[v as usize]);
    }
    draft.triangles.extend(copies.into_iter().map(|t| t.map(|v| first + v)));
    draft.triangle_origin.extend(origins);
    let counts = [("triangles_copied", bare.len() as u64), ("triangles_cancelled", cancelled)];
    Ok(Changes::counted(counts))
}

/// Of the triangles that cover a piece the first one that is of the file, or else the first.
fn source(draft: &Draft, arrangement: &Arrangement, piece: usize) -> u32 {
    let sources = arrangement.sources(piece);
    let is_of_file = |&&(t, _): &&(u32, bool)| draft.triangle_origin[t as usize] != NEW;
    sources.iter().find(is_of_file).unwrap_or(&sources[0]).0
}

/// Drops pairs of triangles on the same corners that turn opposite ways; gives the number of triangles.
fn drop_cancelling(draft: &mut Draft, budget: &Budget) -> Result<u64, Stopped> {
    let mut order: Vec<([u32; 3], bool, u32)> = Vec::with_capacity(draft.triangles.len());
    for (t, &corners) in draft.triangles.iter().enumerate() {
        if t % CHECK_EVERY == 0 {
            budget.spend(CHECK_EVERY as u64)?;
        }
        let mut sorted = corners;
        sorted.sort_unstable();
        let [a, b, c] = corners;
        let is_turned = [[a, b, c], [b, c, a], [c, a, b]].iter().all(|&turn| turn != sorted);
        order.push((sorted, is_turned, t as u32));
    }
    order.sort_unstable();
    let mut is_gone = vec![false; draft.triangles.len()];
    for same in order.chunk_by(|a, b| a.0 == b.0) {
        let ahead = same.partition_point(|&(_, is_turned, _)| !is_turned);
        for i in 0..ahead.min(same.len() - ahead) {
            is_gone[same[i].2 as usize] = true;
            is_gone[same[ahead + i].2 as usize] = true;
        }
    }
    let gone = is_gone.iter().filter(|&&gone| gone).count() as u64;
    if gone > 0 {
        let kept = |i: usize| !is_gone[i];
        let mut i = 0;
        draft.triangles.retain(|_| {
            i += 1;
            kept(i - 1)
        });
        i = 0;
        draft.triangle_origin.retain(|_| {
            i += 1;
            kept(i - 1)
        });
    }
    Ok(gone)
}

#[cfg(test)]
mod tests {
    use super::super::tests::{cubes, volume_times_6};
    use super::super::unite;
    use super::*;
    use crate::geom::DVec3;
    use crate::repair::thicken::thicken;

    #[test]
    fn a_fin_on_a_cube_is_copied_and_the_cube_is_not() {
        let mut draft = cubes(&[(DVec3::ZERO, 1.0, false)]);
        let first = draft.positions.len() as u32;
        draft.positions.extend([
            DVec3::new(0.5, 0.5, 0.5),
            DVec3::new(0.75, 0.5, 2.0),
            DVec3::new(0.25, 0.5, 2.0),
        ]);
        draft.vertex_origin.extend([8, 9, 10]);
        // A triangle that sticks out of the cube, on both sides.
        draft.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 1]]);
        draft.triangle_origin.extend([12, NEW]);
        let budget = Budget::unlimited();
        let changes = copy_bare(&mut draft, &budget).unwrap();
        assert_eq!((changes.count("triangles_copied"), changes.count("triangles_cancelled")), (1, 2));
        assert_eq!(draft.triangle_origin[12..], [12]);
        assert_eq!(draft.check(), Vec::<String>::new());
        thicken(&mut draft, 0.125, &budget).unwrap();
        unite(&mut draft, &budget).unwrap();
        // The wall has its whole thickness outside of the cube.
        let fin = (0.5 - 0.5 / 9.0) / 2.0 * 0.125;
        let volume = volume_times_6(&draft) / 6.0;
        assert!(volume > 1.0 + 0.5 * fin && volume < 1.0 + 2.0 * fin, "{volume}");
        assert!(draft.triangle_origin.contains(&12));
    }
}
