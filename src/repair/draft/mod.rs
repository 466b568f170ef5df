//! The mesh that repair steps work on: a plain triangle list that remembers where everything came from.

mod faces;
mod seams;

pub use faces::Faced;
use seams::are_over_seams;

use super::Changes;
use crate::geom::DVec3;
use crate::mesh::{Color, NO_POINT, PolygonRuns, Soup, Texture, triangle_of};

/// In the place of an origin: made by a repair step.
pub const NEW: u32 = u32::MAX;

/// From here on an origin of a vertex is the number of a blend.
pub const FIRST_BLEND: u32 = 1 << 31;

/// A vertex that is new between others: corners of the soup, as `3 t + c` for corner `c` of triangle `t`, with their
/// shares, which are positive and have the sum 1.
pub type Blend = Vec<(u32, f64)>;

/// What patches of holes take their colours and their texture from.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Blends {
    /// The vertices with origin [`FIRST_BLEND`] and up.
    pub vertices: Vec<Blend>,
    /// Vertices of the soup at rims of patches, each with its corner there; ascending.
    pub rims: Vec<[u32; 2]>,
}

/// Triangles under repair.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Draft {
    /// Vertex positions, all finite, in the unit of the file.
    pub positions: Vec<DVec3>,
    /// The vertex of the soup behind each vertex; of welded vertices, the first. From [`FIRST_BLEND`] on: one of
    /// `blends`.
    pub vertex_origin: Vec<u32>,
    /// Vertex ids of each triangle's corners.
    pub triangles: Vec<[u32; 3]>,
    /// The triangle of the soup behind each triangle, also of the parts of a split one; [`NEW`] for patches of holes.
    pub triangle_origin: Vec<u32>,
    /// Triangles of the soup, ascending, that it holds in both directions, so that they do not say where outside is.
    pub two_sided: Vec<u32>,
    /// What is behind the new vertices of patches.
    pub blends: Blends,
    /// Which triangles are polygons; none unless the draft was made with [`Draft::with_polygons`].
    pub polygons: PolygonRuns,
}

impl Draft {
    /// The triangles of `soup` and the vertices they use; counts what of the file that leaves out.
    pub fn from_soup(soup: &Soup) -> (Self, Changes) {
        let mut draft = Self {
            positions: soup.positions.clone(),
            vertex_origin: (0..soup.positions.len() as u32).collect(),
            triangles: soup.triangles.clone(),
            triangle_origin: (0..soup.triangles.len() as u32).collect(),
            two_sided: Vec::new(),
            blends: Blends::default(),
            polygons: Default::default(),
        };
        let dropped = draft.drop_unused_vertices();
        let changes = Changes::counted([
            ("polygons_split", soup.polygons.faces.len() as u64),
            ("unusable_faces_dropped", soup.face_faults.len() as u64),
            ("unused_vertices_dropped", dropped),
            ("segments_dropped", soup.segments.len() as u64),
        ]);
        (draft, changes)
    }

    /// These triangles over these points.
    #[cfg(test)]
    pub(super) fn of(points: &[[f64; 3]], triangles: &[[u32; 3]]) -> Self {
        Self {
            positions: points.iter().map(|&p| DVec3::from_array(p)).collect(),
            vertex_origin: (0..points.len() as u32).collect(),
            triangles: triangles.to_vec(),
            triangle_origin: (0..triangles.len() as u32).collect(),
            two_sided: Vec::new(),
            blends: Default::default(),
            polygons: Default::default(),
        }
    }

    /// Bytes that it takes, for a budget.
    pub fn bytes(&self) -> u64 {
        let per_vertex = size_of::<DVec3>() + size_of::<u32>();
        let per_triangle = size_of::<[u32; 3]>() + size_of::<u32>();
        (self.positions.len() * per_vertex + self.triangles.len() * per_triangle) as u64
    }

    /// The corners of triangle `t`.
    pub fn corners(&self, t: usize) -> [DVec3; 3] {
        self.triangles[t].map(|v| self.positions[v as usize])
    }

    /// Keeps the triangles that are marked.
    pub fn retain_triangles(&mut self, is_kept: &[bool]) {
        retain_marked(&mut self.triangles, is_kept);
        retain_marked(&mut self.triangle_origin, is_kept);
        if !self.polygons.is_empty() {
            self.polygons.retain(is_kept);
        }
    }

    /// Drops vertices that no triangle uses and gives their number; the others keep their order.
    pub fn drop_unused_vertices(&mut self) -> u64 {
        let mut is_used = vec![false; self.positions.len()];
        for &v in self.triangles.as_flattened() {
            is_used[v as usize] = true;
        }
        let mut used = 0;
        let renumbered: Vec<u32> = is_used
            .iter()
            .map(|&is_used| {
                used += u32::from(is_used);
                used.wrapping_sub(1)
            })
            .collect();
        let dropped = self.positions.len() as u64 - u64::from(used);
        if dropped > 0 {
            for v in self.triangles.as_flattened_mut() {
                *v = renumbered[*v as usize];
            }
            retain_marked(&mut self.positions, &is_used);
            retain_marked(&mut self.vertex_origin, &is_used);
        }
        dropped
    }

    /// Puts `parts` in the place of triangle `t`: the first there, the others after the last triangle. A polygon of which `t`
    /// is a part becomes triangles, if there is more than one.
    pub fn replace(&mut self, t: u32, parts: &[[u32; 3]]) {
        if parts.len() > 1 {
            self.polygons.split(t as usize);
            self.polygons.push_triangles(parts.len() - 1);
        }
        let origin = self.triangle_origin[t as usize];
        self.triangles[t as usize] = parts[0];
        self.triangles.extend(&parts[1..]);
        self.triangle_origin.extend(std::iter::repeat_n(origin, parts.len() - 1));
    }

    /// Turns triangle `t` around; all triangles of a polygon are to be turned together.
    pub fn flip(&mut self, t: usize) {
        self.triangles[t].swap(1, 2);
    }

    /// The draft as a soup to be written; `source` is the soup it was made from and gives the
    /// colours, the texture coordinates and the materials.
    pub fn to_soup(&self, source: &Soup) -> Soup {
        let face_behind = |&t: &u32| (t != NEW).then(|| source.face_of(t));
        let color_of_face = |t: &u32| source.face_colors[face_behind(t)? as usize];
        Soup {
            positions: self.positions.clone(),
            triangles: self.triangles.clone(),
            face_count: self.triangles.len() as u32,
            is_f32_exact: self.positions.iter().all(|p| p.as_vec3().as_dvec3() == *p),
            vertex_colors: match source.vertex_colors.is_empty() {
                true => Vec::new(),
                false => self.vertex_origin.iter().map(|&v| self.color(v, source)).collect(),
            },
            face_colors: match source.face_colors.is_empty() {
                true => Vec::new(),
                false => self.triangle_origin.iter().map(color_of_face).collect(),
            },
            texture: self.texture(&source.texture, source),
            materials: source.materials.on(self.triangle_origin.iter().map(face_behind)),
            ..Soup::default()
        }
    }

    /// The colour of a vertex with this origin.
    fn color(&self, origin: u32, source: &Soup) -> Option<Color> {
        if origin < FIRST_BLEND {
            return source.vertex_colors[origin as usize];
        }
        let blend = &self.blends.vertices[(origin - FIRST_BLEND) as usize];
        let color_of = |&(corner, share): &(u32, f64)| {
            let v = source.triangles[triangle_of(corner) as usize][(corner % 3) as usize];
            (source.vertex_colors[v as usize], share)
        };
        Color::blend(&blend.iter().map(color_of).collect::<Vec<_>>())
    }

    /// The texture of the triangles whose corners are still at vertices of their triangle in `source`, or where these
    /// were before they moved, and of patches, between the points at their rims, where no seam runs into them; other
    /// triangles have none.
    fn texture(&self, texture: &Texture, source: &Soup) -> Texture {
        if texture.is_empty() {
            return Texture::default();
        }
        let place = |v: u32| source.positions.get(v as usize);
        let of_triangle = |t: usize| {
            let origin = self.triangle_origin[t] as usize;
            let (was, points) = (source.triangles.get(origin)?, texture.corners.get(origin)?);
            let point = |v: u32| {
                let k = (0..3).find(|&k| place(was[k]) == place(self.vertex_origin[v as usize]))?;
                Some(points[k])
            };
            let [a, b, c] = self.triangles[t].map(point);
            Some([a?, b?, c?])
        };
        let values = |t: usize| {
            let corners = of_triangle(t)?;
            corners.iter().all(|&p| p != NO_POINT).then(|| corners.map(|p| texture.points[p as usize]))
        };
        let is_over_seam = are_over_seams(self, values);
        let mut points = texture.points.clone();
        let of_blends: Vec<Option<u32>> =
            self.blends.vertices.iter().map(|blend| blended(blend, texture, &mut points)).collect();
        let at_rim = |origin: u32| {
            let rims = &self.blends.rims;
            let [_, corner] =
                *rims.get(rims.partition_point(|&[v, _]| v < origin)).filter(|r| r[0] == origin)?;
            Some(texture.corners[triangle_of(corner) as usize][(corner % 3) as usize])
                .filter(|&point| point != NO_POINT)
        };
        let of_patch = |t: usize| {
            let point = |v: u32| match self.vertex_origin[v as usize] {
                origin if origin >= FIRST_BLEND => of_blends[(origin - FIRST_BLEND) as usize],
                origin => at_rim(origin),
            };
            let [a, b, c] = self.triangles[t].map(point);
            (self.triangle_origin[t] == NEW && !is_over_seam[t]).then_some([a?, b?, c?])
        };
        let corners = (0..self.triangles.len())
            .map(|t| of_triangle(t).or_else(|| of_patch(t)).unwrap_or([NO_POINT; 3]))
            .collect();
        Texture { points, corners }.without_unused_points()
    }

    /// Broken invariants, as sentences; empty when all hold.
    pub fn check(&self) -> Vec<String> {
        let mut broken = Vec::new();
        if self.vertex_origin.len() != self.positions.len() {
            broken.push("vertex_origin has another length than positions".to_owned());
        }
        if self.triangle_origin.len() != self.triangles.len() {
            broken.push("triangle_origin has another length than triangles".to_owned());
        }
        if !self.polygons.is_empty() && self.polygons.len() != self.triangles.len() {
            broken.push("polygons has another length than triangles".to_owned());
        }
        for (t, corners) in self.triangles.iter().enumerate() {
            if corners.iter().any(|&v| v as usize >= self.positions.len()) {
                broken.push(format!("triangle {t} names a vertex that is not there: {corners:?}"));
            }
        }
        if let Some(v) = self.positions.iter().position(|p| !p.is_finite()) {
            broken.push(format!("vertex {v} is not finite"));
        }
        broken
    }
}

/// Adds the point of a blend to `points`; gives its number, if all corners of the blend have points.
fn blended(blend: &Blend, texture: &Texture, points: &mut Vec<[f64; 2]>) -> Option<u32> {
    let mut sum = [0.0; 2];
    for &(corner, share) in blend {
        let [u, v] = texture.of_triangle(triangle_of(corner) as usize)?[(corner % 3) as usize];
        sum = [sum[0] + share * u, sum[1] + share * v];
    }
    points.push(sum);
    Some(points.len() as u32 - 1)
}

/// Keeps the items that are marked, in their order.
fn retain_marked<T>(items: &mut Vec<T>, is_kept: &[bool]) {
    let mut marks = is_kept.iter();
    items.retain(|_| marks.next() == Some(&true));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn soup() -> Soup {
        Soup {
            positions: [[f64::NAN; 3], [0.0; 3], [1.0, 0.0, 0.0], [9.0; 3], [0.0, 1.0, 0.0]]
                .map(DVec3::from_array)
                .to_vec(),
            triangles: vec![[1, 2, 4], [2, 1, 4]],
            face_count: 2,
            face_colors: vec![Some(Color::Index(5)), Some(Color::Index(6))],
            vertex_colors: [0, 1, 2, 3, 4].map(|i| Some(Color::Index(i))).to_vec(),
            ..Soup::default()
        }
    }

    #[test]
    fn unused_vertices_are_dropped_and_counted_and_the_others_keep_their_order() {
        let (draft, changes) = Draft::from_soup(&soup());
        assert_eq!(changes.count("unused_vertices_dropped"), 2);
        assert_eq!(draft.vertex_origin, [1, 2, 4]);
        assert_eq!(draft.triangles, [[0, 1, 2], [1, 0, 2]]);
        assert!(draft.check().is_empty());
    }

    #[test]
    fn texture_stays_with_its_triangles_and_points_that_none_has_go() {
        let texture = Texture {
            points: vec![[0.0, 0.5], [0.1, 0.5], [0.2, 0.5], [0.3, 0.5]],
            corners: vec![[0, 1, 2], [1, 0, 3]],
        };
        let source = Soup { texture, ..soup() };
        let (mut draft, _) = Draft::from_soup(&source);
        draft.retain_triangles(&[false, true]);
        draft.triangles.push([0, 1, 2]);
        draft.triangle_origin.push(NEW);
        let written = draft.to_soup(&source).texture;
        assert_eq!(written.points, [[0.0, 0.5], [0.1, 0.5], [0.3, 0.5]]);
        assert_eq!(written.corners, [[1, 0, 2], [NO_POINT; 3]]);
        draft.retain_triangles(&[false, true]);
        assert_eq!(draft.to_soup(&source).texture, Texture::default());
    }

    #[test]
    fn colors_follow_their_triangles_and_vertices() {
        let source = soup();
        let (mut draft, _) = Draft::from_soup(&source);
        draft.retain_triangles(&[false, true]);
        draft.triangles.push([0, 1, 2]);
        draft.triangle_origin.push(NEW);
        let written = draft.to_soup(&source);
        assert_eq!(written.face_colors, [Some(Color::Index(6)), None]);
        assert_eq!(written.vertex_colors, [1, 2, 4].map(|i| Some(Color::Index(i))));
        assert!(written.check().is_empty());
    }
}
