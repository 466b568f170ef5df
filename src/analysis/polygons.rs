//! Polygons that programs split differently: their corners are not in one plane, or they are not convex.

use super::best_plane::BestPlane;
use super::{Context, DefectCode, Finding};
use crate::budget::{CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::mesh::Soup;
use crate::par;

/// How far a corner may be from the polygon's plane, or behind the line between its neighbours, as a share of the
/// polygon's largest coordinate: what rounding to float32 or to six decimal digits explains.
const ROUNDING: f64 = 1.0 / (1 << 20) as f64;

/// Polygons that a thread handles at a time.
const CHUNK: usize = CHECK_EVERY / 4;

/// A polygon that is not plain: an index into the soup's list of polygons, the corner that shows it best, and by how
/// much, in the unit of the file.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Odd {
    polygon: u32,
    corner: u32,
    amount: f64,
}

pub(super) fn find(cx: &Context<'_>) -> Result<Vec<Finding>, Stopped> {
    let soup = cx.mesh.soup;
    let parts = par::try_map_ranges(soup.polygons.faces.len(), CHUNK, |range| {
        let (mut bent, mut dented) = (Vec::new(), Vec::new());
        for i in range {
            cx.budget.check()?;
            let polygon = Polygon::of(soup, i);
            bent.extend(polygon.largest(|c| polygon.height(c)));
            dented.extend(polygon.largest(|c| polygon.dent(c)).or_else(|| polygon.is_split_otherwise()));
        }
        Ok((bent, dented))
    })?;
    let (bent, dented): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
    let finding = |code, odd: &[Odd], figure| {
        Finding::of(code, odd, cx.samples, |odd| {
            let corners = corners_of(soup, odd.polygon as usize);
            let face = soup.polygons.faces[odd.polygon as usize];
            let position = soup.positions[odd.corner as usize];
            let mut witness = cx.mesh.names().witness([face], [odd.corner], position);
            witness.figures = vec![("corners", corners.len() as f64), (figure, odd.amount)];
            witness
        })
    };
    Ok([
        finding(DefectCode::NonPlanarPolygon, &bent.concat(), "distance_from_plane"),
        finding(DefectCode::ConcavePolygon, &dented.concat(), "dent"),
    ]
    .concat())
}

/// The corners of polygon `i`, as vertices of the file.
fn corners_of(soup: &Soup, i: usize) -> &[u32] {
    soup.polygons.corners_of(i)
}

/// A polygon of the file with its plane.
struct Polygon<'s> {
    soup: &'s Soup,
    index: usize,
    corners: &'s [u32],
    /// Largest coordinate, in the unit of the file.
    size: f64,
    /// A point of the plane, in shares of the size.
    centre: DVec3,
    /// Unit normal, on the side from which most of the polygon turns counter-clockwise.
    normal: DVec3,
}

impl<'s> Polygon<'s> {
    fn of(soup: &'s Soup, index: usize) -> Self {
        let corners = corners_of(soup, index);
        let coordinates = corners.iter().map(|&v| soup.positions[v as usize].abs().max_element());
        let size = coordinates.fold(f64::MIN_POSITIVE, f64::max);
        let mut polygon = Self { soup, index, corners, size, centre: DVec3::ZERO, normal: DVec3::ZERO };
        let n = corners.len();
        polygon.centre = (0..n).map(|c| polygon.at(c)).sum::<DVec3>() / n as f64;
        // Newell's normal: the sum of the corners' cross products, twice the area.
        let arm = |c: usize| polygon.at(c) - polygon.centre;
        let area: DVec3 = (0..n).map(|c| arm(c).cross(arm((c + 1) % n))).sum();
        polygon.normal = match area.try_normalize() {
            Some(normal) => normal,
            None => BestPlane::of((0..n).map(|c| polygon.at(c))).normal,
        };
        polygon
    }

    /// Position of corner `c` in shares of the size.
    fn at(&self, c: usize) -> DVec3 {
        self.soup.positions[self.corners[c] as usize] / self.size
    }

    /// Distance of corner `c` from the plane.
    fn height(&self, c: usize) -> f64 {
        (self.at(c) - self.centre).dot(self.normal).abs()
    }

    /// How far corner `c` is pushed in behind the line between its neighbours; negative when it stands out.
    fn dent(&self, c: usize) -> f64 {
        let n = self.corners.len();
        let [before, at, after] = [self.at((c + n - 1) % n), self.at(c), self.at((c + 1) % n)];
        let turn = (at - before).cross(after - at).dot(self.normal);
        let chord = before.distance(after);
        if chord > 0.0 { -turn / chord } else { 0.0 }
    }

    /// The corner for which `share` is largest, if that is more than rounding explains.
    fn largest(&self, share: impl Fn(usize) -> f64) -> Option<Odd> {
        let shares = (0..self.corners.len()).map(|c| (c, share(c)));
        let (c, most) = shares.fold((0, 0.0), |most, one| if one.1 > most.1 { one } else { most });
        (most > ROUNDING).then(|| self.odd(c, most * self.size))
    }

    /// The polygon as odd where its reader could not split it as a fan, though no corner is pushed in: corners on one
    /// line with the first, or edges that cross.
    fn is_split_otherwise(&self) -> Option<Odd> {
        let is_fan = self.soup.polygons.not_fans.binary_search(&(self.index as u32)).is_err();
        (!is_fan).then(|| self.odd(0, 0.0))
    }

    fn odd(&self, c: usize, amount: f64) -> Odd {
        Odd { polygon: self.index as u32, corner: self.corners[c], amount }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::tests::{found, polygon};

    const BENT: DefectCode = DefectCode::NonPlanarPolygon;
    const DENTED: DefectCode = DefectCode::ConcavePolygon;

    fn quad(last: DVec3) -> Soup {
        polygon(&[DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), last])
    }

    #[test]
    fn a_square_is_plain_at_any_scale() {
        for scale in [1e-300, 1.0, 1e300] {
            let mut square = quad(DVec3::Y);
            square.positions.iter_mut().for_each(|p| *p *= scale);
            assert_eq!(found(&square, BENT), None);
            assert_eq!(found(&square, DENTED), None);
        }
    }

    #[test]
    fn a_corner_above_the_plane_of_the_others_is_told_with_its_height() {
        let finding = found(&quad(DVec3::new(0.0, 1.0, 0.4)), BENT).unwrap();
        let height = finding.witnesses[0].figures[1].1;
        assert!((height - 0.1).abs() < 0.01, "each of four corners has its share: {height}");
        assert_eq!(found(&quad(DVec3::new(0.0, 1.0, 1e-7)), BENT), None);
    }

    #[test]
    fn a_corner_pushed_in_is_told_with_its_depth() {
        let dart = quad(DVec3::new(0.75, 0.25, 0.0));
        let finding = found(&dart, DENTED).unwrap();
        assert_eq!(finding.witnesses[0].vertices[0].index, 3);
        assert!((finding.witnesses[0].figures[1].1 - 0.125f64.sqrt()).abs() < 1e-12);
        assert_eq!(found(&dart, BENT), None);
    }

    #[test]
    fn a_polygon_that_its_reader_could_not_split_as_a_fan_is_told() {
        let mut square = quad(DVec3::Y);
        square.polygons.not_fans = vec![0];
        assert_eq!(found(&square, DENTED).unwrap().count, 1);
    }
}
