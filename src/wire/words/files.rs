//! Files: their formats, encodings, readers and units, and what is done with them.

use crate::{formats, pipeline};

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

mirror! { pipeline::SolidParts =>
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
