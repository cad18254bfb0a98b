-- Runs in the order in which they were added. Nothing is ever changed or removed.
CREATE TABLE machine (
    id INTEGER PRIMARY KEY,
    os TEXT NOT NULL,
    cpu TEXT NOT NULL,
    cores INTEGER NOT NULL,
    UNIQUE (os, cpu, cores)
) STRICT;

CREATE TABLE run (
    id INTEGER PRIMARY KEY,
    digest BLOB NOT NULL UNIQUE,
    header BLOB NOT NULL,
    kind TEXT NOT NULL,
    etalon TEXT NOT NULL,
    suite_commit TEXT,
    machine INTEGER NOT NULL REFERENCES machine,
    started INTEGER NOT NULL,
    released INTEGER,
    profile TEXT,
    ruler TEXT,
    missing INTEGER NOT NULL,
    labels TEXT NOT NULL
) STRICT;

-- An adapter as a run found it.
CREATE TABLE adapter (
    id INTEGER PRIMARY KEY,
    name TEXT NOT NULL,
    backend TEXT NOT NULL,
    device TEXT NOT NULL,
    driver TEXT NOT NULL,
    driver_version TEXT NOT NULL,
    driver_id TEXT NOT NULL,
    api_version TEXT NOT NULL,
    software INTEGER NOT NULL,
    line TEXT NOT NULL,
    version TEXT NOT NULL,
    UNIQUE (name, driver_version, version, driver, device, api_version, driver_id, backend, line, software)
) STRICT;

-- One adapter on one machine over its runs.
CREATE TABLE chain (
    id INTEGER PRIMARY KEY,
    timeline TEXT NOT NULL,
    machine INTEGER NOT NULL REFERENCES machine,
    UNIQUE (timeline, machine)
) STRICT;

CREATE TABLE test_case (
    id INTEGER PRIMARY KEY,
    name TEXT NOT NULL UNIQUE
) STRICT;

-- All that is kept of a record. The digest is of the other columns.
CREATE TABLE outcome (
    id INTEGER PRIMARY KEY,
    digest BLOB NOT NULL UNIQUE,
    verdict TEXT NOT NULL,
    expected TEXT,
    improves TEXT,
    due_fail INTEGER NOT NULL,
    inferred INTEGER NOT NULL,
    measures TEXT NOT NULL
) STRICT;

-- Which cases an adapter has records of in a run: bit n is case n + 1.
CREATE TABLE drawn (
    id INTEGER PRIMARY KEY,
    digest BLOB NOT NULL UNIQUE,
    cases BLOB NOT NULL
) STRICT;

-- All outcomes of an adapter in a run, in the order of the cases: deflated variable-length differences. The digest is of
-- the cases, too.
CREATE TABLE state (
    id INTEGER PRIMARY KEY,
    digest BLOB NOT NULL UNIQUE,
    outcomes BLOB NOT NULL
) STRICT;

-- The records of a state, counted.
CREATE TABLE tally (
    state INTEGER NOT NULL REFERENCES state,
    area TEXT NOT NULL,
    verdict TEXT NOT NULL,
    unexpected INTEGER NOT NULL,
    records INTEGER NOT NULL,
    PRIMARY KEY (state, area, verdict, unexpected)
) STRICT, WITHOUT ROWID;

-- An adapter of a run.
CREATE TABLE part (
    chain INTEGER NOT NULL REFERENCES chain,
    run INTEGER NOT NULL REFERENCES run,
    adapter INTEGER NOT NULL REFERENCES adapter,
    drawn INTEGER NOT NULL REFERENCES drawn,
    state INTEGER NOT NULL REFERENCES state,
    records INTEGER NOT NULL,
    PRIMARY KEY (chain, run)
) STRICT, WITHOUT ROWID;

-- The outcome of a case from this run of the chain on, in the order in which runs were added, until the next row.
CREATE TABLE change (
    test_case INTEGER NOT NULL REFERENCES test_case,
    chain INTEGER NOT NULL REFERENCES chain,
    run INTEGER NOT NULL REFERENCES run,
    outcome INTEGER NOT NULL REFERENCES outcome,
    PRIMARY KEY (test_case, chain, run)
) STRICT, WITHOUT ROWID;

-- Medians of frame times by round, in seconds: little-endian 32-bit floats.
CREATE TABLE frame_time (
    test_case INTEGER NOT NULL REFERENCES test_case,
    chain INTEGER NOT NULL REFERENCES chain,
    run INTEGER NOT NULL REFERENCES run,
    frames INTEGER NOT NULL,
    wall BLOB NOT NULL,
    cpu BLOB NOT NULL,
    gpu BLOB NOT NULL,
    read_back BLOB NOT NULL,
    ruler BLOB NOT NULL,
    low_high BLOB NOT NULL,
    PRIMARY KEY (test_case, chain, run)
) STRICT, WITHOUT ROWID;

-- What people said of changes. The last row about one subject counts.
CREATE TABLE triage (
    id INTEGER PRIMARY KEY,
    at INTEGER NOT NULL,
    author TEXT NOT NULL,
    test_case TEXT NOT NULL,
    timeline TEXT NOT NULL,
    machine INTEGER REFERENCES machine,
    time TEXT,
    run INTEGER REFERENCES run,
    state TEXT NOT NULL,
    reason TEXT NOT NULL
) STRICT;
