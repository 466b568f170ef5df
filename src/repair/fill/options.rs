//! What a caller may choose about the filling of holes.

use crate::repair::Selection;

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
    /// How triangles are made of such a surface.
    pub extract: Extract,
    /// Single holes, ascending by half-edge. Of several for one hole the first holds.
    pub choices: Vec<HoleChoice>,
    /// A hole whose method gives no sound patch is offered those of the plainer methods.
    pub falls_back: bool,
    /// Loops that face each other across a gap or lie in each other without being flat get one patch between them.
    pub bridges: bool,
}

impl Default for FillOptions {
    fn default() -> Self {
        Self {
            holes: Selection::default(),
            method: Method::Auto,
            band_rings: 2,
            extract: Extract::Project,
            choices: Vec::new(),
            falls_back: true,
            bridges: true,
        }
    }
}

impl FillOptions {
    /// Those with which a repair fills: no new vertices, and no patch between loops that are not in one plane.
    pub fn plain(holes: Selection) -> Self {
        Self { holes, method: Method::Minimal, bridges: false, ..Self::default() }
    }
}
