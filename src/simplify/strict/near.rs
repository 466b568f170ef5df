//! What is done for many edges at once: the costs of all at the start, and reads for those whose turn is near.

use super::Strict;
use crate::budget::{CHECK_EVERY, Stopped};
use crate::mesh::corner_table::{NONE, next, prev};
use crate::par;
use crate::simplify::criterion::CollapseCriterion;
use crate::simplify::queue::{AHEAD, Queue};

/// Steps around each end of an edge that are fetched; most vertices have six triangles.
const RING: usize = 6;

impl<C: CollapseCriterion> Strict<'_, C> {
    /// Computes the costs of all edges, on all cores.
    pub(super) fn fill_queue(&mut self) -> Result<(), Stopped> {
        let count = self.surface.table.triangle_bound();
        let parts = par::try_map_ranges(count, 1 << 14, |range| {
            let mut items = Vec::with_capacity(range.len() * 3 / 2);
            let mut aside = Vec::new();
            for t in range.clone() {
                if t % CHECK_EVERY == 0 {
                    self.budget.check()?;
                }
                for h in [4 * t as u32, 4 * t as u32 + 1, 4 * t as u32 + 2] {
                    if self.surface.table.edge(h) == h {
                        match self.cost(h) {
                            Ok(key) => items.push((h, key)),
                            Err(reason) => aside.push((h, reason)),
                        }
                    }
                }
            }
            Ok((items, aside))
        })?;
        let (items, aside): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
        self.queue = Queue::new(&items.concat(), count * 4);
        for (h, reason) in aside.concat() {
            self.set_aside(h, reason);
        }
        Ok(())
    }

    /// Reads what is around the edges whose turn is near, step by step around all of them. Nothing depends on it: these
    /// reads do not wait for one another, so that what a collapse needs is in the cache when its turn comes.
    #[inline]
    pub(super) fn fetch_ahead(&mut self) {
        let (surface, mut walks, mut count) = (&self.surface, [0u32; 2 * AHEAD], 0);
        for h in self.queue.ahead() {
            walks[count] = h;
            walks[count + 1] = next(h);
            count += 2;
        }
        if count == 0 {
            return;
        }
        let mut sum = 0u64;
        for _ in 0..RING {
            for corner in &mut walks[..count] {
                let beyond = surface.table.twin(prev(*corner));
                if beyond != NONE {
                    *corner = beyond;
                }
                let vertex = surface.vertex(surface.table.destination(*corner));
                sum ^= vertex.position.x.to_bits() ^ u64::from(vertex.origin);
            }
        }
        std::hint::black_box(sum);
    }
}
