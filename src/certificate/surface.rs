//! One reading of a file as positions and triangles.

use super::{Condition, Reading, Violation};
use crate::budget::{Budget, CHECK_EVERY, Charge, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::mesh::Soup;
use crate::spatial::coincident_f64;
use std::borrow::Cow;

/// Most faces that a violation names.
const WITNESS_FACES_MAX: usize = 8;

/// The triangles of one reading; triangle `t` is triangle `t` of the soup.
pub(super) struct ReadingSurface<'a> {
    pub(super) soup: &'a Soup,
    pub(super) reading: Reading,
    pub(super) positions: Cow<'a, [DVec3]>,
    pub(super) triangles: Cow<'a, [[u32; 3]]>,
    /// For what is not borrowed.
    _charges: Vec<Charge<'a>>,
}

impl<'a> ReadingSurface<'a> {
    /// The vertices as the file indexes them, the polygons as the soup splits them or as fans.
    pub(super) fn as_indexed(
        soup: &'a Soup,
        is_f32: bool,
        is_fan: bool,
        budget: &'a Budget,
    ) -> Result<Self, Stopped> {
        let (triangles, charges) = if is_fan {
            let (triangles, charge) = fans(soup, budget)?;
            (Cow::Owned(triangles), vec![charge])
        } else {
            (Cow::Borrowed(&soup.triangles[..]), Vec::new())
        };
        let reading = Reading { is_f32, is_fan, is_as_indexed: true };
        Ok(Self { soup, reading, positions: Cow::Borrowed(&soup.positions), triangles, _charges: charges })
    }

    /// The same with bit-equal positions welded, and the surface as it was where that is another one.
    pub(super) fn weld(mut self, budget: &'a Budget) -> Result<(Self, Option<Self>), Stopped> {
        let reading = Reading { is_as_indexed: false, ..self.reading };
        if self.soup.is_welded_by_format {
            self.reading = reading;
            return Ok((self, None));
        }
        let groups_charge = budget.charge(self.positions.len() as u64 * 8)?;
        let groups = coincident_f64(&self.positions, budget)?;
        if groups.first.len() == self.positions.len() {
            self.reading = reading;
            return Ok((self, None));
        }
        let (mut positions, positions_charge) = budget.vec(groups.first.len())?;
        positions.extend(groups.first.iter().map(|&v| self.positions[v as usize]));
        let (mut triangles, triangles_charge) = budget.vec(self.triangles.len())?;
        for block in self.triangles.chunks(CHECK_EVERY) {
            budget.check()?;
            triangles.extend(block.iter().map(|t| t.map(|v| groups.group[v as usize])));
        }
        drop(groups_charge);
        let (positions, triangles) = (Cow::Owned(positions), Cow::Owned(triangles));
        let charges = vec![positions_charge, triangles_charge];
        Ok((Self { soup: self.soup, reading, positions, triangles, _charges: charges }, Some(self)))
    }

    /// Every face of the file has its triangles here, and every vertex is finite.
    pub(super) fn is_usable(&self) -> bool {
        self.soup.face_faults.is_empty() && self.soup.non_finite_vertices.is_empty()
    }

    pub(super) fn corners(&self, t: u32) -> [DVec3; 3] {
        self.triangles[t as usize].map(|v| self.positions[v as usize])
    }

    /// A violation that `triangles` show around the middle of `vertices`.
    pub(super) fn violation(&self, condition: Condition, triangles: &[u32], vertices: &[u32]) -> Violation {
        let share = 1.0 / vertices.len() as f64;
        let middle = vertices.iter().map(|&v| self.positions[v as usize] * share).sum();
        self.violation_at(condition, triangles, middle)
    }

    /// A violation that two triangles show where they meet: in the middle of what their boxes share.
    pub(super) fn violation_between(&self, condition: Condition, [a, b]: [u32; 2]) -> Violation {
        let [a_box, b_box] = [a, b].map(|t| Aabb::of(self.corners(t)));
        let middle = a_box.min.max(b_box.min) * 0.5 + a_box.max.min(b_box.max) * 0.5;
        self.violation_at(condition, &[a, b], middle)
    }

    fn violation_at(&self, condition: Condition, triangles: &[u32], position: DVec3) -> Violation {
        let mut faces = Vec::new();
        for face in triangles.iter().map(|&t| self.soup.face_of(t)) {
            if faces.len() < WITNESS_FACES_MAX && !faces.contains(&face) {
                faces.push(face);
            }
        }
        Violation { condition, reading: self.reading, faces, position: Some(position) }
    }
}

/// The soup's triangles, but every polygon as the fan around its first corner.
fn fans<'a>(soup: &Soup, budget: &'a Budget) -> Result<(Vec<[u32; 3]>, Charge<'a>), Stopped> {
    let (mut triangles, charge) = budget.vec(soup.triangles.len())?;
    triangles.extend_from_slice(&soup.triangles);
    let polygons = &soup.polygons;
    for (n, &i) in polygons.not_fans.iter().enumerate() {
        if n % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let i = i as usize;
        let corners = &polygons.corners[polygons.starts[i] as usize..polygons.starts[i + 1] as usize];
        let fan = &mut triangles[polygons.first_triangles[i] as usize..][..corners.len() - 2];
        for (triangle, side) in fan.iter_mut().zip(corners[1..].windows(2)) {
            *triangle = [corners[0], side[0], side[1]];
        }
    }
    Ok((triangles, charge))
}
