//! How a mesh is drawn.

use crate::{pipeline, render};

words! {
    /// From which sides a mesh is drawn; z is up, and the front is the side of small y.
    Views {
        /// From the front, the right and above.
        Iso = "iso",
        /// From small y.
        Front = "front",
        /// From large y.
        Back = "back",
        /// From small x.
        Left = "left",
        /// From large x.
        Right = "right",
        /// From above.
        Top = "top",
        /// From below.
        Bottom = "bottom",
        /// Iso, front, right and top.
        Four = "four",
        /// All seven.
        All = "all",
    }
}

impl Views {
    /// The views by themselves.
    pub fn to_engine(self) -> Vec<render::View> {
        use render::View;
        vec![match self {
            Self::Iso => View::Iso,
            Self::Front => View::Front,
            Self::Back => View::Back,
            Self::Left => View::Left,
            Self::Right => View::Right,
            Self::Top => View::Top,
            Self::Bottom => View::Bottom,
            Self::Four => return vec![View::Iso, View::Front, View::Right, View::Top],
            Self::All => return View::ALL.to_vec(),
        }]
    }
}

mirror! { render::Shade =>
    /// How faces are shaded.
    Shade {
        /// Each in one colour.
        Flat = "flat",
        /// Rounded where neighbours meet at less than 40 degrees.
        Smooth = "smooth",
    }
}

mirror! { render::DrawnEdges =>
    /// Which edges are drawn.
    DrawnEdges {
        /// None.
        None = "none",
        /// Outlines, and edges at which the surface turns by more than 40 degrees.
        Creases = "creases",
        /// All edges of triangles.
        All = "all",
    }
}

mirror! { render::Projection =>
    /// How depth changes what is seen.
    Projection {
        /// Not at all: parallel lines stay parallel.
        Orthographic = "orthographic",
        /// What is farther is smaller.
        Perspective = "perspective",
    }
}

mirror! { pipeline::PictureFormat =>
    /// What kind of file a picture is.
    PictureFormat {
        /// Pixels.
        Png = "png",
        /// A mesh whose colours and marks show the same, which viewers turn.
        Glb = "glb",
    }
}
