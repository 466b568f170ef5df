//! Drafts whose polygons stay polygons: how they are taken from a file, and put together again from their triangles.

use super::Draft;
use crate::budget::{Budget, Stopped};
use crate::formats::split_polygon;
use crate::geom::{DVec3, Sign, are_collinear, orient3d};
use crate::mesh::{EdgeGroups, NO_POINT, Outlines, PolygonRuns, Polygons, Soup, edge_of};
use crate::repair::Changes;
use std::ops::Range;

/// A draft as faces to be written.
#[derive(Debug, Clone, PartialEq)]
pub struct Faced {
    /// The faces. The triangles of a polygon are those that a reader makes of it.
    pub soup: Soup,
    /// The triangle of the draft's source behind each triangle.
    pub origins: Vec<u32>,
    /// Polygons that are written as triangles, as a reader would split them along other diagonals into another surface.
    pub polygons_split: u64,
}

impl Draft {
    /// As [`Draft::from_soup`] with the polygons of `soup` as such. The first triangle of each begins at its first corner and
    /// goes to its second. The steps that divide or drop triangles of a polygon make triangles of all of it.
    pub fn with_polygons(soup: &Soup) -> (Self, Changes) {
        let (mut draft, mut changes) = Self::from_soup(soup);
        let polygons = &soup.polygons;
        let ranges = (0..polygons.faces.len()).map(|i| {
            let first = polygons.first_triangles[i] as usize;
            first..first + polygons.corners_of(i).len() - 2
        });
        draft.polygons = PolygonRuns::of(soup.triangles.len(), ranges.clone());
        for (i, range) in ranges.enumerate() {
            let corners = polygons.corners_of(i);
            if let Some((t, c)) = find(&soup.triangles[range.clone()], [corners[0], corners[1]]) {
                draft.triangles[range.start + t].rotate_left(c);
                draft.triangles[range.start..=range.start + t].rotate_right(1);
                draft.triangle_origin[range.start..=range.start + t].rotate_right(1);
            }
        }
        for (name, count) in &mut changes.counts {
            if *name == "polygons_split" {
                *count = 0;
            }
        }
        (draft, changes)
    }

    /// Appends the polygon that is split into `triangles` and begins with the two corners `start`.
    pub fn push_polygon(&mut self, mut triangles: Vec<[u32; 3]>, start: [u32; 2], origin: u32) {
        if let Some((t, c)) = find(&triangles, start) {
            triangles[t].rotate_left(c);
            triangles[..=t].rotate_right(1);
        }
        self.polygons.push_face(self.triangles.len(), triangles.len());
        self.triangle_origin.resize(self.triangle_origin.len() + triangles.len(), origin);
        self.triangles.extend(triangles);
    }

    /// How the outlines of its faces run.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn outlines(&self, budget: &Budget) -> Result<Outlines, Stopped> {
        Outlines::of(&self.triangles, &self.polygons, budget)
    }

    /// The half-edges of each edge of its faces, then those of the diagonals of polygons.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn edge_groups(&self, budget: &Budget) -> Result<EdgeGroups, Stopped> {
        EdgeGroups::of_faces(&self.triangles, &self.outlines(budget)?, self.positions.len(), budget)
    }

    /// Number of its faces: triangles and polygons.
    pub fn face_count(&self) -> usize {
        self.polygons.faces(self.triangles.len()).count()
    }

    /// As [`Draft::to_soup`] with polygons as such, each from the corner that was its first. A polygon of which a reader
    /// would make another surface, because its corners are not in one plane, becomes triangles.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn to_faces(&self, source: &Soup, budget: &Budget) -> Result<Faced, Stopped> {
        let outlines = self.outlines(budget)?;
        let soup = self.to_soup(source);
        let mut made = Faced { soup, origins: self.triangle_origin.clone(), polygons_split: 0 };
        if self.polygons.is_empty() {
            return Ok(made);
        }
        let mut polygons = Polygons { starts: vec![0], ..Polygons::default() };
        let (mut triangle_face, mut first_of_face) = (Vec::with_capacity(self.triangles.len()), Vec::new());
        for face in self.polygons.faces(self.triangles.len()) {
            budget.spend(1)?;
            if face.len() > 1 {
                let first = face.start as u32;
                let corners: Vec<u32> =
                    outlines.along(first).map(|h| edge_of(&self.triangles, h)[0]).collect();
                if self.is_read_alike(&corners, &face, &mut made, budget)? {
                    polygons.faces.push(first_of_face.len() as u32);
                    polygons.first_triangles.push(first);
                    polygons.corners.extend(corners);
                    polygons.starts.push(polygons.corners.len() as u32);
                    triangle_face.resize(face.end, first_of_face.len() as u32);
                    first_of_face.push(face.start);
                    continue;
                }
                made.polygons_split += 1;
            }
            for t in face {
                triangle_face.push(first_of_face.len() as u32);
                first_of_face.push(t);
            }
        }
        let soup = &mut made.soup;
        if !soup.face_colors.is_empty() {
            soup.face_colors = first_of_face.iter().map(|&t| soup.face_colors[t]).collect();
        }
        let first_of_faces = || first_of_face.iter().map(|&t| Some(t as u32));
        soup.materials = soup.materials.on(first_of_faces());
        soup.objects = soup.objects.on(first_of_faces());
        soup.face_count = first_of_face.len() as u32;
        (soup.triangle_face, soup.polygons) = (triangle_face, polygons);
        Ok(made)
    }

    /// True when a reader makes the surface of these triangles out of the polygon with these `corners`, and then `made` has
    /// its triangles.
    fn is_read_alike(
        &self,
        corners: &[u32],
        face: &Range<usize>,
        made: &mut Faced,
        budget: &Budget,
    ) -> Result<bool, Stopped> {
        let mut read = Vec::with_capacity(face.len());
        split_polygon(corners, &self.positions, &mut read, budget)?;
        let sorted = |triangles: &[[u32; 3]]| {
            let mut all: Vec<[u32; 3]> = triangles.iter().map(|&t| from_the_smallest(t)).collect();
            all.sort_unstable();
            all
        };
        debug_assert_eq!(read.len(), face.len(), "the triangles {face:?} are no polygon");
        let is_alike = sorted(&read) == sorted(&self.triangles[face.clone()]);
        if read.len() != face.len() || !(is_alike || self.are_in_one_plane(corners)) {
            return Ok(false);
        }
        made.origins[face.clone()].sort_unstable();
        if !made.soup.texture.is_empty() {
            let of_face = &mut made.soup.texture.corners[face.clone()];
            let was = self.triangles[face.clone()].as_flattened().iter().zip(of_face.as_flattened());
            let mut points: Vec<(u32, u32)> = was.map(|(&v, &point)| (v, point)).collect();
            points.sort_unstable();
            points.dedup();
            // Of corners with several points, or none, no triangle has a point.
            let point = |v: u32| match points.partition_point(|&(u, _)| u < v) {
                i if points.get(i + 1).is_some_and(|&(u, _)| u == v) => NO_POINT,
                i => points[i].1,
            };
            for (new, triangle) in of_face.iter_mut().zip(&read) {
                *new = triangle.map(point);
                if new.contains(&NO_POINT) {
                    *new = [NO_POINT; 3];
                }
            }
        }
        made.soup.triangles[face.clone()].copy_from_slice(&read);
        Ok(true)
    }

    fn are_in_one_plane(&self, corners: &[u32]) -> bool {
        let points: Vec<DVec3> = corners.iter().map(|&v| self.positions[v as usize]).collect();
        let [a, b] = [points[0], points[1]];
        match points.iter().find(|&&c| !are_collinear(a, b, c)) {
            Some(&c) => points.iter().all(|&d| orient3d(a, b, c, d) == Sign::Zero),
            None => true,
        }
    }
}

/// Among `triangles` the one with the half-edge from the first vertex to the second, and its corner there.
fn find(triangles: &[[u32; 3]], [from, to]: [u32; 2]) -> Option<(usize, usize)> {
    let corner = |t: &[u32; 3]| (0..3).find(|&c| t[c] == from && t[(c + 1) % 3] == to);
    triangles.iter().enumerate().find_map(|(i, t)| Some((i, corner(t)?)))
}

/// The same triangle from its smallest vertex on.
fn from_the_smallest([a, b, c]: [u32; 3]) -> [u32; 3] {
    match a.min(b).min(c) {
        least if least == a => [a, b, c],
        least if least == b => [b, c, a],
        _ => [c, a, b],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::{Encoding, ReadOptions, read};

    fn soup(text: &str) -> Soup {
        read(text.as_bytes(), Encoding::Obj, &ReadOptions::default(), &Budget::unlimited()).unwrap()
    }

    /// A triangle, a dart that no fan around its first corner covers, and a pentagon over it.
    const FACES: &str =
        "v 9 9 9\nv 0 0 0\nv 4 -3 0\nv 1 0 0\nv 4 3 0\nv 0 5 1\nf 2 3 6\nf 3 4 5 2\nf 2 3 4 5 6\n";

    fn corners(faced: &Faced) -> Vec<Vec<u32>> {
        faced.soup.faces().map(|(_, corners)| corners.to_vec()).collect()
    }

    #[test]
    fn faces_come_back_from_their_first_corners_and_turned_ones_the_other_way_around() {
        let source = soup(FACES);
        let (mut draft, changes) = Draft::with_polygons(&source);
        assert_eq!((changes.count("polygons_split"), changes.count("unused_vertices_dropped")), (0, 1));
        assert_eq!((draft.face_count(), draft.check()), (3, vec![]));
        let faced = draft.to_faces(&source, &Budget::unlimited()).unwrap();
        assert_eq!(corners(&faced), [&[0, 1, 4][..], &[1, 2, 3, 0], &[0, 1, 2, 3, 4]]);
        assert_eq!((faced.polygons_split, &faced.origins), (0, &(0..6).collect()));
        assert_eq!(faced.soup.triangles.len(), source.triangles.len());
        (1..3).for_each(|t| draft.flip(t));
        let faced = draft.to_faces(&source, &Budget::unlimited()).unwrap();
        assert_eq!(corners(&faced), [&[0, 1, 4][..], &[1, 0, 3, 2], &[0, 1, 2, 3, 4]]);
    }

    #[test]
    fn a_polygon_that_a_reader_would_split_otherwise_is_triangles() {
        let source = soup("v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4\nf 4 3 2 1\n");
        let (mut draft, _) = Draft::with_polygons(&source);
        draft.positions[1] = DVec3::new(0.5, 1.5, 0.25);
        let faced = draft.to_faces(&source, &Budget::unlimited()).unwrap();
        // The second begins beside the corner that is pushed in, so that its diagonal stays.
        assert_eq!((faced.polygons_split, corners(&faced).len()), (1, 3));
        assert_eq!(corners(&faced)[..2], [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn what_is_left_of_a_polygon_of_which_a_triangle_is_divided_or_dropped_are_triangles() {
        let source = soup(FACES);
        let (mut draft, _) = Draft::with_polygons(&source);
        draft.replace(1, &[[1, 2, 4], [2, 3, 4]]);
        assert_eq!((draft.face_count(), draft.check()), (5, vec![]));
        draft.retain_triangles(&[true, true, true, true, true, false, true]);
        assert_eq!((draft.face_count(), draft.check()), (6, vec![]));
    }
}
