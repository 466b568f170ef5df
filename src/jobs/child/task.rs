//! The words between a server and its children.

use serde::{Deserialize, Serialize};

use super::limits::ProcessLimits;
use super::sandbox::{Protections, Sandbox};
use crate::formats::ReadLimits;
use crate::jobs::product::RunProduct;
use crate::wire::{Operation, Options, Problem, Stage};

/// What a child is told when it is started; its task comes later.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct ChildSetup {
    /// Process id of the server; the child ends when that is not its parent.
    pub(super) parent: i32,
    /// Engine threads, at least one.
    pub(super) threads: usize,
    /// What the kernel holds the process to.
    pub(super) limits: ProcessLimits,
    /// How much of the sandbox there must be.
    pub(super) sandbox: Sandbox,
}

/// What a child is to do with the files in its folder.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Task {
    /// What to do.
    pub(super) operation: Operation,
    /// How.
    pub(super) options: Options,
    /// Size of the mesh in bytes; of several meshes, of all together.
    pub(super) input_bytes: u64,
    /// Sizes of several meshes, which stand one behind the other in one file; none: it is one mesh.
    pub(super) file_sizes: Vec<u64>,
    /// With the mesh, an OBJ, comes its MTL file.
    pub(super) has_material: bool,
    /// Most triangles of a mesh.
    pub(super) triangles_max: u32,
    /// Most vertices of a mesh.
    pub(super) vertices_max: u32,
    /// Most corners of one polygon.
    pub(super) polygon_corners_max: u32,
    /// Most work units.
    pub(super) engine_work_max: u64,
    /// Most bytes that the engine may charge.
    pub(super) engine_bytes_max: u64,
}

impl Task {
    pub(super) fn read_limits(&self) -> ReadLimits {
        ReadLimits {
            triangles_max: self.triangles_max,
            vertices_max: self.vertices_max,
            polygon_corners_max: self.polygon_corners_max,
        }
    }
}

/// What a child says, a line each.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum ChildMessage {
    /// It is confined and waits for its task.
    Confined(Protections),
    /// It has its task.
    Taken,
    /// A pass begins.
    Enter(Stage),
    /// A pass ends.
    Leave(Stage),
    /// So many work units are used by now.
    Work(u64),
    /// It is done; the last word.
    Made(Box<RunProduct<FileMade>>),
    /// It has nothing to show; the last word.
    Failed(Box<Problem>),
}

/// A file that a child made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct FileMade {
    /// Its place among the files, from 0.
    pub(super) number: usize,
    /// Its size.
    pub(super) bytes: u64,
    /// SHA-256 of its bytes.
    pub(super) sha256: [u8; 32],
}
