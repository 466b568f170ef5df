//! Faces as a file lists them, and the soup they make once all vertices are known.

use super::polygons::Splitter;
use super::{Place, ReadError, ReadErrorKind, ReadLimits};
use crate::budget::{Budget, CHECK_EVERY, Charge, Stopped};
use crate::geom::DVec3;
use crate::mesh::{FaceFault, FaceFaultReason, Polygons, Soup};
use crate::par;

/// Faces in file order with whatever indices the file gave them.
#[derive(Debug, Default)]
pub(super) struct Faces {
    /// The faces of three corners.
    triangles: Vec<[u32; 3]>,
    /// Numbers of the other faces.
    others: Vec<u32>,
    /// How many corners each of the others has.
    other_sizes: Vec<u32>,
    /// The corners of the others, one face after the other.
    other_corners: Vec<u32>,
    /// Triangles that the others make.
    split: u64,
    /// Bytes of these lists that are charged.
    charged: u64,
    /// Corners at which the next look at limits and memory is due.
    due_at: usize,
}

/// Corners that may be added between two looks at limits and memory.
const LOOK_EVERY_CORNERS: usize = 1 << 16;

impl Faces {
    /// Faces that all have three corners.
    pub(super) fn of_triangles(triangles: Vec<[u32; 3]>) -> Self {
        Self { triangles, ..Self::default() }
    }

    /// Makes room for `additional` faces of three corners.
    pub(super) fn reserve<'b>(
        &mut self,
        additional: usize,
        budget: &'b Budget,
    ) -> Result<Charge<'b>, Stopped> {
        let before = self.room_bytes();
        let charge = budget.reserve(&mut self.triangles, additional)?;
        self.charged += self.room_bytes() - before;
        Ok(charge)
    }

    /// Bytes of the room that all lists have.
    fn room_bytes(&self) -> u64 {
        let words = 3 * self.triangles.capacity()
            + self.others.capacity()
            + self.other_sizes.capacity()
            + self.other_corners.capacity();
        words as u64 * size_of::<u32>() as u64
    }

    /// Whether [`settle`](Self::settle) is to be called.
    #[inline]
    pub(super) fn is_due(&self) -> bool {
        self.other_corners.len() + 3 * self.triangles.len() >= self.due_at
    }

    /// Charges what the lists have grown by, and fails when there are too many triangles already.
    pub(super) fn settle<'b>(
        &mut self,
        limits: &ReadLimits,
        budget: &'b Budget,
    ) -> Result<Charge<'b>, ReadError> {
        self.due_at = self.other_corners.len() + 3 * self.triangles.len() + LOOK_EVERY_CORNERS;
        limits.check_triangles(self.triangle_count())?;
        let grown = self.room_bytes().saturating_sub(self.charged);
        self.charged += grown;
        Ok(budget.charge(grown)?)
    }

    /// Number of faces.
    pub(super) fn len(&self) -> usize {
        self.triangles.len() + self.others.len()
    }

    /// Adds the next face of the file. Its index may be anything.
    #[inline]
    pub(super) fn push(&mut self, corners: &[u32]) {
        if let &[a, b, c] = corners {
            self.triangles.push([a, b, c]);
        } else {
            self.others.push(self.len() as u32);
            self.other_sizes.push(corners.len() as u32);
            self.split += (corners.len() as u64).saturating_sub(2);
            self.other_corners.extend_from_slice(corners);
        }
    }

    /// Adds the faces of a later part of the file.
    pub(super) fn append(&mut self, later: &Self) {
        let before = self.len() as u32;
        self.triangles.extend_from_slice(&later.triangles);
        self.others.extend(later.others.iter().map(|face| before + face));
        self.other_sizes.extend_from_slice(&later.other_sizes);
        self.other_corners.extend_from_slice(&later.other_corners);
        self.split += later.split;
    }

    /// The soup of these faces on `positions`: bad faces become faults, polygons are split.
    ///
    /// # Errors
    /// Too many triangles or vertices; a stopped budget.
    pub(super) fn into_soup(
        self,
        positions: Vec<DVec3>,
        limits: &ReadLimits,
        budget: &Budget,
    ) -> Result<Soup, ReadError> {
        limits.check_vertices(positions.len() as u64)?;
        limits.check_triangles(self.triangle_count())?;
        if positions.is_empty() && self.len() == 0 {
            return Err(ReadError::empty("vertices and faces"));
        }
        let mut soup = Soup { face_count: self.len() as u32, ..Soup::default() };
        let looks = par::try_map_ranges(positions.len(), 16 * CHECK_EVERY, |range| {
            budget.check()?;
            Ok::<_, Stopped>(look_at(&positions[range.clone()], range.start as u32))
        })?;
        soup.is_f32_exact = looks.iter().all(|look| look.is_f32_exact);
        soup.non_finite_vertices = looks.into_iter().flat_map(|look| look.non_finite).collect();
        soup.positions = positions;
        if self.others.is_empty() && self.are_triangles_good(&soup, budget)? {
            soup.triangles = self.triangles;
        } else {
            self.sort_out(&mut soup, budget)?;
        }
        Ok(soup)
    }

    /// What these faces have at the corners of the triangles of `soup`, which was made of faces with the same numbers of
    /// corners: a value of its own for each corner, as texture points are. Where a polygon has a vertex twice, it is the
    /// value at the first.
    pub(super) fn corners_of(self, soup: &Soup, budget: &Budget) -> Result<Vec<[u32; 3]>, Stopped> {
        if self.others.is_empty() && soup.triangles.len() == self.triangles.len() {
            return Ok(self.triangles);
        }
        let polygons = &soup.polygons;
        let (mut polygon, mut other, mut start) = (0, 0, 0);
        let mut values = Vec::with_capacity(soup.triangles.len());
        for (t, corners) in soup.triangles.iter().enumerate() {
            if t.is_multiple_of(CHECK_EVERY) {
                budget.check()?;
            }
            let face = soup.face_of(t as u32);
            while self.others.get(other).is_some_and(|&number| number < face) {
                start += self.other_sizes[other] as usize;
                other += 1;
            }
            if self.others.get(other) != Some(&face) {
                values.push(self.triangles[face as usize - other]);
                continue;
            }
            while polygons.faces[polygon] < face {
                polygon += 1;
            }
            let vertices = &polygons.corners[polygons.starts[polygon] as usize..];
            let place = |v: u32| vertices.iter().position(|&u| u == v).unwrap_or(0);
            values.push(corners.map(|v| self.other_corners[start + place(v)]));
        }
        Ok(values)
    }

    /// Triangles after splitting, if no face is at fault.
    fn triangle_count(&self) -> u64 {
        self.triangles.len() as u64 + self.split
    }

    fn are_triangles_good(&self, soup: &Soup, budget: &Budget) -> Result<bool, Stopped> {
        let parts = par::try_map_ranges(self.triangles.len(), 16 * CHECK_EVERY, |range| {
            budget.check()?;
            Ok::<_, Stopped>(self.triangles[range].iter().all(|corners| fault_of(corners, soup).is_none()))
        })?;
        Ok(parts.into_iter().all(|is_good| is_good))
    }

    /// Goes through the faces in file order and sorts them into triangles, polygons and faults.
    fn sort_out(self, soup: &mut Soup, budget: &Budget) -> Result<(), Stopped> {
        let capacity = self.triangle_count() as usize;
        let (mut triangles, _charged) = budget.vec::<[u32; 3]>(capacity)?;
        let (mut triangle_face, _charged) = budget.vec::<u32>(capacity)?;
        // Polygons are kept beside their triangles.
        let _charged = budget.charge(4 * (self.other_corners.len() + 3 * self.others.len()) as u64)?;
        let mut splitter = Splitter::default();
        let mut three_corners = self.triangles.into_iter();
        let mut other = 0;
        let mut rest = &self.other_corners[..];
        for face in 0..soup.face_count {
            if (face as usize).is_multiple_of(CHECK_EVERY) {
                budget.check()?;
            }
            let triangle;
            let corners = if self.others.get(other) == Some(&face) {
                let (corners, later) = rest.split_at(self.other_sizes[other] as usize);
                (other, rest) = (other + 1, later);
                corners
            } else {
                triangle = three_corners.next().unwrap_or_default();
                &triangle
            };
            if let Some(reason) = fault_of(corners, soup) {
                soup.face_faults.push(FaceFault { face, reason });
                continue;
            }
            if let &[a, b, c] = corners {
                triangles.push([a, b, c]);
            } else {
                let first = triangles.len() as u32;
                let is_fan = splitter.split(corners, &soup.positions, &mut triangles, budget)?;
                soup.polygons.push(face, corners, first, is_fan);
            }
            triangle_face.resize(triangles.len(), face);
        }
        soup.triangles = triangles;
        soup.triangle_face = triangle_face;
        Ok(())
    }
}

impl Polygons {
    fn push(&mut self, face: u32, corners: &[u32], first_triangle: u32, is_fan: bool) {
        if !is_fan {
            self.not_fans.push(self.faces.len() as u32);
        }
        if self.starts.is_empty() {
            self.starts.push(0);
        }
        self.faces.push(face);
        self.corners.extend_from_slice(corners);
        self.starts.push(self.corners.len() as u32);
        self.first_triangles.push(first_triangle);
    }
}

/// What the coordinates of a range of vertices are like.
struct CoordinateProperties {
    is_f32_exact: bool,
    non_finite: Vec<u32>,
}

fn look_at(positions: &[DVec3], first: u32) -> CoordinateProperties {
    let mut look = CoordinateProperties { is_f32_exact: true, non_finite: Vec::new() };
    for (id, p) in (first..).zip(positions) {
        if !p.is_finite() {
            look.non_finite.push(id);
        } else if p.to_array().iter().any(|&c| f64::from(c as f32) != c) {
            look.is_f32_exact = false;
        }
    }
    look
}

/// Why a face with these corners cannot be used.
#[inline]
fn fault_of(corners: &[u32], soup: &Soup) -> Option<FaceFaultReason> {
    if corners.len() < 3 {
        return Some(FaceFaultReason::TooFewCorners);
    }
    if corners.iter().any(|&v| v as usize >= soup.positions.len()) {
        return Some(FaceFaultReason::IndexOutOfRange);
    }
    let is_bad = |&v: &u32| !soup.positions[v as usize].is_finite();
    (!soup.non_finite_vertices.is_empty() && corners.iter().any(is_bad)).then_some(FaceFaultReason::NonFinite)
}

impl ReadLimits {
    pub(super) fn check_triangles(&self, actual: u64) -> Result<(), ReadError> {
        // Corners are numbered in 32 bits too.
        let limit = self.triangles_max.min(u32::MAX / 3);
        refuse_over("triangles", "triangles_max", limit, actual, Place::Whole)
    }

    pub(super) fn check_vertices(&self, actual: u64) -> Result<(), ReadError> {
        refuse_over("vertices", "vertices_max", self.vertices_max, actual, Place::Whole)
    }

    pub(super) fn check_polygon(&self, actual: u64, place: Place) -> Result<(), ReadError> {
        let what = "corners of one polygon";
        refuse_over(what, "polygon_corners_max", self.polygon_corners_max, actual, place)
    }
}

fn refuse_over(
    what: &'static str,
    limit_name: &'static str,
    limit: u32,
    actual: u64,
    place: Place,
) -> Result<(), ReadError> {
    let limit = u64::from(limit);
    if actual <= limit {
        return Ok(());
    }
    let kind = ReadErrorKind::TooLarge { what, limit_name, limit, actual };
    Err(ReadError { kind, place, expected: String::new() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square_and(extra: &[DVec3]) -> Vec<DVec3> {
        let mut positions = vec![
            DVec3::ZERO,
            DVec3::new(1.0, 0.0, 0.0),
            DVec3::new(1.0, 1.0, 0.0),
            DVec3::new(0.0, 1.0, 0.0),
        ];
        positions.extend_from_slice(extra);
        positions
    }

    fn soup_of(faces: &[&[u32]], positions: Vec<DVec3>) -> Soup {
        let mut list = Faces::default();
        for face in faces {
            list.push(face);
        }
        let soup = list.into_soup(positions, &ReadLimits::default(), &Budget::unlimited()).unwrap();
        assert_eq!(soup.check(), Vec::<String>::new());
        soup
    }

    #[test]
    fn triangles_alone_need_no_face_numbers() {
        let soup = soup_of(&[&[0, 1, 2], &[0, 2, 3]], square_and(&[]));
        assert_eq!(soup.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!((soup.face_count, soup.is_f32_exact), (2, true));
        assert!(soup.triangle_face.is_empty() && soup.polygons == Polygons::default());
    }

    #[test]
    fn each_bad_face_is_named_with_its_reason_and_the_others_stay() {
        let positions = square_and(&[DVec3::new(f64::NAN, 0.0, 0.1)]);
        let soup =
            soup_of(&[&[0, 1], &[0, 1, 4], &[0, 1, 2], &[0, 1, u32::MAX], &[], &[0, 1, 2, 3]], positions);
        let faults: Vec<_> = soup.face_faults.iter().map(|f| (f.face, f.reason)).collect();
        use FaceFaultReason::{IndexOutOfRange, NonFinite, TooFewCorners};
        assert_eq!(faults, [(0, TooFewCorners), (1, NonFinite), (3, IndexOutOfRange), (4, TooFewCorners)]);
        assert_eq!(soup.triangles, [[0, 1, 2], [0, 1, 2], [0, 2, 3]]);
        assert_eq!(soup.triangle_face, [2, 5, 5]);
        assert_eq!(soup.non_finite_vertices, [4]);
    }

    #[test]
    fn a_polygon_is_remembered_with_its_first_triangle() {
        let soup = soup_of(&[&[0, 1, 2], &[3, 2, 1, 0]], square_and(&[]));
        assert_eq!(soup.triangles, [[0, 1, 2], [3, 2, 1], [3, 1, 0]]);
        let p = &soup.polygons;
        assert_eq!((&p.faces[..], &p.starts[..], &p.first_triangles[..]), (&[1][..], &[0, 4][..], &[1][..]));
        assert_eq!((&p.corners[..], p.not_fans.len()), (&[3, 2, 1, 0][..], 0));
    }

    #[test]
    fn parts_of_a_file_are_appended_in_order() {
        let mut faces = Faces::default();
        faces.push(&[0, 1, 2, 3]);
        let mut later = Faces::default();
        later.push(&[0, 1, 2]);
        later.push(&[0, 1]);
        faces.append(&later);
        assert_eq!((faces.len(), &faces.others[..], &faces.other_sizes[..]), (3, &[0, 2][..], &[4, 2][..]));
    }

    #[test]
    fn polygons_are_charged_and_counted_while_they_come() {
        let limits = ReadLimits { triangles_max: 1_000_000, ..ReadLimits::default() };
        let polygon = vec![0; 60_000];
        let fill = |bytes_max| {
            let budget = Budget::new(crate::budget::StopFlag::default(), u64::MAX, bytes_max);
            let mut faces = Faces::default();
            let mut charges = Vec::new();
            for _ in 0..100 {
                faces.push(&polygon);
                if faces.is_due() {
                    charges.push(faces.settle(&limits, &budget)?);
                }
            }
            Ok::<_, ReadError>(budget.bytes_peak())
        };
        let error = |bytes_max| fill(bytes_max).unwrap_err();
        assert!(matches!(error(u64::MAX).kind, ReadErrorKind::TooLarge { limit_name: "triangles_max", .. }));
        assert!(matches!(error(1 << 20).kind, ReadErrorKind::Stopped(Stopped::Memory { .. })));
    }

    #[test]
    fn a_value_between_two_float32_is_not_f32_exact() {
        assert!(!soup_of(&[&[0, 1, 2]], square_and(&[DVec3::splat(0.1)])).is_f32_exact);
        assert!(!soup_of(&[&[0, 1, 2]], square_and(&[DVec3::splat(1e300)])).is_f32_exact);
    }

    #[test]
    fn limits_are_named_when_they_are_passed() {
        let limits = ReadLimits { triangles_max: 1, vertices_max: 4, polygon_corners_max: 5 };
        let error = |face: &[u32], extra: &[DVec3]| {
            let mut faces = Faces::default();
            faces.push(face);
            faces.into_soup(square_and(extra), &limits, &Budget::unlimited()).unwrap_err().to_string()
        };
        assert_eq!(error(&[0, 1, 2, 3], &[]), "2 triangles is over the limit triangles_max = 1");
        assert_eq!(error(&[0, 1, 2], &[DVec3::ONE]), "5 vertices is over the limit vertices_max = 4");
        assert_eq!(
            limits.check_polygon(6, Place::Line(3)).unwrap_err().to_string(),
            "line 3: 6 corners of one polygon is over the limit polygon_corners_max = 5"
        );
    }
}
