//! Duplicate faces: triangles with the same three positions.
//!
//! In the same direction they are a face written twice; in opposite directions a sheet with two sides and nothing
//! between them. Each triangle beyond the first of its three positions counts once: as a duplicate where an earlier one
//! has its direction, otherwise as the opposite.

use super::names::middle;
use super::welded::Welded;
use super::{Context, DefectCode, Finding};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::mesh::{edge_of, prev_corner, triangle_of};
use crate::par;

/// A triangle that has the vertices of an earlier one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Repeat {
    /// The later triangle.
    pub(super) triangle: u32,
    /// The first triangle of the same direction; of all, when the direction is new.
    pub(super) of: u32,
    /// No earlier triangle has the same direction.
    pub(super) is_opposite: bool,
}

/// All repeats, by triangle.
pub(super) fn repeats(mesh: &Welded<'_>, budget: &Budget) -> Result<Vec<Repeat>, Stopped> {
    let parts = par::try_map_ranges(mesh.edges.len(), CHECK_EVERY, |range| {
        budget.check()?;
        let mut repeats = Vec::new();
        for e in range {
            repeats_at_edge(&mesh.triangles, mesh.edges.group(e), &mut repeats);
        }
        Ok(repeats)
    })?;
    let mut repeats = parts.concat();
    par::sort_unstable(&mut repeats);
    Ok(repeats)
}

/// Repeats among the triangles at one edge, told only at the edge opposite to their largest vertex.
fn repeats_at_edge(triangles: &[[u32; 3]], group: &[u32], repeats: &mut Vec<Repeat>) {
    let opposite = |h: u32| edge_of(triangles, prev_corner(h))[0];
    if let &[a, b] = group
        && opposite(a) != opposite(b)
    {
        return;
    }
    if group.len() < 2 {
        return;
    }
    let larger_end = edge_of(triangles, group[0]).into_iter().max();
    let mut by_third: Vec<(u32, u32)> =
        group.iter().map(|&h| (opposite(h), h)).filter(|&(third, _)| Some(third) > larger_end).collect();
    by_third.sort_unstable();
    for same in by_third.chunk_by(|a, b| a.0 == b.0) {
        let from = |h: u32| edge_of(triangles, h)[0];
        let first = same[0].1;
        let first_against = same.iter().map(|&(_, h)| h).find(|&h| from(h) != from(first));
        for &(_, h) in &same[1..] {
            let is_opposite = first_against == Some(h);
            let of = match first_against {
                Some(against) if !is_opposite && from(h) != from(first) => against,
                _ => first,
            };
            repeats.push(Repeat { triangle: triangle_of(h), of: triangle_of(of), is_opposite });
        }
    }
}

pub(super) fn find(cx: &Context<'_>) -> Result<Vec<Finding>, Stopped> {
    let mesh = &cx.mesh;
    let found = |code, is_opposite| {
        let meant: Vec<Repeat> =
            cx.repeats.iter().copied().filter(|r| r.is_opposite == is_opposite).collect();
        Finding::of(code, &meant, cx.samples, |r| {
            let pair = [mesh.source(r.triangle), mesh.source(r.of)];
            mesh.names().triangles(&pair, middle(mesh.corners(r.triangle)))
        })
    };
    Ok([found(DefectCode::DuplicateFace, false), found(DefectCode::OppositeDuplicateFace, true)].concat())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::tests::{found, soup};

    const DUPLICATE: DefectCode = DefectCode::DuplicateFace;
    const OPPOSITE: DefectCode = DefectCode::OppositeDuplicateFace;

    #[test]
    fn a_face_written_twice_is_one_duplicate_of_the_first() {
        let finding = found(&soup(3, &[[0, 1, 2], [1, 2, 0]]), DUPLICATE).unwrap();
        assert_eq!(finding.count, 1);
        let faces: Vec<u32> = finding.witnesses[0].faces.iter().map(|f| f.index).collect();
        assert_eq!(faces, [1, 0]);
    }

    #[test]
    fn a_face_and_its_back_are_opposite() {
        let pillow = soup(3, &[[0, 1, 2], [0, 2, 1]]);
        assert_eq!(found(&pillow, OPPOSITE).unwrap().count, 1);
        assert_eq!(found(&pillow, DUPLICATE), None);
    }

    #[test]
    fn each_copy_counts_once_as_duplicate_of_the_first_in_its_own_direction() {
        let stack = soup(3, &[[0, 1, 2], [0, 2, 1], [1, 2, 0], [2, 1, 0]]);
        let duplicate = found(&stack, DUPLICATE).unwrap();
        let pairs: Vec<Vec<u32>> =
            duplicate.witnesses.iter().map(|w| w.faces.iter().map(|f| f.index).collect()).collect();
        assert_eq!(pairs, [[2, 0], [3, 1]]);
        assert_eq!(found(&stack, OPPOSITE).unwrap().count, 1);
    }

    #[test]
    fn neighbours_that_share_an_edge_only_are_no_duplicates() {
        assert_eq!(found(&soup(4, &[[0, 1, 2], [0, 2, 3]]), DUPLICATE), None);
    }
}
