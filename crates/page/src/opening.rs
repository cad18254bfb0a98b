//! The beginning of a run: its selection, its adapter and its header.

use crate::message::{Choice, Choosing, Opened, Opening, PageDevice};
use crate::session::Session;
use etalon_backend::Fault;
use etalon_case::{Case, CaseRef, Library, Profile, left_out, select};
use etalon_judge::{pictured, round_trips};
use etalon_record::{AdapterRecord, Header, Provenance, Settings, header_line, selection_digest};
use etalon_webgpu::adapter;
use std::collections::{BTreeSet, HashMap, HashSet};

/// The time limit of a case, in seconds.
const TIMEOUT: f64 = 60.0;

/// The number of cases that are built before a run begins.
const MANY: usize = 4096;
/// The start of the ids of round trips.
const ROUND_TRIPS: &str = "capabilities/round-trip/format=";

/// Begins a run. One step of the opening after the other.
///
/// # Errors
/// If the selection is empty, a glob does not parse, or the device lacks a limit.
pub(crate) fn open(opening: Opening) -> Result<(Session, Opened), String> {
    let library = Library::built_in();
    let PageSelection {
        profile,
        cases: selected,
        measured,
    } = selection(&opening.globs, &opening.profile)?;
    let ids: Vec<String> = selected.iter().map(CaseRef::id).collect();
    let trips = match opening.trips {
        Some(trips) => trips,
        None => trips_of(library, &selected)?,
    };
    let measuring = selected.iter().any(CaseRef::is_measured);
    let pictured = if measuring {
        pictured(&built(&selected)?)
    } else {
        HashSet::new()
    };
    let mut cases = selected;
    let mut first = Vec::new();
    let numbers: HashMap<&str, usize> = ids.iter().map(String::as_str).zip(0..).collect();
    let known: BTreeSet<&str> = trips.iter().map(String::as_str).collect();
    for case in library.cases(Profile::Full) {
        let id = case.id();
        if known.contains(id.as_str()) {
            first.push(numbers.get(id.as_str()).copied().unwrap_or(cases.len()));
            if !numbers.contains_key(id.as_str()) {
                cases.push(case);
            }
        }
    }
    let name = name_of(&opening.hello.browser.name, &opening.fault);
    let device = adapter::device(&opening.hello.offer)?;
    let record = AdapterRecord {
        info: adapter::info(&name, &opening.hello),
        release: None,
        limits: device.limits.clone(),
    };
    let left_out = left_out(library, profile, &opening.globs, &ids).map_err(|e| e.to_string())?;
    let header = Header {
        provenance: Provenance {
            etalon: env!("CARGO_PKG_VERSION").to_owned(),
            commit: option_env!("ETALON_COMMIT").map(str::to_owned),
            machine: opening.machine,
            started: opening.started.clone(),
            command: opening.command,
        },
        settings: Settings {
            selection: selection_digest(ids.iter().map(String::as_str)),
            profile: Some(opening.profile),
            left_out: Some(left_out),
            timeout: Some(TIMEOUT),
            ..Settings::default()
        },
        ..Header::new(vec![record.clone()], ids.len() as u64)
    };
    let line = header_line(&header).map_err(|error| error.to_string())?;
    let opened = Opened {
        cases: ids,
        trips,
        first,
        measured,
        timed: measuring,
        header: String::from_utf8_lossy(&line).into_owned(),
        device: page_device(&record),
    };
    let fault = Fault::in_name(&name).map_err(|error| error.to_string())?;
    let fault = fault.map(|(_, fault)| fault);
    let today: String = opening.started.chars().take(10).collect();
    let expectations = etalon_findings::findings().map_err(|error| error.to_string())?;
    let expectations = expectations
        .of_run(&header.provenance.machine.cpu, &[])
        .on(&today)
        .about(&record);
    Ok((
        Session::new(record, device, fault, expectations, cases, pictured),
        opened,
    ))
}

/// The cases of a selection.
struct PageSelection {
    profile: Profile,
    cases: Vec<CaseRef<'static>>,
    /// The number of matching cases that are left out because they are measured.
    measured: usize,
}

/// Returns the cases that match; without globs, all that are judged.
///
/// # Errors
/// If there is no such profile, a glob does not parse, or no case matches.
fn selection(globs: &[String], profile: &str) -> Result<PageSelection, String> {
    let profile = match profile {
        "quick" => Profile::Quick,
        "full" => Profile::Full,
        other => {
            return Err(format!(
                "there is no profile {other}; there are quick and full"
            ));
        }
    };
    let matching = |profile| select(Library::built_in(), profile, globs).map_err(|e| e.to_string());
    let mut cases = matching(profile)?.cases;
    let count = cases.len();
    if globs.is_empty() {
        cases.retain(|case| !case.is_measured());
    }
    if cases.is_empty() {
        return Err(match matching(Profile::Full)?.cases.len() {
            0 => "no case matches".to_owned(),
            n => format!("no case of the quick profile matches, of the full one {n}"),
        });
    }
    let measured = count - cases.len();
    Ok(PageSelection {
        profile,
        cases,
        measured,
    })
}

/// Returns what a run would draw, and on what.
///
/// # Errors
/// As [`open`].
pub(crate) fn choice(choosing: &Choosing) -> Result<Choice, String> {
    let cases = selection(&choosing.globs, &choosing.profile)?.cases.len();
    let hello = choosing.hello.as_ref();
    let device = hello.map(|hello| {
        Ok::<_, String>(page_device(&AdapterRecord {
            info: adapter::info(&name_of(&hello.browser.name, ""), hello),
            release: None,
            limits: adapter::device(&hello.offer)?.limits,
        }))
    });
    let device = device.transpose()?;
    Ok(Choice { cases, device })
}

fn page_device(adapter: &AdapterRecord) -> PageDevice {
    let info = &adapter.info;
    PageDevice {
        adapter: info.name.clone(),
        device: info.device.clone(),
        driver: adapter.driver_text(),
        software: info.software,
    }
}

/// Returns the ids of the round trips that cases depend on. For many cases it returns all of them: building
/// the cases to find out takes longer than drawing round trips that no case needs.
fn trips_of(library: &Library, selected: &[CaseRef<'_>]) -> Result<Vec<String>, String> {
    if selected.len() > MANY {
        let ids = library.cases(Profile::Full).map(|case| case.id());
        return Ok(ids.filter(|id| id.starts_with(ROUND_TRIPS)).collect());
    }
    let trips = round_trips(&[library], &built(selected)?).map_err(|error| error.to_string())?;
    Ok(trips.into_iter().map(|trip| trip.id).collect())
}

fn built(cases: &[CaseRef<'_>]) -> Result<Vec<Case>, String> {
    let cases: Result<Vec<Case>, _> = cases.iter().map(CaseRef::build).collect();
    cases.map_err(|error| error.to_string())
}

/// Returns the adapter's name: the browser in one word, such as `webgpu:chromium`, and the planted fault if there is
/// one.
fn name_of(browser: &str, fault: &str) -> String {
    let word = browser.split_whitespace().last().unwrap_or("browser");
    let word: String = word.chars().filter(char::is_ascii_alphanumeric).collect();
    let name = format!("webgpu:{}", word.to_lowercase());
    match fault {
        "" => name,
        fault => format!("{name}:{fault}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn browsers_have_one_word_names() {
        assert_eq!(name_of("Chromium", ""), "webgpu:chromium");
        assert_eq!(name_of("Google Chrome", ""), "webgpu:chrome");
        assert_eq!(name_of("", ""), "webgpu:browser");
        let name = name_of("Firefox", "read-fault=off-by-one");
        assert!(Fault::in_name(&name).is_ok_and(|fault| fault.is_some()));
    }
}
