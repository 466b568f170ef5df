//! Whom jobs, files and places are charged to.

use std::fmt;
use std::sync::Arc;

/// Whom a job is charged to: the holder of a key, or the address of a caller without one. What it shares with others (the
/// queue, slots, room for results) is shared by tenants.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Tenant(Arc<str>);

impl Tenant {
    /// The tenant of this name.
    pub fn named(name: impl Into<Arc<str>>) -> Self {
        Self(name.into())
    }

    /// Nobody is known: jobs of programs that use this library for themselves alone. No share is kept from such a tenant.
    pub fn nobody() -> Self {
        Self(Arc::from(""))
    }

    /// Whether nobody is known.
    pub fn is_nobody(&self) -> bool {
        self.0.is_empty()
    }

    /// The name; empty when nobody is known.
    pub fn name(&self) -> &str {
        &self.0
    }
}

impl Default for Tenant {
    fn default() -> Self {
        Self::nobody()
    }
}

impl fmt::Display for Tenant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// What a tenant has, and what all have.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Holding {
    /// Its jobs in any state.
    pub jobs: u64,
    /// Those that wait for a slot.
    pub queued: u64,
    /// Bytes of its uploads whose jobs have not ended, and of those that no job has taken yet.
    pub open_bytes: u64,
    /// The same of all tenants together.
    pub open_bytes_of_all: u64,
    /// Bytes of its files, each counted for every job or upload that names it.
    pub bytes: u64,
}

impl Holding {
    /// The same with the bytes of uploads that no job has taken yet: of the tenant, and of all.
    pub(in crate::jobs) fn with_uploads(self, own: u64, all: u64) -> Self {
        Self {
            open_bytes: self.open_bytes.saturating_add(own),
            open_bytes_of_all: self.open_bytes_of_all.saturating_add(all),
            bytes: self.bytes.saturating_add(own),
            ..self
        }
    }
}
