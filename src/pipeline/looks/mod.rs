//! What new triangles take over of the file: the colours, texture coordinates, materials and objects of the nearest places.

mod charts;

use self::charts::Charts;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{DVec3, shares_of_corners};
use crate::mesh::{Color, Materials, NO_MATERIAL, NO_OBJECT, NO_POINT, Objects, Soup};
use crate::par;
use crate::repair::{Draft, NEW};
use crate::spatial::{Nearest, NearestSearch};
use rustc_hash::FxHashMap;

/// A mesh whose colours, texture, materials and objects are looked up by place.
pub(super) struct AppearanceSource<'s> {
    soup: &'s Soup,
    search: NearestSearch<'s>,
    charts: Charts<'s>,
}

impl<'s> AppearanceSource<'s> {
    /// `None` where `soup` has no colours, no texture, no materials and no objects.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub(super) fn of(soup: &'s Soup, budget: &Budget) -> Result<Option<Self>, Stopped> {
        let has_colors = !soup.vertex_colors.is_empty() || !soup.face_colors.is_empty();
        let has_names = !soup.materials.is_empty() || !soup.objects.is_empty();
        if !has_colors && !has_names && soup.texture.is_empty() {
            return Ok(None);
        }
        let search = NearestSearch::build(&soup.positions, &soup.triangles, budget)?;
        Ok(Some(Self { soup, search, charts: Charts::of(soup, budget)? }))
    }

    /// Gives the last `vertices` vertices and `triangles` triangles of `made`, which are its last faces, what is nearest to
    /// them: vertices the colour between those of the corners there, triangles what the face nearest to their middle has.
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
        let first = made.triangles.len() - triangles;
        let new: Vec<u32> = (first as u32..made.triangles.len() as u32).collect();
        self.put_texture(made, &new, budget)?;
        if source.face_colors.is_empty() && source.materials.is_empty() && source.objects.is_empty() {
            return Ok(());
        }
        let middle = |i: usize| made.corners((first + i) as u32).iter().sum::<DVec3>() / 3.0;
        let faces = self.nearest(triangles, middle, |at| source.face_of(at.triangle), budget)?;
        self.put_faces(made, first, faces.into_iter());
        Ok(())
    }

    /// Gives the faces of `made` from `first` on the colour, the material and the object of `faces` of the source.
    fn put_faces(&self, made: &mut Soup, first: usize, faces: impl Iterator<Item = Option<u32>> + Clone) {
        let source = self.soup;
        if !source.face_colors.is_empty() {
            made.face_colors.resize(first, None);
            made.face_colors.extend(faces.clone().map(|f| source.face_colors[f? as usize]));
        }
        if !source.materials.is_empty() {
            let mut of_face = std::mem::take(&mut made.materials.of_face);
            of_face.resize(first, NO_MATERIAL);
            of_face
                .extend(faces.clone().map(|f| f.and_then(|f| source.materials.of(f)).unwrap_or(NO_MATERIAL)));
            if of_face.iter().any(|&material| material != NO_MATERIAL) {
                made.materials = Materials { of_face, ..source.materials.clone() };
            }
        }
        if !source.objects.is_empty() {
            let mut of_face = std::mem::take(&mut made.objects.of_face);
            of_face.resize(first, NO_OBJECT);
            of_face.extend(faces.map(|f| f.and_then(|f| source.objects.of(f)).unwrap_or(NO_OBJECT)));
            if of_face.iter().any(|&object| object != NO_OBJECT) {
                made.objects = Objects { of_face, names: source.objects.names.clone() };
            }
        }
    }

    /// Gives each of the `triangles` of `made` the texture coordinates of the chart nearest to its middle, if it has some; gives
    /// for each the triangle there.
    fn put_texture(
        &self,
        made: &mut Soup,
        triangles: &[u32],
        budget: &Budget,
    ) -> Result<Vec<Option<u32>>, Stopped> {
        if self.soup.texture.is_empty() {
            return Ok(Vec::new());
        }
        /// What is found, its points, and their table.
        const PER_TRIANGLE: u64 = 192;
        let _charge = budget.charge(PER_TRIANGLE * triangles.len() as u64)?;
        let found = par::try_map_ranges(triangles.len(), CHECK_EVERY, |range| {
            triangles[range]
                .iter()
                .map(|&t| self.charts.points(made.corners(t), &self.search, budget))
                .collect::<Result<Vec<_>, _>>()
        })?;
        let texture = &mut made.texture;
        texture.corners.resize(made.triangles.len(), [NO_POINT; 3]);
        let mut numbers = FxHashMap::default();
        let mut number = |point: [f64; 2]| {
            *numbers.entry(point.map(f64::to_bits)).or_insert_with(|| {
                texture.points.push(point);
                texture.points.len() as u32 - 1
            })
        };
        let mut behind = Vec::with_capacity(triangles.len());
        for (found, &t) in found.into_iter().flatten().zip(triangles) {
            behind.push(found.as_ref().map(|found| found.triangle));
            if let Some(found) = found {
                texture.corners[t as usize] = found.points.map(&mut number);
            }
        }
        if texture.points.is_empty() {
            texture.corners.clear();
        }
        Ok(behind)
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
        let shares = shares_of_corners(at.point, self.search.corners(at.triangle)).unwrap_or([1.0, 0.0, 0.0]);
        let colors: Vec<_> =
            corners.iter().map(|&v| self.soup.vertex_colors[v as usize]).zip(shares).collect();
        // A corner without a share needs no colour.
        Color::blend(&colors.into_iter().filter(|&(_, share)| share > 0.0).collect::<Vec<_>>())
    }
}

/// The soup of a `draft` that was made of `source`: new triangles that are of no patch between rims, and those of a patch that
/// a seam runs into, have the texture, the colour and the material of the nearest faces.
///
/// # Errors
/// When the budget stops the run.
pub(super) fn soup_of(draft: &Draft, source: &Soup, budget: &Budget) -> Result<Soup, Stopped> {
    let mut made = draft.to_soup(source);
    if source.texture.is_empty() {
        return Ok(made);
    }
    let is_bare =
        |&t: &u32| draft.triangle_origin[t as usize] == NEW && made.texture.of_triangle(t as usize).is_none();
    let bare: Vec<u32> = (0..made.triangles.len() as u32).filter(is_bare).collect();
    if bare.is_empty() {
        return Ok(made);
    }
    let Some(looks) = AppearanceSource::of(source, budget)? else { return Ok(made) };
    let behind = looks.put_texture(&mut made, &bare, budget)?;
    for (&t, behind) in bare.iter().zip(behind) {
        let Some(face) = behind.map(|behind| source.face_of(behind)) else { continue };
        if let Some(color) = made.face_colors.get_mut(t as usize) {
            *color = source.face_colors[face as usize];
        }
        if let Some(material) = made.materials.of_face.get_mut(t as usize) {
            *material = source.materials.of_face[face as usize];
        }
    }
    Ok(made)
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
        AppearanceSource::of(&source, &budget).unwrap().unwrap().put_on(&mut made, 4, 2, &budget).unwrap();
        assert_eq!(made.check(), Vec::<String>::new());
        assert_eq!(made.vertex_colors, [gray(50), gray(75), gray(200), None]);
        assert_eq!(made.face_colors, [gray(7), None]);
        assert_eq!(made.materials.of_face, [NO_MATERIAL, 0]);
        assert!(AppearanceSource::of(&Soup::default(), &budget).unwrap().is_none());
    }
}
