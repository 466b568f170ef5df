//! The words between a server and its children.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::limits::Limits;
use super::sandbox::{Protections, Sandbox};
use crate::formats::ReadLimits;
use crate::jobs::product::Product;
use crate::wire::{Operation, Options, Problem, Stage};

/// What a child is to do.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(in crate::jobs) struct Task {
    /// Process id of the server; the child ends when that is not its parent.
    pub(in crate::jobs) parent: i32,
    /// What to do.
    pub(in crate::jobs) operation: Operation,
    /// How.
    pub(in crate::jobs) options: Options,
    /// The mesh.
    pub(in crate::jobs) input: PathBuf,
    /// Its size in bytes.
    pub(in crate::jobs) input_bytes: u64,
    /// The MTL file of an OBJ.
    pub(in crate::jobs) material: Option<PathBuf>,
    /// The folder for what the child makes.
    pub(in crate::jobs) output: PathBuf,
    /// Engine threads, at least one.
    pub(in crate::jobs) threads: usize,
    /// Most triangles of a mesh.
    pub(in crate::jobs) triangles_max: u32,
    /// Most vertices of a mesh.
    pub(in crate::jobs) vertices_max: u32,
    /// Most corners of one polygon.
    pub(in crate::jobs) polygon_corners_max: u32,
    /// Most work units.
    pub(in crate::jobs) engine_work_max: u64,
    /// Most bytes that the engine may charge.
    pub(in crate::jobs) engine_bytes_max: u64,
    /// What the kernel holds the process to.
    pub(in crate::jobs) limits: Limits,
    /// How much of the sandbox there must be.
    pub(in crate::jobs) sandbox: Sandbox,
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
pub(super) enum Message {
    /// It is confined and begins.
    Confined(Protections),
    /// A pass begins.
    Enter(Stage),
    /// A pass ends.
    Leave(Stage),
    /// It is done; the last word.
    Made(Box<Product<FileMade>>),
    /// It has nothing to show; the last word.
    Failed(Box<Problem>),
}

/// A file in the folder of the child.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct FileMade {
    /// Its place among the files, from 0.
    pub(super) number: usize,
    /// Its size.
    pub(super) bytes: u64,
    /// SHA-256 of its bytes.
    pub(super) sha256: [u8; 32],
}

/// Name of the file with this number.
pub(super) fn file_name(number: usize) -> String {
    format!("made-{number}")
}
