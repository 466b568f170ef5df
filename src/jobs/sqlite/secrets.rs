//! Secrets of webhooks that an older program left as they are.

use rusqlite::{Connection, params};

use crate::jobs::store::StoreError;

pub(super) fn seal(
    connection: &Connection,
    seal: &dyn Fn(&str) -> Option<String>,
) -> Result<usize, StoreError> {
    // What stood there is to be gone, not only free.
    connection.execute_batch("PRAGMA secure_delete = ON")?;
    let mut sealed = 0;
    for table in ["jobs", "deliveries"] {
        let mut statement = connection.prepare(&format!(
            "SELECT id, webhook ->> 'secret' FROM {table} WHERE webhook ->> 'secret' IS NOT NULL"
        ))?;
        let found = statement
            .query_map([], |row| Ok((row.get(0)?, row.get(1)?)))?
            .collect::<rusqlite::Result<Vec<(String, String)>>>()?;
        let mut update = connection.prepare(&format!(
            "UPDATE {table} SET webhook = json_set(webhook, '$.secret', ?2) WHERE id = ?1"
        ))?;
        for (id, secret) in found {
            if let Some(secret) = seal(&secret) {
                sealed += update.execute(params![id, secret])?;
            }
        }
    }
    Ok(sealed)
}
