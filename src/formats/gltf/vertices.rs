//! The vertices of a new glTF file: those of the soup, split where glTF has to split them.

use super::looks::{Looks, own_color};
use crate::budget::{Budget, CHECK_EVERY, Charge, Stopped};
use crate::formats::colors::as_linear;
use crate::mesh::{Color, Soup};
use rustc_hash::FxHashMap;
use std::ops::Range;

/// The vertices that are written: those of the soup, or one for each different corner.
pub(super) struct Vertices {
    /// For each corner the number of its vertex; empty: as in the soup.
    of_corner: Vec<[u32; 3]>,
    /// The vertex of the soup behind each; empty: the same number.
    position: Vec<u32>,
    /// Texture coordinates of each, across and down; empty when there are none.
    pub(super) points: Vec<[f32; 2]>,
    /// Linear colour of each; empty when there are none.
    pub(super) colors: Vec<[f32; 4]>,
    pub(super) has_alpha: bool,
    /// Of each object with triangles, in the order in which they are written, its first vertex.
    first_of_object: Vec<u32>,
}

impl Vertices {
    /// `triangles` are all, sorted by objects.
    pub(super) fn of<'b>(
        soup: &Soup,
        looks: &Looks,
        triangles: &[u32],
        budget: &'b Budget,
    ) -> Result<(Self, Vec<Charge<'b>>), Stopped> {
        let has_points = !soup.texture.is_empty();
        let at_corners = looks.has_colors_at_corners;
        let has_alpha = |colors: &[Option<Color>]| {
            let alpha = |color: &Option<Color>| match color {
                Some(Color::Bytes(_, a)) => a.is_some(),
                Some(Color::Floats(_, a) | Color::Linear(_, a)) => a.is_some(),
                _ => false,
            };
            colors.iter().any(alpha)
        };
        let is_shown = |color: &Option<Color>| !matches!(color, None | Some(Color::Index(_)));
        let has_colors = !at_corners && soup.vertex_colors.iter().any(is_shown);
        let of_vertex = |v: u32| as_linear(soup.vertex_colors.get(v as usize).copied().flatten());
        let mut vertices = Self {
            of_corner: Vec::new(),
            position: Vec::new(),
            points: Vec::new(),
            colors: Vec::new(),
            has_alpha: has_alpha(if at_corners { &soup.face_colors } else { &soup.vertex_colors }),
            first_of_object: vec![0],
        };
        let mut charges = Vec::new();
        let object_of = |t: u32| looks.primitive_of(soup, t).0;
        let ends = triangles.first().zip(triangles.last());
        let is_of_one = ends.is_none_or(|(&first, &last)| object_of(first) == object_of(last));
        if !has_points && !at_corners && is_of_one {
            if has_colors {
                charges.push(budget.reserve(&mut vertices.colors, soup.positions.len())?);
                vertices.colors.extend((0..soup.positions.len() as u32).map(of_vertex));
            }
            return Ok((vertices, charges));
        }
        charges.push(budget.reserve(&mut vertices.of_corner, soup.triangles.len())?);
        vertices.of_corner.resize(soup.triangles.len(), [0; 3]);
        // A table and lists with a number, two coordinates and four channels for each different corner.
        const PER_VERTEX: u64 = 3 * 7 * size_of::<u32>() as u64;
        let mut charged = 0;
        let mut numbers: FxHashMap<(u32, [u32; 2], [u32; 4]), u32> = FxHashMap::default();
        let _charge = budget.charge((soup.triangles.len() * size_of::<u32>()) as u64)?;
        let mut next = triangles.to_vec();
        // Inside an object they are numbered in the order of the soup.
        next.sort_by_key(|&t| (object_of(t), t));
        let mut object = next.first().map_or(0, |&t| object_of(t));
        for (i, t) in next.into_iter().enumerate() {
            if i.is_multiple_of(CHECK_EVERY) {
                charges.push(budget.charge((vertices.position.len() - charged) as u64 * PER_VERTEX)?);
                charged = vertices.position.len();
            }
            if object != object_of(t) {
                object = object_of(t);
                vertices.first_of_object.push(vertices.position.len() as u32);
                numbers = FxHashMap::default();
            }
            let t = t as usize;
            let corners = soup.triangles[t];
            let points = soup.texture.of_triangle(t);
            let color = at_corners.then(|| as_linear(own_color(soup, t)));
            let number = |k: usize| {
                let v = corners[k];
                let point =
                    points.map_or([0.0; 2], |points| [points[k][0] as f32, (1.0 - points[k][1]) as f32]);
                let color = color.unwrap_or_default();
                let key = (v, point.map(f32::to_bits), color.map(f32::to_bits));
                *numbers.entry(key).or_insert_with(|| {
                    vertices.position.push(v);
                    if has_points {
                        vertices.points.push(point);
                    }
                    if at_corners {
                        vertices.colors.push(color);
                    } else if has_colors {
                        vertices.colors.push(of_vertex(v));
                    }
                    vertices.position.len() as u32 - 1
                })
            };
            vertices.of_corner[t] = [0, 1, 2].map(number);
        }
        Ok((vertices, charges))
    }

    pub(super) fn len(&self, soup: &Soup) -> usize {
        if self.of_corner.is_empty() { soup.positions.len() } else { self.position.len() }
    }

    pub(super) fn position(&self, i: usize) -> u32 {
        self.position.get(i).copied().unwrap_or(i as u32)
    }

    pub(super) fn corners(&self, soup: &Soup, t: usize) -> [u32; 3] {
        self.of_corner.get(t).copied().unwrap_or_else(|| soup.triangles[t])
    }

    /// The vertices of each object.
    pub(super) fn of_objects(&self, soup: &Soup) -> Vec<Range<usize>> {
        let ends = self.first_of_object.iter().skip(1).map(|&first| first as usize).chain([self.len(soup)]);
        self.first_of_object.iter().map(|&first| first as usize).zip(ends).map(|(a, b)| a..b).collect()
    }

    /// The colours as bytes, if they are all that.
    pub(super) fn color_bytes(&self) -> Option<Vec<[u8; 4]>> {
        let byte = |channel: f32| {
            let byte = (channel * 255.0).round() as u8;
            ((f64::from(byte) / 255.0) as f32 == channel).then_some(byte)
        };
        self.colors.iter().map(|&[r, g, b, a]| Some([byte(r)?, byte(g)?, byte(b)?, byte(a)?])).collect()
    }
}
