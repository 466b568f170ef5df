//! What a caller may choose about the filling of holes.

use crate::implicit::RbfOptions;
use crate::mesh::{Soup, edge_of, triangle_of};
use crate::repair::{Draft, NEW, Selection};

/// Share of the points around a hole that have offset constraints. With fewer, the field follows the normals of a coarse mesh
/// less closely, and comes closer to what was removed (`docs/holes.md`).
const OFFSETS_SHARE: f64 = 0.2;

/// A way to make a patch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum Method {
    /// The one that measures best on holes of the same class, see `docs/holes.md`.
    #[default]
    Auto,
    /// A triangulation of the loop as seen along its mean normal. No new vertex.
    Flat,
    /// The triangulation whose triangles bend least, and of those the smallest (Liepa 2003). No new vertex.
    Minimal,
    /// The minimal one, refined to the edge length of the rim and faired so that it leaves the rim in the direction of the
    /// surface around.
    Smooth,
    /// Sharp edges that end at the rim are carried on through the hole; each side between them is flat or smooth.
    Creased,
    /// A surface through the rim and the rings around it: where a sum of radial basis functions is zero.
    Rbf,
}

/// How triangles are made of a surface that is given as the zeros of a function.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum Extract {
    /// The vertices of the smooth patch go to the surface.
    #[default]
    Project,
    /// Marching cubes around the hole, clipped and zipped to the rim.
    March,
    /// Triangles without small angles, zipped to the rim.
    Mesh,
}

/// What is chosen for one hole.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct HoleChoice {
    /// A boundary half-edge of the soup in a loop of the hole.
    pub half_edge: u32,
    /// `None`: that of the options.
    pub method: Option<Method>,
    /// Rings of vertices around the rim that the surface goes through, 0 to 8; `None`: those of the options.
    pub band_rings: Option<u32>,
}

/// Which holes are filled, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct FillOptions {
    /// The holes to fill; others stay open.
    pub holes: Selection,
    /// How those are filled that `choices` do not name.
    pub method: Method,
    /// Rings of vertices around the rim that a surface of [`Method::Rbf`] goes through, 0 to 8.
    pub band_rings: u32,
    /// How such a surface is fitted.
    pub rbf: RbfOptions,
    /// How triangles are made of such a surface.
    pub extract: Extract,
    /// Single holes, ascending by half-edge. Of several for one hole the first holds.
    pub choices: Vec<HoleChoice>,
    /// A hole whose method gives no sound patch is offered those of the plainer methods.
    pub falls_back: bool,
    /// Loops that face each other across a gap or lie in each other without being flat get one patch between them.
    pub bridges: bool,
    /// [`Method::Auto`] may make new vertices also where no choice asks for it.
    pub refines: bool,
}

impl Default for FillOptions {
    fn default() -> Self {
        Self {
            holes: Selection::default(),
            method: Method::Auto,
            band_rings: 2,
            rbf: RbfOptions { share: OFFSETS_SHARE, ..RbfOptions::default() },
            extract: Extract::Project,
            choices: Vec::new(),
            falls_back: true,
            bridges: true,
            refines: true,
        }
    }
}

impl FillOptions {
    /// Those with which a repair fills: no new vertices, and no patch between loops that only face each other.
    pub fn plain(holes: Selection) -> Self {
        Self { holes, bridges: false, refines: false, ..Self::default() }
    }

    /// True when a hole may get a method that looks at the mesh around it, not at its rim alone.
    pub(super) fn looks_around(&self) -> bool {
        if self.choices.iter().any(|choice| choice.band_rings.is_some()) {
            return true;
        }
        let chosen = self.choices.iter().filter_map(|choice| choice.method);
        let own = (self.method != Method::Auto || self.refines).then_some(self.method);
        chosen.chain(own).any(|method| !matches!(method, Method::Flat | Method::Minimal))
    }

    /// What is chosen for the hole with these half-edges of `draft`, which was made of `soup`.
    pub(super) fn choice(&self, half_edges: &[u32], draft: &Draft, soup: &Soup) -> Option<HoleChoice> {
        let of_edge = |&h: &u32| {
            let origin = draft.triangle_origin[triangle_of(h) as usize];
            let start = self.choices.partition_point(|choice| triangle_of(choice.half_edge) < origin);
            let of_triangle = self.choices[start..].iter();
            let mut of_triangle = of_triangle.take_while(|choice| triangle_of(choice.half_edge) == origin);
            of_triangle.find(|choice| Selection::Only(vec![choice.half_edge]).takes(&[h], draft, soup))
        };
        half_edges.iter().find_map(of_edge).copied()
    }
}

/// The half-edge of the soup behind half-edge `h` of the draft: that of the same triangle between the same places.
pub(super) fn soup_half_edge(h: u32, draft: &Draft, soup: &Soup) -> Option<u32> {
    let origin = draft.triangle_origin[triangle_of(h) as usize];
    if origin == NEW {
        return None;
    }
    let place = |v: u32| soup.positions.get(v as usize);
    let [a, b] = edge_of(&draft.triangles, h).map(|v| place(draft.vertex_origin[v as usize]));
    let is_same = |&g: &u32| {
        let [c, d] = edge_of(&soup.triangles, g).map(place);
        (a == c && b == d) || (a == d && b == c)
    };
    ((origin as usize) < soup.triangles.len()).then(|| (3 * origin..3 * origin + 3).find(is_same))?
}
