//! Connections to the database file.
//!
//! The file uses SQLite's rollback journal, not its write-ahead log. A history is then a single file
//! whenever no process writes, so it can be copied, cached between jobs and read from a read-only folder.
//! The log would let readers and a writer work at once. But a writer is done in seconds, and readers hold
//! no lock between queries: rows are never changed, so what a reader found at first stays true.

use crate::error::HistoryError;
use crate::schema::{self, FoundSchema, MIGRATIONS, SCHEMA};
use etalon_record::check_folder;
use rusqlite::{Connection, OpenFlags};
use std::fs::{self, File};
use std::path::Path;
use std::time::Duration;

/// The longest time that a process waits for others.
pub(crate) const PATIENCE: Duration = Duration::from_secs(60);

/// The size of the page cache in KiB.
const CACHE_KIB: i64 = 256 << 10;

/// Opens a file for writing, and creates it if it does not exist.
pub(crate) fn for_writing(path: &Path, patience: Duration) -> Result<Connection, HistoryError> {
    check_folder(path.parent().unwrap_or(path))?;
    if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
        fs::create_dir_all(folder).map_err(HistoryError::io("create", folder))?;
    }
    // SQLite does not say why it cannot create a file.
    if !path.try_exists().unwrap_or(false) {
        let mut options = File::options();
        let created = options.append(true).create(true).open(path);
        created.map_err(HistoryError::io("create", path))?;
    }
    let mut connection = open(path, OpenFlags::SQLITE_OPEN_READ_WRITE, patience)?;
    schema::migrate(path, &mut connection, &MIGRATIONS)?;
    let set = |name: &str, value: i64| {
        connection
            .pragma_update(None, name, value)
            .map_err(HistoryError::database(path))
    };
    // A transaction that spills its pages early would keep readers out until it ends.
    set("cache_size", -CACHE_KIB)?;
    set("cache_spill", 0)?;
    Ok(connection)
}

/// Opens a file for reading. An older schema is migrated first, which needs permission to write.
pub(crate) fn for_reading(path: &Path, patience: Duration) -> Result<Connection, HistoryError> {
    check_folder(path.parent().unwrap_or(path))?;
    if !path.try_exists().map_err(HistoryError::io("read", path))? {
        return Err(HistoryError::None {
            path: path.to_owned(),
        });
    }
    // If a killed writer left a transaction half done, the next process rolls it back, and needs permission
    // to write for that. Without that permission, SQLite still opens the file for reading.
    let mut connection = open(path, OpenFlags::SQLITE_OPEN_READ_WRITE, patience)?;
    match schema::look(path, &connection)? {
        // Another process may be creating the file.
        FoundSchema::Empty => {
            return Err(HistoryError::None {
                path: path.to_owned(),
            });
        }
        FoundSchema::Schema(schema) if schema == SCHEMA => {}
        FoundSchema::Schema(_) => schema::migrate(path, &mut connection, &MIGRATIONS)?,
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
    // Opening a pipe waits until another process writes to it.
    if fs::metadata(path).is_ok_and(|found| !found.is_file()) {
        return Err(HistoryError::Other {
            path: path.to_owned(),
        });
    }
    let connection = Connection::open_with_flags(path, flags | OpenFlags::SQLITE_OPEN_NO_MUTEX)
        .map_err(&wrong)?;
    connection.busy_timeout(patience).map_err(&wrong)?;
    connection.set_prepared_statement_cache_capacity(64);
    Ok(connection)
}
