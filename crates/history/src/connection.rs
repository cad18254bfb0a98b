//! Connections to the file.
//!
//! The journal is SQLite's rollback journal and not its write-ahead log. With it, a history is one file whenever nobody
//! writes, so it can be copied, cached between jobs and read from a folder that cannot be written to. The log would let
//! readers and a writer work at once, but a writer is done in seconds, and readers hold no lock between two questions:
//! rows are never changed, so what a reader found when it began stays true.

use crate::error::HistoryError;
use crate::schema::{self, Found, MIGRATIONS, SCHEMA};
use rusqlite::{Connection, OpenFlags};
use std::fs;
use std::path::Path;
use std::time::Duration;

/// The longest time that a process waits for others.
pub(crate) const PATIENCE: Duration = Duration::from_secs(60);

/// KiB of pages that are held in memory.
const CACHE_KIB: i64 = 256 << 10;

/// Opens a file for writing, which is made when it does not exist.
pub(crate) fn for_writing(path: &Path, patience: Duration) -> Result<Connection, HistoryError> {
    if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
        fs::create_dir_all(folder).map_err(HistoryError::io("create", folder))?;
    }
    let flags = OpenFlags::SQLITE_OPEN_READ_WRITE | OpenFlags::SQLITE_OPEN_CREATE;
    let mut connection = open(path, flags, patience)?;
    schema::migrate(path, &mut connection, &MIGRATIONS)?;
    let set = |name: &str, value: i64| {
        connection
            .pragma_update(None, name, value)
            .map_err(HistoryError::database(path))
    };
    // A transaction that spills its pages early would keep readers out until its end.
    set("cache_size", -CACHE_KIB)?;
    set("cache_spill", 0)?;
    Ok(connection)
}

/// Opens a file for reading. An older schema is brought up to date, which needs permission to write.
pub(crate) fn for_reading(path: &Path, patience: Duration) -> Result<Connection, HistoryError> {
    if !path.try_exists().unwrap_or(true) {
        return Err(HistoryError::None {
            path: path.to_owned(),
        });
    }
    // What a killed writer left half done is undone by the next process, which must be able to write for that. SQLite
    // reads a file without that permission all the same.
    let mut connection = open(path, OpenFlags::SQLITE_OPEN_READ_WRITE, patience)?;
    match schema::look(path, &connection)? {
        // As a file is that another process is making.
        Found::Empty => {
            return Err(HistoryError::None {
                path: path.to_owned(),
            });
        }
        Found::Schema(schema) if schema == SCHEMA => {}
        Found::Schema(_) => schema::migrate(path, &mut connection, &MIGRATIONS)?,
    }
    let set = |name: &str, value: i64| {
        connection
            .pragma_update(None, name, value)
            .map_err(HistoryError::database(path))
    };
    set("query_only", 1)?;
    set("cache_size", -CACHE_KIB / 4)?;
    Ok(connection)
}

fn open(path: &Path, flags: OpenFlags, patience: Duration) -> Result<Connection, HistoryError> {
    let wrong = HistoryError::database(path);
    let connection = Connection::open_with_flags(path, flags | OpenFlags::SQLITE_OPEN_NO_MUTEX)
        .map_err(&wrong)?;
    connection.busy_timeout(patience).map_err(&wrong)?;
    connection.set_prepared_statement_cache_capacity(64);
    Ok(connection)
}
