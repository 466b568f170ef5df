//! Which properties of a PLY file mean something to us.

use super::header::{HeaderProperty, PlyElement, PropertyType, Scalar};
use crate::formats::{Place, ReadError};

/// What a property means to us.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PropertyRole {
    /// x, y or z.
    Coordinate(usize),
    /// Red, green, blue or alpha.
    Channel(usize),
    /// The corners of a face.
    Corners,
    /// The vertices of triangle strips.
    Strips,
    /// The number of a colour in a colour map.
    ColorIndex,
    /// An end of an edge.
    End(usize),
    Other,
}

/// The properties of an element with their roles.
pub(super) struct PropertyRoles {
    pub(super) properties: Vec<(PropertyRole, PropertyType)>,
    pub(super) colors: ColorKind,
}

/// What the colour channels of an element make.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ColorKind {
    None,
    Bytes { has_alpha: bool },
    Floats { has_alpha: bool },
}

impl PropertyRoles {
    /// Nothing has a role yet.
    pub(super) fn new(element: &PlyElement<'_>) -> Self {
        let roles = element.properties.iter().map(|property| (PropertyRole::Other, property.kind));
        Self { properties: roles.collect(), colors: ColorKind::None }
    }

    /// Number of properties that mean nothing to us; normals are no loss, as a changed surface has others.
    pub(super) fn further_properties(&self, element: &PlyElement<'_>) -> u64 {
        let is_further = |(property, (role, _)): &(&HeaderProperty<'_>, &(PropertyRole, PropertyType))| {
            *role == PropertyRole::Other && !matches!(property.name, b"nx" | b"ny" | b"nz")
        };
        element.properties.iter().zip(&self.properties).filter(is_further).count() as u64
    }

    /// Notes x, y and z.
    pub(super) fn with_coordinates(mut self, element: &PlyElement<'_>) -> Result<Self, ReadError> {
        for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
            match element.find(&[name]) {
                Some(i) if matches!(self.properties[i].1, PropertyType::One(_)) => {
                    self.properties[i].0 = PropertyRole::Coordinate(k);
                }
                _ => return Err(lacks(element, "the properties x, y and z")),
            }
        }
        Ok(self)
    }

    /// Notes the list of vertices as `role`.
    pub(super) fn with_vertices(
        mut self,
        element: &PlyElement<'_>,
        role: PropertyRole,
    ) -> Result<Self, ReadError> {
        match element.find(&["vertex_indices", "vertex_index"]) {
            Some(i) if matches!(self.properties[i].1, PropertyType::List { item, .. } if item.is_integer()) =>
            {
                self.properties[i].0 = role;
                Ok(self)
            }
            _ => Err(lacks(element, "a list of integers vertex_indices")),
        }
    }

    /// Notes the number of a colour.
    pub(super) fn with_color_index(mut self, element: &PlyElement<'_>) -> Self {
        if let Some(i) = element.find(&["color_index"])
            && matches!(self.properties[i].1, PropertyType::One(scalar) if scalar.is_integer())
        {
            self.properties[i].0 = PropertyRole::ColorIndex;
        }
        self
    }

    /// Notes both ends of an edge, if they are there.
    pub(super) fn with_ends(mut self, element: &PlyElement<'_>) -> Option<Self> {
        for (k, name) in ["vertex1", "vertex2"].into_iter().enumerate() {
            let i = element.find(&[name])?;
            if !matches!(self.properties[i].1, PropertyType::One(scalar) if scalar.is_integer()) {
                return None;
            }
            self.properties[i].0 = PropertyRole::End(k);
        }
        Some(self)
    }

    /// Notes the colour channels, if red, green and blue are there and all channels are bytes or all are floats.
    pub(super) fn with_colors(mut self, element: &PlyElement<'_>) -> Self {
        const NAMES: [[&str; 2]; 4] = [
            ["red", "diffuse_red"],
            ["green", "diffuse_green"],
            ["blue", "diffuse_blue"],
            ["alpha", "diffuse_alpha"],
        ];
        let found = NAMES.map(|names| element.find(&names));
        let kinds: Vec<PropertyType> = found.iter().flatten().map(|&i| self.properties[i].1).collect();
        let has_alpha = found[3].is_some();
        self.colors = if found[..3].iter().any(Option::is_none) {
            ColorKind::None
        } else if kinds.iter().all(|&kind| kind == PropertyType::One(Scalar::U8)) {
            ColorKind::Bytes { has_alpha }
        } else if kinds.iter().all(|kind| matches!(kind, PropertyType::One(Scalar::F32 | Scalar::F64))) {
            ColorKind::Floats { has_alpha }
        } else {
            ColorKind::None
        };
        if self.colors != ColorKind::None {
            for (channel, i) in found.into_iter().enumerate() {
                if let Some(i) = i {
                    self.properties[i].0 = PropertyRole::Channel(channel);
                }
            }
        }
        self
    }
}

fn lacks(element: &PlyElement<'_>, expected: &str) -> ReadError {
    let found = format!("element {}", String::from_utf8_lossy(element.name));
    ReadError::unparseable(Place::Line(element.line), found, format!("{expected} in it"))
}
