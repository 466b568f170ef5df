//! Which triangles make up each part.

use super::welded::Welded;
use crate::budget::{Budget, CHECK_EVERY, Stopped};

/// The triangles of each part, ascending.
#[derive(Debug)]
pub(super) struct Members {
    /// Where each part begins in `triangles`; one more entry than parts.
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl Members {
    pub(super) fn of(mesh: &Welded<'_>, budget: &Budget) -> Result<Self, Stopped> {
        let mut starts = Vec::with_capacity(mesh.parts.len() + 1);
        starts.push(0);
        for part in &mesh.parts {
            starts.push(starts[starts.len() - 1] + part.len);
        }
        let mut cursor = starts.clone();
        let mut triangles = vec![0; mesh.triangles.len()];
        for (t, &part) in mesh.components.of.iter().enumerate() {
            if t % CHECK_EVERY == 0 {
                budget.check()?;
            }
            let slot = &mut cursor[part as usize];
            triangles[*slot as usize] = t as u32;
            *slot += 1;
        }
        Ok(Self { starts, triangles })
    }

    /// The triangles of part `p`.
    pub(super) fn part(&self, p: u32) -> &[u32] {
        &self.triangles[self.starts[p as usize] as usize..self.starts[p as usize + 1] as usize]
    }
}
