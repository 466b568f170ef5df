//! A package read: its model, the parts that this refers to, and the meshes in all of them.

use super::model::{
    FaceAttributes, Groups, ModelDocument, Object, ObjectContent, ObjectKind, ObjectMesh, Property,
};
use super::models::Models;
use super::read_volumes::{ObjectVolume, are_all, by_object};
use super::scene::{self, Assembled, PartSelection, PlacedObject};
use super::split::volume_of;
use crate::budget::Budget;
use crate::formats::{ReadError, ReadOptions};
use crate::mesh::{Soup, Units};
use rustc_hash::FxHashMap;
use std::ops::Range;
use std::sync::Arc;

/// The mesh of an object, in its own coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Name of the model part that holds it, such as `/3D/3dmodel.model`.
    pub part: String,
    /// Id of the object in that part.
    pub object: u32,
    /// Number of the model part among all that are read, and of the object in it.
    pub source: [usize; 2],
    /// Name of the object or of the volume; empty when it has none.
    pub name: String,
    /// Number of the volume among those of the object, where the project parts its triangles into several.
    pub volume: Option<u32>,
    /// What the object is for.
    pub kind: ObjectKind,
    /// How often the build has it.
    pub instances: u32,
    /// The triangles without colours, and with texture coordinates where faces are places in a picture.
    pub soup: Soup,
    /// What the file says of faces.
    pub attributes: FaceAttributes,
    /// What speaks of its vertices or triangles by number, such as `beamlattice`.
    pub extras: Vec<String>,
    /// The property groups of its part.
    pub(super) groups: Arc<Groups>,
    /// Property of faces that state none.
    pub(super) property: Property,
    /// Bytes of the elements of its vertices and triangles in the text of the part.
    pub(super) spans: [Range<usize>; 2],
    /// Bytes of the elements that `extras` names.
    pub(super) extra_spans: Vec<Range<usize>>,
}

impl Body {
    /// True when it has to be a solid: the rules of 3MF say so, and it has triangles.
    pub fn is_solid(&self) -> bool {
        self.kind.is_solid() && self.soup.face_count > 0
    }

    /// One volume of it, as a body of its own.
    fn volume(&self, number: u32, volume: &ObjectVolume) -> Self {
        let (soup, attributes) = volume_of(&self.soup, &self.attributes, volume);
        let name = if volume.name.is_empty() { self.name.clone() } else { volume.name.clone() };
        let (part, extras, extra_spans) = (self.part.clone(), self.extras.clone(), self.extra_spans.clone());
        let (spans, groups, volume) = (self.spans.clone(), Arc::clone(&self.groups), Some(number));
        Self { part, name, volume, soup, attributes, extras, extra_spans, spans, groups, ..*self }
    }
}

/// What a 3MF holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Project {
    /// Unit of all coordinates.
    pub units: Units,
    /// The meshes, in the order of their parts and of their objects there.
    pub bodies: Vec<Body>,
    /// What is kept and not judged, and which rules of 3MF the file breaks, as sentences.
    pub remarks: Vec<String>,
    /// Name of the first model part.
    pub(super) root: String,
    /// Volumes as ranges of triangles of its objects.
    pub(super) volumes: Vec<ObjectVolume>,
}

/// Reads all meshes of a 3MF.
///
/// # Errors
/// A package or model that cannot be read, requires an unknown extension, or is signed or encrypted.
pub fn read_project(bytes: &[u8], options: &ReadOptions, budget: &Budget) -> Result<Project, ReadError> {
    let mut project = project_of(Models::read(bytes, options, budget)?);
    for body in &mut project.bodies {
        body.soup.texture = body.places(budget)?;
    }
    Ok(project)
}

/// The meshes of a 3MF that have to be solids, each in its own coordinates; those that no build item uses too.
///
/// # Errors
/// As [`read_project`].
pub(in crate::formats) fn read_solids(
    bytes: &[u8],
    options: &ReadOptions,
    budget: &Budget,
) -> Result<Vec<Soup>, ReadError> {
    let bodies = read_project(bytes, options, budget)?.bodies;
    Ok(bodies.into_iter().filter(Body::is_solid).map(|body| body.soup).collect())
}

/// What the build puts together, as one mesh: each object as often as it is there, at its place, with its colours.
/// Supports and objects of the type `other` are left out, and parts that are no material.
///
/// # Errors
/// As [`read_project`]; more triangles than the limits allow.
pub(in crate::formats) fn read(
    bytes: &[u8],
    options: &ReadOptions,
    budget: &Budget,
) -> Result<Soup, ReadError> {
    let models = Models::read(bytes, options, budget)?;
    Ok(scene::assemble(&models, PartSelection::Material, options, budget)?.soup)
}

/// The same with parts that are no material, and with the places of objects in it.
///
/// # Errors
/// As [`read_project`]; more triangles than the limits allow.
pub fn read_scene(
    bytes: &[u8],
    options: &ReadOptions,
    budget: &Budget,
) -> Result<(Soup, Vec<PlacedObject>), ReadError> {
    let models = Models::read(bytes, options, budget)?;
    let Assembled { soup, placed } = scene::assemble(&models, PartSelection::Everything, options, budget)?;
    Ok((soup, placed))
}

/// The meshes of all parts, each by itself.
fn project_of(models: Models) -> Project {
    let mut instances: FxHashMap<[usize; 2], u32> = FxHashMap::default();
    for placement in &models.placements {
        *instances.entry(placement.object).or_default() += 1;
    }
    let of_object = by_object(&models.volumes);
    let units = models.all.first().map(|model| model.units).unwrap_or_default();
    let root = models.all.first().map(|model| model.part.clone()).unwrap_or_default();
    let (mut bodies, mut remarks): (Vec<Body>, _) = (Vec::new(), models.remarks);
    for (m, model) in models.all.into_iter().enumerate() {
        let ModelDocument { part, objects, remarks: more, units: own, groups, .. } = model;
        let groups = Arc::new(groups);
        remarks.extend(more);
        if own != units {
            remarks.push(format!("The file breaks a rule of 3MF: {part} has another unit than the model."));
        }
        for (o, object) in objects.into_iter().enumerate() {
            let Object { id, kind, name, content, property } = object;
            let ObjectContent::Mesh(mesh) = content else { continue };
            let ObjectMesh { soup, attributes, spans, extras, extra_spans } = *mesh;
            let instances = instances.get(&[m, o]).copied().unwrap_or(0);
            let soup = Soup { units: Some(units), ..soup };
            let body = Body {
                part: part.clone(),
                object: id,
                source: [m, o],
                name,
                volume: None,
                kind,
                instances,
                soup,
                attributes,
                extras,
                groups: Arc::clone(&groups),
                property,
                spans,
                extra_spans,
            };
            let own = of_object.get(&id).filter(|_| m == 0).map(Vec::as_slice).unwrap_or_default();
            if own.len() < 2 {
                bodies.push(body);
            } else if are_all(own, body.soup.face_count) {
                bodies.extend((0_u32..).zip(own).map(|(number, volume)| body.volume(number, volume)));
            } else {
                remarks.push(format!(
                    "The volumes that the project notes for the object {id} are not its triangles: it is taken as one part."
                ));
                bodies.push(body);
            }
        }
    }
    Project { units, bodies, remarks, root, volumes: models.volumes }
}
