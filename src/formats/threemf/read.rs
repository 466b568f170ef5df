//! A package read: its model, the parts that this refers to, and the meshes in all of them.

use super::model::{Content, FaceAttributes, Mesh, Model, Object, ObjectKind, Reference};
use super::package::{Package, shortened, too_large};
use super::read_model::read_model;
use super::read_relationships::read_start;
use super::read_volumes::{Volume, are_all, read_volumes};
use super::scene::{self, Assembled, Placed};
use super::split::volume_of;
use super::transform::Transform;
use super::xml::Document;
use crate::budget::Budget;
use crate::formats::{Place, ReadError, ReadOptions};
use crate::mesh::{Soup, Units};
use rustc_hash::FxHashMap;
use std::ops::Range;

/// Most model parts of a package that are read.
const MODEL_PARTS_MAX: u64 = 10_000;
/// Most levels of components in each other.
const LEVELS_MAX: usize = 64;
/// Most places into which the build puts objects, and steps on the way there.
const PLACEMENTS_MAX: u64 = 1_000_000;

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
    /// The triangles, without colours.
    pub soup: Soup,
    /// What the file says of faces.
    pub attributes: FaceAttributes,
    /// What speaks of its vertices or triangles by number, such as `beamlattice`.
    pub extras: Vec<String>,
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
    fn volume(&self, number: u32, volume: &Volume) -> Self {
        let (soup, attributes) = volume_of(&self.soup, &self.attributes, volume);
        let name = if volume.name.is_empty() { self.name.clone() } else { volume.name.clone() };
        let (part, extras, extra_spans) = (self.part.clone(), self.extras.clone(), self.extra_spans.clone());
        let (spans, volume) = (self.spans.clone(), Some(number));
        Self { part, name, volume, soup, attributes, extras, extra_spans, spans, ..*self }
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
    pub(super) volumes: Vec<Volume>,
}

/// Reads all meshes of a 3MF.
///
/// # Errors
/// A package or model that cannot be read, requires an unknown extension, or is signed or encrypted.
pub fn read_project(bytes: &[u8], options: &ReadOptions, budget: &Budget) -> Result<Project, ReadError> {
    Ok(Models::read(bytes, options, budget)?.into_project())
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
/// Supports and objects of the type `other` are left out.
///
/// # Errors
/// As [`read_project`]; more triangles than the limits allow.
pub(in crate::formats) fn read(
    bytes: &[u8],
    options: &ReadOptions,
    budget: &Budget,
) -> Result<Soup, ReadError> {
    let models = Models::read(bytes, options, budget)?;
    Ok(scene::assemble(&models, options, budget)?.soup)
}

/// The same with the places of objects in it.
///
/// # Errors
/// As [`read_project`]; more triangles than the limits allow.
pub fn read_scene(
    bytes: &[u8],
    options: &ReadOptions,
    budget: &Budget,
) -> Result<(Soup, Vec<Placed>), ReadError> {
    let models = Models::read(bytes, options, budget)?;
    let Assembled { soup, placed } = scene::assemble(&models, options, budget)?;
    Ok((soup, placed))
}

/// An object at a place of the scene.
pub(super) struct Placement {
    /// Number of the model and of the object in it.
    pub(super) object: [usize; 2],
    pub(super) transform: Transform,
}

/// All model parts that are needed.
pub(super) struct Models {
    /// The first is the model of the package.
    pub(super) all: Vec<Model>,
    /// What the build holds, in its order.
    pub(super) placements: Vec<Placement>,
    remarks: Vec<String>,
    volumes: Vec<Volume>,
}

impl Models {
    fn read(bytes: &[u8], options: &ReadOptions, budget: &Budget) -> Result<Self, ReadError> {
        let mut package = Package::open(bytes, budget)?;
        let start = read_start(&mut package, budget)?;
        let volumes = read_volumes(&mut package, budget)?;
        let mut models = Self { all: Vec::new(), placements: Vec::new(), remarks: start.remarks, volumes };
        let mut numbers: FxHashMap<String, usize> = FxHashMap::default();
        let mut waiting = vec![start.part];
        let (mut triangles, mut vertices) = (0_u64, 0_u64);
        let mut next = 0;
        while let Some(part) = waiting.get(next).cloned() {
            next += 1;
            if numbers.contains_key(&part.to_ascii_lowercase()) {
                continue;
            }
            if models.all.len() as u64 >= MODEL_PARTS_MAX {
                return Err(too_large(
                    "model parts",
                    "model_parts_max",
                    MODEL_PARTS_MAX,
                    MODEL_PARTS_MAX + 1,
                ));
            }
            let Some(number) = package.find(&part) else {
                let found =
                    format!("a package without the model part {} that is referred to", shortened(&part));
                return Err(ReadError::unparseable(Place::Whole, found, "the part"));
            };
            let (bytes, _charge) = package.inflate(number, budget)?;
            // Vertices and triangles take at most three times as much as their text.
            let _meshes = budget.charge(3 * bytes.len() as u64)?;
            let model = read_model(&Document::of(&part, &bytes)?, options, budget)?;
            for object in &model.objects {
                if let Content::Mesh(mesh) = &object.content {
                    triangles += mesh.soup.triangles.len() as u64;
                    vertices += mesh.soup.positions.len() as u64;
                }
            }
            let limits = &options.limits;
            if triangles > limits.triangles_max.into() {
                return Err(too_large("triangles", "triangles_max", limits.triangles_max.into(), triangles));
            }
            if vertices > limits.vertices_max.into() {
                return Err(too_large("vertices", "vertices_max", limits.vertices_max.into(), vertices));
            }
            let references = model.objects.iter().filter_map(|object| match &object.content {
                Content::Components(all) => Some(all),
                _ => None,
            });
            let items = if models.all.is_empty() { &model.items[..] } else { &[] };
            let paths = references.flatten().chain(items).filter_map(|reference| reference.path.clone());
            waiting.extend(paths);
            numbers.insert(part.to_ascii_lowercase(), models.all.len());
            models.all.push(model);
        }
        models.place(&numbers, budget)?;
        Ok(models)
    }

    /// Follows the build down to the meshes.
    fn place(&mut self, numbers: &FxHashMap<String, usize>, budget: &Budget) -> Result<(), ReadError> {
        let mut placements = Vec::new();
        let mut steps = 0_u64;
        // Objects on the way from the build, each with the references that are still to be followed.
        let mut way: Vec<(usize, &[Reference], Transform, [usize; 2])> = Vec::new();
        let mut remarks = Vec::new();
        // No component of an object that nothing refers to is followed, but it must not lead to itself either.
        let Some(root) = self.all.first() else { return Ok(()) };
        way.push((0, &root.items, Transform::IDENTITY, [usize::MAX; 2]));
        while let Some((model, references, transform, _)) = way.last_mut() {
            let (model, transform) = (*model, *transform);
            let Some((reference, rest)) = references.split_first() else {
                way.pop();
                continue;
            };
            *references = rest;
            budget.spend(1)?;
            steps += 1;
            if steps > PLACEMENTS_MAX {
                return Err(too_large("components in the build", "components_max", PLACEMENTS_MAX, steps));
            }
            let target = self.target(model, reference, numbers)?;
            let in_part = |found: &str, expected: &str| {
                let found = format!("{found} (byte {} of {})", reference.at, self.all[model].part);
                ReadError::unparseable(Place::Byte(reference.at as u64), found, expected)
            };
            if way.iter().any(|&(.., object)| object == target) {
                let found = format!("the object {} as a component of itself", reference.object);
                return Err(in_part(&found, "components without a circle"));
            }
            if way.len() > LEVELS_MAX {
                return Err(in_part(&format!("more than {LEVELS_MAX} levels of components"), "fewer"));
            }
            let object = &self.all[target[0]].objects[target[1]];
            let transform = transform.after(&reference.transform);
            match &object.content {
                Content::Components(all) => way.push((target[0], all, transform, target)),
                Content::Mesh(_) => placements.push(Placement { object: target, transform }),
                Content::Nothing => {}
            }
            if way.len() == 1 && object.kind == ObjectKind::Other {
                let text = format!(
                    "The file breaks a rule of 3MF: the build has the object {} of the type other.",
                    object.id
                );
                remarks.push(text);
            }
        }
        self.placements = placements;
        self.remarks.extend(remarks);
        self.check_loose_components(numbers)
    }

    /// That components of objects that the build does not reach refer to what is there.
    fn check_loose_components(&self, numbers: &FxHashMap<String, usize>) -> Result<(), ReadError> {
        for (m, model) in self.all.iter().enumerate() {
            for object in &model.objects {
                let Content::Components(all) = &object.content else { continue };
                for reference in all {
                    self.target(m, reference, numbers)?;
                }
            }
        }
        Ok(())
    }

    /// The model and object that `reference` in the model `from` means.
    fn target(
        &self,
        from: usize,
        reference: &Reference,
        numbers: &FxHashMap<String, usize>,
    ) -> Result<[usize; 2], ReadError> {
        let model = match &reference.path {
            None => Some(from),
            Some(path) => numbers.get(&path.to_ascii_lowercase()).copied(),
        };
        let object = model.and_then(|m| self.all[m].numbers.get(&reference.object).map(|&o| [m, o]));
        object.ok_or_else(|| {
            let part = reference.path.as_ref().unwrap_or(&self.all[from].part);
            let found = format!(
                "the object {} of {part}, which is not there (byte {} of {})",
                reference.object, reference.at, self.all[from].part
            );
            ReadError::unparseable(Place::Byte(reference.at as u64), found, "the id of an object")
        })
    }

    fn into_project(self) -> Project {
        let mut instances: FxHashMap<[usize; 2], u32> = FxHashMap::default();
        for placement in &self.placements {
            *instances.entry(placement.object).or_default() += 1;
        }
        let units = self.all.first().map(|model| model.units).unwrap_or_default();
        let root = self.all.first().map(|model| model.part.clone()).unwrap_or_default();
        let (mut bodies, mut remarks) = (Vec::new(), self.remarks);
        for (m, model) in self.all.into_iter().enumerate() {
            let Model { part, objects, remarks: more, units: own, .. } = model;
            remarks.extend(more);
            if own != units {
                remarks
                    .push(format!("The file breaks a rule of 3MF: {part} has another unit than the model."));
            }
            for (o, object) in objects.into_iter().enumerate() {
                let Object { id, kind, name, content, .. } = object;
                let Content::Mesh(mesh) = content else { continue };
                let Mesh { soup, attributes, spans, extras, extra_spans } = *mesh;
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
                    spans,
                    extra_spans,
                };
                let of_object = |volume: &&Volume| m == 0 && volume.object == id;
                let own: Vec<&Volume> = self.volumes.iter().filter(of_object).collect();
                if own.len() < 2 {
                    bodies.push(body);
                } else if are_all(&own, body.soup.face_count) {
                    bodies.extend((0_u32..).zip(own).map(|(number, volume)| body.volume(number, volume)));
                } else {
                    remarks.push(format!(
                        "The volumes that the project notes for the object {id} are not its triangles: it is taken as one part."
                    ));
                    bodies.push(body);
                }
            }
        }
        Project { units, bodies, remarks, root, volumes: self.volumes }
    }
}
