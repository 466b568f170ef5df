//! Memory shared among the jobs that run: a job waits until what it will probably take is free.

use std::fs;
use std::sync::Arc;
use std::time::Duration;

use tokio::sync::{OwnedSemaphorePermit, Semaphore};

use super::estimate::estimated_bytes;
use super::live::Live;
use super::service::Service;
use super::settings::JobsSettings;
use super::store::{JobRow, Lane};
use crate::wire::Operation;

/// The unit of account, in bytes: semaphores count up to 2^32 permits.
const UNIT: u64 = 1 << 20;

/// Pause between two looks whether a run that waits for memory is to stop.
const STOP_CHECK: Duration = Duration::from_millis(50);

/// The memory of all runs. Small jobs that somebody waits for have a part of their own, so that none of them waits
/// behind a large one.
#[derive(Debug)]
pub(super) struct Capacity {
    bulk: Arc<Semaphore>,
    bulk_units: u32,
}

/// Memory that a run has been given, until dropped.
#[derive(Debug)]
pub(super) struct Room {
    /// What is held is given back on drop.
    _held: Option<OwnedSemaphorePermit>,
}

impl Capacity {
    /// The memory that the operator allows; what small jobs may take in all slots is kept for them.
    pub(super) fn of(settings: &JobsSettings) -> Self {
        let each = estimated_bytes(Operation::Repair, None, settings.interactive_bytes_max);
        let slots = (settings.slots + settings.interactive_slots) as u64;
        // At least half is for large ones.
        let kept = each.saturating_mul(slots).min(settings.memory_bytes_max / 2);
        Self::new(settings.memory_bytes_max, kept)
    }

    /// `bytes_max` for all runs together, of which `interactive_bytes` are kept for small ones.
    pub(super) fn new(bytes_max: u64, interactive_bytes: u64) -> Self {
        let bulk_units = units(bytes_max.saturating_sub(interactive_bytes)).max(1);
        Self { bulk: Arc::new(Semaphore::new(bulk_units as usize)), bulk_units }
    }

    /// Waits for room. A job that is thought to take more than there is gets all of it and runs without any other large
    /// one: the estimate is rough, and the limit of each job holds anyway.
    pub(super) async fn room(&self, lane: Lane, estimated_bytes: u64) -> Room {
        if lane == Lane::Interactive {
            return Room { _held: None };
        }
        let wanted = units(estimated_bytes).clamp(1, self.bulk_units);
        // Never closed, so there is always a permit in the end.
        Room { _held: Arc::clone(&self.bulk).acquire_many_owned(wanted).await.ok() }
    }
}

impl Service {
    /// Waits for the memory of a run; `None`: the run is to stop before there is any.
    pub(super) async fn room_for(&self, row: &JobRow, live: &Live) -> Option<Room> {
        let estimated = estimated_bytes(row.operation, row.options.format, row.input.bytes);
        let room = self.capacity.room(row.lane, estimated);
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

fn units(bytes: u64) -> u32 {
    u32::try_from(bytes.div_ceil(UNIT)).unwrap_or(u32::MAX / 8)
}

/// Three quarters of the memory that this process may use: of the machine, or of its control group.
pub(super) fn default_bytes_max() -> u64 {
    let machine = rustix::system::sysinfo();
    let total = machine.totalram;
    let total = total.saturating_mul(u64::from(machine.mem_unit.max(1)));
    let group =
        fs::read_to_string("/sys/fs/cgroup/memory.max").ok().and_then(|text| text.trim().parse().ok());
    total.min(group.unwrap_or(u64::MAX)) / 4 * 3
}

#[cfg(test)]
mod tests {
    use super::*;

    const GIB: u64 = 1 << 30;

    async fn is_let_in(capacity: &Capacity, lane: Lane, bytes: u64) -> bool {
        tokio::time::timeout(Duration::from_millis(50), capacity.room(lane, bytes)).await.is_ok()
    }

    #[tokio::test]
    async fn large_jobs_run_side_by_side_while_there_is_memory_and_small_ones_never_wait_for_it() {
        let capacity = Capacity::new(4 * GIB, GIB);
        let first = capacity.room(Lane::Bulk, 2 * GIB).await;
        assert!(is_let_in(&capacity, Lane::Bulk, GIB).await);
        assert!(!is_let_in(&capacity, Lane::Bulk, 2 * GIB).await);
        assert!(is_let_in(&capacity, Lane::Interactive, 100 << 20).await);
        drop(first);
        assert!(is_let_in(&capacity, Lane::Bulk, 2 * GIB).await);
    }

    #[tokio::test]
    async fn a_job_that_is_thought_too_large_runs_alone() {
        let capacity = Capacity::new(GIB, 0);
        let alone = capacity.room(Lane::Bulk, 100 * GIB).await;
        assert!(!is_let_in(&capacity, Lane::Bulk, 1).await);
        drop(alone);
        assert!(is_let_in(&capacity, Lane::Bulk, 1).await);
    }

    #[test]
    fn the_default_is_a_part_of_the_memory_there_is() {
        let bytes = default_bytes_max();
        assert!(bytes > 64 << 20 && bytes < u64::MAX / 2, "{bytes}");
    }
}
