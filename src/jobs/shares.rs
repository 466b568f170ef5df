//! Room that jobs which have not ended take from others: no tenant has more of it than is left for the rest.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::pace::Pace;
use super::problems::store_problem;
use super::spool::Spool;
use super::store::{JobStore, Tenant};
use crate::wire::{Problem, ProblemCode};

/// Uploads that come in.
pub(super) struct Incoming {
    store: Arc<dyn JobStore>,
    spool: Arc<Spool>,
    pace: Arc<Pace>,
    /// Bytes of uploads that are not jobs yet, by tenant.
    bytes: Mutex<HashMap<Tenant, u64>>,
}

impl Incoming {
    pub(super) fn new(store: Arc<dyn JobStore>, spool: Arc<Spool>, pace: Arc<Pace>) -> Arc<Self> {
        Arc::new(Self { store, spool, pace, bytes: Mutex::default() })
    }

    fn lock(&self) -> MutexGuard<'_, HashMap<Tenant, u64>> {
        self.bytes.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Those of one tenant, and of all.
    fn of(&self, tenant: &Tenant) -> (u64, u64) {
        let bytes = self.lock();
        (bytes.get(tenant).copied().unwrap_or_default(), bytes.values().sum())
    }

    fn add(&self, tenant: &Tenant, more: u64) {
        *self.lock().entry(tenant.clone()).or_default() += more;
    }

    fn take(&self, tenant: &Tenant, fewer: u64) {
        let mut bytes = self.lock();
        if let Some(own) = bytes.get_mut(tenant) {
            *own = own.saturating_sub(fewer);
            if *own == 0 {
                bytes.remove(tenant);
            }
        }
    }

    /// Refuses `bytes` more of uploads whose jobs have not ended when the tenant would have more than what is free: one alone
    /// has half of the room at most, two a third each. An upload that is the only one has all the room there is.
    /// `here`: how many it has by the upload that grows; `instead_of`: how many go when it is complete.
    pub(super) async fn check(
        &self,
        tenant: &Tenant,
        here: u64,
        instead_of: u64,
        bytes: u64,
    ) -> Result<(), Problem> {
        if tenant.is_nobody() {
            return Ok(());
        }
        let holding = self.store.holding(tenant.clone()).await.map_err(|error| store_problem(&error))?;
        let (own, all) = self.of(tenant);
        let own = holding.open_bytes.saturating_sub(instead_of).saturating_add(own);
        let all = holding.open_bytes_of_all.saturating_sub(instead_of).saturating_add(all);
        // An upload that is the only one of its tenant may fill what others leave.
        let limit = self.spool.bytes_max().saturating_sub(if own == here { all - own.min(all) } else { all });
        if own.saturating_add(bytes) <= limit {
            return Ok(());
        }
        let detail = "uploads of this caller whose jobs have not ended fill its share of the data directory";
        Err(Problem {
            retry_after_s: Some(self.pace.retry_after_s()),
            ..Problem::new(ProblemCode::StorageFull, detail).with_limit(
                "owner_data_bytes_max",
                limit,
                Some(own.saturating_add(bytes)),
            )
        })
    }
}

/// Bytes of one upload, until it is a job or gone.
pub(super) struct IncomingBytes {
    incoming: Arc<Incoming>,
    tenant: Tenant,
    bytes: u64,
    /// How many of the tenant go when these have come.
    instead_of: u64,
}

impl std::fmt::Debug for IncomingBytes {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("IncomingBytes").field("bytes", &self.bytes).finish_non_exhaustive()
    }
}

impl IncomingBytes {
    pub(super) fn none(incoming: Arc<Incoming>, tenant: Tenant, instead_of: u64) -> Self {
        Self { incoming, tenant, bytes: 0, instead_of }
    }

    pub(super) fn tenant(&self) -> &Tenant {
        &self.tenant
    }

    /// Adds bytes, unless the tenant has its share.
    pub(super) async fn grow(&mut self, bytes: u64) -> Result<(), Problem> {
        self.incoming.check(&self.tenant, self.bytes, self.instead_of, bytes).await?;
        self.incoming.add(&self.tenant, bytes);
        self.bytes += bytes;
        Ok(())
    }
}

impl Drop for IncomingBytes {
    fn drop(&mut self) {
        self.incoming.take(&self.tenant, self.bytes);
    }
}
