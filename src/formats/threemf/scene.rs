//! What the build of a 3MF puts together, as one mesh.

use super::model::Content;
use super::models::Models;
use super::package::too_large;
use super::read_volumes::{Purpose, are_all, by_object};
use super::split::volume_of;
use super::transform::Transform;
use crate::budget::{Budget, CHECK_EVERY, Charge};
use crate::formats::colors::note_color;
use crate::formats::{Precision, ReadError, ReadOptions};
use crate::geom::DVec3;
use crate::mesh::{Color, FaceFault, Soup};

/// An object at its place in the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Placed {
    /// Number of its model part and its own number there, as of [`Body`](super::Body).
    pub source: [usize; 2],
    /// Number of its first vertex in the scene.
    pub first_vertex: u32,
    /// Number of its first triangle in the scene.
    pub first_triangle: u32,
    /// Number of its first face in the scene.
    pub first_face: u32,
    transform: Transform,
}

impl Placed {
    /// Where a point of the object lies in the scene.
    pub fn apply(&self, p: DVec3) -> DVec3 {
        self.transform.apply(p, Precision::F64)
    }
}

/// What is assembled of a build.
pub(super) struct Assembled {
    pub(super) soup: Soup,
    /// The objects in it, in their order.
    pub(super) placed: Vec<Placed>,
}

/// Which parts are put together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Extent {
    /// All that are printed or are for what is.
    Everything,
    /// Those that are printed.
    Material,
}

/// All placements in one mesh, in the order of the build.
pub(super) fn assemble(
    models: &Models,
    extent: Extent,
    options: &ReadOptions,
    budget: &Budget,
) -> Result<Assembled, ReadError> {
    let mut placed = Vec::new();
    let units = models.all.first().map(|model| model.units);
    let soup = Soup { units, is_f32_exact: true, ..Soup::default() };
    let mut scene = Scene { soup, is_faulty: false, means: 0, charges: Vec::new(), options, budget };
    let of_object = by_object(&models.volumes);
    for placement in &models.placements {
        let [m, o] = placement.object;
        let model = &models.all[m];
        let object = &model.objects[o];
        let Content::Mesh(mesh) = &object.content else { continue };
        let is_printed = object.kind.is_solid() || object.kind == super::ObjectKind::Surface;
        if !is_printed {
            continue;
        }
        if let (Extent::Material, Some(name)) = (extent, placement.purpose.left_out_as()) {
            scene.leave_out(name);
            continue;
        }
        placed.push(Placed {
            source: placement.object,
            first_vertex: scene.soup.positions.len() as u32,
            first_triangle: scene.soup.triangles.len() as u32,
            first_face: scene.soup.face_count,
            transform: placement.transform,
        });
        let color = |face: usize| model.color_of_face(object, &mesh.attributes, face);
        let volumes = of_object.get(&object.id).filter(|_| m == 0).map(Vec::as_slice).unwrap_or_default();
        let is_apart = extent == Extent::Material
            && volumes.iter().any(|volume| volume.purpose != Purpose::Material)
            && are_all(volumes, mesh.soup.face_count);
        if !is_apart {
            scene.put(&mesh.soup, &placement.transform, color)?;
            continue;
        }
        for volume in volumes {
            if let Some(name) = volume.purpose.left_out_as() {
                scene.leave_out(name);
                continue;
            }
            let (soup, _) = volume_of(&mesh.soup, &mesh.attributes, volume);
            scene.put(&soup, &placement.transform, |face| color(volume.triangles.start as usize + face))?;
        }
    }
    let Scene { mut soup, is_faulty, means, .. } = scene;
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
struct Scene<'s> {
    soup: Soup,
    /// Some face has no triangle.
    is_faulty: bool,
    /// Faces whose colour is the mean of those of their corners.
    means: u64,
    charges: Vec<Charge<'s>>,
    options: &'s ReadOptions,
    budget: &'s Budget,
}

impl Scene<'_> {
    /// Counts a part that is left out.
    fn leave_out(&mut self, name: &'static str) {
        match self.soup.left_out.iter_mut().find(|(known, _)| *known == name) {
            Some((_, count)) => *count += 1,
            None => self.soup.left_out.push((name, 1)),
        }
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
        let bytes = 64 * (soup.positions.len() + soup.triangles.len()) + size_of::<Placed>();
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
