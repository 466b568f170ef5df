//! The words of printing.

use crate::printing;
use crate::wire::words::{mirror, words};

words! {
    /// A printing process, with the limits that `/v1/policies` lists.
    PolicyName {
        /// Fused deposition modelling.
        Fdm = "fdm",
        /// Stereolithography.
        Sla = "sla",
        /// Selective laser sintering of polyamide.
        Sls = "sls",
        /// Multi jet fusion of polyamide.
        Mjf = "mjf",
        /// Laser sintering of metal.
        Metal = "metal",
    }
}

mirror! { printing::BuildDirection =>
    /// The direction of the file that is up in the machine.
    BuildDirection {
        /// Along x.
        X = "x",
        /// Against x.
        MinusX = "minus_x",
        /// Along y.
        Y = "y",
        /// Against y.
        MinusY = "minus_y",
        /// Along z.
        Z = "z",
        /// Against z.
        MinusZ = "minus_z",
    }
}

mirror! { printing::CheckCode =>
    /// What is checked for printing.
    CheckCode {
        /// Walls are thick enough; measured is the thinnest, in millimetres.
        Wall = "wall-thickness",
        /// Gaps between walls are wide enough; measured is the narrowest, in millimetres.
        Gap = "gap",
        /// Parts of their own are large enough; measured is the longest side of the smallest, in millimetres.
        Feature = "small-feature",
        /// Faces that look down are steep enough; measured is the smallest angle from the horizontal, in degrees.
        Overhang = "overhang",
        /// Edges are blunt enough; measured is the smallest angle of material, in degrees.
        SharpEdge = "sharp-edge",
        /// Nothing is trapped inside; measured is the number of cavities without a way out.
        Cavity = "trapped-cavity",
        /// The part fits the machine; measured is its size as a share of the largest box, 1 when it just fits.
        BuildVolume = "build-volume",
    }
}

mirror! { printing::Status =>
    /// How a figure stands to its limits.
    Status {
        /// Within both.
        Ok = "ok",
        /// Beyond the limit of a warning: the print may fail or be weak.
        Warning = "warning",
        /// Beyond the limit of an error: the process cannot do it.
        Error = "error",
    }
}

mirror! { printing::Fit =>
    /// How a part fits the largest box of a process.
    Fit {
        /// With the build direction up, turned about it by a quarter at most.
        AsPlaced = "as_placed",
        /// With its sides along those of the box in another way.
        Turned = "turned",
        /// Only turned askew.
        Tilted = "tilted",
        /// In none of these ways.
        No = "no",
    }
}

words! {
    /// What a printing report is about.
    PrintedMesh {
        /// The mesh that is returned.
        Result = "result",
        /// The uploaded mesh.
        Input = "input",
    }
}

words! {
    /// The unit of a figure.
    PrintingUnit {
        /// Millimetres.
        Millimetres = "mm",
        /// Degrees.
        Degrees = "degrees",
        /// A number of elements.
        Count = "count",
        /// A share; 1 is the whole.
        Share = "share",
    }
}

words! {
    /// On which side of its limits a figure must be.
    BoundKind {
        /// Smaller figures break the limit.
        AtLeast = "at_least",
        /// Larger figures break the limit.
        AtMost = "at_most",
    }
}

impl CheckCode {
    /// The unit of its figure.
    pub fn unit(self) -> PrintingUnit {
        match self {
            Self::Wall | Self::Gap | Self::Feature => PrintingUnit::Millimetres,
            Self::Overhang | Self::SharpEdge => PrintingUnit::Degrees,
            Self::Cavity => PrintingUnit::Count,
            Self::BuildVolume => PrintingUnit::Share,
        }
    }
}
