//! The memoryless criterion: Lindstrom and Turk, "Fast and memory efficient polygonal simplification" (1998).
//!
//! Nothing is kept: each cost is made of the triangles around the edge as they are now. The merged vertex keeps the
//! enclosed volume exactly (one linear condition), and of the places that do so it takes the one with the least sum of
//! squared volumes of the tetrahedra that it spans with the triangles, which is a quadric weighted with squared areas.
//! At borders the paper's two area terms are replaced by the squared distance from the lines of the border edges,
//! weighted with their fourth power of length: it keeps straight borders as they are, and does not keep the area under
//! curved ones exactly. Where the paper's last tie-break, the triangles' shape, would decide, the place nearest to the
//! middle of the edge is taken.

use super::criterion::{CollapseCriterion, CostReach, PlacedVertex, cheaper};
use super::options::Placement;
use super::quadric::Quadric;
use super::surface::{CollapseSurface, MergeRule, Vertex};
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::mesh::corner_table::{NONE, next, prev, triangle_of};

/// Below this share of the summed areas the triangles around an edge have no common normal, and keeping the volume
/// fixes no direction: two degrees, twice the paper's limit for compatible conditions.
const NO_NORMAL: f64 = 0.035;
/// As in the quadric criterion: where all is flat, short edges first.
const LENGTH_SHARE: f64 = 1e-7;

/// Costs by changes of volume.
#[derive(Debug, Clone, Copy)]
pub(super) struct Memoryless;

/// Sums over the triangles around an edge, about its destination.
struct EdgeSums {
    quadric: Quadric,
    /// Sum of the normals, each twice as long as its triangle's area.
    normal: DVec3,
    /// Sum of the products of the normals with their triangles' corners.
    volume: f64,
    /// Sum of the normals' lengths.
    area: f64,
    has_border: bool,
}

impl CollapseCriterion for Memoryless {
    type State = ();

    const REACH: CostReach = CostReach::Neighbours;

    fn prepare(&self, _: &mut CollapseSurface<()>, _: &Budget) -> Result<(), Stopped> {
        Ok(())
    }

    fn place(
        &self,
        surface: &CollapseSurface<()>,
        h: u32,
        rule: MergeRule,
        placement: Placement,
    ) -> PlacedVertex {
        let [a, b] = surface.ends(h).map(|end| end.position);
        let around = EdgeSums::edge(surface, h, b);
        let to_a = a - b;
        let weight = around.quadric.weight();
        let placed = |offset: DVec3| {
            let value = around.quadric.value(offset);
            PlacedVertex {
                position: b + offset,
                cost: value + LENGTH_SHARE * weight * to_a.length_squared(),
                error_squared: if weight > 0.0 { value / weight } else { 0.0 },
            }
        };
        let onto_a = || PlacedVertex { position: a, ..placed(to_a) };
        let onto_b = || placed(DVec3::ZERO);
        match (rule, placement) {
            (MergeRule::OntoOrigin, _) => onto_a(),
            (MergeRule::OntoDestination, _) => onto_b(),
            (MergeRule::Anywhere, Placement::OntoEnd) => cheaper(onto_a(), onto_b()),
            (MergeRule::Anywhere, Placement::Optimal) => placed(around.best(0.5 * to_a)),
        }
    }

    fn merged(&self, _: [&Vertex<()>; 2], _: DVec3) {}
}

impl EdgeSums {
    const NOTHING: Self =
        Self { quadric: Quadric::ZERO, normal: DVec3::ZERO, volume: 0.0, area: 0.0, has_border: false };

    fn edge(surface: &CollapseSurface<()>, h: u32, about: DVec3) -> Self {
        Self::inside(surface, h, about).unwrap_or_else(|| Self::at_border(surface, h, about))
    }

    /// The sums for an edge whose ends are not on a border; nothing for another one. Each vertex around is read once.
    fn inside(surface: &CollapseSurface<()>, h: u32, about: DVec3) -> Option<Self> {
        let table = &surface.table;
        let twin = table.twin(h);
        let mut sums = Self::NOTHING;
        // All triangles of the destination, which is where the sums are about.
        let mut corner = next(h);
        let mut p = surface.position(table.destination(corner)) - about;
        loop {
            let r = surface.position(table.origin(prev(corner))) - about;
            sums.add_normal_through_zero(p.cross(r));
            p = r;
            corner = table.twin(prev(corner));
            if corner == NONE {
                return None;
            }
            if corner == next(h) {
                break;
            }
        }
        // Those of the origin but the two of the edge: the twin is there, or the loop had ended.
        let a = surface.position(table.origin(h)) - about;
        let mut p = surface.position(table.origin(prev(h))) - about;
        corner = table.twin(prev(h));
        while corner != next(twin) {
            if corner == NONE {
                return None;
            }
            let r = surface.position(table.origin(prev(corner))) - about;
            sums.add_normal((p - a).cross(r - a), a);
            p = r;
            corner = table.twin(prev(corner));
        }
        Some(sums)
    }

    fn at_border(surface: &CollapseSurface<()>, h: u32, about: DVec3) -> Self {
        let mut sums = Self::NOTHING;
        let twin = surface.table.twin(h);
        for corner in surface.table.fan(h) {
            sums.add_triangle(surface, corner, about);
            sums.add_borders(surface, corner, about);
        }
        for corner in surface.table.fan(next(h)) {
            let is_counted = triangle_of(corner) == triangle_of(h)
                || (twin != NONE && triangle_of(corner) == triangle_of(twin));
            if !is_counted {
                sums.add_triangle(surface, corner, about);
            }
            sums.add_borders(surface, corner, about);
        }
        sums
    }

    fn add_triangle(&mut self, surface: &CollapseSurface<()>, corner: u32, about: DVec3) {
        let [p, q, r] = surface.corners(corner).map(|p| p - about);
        self.add_normal((q - p).cross(r - p), p);
    }

    /// Adds the triangle through `p` with a normal that is twice as long as its area.
    #[inline]
    fn add_normal(&mut self, normal: DVec3, p: DVec3) {
        let height = normal.dot(p);
        self.normal += normal;
        self.area += normal.length();
        self.volume += height;
        self.quadric += Quadric::of_normal(normal, height);
    }

    /// Adds a triangle that has a corner where the sums are about.
    #[inline]
    fn add_normal_through_zero(&mut self, normal: DVec3) {
        self.normal += normal;
        self.area += normal.length();
        self.quadric += Quadric::of_normal(normal, 0.0);
    }

    /// The border edges at the origin of `corner`, held by two planes each.
    fn add_borders(&mut self, surface: &CollapseSurface<()>, corner: u32, about: DVec3) {
        for h in [corner, prev(corner)] {
            if surface.table.twin(h) == NONE {
                let [p, q, r] = surface.corners(h).map(|p| p - about);
                let normal = (q - p).cross(r - p);
                let weight = p.distance_squared(q);
                let wall = Quadric::of_wall(p, q, normal, weight);
                let floor = Quadric::of_wall(p, q, (q - p).cross(normal), weight);
                self.quadric += (wall + floor).about(-p);
                self.has_border = true;
            }
        }
    }

    /// The best place, sought from `start`.
    fn best(&self, start: DVec3) -> DVec3 {
        let length = self.normal.length();
        if self.has_border || length.is_nan() || length <= NO_NORMAL * self.area {
            return self.quadric.minimum(start).position;
        }
        let normal = self.normal / length;
        let on_plane = start - normal * (normal.dot(start) - self.volume / length);
        self.quadric.minimum_on_plane(normal, on_plane)
    }
}
