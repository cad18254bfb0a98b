//! Finding a row by its content, or inserting it.

use crate::adapter::Adapter;
use crate::digest::{of_parts, short};
use crate::outcome::Outcome;
use crate::packing::pack;
use etalon_record::Machine;
use rusqlite::{Connection, OptionalExtension, params};
use std::collections::HashMap;

/// Returns the number of a machine.
pub(crate) fn machine(connection: &Connection, machine: &Machine) -> rusqlite::Result<u32> {
    let values = params![machine.os, machine.cpu, machine.cores];
    find_or_insert(
        connection,
        "SELECT id FROM machine WHERE os = ?1 AND cpu = ?2 AND cores = ?3",
        "INSERT INTO machine (os, cpu, cores) VALUES (?1, ?2, ?3) RETURNING id",
        values,
    )
}

/// Returns the number of an adapter as a run found it.
pub(crate) fn adapter(connection: &Connection, adapter: &Adapter) -> rusqlite::Result<u32> {
    let values = params![
        adapter.info.name,
        adapter.info.backend,
        adapter.info.device,
        adapter.info.driver,
        adapter.info.driver_version,
        adapter.info.driver_id,
        adapter.info.api_version,
        adapter.info.software,
        adapter.line,
        adapter.version
    ];
    find_or_insert(
        connection,
        "SELECT id FROM adapter WHERE name = ?1 AND backend = ?2 AND device = ?3 AND driver = ?4 \
         AND driver_version = ?5 AND driver_id = ?6 AND api_version = ?7 AND software = ?8 AND line = ?9 AND version = ?10",
        "INSERT INTO adapter (name, backend, device, driver, driver_version, driver_id, api_version, software, line, \
         version) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10) RETURNING id",
        values,
    )
}

/// Returns the number of a timeline on a machine.
pub(crate) fn chain(
    connection: &Connection,
    timeline: &str,
    machine: u32,
) -> rusqlite::Result<u32> {
    find_or_insert(
        connection,
        "SELECT id FROM chain WHERE timeline = ?1 AND machine = ?2",
        "INSERT INTO chain (timeline, machine) VALUES (?1, ?2) RETURNING id",
        params![timeline, machine],
    )
}

/// Returns the number of a set of cases.
pub(crate) fn drawn(connection: &Connection, cases: &[u8]) -> rusqlite::Result<u32> {
    let digest = short(of_parts(&[cases]));
    let found = connection
        .prepare_cached("SELECT id FROM drawn WHERE digest = ?1")?
        .query_row([digest], |row| row.get(0))
        .optional()?;
    match found {
        Some(id) => Ok(id),
        None => connection
            .prepare_cached("INSERT INTO drawn (digest, cases) VALUES (?1, ?2) RETURNING id")?
            .query_row(params![digest, cases], |row| row.get(0)),
    }
}

/// Returns the number of a state, and whether it was inserted.
pub(crate) fn state(
    connection: &Connection,
    drawn: u32,
    outcomes: &[u32],
) -> rusqlite::Result<(u32, bool)> {
    let bytes: Vec<u8> = outcomes.iter().flat_map(|o| o.to_le_bytes()).collect();
    let digest = short(of_parts(&[&drawn.to_le_bytes(), &bytes]));
    let found = connection
        .prepare_cached("SELECT id FROM state WHERE digest = ?1")?
        .query_row([digest], |row| row.get(0))
        .optional()?;
    if let Some(found) = found {
        return Ok((found, false));
    }
    let packed =
        pack(outcomes).map_err(|e| rusqlite::Error::ToSqlConversionFailure(Box::new(e)))?;
    let new = connection
        .prepare_cached("INSERT INTO state (digest, outcomes) VALUES (?1, ?2) RETURNING id")?
        .query_row(params![digest, packed], |row| row.get(0))?;
    Ok((new, true))
}

fn find_or_insert(
    connection: &Connection,
    find: &str,
    insert: &str,
    values: &[&dyn rusqlite::ToSql],
) -> rusqlite::Result<u32> {
    let found = connection
        .prepare_cached(find)?
        .query_row(values, |row| row.get(0))
        .optional()?;
    match found {
        Some(id) => Ok(id),
        None => connection
            .prepare_cached(insert)?
            .query_row(values, |row| row.get(0)),
    }
}

/// The numbers of cases and outcomes that one transaction has used.
#[derive(Default)]
pub(crate) struct Interning {
    cases: HashMap<String, u32>,
    outcomes: HashMap<[u8; 16], u32>,
    measures: Vec<u8>,
}

impl Interning {
    /// Returns the number of a case.
    pub(crate) fn case(&mut self, connection: &Connection, name: &str) -> rusqlite::Result<u32> {
        if let Some(id) = self.cases.get(name) {
            return Ok(*id);
        }
        let id = find_or_insert(
            connection,
            "SELECT id FROM test_case WHERE name = ?1",
            "INSERT INTO test_case (name) VALUES (?1) RETURNING id",
            params![name],
        )?;
        self.cases.insert(name.to_owned(), id);
        Ok(id)
    }

    /// Returns the number of an outcome.
    pub(crate) fn outcome(
        &mut self,
        connection: &Connection,
        outcome: &Outcome,
    ) -> rusqlite::Result<u32> {
        // The stored text is the key, so that numbers added by a later version do not change it.
        self.measures.clear();
        serde_json::to_writer(&mut self.measures, &outcome.measures)
            .map_err(|e| rusqlite::Error::ToSqlConversionFailure(Box::new(e)))?;
        let text = |text: Option<&str>| text.map_or(vec![0], |t| [&[1], t.as_bytes()].concat());
        let digest = short(of_parts(&[
            outcome.verdict.name().as_bytes(),
            &text(outcome.expected.as_deref()),
            &text(outcome.improves.map(|v| v.name())),
            &[u8::from(outcome.due_fail), u8::from(outcome.inferred)],
            &self.measures,
        ]));
        if let Some(id) = self.outcomes.get(&digest) {
            return Ok(*id);
        }
        let found = connection
            .prepare_cached("SELECT id FROM outcome WHERE digest = ?1")?
            .query_row([digest], |row| row.get(0))
            .optional()?;
        let id = match found {
            Some(id) => id,
            None => {
                let measures = String::from_utf8_lossy(&self.measures);
                connection
                    .prepare_cached(
                        "INSERT INTO outcome (digest, verdict, expected, improves, due_fail, inferred, measures) \
                         VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7) RETURNING id",
                    )?
                    .query_row(
                        params![
                            digest,
                            outcome.verdict.name(),
                            outcome.expected,
                            outcome.improves.map(|v| v.name()),
                            outcome.due_fail,
                            outcome.inferred,
                            measures
                        ],
                        |row| row.get(0),
                    )?
            }
        };
        self.outcomes.insert(digest, id);
        Ok(id)
    }
}
