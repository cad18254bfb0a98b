//! `etalon preflight`.

use crate::cases::build_named;
use crate::commands::run::{self, RunCases, StartedAdapters, draw};
use crate::counted::counted;
use crate::expectations::built_in;
use crate::failure::Failure;
use crate::flags::AdapterFileArguments;
use crate::interruption::listen;
use crate::named_files::{check_file, replace};
use crate::output::{print, print_json};
use crate::worth::sort_by_worth;
use clap::Args;
use etalon_case::{Case, Library, Profile, select};
use etalon_diagnose::{Advice, DrawnCase, Fact, Preflight, Safety, ShownBug, Symptom};
use etalon_explore::{Candidate, PLAIN_FACTS, case_facts, fact_names, format_fact};
use etalon_frame::TextureFormat;
use etalon_glob::did_you_mean;
use etalon_record::{AdapterRecord, Expectations, Known, Record, Run, Verdict};
use etalon_runner::Reducer;
use etalon_scene::{Pass, Scene};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ffi::OsStr;
use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The time that the driver may take to start.
const START: Duration = Duration::from_secs(15);
/// The time after which no further case is drawn, with that of the start. Each case may take [`TIMEOUT`] seconds.
const DRAWING: Duration = Duration::from_secs(14);
const TIMEOUT: &str = "3";
/// The time after which no further failure is reduced. A reduction takes a second or two.
const REDUCING: Duration = Duration::from_secs(17);
/// The fact of a draw that reads a texture.
const SAMPLED: &str = "texture";
/// The number of failures of one bug whose common facts say something.
const MANY: usize = 4;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) file: AdapterFileArguments,
    /// The adapter to ask
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: String,
    /// Say only what draws with these states and formats can meet: names as the whole answer has them, with commas
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub(crate) uses: Vec<String>,
    /// Print JSON for programs
    #[arg(long)]
    pub(crate) json: bool,
    /// Also write the JSON to this file
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
}

/// Draws the cases of the findings about an adapter, then others, and says what they show.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let begin = Instant::now();
    if let Some(file) = &arguments.out {
        check_file(file)?;
    }
    let formats = TextureFormat::ALL.map(|format| [format.name().to_owned(), format_fact(format)]);
    let states: Vec<String> = fact_names().collect();
    let used = used(&arguments.uses, &states)?;
    let failed = |e: io::Error| Failure::incomplete(format!("cannot make a folder: {e}"));
    let folder = tempfile::tempdir().map_err(failed)?;
    let mut run = drawing(arguments, &folder.path().join("run"))?;
    run.start_timeout = Some(START);
    let selected = RunCases::new(&run)?;
    let expectations = built_in()?;
    let stop = listen()?;
    let started = StartedAdapters::start(&run)?;
    let Some(launch) = started.launches().next().cloned() else {
        let name = &arguments.adapter;
        return Err(Failure::incomplete(format!("{name} does not start")));
    };
    let left = DRAWING.saturating_sub(begin.elapsed());
    run.within = Some(left.as_secs_f64().max(1.0));
    let mut plan = started.plan(&run, &selected, &expectations, stop);
    let Some(adapter) = plan.header.adapters.first().cloned() else {
        return Err(Failure::incomplete("no adapter was started"));
    };
    let library = Library::built_in();
    let cases = in_order(library, &selected.cases, &expectations.about(&adapter))?;
    plan.header.cases = cases.len() as u64;
    plan.selection = None;
    plan.cases = &cases;
    let summary = draw(plan)?;
    if summary.interrupted {
        return Err(Failure::incomplete("interrupted before it could answer"));
    }
    let records = Run::read(&run.out).map_err(Failure::incomplete)?.records;
    let mut reductions = Reductions {
        library,
        reducer: Reducer::new(
            launch,
            adapter.limits.clone(),
            Duration::from_secs_f64(run.timeout),
            stop,
        ),
        begin,
    };
    let by_id: HashMap<&str, &Case> = cases.iter().map(|case| (&*case.id, case)).collect();
    let drawn = records.iter().filter_map(|record| {
        let case = by_id.get(record.case.as_str())?;
        Some(DrawnCase {
            record,
            draws: case_facts(case),
            formats: formats_where(&case.scene, |pass, index| pass.attaches(index), format_fact),
            sampled: formats_where(
                &case.scene,
                |pass, index| pass.draws.iter().any(|draw| draw.textures.contains(&index)),
                |_| SAMPLED.to_owned(),
            ),
        })
    });
    let drawn: Vec<DrawnCase<'_>> = drawn.collect();
    let mut answer = Preflight::new(
        &drawn,
        &adapter,
        &expectations,
        &formats,
        &states,
        |known, cases| reductions.needs(known, cases),
    );
    if let Some([facts, names]) = &used {
        answer.keep(facts, names);
    }
    let answer = Answer {
        adapter: &adapter,
        uses: &arguments.uses,
        answer,
        seconds: begin.elapsed().as_secs_f64(),
        drawn: records.iter().filter(|record| record.is_drawn()).count() as u64,
        left: records
            .iter()
            .filter(|record| record.verdict == Verdict::Skipped)
            .count() as u64,
    };
    let json = answer.json();
    if let Some(file) = &arguments.out {
        let text =
            serde_json::to_vec_pretty(&json).map_err(|e| Failure::incomplete(e.to_string()))?;
        replace(file, &text)?;
    }
    if arguments.json {
        print_json(&json)?;
    } else {
        print(&answer.text())?;
    }
    Ok(0)
}

/// Returns the arguments of the run that draws.
fn drawing(arguments: &Arguments, out: &Path) -> Result<run::Arguments, Failure> {
    let mut words: Vec<&OsStr> = Vec::new();
    for (flag, value) in [
        ("--adapter", arguments.adapter.as_ref()),
        ("--timeout", TIMEOUT.as_ref()),
        ("--keep-frames", "none".as_ref()),
        ("--out", out.as_os_str()),
    ] {
        words.extend([flag.as_ref(), value]);
    }
    if let Some(file) = &arguments.file.adapter_file {
        words.extend(["--adapters".as_ref(), file.as_os_str()]);
    }
    run::of_words(&words).ok_or_else(|| Failure::usage("the name of the adapter is no text"))
}

/// Returns the shortest case of each finding about the adapter, first of bugs that end no process, then the quick cases by
/// what they find per second.
fn in_order(library: &Library, quick: &[Case], about: &Expectations) -> Result<Vec<Case>, Failure> {
    let mut others: Vec<Case> = quick.to_vec();
    sort_by_worth(&mut others);
    let is_lasting = |number: usize| {
        let verdict = about.all()[number].verdict;
        verdict.is_violation() || matches!(verdict, Verdict::Flaky | Verdict::Open)
    };
    let mut numbers: Vec<usize> = (0..about.all().len()).collect();
    numbers.sort_by_key(|number| !is_lasting(*number));
    let mut first: Vec<Case> = Vec::new();
    for number in numbers {
        let draws = |case: &&Case| {
            let draws = case.scene.passes.iter().map(|pass| pass.draws.len());
            draws.sum::<usize>()
        };
        let shows = |case: &&Case| about.names(number, &case.id);
        if first.iter().any(|case| shows(&case)) {
            continue;
        }
        if let Some(case) = others.iter().filter(shows).min_by_key(draws) {
            first.push(case.clone());
            continue;
        }
        let selected = select(library, Profile::Full, &about.all()[number].cases);
        let selected = selected.map_err(Failure::usage)?;
        if let Some(case) = selected.cases.first() {
            let id = case.id();
            first.extend(build_named(library, &BTreeSet::from([id.as_str()]))?);
        }
    }
    let ids: BTreeSet<String> = first.iter().map(|case| case.id.clone()).collect();
    others.retain(|case| !ids.contains(&case.id));
    first.extend(others);
    Ok(first)
}

/// Returns the formats of a scene that some pass uses: their names, and their facts.
fn formats_where(
    scene: &Scene,
    uses: impl Fn(&Pass, usize) -> bool,
    fact: impl Fn(TextureFormat) -> String,
) -> Vec<[String; 2]> {
    let attachments = scene.attachments.iter().enumerate();
    let used = attachments.filter(|(index, _)| scene.passes.iter().any(|pass| uses(pass, *index)));
    used.map(|(_, a)| [a.format.name().to_owned(), fact(a.format)])
        .collect()
}

/// Returns the facts of a draw with these states and formats, and all names that it can have in the answer; `None` if
/// nothing is named.
fn used(names: &[String], states: &[String]) -> Result<Option<[BTreeSet<String>; 2]>, Failure> {
    if names.is_empty() {
        return Ok(None);
    }
    let plain = PLAIN_FACTS.map(str::to_owned);
    let (mut facts, mut shown) = (BTreeSet::from(plain), BTreeSet::new());
    for name in names {
        if let Some(format) = TextureFormat::ALL.into_iter().find(|f| f.name() == name) {
            facts.insert(format_fact(format));
        } else if states.contains(name) {
            facts.insert(name.clone());
        } else {
            let formats = TextureFormat::ALL.map(TextureFormat::name);
            let known = states.iter().map(String::as_str).chain(formats);
            let near = did_you_mean(name, known);
            return Err(Failure::usage(format!(
                "no state or format has the name `{name}`{near}; without --uses, etalon preflight names all"
            )));
        }
        shown.insert(name.clone());
    }
    Ok(Some([facts, shown]))
}

/// Finds out what failures need that no finding explains, by reducing them.
struct Reductions<'a> {
    library: &'a Library,
    reducer: Reducer<'a>,
    begin: Instant,
}

impl Reductions<'_> {
    /// Returns the facts that failures of one bug need, without those of the plainest draw: what is left of the first one
    /// when it is reduced and fits the others, otherwise what many of them have in common. A finding's cases fail too,
    /// drawn or not.
    fn needs(&mut self, known: Option<&Known>, cases: &[&DrawnCase<'_>]) -> Vec<String> {
        let mut facts: Vec<BTreeSet<String>> = cases.iter().map(|c| facts_of(&c.draws)).collect();
        facts.extend(known.map_or_else(Vec::new, |known| self.facts_of_finding(known)));
        let needs = match cases.first().and_then(|case| self.reduced(case.record)) {
            Some(case) => unplain(facts_of(&case_facts(&case))),
            None if facts.len() >= MANY => {
                let each = facts.iter().cloned();
                let common = each.reduce(|all, other| &all & &other);
                unplain(common.unwrap_or_default())
            }
            None => Vec::new(),
        };
        fitting(needs, &facts)
    }

    /// Returns the facts of the cases that a finding names, if there is time.
    fn facts_of_finding(&self, known: &Known) -> Vec<BTreeSet<String>> {
        // A finding's globs were checked when it was read.
        let selected = select(self.library, Profile::Full, &known.cases).map(|s| s.cases);
        let cases = selected.unwrap_or_default().into_iter();
        cases
            .take_while(|_| self.begin.elapsed() < REDUCING)
            .filter_map(|case| case.build().ok())
            .map(|case| facts_of(&case_facts(&case)))
            .collect()
    }

    /// Returns the reduced case of a failure; `None` if it fails only after others, or now and then, or if it ends the
    /// process or there is no time left.
    fn reduced(&mut self, record: &Record) -> Option<Case> {
        let symptom = Symptom::of(record);
        let is_late = self.begin.elapsed() > REDUCING;
        if !symptom.keeps_worker() || !record.after.is_empty() || is_late {
            return None;
        }
        let ids = BTreeSet::from([record.case.as_str()]);
        let (_, case) = self.library.named(&ids).next()?;
        let document = case.document().ok()?;
        let case = etalon_case::build("found/preflight", &document).ok()?;
        let scene = Candidate { document, case };
        let looked = self.reducer.look(scene, record.clone(), symptom).ok()?;
        looked.is_reduced().then_some(looked.scene.case)
    }
}

fn facts_of(draws: &[Vec<String>]) -> BTreeSet<String> {
    draws.iter().flatten().cloned().collect()
}

fn unplain(facts: BTreeSet<String>) -> Vec<String> {
    let others = facts.into_iter();
    others
        .filter(|fact| !PLAIN_FACTS.contains(&fact.as_str()))
        .collect()
}

/// Returns what one failure needs, without what others of the bug lack, by the facts of each failure: the values of a key
/// that all of them have, otherwise nothing. If nothing remained, the needs stay as they are.
fn fitting(needs: Vec<String>, failures: &[BTreeSet<String>]) -> Vec<String> {
    let fits = |need: &String| {
        if failures.iter().all(|facts| facts.contains(need)) {
            return Some(need.clone());
        }
        let (key, _) = need.split_once('=')?;
        let of_key = |fact: &&String| fact.split_once('=').is_some_and(|(name, _)| name == key);
        let all: BTreeSet<&String> = failures.iter().flatten().filter(of_key).collect();
        let is_needed = failures
            .iter()
            .all(|facts| facts.iter().any(|fact| all.contains(fact)))
            && !all.iter().any(|fact| PLAIN_FACTS.contains(&fact.as_str()));
        let values = all.iter().map(|fact| &fact[key.len() + 1..]);
        is_needed.then(|| format!("{key}={{{}}}", values.collect::<Vec<_>>().join(",")))
    };
    let fitted: Vec<String> = needs.iter().filter_map(fits).collect();
    if fitted.is_empty() { needs } else { fitted }
}

/// The answer, with what it is based on.
struct Answer<'a> {
    adapter: &'a AdapterRecord,
    /// The states and formats that the answer is about; all if empty.
    uses: &'a [String],
    answer: Preflight,
    seconds: f64,
    /// The number of drawn cases.
    drawn: u64,
    /// The number of cases for which no time was left.
    left: u64,
}

impl Answer<'_> {
    fn json(&self) -> Value {
        let (info, answer) = (&self.adapter.info, &self.answer);
        json!({
            "adapter": info.name,
            "driver": info.driver,
            "driver_version": info.driver_version,
            "device": info.device,
            "seconds": (self.seconds * 10.0).round() / 10.0,
            "drawn": self.drawn,
            "left": self.left,
            "uses": self.uses,
            "bugs": answer.bugs,
            "unseen": answer.unseen,
            "formats": answer.formats,
            "sampled": answer.sampled,
            "states": answer.states,
        })
    }

    fn text(&self) -> String {
        let Preflight {
            bugs,
            unseen,
            formats,
            sampled,
            states,
        } = &self.answer;
        let known = bugs.iter().filter(|bug| bug.finding.is_some()).count();
        let left = match self.left {
            0 => String::new(),
            n => format!(" ({n} more did not fit)"),
        };
        let uses = match self.uses {
            [] => String::new(),
            uses => format!(" that a draw with {} can meet", uses.join(", ")),
        };
        let mut text = format!(
            "{} ({}): {} drawn in {:.0} s{left}: {}, {} without a finding{uses}\n",
            self.adapter.info.name,
            self.adapter.driver_text(),
            counted(self.drawn, "case"),
            self.seconds,
            counted(known as u64, "known bug"),
            counted((bugs.len() - known) as u64, "failure"),
        );
        if !bugs.is_empty() {
            text += "\nWhat it draws wrong\n";
        }
        for bug in bugs {
            text += &bug_lines(bug);
        }
        if let Some(bug) = bugs.first() {
            let name = &self.adapter.info.name;
            let _ = writeln!(text, "Why: etalon explain {} --adapter {name}", bug.example);
        }
        let gone: Vec<&str> = unseen
            .iter()
            .filter(|bug| bug.right > 0)
            .map(|bug| &*bug.finding)
            .collect();
        if !gone.is_empty() {
            let _ = writeln!(text, "\nKnown, and not seen here: {}", gone.join(", "));
        }
        let undrawn = unseen.len() - gone.len();
        if undrawn > 0 {
            let _ = writeln!(text, "Known, and no case of it was drawn: {undrawn}");
        }
        text += &facts_lines("Formats that are drawn to", formats);
        text += &facts_lines("Formats that are sampled", sampled);
        text += &facts_lines("States", states);
        text
    }
}

/// Returns what to do, in a word or two.
fn advice_words(advice: Advice) -> String {
    match advice {
        Advice::Tolerance { codes, encoding } => {
            format!(
                "tolerance of {} of {encoding}",
                counted(codes.into(), "code")
            )
        }
        Advice::Skip => "skip".to_owned(),
        Advice::IgnoreCounters => "ignore counters".to_owned(),
        Advice::Avoid => "avoid".to_owned(),
    }
}

fn bug_lines(bug: &ShownBug) -> String {
    let name = bug.finding.as_deref().unwrap_or("no finding");
    let needs = match &bug.needs[..] {
        [] => "what it needs is not known".to_owned(),
        needs => format!("needs {}", needs.join(" + ")),
    };
    let after = bug.after.as_ref();
    let after = after.map_or_else(String::new, |case| format!(" after {case}"));
    format!(
        "  {}: {} ({name})\n      {needs}; {} {}, as {}{after}\n",
        advice_words(bug.advice),
        bug.title,
        counted(bug.cases, "case"),
        bug.verdict,
        bug.example,
    )
}

/// Returns a line for each unsafe fact, and one for all others of each kind.
fn facts_lines(title: &str, facts: &BTreeMap<String, Fact>) -> String {
    let of = |safety: Safety| {
        let facts = facts.iter().filter(move |(_, fact)| fact.safety == safety);
        facts.map(|(name, _)| name.as_str()).collect::<Vec<_>>()
    };
    let mut text = format!("\n{title}\n");
    for (name, fact) in facts {
        let bugs: Vec<&str> = fact.bugs.iter().map(String::as_str).collect();
        let bugs = bugs.join(", ");
        text += &match fact.safety {
            Safety::Partly => format!("  right but for a bug  {name}: {bugs}\n"),
            Safety::Unclear => {
                format!("  unclear  {name}: only in wrong pictures, of {bugs}\n")
            }
            Safety::Wrong => format!(
                "  wrong in each of {}  {name}: {bugs}\n",
                counted(fact.wrong, "case")
            ),
            _ => continue,
        };
    }
    for (words, safety) in [
        ("safe", Safety::Safe),
        ("not supported", Safety::NotSupported),
        ("not drawn", Safety::NotDrawn),
    ] {
        let names = of(safety);
        if !names.is_empty() {
            let _ = writeln!(text, "  {words}  {}", names.join(", "));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_another_failure_of_the_bug_lacks_is_not_needed() {
        let case = |facts: &[&str]| -> BTreeSet<String> {
            facts.iter().map(|fact| (*fact).to_owned()).collect()
        };
        let reduced = case(&[
            "depth=depth32float",
            "samples=4",
            "sample-shading",
            "texture",
        ]);
        let other = case(&["depth=depth16unorm", "samples=1", "texture", "cull"]);
        let unlike = case(&["cull"]);
        let needs = || unplain(reduced.clone());
        assert_eq!(fitting(needs(), std::slice::from_ref(&reduced)), needs());
        assert_eq!(
            fitting(needs(), &[reduced.clone(), other]),
            ["depth={depth16unorm,depth32float}", "texture"]
        );
        assert_eq!(fitting(needs(), &[reduced.clone(), unlike]), needs());
    }
}
