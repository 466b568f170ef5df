//! P2: which space a closed, embedded surface encloses.

use super::Shell;
use super::surface::ReadingSurface;
use crate::budget::{Budget, CHECK_EVERY, Charge, Stopped};
use crate::geom::signed_volume;
use crate::mesh::UnionFind;
use crate::par;
use crate::spatial::{Bvh, ShellNesting, ShellTriangles, nest};

/// The shells of a surface for which P0 and P1 hold.
pub(super) struct EmbeddedShells<'a> {
    shells: ShellTriangles,
    nesting: ShellNesting,
    /// Number of vertices of each shell.
    vertices: Vec<u32>,
    _charge: Charge<'a>,
}

impl<'a> EmbeddedShells<'a> {
    pub(super) fn of(surface: &ReadingSurface<'_>, bvh: &Bvh, budget: &'a Budget) -> Result<Self, Stopped> {
        let charge =
            budget.charge(surface.triangles.len() as u64 * 8 + surface.positions.len() as u64 * 8)?;
        let (shell_of, vertices) = shells(surface, budget)?;
        let count = vertices.len() as u32;
        let nesting = nest(&surface.positions, &surface.triangles, &shell_of, count, Some(bvh), budget)?;
        let shells = ShellTriangles::group(&shell_of, count, budget)?;
        Ok(Self { shells, nesting, vertices, _charge: charge })
    }

    /// First triangles of the shells that point inward although an even number of shells is around them, or outward
    /// although an odd number is.
    pub(super) fn misnested(&self) -> Vec<u32> {
        (0..self.vertices.len())
            .filter(|&s| self.nesting.is_outward[s] != self.nesting.depth[s].is_multiple_of(2))
            .map(|s| self.shells.of(s)[0])
            .collect()
    }

    /// The description of every shell.
    pub(super) fn describe(
        &self,
        surface: &ReadingSurface<'_>,
        budget: &Budget,
    ) -> Result<Vec<Shell>, Stopped> {
        par::try_map_ranges(self.vertices.len(), 1, |range| {
            budget.check()?;
            let s = range.start;
            let triangles = self.shells.of(s);
            // Closed: three half-edges a triangle, two an edge.
            let euler = i64::from(self.vertices[s]) - triangles.len() as i64 / 2;
            Ok(Shell {
                triangles: triangles.len() as u32,
                depth: self.nesting.depth[s],
                genus: ((2 - euler) / 2) as u32,
                volume: signed_volume(triangles.iter().map(|&t| surface.corners(t))),
            })
        })
    }
}

/// The shell of each triangle, shells numbered by first triangle, and the number of vertices of each. Where every
/// vertex has one fan, triangles that share a vertex are connected by edges too, so uniting vertices finds the shells.
fn shells(surface: &ReadingSurface<'_>, budget: &Budget) -> Result<(Vec<u32>, Vec<u32>), Stopped> {
    const UNSEEN: u32 = u32::MAX;
    let mut parts = UnionFind::new(surface.positions.len());
    for block in surface.triangles.chunks(CHECK_EVERY) {
        budget.check()?;
        for &[a, b, c] in block {
            parts.unite(a, b);
            parts.unite(b, c);
        }
    }
    let parts = parts.into_components();
    let mut shell_of_part = vec![UNSEEN; parts.count as usize];
    let mut shell_of = Vec::with_capacity(surface.triangles.len());
    let mut count = 0;
    for block in surface.triangles.chunks(CHECK_EVERY) {
        budget.check()?;
        for corners in block {
            let shell = &mut shell_of_part[parts.of[corners[0] as usize] as usize];
            if *shell == UNSEEN {
                *shell = count;
                count += 1;
            }
            shell_of.push(*shell);
        }
    }
    let mut vertices = vec![0; count as usize];
    for &part in &parts.of {
        let shell = shell_of_part[part as usize];
        if shell != UNSEEN {
            vertices[shell as usize] += 1;
        }
    }
    Ok((shell_of, vertices))
}
