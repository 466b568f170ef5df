//! Memory shared among the jobs that run: a job waits until what it will probably take is free.

use std::fs;
use std::io::{self, Read as _};
use std::sync::Arc;
use std::time::Duration;

use tokio::sync::{OwnedSemaphorePermit, Semaphore};

use super::estimate::estimated_bytes;
use super::live::Live;
use super::settings::JobsSettings;
use super::spool::Spool;
use super::store::{JobRow, Lane};
use crate::formats::triangles_at_most;

/// The unit of account, in bytes: semaphores count up to 2^32 permits.
const UNIT: u64 = 1 << 20;

/// Pause between two looks whether a run that waits for memory is to stop.
const STOP_CHECK: Duration = Duration::from_millis(50);

/// The most that a small job is given at first, in bytes: a rebuilt surface of a part with fine details.
const SMALL_BYTES_MAX: u64 = 1 << 30;
/// The least that it is given, in bytes, however little there is: a part of some thousand triangles.
const SMALL_BYTES_MIN: u64 = 64 << 20;
/// Bytes at the start of an upload that are looked at for what they announce.
const LOOKED_AT_BYTES: u64 = 64 << 10;

/// The memory of all runs. What a run may charge is reserved before it starts; one that comes to need more starts again when
/// there is as much as a job may have at most. Small jobs that somebody waits for have a part of their own, so that none of
/// them waits behind a large one.
#[derive(Debug)]
pub(super) struct Capacity {
    large: Arc<Semaphore>,
    large_units: u32,
    /// What is kept for a small job, in each slot.
    small_bytes: u64,
    /// The most that any job may charge.
    bytes_max: u64,
}

/// Memory that a run has been given, until dropped.
#[derive(Debug)]
pub(super) struct MemoryGrant {
    /// How much it may charge.
    pub(super) bytes: u64,
    /// What is held is given back on drop.
    _held: Option<OwnedSemaphorePermit>,
}

impl Capacity {
    /// The memory that the operator allows; what small jobs may take in all slots is kept for them.
    pub(super) fn of(settings: &JobsSettings) -> Self {
        let slots = (settings.slots + settings.interactive_slots).max(1) as u64;
        // At least half is for large ones.
        let small = (settings.memory_bytes_max / 2 / slots).clamp(SMALL_BYTES_MIN, SMALL_BYTES_MAX);
        let small = small.min(settings.engine_bytes_max);
        let kept = small.saturating_mul(slots).min(settings.memory_bytes_max / 2);
        Self::new(settings.memory_bytes_max, kept, small, settings.engine_bytes_max)
    }

    /// `memory_bytes_max` for all runs together, of which `kept` are for small ones, `small` for each.
    fn new(memory_bytes_max: u64, kept: u64, small: u64, bytes_max: u64) -> Self {
        let large_units = units(memory_bytes_max.saturating_sub(kept)).max(1);
        Self {
            large: Arc::new(Semaphore::new(large_units as usize)),
            large_units,
            small_bytes: small,
            bytes_max,
        }
    }

    /// Waits for room; a small job is given what is kept for it at once. `reserved` is what a large one will probably take
    /// at most; `None`: it took more than that already, and is given all that a job may have. One that is thought to take
    /// more than there is waits until no other large one runs.
    async fn room(&self, lane: Lane, reserved: Option<u64>) -> MemoryGrant {
        let bytes = reserved.unwrap_or(self.bytes_max).min(self.bytes_max);
        if lane == Lane::Interactive {
            return MemoryGrant { bytes: self.small_bytes, _held: None };
        }
        let wanted = units(bytes).clamp(1, self.large_units);
        // Never closed, so there is always a permit in the end.
        MemoryGrant { bytes, _held: Arc::clone(&self.large).acquire_many_owned(wanted).await.ok() }
    }

    /// Waits for the memory of a run; `None`: the run is to stop before there is any.
    pub(super) async fn room_for(
        &self,
        row: &JobRow,
        live: &Live,
        spool: &Arc<Spool>,
    ) -> Option<MemoryGrant> {
        let is_known = row.is_outgrown || row.lane == Lane::Interactive;
        let reserved = if is_known { None } else { Some(reserved_bytes(row, spool).await) };
        let room = self.room(row.lane, reserved);
        tokio::pin!(room);
        loop {
            tokio::select! {
                room = &mut room => return Some(room),
                () = tokio::time::sleep(STOP_CHECK) => {
                    if live.stop.raised().is_some() {
                        return None;
                    }
                }
            }
        }
    }
}

/// What a job will probably take at most, as its upload begins.
async fn reserved_bytes(row: &JobRow, spool: &Arc<Spool>) -> u64 {
    let (spool, key) = (Arc::clone(spool), row.input.key.clone());
    let reading = tokio::task::spawn_blocking(move || {
        let mut start = Vec::new();
        fs::File::open(spool.path(&key)?)?.take(LOOKED_AT_BYTES).read_to_end(&mut start)?;
        Ok::<_, io::Error>(start)
    });
    // A file that cannot be read ends its job soon enough.
    let start = reading.await.ok().and_then(Result::ok).unwrap_or_default();
    // Of several meshes only the first is at the start.
    let is_one = row.input.file_count() == 1;
    let triangles = triangles_at_most(&start, row.input.bytes).filter(|_| is_one);
    estimated_bytes(row.operation, row.options.format, row.input.bytes, triangles)
}

fn units(bytes: u64) -> u32 {
    u32::try_from(bytes.div_ceil(UNIT)).unwrap_or(u32::MAX / 8)
}

#[cfg(test)]
mod tests {
    use super::*;

    const GIB: u64 = 1 << 30;

    async fn is_let_in(capacity: &Capacity, lane: Lane, bytes: u64) -> bool {
        tokio::time::timeout(Duration::from_millis(50), capacity.room(lane, Some(bytes))).await.is_ok()
    }

    #[tokio::test]
    async fn large_jobs_run_side_by_side_while_there_is_memory_and_small_ones_never_wait_for_it() {
        let capacity = Capacity::new(4 * GIB, GIB, GIB / 4, 4 * GIB);
        let first = capacity.room(Lane::Bulk, Some(2 * GIB)).await;
        assert_eq!(first.bytes, 2 * GIB, "a run may charge what is reserved for it");
        assert!(is_let_in(&capacity, Lane::Bulk, GIB).await);
        assert!(!is_let_in(&capacity, Lane::Bulk, 2 * GIB).await);
        assert_eq!(capacity.room(Lane::Interactive, Some(100 << 20)).await.bytes, GIB / 4);
        drop(first);
        assert!(is_let_in(&capacity, Lane::Bulk, 2 * GIB).await);
    }

    #[tokio::test]
    async fn a_job_that_is_thought_too_large_runs_alone() {
        let capacity = Capacity::new(GIB, 0, GIB, 4 * GIB);
        let alone = capacity.room(Lane::Bulk, Some(100 * GIB)).await;
        assert_eq!(alone.bytes, 4 * GIB, "as much as a job may have at most");
        assert!(!is_let_in(&capacity, Lane::Bulk, 1).await);
        drop(alone);
        assert!(is_let_in(&capacity, Lane::Bulk, 1).await);
    }

    #[tokio::test]
    async fn a_job_that_has_outgrown_its_room_waits_for_as_much_as_a_job_may_have() {
        let capacity = Capacity::new(4 * GIB, 0, GIB, 4 * GIB);
        let small = capacity.room(Lane::Bulk, Some(GIB)).await;
        let mut large = std::pin::pin!(capacity.room(Lane::Bulk, None));
        assert!(tokio::time::timeout(Duration::from_millis(50), &mut large).await.is_err());
        drop(small);
        assert_eq!(large.await.bytes, 4 * GIB);
    }

    #[test]
    fn small_jobs_have_at_most_half_of_the_memory_together() {
        let of = |memory_bytes_max| {
            let settings =
                JobsSettings { slots: 2, interactive_slots: 2, memory_bytes_max, ..JobsSettings::new("d") };
            let capacity = Capacity::of(&settings);
            (capacity.small_bytes, u64::from(capacity.large_units) * UNIT)
        };
        assert_eq!(of(16 * GIB), (GIB, 12 * GIB));
        assert_eq!(of(GIB), (128 << 20, GIB / 2));
        assert_eq!(of(1 << 20), (SMALL_BYTES_MIN, UNIT));
    }
}
