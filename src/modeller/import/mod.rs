//! From triangles with rounded corners to a polyhedron with exact planes.
//!
//! 1. Coplanar neighbours are joined to faces: exactly, and within a tolerance that is stated.
//! 2. A vertex with one face around it is inside that face, one with two on an edge; both go. What is left are corners.
//! 3. Faces with three corners can take any three points: they are *free*. The planes of all others are fixed: those of
//!    exact faces as they are, those of tolerant ones fitted, with integers of 40 bits.
//! 4. A corner goes to the nearest point of its fixed planes, exactly: the plane, the line or the point they have in
//!    common. Then the free planes are put through their corners.
//! 5. Where fixed planes have no common point near the corner, the tolerant faces there are taken apart again into faces
//!    that are exactly coplanar, which fit the corners as the file has them.
//!
//! So the worst case is the file's own triangles, joined where they are exactly coplanar, and nothing has moved.

mod fit;
mod groups;
mod loops;
mod polygons;

use super::exact::{IntegerVector, cross, dot, rational};
use super::plane::{Plane, meeting_point};
use super::point::Point;
use super::solid::Solid;
use super::validity::{Validity, check};
use crate::budget::{Budget, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::mesh::polyhedron::{BuildFault, Polyhedron, VertexId};
use loops::GroupedFaces;
pub use polygons::{PolygonFault, from_polygons};
use std::cmp::Ordering;

/// A corner may move so many times the tolerance: planes that meet at a flat angle meet farther away.
const MOVE_PER_TOLERANCE: f64 = 8.0;
/// Times that tolerant faces are taken apart before all of them are.
const ROUNDS_MAX: usize = 24;
/// Largest difference of the exponents of coordinates: it bounds the integers and so the work of each operation.
const EXPONENT_SPAN_MAX: i32 = 200;

/// A polyhedron and how it came from the triangles.
#[derive(Debug, Clone)]
pub struct Imported {
    /// The polyhedron.
    pub solid: Solid,
    /// What the check of the whole solid found: no fault.
    pub validity: Validity,
    /// Where the file has each vertex of the polyhedron, in the unit of the file.
    pub positions: Vec<DVec3>,
    /// How many times as large as in the file the polyhedron is.
    pub factor: f64,
    /// Within which distance neighbours were taken to be coplanar, in the unit of the coordinates.
    pub tolerance: f64,
    /// Faces that were joined within the tolerance, not exactly.
    pub tolerant_faces: usize,
    /// Vertices that moved, and the largest move, in the unit of the coordinates.
    pub moved: (usize, f64),
    /// For each triangle the face it became a part of.
    pub face_of_triangle: Vec<u32>,
}

impl Imported {
    /// The same in another unit, in which lengths have `factor` times the number, a positive one: exactly, so that faces and
    /// their numbers stay.
    pub fn scaled(self, factor: f64) -> Self {
        if factor == 1.0 {
            return self;
        }
        Self {
            solid: self.solid.scaled(&rational(factor)),
            factor: self.factor * factor,
            tolerance: self.tolerance * factor,
            moved: (self.moved.0, self.moved.1 * factor),
            ..self
        }
    }
}

/// Why triangles cannot be read as a polyhedron.
#[derive(Debug, Clone, PartialEq)]
pub enum ImportRefusal {
    /// There is no triangle.
    Empty,
    /// A triangle has no area.
    DegenerateTriangle {
        /// The triangle.
        triangle: u32,
    },
    /// The triangles are not a closed manifold.
    NotClosed(BuildFault),
    /// Coordinates differ by more powers of two than are calculated with.
    ExponentSpan {
        /// The difference of the exponents.
        span: i32,
    },
    /// A vertex is not the one point of the planes of its faces.
    VertexNotOnPlanes {
        /// Where the file has it.
        position: DVec3,
    },
    /// The polyhedron is not a valid solid.
    Invalid(Validity),
}

impl ImportRefusal {
    /// The same with places in another unit, in which lengths have `factor` times the number.
    pub fn scaled(self, factor: f64) -> Self {
        match self {
            Self::VertexNotOnPlanes { position } => Self::VertexNotOnPlanes { position: position * factor },
            other => other,
        }
    }
}

/// How near to one plane neighbours must be to become one face, when nothing else is said: eight float32 steps at the
/// largest coordinate, in the unit of the coordinates.
pub fn default_tolerance(points: &[DVec3]) -> f64 {
    let reach = points.iter().fold(0.0f64, |m, p| m.max(p.abs().max_element()));
    reach * (1.0 / (1u32 << 20) as f64)
}

/// Reads triangles, whose corners must be finite and welded by index, as a polyhedron.
///
/// # Errors
/// When the budget stops the run.
pub fn import(
    points: &[DVec3],
    triangles: &[[u32; 3]],
    tolerance: Option<f64>,
    budget: &Budget,
) -> Result<Result<Imported, ImportRefusal>, Stopped> {
    if let Some(refusal) = unreadable(points, triangles) {
        return Ok(Err(refusal));
    }
    let neighbours = match loops::neighbours(triangles, points.len()) {
        Ok(neighbours) => neighbours,
        Err(fault) => return Ok(Err(ImportRefusal::NotClosed(fault))),
    };
    let exact = groups::exact_groups(points, triangles, &neighbours, budget)?;
    let tolerance = tolerance.unwrap_or_else(|| default_tolerance(points));
    let mesh = ImportMesh { points, triangles, neighbours, exact, tolerance };
    if tolerance > 0.0
        && let Ok(imported) = mesh.import_tolerant(budget)?
    {
        return Ok(Ok(imported));
    }
    Ok(mesh.build(&mesh.exact, &|_| false, budget)?.map_err(|failure| failure.refusal))
}

fn unreadable(points: &[DVec3], triangles: &[[u32; 3]]) -> Option<ImportRefusal> {
    if triangles.is_empty() {
        return Some(ImportRefusal::Empty);
    }
    let is_flat = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| points[v as usize]);
        crate::geom::are_collinear(a, b, c)
    };
    if let Some(triangle) = triangles.iter().position(is_flat) {
        return Some(ImportRefusal::DegenerateTriangle { triangle: triangle as u32 });
    }
    let used = triangles.iter().flatten().flat_map(|&v| points[v as usize].to_array());
    let parts = used.map(super::exact::decompose).filter(|(m, _)| *m != 0);
    let (low, high) = parts.fold((i32::MAX, i32::MIN), |(l, h), (m, e)| {
        (l.min(e), h.max(e + 64 - m.unsigned_abs().leading_zeros() as i32))
    });
    let span = high.saturating_sub(low);
    (span > EXPONENT_SPAN_MAX).then_some(ImportRefusal::ExponentSpan { span })
}

struct ImportMesh<'m> {
    points: &'m [DVec3],
    triangles: &'m [[u32; 3]],
    neighbours: groups::TriangleNeighbours,
    exact: Vec<u32>,
    tolerance: f64,
}

/// A build that did not succeed, and the groups that are to blame, if that is known.
struct ImportFailure {
    refusal: ImportRefusal,
    groups: Vec<u32>,
}

impl ImportMesh<'_> {
    /// Tolerant faces, of which those that do not fit together are taken apart.
    fn import_tolerant(&self, budget: &Budget) -> Result<Result<Imported, ImportRefusal>, Stopped> {
        let mut group =
            groups::tolerant_groups(self.points, self.triangles, &self.neighbours, self.tolerance, budget)?;
        let mut is_tolerant = self.inexact(&group);
        for _ in 0..ROUNDS_MAX {
            let failure = match self.build(&group, &|g| is_tolerant[g as usize], budget)? {
                Ok(imported) => return Ok(Ok(imported)),
                Err(failure) => failure,
            };
            let mut blamed: Vec<u32> =
                failure.groups.into_iter().filter(|&g| is_tolerant[g as usize]).collect();
            blamed.sort_unstable();
            blamed.dedup();
            if blamed.is_empty() {
                return Ok(Err(failure.refusal));
            }
            blamed.iter().for_each(|&g| is_tolerant[g as usize] = false);
            for (t, g) in group.iter_mut().enumerate() {
                if blamed.binary_search(g).is_ok() {
                    *g = self.exact[t];
                }
            }
            // An exact group may have parts in tolerant ones: each part by its first triangle.
            is_tolerant = self.inexact(&group);
        }
        Ok(Err(ImportRefusal::Empty))
    }

    /// Which groups, by number, are not one exact group.
    fn inexact(&self, group: &[u32]) -> Vec<bool> {
        let mut is_inexact = vec![false; self.triangles.len()];
        for (t, &g) in group.iter().enumerate() {
            is_inexact[g as usize] |= self.exact[t] != self.exact[g as usize];
        }
        is_inexact
    }

    fn build(
        &self,
        group: &[u32],
        is_tolerant: &dyn Fn(u32) -> bool,
        budget: &Budget,
    ) -> Result<Result<Imported, ImportFailure>, Stopped> {
        let faces = match loops::trace(self.triangles, &self.neighbours, group, self.points) {
            Ok(faces) => faces,
            Err(groups) => {
                return Ok(Err(ImportFailure { refusal: ImportRefusal::Empty, groups }));
            }
        };
        budget.spend(self.triangles.len() as u64)?;
        let (mut planes, fixed) = self.fixed_planes(&faces, is_tolerant);
        let points = match self.place_corners(&faces, &planes, &fixed) {
            Ok(points) => points,
            Err(failure) => return Ok(Err(failure)),
        };
        for (f, plane) in planes.iter_mut().enumerate().filter(|(f, _)| !fixed[*f]) {
            let corners = &faces.loops[f][0];
            let [a, b, c] = [0, 1, 2].map(|i| &points[corners[i] as usize]);
            let normal: IntegerVector = cross(&a.to(b), &a.to(c));
            if super::exact::is_zero(&normal) {
                let groups = Self::tolerant_around(&faces, is_tolerant, corners);
                return Ok(Err(ImportFailure { refusal: ImportRefusal::Empty, groups }));
            }
            *plane = Some(Plane::through(normal, a));
        }
        let topology = match Polyhedron::from_loops(&faces.loops, faces.vertices.len()) {
            Ok(topology) => topology,
            Err(fault) => {
                let groups = faces.groups.iter().copied().filter(|&g| is_tolerant(g)).collect();
                return Ok(Err(ImportFailure { refusal: ImportRefusal::NotClosed(fault), groups }));
            }
        };
        let planes: Option<Vec<Plane>> = planes.into_iter().collect();
        let Some(planes) = planes else {
            return Ok(Err(ImportFailure { refusal: ImportRefusal::Empty, groups: faces.groups }));
        };
        self.finish(&faces, topology, planes, is_tolerant, budget)
    }

    fn finish(
        &self,
        faces: &GroupedFaces,
        topology: Polyhedron,
        planes: Vec<Plane>,
        is_tolerant: &dyn Fn(u32) -> bool,
        budget: &Budget,
    ) -> Result<Result<Imported, ImportFailure>, Stopped> {
        let positions: Vec<DVec3> = faces.vertices.iter().map(|&v| self.points[v as usize]).collect();
        let solid = match Solid::new(topology, planes) {
            Ok(solid) => solid,
            Err(v) => {
                let refusal = ImportRefusal::VertexNotOnPlanes { position: positions[v.index()] };
                let groups = Self::tolerant_around(faces, is_tolerant, &[v.index() as u32]);
                return Ok(Err(ImportFailure { refusal, groups }));
            }
        };
        let validity = check(&solid, budget)?;
        if !validity.is_valid() {
            let blamed = validity.faults.iter().flat_map(|f| {
                let around = f.vertices.iter().flat_map(|&v| solid.topology.faces_around(v));
                f.faces.iter().copied().chain(around)
            });
            let groups = blamed.map(|f| faces.groups[f.index()]).filter(|&g| is_tolerant(g)).collect();
            return Ok(Err(ImportFailure { refusal: ImportRefusal::Invalid(validity), groups }));
        }
        let moves = positions.iter().enumerate().map(|(v, p)| {
            let q = solid.point(VertexId::new(v));
            if *q == Point::of(*p) { 0.0 } else { q.near.distance(*p).max(f64::MIN_POSITIVE) }
        });
        let (mut count, mut largest) = (0, 0.0f64);
        for d in moves.filter(|d| *d > 0.0) {
            (count, largest) = (count + 1, largest.max(d));
        }
        // Corners that went stay within the tolerance of the plane or line that they were on.
        let tolerant_faces = faces.groups.iter().filter(|&&g| is_tolerant(g)).count();
        Ok(Ok(Imported {
            solid,
            validity,
            positions,
            factor: 1.0,
            tolerance: if tolerant_faces == 0 { 0.0 } else { self.tolerance },
            tolerant_faces,
            moved: (count, largest),
            face_of_triangle: faces.face_of_triangle.clone(),
        }))
    }

    fn tolerant_around(faces: &GroupedFaces, is_tolerant: &dyn Fn(u32) -> bool, corners: &[u32]) -> Vec<u32> {
        let around = corners.iter().flat_map(|&v| faces.around[v as usize].iter());
        around.map(|&f| faces.groups[f as usize]).filter(|&g| is_tolerant(g)).collect()
    }

    /// The planes of faces that are not free, and which are those.
    fn fixed_planes(
        &self,
        faces: &GroupedFaces,
        is_tolerant: &dyn Fn(u32) -> bool,
    ) -> (Vec<Option<Plane>>, Vec<bool>) {
        let mut area = vec![DVec3::ZERO; faces.loops.len()];
        for (t, corners) in self.triangles.iter().enumerate() {
            area[faces.face_of_triangle[t] as usize] += groups::normal(self.points, *corners);
        }
        let plane = |f: usize| {
            let g = faces.groups[f];
            if is_tolerant(g) {
                let corners: Vec<DVec3> = faces.loops[f]
                    .iter()
                    .flatten()
                    .map(|&v| self.points[faces.vertices[v as usize] as usize])
                    .collect();
                return fit::fit(&corners, area[f], self.tolerance);
            }
            let [a, b, c] = self.triangles[g as usize].map(|v| Point::of(self.points[v as usize]));
            Some(Plane::through(cross(&a.to(&b), &a.to(&c)), &a))
        };
        let is_fixed = |f: usize| faces.loops[f].len() > 1 || faces.loops[f][0].len() > 3;
        let fixed: Vec<bool> = (0..faces.loops.len()).map(is_fixed).collect();
        ((0..faces.loops.len()).map(|f| if fixed[f] { plane(f) } else { None }).collect(), fixed)
    }

    /// Each corner at the nearest point of its fixed planes.
    fn place_corners(
        &self,
        faces: &GroupedFaces,
        planes: &[Option<Plane>],
        fixed: &[bool],
    ) -> Result<Vec<Point>, ImportFailure> {
        let mut points = Vec::with_capacity(faces.vertices.len());
        let mut failed: Vec<u32> = Vec::new();
        for (v, &source) in faces.vertices.iter().enumerate() {
            let here = self.points[source as usize];
            let around: Vec<&Plane> = faces.around[v]
                .iter()
                .filter(|&&f| fixed[f as usize])
                .filter_map(|&f| planes[f as usize].as_ref())
                .collect();
            let limit = self.tolerance * MOVE_PER_TOLERANCE;
            match nearest_common_point(here, &around)
                .filter(|p| p.near.distance(here) <= limit || *p == Point::of(here))
            {
                Some(point) => points.push(point),
                None => {
                    failed.extend(faces.around[v].iter().map(|&f| faces.groups[f as usize]));
                    points.push(Point::of(here));
                }
            }
        }
        if failed.is_empty() {
            return Ok(points);
        }
        let position = Aabb::of(self.points.iter().copied()).min;
        Err(ImportFailure { refusal: ImportRefusal::VertexNotOnPlanes { position }, groups: failed })
    }
}

/// The point nearest to `here` that lies on all planes.
fn nearest_common_point(here: DVec3, planes: &[&Plane]) -> Option<Point> {
    let point = Point::of(here);
    if planes.iter().all(|p| p.side(&point) == Ordering::Equal) {
        return Some(point);
    }
    let first = *planes.first()?;
    let found = match planes.iter().find(|p| !p.is_parallel(first)) {
        None => {
            // The foot on the plane: x - n (n.x - d) / n.n.
            let (normal, offset) = first.row();
            let square = dot(&normal, &normal);
            let height = dot(&normal, &point.x) - offset * &point.w;
            let x = std::array::from_fn(|k| &point.x[k] * &square - &normal[k] * &height);
            Point::new(x, &point.w * square)
        }
        Some(second) => {
            let line = cross(&first.normal, &second.normal);
            let across =
                planes.iter().find(|p| super::exact::sign(&dot(&p.normal, &line)) != Ordering::Equal);
            let own;
            let third = match across {
                Some(third) => third,
                None => {
                    own = Plane::through(line, &point);
                    &own
                }
            };
            meeting_point([first, second, third])?
        }
    };
    planes.iter().all(|p| p.side(&found) == Ordering::Equal).then_some(found)
}
