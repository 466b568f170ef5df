//! The seams of a surface under simplification: where faces have other colours, materials, texture or marks of a project.

use super::input::Input;
use super::texture::points_of;
use crate::mesh::{Color, NO_VALUE, Regions, Soup};
use crate::repair::{Draft, NEW};
use crate::simplify::NO_TEXTURE;
use rustc_hash::FxHashMap;

/// What a simplification is told of regions.
pub(super) struct Seams {
    /// A number for each triangle, the same in the same region; empty when there is one region only.
    pub(super) groups: Vec<u32>,
    /// Points at the corners of triangles, which differ across seams inside a group; empty when no triangle has some. Those of a
    /// triangle with texture are where that is.
    pub(super) points: Vec<[[f64; 2]; 3]>,
}

impl Seams {
    /// Those of `mesh`, which `draft` became; `input` says what the draft was made of.
    pub(super) fn of(mesh: &Soup, draft: &Draft, input: &Input) -> Self {
        let plain = Self { groups: Vec::new(), points: points_of(mesh) };
        match &input.regions {
            Some(regions) if !regions.is_empty() => plain.with_regions(regions, mesh, draft, &input.soup),
            _ => Self { groups: face_groups(mesh), ..plain },
        }
    }

    /// The same for the triangles of a project, which says what they are beside the mesh.
    fn with_regions(self, regions: &Regions, mesh: &Soup, draft: &Draft, source: &Soup) -> Self {
        let behind = draft.triangles_behind();
        let groups = behind.iter().map(|&t| regions.of_triangle.get(t as usize).copied().unwrap_or(NEW));
        let groups = groups.collect();
        if regions.at_corners.is_empty() {
            return Self { groups, ..self };
        }
        let first =
            regions.at_corners.iter().flatten().filter(|&&n| n != NO_VALUE).max().map_or(0, |n| n + 1);
        let of_triangle = |t: usize| {
            if let Some(points) = mesh.texture.of_triangle(t) {
                return points;
            }
            let Some(&values) = regions.at_corners.get(behind[t] as usize) else { return [NO_TEXTURE; 3] };
            if values == [NO_VALUE; 3] {
                return [NO_TEXTURE; 3];
            }
            let was = source.corners(behind[t]);
            mesh.triangles[t].map(|v| {
                let here = mesh.positions[v as usize];
                // What is at a new vertex is the same on all sides of it.
                let number = match (0..3).find(|&k| was[k] == here) {
                    Some(k) => f64::from(values[k]),
                    None => f64::from(first) + f64::from(v),
                };
                [number, 0.0]
            })
        };
        Self { groups, points: (0..mesh.triangles.len()).map(of_triangle).collect() }
    }
}

/// A number for each triangle, the same for the same colour and material of the face; empty when faces have neither.
fn face_groups(mesh: &Soup) -> Vec<u32> {
    let mut numbers = FxHashMap::default();
    let key = |color: &Option<Color>| match *color {
        None => (0, [0; 4]),
        Some(Color::Bytes([r, g, b], a)) => (1, [r, g, b, a.unwrap_or(255)].map(u32::from)),
        Some(Color::Floats([r, g, b], a)) => (2, [r, g, b, a.unwrap_or(1.0)].map(f32::to_bits)),
        Some(Color::Linear([r, g, b], a)) => (4, [r, g, b, a.unwrap_or(1.0)].map(f32::to_bits)),
        Some(Color::Index(index)) => (3, [index as u32, 0, 0, 0]),
    };
    let mut number = |f: u32| {
        let color = mesh.face_colors.get(f as usize).unwrap_or(&None);
        let next = numbers.len() as u32;
        *numbers.entry((key(color), mesh.materials.of(f))).or_insert(next)
    };
    let has_none = mesh.face_colors.is_empty() && mesh.materials.is_empty();
    (0..if has_none { 0 } else { mesh.face_count }).map(&mut number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Materials;

    #[test]
    fn faces_of_one_colour_and_material_are_one_group() {
        let (red, other) = (Some(Color::Bytes([255, 0, 0], None)), Some(Color::Index(7)));
        let mut mesh = Soup { face_colors: vec![red, other, None, red], face_count: 4, ..Soup::default() };
        assert_eq!(face_groups(&mesh), [0, 1, 2, 0]);
        let names = vec![b"wood".to_vec(), b"tin".to_vec()];
        mesh.materials = Materials { names, of_face: vec![0, 0, 0, 1], ..Materials::default() };
        assert_eq!(face_groups(&mesh), [0, 1, 2, 3]);
        mesh.face_colors = Vec::new();
        assert_eq!(face_groups(&mesh), [0, 0, 0, 1]);
        assert!(face_groups(&Soup { face_count: 4, ..Soup::default() }).is_empty());
    }

    #[test]
    fn corners_of_a_project_have_what_is_at_them_and_new_vertices_the_same_on_all_sides() {
        let positions = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
        let source = Soup {
            positions: positions.map(|[x, y]| crate::geom::DVec3::new(x, y, 0.0)).to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            face_count: 2,
            ..Soup::default()
        };
        let regions = Regions { of_triangle: vec![5, 6], at_corners: vec![[0, 1, 2], [NO_VALUE; 3]] };
        let (mut draft, _) = Draft::from_soup(&source);
        draft.positions.push(crate::geom::DVec3::new(2.0, 2.0, 0.0));
        draft.vertex_origin.push(0);
        draft.replace(0, &[[0, 1, 4], [1, 2, 4]]);
        draft.flip(0);
        let mesh = draft.to_soup(&source);
        let plain = Seams { groups: Vec::new(), points: Vec::new() };
        let seams = plain.with_regions(&regions, &mesh, &draft, &source);
        assert_eq!(seams.groups, [5, 6, 5]);
        let points = |numbers: [f64; 3]| numbers.map(|number| [number, 0.0]);
        assert_eq!(seams.points, [points([0.0, 7.0, 1.0]), [NO_TEXTURE; 3], points([1.0, 2.0, 7.0])]);
    }
}
