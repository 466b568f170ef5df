//! What a report says: outcomes, stages, defects and conditions.

use crate::{analysis, budget, certificate, pipeline};

mirror! { pipeline::Outcome =>
    /// What became of the file.
    Outcome {
        /// Already valid; the same bytes.
        Identical = "identical",
        /// Valid; another format.
        Converted = "converted",
        /// Valid after local edits.
        Repaired = "repaired",
        /// Valid; the surface was rebuilt within the distance that is reported.
        Rebuilt = "rebuilt",
        /// Fewer triangles, as asked; the certificate says what holds.
        Simplified = "simplified",
        /// Cut and stitched, as asked; the certificate says what holds.
        CutStitched = "cut-stitched",
        /// Holes closed, as asked and as far as sound patches were found; the certificate says what holds.
        Filled = "filled",
        /// Edited by its planes, as asked; the certificate says what holds.
        Modelled = "modelled",
        /// Valid; several solids became one, as asked.
        Combined = "combined",
        /// Not valid; only on request.
        Partial = "partial",
        /// No result.
        Refused = "refused",
    }
}

mirror! { pipeline::Fidelity =>
    /// How true a result is to its file.
    Fidelity {
        /// The same surface; no vertex moved.
        Exact = "exact",
        /// Nothing is lost, invented or moved beyond bounds that are stated.
        Faithful = "faithful",
        /// A bound is exceeded; the verdict says which.
        Changed = "changed",
    }
}

mirror! { pipeline::ChangeKind =>
    /// What of a file a result changed beyond a bound.
    ChangeKind {
        /// Share of the visible surface of the file that is lost.
        Lost = "lost",
        /// Share of the surface of the result that the file does not have.
        Invented = "invented",
        /// Largest distance between result and file, in the unit of the file.
        Moved = "moved",
        /// Number of bodies that are lost as a whole.
        Bodies = "bodies",
        /// Share by which the volume changed.
        Volume = "volume",
    }
}

mirror! { budget::Stage =>
    /// A pass of the engine.
    Stage {
        /// Bytes to mesh.
        Read = "read",
        /// Report of the mesh as it is.
        Analyze = "analyze",
        /// Repair steps.
        Repair = "repair",
        /// Fewer triangles.
        Simplify = "simplify",
        /// Mesh to bytes.
        Write = "write",
        /// The exact check of bytes.
        Certify = "certify",
        /// How far the result is from the input.
        Measure = "measure",
        /// A picture.
        Draw = "draw",
    }
}

mirror! { analysis::Severity =>
    /// How bad a defect is for printing.
    Severity {
        /// Good to know; valid all the same.
        Info = "info",
        /// Some readers will take it differently.
        Warning = "warning",
        /// The file is not a valid solid.
        Error = "error",
    }
}

mirror! { analysis::DefectCode =>
    /// A kind of defect.
    DefectCode {
        /// No triangle at all: nothing that could be solid.
        NoTriangle = "no-triangle",
        /// Vertex with a NaN or infinite coordinate.
        NonFiniteVertex = "non-finite-vertex",
        /// Face that uses such a vertex.
        NonFiniteFace = "non-finite-face",
        /// Face that names a vertex the file does not have.
        IndexOutOfRange = "index-out-of-range",
        /// Face with fewer than three corners.
        TooFewCorners = "too-few-corners",
        /// Polygon whose corners are not in one plane.
        NonPlanarPolygon = "non-planar-polygon",
        /// Polygon that is not convex.
        ConcavePolygon = "concave-polygon",
        /// Triangle with two or three corners at one position.
        CoincidentCorners = "coincident-corners",
        /// Triangle whose three distinct corners are on one line.
        CollinearFace = "collinear-face",
        /// Triangle whose shortest edge is below 1 % of its longest.
        Needle = "needle",
        /// Triangle with an angle above 175 degrees that is no needle.
        Cap = "cap",
        /// Triangle with the same three vertices as an earlier one in the same direction.
        DuplicateFace = "duplicate-face",
        /// Triangle with the same three vertices as an earlier one, the first in the opposite direction.
        OppositeDuplicateFace = "opposite-duplicate-face",
        /// Vertex that no face and no edge uses.
        IsolatedVertex = "isolated-vertex",
        /// Edge that the file states by itself (`l` of OBJ, `edge` of PLY) and no face has.
        IsolatedEdge = "isolated-edge",
        /// Vertex at the position of an earlier one.
        DuplicateVertex = "duplicate-vertex",
        /// Face that shares no edge with another face.
        IsolatedFace = "isolated-face",
        /// Loop of edges with one triangle.
        BoundaryLoop = "boundary-loop",
        /// Edge with three triangles or more.
        NonManifoldEdge = "non-manifold-edge",
        /// Vertex whose triangles form more than one fan.
        NonManifoldVertex = "non-manifold-vertex",
        /// Edge whose two triangles run in the same direction.
        OrientationConflict = "orientation-conflict",
        /// Component that cannot be oriented coherently.
        NonOrientable = "non-orientable",
        /// Edge whose two triangles are less than one degree apart: they almost lie on each other.
        FoldedEdge = "folded-edge",
        /// Closed outermost shell that points inward.
        InvertedShell = "inverted-shell",
        /// Closed shell nested so that the winding number is neither 0 nor 1.
        MisnestedShell = "misnested-shell",
        /// Closed shell with exactly no volume.
        ZeroVolumeShell = "zero-volume-shell",
        /// Closed shell, or shell and the next one inside it, with next to nothing between its two sides.
        DoubleSkin = "double-skin",
        /// Part with a rim that bounds no volume, rather than a solid that lacks faces.
        OpenSheet = "open-sheet",
        /// Part that is tiny beside the largest one.
        NoiseShell = "noise-shell",
        /// Two triangles that pass through each other.
        SelfIntersection = "self-intersection",
        /// Two triangles that overlap in one plane.
        Overlap = "overlap",
        /// Two triangles that touch in a point or segment they do not share.
        Touch = "touch",
        /// Vertices, edges or faces that do not meet but are nearer than epsilon and half of the edges around them.
        Near = "near",
        /// Sound as described here, but not with coordinates rounded to float32 or polygons split as simple fans.
        UnsoundReading = "unsound-reading",
    }
}

mirror! { analysis::ProximityTest =>
    /// Which features of two faces meet or are near each other, lowest dimension first.
    ProximityTest {
        /// Two vertices.
        VertexVertex = "vv",
        /// A vertex and an edge.
        VertexEdge = "ve",
        /// A vertex and a face.
        VertexFace = "vf",
        /// Two edges.
        EdgeEdge = "ee",
        /// An edge and a face.
        EdgeFace = "ef",
        /// Two faces.
        FaceFace = "ff",
    }
}

mirror! { certificate::Condition =>
    /// A condition that a valid solid must meet.
    Condition {
        /// P0: every face is usable and all coordinates are finite.
        Usable = "usable",
        /// P0: no triangle has a repeated or exactly collinear corner.
        NonDegenerate = "non-degenerate",
        /// P0: no two triangles have the same three vertices.
        Distinct = "distinct",
        /// P0: every edge has exactly two triangles.
        TwoTrianglesPerEdge = "two-triangles-per-edge",
        /// P0: the two triangles of an edge run through it in opposite directions.
        OppositeDirections = "opposite-directions",
        /// P0: the link of every vertex is one cycle.
        OneFanPerVertex = "one-fan-per-vertex",
        /// P1: no two triangles meet except in a common vertex or edge.
        Embedded = "embedded",
        /// P2: there is at least one triangle.
        NotEmpty = "not-empty",
        /// P2: nested shells alternate and the outermost ones point outward.
        Alternating = "alternating",
    }
}

words! {
    /// Why a verdict is as it is: a refusal, or a condition that does not hold.
    ReasonCode {
        /// There is no finite non-degenerate triangle.
        NothingToRepair = "nothing-to-repair",
        /// No step of the plan led to a valid solid.
        NotRepairable = "not-repairable",
        /// No valid solid was found in the work that a file of this size may take.
        OverBudget = "over-budget",
        /// A coordinate cannot be written in the output format.
        NotRepresentable = "not-representable",
        /// The modeller cannot read the mesh as a polyhedron.
        NotAPolyhedron = "not-a-polyhedron",
        /// The modeller refuses an operator, a range or the dual.
        OperatorRefused = "operator-refused",
        /// A mesh that is to be combined with others is no closed solid.
        InputNotSolid = "input-not-solid",
        /// Nothing is left of the solids.
        EmptyResult = "empty-result",
        /// The solids meet in too many places, or combining them failed.
        NotCombined = "not-combined",
        /// No result keeps the caller's own limits.
        LimitExceeded = "limit-exceeded",
        /// No result is exact or faithful, as the caller demands.
        NotFaithful = "not-faithful",
        /// A condition of P0, P1 or P2 does not hold in the judged bytes.
        ConditionBroken = "condition-broken",
    }
}
