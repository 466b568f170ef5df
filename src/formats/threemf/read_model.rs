//! A model part: units, resources, objects and the build.

use super::model::{
    Group, ModelDocument, NO_NUMBER, Object, ObjectContent, ObjectKind, ObjectMesh, Property, Reference,
};
use super::model_reader::{ModelReader, number};
use super::package::{resolve, shortened};
use super::read_mesh;
use super::read_properties;
use super::transform::Transform;
use super::xml::{Attribute, Document, Namespace, XmlElement, XmlEvent, value, value_in};
use crate::budget::Budget;
use crate::formats::{ReadError, ReadOptions};
use crate::mesh::Units;

/// Names of metadata that are compared with each other.
const METADATA_MAX: usize = 200;

/// Names that the core specification gives to metadata; all others are in the namespace of their maker.
const METADATA_NAMES: [&str; 9] = [
    "Title",
    "Designer",
    "Description",
    "Copyright",
    "LicenseTerms",
    "Rating",
    "CreationDate",
    "ModificationDate",
    "Application",
];
/// Names that a remark lists.
const NAMES_LISTED: usize = 5;

/// Reads the model of `document`.
///
/// # Errors
/// What is no model of a 3MF, requires what is not known here, or refers to what is not there.
pub(super) fn read_model(
    document: &Document<'_>,
    options: &ReadOptions,
    budget: &Budget,
) -> Result<ModelDocument, ReadError> {
    let mut reader = ModelReader::new(document, options, budget);
    reader.read()?;
    Ok(reader.into_model())
}

impl<'x> ModelReader<'x> {
    fn read(&mut self) -> Result<(), ReadError> {
        let XmlEvent::Open(root) = self.scanner.next()? else {
            return Err(self.error(0, "no element", "<model>"));
        };
        if (root.namespace, root.local) != (Namespace::Core, "model") {
            let expected = "<model> in the namespace of the 3MF core specification";
            return Err(self.error(root.at, &format!("<{}>", shortened(root.name)), expected));
        }
        self.take_root(&root)?;
        let mut has = [false; 2];
        if !root.is_empty {
            while let Some(element) = self.next_child(1)? {
                match (element.namespace, element.local) {
                    (Namespace::Core, "resources") => {
                        has[0] = true;
                        self.read_resources(&element)?;
                    }
                    (Namespace::Core, "build") => {
                        has[1] = true;
                        self.read_build(&element)?;
                    }
                    (Namespace::Core, "metadata") => self.take_metadata(&element)?,
                    _ => self.scanner.skip(&element)?,
                }
            }
        }
        self.note_metadata();
        for (has, name) in has.into_iter().zip(["resources", "build"]) {
            if !has {
                self.remark(root.at, &format!("there is no <{name}>"));
            }
        }
        match self.scanner.next()? {
            XmlEvent::End => Ok(()),
            XmlEvent::Open(second) => Err(self.error(second.at, "a second root element", "one <model>")),
            XmlEvent::Close => Err(self.error(self.scanner.position(), "an end tag", "the end of the part")),
        }
    }

    fn take_root(&mut self, root: &XmlElement<'x>) -> Result<(), ReadError> {
        let attributes = self.scanner.attributes(root)?;
        self.model.units = match value(&attributes, "unit") {
            None | Some("millimeter") => Units::Millimetre,
            Some("micron") => Units::Micrometre,
            Some("centimeter") => Units::Centimetre,
            Some("inch") => Units::Inch,
            Some("foot") => Units::Foot,
            Some("meter") => Units::Metre,
            Some(other) => {
                let found = format!("the unit {:?}", shortened(other));
                let expected = "micron, millimeter, centimeter, inch, foot or meter";
                return Err(self.error(root.at, &found, expected));
            }
        };
        if attributes.iter().any(|attribute| attribute.key() == "xml:space") {
            self.remark(root.at, "<model> has the attribute xml:space");
        }
        let listed = ["requiredextensions", "recommendedextensions"];
        for (name, is_required) in listed.into_iter().zip([true, false]) {
            for prefix in value(&attributes, name).unwrap_or_default().split_ascii_whitespace() {
                self.take_extension(root, prefix, is_required)?;
            }
        }
        Ok(())
    }

    fn take_extension(
        &mut self,
        root: &XmlElement<'x>,
        prefix: &str,
        is_required: bool,
    ) -> Result<(), ReadError> {
        match self.scanner.namespace(prefix) {
            Some(Namespace::Other | Namespace::None) if is_required => {
                let declared = format!("xmlns:{prefix}");
                let attributes = self.scanner.attributes(root)?;
                let uri = attributes.iter().find(|a| a.key() == declared).map(|a| a.value.to_string());
                let name = uri.as_deref().unwrap_or(prefix);
                let found = format!("the required extension {}, which is not known here,", shortened(name));
                let known = "material, production, slice, beam lattice or triangle sets";
                Err(self.error(root.at, &found, known))
            }
            None if is_required => {
                let found = format!("the required extension {:?}, which is not declared,", shortened(prefix));
                Err(self.error(root.at, &found, "the prefix of a namespace"))
            }
            _ => Ok(()),
        }
    }

    /// Notes names of metadata that are in no namespace and not those of the core specification. The samples of the
    /// consortium disagree on whether that breaks a rule: one must pass with such a name, another must fail.
    fn note_metadata(&mut self) {
        let is_strange =
            |name: &&String| !name.contains(':') && !METADATA_NAMES.iter().any(|known| known == *name);
        let strange: Vec<&String> = self.metadata.iter().filter(is_strange).collect();
        if strange.is_empty() {
            return;
        }
        let listed: Vec<String> =
            strange.iter().take(NAMES_LISTED).map(|name| format!("{:?}", shortened(name))).collect();
        let more = match strange.len() - listed.len() {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        let text = format!(
            "{} has metadata whose names are neither those of the core specification nor in a namespace: {}{more}. They are \
             kept.",
            self.model.part,
            listed.join(", ")
        );
        self.model.remarks.push(text);
    }

    fn take_metadata(&mut self, element: &XmlElement<'x>) -> Result<(), ReadError> {
        let attributes = self.scanner.attributes(element)?;
        let name = value(&attributes, "name").unwrap_or_default().to_owned();
        if name.is_empty() {
            self.remark(element.at, "a <metadata> has no name");
        } else if self.metadata.contains(&name) {
            self.remark(element.at, &format!("two <metadata> have the name {:?}", shortened(&name)));
        } else if self.metadata.len() < METADATA_MAX {
            self.metadata.push(name);
        }
        self.scanner.skip(element)
    }

    fn read_resources(&mut self, resources: &XmlElement<'x>) -> Result<(), ReadError> {
        if resources.is_empty {
            return Ok(());
        }
        let depth = self.scanner.depth;
        while let Some(element) = self.next_child(depth)? {
            match (element.namespace, element.local) {
                (Namespace::Core, "object") => self.read_object(&element)?,
                (Namespace::Core | Namespace::Material, _) => {
                    if let Some(id) = self.id_of(&element)? {
                        match self.read_group(&element)? {
                            Some(group) => {
                                let is_material = element.namespace == Namespace::Core;
                                let span = element.at..self.scanner.position();
                                self.model.groups.insert(id, group, is_material, span);
                            }
                            None => {
                                self.other_ids.insert(id);
                            }
                        }
                    } else {
                        self.scanner.skip(&element)?;
                    }
                }
                (Namespace::Slice, "slicestack") => {
                    self.note_extension("slices", "where the parts stay apart");
                    self.scanner.skip(&element)?;
                }
                _ => self.scanner.skip(&element)?,
            }
        }
        Ok(())
    }

    /// The id of a resource, which no other one may have.
    fn id_of(&mut self, element: &XmlElement<'x>) -> Result<Option<u32>, ReadError> {
        let attributes = self.scanner.attributes(element)?;
        let Some(text) = value(&attributes, "id") else { return Ok(None) };
        let Some(id) = number(text) else {
            let found = format!("the id {:?} of <{}>", shortened(text), element.name);
            return Err(self.error(element.at, &found, "a whole number from 1"));
        };
        let model = &self.model;
        let is_known =
            model.numbers.contains_key(&id) || model.groups.get(id).is_some() || self.other_ids.contains(&id);
        if is_known {
            return Err(self.error(
                element.at,
                &format!("a second resource with the id {id}"),
                "ids used once",
            ));
        }
        Ok(Some(id))
    }

    fn read_group(&mut self, element: &XmlElement<'x>) -> Result<Option<Group>, ReadError> {
        match (element.namespace, element.local) {
            (Namespace::Core, "basematerials") => {
                read_properties::colors(self, element, "base", "displaycolor").map(Some)
            }
            (Namespace::Material, "colorgroup") => {
                read_properties::colors(self, element, "color", "color").map(Some)
            }
            (Namespace::Material, "texture2dgroup") => read_properties::places(self, element).map(Some),
            (Namespace::Material, "compositematerials") => read_properties::mixtures(self, element).map(Some),
            (Namespace::Material, "multiproperties") => read_properties::layers(self, element).map(Some),
            (Namespace::Material, "texture2d") => {
                read_properties::check_texture(self, element)?;
                self.scanner.skip(element)?;
                Ok(None)
            }
            _ => {
                self.scanner.skip(element)?;
                Ok(None)
            }
        }
    }

    fn read_object(&mut self, element: &XmlElement<'x>) -> Result<(), ReadError> {
        let Some(id) = self.id_of(element)? else {
            return Err(self.error(element.at, "an object without an id", "an id"));
        };
        let attributes = self.scanner.attributes(element)?;
        let kind = match value(&attributes, "type") {
            None => ObjectKind::Model,
            Some(word) => ObjectKind::of(word).unwrap_or_else(|| {
                let text = format!("the object {id} has the type {:?}, which there is not", shortened(word));
                self.remark(element.at, &text);
                ObjectKind::Model
            }),
        };
        let name = value(&attributes, "name").unwrap_or_default().to_owned();
        let [group, member] = ["pid", "pindex"].map(|key| value(&attributes, key).and_then(number));
        let member = member.unwrap_or(if group.is_some() { 0 } else { NO_NUMBER });
        let property = Property { group: group.unwrap_or(NO_NUMBER), members: [member; 3] };
        if value_in(&attributes, Namespace::Slice, "slicestackid").is_some() {
            self.note_extension("slices", "where the parts stay apart");
        }
        let mut content = ObjectContent::Nothing;
        if !element.is_empty {
            let depth = self.scanner.depth;
            while let Some(child) = self.next_child(depth)? {
                match (child.namespace, child.local) {
                    (Namespace::Core, "mesh") => {
                        let mesh = read_mesh::mesh(self, &child)?;
                        content = self.only(&content, ObjectContent::Mesh(Box::new(mesh)), &child)?;
                    }
                    (Namespace::Core, "components") => {
                        let all = self.read_references(&child, "component")?;
                        content = self.only(&content, ObjectContent::Components(all), &child)?;
                    }
                    _ => self.scanner.skip(&child)?,
                }
            }
        }
        if let ObjectContent::Nothing = content {
            self.remark(element.at, &format!("the object {id} has neither a mesh nor components"));
        }
        let object = Object { id, kind, name, property, content };
        self.check_properties(&object, element.at);
        self.model.numbers.insert(id, self.model.objects.len());
        self.model.objects.push(object);
        Ok(())
    }

    /// `new`, where there was nothing before.
    fn only(
        &self,
        old: &ObjectContent,
        new: ObjectContent,
        element: &XmlElement<'x>,
    ) -> Result<ObjectContent, ReadError> {
        match old {
            ObjectContent::Nothing => Ok(new),
            _ => {
                let found = format!("a second content <{}> of an object", element.name);
                Err(self.error(element.at, &found, "one mesh, or one list of components"))
            }
        }
    }

    fn read_build(&mut self, build: &XmlElement<'x>) -> Result<(), ReadError> {
        let items = self.read_references(build, "item")?;
        self.model.items.extend(items);
        Ok(())
    }

    fn read_references(&mut self, list: &XmlElement<'x>, name: &str) -> Result<Vec<Reference>, ReadError> {
        let mut all = Vec::new();
        if list.is_empty {
            return Ok(all);
        }
        let depth = self.scanner.depth;
        while let Some(element) = self.next_child(depth)? {
            if (element.namespace, element.local) == (Namespace::Core, name) {
                let attributes = self.scanner.attributes(&element)?;
                all.push(self.reference(&element, &attributes)?);
            }
            self.scanner.skip(&element)?;
        }
        Ok(all)
    }

    fn reference(
        &self,
        element: &XmlElement<'x>,
        attributes: &[Attribute<'_>],
    ) -> Result<Reference, ReadError> {
        let Some(object) = value(attributes, "objectid").and_then(number) else {
            let found = format!("<{}> without the id of an object", element.name);
            return Err(self.error(element.at, &found, "objectid=\"N\""));
        };
        let transform = match value(attributes, "transform") {
            None => Transform::IDENTITY,
            Some(text) => Transform::parse(text).ok_or_else(|| {
                let found = format!("the transform {:?}", shortened(text));
                let expected = "twelve finite numbers that leave a solid its volume";
                self.error(element.at, &found, expected)
            })?,
        };
        let path = match value_in(attributes, Namespace::Production, "path") {
            None => None,
            Some(text) => Some(resolve(&self.model.part, text).ok_or_else(|| {
                let found = format!("the path {:?}, which leads out of the package", shortened(text));
                self.error(element.at, &found, "the name of a model part")
            })?),
        };
        Ok(Reference { object, path, transform, at: element.at })
    }

    /// Remarks on properties of an object and its triangles that are not there.
    fn check_properties(&mut self, object: &Object, at: usize) {
        let default = object.property;
        let names =
            |model: &ModelDocument, Property { group, members }: Property| match model.groups.get(group) {
                None => Some(format!("the property group {group}, which is not there")),
                Some(found) => {
                    let count = found.len();
                    let is_beyond = |&&member: &&u32| member != NO_NUMBER && member as usize >= count;
                    let beyond = members.iter().find(is_beyond)?;
                    Some(format!("the member {beyond} of the property group {group}, which has {count}"))
                }
            };
        if default.group != NO_NUMBER
            && let Some(what) = names(&self.model, default)
        {
            self.remark(at, &format!("the object {} has {what}", object.id));
        }
        let ObjectContent::Mesh(mesh) = &object.content else { return };
        let ObjectMesh { attributes, .. } = &**mesh;
        let mut is_default_missing = false;
        for (f, &own) in attributes.properties.iter().enumerate() {
            if own == Property::NONE {
                continue;
            }
            is_default_missing |= default.group == NO_NUMBER;
            let effective = ModelDocument::property_of(object, attributes, f);
            let Some(what) = names(&self.model, effective) else { continue };
            self.remark(at, &format!("triangle {f} of the object {} has {what}", object.id));
            break;
        }
        if is_default_missing {
            let text =
                format!("triangles of the object {} have properties and the object has no pid", object.id);
            self.remark(at, &text);
        }
    }
}
