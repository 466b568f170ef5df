//! The mesh that repair steps work on: a plain triangle list that remembers where everything came from.

mod behind;
mod divide;
mod faces;
mod seams;
mod texture;
mod turn;

pub(in crate::repair) use divide::VertexBeside;
pub use faces::Faced;

use super::Changes;
use crate::budget::CHECK_EVERY;
use crate::geom::{DVec3, triangle_area};
use crate::mesh::{Color, PolygonRuns, Soup, triangle_of};
use crate::par;

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

    /// The area of every triangle.
    pub fn areas(&self) -> Vec<f64> {
        let of = |range: std::ops::Range<usize>| -> Vec<f64> {
            range.map(|t| triangle_area(self.corners(t))).collect()
        };
        par::map_ranges(self.triangles.len(), CHECK_EVERY, of).concat()
    }

    /// Keeps the triangles that are marked.
    pub fn retain_triangles(&mut self, is_kept: &[bool]) {
        retain_marked(&mut self.triangles, is_kept);
        retain_marked(&mut self.triangle_origin, is_kept);
        if !self.polygons.is_empty() {
            self.polygons.retain(is_kept);
        }
    }

    /// Makes room for just so many more vertices: a few more than there is room for would double the room.
    pub(in crate::repair) fn reserve_vertices(&mut self, count: usize) {
        self.positions.reserve_exact(count);
        self.vertex_origin.reserve_exact(count);
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
    /// colours, the texture coordinates, the materials and the objects. New faces have those of the nearest that are not.
    pub fn to_soup(&self, source: &Soup) -> Soup {
        let has_faces = !source.face_colors.is_empty() || !source.materials.is_empty();
        let behind =
            if has_faces || !source.objects.is_empty() { self.triangles_behind() } else { Vec::new() };
        let face_behind = |&t: &u32| (t != NEW).then(|| source.face_of(t));
        let color_of_face = |t: &u32| source.face_colors[face_behind(t)? as usize];
        let vertex_colors: Vec<Option<Color>> = match source.vertex_colors.is_empty() {
            true => Vec::new(),
            false => self.vertex_origin.iter().map(|&v| self.color(v, source)).collect(),
        };
        let at_seams = self.colors_at_seams(&vertex_colors, source);
        Soup {
            positions: self.positions.clone(),
            triangles: self.triangles.clone(),
            face_count: self.triangles.len() as u32,
            is_f32_exact: self.positions.iter().all(|p| p.as_vec3().as_dvec3() == *p),
            vertex_colors,
            face_colors: match source.face_colors.is_empty() {
                true => Vec::new(),
                false => behind.iter().map(color_of_face).collect(),
            },
            texture: self.texture(&source.texture, source),
            materials: source.materials.on(behind.iter().map(face_behind)),
            objects: source.objects.on(behind.iter().map(face_behind)),
            left_out: if at_seams > 0 { vec![("colors_at_seams", at_seams)] } else { Vec::new() },
            ..Soup::default()
        }
    }

    /// Number of vertices of `source` that became one with another at their place and lost their colour, which was another.
    fn colors_at_seams(&self, colors: &[Option<Color>], source: &Soup) -> u64 {
        if colors.is_empty() {
            return 0;
        }
        let mut is_lost = vec![false; source.positions.len()];
        let place = |v: u32| source.positions.get(v as usize);
        for (corners, &origin) in self.triangles.iter().zip(&self.triangle_origin) {
            let Some(was) = source.triangles.get(origin as usize) else { continue };
            for &v in corners {
                let vertex = self.vertex_origin[v as usize];
                if vertex < FIRST_BLEND
                    && !was.contains(&vertex)
                    && let Some(&copy) = was.iter().find(|&&w| place(w) == place(vertex))
                {
                    is_lost[copy as usize] |= source.vertex_colors[copy as usize] != colors[v as usize];
                }
            }
        }
        is_lost.into_iter().filter(|&is_lost| is_lost).count() as u64
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
    fn colors_follow_their_triangles_and_vertices() {
        let source = soup();
        let (mut draft, _) = Draft::from_soup(&source);
        draft.retain_triangles(&[false, true]);
        draft.triangles.push([0, 1, 2]);
        draft.triangle_origin.push(NEW);
        draft.triangles.push([2, 1, 0]);
        draft.triangle_origin.push(0);
        let written = draft.to_soup(&source);
        assert_eq!(written.face_colors, [6, 5, 5].map(|i| Some(Color::Index(i))));
        assert_eq!(written.vertex_colors, [1, 2, 4].map(|i| Some(Color::Index(i))));
        assert!(written.check().is_empty() && written.left_out.is_empty());
    }

    #[test]
    fn colors_of_vertices_that_others_at_their_place_replace_are_counted() {
        let colors = [0, 1, 2, 2, 1, 4].map(|i| Some(Color::Index(i))).to_vec();
        let source = Soup {
            positions: [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]
                .map(|[x, y]| DVec3::new(x, y, 0.0))
                .to_vec(),
            triangles: vec![[2, 0, 1], [3, 5, 4]],
            face_count: 2,
            vertex_colors: colors.clone(),
            ..Soup::default()
        };
        let (mut draft, _) = Draft::from_soup(&source);
        let apart = draft.to_soup(&source);
        assert_eq!((apart.vertex_colors, apart.left_out), (colors, vec![]));
        crate::repair::weld::weld(&mut draft, &crate::budget::Budget::unlimited()).unwrap();
        assert_eq!(draft.to_soup(&source).left_out, [("colors_at_seams", 1)]);
    }
}
