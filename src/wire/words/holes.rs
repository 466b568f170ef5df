//! Holes: their classes, how they are filled and what became of each.

use crate::{analysis, implicit, pipeline, repair};

mirror! { repair::fill::Method =>
    /// How a hole is filled.
    FillMethod {
        /// The method that measures best on holes of the same class.
        Auto = "auto",
        /// A triangulation of the rim as seen along its mean normal. No new vertex.
        Flat = "flat",
        /// The triangulation whose triangles bend least, and of those the smallest. No new vertex.
        Minimal = "minimal",
        /// The minimal one, refined and faired so that it goes on in the direction of the surface around.
        Smooth = "smooth",
        /// Sharp edges that end at the rim are carried on through the hole; each side between them is flat or smooth.
        Creased = "creased",
        /// A surface through the rim and the rings around it, made of radial basis functions.
        Rbf = "rbf",
    }
}

mirror! { repair::fill::Extract =>
    /// How triangles are made of a surface of radial basis functions.
    Extract {
        /// The vertices of the smooth patch go to the surface.
        Project = "project",
        /// Marching cubes around the hole, clipped and zipped to the rim.
        March = "march",
        /// Triangles without small angles, zipped to the rim.
        Mesh = "mesh",
    }
}

mirror! { implicit::Kernel =>
    /// The radial function of a surface of radial basis functions.
    Kernel {
        /// r^2 log r, the thin plate spline.
        ThinPlate = "thin-plate",
        /// r^3, which makes third derivatives small.
        Cubic = "cubic",
        /// -r, which makes second derivatives small.
        Linear = "linear",
    }
}

mirror! { implicit::LambdaFrom =>
    /// Whose bounding box the distance of the offset constraints is a share of.
    LambdaFrom {
        /// That of the rim and the rings around it.
        Hole = "hole",
        /// That of the whole mesh.
        Mesh = "mesh",
    }
}

mirror! { implicit::ConstraintValues =>
    /// The values of a field at its offset constraints.
    ConstraintValues {
        /// 1 and -1, at one distance for all points.
        Unit = "unit",
        /// The distance of each, with its sign.
        Distance = "distance",
    }
}

mirror! { repair::fill::Rejection =>
    /// Why a patch was not taken.
    Rejection {
        /// The method makes no patch for such a hole.
        NoPatch = "no-patch",
        /// The rim has more corners, or the patch more vertices, than the method takes.
        TooLarge = "too-large",
        /// The equations of a smooth patch have no solution, or it swings out far beyond the hole.
        NoFit = "no-fit",
        /// The rim and the rings around it have too few points for a field, or all its centres lie in one plane.
        TooFewPoints = "too-few-points",
        /// Other parts of the surface are at the rim everywhere, so that no side of it can be told from the other.
        NoRoom = "no-room",
        /// The equations of the field are singular to working precision.
        Singular = "singular",
        /// The field misses the values that it should take.
        Inexact = "inexact",
        /// A vertex finds no zero of the field within half the diagonal of the rim.
        NoZero = "no-zero",
        /// The rim is that of a flat sheet, on which every patch would lie.
        FlatSheet = "flat-sheet",
        /// A triangle without area.
        DegenerateTriangle = "degenerate-triangle",
        /// It is not a surface with exactly the rim as its boundary.
        Topology = "topology",
        /// An edge of it is in use already, or a triangle is the double of another.
        EdgeInUse = "edge-in-use",
        /// It meets the mesh or another patch beyond the rim.
        MeetsOther = "meets-other",
        /// It meets itself.
        MeetsItself = "meets-itself",
        /// Its new vertices have no place among the numbers of float32.
        NotRepresentable = "not-representable",
    }
}

mirror! { pipeline::HoleFate =>
    /// What happened to a hole.
    HoleFate {
        /// It has a patch.
        Filled = "filled",
        /// It was to be filled, but no patch was sound.
        Rejected = "rejected",
        /// It is no simple loop: directions of faces contradict each other there, or more than two faces meet.
        NoLoop = "no-loop",
        /// It was not chosen.
        Kept = "kept",
    }
}

mirror! { analysis::HoleClass =>
    /// What a boundary loop most likely is.
    HoleClass {
        /// Two rims that nearly coincide, or a loop with next to nothing inside.
        Crack = "crack",
        /// One face is missing.
        MissingFace = "missing-face",
        /// A flat hole of more edges.
        PlanarCut = "planar-cut",
        /// A hole that is not flat.
        MissingRegion = "missing-region",
        /// The border of a sheet, the mouth of a vessel or the end of a pipe: open on purpose.
        IntendedOpening = "intended-opening",
    }
}
