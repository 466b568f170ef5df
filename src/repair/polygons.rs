//! Splits polygons that pass a vertex more than once into simple ones, and copies of polygons alike.
//!
//! The first step of Guéziec, Taubin, Lazarus and Horn, "Cutting and stitching" (2001), who drop such faces; splitting
//! keeps the surface.

use super::{Changes, Draft};
use crate::budget::{Budget, Stopped};
use crate::formats::split_polygon;
use crate::geom::triangle_area;
use crate::mesh::{Soup, polygon_copies};
use crate::spatial::coincident_f64;

/// Areas whose difference is a smaller share of them are the same.
const SAME_AREA: f64 = 1e-12;

/// What becomes of a face that passes a vertex more than once.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum DegenerateFaces {
    /// The simple cycles that it is made of become faces of their own, and what has fewer than three corners goes; where it
    /// runs around a hole its triangles stay.
    #[default]
    Split,
    /// The whole face goes.
    Drop,
}

/// Replaces the triangles of each polygon of `soup` that has two corners at one position by those of its simple cycles, unless
/// these cover more, as where a polygon runs there and back between its outline and a hole: it would become two over each other.
/// Those of a polygon with the corners of an earlier one become triangles with the same diagonals, so
/// that copies of polygons are copies of triangles from whichever corner they begin and whichever way they run. The draft
/// must be as it was taken from `soup`.
///
/// ```text
///      b---c   f                  b---c   a'--f
///       \ /   / \      gives       \ /     \ / \      a b c a f e is passed through a twice
///        a---e---f                  a       e---
/// ```
///
/// # Errors
/// When the budget stops the run.
pub fn split_polygons(
    draft: &mut Draft,
    soup: &Soup,
    how: DegenerateFaces,
    budget: &Budget,
) -> Result<Changes, Stopped> {
    let polygons = &soup.polygons;
    if polygons.faces.is_empty() {
        return Ok(counted(0, 0, 0));
    }
    let places = coincident_f64(&soup.positions, budget)?.group;
    let keeps_polygons = !draft.polygons.is_empty();
    // Polygons that stay are compared as such.
    let split_alike = if keeps_polygons { 0 } else { split_copies_alike(draft, soup, &places, budget)? };
    let mut is_kept = vec![true; draft.triangles.len()];
    let mut parts = Vec::new();
    let (mut split, mut dropped, mut faces) = (0, 0, Vec::new());
    for (i, range) in polygons.starts.windows(2).enumerate() {
        let corners = &polygons.corners[range[0] as usize..range[1] as usize];
        budget.spend(corners.len() as u64 / 8 + 1)?;
        if !has_repeat(corners, &places) {
            continue;
        }
        let first = polygons.first_triangles[i];
        let mut of_cycles = Vec::new();
        if how == DegenerateFaces::Split {
            for cycle in simple_cycles(corners, &places) {
                let mut triangles = Vec::new();
                split_polygon(&cycle, &soup.positions, &mut triangles, budget)?;
                of_cycles.push(SimpleCycle { triangles, start: [cycle[0], cycle[1]], origin: first });
            }
        }
        let own = first as usize..first as usize + corners.len() - 2;
        let covered: f64 = own.clone().map(|t| triangle_area(draft.corners(t))).sum();
        let of_these = of_cycles.iter().flat_map(|part| &part.triangles);
        let covered_by_cycles: f64 =
            of_these.map(|t| triangle_area(t.map(|v| soup.positions[v as usize]))).sum();
        if covered < covered_by_cycles * (1.0 - SAME_AREA) {
            // Where polygons stay it becomes its triangles; otherwise it is them.
            if draft.polygons.split(first as usize) {
                faces.push(polygons.faces[i]);
                split += 1;
            }
            continue;
        }
        faces.push(polygons.faces[i]);
        is_kept[own].fill(false);
        if of_cycles.is_empty() {
            dropped += 1;
        } else {
            split += 1;
        }
        parts.extend(of_cycles);
    }
    if !faces.is_empty() {
        draft.retain_triangles(&is_kept);
        append(draft, parts, keeps_polygons);
    }
    Ok(Changes { reason: reason(&faces), ..counted(split, dropped, split_alike) })
}

fn counted(split: u64, dropped: u64, split_alike: u64) -> Changes {
    let counts =
        [("polygons_split", split), ("polygons_dropped", dropped), ("copies_split_alike", split_alike)];
    Changes::counted(counts)
}

/// Gives each copy of a polygon the diagonals of the first; the number of those that had others.
fn split_copies_alike(
    draft: &mut Draft,
    soup: &Soup,
    places: &[u32],
    budget: &Budget,
) -> Result<u64, Stopped> {
    let polygons = &soup.polygons;
    let mut changed = 0;
    for copy in polygon_copies(polygons, |v| places[v as usize], budget)? {
        let corners = polygons.corners_of(copy.polygon as usize);
        let triangles_of = |polygon: u32| {
            let first = polygons.first_triangles[polygon as usize] as usize;
            first..first + corners.len() - 2
        };
        budget.spend(corners.len() as u64)?;
        let mut own: Vec<(u32, u32)> = corners.iter().map(|&v| (places[v as usize], v)).collect();
        own.sort_unstable();
        let corner_at = |v: u32| {
            let place = places[draft.vertex_origin[v as usize] as usize];
            own[own.partition_point(|&(p, _)| p < place)].1
        };
        let wanted: Vec<[u32; 3]> = draft.triangles[triangles_of(copy.of)]
            .iter()
            .map(|t| t.map(corner_at))
            .map(|[a, b, c]| if copy.is_reversed { [a, c, b] } else { [a, b, c] })
            .collect();
        let vertex = |v: u32| draft.vertex_origin.partition_point(|&o| o < v) as u32;
        let wanted: Vec<[u32; 3]> = wanted.into_iter().map(|t| t.map(vertex)).collect();
        let range = triangles_of(copy.polygon);
        if !has_the_same(&draft.triangles[range.clone()], &wanted) {
            draft.triangles[range].copy_from_slice(&wanted);
            changed += 1;
        }
    }
    Ok(changed)
}

/// True when two lists have the same triangles in the same direction.
fn has_the_same(a: &[[u32; 3]], b: &[[u32; 3]]) -> bool {
    let sorted = |triangles: &[[u32; 3]]| {
        let mut all: Vec<[u32; 3]> = triangles
            .iter()
            .map(|&[a, b, c]| [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().unwrap_or_default())
            .collect();
        all.sort_unstable();
        all
    };
    sorted(a) == sorted(b)
}

/// A simple cycle out of a polygon, over vertices of the soup.
struct SimpleCycle {
    triangles: Vec<[u32; 3]>,
    /// Its first two corners.
    start: [u32; 2],
    /// The triangle of the soup in whose place it is.
    origin: u32,
}

/// Adds what polygons are made of, as polygons or as triangles.
fn append(draft: &mut Draft, parts: Vec<SimpleCycle>, as_polygons: bool) {
    for SimpleCycle { mut triangles, start, origin } in parts {
        // Ascending, as the draft was taken from the soup and vertices keep their order.
        let vertex = |v: u32| draft.vertex_origin.partition_point(|&o| o < v) as u32;
        triangles.iter_mut().for_each(|t| *t = t.map(vertex));
        let start = start.map(vertex);
        if as_polygons {
            draft.push_polygon(triangles, start, origin);
        } else {
            draft.triangle_origin.resize(draft.triangle_origin.len() + triangles.len(), origin);
            draft.triangles.extend(triangles);
        }
    }
    draft.drop_unused_vertices();
}

fn has_repeat(corners: &[u32], places: &[u32]) -> bool {
    let mut at: Vec<u32> = corners.iter().map(|&v| places[v as usize]).collect();
    at.sort_unstable();
    at.windows(2).any(|pair| pair[0] == pair[1])
}

/// The cycles of a closed walk that pass each place once, with three corners or more, innermost first.
fn simple_cycles(corners: &[u32], places: &[u32]) -> Vec<Vec<u32>> {
    let mut cycles = Vec::new();
    let mut path: Vec<u32> = Vec::new();
    for &v in corners {
        let here = places[v as usize];
        if let Some(step) = path.iter().position(|&u| places[u as usize] == here) {
            cycles.push(path.split_off(step));
        }
        path.push(v);
    }
    cycles.push(path);
    cycles.retain(|cycle| cycle.len() >= 3);
    cycles
}

/// Faces that a reason names.
const FACES_NAMED_MAX: usize = 16;

fn reason(faces: &[u32]) -> String {
    if faces.is_empty() {
        return String::new();
    }
    let named: Vec<String> = faces.iter().take(FACES_NAMED_MAX).map(u32::to_string).collect();
    let more = if faces.len() > FACES_NAMED_MAX { " and others" } else { "" };
    format!("faces {}{more} pass a vertex more than once", named.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::{Encoding, ReadOptions, read};

    fn soup(faces: &str) -> Soup {
        let points = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 -2 0\nv -2 -2 0\nv 0 0 0\n";
        let text = format!("{points}{faces}");
        read(text.as_bytes(), Encoding::Obj, &ReadOptions::default(), &Budget::unlimited()).unwrap()
    }

    fn split(soup: &Soup, how: DegenerateFaces) -> (Draft, Changes) {
        let (mut draft, _) = Draft::from_soup(soup);
        let changes = split_polygons(&mut draft, soup, how, &Budget::unlimited()).unwrap();
        assert!(draft.check().is_empty());
        (draft, changes)
    }

    #[test]
    fn a_bow_tie_becomes_its_two_triangles() {
        for faces in ["f 1 2 3 1 4 5\n", "f 1 2 3 6 4 5\n"] {
            let soup = soup(faces);
            let (draft, changes) = split(&soup, DegenerateFaces::Split);
            assert_eq!(changes.count("polygons_split"), 1);
            assert_eq!(changes.reason, "faces 0 pass a vertex more than once");
            let area = |t: usize| {
                let [a, b, c] = draft.corners(t);
                (b - a).cross(c - a).length() / 2.0
            };
            assert_eq!((draft.triangles.len(), area(0), area(1)), (2, 2.0, 2.0), "{faces}");
            assert_eq!(draft.triangle_origin, [0, 0]);
        }
    }

    #[test]
    fn dropping_takes_the_whole_face_and_leaves_others() {
        let soup = soup("f 1 2 3 1 4 5\nf 1 2 3\n");
        let (draft, changes) = split(&soup, DegenerateFaces::Drop);
        assert_eq!((changes.count("polygons_dropped"), draft.triangle_origin), (1, vec![4]));
    }

    #[test]
    fn a_polygon_that_runs_around_a_hole_does_not_cover_it() {
        let square = |z: i32| {
            format!(
                "v 0 0 {z}\nv 6 0 {z}\nv 6 6 {z}\nv 0 6 {z}\nv 2 2 {z}\nv 4 2 {z}\nv 4 4 {z}\nv 2 4 {z}\n"
            )
        };
        // By a bridge between the outline and the hole, by one whose ends are vertices of their own, and through a common corner.
        for (face, area) in [
            ("f 1 2 3 4 1 5 8 7 6 5\n", 32.0),
            ("f 4 3 2 1 5 6 7 8 5 1\n", 32.0),
            ("f 1 2 3 4 9 13 8 7 6 5\n", 32.0),
            ("f 1 2 3 4 1 8 7 6\n", 28.0),
        ] {
            let text = format!("{}{}{face}", square(0), square(0));
            let soup =
                read(text.as_bytes(), Encoding::Obj, &ReadOptions::default(), &Budget::unlimited()).unwrap();
            let (draft, changes) = split(&soup, DegenerateFaces::Split);
            let covered: f64 = (0..draft.triangles.len()).map(|t| triangle_area(draft.corners(t))).sum();
            assert_eq!((changes.count("polygons_split"), covered), (0, area), "{face}");
        }
    }

    #[test]
    fn a_walk_there_and_back_leaves_nothing() {
        let (draft, changes) = split(&soup("f 1 2 3 2\nf 1 2 3\n"), DegenerateFaces::Split);
        assert_eq!((changes.count("polygons_split"), changes.count("polygons_dropped")), (0, 1));
        assert_eq!(draft.triangles.len(), 1);
    }

    #[test]
    fn a_simple_polygon_stays_as_the_reader_split_it() {
        let soup = soup("f 1 2 3 5\n");
        let (draft, changes) = split(&soup, DegenerateFaces::Split);
        assert_eq!((draft, changes.reason), (Draft::from_soup(&soup).0, String::new()));
    }
}
