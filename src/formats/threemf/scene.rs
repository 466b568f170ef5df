//! What the build of a 3MF puts together, as one mesh.

use super::model::Content;
use super::models::Models;
use super::package::too_large;
use super::transform::Transform;
use crate::budget::{Budget, CHECK_EVERY};
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

/// All placements in one mesh, in the order of the build.
pub(super) fn assemble(
    models: &Models,
    options: &ReadOptions,
    budget: &Budget,
) -> Result<Assembled, ReadError> {
    let mut placed = Vec::new();
    let units = models.all.first().map(|model| model.units);
    let mut scene = Soup { units, is_f32_exact: true, ..Soup::default() };
    let mut is_faulty = false;
    let mut means = 0;
    let mut charges = Vec::new();
    for placement in &models.placements {
        let [m, o] = placement.object;
        let model = &models.all[m];
        let object = &model.objects[o];
        let Content::Mesh(mesh) = &object.content else { continue };
        let is_printed = object.kind.is_solid() || object.kind == super::ObjectKind::Surface;
        if !is_printed {
            continue;
        }
        let (soup, transform) = (&mesh.soup, &placement.transform);
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
        charges.push(budget.charge(bytes as u64)?);
        let (first_vertex, first_face) = (scene.positions.len() as u32, scene.face_count);
        placed.push(Placed {
            source: placement.object,
            first_vertex,
            first_triangle: scene.triangles.len() as u32,
            first_face,
            transform: *transform,
        });
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
        is_faulty |= !soup.face_faults.is_empty();
        for f in 0..soup.face_count as usize {
            if f % CHECK_EVERY == 0 {
                budget.check()?;
            }
            let color = model.color_of_face(object, &mesh.attributes, f);
            means += u64::from(color.is_some_and(|(_, is_mean)| is_mean));
            note_color(&mut scene.face_colors, first_face as usize + f, color.map(|(c, _)| as_color(c)));
        }
        scene.face_count += soup.face_count;
    }
    if !scene.face_colors.is_empty() {
        scene.face_colors.resize(scene.face_count as usize, None);
    }
    if means > 0 {
        scene.left_out.push(("colors_at_corners", means));
    }
    drop_what_became_infinite(&mut scene);
    if !is_faulty && scene.triangles.len() == scene.face_count as usize {
        scene.triangle_face = Vec::new();
    }
    Ok(Assembled { soup: scene, placed })
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
