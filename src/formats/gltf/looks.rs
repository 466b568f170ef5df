//! What the triangles of a soup look like, as the primitives of a glTF mesh hold it: one for each look of an object.

use crate::formats::colors::as_linear;
use crate::mesh::{Color, Soup};
use rustc_hash::FxHashMap;

/// Colours of faces beyond this many are given to vertices instead of materials: readers take each material by itself.
const COLORED_MATERIALS_MAX: usize = 256;

/// What the triangles of one primitive have in common.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Look {
    /// Number of a material of the soup.
    pub(super) material: Option<u32>,
    /// Bits of the linear colour of the faces, where a material shows it that the soup does not describe.
    pub(super) color: Option<[u32; 4]>,
    /// Has texture coordinates.
    pub(super) has_texture: bool,
}

/// The looks of all triangles.
pub(super) struct Looks {
    /// Each once, in the order of the first triangle that has it.
    pub(super) list: Vec<Look>,
    /// For each triangle a number in the list; empty when there is one look only.
    of_triangle: Vec<u32>,
    /// Colours of faces are given to vertices, which faces do not share then.
    pub(super) has_colors_at_corners: bool,
}

/// The colour of the face of triangle `t`, unless its material shows it or it is none.
pub(super) fn own_color(soup: &Soup, t: usize) -> Option<Color> {
    let face = soup.face_of(t as u32);
    let color = soup.face_colors.get(face as usize).copied().flatten();
    let color = color.filter(|color| !matches!(color, Color::Index(_)))?;
    let described = soup.materials.descriptions.as_ref();
    let of_material =
        soup.materials.of(face).and_then(|material| described?.colors.get(material as usize).copied()?);
    (of_material != Some(color)).then_some(color)
}

impl Looks {
    pub(super) fn of(soup: &Soup) -> Self {
        Self::with(soup, false).unwrap_or_else(|| Self::with(soup, true).unwrap_or(Self::ONE))
    }

    const ONE: Self = Self { list: Vec::new(), of_triangle: Vec::new(), has_colors_at_corners: false };

    /// The looks with colours of faces at corners or as materials; `None`: they do not go into materials.
    fn with(soup: &Soup, has_colors_at_corners: bool) -> Option<Self> {
        let mut looks = Self { has_colors_at_corners, ..Self::ONE };
        let mut numbers: FxHashMap<Look, u32> = FxHashMap::default();
        // Vertex colours would be multiplied with those of the faces.
        let has_own_colors = !soup.face_colors.is_empty() && soup.vertex_colors.is_empty();
        let is_described = soup.materials.descriptions.is_some();
        for t in 0..soup.triangles.len() {
            let material = soup.materials.of(soup.face_of(t as u32));
            let color = if has_own_colors { own_color(soup, t) } else { None };
            if !has_colors_at_corners && color.is_some() && material.is_some() && is_described {
                return None;
            }
            let color = color.filter(|_| !has_colors_at_corners);
            let look = Look {
                material,
                color: color.map(|color| as_linear(Some(color)).map(f32::to_bits)),
                has_texture: soup.texture.of_triangle(t).is_some(),
            };
            let next = looks.list.len() as u32;
            let number = *numbers.entry(look).or_insert(next);
            if number == next {
                looks.list.push(look);
                if looks.list.len() == 2 {
                    looks.of_triangle = vec![0; t];
                }
                if look.color.is_some() && looks.list.len() > COLORED_MATERIALS_MAX {
                    return None;
                }
            }
            if looks.list.len() > 1 {
                looks.of_triangle.push(number);
            }
        }
        Some(looks)
    }

    /// The object of triangle `t` of `soup`, plus one, or 0; and the number of its look.
    pub(super) fn primitive_of(&self, soup: &Soup, t: u32) -> (u32, u32) {
        let look = self.of_triangle.get(t as usize).copied().unwrap_or(0);
        (soup.objects.of(soup.face_of(t)).map_or(0, |object| object + 1), look)
    }

    /// The triangles of `soup` as primitives hold them: those of each object together, and of each look of it.
    pub(super) fn sorted(&self, soup: &Soup) -> Vec<u32> {
        let mut triangles: Vec<u32> = (0..soup.triangles.len() as u32).collect();
        if self.list.len() > 1 || !soup.objects.is_empty() {
            triangles.sort_by_key(|&t| self.primitive_of(soup, t));
        }
        triangles
    }
}

/// The order in which the triangles of `soup` are written, as they are sorted by objects and looks; `None`: their own.
pub(in crate::formats) fn stored_order(soup: &Soup) -> Option<Vec<u32>> {
    let sorted = Looks::of(soup).sorted(soup);
    if sorted.is_sorted() { None } else { Some(sorted) }
}
