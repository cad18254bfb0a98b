//! The schema of the file, and the migration of older schemas.
//!
//! Each migration leads from one schema to the next, in its own transaction. A released migration never
//! changes.

use crate::error::HistoryError;
use rusqlite::{Connection, Transaction, TransactionBehavior};
use std::path::Path;

/// The number that distinguishes the file from other databases: "etln".
const APPLICATION: i32 = 0x6574_6c6e;

/// The migrations; the first one creates schema 1 in an empty file.
pub(crate) const MIGRATIONS: [&str; 1] = [include_str!("migrations/1.sql")];

/// The schema that this version writes.
pub const SCHEMA: u32 = MIGRATIONS.len() as u32;

/// The state of a file that was opened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FoundSchema {
    /// The file has no table.
    Empty,
    /// The file is a history with this schema.
    Schema(u32),
}

/// Determines the state of a file.
pub(crate) fn look(path: &Path, connection: &Connection) -> Result<FoundSchema, HistoryError> {
    // A single statement reads one state of all three values: another process can create the tables between
    // two statements.
    let (application, schema, tables): (i32, i32, i64) = connection
        .query_row(
            "SELECT application_id, user_version, (SELECT count(*) FROM sqlite_schema) \
             FROM pragma_application_id, pragma_user_version",
            [],
            |row| Ok((row.get(0)?, row.get(1)?, row.get(2)?)),
        )
        .map_err(HistoryError::database(path))?;
    if application == APPLICATION {
        return Ok(FoundSchema::Schema(
            u32::try_from(schema).unwrap_or(u32::MAX),
        ));
    }
    if application == 0 && schema == 0 && tables == 0 {
        return Ok(FoundSchema::Empty);
    }
    Err(HistoryError::Other {
        path: path.to_owned(),
    })
}

/// Migrates a file to the schema of the last of these migrations.
pub(crate) fn migrate(
    path: &Path,
    connection: &mut Connection,
    migrations: &[&str],
) -> Result<(), HistoryError> {
    let wrong = HistoryError::database(path);
    let known = migrations.len() as u32;
    loop {
        // Another process may migrate at the same time, so only what is read inside the transaction counts.
        let schema = match look(path, connection)? {
            FoundSchema::Empty => 0,
            FoundSchema::Schema(schema) => schema,
        };
        if schema > known {
            return Err(HistoryError::Newer {
                path: path.to_owned(),
                found: schema,
                known,
            });
        }
        if schema == known {
            return Ok(());
        }
        let step = Transaction::new(connection, TransactionBehavior::Immediate).map_err(&wrong)?;
        let now = match look(path, &step)? {
            FoundSchema::Empty => 0,
            FoundSchema::Schema(schema) => schema,
        };
        if now == schema
            && let Some(sql) = migrations.get(schema as usize)
        {
            step.execute_batch(sql).map_err(&wrong)?;
            step.pragma_update(None, "application_id", APPLICATION)
                .map_err(&wrong)?;
            step.pragma_update(None, "user_version", schema + 1)
                .map_err(&wrong)?;
        }
        step.commit().map_err(&wrong)?;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::thread;
    use std::time::Duration;

    fn memory() -> Connection {
        Connection::open_in_memory().unwrap()
    }

    #[test]
    fn every_schema_migrates_to_the_last() {
        let path = Path::new("history.db");
        for from in 0..=MIGRATIONS.len() {
            let mut connection = memory();
            migrate(path, &mut connection, &MIGRATIONS[..from]).unwrap();
            migrate(path, &mut connection, &MIGRATIONS).unwrap();
            let found = look(path, &connection).unwrap();
            assert_eq!(found, FoundSchema::Schema(SCHEMA));
            // Migrating again does nothing.
            migrate(path, &mut connection, &MIGRATIONS).unwrap();
        }
    }

    #[test]
    fn a_file_under_construction_is_empty_or_a_history() {
        let folder = tempfile::tempdir().unwrap();
        for number in 0..50 {
            let path = folder.path().join(format!("{number}.db"));
            let open = || {
                let connection = Connection::open(&path).unwrap();
                connection.busy_timeout(Duration::from_secs(60)).unwrap();
                connection
            };
            let (mut maker, looker) = (open(), open());
            let path = path.as_path();
            thread::scope(|scope| {
                scope.spawn(move || while look(path, &looker).unwrap() == FoundSchema::Empty {});
                migrate(path, &mut maker, &MIGRATIONS).unwrap();
            });
        }
    }

    #[test]
    fn rows_live_through_later_migrations_and_a_failing_one_changes_nothing() {
        let path = Path::new("history.db");
        let mut connection = memory();
        migrate(path, &mut connection, &["CREATE TABLE a (x)"]).unwrap();
        connection.execute("INSERT INTO a VALUES (7)", []).unwrap();
        let failing = [
            "CREATE TABLE a (x)",
            "ALTER TABLE a ADD COLUMN y; CREATE TABLE a (x)",
        ];
        migrate(path, &mut connection, &failing).unwrap_err();
        assert_eq!(look(path, &connection).unwrap(), FoundSchema::Schema(1));
        let steps = [
            "CREATE TABLE a (x)",
            "ALTER TABLE a ADD COLUMN y",
            "UPDATE a SET y = x + 1",
        ];
        migrate(path, &mut connection, &steps).unwrap();
        let y: i64 = connection
            .query_row("SELECT y FROM a", [], |row| row.get(0))
            .unwrap();
        assert_eq!(y, 8);
        assert_eq!(look(path, &connection).unwrap(), FoundSchema::Schema(3));
    }

    #[test]
    fn newer_and_other_files_are_refused() {
        let path = Path::new("history.db");
        let mut connection = memory();
        migrate(path, &mut connection, &MIGRATIONS).unwrap();
        connection.pragma_update(None, "user_version", 99).unwrap();
        let error = migrate(path, &mut connection, &MIGRATIONS).unwrap_err();
        assert!(
            matches!(error, HistoryError::Newer { found: 99, .. }),
            "{error}"
        );

        let mut other = memory();
        other.execute_batch("CREATE TABLE mine (x)").unwrap();
        let error = migrate(path, &mut other, &MIGRATIONS).unwrap_err();
        assert!(matches!(error, HistoryError::Other { .. }), "{error}");
    }
}
