//! What a rebuilt surface takes over of the file: the colours and materials of the nearest places.

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::mesh::{Color, Materials, NO_MATERIAL, Soup};
use crate::par;
use crate::spatial::{Nearest, NearestSearch};

/// A mesh whose colours and materials are looked up by place.
pub(super) struct Source<'s> {
    soup: &'s Soup,
    search: NearestSearch<'s>,
}

impl<'s> Source<'s> {
    /// `None` where `soup` has no colours and no materials.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub(super) fn of(soup: &'s Soup, budget: &Budget) -> Result<Option<Self>, Stopped> {
        if soup.vertex_colors.is_empty() && soup.face_colors.is_empty() && soup.materials.is_empty() {
            return Ok(None);
        }
        let search = NearestSearch::build(&soup.positions, &soup.triangles, budget)?;
        Ok(Some(Self { soup, search }))
    }

    /// Gives the last `vertices` vertices and `triangles` triangles of `made` what is nearest to them: vertices the colour
    /// between those of the corners there, triangles what the face nearest to their middle has.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub(super) fn put_on(
        &self,
        made: &mut Soup,
        vertices: usize,
        triangles: usize,
        budget: &Budget,
    ) -> Result<(), Stopped> {
        let (source, first) = (self.soup, made.positions.len() - vertices);
        if !source.vertex_colors.is_empty() {
            let colors =
                self.nearest(vertices, |i| made.positions[first + i], |at| self.color_at(at), budget)?;
            made.vertex_colors.resize(first, None);
            made.vertex_colors.extend(colors.into_iter().map(Option::flatten));
        }
        if source.face_colors.is_empty() && source.materials.is_empty() {
            return Ok(());
        }
        let first = made.triangles.len() - triangles;
        let middle = |i: usize| made.corners((first + i) as u32).iter().sum::<DVec3>() / 3.0;
        let faces = self.nearest(triangles, middle, |at| source.face_of(at.triangle), budget)?;
        if !source.face_colors.is_empty() {
            made.face_colors.resize(first, None);
            let color = |f: &Option<u32>| source.face_colors[(*f)? as usize];
            made.face_colors.extend(faces.iter().map(color));
        }
        if !source.materials.is_empty() {
            let mut of_face = std::mem::take(&mut made.materials.of_face);
            of_face.resize(first, NO_MATERIAL);
            let material = |f: &Option<u32>| f.and_then(|f| source.materials.of(f)).unwrap_or(NO_MATERIAL);
            of_face.extend(faces.iter().map(material));
            if of_face.iter().any(|&material| material != NO_MATERIAL) {
                made.materials = Materials { of_face, ..source.materials.clone() };
            }
        }
        Ok(())
    }

    /// `of` the nearest place to each of `count` points.
    fn nearest<T: Send>(
        &self,
        count: usize,
        point: impl Fn(usize) -> DVec3 + Sync,
        of: impl Fn(Nearest) -> T + Sync,
        budget: &Budget,
    ) -> Result<Vec<Option<T>>, Stopped> {
        let found = par::try_map_ranges(count, CHECK_EVERY, |range| {
            range
                .map(|i| Ok(self.search.find(point(i), None, budget)?.map(&of)))
                .collect::<Result<Vec<_>, _>>()
        })?;
        Ok(found.into_iter().flatten().collect())
    }

    /// The colour in a place of the surface.
    fn color_at(&self, at: Nearest) -> Option<Color> {
        let corners = self.soup.triangles[at.triangle as usize];
        let [a, b, c] = self.search.corners(at.triangle);
        let normal = (b - a).cross(c - a);
        let part = |p: DVec3, q: DVec3| (p - at.point).cross(q - at.point).dot(normal).max(0.0);
        let parts = [part(b, c), part(c, a), part(a, b)];
        let sum: f64 = parts.iter().sum();
        let shares =
            if sum > 0.0 && sum.is_finite() { parts.map(|part| part / sum) } else { [1.0, 0.0, 0.0] };
        let colors: Vec<_> =
            corners.iter().map(|&v| self.soup.vertex_colors[v as usize]).zip(shares).collect();
        // A corner without a share needs no colour.
        Color::blend(&colors.into_iter().filter(|&(_, share)| share > 0.0).collect::<Vec<_>>())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn new_places_have_the_colours_and_materials_of_the_nearest() {
        let gray = |byte| Some(Color::Bytes([byte; 3], None));
        let source = Soup {
            positions: [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0], [9.0, 0.0]]
                .map(|[x, y]| DVec3::new(x, y, 0.0))
                .to_vec(),
            triangles: vec![[0, 1, 2], [1, 3, 2]],
            face_count: 2,
            vertex_colors: vec![gray(0), gray(100), gray(200), None],
            face_colors: vec![gray(7), None],
            materials: Materials {
                names: vec![b"oak".to_vec()],
                of_face: vec![NO_MATERIAL, 0],
                ..Materials::default()
            },
            ..Soup::default()
        };
        let budget = Budget::unlimited();
        let mut made = Soup::default();
        let points =
            [[2.0, 0.0, 1.0], [1.0, 1.0, -1.0], [0.0, 5.0, 0.0], [9.0, 0.0, 0.0]].map(DVec3::from_array);
        made.add_plain(&points, &[[0, 1, 2], [0, 3, 3]]);
        Source::of(&source, &budget).unwrap().unwrap().put_on(&mut made, 4, 2, &budget).unwrap();
        assert_eq!(made.check(), Vec::<String>::new());
        assert_eq!(made.vertex_colors, [gray(50), gray(75), gray(200), None]);
        assert_eq!(made.face_colors, [gray(7), None]);
        assert_eq!(made.materials.of_face, [NO_MATERIAL, 0]);
        assert!(Source::of(&Soup::default(), &budget).unwrap().is_none());
    }
}
