//! The charts of a texture: parts of a surface over which texture coordinates run without a seam.

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{DVec3, shares_of_corners};
use crate::mesh::{Soup, UnionFind};
use crate::spatial::{Nearest, NearestSearch, coincident_f64};

/// In the place of the number of a chart: the triangle has no texture coordinates.
const NO_CHART: u32 = u32::MAX;

/// Texture coordinates that are farther apart than those of their triangles let expect, by this factor, have a seam between them:
/// a chart that is closed around a body meets itself.
const STRETCH_MAX: f64 = 4.0;

/// So many triangles at one edge are compared with each: surfaces that lie on each other have some there.
const SHEETS_MAX: usize = 8;

/// How often the way from the middle of a triangle to a corner behind a seam is halved.
const HALVINGS: usize = 6;

/// A corner is first looked for so far towards the middle, as a share of the way: a corner on a seam has both sides at its place.
const INWARD: f64 = 1.0 / 64.0;

/// The texture of a surface, which is looked up by place.
pub(super) struct Charts<'s> {
    soup: &'s Soup,
    /// For each triangle the smallest triangle of its chart, or [`NO_CHART`].
    of_triangle: Vec<u32>,
}

/// Where a new triangle is in a chart.
pub(super) struct OnChart {
    /// The triangle that is nearest to its middle.
    pub(super) triangle: u32,
    /// The texture coordinates at its corners.
    pub(super) points: [[f64; 2]; 3],
}

/// A place of a chart.
#[derive(Clone, Copy)]
struct ChartPlace {
    chart: u32,
    triangle: u32,
    place: DVec3,
    point: [f64; 2],
}

impl<'s> Charts<'s> {
    /// Triangles are of one chart where they have one material and, at an edge of both, the same coordinates.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub(super) fn of(soup: &'s Soup, budget: &Budget) -> Result<Self, Stopped> {
        let count = soup.triangles.len();
        if soup.texture.is_empty() {
            return Ok(Self { soup, of_triangle: Vec::new() });
        }
        let mut charts = UnionFind::new(count);
        let groups = coincident_f64(&soup.positions, budget)?;
        let (mut edges, _charge) = budget.vec::<([u32; 2], u32)>(3 * count)?;
        let has_points = |t: usize| soup.texture.of_triangle(t).is_some();
        for t in (0..count).filter(|&t| has_points(t)) {
            let corners = soup.triangles[t].map(|v| groups.group[v as usize]);
            edges.extend((0..3).map(|k| {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                ([a.min(b), a.max(b)], (3 * t + k) as u32)
            }));
        }
        budget.check()?;
        edges.sort_unstable();
        let end_points = |corner: u32| {
            let (t, k) = ((corner / 3) as usize, (corner % 3) as usize);
            let corners = soup.triangles[t].map(|v| groups.group[v as usize]);
            let points = soup.texture.of_triangle(t).unwrap_or_default().map(|p| p.map(f64::to_bits));
            let mut ends = [(corners[k], points[k]), (corners[(k + 1) % 3], points[(k + 1) % 3])];
            ends.sort_unstable();
            (ends, soup.materials.of(soup.face_of(t as u32)))
        };
        for (i, &(edge, a)) in edges.iter().enumerate() {
            if i.is_multiple_of(CHECK_EVERY) {
                budget.check()?;
            }
            let at_edge = edges[i + 1..].iter().take(SHEETS_MAX).take_while(|(other, _)| *other == edge);
            for &(_, b) in at_edge.filter(|&&(_, b)| end_points(a) == end_points(b)) {
                charts.unite(a / 3, b / 3);
            }
        }
        let chart = |t: usize| if has_points(t) { charts.find(t as u32) } else { NO_CHART };
        Ok(Self { soup, of_triangle: (0..count).map(chart).collect() })
    }

    /// Where a new triangle is in the chart that is nearest to its middle; `None` where the surface has none there. A corner beyond
    /// a seam has the coordinates of the last place before it on the way from the middle.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub(super) fn points(
        &self,
        corners: [DVec3; 3],
        search: &NearestSearch<'_>,
        budget: &Budget,
    ) -> Result<Option<OnChart>, Stopped> {
        let find = |p: DVec3| Ok(search.find(p, None, budget)?.and_then(|at| self.spot(at, search)));
        let middle = corners.iter().sum::<DVec3>() / 3.0;
        let Some(start) = find(middle)? else { return Ok(None) };
        let mut points = [start.point; 3];
        for (point, corner) in points.iter_mut().zip(corners) {
            let on_this_side = |share: f64| -> Result<Option<[f64; 2]>, Stopped> {
                let spot = find(middle.lerp(corner, share))?;
                Ok(spot.filter(|spot| self.are_connected(&start, spot, search)).map(|spot| spot.point))
            };
            if let Some(at) = on_this_side(1.0)? {
                *point = at;
                continue;
            }
            let (mut good, mut bad, mut share) = (0.0, 1.0, 1.0 - INWARD);
            for _ in 0..HALVINGS {
                match on_this_side(share)? {
                    Some(at) => (*point, good) = (at, share),
                    None => bad = share,
                }
                if good + INWARD >= bad {
                    break;
                }
                share = 0.5 * (good + bad);
            }
        }
        Ok(Some(OnChart { triangle: start.triangle, points }))
    }

    fn spot(&self, at: Nearest, search: &NearestSearch<'_>) -> Option<ChartPlace> {
        let chart = *self.of_triangle.get(at.triangle as usize)?;
        let points = self.soup.texture.of_triangle(at.triangle as usize)?;
        let shares = shares_of_corners(at.point, search.corners(at.triangle)).unwrap_or([1.0, 0.0, 0.0]);
        let along = |k: usize| (0..3).map(|corner| shares[corner] * points[corner][k]).sum();
        Some(ChartPlace { chart, triangle: at.triangle, place: at.point, point: [along(0), along(1)] })
    }

    /// True when both are of one chart and no seam of it is between them.
    fn are_connected(&self, a: &ChartPlace, b: &ChartPlace, search: &NearestSearch<'_>) -> bool {
        if a.chart != b.chart || a.triangle == b.triangle {
            return a.chart == b.chart;
        }
        let stretch = self.stretch(a.triangle, search).max(self.stretch(b.triangle, search));
        let apart = distance(a.point, b.point);
        apart <= STRETCH_MAX * stretch * a.place.distance(b.place)
    }

    /// The longest side of a triangle in the picture as a multiple of its longest side.
    fn stretch(&self, triangle: u32, search: &NearestSearch<'_>) -> f64 {
        let corners = search.corners(triangle);
        let points = self.soup.texture.of_triangle(triangle as usize).unwrap_or_default();
        let longest = |length: &dyn Fn(usize, usize) -> f64| length(0, 1).max(length(1, 2)).max(length(2, 0));
        longest(&|i, j| distance(points[i], points[j])) / longest(&|i, j| corners[i].distance(corners[j]))
    }
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    libm::hypot(a[0] - b[0], a[1] - b[1])
}
