//! The triangles around each vertex, and whether a vertex may move without turning one of them.

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;

/// Least cosine between the normals of a triangle before and after a move.
const TURN_COS: f64 = 0.1;

/// Least height of a triangle after a move, as a share of its longest side.
const HEIGHT: f64 = 0.02;

/// The triangles around each vertex.
#[derive(Debug)]
pub(super) struct Stars {
    starts: Vec<u32>,
    members: Vec<u32>,
}

impl Stars {
    pub(super) fn of(triangles: &[[u32; 3]], vertex_count: usize, budget: &Budget) -> Result<Self, Stopped> {
        let mut starts = vec![0u32; vertex_count + 1];
        for block in triangles.chunks(CHECK_EVERY) {
            budget.check()?;
            block.as_flattened().iter().for_each(|&v| starts[v as usize + 1] += 1);
        }
        for v in 0..vertex_count {
            starts[v + 1] += starts[v];
        }
        let mut next = starts.clone();
        let mut members = vec![0; triangles.len() * 3];
        for (t, corners) in triangles.iter().enumerate() {
            if t % CHECK_EVERY == 0 {
                budget.check()?;
            }
            for &v in corners {
                members[next[v as usize] as usize] = t as u32;
                next[v as usize] += 1;
            }
        }
        Ok(Self { starts, members })
    }

    /// The triangles around vertex `v`.
    pub(super) fn of_vertex(&self, v: usize) -> &[u32] {
        &self.members[self.starts[v] as usize..self.starts[v + 1] as usize]
    }

    /// True when vertex `v` can be at `to` and every triangle around it still faces about where it did.
    pub(super) fn may_move(&self, v: usize, to: DVec3, triangles: &[[u32; 3]], places: &[DVec3]) -> bool {
        self.of_vertex(v).iter().all(|&t| {
            let old = triangles[t as usize].map(|w| places[w as usize]);
            let new = triangles[t as usize].map(|w| if w as usize == v { to } else { places[w as usize] });
            let (before, after) = (normal(old), normal(new));
            let longest = (new[1] - new[0])
                .length_squared()
                .max((new[2] - new[1]).length_squared())
                .max((new[0] - new[2]).length_squared());
            let size = after.length();
            size > HEIGHT * longest && after.dot(before) >= TURN_COS * size * before.length()
        })
    }
}

fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}
