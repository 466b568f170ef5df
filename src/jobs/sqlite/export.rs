//! The rows of a store of which no server makes use, for another store.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use rusqlite::Connection;
use rusqlite::types::ValueRef;

use super::schema::{self, SqliteOpenError};
use crate::jobs::store::tables::{Column, ColumnTexts, Table};
use crate::jobs::store::{BlobRef, StoreError};

/// What stands beside the file of a store while it is used, or after its server was killed.
const LOG_SUFFIX: &str = "-wal";

/// The rows of a store, as they were when it was opened.
pub(in crate::jobs) struct Export {
    connection: Connection,
}

impl Export {
    /// Opens a copy, in `folder`, of the store at `path`, which stays as it is, also where it is of an older version or its
    /// server was killed. Nobody may write to it meanwhile. Blocks.
    pub(in crate::jobs) fn of_copy(path: &Path, folder: &Path) -> Result<Self, SqliteOpenError> {
        let copy = folder.join("rows");
        for suffix in ["", LOG_SUFFIX] {
            let (from, to) = (with_suffix(path, suffix), with_suffix(&copy, suffix));
            match fs::copy(&from, &to) {
                Ok(_) => {}
                Err(error) if error.kind() == std::io::ErrorKind::NotFound && !suffix.is_empty() => {}
                Err(error) => return Err(SqliteOpenError::File(error)),
            }
        }
        let mut connection = Connection::open(copy)?;
        schema::migrate(&mut connection)?;
        Ok(Self { connection })
    }

    /// Every file that a row names, once. Blocks.
    pub(in crate::jobs) fn blobs(&self) -> Result<Vec<BlobRef>, StoreError> {
        let mut statement =
            self.connection.prepare("SELECT key, max(blob) FROM names GROUP BY key ORDER BY key")?;
        let blobs = statement.query_map([], |row| super::rows::json(row, 1))?;
        Ok(blobs.collect::<Result<_, _>>()?)
    }

    /// Gives every row of a table to `take`, until that one wants no more. Blocks.
    pub(in crate::jobs) fn rows(
        &self,
        table: &Table,
        mut take: impl FnMut(ColumnTexts) -> bool,
    ) -> Result<(), StoreError> {
        let mut list = String::new();
        for (number, column) in table.columns.iter().enumerate() {
            let comma = if number > 0 { ", " } else { "" };
            let _ = write!(list, "{comma}{}", expression(table.name, column.name()));
        }
        let mut statement = self.connection.prepare(&format!("SELECT {list} FROM {}", table.name))?;
        let mut rows = statement.query([])?;
        while let Some(row) = rows.next()? {
            let cells =
                table.columns.iter().enumerate().map(|(number, &column)| cell(column, row.get_ref(number)?));
            if !take(cells.collect::<Result<_, StoreError>>()?) {
                break;
            }
        }
        Ok(())
    }
}

/// What is read for a column that the table has not, or not as it is to be.
fn expression(table: &str, column: &'static str) -> &'static str {
    match (table, column) {
        ("jobs", "input_bytes") => "input ->> 'bytes'",
        ("jobs", "file_bytes") => {
            "(SELECT coalesce(sum(blob ->> 'bytes'), 0) FROM names WHERE names.job = jobs.id)"
        }
        // Its server is gone: whoever looks for runs that are lost finds it.
        ("jobs", "lease_until") => "iif(state = 'running', 0, NULL)",
        ("names", "bytes") => "blob ->> 'bytes'",
        _ => column,
    }
}

fn cell(column: Column, value: ValueRef<'_>) -> Result<Option<String>, StoreError> {
    let unreadable = |what: &str| StoreError::Unavailable(format!("column {} has {what}", column.name()));
    let text = match value {
        ValueRef::Null => return Ok(None),
        ValueRef::Integer(number) => number.to_string(),
        ValueRef::Real(_) => return Err(unreadable("a fraction")),
        ValueRef::Text(text) => {
            String::from_utf8(text.to_vec()).map_err(|_| unreadable("a text that is no UTF-8"))?
        }
        ValueRef::Blob(bytes) => {
            bytes.iter().fold(String::with_capacity(bytes.len() * 2), |mut text, byte| {
                let _ = write!(text, "{byte:02x}");
                text
            })
        }
    };
    Ok(Some(if let Column::Quoted(_) = column { super::rows::to_json(&text)? } else { text }))
}

fn with_suffix(path: &Path, suffix: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(suffix);
    name.into()
}
