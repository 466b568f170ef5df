//! Locks of the database that a transaction holds until its end, where one row is not what must not change.

use super::rows::value;
use super::session::Session;
use crate::jobs::store::StoreError;

/// The tables are brought to a new version.
pub(super) const SCHEMA: i32 = 0x6d65_0001;
/// Jobs come in: how many wait is counted, and one is added.
pub(super) const ARRIVALS: i32 = 0x6d65_0002;
/// A job of a tenant is claimed: how many of it run is counted, and one is added. With a digest of the tenant.
const SHARE: i32 = 0x6d65_0003;
/// Files lose their names: whether another row names one is asked, and the name goes.
pub(super) const NAMES: i32 = 0x6d65_0004;
/// Deliveries are claimed.
pub(super) const OUTBOX: i32 = 0x6d65_0005;
/// Uploads that come before their job are made: how many there are is counted, and one is added.
pub(super) const UPLOADS: i32 = 0x6d65_0006;

/// Waits until nobody else holds the lock.
pub(super) async fn hold(session: &Session, lock: i32) -> Result<(), StoreError> {
    session.change("SELECT pg_advisory_xact_lock($1, 0)", &[&lock]).await.map(drop)
}

/// Waits until nobody else claims a job of this tenant, or nobody else for this worker.
pub(super) async fn hold_share(
    session: &Session,
    tenant: &str,
    worker: Option<&str>,
) -> Result<(), StoreError> {
    let sql = "SELECT pg_advisory_xact_lock($1, hashtext($2::text || coalesce(' ' || $3::text, '')))";
    session.change(sql, &[&SHARE, &tenant, &worker]).await.map(drop)
}

/// The same without a wait: whether nobody does.
pub(super) async fn try_hold_share(
    session: &Session,
    tenant: &str,
    worker: Option<&str>,
) -> Result<bool, StoreError> {
    let sql = "SELECT pg_try_advisory_xact_lock($1, hashtext($2::text || coalesce(' ' || $3::text, '')))";
    value(&session.row(sql, &[&SHARE, &tenant, &worker]).await?, 0)
}
