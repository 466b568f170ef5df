//! What this process knows of jobs that have not ended: how to stop their runs and how to wait for their end.

use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use tokio::sync::{Notify, watch};
use tokio_util::sync::CancellationToken;

use super::clock::StageClock;
use super::store::{ClaimRef, JobId};
use crate::budget::StopFlag;

/// One claim of a job, or a job that waits for one.
#[derive(Debug, Default)]
pub(super) struct Live {
    pub(super) stop: StopFlag,
    /// Set when the caller has cancelled the job.
    is_cancelled: AtomicBool,
    /// Set when the claim is void: what the run gives is in vain.
    pub(super) is_void: OnceLock<()>,
    /// Set when the server, not the caller, ends the run.
    pub(super) is_drained: OnceLock<()>,
    /// Set when the run takes longer than a slot for small jobs is for.
    pub(super) is_outgrown: OnceLock<()>,
    /// The claim by which the job runs; 0: it waits.
    pub(super) epoch: u32,
    /// Wakes who renews the claim: another server has done something with the job.
    pub(super) heard: Notify,
    /// What is heard of the run.
    pub(super) clock: Option<StageClock>,
    /// Shared by all claims of the job in this process.
    pub(super) job: Arc<ClaimSignals>,
}

/// What all claims of a job share.
#[derive(Debug, Default)]
pub(super) struct ClaimSignals {
    /// Raised when the job has ended or is gone.
    pub(super) ended: CancellationToken,
    /// Counts changes of the job's state.
    pub(super) changes: watch::Sender<u64>,
}

impl Live {
    /// The caller wants the job to end.
    pub(super) fn cancel(&self) {
        self.is_cancelled.store(true, Ordering::SeqCst);
        self.stop.cancel();
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.is_cancelled.load(Ordering::SeqCst)
    }

    /// The claim is void.
    pub(super) fn make_void(&self) {
        // Told twice, the first word stays.
        let _ = self.is_void.set(());
        self.stop.cancel();
    }

    /// Another server has changed something: those who follow the job look at its row, and its run asks whether it is to stop.
    pub(super) fn hear(&self) {
        self.job.changes.send_modify(|count| *count += 1);
        self.heard.notify_one();
    }

    /// The run goes on elsewhere, from its beginning.
    pub(super) fn outgrow(&self) {
        // As above.
        let _ = self.is_outgrown.set(());
        self.stop.cancel();
    }

    /// The server ends.
    pub(super) fn drain(&self) {
        // As above.
        let _ = self.is_drained.set(());
        self.stop.cancel();
    }
}

/// All of them.
#[derive(Debug, Default)]
pub(super) struct LiveJobs(Mutex<HashMap<JobId, Arc<Live>>>);

impl LiveJobs {
    /// The job's entry, made if there is none. Whoever calls this looks afterwards whether the job has ended meanwhile,
    /// and calls [`end`](Self::end) if so.
    pub(super) fn watch(&self, id: JobId) -> Arc<Live> {
        Arc::clone(self.lock().entry(id).or_default())
    }

    /// As [`watch`](Self::watch), and the job is cancelled, also when it comes into a slot only now.
    pub(super) fn cancel(&self, id: JobId) {
        self.lock().entry(id).or_default().cancel();
    }

    /// A slot has claimed the job.
    pub(super) fn begin(&self, claim: ClaimRef, clock: StageClock) -> Arc<Live> {
        let id = claim.id;
        let mut jobs = self.lock();
        let before = jobs.remove(&id);
        let job = before.as_ref().map(|live| Arc::clone(&live.job)).unwrap_or_default();
        let live = Arc::new(Live { job, epoch: claim.epoch, clock: Some(clock), ..Live::default() });
        if before.is_some_and(|live| live.is_cancelled()) {
            live.cancel();
        }
        live.job.changes.send_modify(|count| *count += 1);
        jobs.insert(id, Arc::clone(&live));
        live
    }

    pub(super) fn get(&self, id: JobId) -> Option<Arc<Live>> {
        self.lock().get(&id).cloned()
    }

    /// The job waits for a slot again: those who follow it hear of it.
    pub(super) fn requeue(&self, id: JobId) {
        if let Some(live) = self.get(id) {
            live.job.changes.send_modify(|count| *count += 1);
        }
    }

    /// The job has ended: those who wait for it go on.
    pub(super) fn end(&self, id: JobId) {
        let live = self.lock().remove(&id);
        if let Some(live) = live {
            live.job.ended.cancel();
        }
    }

    /// The claim is over; the job may go on by another one, whose entry stays.
    pub(super) fn forget(&self, id: JobId, live: &Arc<Live>) {
        let mut jobs = self.lock();
        if jobs.get(&id).is_some_and(|known| Arc::ptr_eq(known, live)) {
            jobs.remove(&id);
            // Those who wait look at the row, and wait anew.
            live.job.ended.cancel();
        }
    }

    pub(super) fn all(&self) -> Vec<(JobId, Arc<Live>)> {
        self.lock().iter().map(|(&id, live)| (id, Arc::clone(live))).collect()
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, HashMap<JobId, Arc<Live>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::Operation;

    fn begin(jobs: &LiveJobs, id: JobId, epoch: u32) -> Arc<Live> {
        jobs.begin(ClaimRef { id, epoch }, StageClock::start(Operation::Repair))
    }

    #[test]
    fn who_cancels_a_job_before_a_slot_takes_it_is_heard() {
        let (jobs, id) = (LiveJobs::default(), JobId::unique());
        jobs.cancel(id);
        assert!(begin(&jobs, id, 1).is_cancelled());
    }

    #[test]
    fn a_void_claim_does_not_stop_the_next_one_and_waiters_stay_with_the_job() {
        let (jobs, id) = (LiveJobs::default(), JobId::unique());
        let waiting = jobs.watch(id);
        let first = begin(&jobs, id, 1);
        first.make_void();
        let second = begin(&jobs, id, 2);
        assert!(!second.is_cancelled());
        jobs.forget(id, &first);
        assert!(!waiting.job.ended.is_cancelled(), "the second claim goes on");
        jobs.end(id);
        assert!(waiting.job.ended.is_cancelled() && jobs.get(id).is_none());
    }
}
