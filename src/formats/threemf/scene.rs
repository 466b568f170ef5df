//! What the build of a 3MF puts together, as one mesh.

use super::model::ObjectContent;
use super::models::Models;
use super::package::too_large;
use super::read_volumes::{VolumePurpose, are_all, by_object};
use super::split::volume_of;
use super::transform::Transform;
use crate::budget::{Budget, CHECK_EVERY, Charge};
use crate::formats::colors::note_color;
use crate::formats::{Precision, ReadError, ReadOptions};
use crate::geom::DVec3;
use crate::mesh::{Color, FaceFault, NAME_BYTES_MAX, OBJECTS_MAX, ObjectName, Objects, Soup};

/// An object at its place in the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedObject {
    /// Number of its model part and its own number there, as of [`Body`](super::Body).
    pub source: [usize; 2],
    /// Number of the build item that it belongs to.
    pub item: usize,
    /// Number of its first vertex in the scene.
    pub first_vertex: u32,
    /// Number of its first triangle in the scene.
    pub first_triangle: u32,
    /// Number of its first face in the scene.
    pub first_face: u32,
    transform: Transform,
}

impl PlacedObject {
    /// Where a point of the object lies in the scene.
    pub fn apply(&self, p: DVec3) -> DVec3 {
        self.transform.apply(p, Precision::F64)
    }
}

/// What is assembled of a build.
pub(super) struct Assembled {
    pub(super) soup: Soup,
    /// The objects in it, in their order.
    pub(super) placed: Vec<PlacedObject>,
}

/// Which parts are put together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PartSelection {
    /// All that are printed or are for what is.
    Everything,
    /// Those that are printed.
    Material,
    /// Those that are taken away from what is printed.
    Negative,
}

impl PartSelection {
    /// True when it has parts for `purpose`.
    fn has(self, purpose: VolumePurpose) -> bool {
        match self {
            Self::Everything => true,
            Self::Material => purpose == VolumePurpose::Material,
            Self::Negative => purpose == VolumePurpose::Negative,
        }
    }
}

/// All placements in one mesh, in the order of the build. Each is an object of it, and so is each volume.
pub(super) fn assemble(
    models: &Models,
    extent: PartSelection,
    options: &ReadOptions,
    budget: &Budget,
) -> Result<Assembled, ReadError> {
    let mut placed = Vec::new();
    let units = models.all.first().map(|model| model.units);
    let soup = Soup { units, is_f32_exact: true, ..Soup::default() };
    let objects = Objects::default();
    let mut scene =
        SceneBuilder { soup, objects, is_faulty: false, means: 0, charges: Vec::new(), options, budget };
    let of_object = by_object(&models.volumes);
    for placement in &models.placements {
        let [m, o] = placement.object;
        let model = &models.all[m];
        let object = &model.objects[o];
        let ObjectContent::Mesh(mesh) = &object.content else { continue };
        let is_printed = object.kind.is_solid() || object.kind == super::ObjectKind::Surface;
        if !is_printed {
            continue;
        }
        let color = |face: usize| model.color_of_face(object, &mesh.attributes, face);
        let volumes = of_object.get(&object.id).filter(|_| m == 0).map(Vec::as_slice).unwrap_or_default();
        let has_volumes = are_all(volumes, mesh.soup.face_count);
        let is_apart = extent != PartSelection::Everything
            && placement.purpose == VolumePurpose::Material
            && volumes.iter().any(|volume| volume.purpose != VolumePurpose::Material)
            && has_volumes;
        if !extent.has(placement.purpose) && !is_apart {
            scene.leave_out(placement.purpose);
            continue;
        }
        placed.push(PlacedObject {
            source: placement.object,
            item: placement.item,
            first_vertex: scene.soup.positions.len() as u32,
            first_triangle: scene.soup.triangles.len() as u32,
            first_face: scene.soup.face_count,
            transform: placement.transform,
        });
        if !is_apart {
            let first = scene.soup.face_count;
            scene.put(&mesh.soup, &placement.transform, color)?;
            for volume in volumes.iter().filter(|_| has_volumes) {
                scene.name_faces(first + volume.triangles.end, &object.name, &volume.name)?;
            }
            scene.name_faces(scene.soup.face_count, &object.name, "")?;
            continue;
        }
        for volume in volumes {
            if !extent.has(volume.purpose) {
                scene.leave_out(volume.purpose);
                continue;
            }
            let (soup, _) = volume_of(&mesh.soup, &mesh.attributes, volume);
            scene.put(&soup, &placement.transform, |face| color(volume.triangles.start as usize + face))?;
            scene.name_faces(scene.soup.face_count, &object.name, &volume.name)?;
        }
    }
    let SceneBuilder { mut soup, objects, is_faulty, means, .. } = scene;
    match objects.names.len() {
        1 if objects.names[0] == ObjectName::default() => {}
        0..=OBJECTS_MAX => soup.objects = objects,
        count => soup.left_out.push(("objects", count as u64)),
    }
    if !soup.face_colors.is_empty() {
        soup.face_colors.resize(soup.face_count as usize, None);
    }
    if means > 0 {
        soup.left_out.push(("colors_at_corners", means));
    }
    drop_what_became_infinite(&mut soup);
    if !is_faulty && soup.triangles.len() == soup.face_count as usize {
        soup.triangle_face = Vec::new();
    }
    Ok(Assembled { soup, placed })
}

/// A mesh to which others are added.
struct SceneBuilder<'s> {
    soup: Soup,
    objects: Objects,
    /// Some face has no triangle.
    is_faulty: bool,
    /// Faces whose colour is the mean of those of their corners.
    means: u64,
    charges: Vec<Charge<'s>>,
    options: &'s ReadOptions,
    budget: &'s Budget,
}

impl SceneBuilder<'_> {
    /// Counts a part that is left out, unless it is material.
    fn leave_out(&mut self, purpose: VolumePurpose) {
        let Some(name) = purpose.left_out_as() else { return };
        match self.soup.left_out.iter_mut().find(|(known, _)| *known == name) {
            Some((_, count)) => *count += 1,
            None => self.soup.left_out.push((name, 1)),
        }
    }

    /// The faces before number `end` that have no object yet are one of these names.
    fn name_faces(&mut self, end: u32, object: &str, group: &str) -> Result<(), ReadError> {
        let Objects { names, of_face } = &mut self.objects;
        let count = (end as usize).saturating_sub(of_face.len());
        if count == 0 {
            return Ok(());
        }
        let usable =
            |name: &str| if name.len() > NAME_BYTES_MAX { Vec::new() } else { name.as_bytes().to_vec() };
        let name = ObjectName { object: usable(object), group: usable(group) };
        let bytes = size_of::<ObjectName>() + name.object.len() + name.group.len() + 4 * count;
        self.charges.push(self.budget.charge(bytes as u64)?);
        of_face.resize(end as usize, names.len() as u32);
        names.push(name);
        Ok(())
    }

    /// Adds `soup` at its place; `color`: that of each of its faces, and whether it is a mean.
    fn put(
        &mut self,
        soup: &Soup,
        transform: &Transform,
        color: impl Fn(usize) -> Option<([u8; 4], bool)>,
    ) -> Result<(), ReadError> {
        let Self { soup: scene, options, budget, .. } = self;
        let limits = &options.limits;
        let vertices = scene.positions.len() as u64 + soup.positions.len() as u64;
        if vertices > limits.vertices_max.into() {
            return Err(too_large("vertices", "vertices_max", limits.vertices_max.into(), vertices));
        }
        let triangles = scene.triangles.len() as u64 + soup.triangles.len() as u64;
        if triangles > limits.triangles_max.into() {
            return Err(too_large("triangles", "triangles_max", limits.triangles_max.into(), triangles));
        }
        let bytes = 64 * (soup.positions.len() + soup.triangles.len()) + size_of::<PlacedObject>();
        self.charges.push(budget.charge(bytes as u64)?);
        let (first_vertex, first_face) = (scene.positions.len() as u32, scene.face_count);
        for (i, &p) in soup.positions.iter().enumerate() {
            if i % CHECK_EVERY == 0 {
                budget.check()?;
            }
            let p = transform.apply(p, options.precision);
            scene.is_f32_exact &= p.as_vec3().as_dvec3() == p;
            if !p.is_finite() {
                scene.non_finite_vertices.push(scene.positions.len() as u32);
            }
            scene.positions.push(p);
        }
        let is_mirror = transform.is_mirror();
        for (t, &[a, b, c]) in soup.triangles.iter().enumerate() {
            if t % CHECK_EVERY == 0 {
                budget.check()?;
            }
            let [b, c] = if is_mirror { [c, b] } else { [b, c] };
            scene.triangles.push([a, b, c].map(|v| first_vertex + v));
            scene.triangle_face.push(first_face + soup.face_of(t as u32));
        }
        let of_scene = |fault: &FaceFault| FaceFault { face: first_face + fault.face, reason: fault.reason };
        scene.face_faults.extend(soup.face_faults.iter().map(of_scene));
        self.is_faulty |= !soup.face_faults.is_empty();
        for f in 0..soup.face_count as usize {
            if f % CHECK_EVERY == 0 {
                budget.check()?;
            }
            let color = color(f);
            self.means += u64::from(color.is_some_and(|(_, is_mean)| is_mean));
            note_color(&mut scene.face_colors, first_face as usize + f, color.map(|(c, _)| as_color(c)));
        }
        scene.face_count += soup.face_count;
        Ok(())
    }
}

fn as_color([r, g, b, a]: [u8; 4]) -> Color {
    Color::Bytes([r, g, b], (a != u8::MAX).then_some(a))
}

/// Triangles with a corner beyond float64 after its transform become faults, as those are that a file states.
fn drop_what_became_infinite(scene: &mut Soup) {
    if scene.non_finite_vertices.is_empty() {
        return;
    }
    let is_finite = |corners: &[u32; 3]| corners.iter().all(|&v| scene.positions[v as usize].is_finite());
    let kept: Vec<bool> = scene.triangles.iter().map(is_finite).collect();
    let reason = crate::mesh::FaceFaultReason::NonFinite;
    let lost = kept.iter().zip(&scene.triangle_face).filter(|(is_kept, _)| !**is_kept);
    scene.face_faults.extend(lost.map(|(_, &face)| FaceFault { face, reason }));
    scene.face_faults.sort_by_key(|fault| fault.face);
    let mut marks = kept.iter();
    scene.triangles.retain(|_| marks.next() == Some(&true));
    let mut marks = kept.iter();
    scene.triangle_face.retain(|_| marks.next() == Some(&true));
}
