//! Costs of many edges at once: of all at the start, and of those whose turn is near.

use super::Strict;
use crate::budget::{CHECK_EVERY, Stopped};
use crate::mesh::corner_table::{NONE, next, prev};
use crate::par;
use crate::simplify::criterion::{Criterion, Reach};
use crate::simplify::key::Key;
use crate::simplify::queue::Queue;

/// Edges whose surroundings are fetched together.
const BATCH: usize = 32;
/// Edges whose costs are computed by one task; a multiple of [`BATCH`].
const SHARE: usize = 1024;
/// Steps around each end of an edge that are fetched; most vertices have six triangles.
const RING: usize = 6;

impl<C: Criterion> Strict<'_, C> {
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

    /// Moves the edges whose turn is near into the queue's heap, with costs as they are now; false when there are none.
    pub(super) fn bring_near(&mut self) -> Result<bool, Stopped> {
        let Some(items) = self.queue.next_bucket() else { return Ok(false) };
        if C::REACH != Reach::StarGrows {
            items.into_iter().for_each(|(h, key)| self.queue.set(h, key));
            return Ok(true);
        }
        let costs = par::try_map_ranges(items.len(), SHARE, |range| {
            self.budget.check()?;
            let mut costs = Vec::with_capacity(range.len());
            for batch in items[range].chunks(BATCH) {
                self.fetch(batch);
                costs.extend(batch.iter().map(|&(h, _)| self.cost(h)));
            }
            Ok(costs)
        })?;
        for (&(h, key), cost) in items.iter().zip(costs.into_iter().flatten()) {
            match cost {
                Ok(now) => self.queue.set(h, now.max(key)),
                Err(reason) => self.set_aside(h, reason),
            }
        }
        items.chunks(BATCH).for_each(|batch| self.fetch_rings(batch));
        Ok(true)
    }

    /// Reads what the costs of a batch of edges need. Nothing depends on it: these reads do not wait for one another,
    /// so that the vertices are in the cache when the costs are computed, one after the other.
    fn fetch(&self, batch: &[(u32, Key)]) {
        let mut ends = [[0u32; 2]; BATCH];
        for (ends, &(h, _)) in ends.iter_mut().zip(batch) {
            *ends = [h, next(h)].map(|g| self.surface.table.origin(g));
        }
        let mut sum = 0u64;
        for &v in ends[..batch.len()].as_flattened() {
            let vertex = self.surface.vertex(v);
            sum ^= u64::from(vertex.origin) ^ vertex.position.x.to_bits();
        }
        std::hint::black_box(sum);
    }

    /// Reads what is around a batch of edges, step by step around all of them, for the same reason.
    fn fetch_rings(&self, batch: &[(u32, Key)]) {
        let (table, mut walks, mut count) = (&self.surface.table, [0u32; 2 * BATCH], 0);
        for &(h, _) in batch.iter().filter(|&&(h, _)| self.queue.is_near(h)) {
            walks[count] = h;
            walks[count + 1] = next(h);
            count += 2;
        }
        let mut sum = 0u64;
        for _ in 0..RING {
            for corner in &mut walks[..count] {
                let beyond = table.twin(prev(*corner));
                if beyond != NONE {
                    *corner = beyond;
                }
                sum ^= self.surface.position(table.destination(*corner)).x.to_bits();
            }
        }
        std::hint::black_box(sum);
    }
}
