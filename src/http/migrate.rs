//! From a configuration to jobs that are carried over.

use super::shared_stores::shared_stores;
use crate::config::Loaded;
use crate::jobs::{self, Migrated};

/// Carries what is in the data directory over to the database and the bucket that the configuration names.
///
/// # Errors
/// A [`ConfigError`](crate::config::ConfigError) where it names none, and what stands in the way.
pub fn migrate(loaded: &Loaded) -> anyhow::Result<Migrated> {
    let Some(shared) = shared_stores(loaded)? else {
        return Err(loaded
            .refused("database_url", &"name where jobs are to go: set database_url and blobs_url")
            .into());
    };
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build()?;
    Ok(runtime.block_on(jobs::migrate(&loaded.config.data_dir, &shared))?)
}
