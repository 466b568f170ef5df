//! What a caller chooses of a repair, a cut, a simplification or a union.

use crate::{mesh, pipeline, repair, simplify, winding};

mirror! { pipeline::Require =>
    /// What the result must be.
    Require {
        /// A valid solid, or a refusal.
        Printable = "printable",
        /// A valid solid that is exact or faithful to the file, or a refusal.
        Faithful = "faithful",
        /// The best there is, called `partial` when it is not printable.
        BestEffort = "best_effort",
        /// Whatever the operation gives; the certificate says what holds.
        None = "none",
    }
}

mirror! { pipeline::FillHoles =>
    /// Whether simple holes are filled.
    FillHoles {
        /// No step fills boundary loops; where the surface is rebuilt, they are closed all the same.
        None = "none",
        /// Planar loops and those that close by ears or a fan without a contact.
        Simple = "simple",
    }
}

words! {
    /// How a cut is made. The result is the same.
    Cut {
        /// Whichever costs less.
        Auto = "auto",
        /// The stars of singular vertices are taken apart.
        Local = "local",
        /// All corners start apart and are united across unmarked edges.
        Global = "global",
    }
}

impl From<Cut> for Option<mesh::CutMethod> {
    fn from(word: Cut) -> Self {
        match word {
            Cut::Auto => None,
            Cut::Local => Some(mesh::CutMethod::Local),
            Cut::Global => Some(mesh::CutMethod::Global),
        }
    }
}

mirror! { pipeline::Stitching =>
    /// Which boundary edges are joined after a cut.
    Stitch {
        /// None.
        None = "none",
        /// Those that the cut has parted, along each boundary from where it turns back on itself. No vertex moves.
        Pinch = "pinch",
        /// All whose ends are close to each other.
        Snap = "snap",
    }
}

words! {
    /// Which vertices a cut takes as one.
    Weld {
        /// All at one position, as programs do that read a file without indices.
        Exact = "exact",
        /// Those that have one number in the file. Coincident rims stay apart.
        None = "none",
    }
}

mirror! { mesh::StitchValidity =>
    /// When two boundary edges may be joined.
    StitchValidity {
        /// When the mesh is a manifold afterwards.
        Exact = "exact",
        /// When the published conditions hold as well.
        Paper = "paper",
    }
}

mirror! { repair::polygons::DegenerateFaces =>
    /// What becomes of faces that pass a vertex more than once.
    Degenerate {
        /// The simple cycles that they are made of become faces of their own; one whose own triangles cover less, as around a hole, keeps them.
        Split = "split",
        /// They go.
        Drop = "drop",
    }
}

mirror! { winding::OpenShells =>
    /// How open shells are read where holes are left or a mesh must be rebuilt.
    OpenShells {
        /// Those that nearly bound a volume are closed, others become walls.
        Auto = "auto",
        /// As the boundary of a volume, open only by mistake.
        Close = "close",
        /// As walls.
        Thicken = "thicken",
    }
}

mirror! { pipeline::Effort =>
    /// How fine and so how long a mesh is rebuilt that no step of a repair makes a solid.
    Effort {
        /// The coarsest lattice that usually shows what is to be seen.
        Low = "low",
        /// That, and a finer one where too much is lost.
        Normal = "normal",
        /// Ever finer ones.
        High = "high",
    }
}

mirror! { pipeline::SetOperation =>
    /// What becomes of several solids.
    SetOperation {
        /// What is in any of them.
        Union = "union",
        /// What is in all of them.
        Intersection = "intersection",
        /// What is in the first and in no other.
        Difference = "difference",
    }
}

mirror! { pipeline::Contact =>
    /// What becomes of bodies that touch in vertices or edges only.
    Contact {
        /// All but one are drawn back a little.
        Open = "open",
        /// They become one by necks as thick as a wall, where there is room; elsewhere they are drawn apart.
        Join = "join",
    }
}

mirror! { repair::pair_sheets::Across =>
    /// What lies between triangles that are paired.
    Across {
        /// The solid behind them.
        Solid = "solid",
        /// The empty space in front of them.
        Void = "void",
    }
}

mirror! { repair::nest::NestingPolicy =>
    /// How shells inside shells are taken.
    Nesting {
        /// As they point: only a globally consistent inversion is flipped, cavities stay.
        AsOriented = "as_oriented",
        /// Every second shell from outside inward is a cavity, however it points.
        Alternate = "alternate",
        /// The outermost shells are solid throughout; what is inside of them goes.
        Fill = "fill",
    }
}

mirror! { repair::nest::ShellFate =>
    /// What becomes of a shell.
    ShellFate {
        /// It stays as it is.
        Stays = "stays",
        /// Its triangles are turned.
        Turns = "turns",
        /// It is dropped.
        Goes = "goes",
    }
}

mirror! { repair::duplicates::OppositePairs =>
    /// What becomes of two triangles with the same vertices in opposite directions.
    Opposite {
        /// Both go; where they are the surface of a body or sheet of their own, one stays.
        Cancel = "cancel",
        /// The first stays.
        KeepFirst = "keep-first",
    }
}

mirror! { pipeline::Remedy =>
    /// What is done about a defect.
    Remedy {
        /// What is defect goes; what is around it meets.
        Drop = "drop",
        /// Both triangles of a pair go.
        DropBoth = "drop-both",
        /// One triangle of a pair goes.
        DropOne = "drop-one",
        /// Its short edge is collapsed.
        Collapse = "collapse",
        /// Its long edge is flipped.
        Flip = "flip",
        /// It is divided.
        Split = "split",
        /// Vertices at one place become one.
        Join = "join",
        /// It is closed by new triangles.
        Fill = "fill",
        /// The open part gets a wall behind it.
        Thicken = "thicken",
        /// The surface is cut there, and joined where it belongs together.
        Cut = "cut",
        /// Triangles are turned.
        Turn = "turn",
        /// The whole part goes; of triangles that meet, they and what is around them, and the place is filled.
        Remove = "remove",
        /// Bodies that pass through each other become one.
        Unite = "unite",
        /// Coordinates become float32.
        Round = "round",
        /// No local step cures it; the surface is rebuilt.
        Rebuild = "rebuild",
        /// It stays. A file with an error that stays is not printable.
        Keep = "keep",
    }
}

mirror! { simplify::Mode =>
    /// How a simplification works.
    Mode {
        /// Always the cheapest collapse of all that are possible.
        Strict = "strict",
        /// Cheap collapses first, in many independent parts of the mesh at a time: several times as fast as strict.
        Fast = "fast",
        /// As fast, with checks that surfaces neither meet nor pass through each other: valid in, valid out. Takes four to five times as long.
        Guarded = "guarded",
    }
}

mirror! { simplify::CriterionKind =>
    /// What the collapse of an edge costs.
    Criterion {
        /// Squared distances from the planes of the triangles that a vertex stands for.
        Quadric = "quadric",
        /// Change of volume and shape by this collapse alone.
        Memoryless = "memoryless",
        /// The length of the edge.
        Length = "length",
    }
}

mirror! { simplify::Placement =>
    /// Where the vertex goes that an edge becomes.
    Placement {
        /// Where the criterion is smallest.
        Optimal = "optimal",
        /// Onto an end of the edge: no new positions.
        OntoEnd = "onto_end",
    }
}

mirror! { pipeline::VertexColors =>
    /// What colours the vertices of a simplified mesh have.
    VertexColors {
        /// Those of the file, mixed where vertices were merged.
        Kept = "kept",
        /// The order in which they would go next, from blue to red: a picture for OFF, PLY and glTF.
        Priority = "priority",
    }
}
