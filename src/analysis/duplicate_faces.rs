//! Duplicate faces: triangles with the same three positions, and polygons with the same corners in the same order, from
//! whichever they begin.
//!
//! In the same direction they are a face written twice; in opposite directions a sheet with two sides and nothing
//! between them. Each triangle beyond the first of its three positions counts once: as a duplicate where an earlier one
//! has its direction, otherwise as the opposite.

use super::names::middle;
use super::welded::Welded;
use super::{Context, DefectCode, Finding};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::mesh::{PolygonCopy, edge_of, polygon_copies, prev_corner, triangle_of};
use crate::par;
use crate::spatial::{Contacts, TriangleContact};
use std::borrow::Cow;

/// A triangle that has the vertices of an earlier one, or is a part of a polygon that has.
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
    of_polygons(mesh, &mut repeats, budget)?;
    Ok(repeats)
}

/// Adds the triangles of copied polygons that are no repeats by themselves, because the diagonals are others.
fn of_polygons(mesh: &Welded<'_>, repeats: &mut Vec<Repeat>, budget: &Budget) -> Result<(), Stopped> {
    let polygons = &mesh.soup.polygons;
    if polygons.faces.len() < 2 {
        return Ok(());
    }
    let copies = polygon_copies(polygons, |v| mesh.first_at(v), budget)?;
    let mut by_first: Vec<PolygonCopy> = copies;
    by_first.sort_unstable_by_key(|copy| (copy.of, copy.polygon));
    let mut more = Vec::new();
    for same in by_first.chunk_by(|a, b| a.of == b.of) {
        let first_against = same.iter().find(|copy| copy.is_reversed).map(|copy| copy.polygon);
        for copy in same {
            budget.spend(1)?;
            let of = match first_against {
                Some(against) if copy.is_reversed => against,
                _ => copy.of,
            };
            let is_opposite = first_against == Some(copy.polygon);
            let of = if is_opposite { copy.of } else { of };
            let corners = polygons.corners_of(copy.polygon as usize).len() as u32;
            let [first, first_of] = [copy.polygon, of].map(|p| polygons.first_triangles[p as usize]);
            let Some(of) = mesh.triangle_of_source(first_of) else { continue };
            let triangles = (first..first + corners - 2).filter_map(|t| mesh.triangle_of_source(t));
            let is_new = |t: &u32| repeats.binary_search_by_key(t, |r| r.triangle).is_err();
            more.extend(triangles.filter(is_new).map(|triangle| Repeat { triangle, of, is_opposite }));
        }
    }
    repeats.extend(more);
    repeats.sort_unstable();
    Ok(())
}

/// `contacts` without those of triangles of a copied polygon with those of the polygon it is a copy of, which are told as
/// duplicates. As they are where not all are listed.
pub(super) fn without_copies<'c>(
    contacts: Cow<'c, Contacts>,
    mesh: &Welded<'_>,
    repeats: &[Repeat],
) -> Cow<'c, Contacts> {
    let polygons = &mesh.soup.polygons;
    if polygons.faces.len() < 2 || repeats.is_empty() || !contacts.are_all_listed() {
        return contacts;
    }
    let repeat_of = |t: u32| {
        let found = mesh.triangle_of_source(t)?;
        let i = repeats.binary_search_by_key(&found, |r| r.triangle).ok()?;
        Some(mesh.source(repeats[i].of))
    };
    // A copy in the other direction may stand between a later one and the first.
    let stands_for = |t: u32| {
        let of = repeat_of(t).unwrap_or(t);
        mesh.soup.face_of(repeat_of(of).unwrap_or(of))
    };
    let is_copy = |c: &TriangleContact| {
        stands_for(c.a) == stands_for(c.b) && mesh.soup.face_of(c.a) != mesh.soup.face_of(c.b)
    };
    if !contacts.list.iter().any(is_copy) {
        return contacts;
    }
    let mut left = Contacts::default();
    for &contact in contacts.list.iter().filter(|c| !is_copy(c)) {
        left.count += 1;
        left.count_by_kind[contact.kind as usize] += 1;
        left.list.push(contact);
    }
    Cow::Owned(left)
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
