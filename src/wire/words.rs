//! One public word for each value of the engine's enumerations.

use crate::{
    analysis, budget, certificate, formats, implicit, mesh, pipeline, render, repair, simplify, winding,
};

/// An enumeration whose values have public words, as options see it.
pub(super) trait Word: Sized {
    /// Name of its schema.
    const NAME: &'static str;
    /// The words of all values.
    const ALL_WORDS: &'static [&'static str];

    /// The value of this word.
    fn of_word(word: &str) -> Option<Self>;
}

/// An enumeration whose values have public words.
macro_rules! words {
    ($(#[doc = $description:literal])+ $name:ident {
        $($(#[doc = $about:literal])+ $variant:ident = $word:literal,)+
    }) => {
        $(#[doc = $description])+
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize)]
        pub enum $name {
            $($(#[doc = $about])+ #[serde(rename = $word)] $variant,)+
        }

        // Written out, because the derive does not see words that come out of a macro.
        impl utoipa::PartialSchema for $name {
            fn schema() -> utoipa::openapi::RefOr<utoipa::openapi::schema::Schema> {
                let mut description = String::from(concat!($($description),+).trim());
                for (word, about) in [$(($word, concat!($($about),+).trim())),+] {
                    description.push_str(&format!("\n- `{word}`: {about}"));
                }
                let object = utoipa::openapi::schema::ObjectBuilder::new()
                    .schema_type(utoipa::openapi::schema::Type::String)
                    .description(Some(description))
                    .enum_values(Some(Self::WORDS.iter().copied()));
                utoipa::openapi::RefOr::T(utoipa::openapi::schema::Schema::Object(object.build()))
            }
        }

        impl utoipa::ToSchema for $name {}

        impl $crate::wire::words::Word for $name {
            const NAME: &'static str = stringify!($name);
            const ALL_WORDS: &'static [&'static str] = Self::WORDS;

            fn of_word(word: &str) -> Option<Self> {
                Self::from_word(word)
            }
        }

        impl $name {
            /// Every value.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];
            /// The words of all values, in the same order.
            pub const WORDS: &'static [&'static str] = &[$($word),+];

            /// The public word.
            pub fn word(self) -> &'static str {
                match self { $(Self::$variant => $word),+ }
            }

            /// The value of this word.
            pub fn from_word(word: &str) -> Option<Self> {
                match word { $($word => Some(Self::$variant),)+ _ => None }
            }
        }

        impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                let word = <std::borrow::Cow<'de, str> as serde::Deserialize>::deserialize(from)?;
                Self::from_word(&word).ok_or_else(|| serde::de::Error::unknown_variant(&word, Self::WORDS))
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.word())
            }
        }
    };
}

/// As `words!` for a type of the engine, whose values it mirrors one to one.
macro_rules! mirror {
    ($engine:ty => $(#[doc = $description:literal])+ $name:ident {
        $($(#[doc = $about:literal])+ $variant:ident = $word:literal,)+
    }) => {
        words! { $(#[doc = $description])+ $name { $($(#[doc = $about])+ $variant = $word,)+ } }

        impl From<$engine> for $name {
            fn from(inner: $engine) -> Self {
                type Inner = $engine;
                match inner { $(Inner::$variant => Self::$variant),+ }
            }
        }

        impl From<$name> for $engine {
            fn from(word: $name) -> Self {
                match word { $($name::$variant => Self::$variant),+ }
            }
        }
    };
}

pub(super) use {mirror, words};

mirror! { pipeline::Operation =>
    /// What to do with a file.
    Operation {
        /// Report only.
        Analyze = "analyze",
        /// Report and what a repair would do about each defect.
        Plan = "plan",
        /// Report and a certified repair.
        Repair = "repair",
        /// The same mesh in another format.
        Convert = "convert",
        /// The certificate of the file as it is.
        Verify = "verify",
        /// Fewer triangles; the certificate states what holds.
        Simplify = "simplify",
        /// A manifold with boundary; the certificate states what holds.
        CutStitch = "cut-stitch",
        /// Holes closed; the certificate states what holds.
        FillHoles = "fill-holes",
        /// A closed polyhedron edited by its planes; the certificate states what holds.
        Modeller = "modeller",
        /// Several solids combined into one that is certified.
        Boolean = "boolean",
        /// A picture.
        Render = "render",
    }
}

impl Operation {
    /// Those whose product is a mesh.
    pub const WITH_MESH: &'static [Self] = &[
        Self::Repair,
        Self::Convert,
        Self::Simplify,
        Self::CutStitch,
        Self::FillHoles,
        Self::Modeller,
        Self::Boolean,
    ];
    /// Those that do more than make a picture.
    pub const BESIDE_PICTURE: &'static [Self] = &[
        Self::Analyze,
        Self::Plan,
        Self::Repair,
        Self::Convert,
        Self::Verify,
        Self::Simplify,
        Self::CutStitch,
        Self::FillHoles,
        Self::Modeller,
        Self::Boolean,
    ];
    /// Those that describe the mesh.
    pub const DESCRIBING: &'static [Self] = &[
        Self::Analyze,
        Self::Plan,
        Self::Repair,
        Self::Convert,
        Self::Simplify,
        Self::CutStitch,
        Self::FillHoles,
        Self::Modeller,
        Self::Boolean,
        Self::Render,
    ];

    /// Most meshes that it takes.
    pub fn meshes_max(self) -> usize {
        *pipeline::Operation::from(self).meshes().end()
    }

    /// True when its product is a mesh.
    pub fn makes_mesh(self) -> bool {
        Self::WITH_MESH.contains(&self)
    }
}

mirror! { formats::Format =>
    /// A file format.
    Format {
        /// Wavefront OBJ.
        Obj = "obj",
        /// STL, binary or ASCII.
        Stl = "stl",
        /// Object file format.
        Off = "off",
        /// Polygon file format.
        Ply = "ply",
        /// glTF 2.0 in one binary file.
        Glb = "glb",
        /// glTF 2.0 as JSON that holds its data.
        Gltf = "gltf",
        /// 3D Manufacturing Format.
        ThreeMf = "3mf",
    }
}

mirror! { formats::Encoding =>
    /// A format together with the way its bytes are laid out.
    Encoding {
        /// OBJ text.
        Obj = "obj",
        /// Binary STL.
        StlBinary = "stl-binary",
        /// ASCII STL.
        StlAscii = "stl-ascii",
        /// OFF text.
        Off = "off",
        /// Binary OFF.
        OffBinary = "off-binary",
        /// PLY text.
        PlyAscii = "ply-ascii",
        /// Binary little-endian PLY.
        PlyBinaryLittleEndian = "ply-binary-little-endian",
        /// Binary big-endian PLY.
        PlyBinaryBigEndian = "ply-binary-big-endian",
        /// Binary glTF.
        Glb = "glb",
        /// glTF JSON.
        Gltf = "gltf",
        /// The package of a 3MF.
        ThreeMf = "3mf",
    }
}

mirror! { formats::ObjReader =>
    /// The reader of OBJ files.
    Reader {
        /// Our own: speaks of lines and keeps the file's numbering.
        Own = "own",
        /// The `tobj` crate: as other programs read the file.
        Tobj = "tobj",
    }
}

mirror! { pipeline::Units =>
    /// The length of one unit of the file.
    Units {
        /// Micrometre.
        Micrometre = "um",
        /// Millimetre.
        Millimetre = "mm",
        /// Centimetre.
        Centimetre = "cm",
        /// Metre.
        Metre = "m",
        /// Inch.
        Inch = "in",
        /// Foot.
        Foot = "ft",
    }
}

impl Units {
    /// Length of the unit in millimetres.
    pub fn millimetres(self) -> f64 {
        pipeline::Units::from(self).millimetres()
    }
}

mirror! { pipeline::Parts =>
    /// What of a file of several parts is one solid.
    SolidParts {
        /// Each part by itself, in its own coordinates; the file keeps everything around them.
        Separate = "separate",
        /// All parts at their places, after each was repaired by itself; the result is a new file of one mesh.
        Union = "union",
        /// All parts at their places, as they are; the result is a new file of one mesh.
        Together = "together",
    }
}

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
        /// Boundary loops stay as they are.
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

mirror! { mesh::Validity =>
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
        /// The simple cycles that they are made of become faces of their own.
        Split = "split",
        /// They go.
        Drop = "drop",
    }
}

mirror! { winding::OpenShells =>
    /// How open shells are read where a mesh must be rebuilt.
    OpenShells {
        /// Those that nearly bound a volume are closed, others become walls.
        Auto = "auto",
        /// As the boundary of a volume, open only by mistake.
        Close = "close",
        /// As walls of no thickness.
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

mirror! { repair::nest::Policy =>
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

mirror! { repair::nest::Fate =>
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
        /// No surface fits the rim and what is around it.
        NoFit = "no-fit",
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

mirror! { render::Edges =>
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    fn are_distinct(words: &[&str]) -> bool {
        words.iter().collect::<HashSet<_>>().len() == words.len()
    }

    #[test]
    fn the_schema_lists_the_words_that_are_sent() {
        let schema = serde_json::to_value(<Units as utoipa::PartialSchema>::schema()).unwrap();
        assert_eq!(schema["enum"], serde_json::json!(Units::WORDS));
        assert_eq!(serde_json::to_value(Units::ALL).unwrap(), schema["enum"]);
    }

    #[test]
    fn every_value_has_a_word_of_its_own() {
        for words in [
            Operation::WORDS,
            Format::WORDS,
            Encoding::WORDS,
            Reader::WORDS,
            Units::WORDS,
            Require::WORDS,
            FillHoles::WORDS,
            Nesting::WORDS,
            ShellFate::WORDS,
            Opposite::WORDS,
            Remedy::WORDS,
            OpenShells::WORDS,
            Contact::WORDS,
            SetOperation::WORDS,
            Across::WORDS,
            Cut::WORDS,
            Stitch::WORDS,
            StitchValidity::WORDS,
            Degenerate::WORDS,
            Outcome::WORDS,
            Fidelity::WORDS,
            ChangeKind::WORDS,
            Stage::WORDS,
            Severity::WORDS,
            DefectCode::WORDS,
            ProximityTest::WORDS,
            Condition::WORDS,
            ReasonCode::WORDS,
        ] {
            assert!(are_distinct(words), "{words:?}");
        }
    }

    #[test]
    fn a_word_leads_back_to_its_value_and_to_the_engine() {
        for &code in DefectCode::ALL {
            assert_eq!(DefectCode::from_word(code.word()), Some(code));
            assert_eq!(DefectCode::from(analysis::DefectCode::from(code)), code);
            assert_eq!(serde_json::to_value(code).unwrap(), code.word());
        }
        assert_eq!(DefectCode::from_word("hole"), None);
    }

    #[test]
    fn the_engine_uses_the_same_words_where_it_has_names() {
        for format in formats::Format::ALL {
            assert_eq!(Format::from(format).word(), format.name());
        }
        for operation in pipeline::Operation::ALL {
            assert_eq!(Operation::from(operation).word(), operation.name());
        }
        for &operation in SetOperation::ALL {
            assert_eq!(operation.word(), pipeline::SetOperation::from(operation).name());
        }
        for stage in budget::Stage::ALL {
            assert_eq!(Stage::from(stage).word(), stage.name());
        }
        for &encoding in Encoding::ALL {
            assert_eq!(encoding.word(), formats::Encoding::from(encoding).name());
        }
    }
}
