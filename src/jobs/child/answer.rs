//! What a child made, as files of its folder.

use std::fs::File;
use std::io::Write as _;

use sha2::{Digest as _, Sha256};

use super::task::FileMade;
use super::workspace::Rooms;
use crate::jobs::problems::workspace_problem;
use crate::jobs::product::RunProduct;
use crate::par;
use crate::wire::{Problem, ProblemCode};

/// Writes files with numbers into a folder.
#[derive(Debug)]
pub(super) struct Files {
    pub(super) rooms: Rooms,
    /// Most bytes of one.
    pub(super) bytes_max: u64,
}

impl Files {
    /// The product with its contents in files.
    pub(super) fn write(&self, product: RunProduct<Vec<u8>>) -> Result<RunProduct<FileMade>, Problem> {
        let mut number = 0;
        product.try_map(|content| {
            let made = self.make(number, &content)?;
            number += 1;
            Ok(made)
        })
    }

    fn make(&self, number: usize, content: &[u8]) -> Result<FileMade, Problem> {
        let bytes = content.len() as u64;
        if bytes > self.bytes_max {
            // The kernel would end the process: say so instead.
            let detail = "the result is larger than all that may be kept";
            return Err(Problem::new(ProblemCode::StorageFull, detail).with_limit(
                "data_bytes_max",
                self.bytes_max,
                Some(bytes),
            ));
        }
        let path = self.rooms.made(number);
        // Not `create_new` alone: that asks to read as well, which the sandbox does not grant.
        let write = || File::options().write(true).create_new(true).open(&path)?.write_all(content);
        let (written, sha256) = par::join(write, || Sha256::digest(content).into());
        written.map_err(|error| workspace_problem(&error))?;
        Ok(FileMade { number, bytes, sha256 })
    }
}
