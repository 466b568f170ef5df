//! What a model part says, as far as it is understood.

use super::transform::Transform;
use crate::mesh::{Soup, Units};
use rustc_hash::{FxHashMap, FxHashSet};
use std::ops::Range;
use std::sync::Arc;

/// In the place of the number of a property or a text: there is none.
pub const NO_NUMBER: u32 = u32::MAX;

/// What an object is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ObjectKind {
    /// A solid to be made.
    Model,
    /// A support that is a solid.
    SolidSupport,
    /// A support that need not be one.
    Support,
    /// A surface that need not be closed.
    Surface,
    /// Anything else; it is not printed by itself.
    Other,
}

impl ObjectKind {
    /// True when the rules of 3MF demand a solid.
    pub fn is_solid(self) -> bool {
        matches!(self, Self::Model | Self::SolidSupport)
    }

    /// The kind of this word.
    pub(super) fn of(word: &str) -> Option<Self> {
        Some(match word {
            "model" => Self::Model,
            "solidsupport" => Self::SolidSupport,
            "support" => Self::Support,
            "surface" => Self::Surface,
            "other" => Self::Other,
            _ => return None,
        })
    }
}

/// What a triangle is made of: members of a property group at its corners.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Property {
    /// Id of the group; [`NO_NUMBER`]: that of the object.
    pub group: u32,
    /// The member at each corner; [`NO_NUMBER`]: not stated.
    pub members: [u32; 3],
}

impl Property {
    /// Nothing is stated.
    pub const NONE: Self = Self { group: NO_NUMBER, members: [NO_NUMBER; 3] };
}

/// What a 3MF says of faces beside their corners.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FaceAttributes {
    /// For each face its property; empty when no face has one.
    pub properties: Vec<Property>,
    /// For each face the number of the other attributes in its tag, or [`NO_NUMBER`]; empty when no face has any.
    pub others: Vec<u32>,
    /// Other attributes as the file writes them, such as `paint_color="4"`.
    pub texts: Arc<Vec<String>>,
}

impl FaceAttributes {
    /// The property of face `f`: its own, or `of_object`.
    pub(super) fn property_of(&self, of_object: Property, f: usize) -> Property {
        let own = self.properties.get(f).copied().unwrap_or(Property::NONE);
        match own {
            Property { members: [NO_NUMBER, ..], .. } => of_object,
            Property { group: NO_NUMBER, members } => Property { group: of_object.group, members },
            _ => own,
        }
    }
}

/// An object of a model part.
pub(super) struct Object {
    pub(super) id: u32,
    pub(super) kind: ObjectKind,
    pub(super) name: String,
    /// Property of triangles that state none.
    pub(super) property: Property,
    pub(super) content: ObjectContent,
}

/// What an object consists of.
pub(super) enum ObjectContent {
    Mesh(Box<ObjectMesh>),
    Components(Vec<Reference>),
    Nothing,
}

/// The mesh of an object.
#[derive(Default)]
pub(super) struct ObjectMesh {
    pub(super) soup: Soup,
    pub(super) attributes: FaceAttributes,
    /// Bytes of the elements of vertices and of triangles in the text of the part; empty when there is none.
    pub(super) spans: [Range<usize>; 2],
    /// Elements beside these, such as a beam lattice, which speak of vertices and triangles by number: their names.
    pub(super) extras: Vec<String>,
    /// Bytes of these elements.
    pub(super) extra_spans: Vec<Range<usize>>,
}

/// An object put into a place.
pub(super) struct Reference {
    pub(super) object: u32,
    /// The part of the object; `None`: the same part.
    pub(super) path: Option<String>,
    pub(super) transform: Transform,
    /// Byte at which it stands.
    pub(super) at: usize,
}

/// Members of a property group.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Group {
    /// Colours, where they are stated.
    Colors(Vec<Option<[u8; 4]>>),
    /// Places in a picture, across and up; those that are not stated are the origin.
    Places(Vec<[f64; 2]>),
    /// Shares of base materials.
    Mixtures { of: u32, members: Vec<u32>, shares: Vec<Vec<f64>> },
    /// Members of several groups on each other.
    Layers { of: Vec<u32>, members: Vec<Vec<u32>> },
}

impl Group {
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Colors(colors) => colors.len(),
            Self::Places(points) => points.len(),
            Self::Mixtures { shares, .. } => shares.len(),
            Self::Layers { members, .. } => members.len(),
        }
    }
}

/// Most layers or materials of a member that is mixed with others.
pub(super) const MIXED_MAX: usize = 16;

/// The property groups of a model part.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Groups {
    by_id: FxHashMap<u32, Group>,
    /// Ids of groups of base materials.
    materials: FxHashSet<u32>,
    /// Ids of groups whose members are not mixed: base materials, and members of more than [`MIXED_MAX`] layers or materials.
    unmixed: FxHashSet<u32>,
    /// By the ids of groups the bytes of their elements in the text of the part.
    spans: FxHashMap<u32, Range<usize>>,
}

impl Groups {
    pub(super) fn insert(&mut self, id: u32, group: Group, is_material: bool, span: Range<usize>) {
        let is_long = match &group {
            Group::Layers { of, .. } => of.len() > MIXED_MAX,
            Group::Mixtures { shares, .. } => shares.iter().any(|shares| shares.len() > MIXED_MAX),
            _ => false,
        };
        if is_material || is_long {
            self.unmixed.insert(id);
        }
        self.by_id.insert(id, group);
        self.spans.insert(id, span);
        if is_material {
            self.materials.insert(id);
        }
    }

    pub(super) fn get(&self, id: u32) -> Option<&Group> {
        self.by_id.get(&id)
    }

    /// A group whose members can be mixed.
    pub(super) fn mixable(&self, id: u32) -> Option<&Group> {
        self.get(id).filter(|_| !self.unmixed.contains(&id))
    }

    /// True when no more than one group has places in a picture.
    pub(super) fn have_one_picture(&self) -> bool {
        self.by_id.values().filter(|group| matches!(group, Group::Places(_))).count() <= 1
    }

    /// How many places in pictures there are in all groups.
    pub(super) fn count_of_places(&self) -> u64 {
        let of = |group: &Group| if let Group::Places(points) = group { points.len() as u64 } else { 0 };
        self.by_id.values().map(of).sum()
    }

    /// True when a group has places in a picture.
    pub(super) fn have_places(&self) -> bool {
        self.by_id.values().any(|group| matches!(group, Group::Places(_)))
    }

    /// True when the group is one of base materials.
    pub(super) fn is_material(&self, id: u32) -> bool {
        self.materials.contains(&id)
    }

    /// The bytes of the element of a group.
    pub(super) fn span(&self, id: u32) -> Option<Range<usize>> {
        self.spans.get(&id).cloned()
    }
}

/// A model part.
pub(super) struct ModelDocument {
    pub(super) part: String,
    pub(super) units: Units,
    pub(super) objects: Vec<Object>,
    /// Places in `objects` by id.
    pub(super) numbers: FxHashMap<u32, usize>,
    pub(super) groups: Groups,
    pub(super) items: Vec<Reference>,
    /// Rules that it breaks and extensions that it uses, as sentences.
    pub(super) remarks: Vec<String>,
}

impl ModelDocument {
    /// The colour of a member of a group, if it has one: of mixtures the mean, of layers that of the uppermost.
    pub(super) fn color(&self, group: u32, member: u32) -> Option<[u8; 4]> {
        match self.groups.get(group)? {
            Group::Layers { of, members } => {
                let indices = members.get(member as usize)?;
                let layers = of.iter().enumerate().rev();
                let of_layer = |(i, &group): (usize, &u32)| {
                    self.plain_color(group, indices.get(i).copied().unwrap_or(0))
                };
                layers.into_iter().find_map(of_layer)
            }
            _ => self.plain_color(group, member),
        }
    }

    fn plain_color(&self, group: u32, member: u32) -> Option<[u8; 4]> {
        match self.groups.get(group)? {
            Group::Colors(colors) => *colors.get(member as usize)?,
            Group::Mixtures { of, members, shares } => {
                let shares = shares.get(member as usize)?;
                let whole: f64 = shares.iter().sum();
                let mut mean = [0.0; 4];
                for (&member, share) in members.iter().zip(shares) {
                    let Some(Group::Colors(colors)) = self.groups.get(*of) else { return None };
                    let color = (*colors.get(member as usize)?)?;
                    for (sum, channel) in mean.iter_mut().zip(color) {
                        *sum += f64::from(channel) * share / whole;
                    }
                }
                (whole > 0.0).then(|| mean.map(|channel| channel.round() as u8))
            }
            Group::Places(_) | Group::Layers { .. } => None,
        }
    }

    /// The property of face `f` of an object: its own, or that of the object.
    pub(super) fn property_of(object: &Object, attributes: &FaceAttributes, f: usize) -> Property {
        attributes.property_of(object.property, f)
    }

    /// The colour of face `f` of an object, and whether it is the mean of corners that differ.
    pub(super) fn color_of_face(
        &self,
        object: &Object,
        attributes: &FaceAttributes,
        f: usize,
    ) -> Option<([u8; 4], bool)> {
        let Property { group, members } = Self::property_of(object, attributes, f);
        let [first, ..] = members;
        let of = |member: u32| self.color(group, if member == NO_NUMBER { first } else { member });
        let colors = [of(members[0])?, of(members[1])?, of(members[2])?];
        let mean = |k: usize| (colors.iter().map(|color| u32::from(color[k])).sum::<u32>() + 1) / 3;
        let is_mean = colors[1] != colors[0] || colors[2] != colors[0];
        Some(([0, 1, 2, 3].map(|k| mean(k) as u8), is_mean))
    }
}
