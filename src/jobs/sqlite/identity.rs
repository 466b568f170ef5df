//! The mark by which a store and its files know each other.

use std::path::Path;

use rusqlite::{Connection, OpenFlags, OptionalExtension as _};

use super::schema::SqliteOpenError;

/// What a file is as a store.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum StoreFile {
    /// It is not there, or nothing is in it.
    Empty,
    /// A store without a mark: an older program made it.
    Unmarked,
    /// A store with this mark.
    Marked(String),
}

pub(super) fn look_at(path: &Path) -> Result<StoreFile, SqliteOpenError> {
    if !path.try_exists().map_err(SqliteOpenError::File)? {
        return Ok(StoreFile::Empty);
    }
    // Not to read only: what a killed server left beside the file is taken in.
    let connection = Connection::open_with_flags(path, OpenFlags::SQLITE_OPEN_READ_WRITE)?;
    if !has_table(&connection, "jobs")? {
        return Ok(StoreFile::Empty);
    }
    if !has_table(&connection, "identity")? {
        return Ok(StoreFile::Unmarked);
    }
    let mark = connection.query_row("SELECT mark FROM identity", [], |row| row.get(0)).optional()?;
    Ok(mark.map_or(StoreFile::Unmarked, StoreFile::Marked))
}

/// Whether there is such a table, which an older program may not have made.
fn has_table(connection: &Connection, name: &str) -> Result<bool, SqliteOpenError> {
    let mut statement =
        connection.prepare("SELECT 1 FROM sqlite_schema WHERE type = 'table' AND name = ?1")?;
    Ok(statement.exists([name])?)
}

/// Whether a row of the store at `path` names one of these files.
pub(super) fn names_any(path: &Path, keys: &[&str]) -> Result<bool, SqliteOpenError> {
    let connection = Connection::open_with_flags(path, OpenFlags::SQLITE_OPEN_READ_WRITE)?;
    for table in ["names", "pieces"] {
        if !has_table(&connection, table)? {
            continue;
        }
        let mut statement = connection.prepare(&format!("SELECT 1 FROM {table} WHERE key = ?1"))?;
        for key in keys {
            if statement.exists([key])? {
                return Ok(true);
            }
        }
    }
    Ok(false)
}

pub(super) fn set_mark(path: &Path, mark: &str) -> Result<(), SqliteOpenError> {
    let connection = Connection::open(path)?;
    connection.execute_batch("BEGIN IMMEDIATE; DELETE FROM identity")?;
    connection.execute("INSERT INTO identity VALUES (?1)", [mark])?;
    Ok(connection.execute_batch("COMMIT")?)
}
