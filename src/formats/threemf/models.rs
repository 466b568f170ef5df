//! The model of a package with the parts that it refers to, and where the build puts their objects.

use super::model::{ModelDocument, ObjectContent, ObjectKind, Reference};
use super::package::{Package, shortened, too_large};
use super::read_model::read_model;
use super::read_purposes::{Purposes, read_purposes};
use super::read_relationships::read_start;
use super::read_volumes::{ObjectVolume, VolumePurpose, read_volumes};
use super::transform::Transform;
use super::xml::Document;
use crate::budget::Budget;
use crate::formats::{Place, ReadError, ReadOptions};
use rustc_hash::FxHashMap;

/// Most model parts of a package that are read.
const MODEL_PARTS_MAX: u64 = 10_000;
/// Most meshes, and volumes that are noted of them.
const MESHES_MAX: u64 = 10_000;
/// Most levels of components in each other.
const LEVELS_MAX: usize = 64;
/// Most places into which the build puts objects, and steps on the way there.
const PLACEMENTS_MAX: u64 = 1_000_000;

/// An object at a place of the scene.
pub(super) struct ObjectPlacement {
    /// Number of the model and of the object in it.
    pub(super) object: [usize; 2],
    /// Number of the build item.
    pub(super) item: usize,
    pub(super) transform: Transform,
    pub(super) purpose: VolumePurpose,
}

/// All model parts that are needed.
pub(super) struct Models {
    /// The first is the model of the package.
    pub(super) all: Vec<ModelDocument>,
    /// What the build holds, in its order.
    pub(super) placements: Vec<ObjectPlacement>,
    pub(super) remarks: Vec<String>,
    pub(super) volumes: Vec<ObjectVolume>,
    /// What components are for, by the ids of the objects of their build item and of themselves, where they are no material.
    purposes: Purposes,
}

impl Models {
    /// Reads the model of the package, and each part that it refers to.
    pub(super) fn read(bytes: &[u8], options: &ReadOptions, budget: &Budget) -> Result<Self, ReadError> {
        let mut package = Package::open(bytes, budget)?;
        let start = read_start(&mut package, budget)?;
        let volumes = read_volumes(&mut package, budget)?;
        let mut remarks = start.remarks;
        let purposes = read_purposes(&mut package, &mut remarks, budget)?;
        let mut models = Self { all: Vec::new(), placements: Vec::new(), remarks, volumes, purposes };
        let mut numbers: FxHashMap<String, usize> = FxHashMap::default();
        let mut waiting = vec![start.part];
        let (mut triangles, mut vertices, mut meshes) = (0_u64, 0_u64, models.volumes.len() as u64);
        let mut charges = Vec::new();
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
                if let ObjectContent::Mesh(mesh) = &object.content {
                    let own =
                        [mesh.soup.triangles.len(), mesh.soup.positions.len()].map(|count| count as u64);
                    charges.push(budget.charge(32 * own[0] + 24 * own[1])?);
                    triangles += own[0];
                    vertices += own[1];
                    meshes += 1;
                }
            }
            if meshes > MESHES_MAX {
                return Err(too_large("meshes and volumes", "meshes_max", MESHES_MAX, meshes));
            }
            let limits = &options.limits;
            if triangles > limits.triangles_max.into() {
                return Err(too_large("triangles", "triangles_max", limits.triangles_max.into(), triangles));
            }
            if vertices > limits.vertices_max.into() {
                return Err(too_large("vertices", "vertices_max", limits.vertices_max.into(), vertices));
            }
            let references = model.objects.iter().filter_map(|object| match &object.content {
                ObjectContent::Components(all) => Some(all),
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
        let (mut steps, mut items) = (0_u64, 0);
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
            let is_item = way.len() == 1;
            items += usize::from(is_item);
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
                ObjectContent::Components(all) => way.push((target[0], all, transform, target)),
                ObjectContent::Mesh(_) => {
                    let id = |[m, o]: [usize; 2]| self.all[m].objects[o].id;
                    let component = way.get(2).map_or(reference.object, |&(.., object)| id(object));
                    let noted = way.get(1).and_then(|&(.., item)| self.purposes.get(&[id(item), component]));
                    let purpose = noted.copied().unwrap_or(VolumePurpose::Material);
                    placements.push(ObjectPlacement { object: target, item: items - 1, transform, purpose });
                }
                ObjectContent::Nothing => {}
            }
            if is_item && object.kind == ObjectKind::Other {
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
                let ObjectContent::Components(all) = &object.content else { continue };
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
}
