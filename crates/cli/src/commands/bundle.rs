//! `etalon bundle`.

use crate::adapters::{Query, discover, releases_of};
use crate::built_program::{Run, built_and_run};
use crate::expectations;
use crate::failure::{Failure, UNEXPECTED};
use crate::flags::{AdapterFileArguments, Format, parse_timeout};
use crate::output::{say, summarize, summarize_json};
use crate::provenance;
use crate::reducing::{Failing, smallest, started};
use crate::reduction::{Shown, TIMEOUT};
use clap::Args;
use etalon_bundle::{
    Checks, Due, DueChannel, DueCounter, DueTexel, Expected, File, Head, Program, Report, Trim,
    Versions,
};
use etalon_case::Case;
use etalon_explore::states;
use etalon_frame::{ChannelMismatch, Frame, Limits, WrongTexel};
use etalon_record::{AdapterRecord, Finding, Record, Source, Subject, Symptom};
use etalon_runner::{Judge, Judged, Launch, Recorded, Worker, judge_texel};
use serde_json::json;
use std::path::PathBuf;
use std::time::Duration;

/// The wrong samples that a program checks.
const CHECKED: usize = 8;
/// The exit status of a program that shows its bug.
const BUG: i32 = 1;
/// The processes that count how often the case fails.
const RUNS: u32 = 20;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) file: AdapterFileArguments,
    /// Id of the case
    #[arg(value_name = "CASE")]
    pub(crate) case: String,
    /// The adapter on which it fails
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: String,
    /// Line of drivers whose newest release draws the case too
    #[arg(long, value_name = "LINE")]
    pub(crate) latest: Option<String>,
    /// Folder for the bundle: a folder of the case's name, and the same as .tar.gz
    #[arg(long, value_name = "DIR", default_value = "reports/bundles")]
    pub(crate) out: PathBuf,
    /// Replace the bundle of the same name
    #[arg(long)]
    pub(crate) force: bool,
    /// Read case files from this folder instead of the built-in ones
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
    /// Seconds that a case may take
    #[arg(long, value_name = "S", default_value = TIMEOUT, value_parser = parse_timeout)]
    pub(crate) timeout: f64,
    /// Form of the summary
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
}

/// Reduces a failing case, and writes a program that shows the bug without the suite, and a report.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let file = arguments.file.adapter_file.as_deref();
    let cases = arguments.cases.as_ref();
    let Failing {
        name,
        candidate,
        launch,
        worker,
    } = Failing::find(&arguments.case, &arguments.adapter, cases, file)?;
    let hello = worker.hello.clone();
    etalon_bundle::free(&arguments.out, &name, arguments.force).map_err(Failure::usage)?;
    let adapter = AdapterRecord::from(&worker);
    let timeout = Duration::from_secs_f64(arguments.timeout);
    let smallest = smallest(&arguments.case, candidate, &launch, worker, timeout)?;
    let symptom = &smallest.symptom;
    let refused = |why: &str| refused(arguments, why, symptom);
    let (Subject::Picture(_) | Subject::Counter(_)) = symptom.subject else {
        return Err(refused("it is no wrong value of one picture"));
    };
    let document = &smallest.reduction.smallest.document;
    let reduced = Reduced {
        case: &alone(smallest.reduction.smallest.case.clone()),
        symptom,
        limits: &hello.limits,
    };
    let checks = reduced.checks(arguments, &hello.info.backend)?;
    let recorded = reduced.recorded(arguments)?;
    let judged = reduced.judged(&recorded.frame)?;
    let due = reduced.due(&recorded.frame, &judged.record)?;
    let Some(recording) = &recorded.recording else {
        let backend = &hello.info.backend;
        return Err(refused(&format!(
            "calls of backend {backend} are not recorded"
        )));
    };
    let frequency = reduced.frequency(&launch, timeout)?;
    let finding = finding(&adapter, &arguments.case)?;
    let newest = match &arguments.latest {
        Some(line) => Some(reduced.newest(arguments, line, timeout)?),
        None => None,
    };
    let shown = Shown {
        document,
        record: &judged.record,
        symptom,
    };
    let title = match &finding {
        Some(finding) => finding.title.clone(),
        None => format!("{}: wrong {symptom}", adapter.device),
    };
    let run = run_command(&launch);
    let head = Head {
        title: title.clone(),
        sentence: shown.sentence(),
        run: run.clone(),
    };
    let (program, built) = shortest(
        |trim| {
            etalon_bundle::program(&head, recording, &due, trim)
                .map_err(|e| refused(&format!("no program can be printed: {e}")))
        },
        |program| built_and_run(program, &launch, timeout),
    )?;
    if let Some(run) = built.as_ref().filter(|run| run.status != Some(BUG)) {
        return Err(refused(&format!(
            "the program made of its calls does not show the bug: {}, {}",
            run.ending, run.line
        )));
    }
    let described = shown.described(&format!(
        "Reduced from {} on {}.",
        arguments.case, arguments.adapter
    ));
    let language = program.language;
    let mut files = program.files;
    let line = built.map(|run| {
        files.extend(run.made);
        run.line
    });
    files.push(File::text(
        "case.json",
        "the scene as a case file of etalon",
        format!(
            "{}\n",
            serde_json::to_string_pretty(&described).map_err(Failure::incomplete)?
        ),
    ));
    files.extend(pictures(&judged));
    let report = Report {
        title,
        sentence: shown.sentence(),
        clause: finding
            .as_ref()
            .map(|f| f.clause.clone())
            .filter(|c| !c.is_empty())
            .or_else(|| shown.clause().map(str::to_owned)),
        device: hello.info.clone(),
        machine: {
            let machine = provenance::machine();
            format!("{}, {}", machine.os, machine.cpu)
        },
        versions: versions(finding.as_ref(), newest),
        expected: expected(&judged.record),
        states: states(&document["scene"]),
        frequency,
        checks,
        language,
        run,
        built: line,
        search: search(&adapter, symptom),
        story: judged
            .record
            .story
            .iter()
            .flat_map(|s| s.to_string().lines().map(str::to_owned).collect::<Vec<_>>())
            .collect(),
        files: files
            .iter()
            .map(|f| (f.name.clone(), f.about.clone()))
            .collect(),
    };
    files.insert(0, File::text("report.md", "the report", report.markdown()));
    let written = etalon_bundle::write(&arguments.out, &name, &files, arguments.force)
        .map_err(Failure::incomplete)?;
    match arguments.format {
        Format::Text => summarize(&format!(
            "{} on {}\n  {}\n  {}\n  fails in {} of {} processes\n  build and run: {} && {}\nBundle: {}\nArchive: {}\n",
            arguments.case,
            arguments.adapter,
            report.title,
            report.sentence,
            frequency[0],
            frequency[1],
            language.build(),
            report.run,
            written.folder.display(),
            written.archive.display(),
        )),
        Format::Json => summarize_json(&json!({
            "case": arguments.case,
            "adapter": arguments.adapter,
            "title": report.title,
            "sentence": report.sentence,
            "clause": report.clause,
            "failed": frequency[0],
            "runs": frequency[1],
            "clean": report.checks != Checks::Absent,
            "folder": written.folder,
            "archive": written.archive,
        }))?,
    }
    Ok(0)
}

/// Returns the shortest program that shows the bug when it is built and run, with that run; the whole one if none does,
/// or if none is run here.
fn shortest(
    program: impl Fn(Trim) -> Result<Program, Failure>,
    run: impl Fn(&Program) -> Result<Option<Run>, Failure>,
) -> Result<(Program, Option<Run>), Failure> {
    let whole = program(Trim::Nothing)?;
    for trim in Trim::ALL {
        let shorter = program(trim)?;
        if shorter != whole || trim == Trim::Nothing {
            let ran = run(&shorter)?;
            let shows = ran.as_ref().is_some_and(|ran| ran.status == Some(BUG));
            if shows || trim == Trim::Nothing {
                return Ok((shorter, ran));
            }
            if ran.is_none() {
                break;
            }
        }
    }
    Ok((whole, None))
}

/// The reason why there is no bundle.
fn refused(arguments: &Arguments, why: &str, symptom: &Symptom) -> Failure {
    Failure {
        code: UNEXPECTED,
        message: format!(
            "no bundle of {} on {}: {why} ({symptom}); `etalon reduce` writes it as a case file",
            arguments.case, arguments.adapter
        ),
    }
}

/// Returns the case without its variants: the program draws one picture.
fn alone(mut case: Case) -> Case {
    case.variants.clear();
    case
}

/// The smallest case.
struct Reduced<'a> {
    case: &'a Case,
    symptom: &'a Symptom,
    limits: &'a Limits,
}

impl Reduced<'_> {
    /// Draws the case where the API checks each call.
    fn checks(&self, arguments: &Arguments, backend: &str) -> Result<Checks, Failure> {
        let opened = started(Query {
            names: std::slice::from_ref(&arguments.adapter),
            file: arguments.file.adapter_file.as_deref(),
            validate: true,
            ..Query::default()
        });
        let Ok((_, mut worker)) = opened else {
            say!(
                "{} has no debug output or validation layer: the calls are not checked",
                arguments.adapter
            );
            return Ok(Checks::Absent);
        };
        let recorded = worker
            .recorded(&self.case.scene)
            .map_err(Failure::incomplete)?;
        match recorded.messages.into_iter().next() {
            None => Ok(Checks::Clean),
            // wgpu refuses what breaks its own rules; these are of the calls that it makes.
            Some(message) if backend == "wgpu" => Ok(Checks::Below(message)),
            Some(message) => Err(refused(
                arguments,
                &format!("the case does not keep to the rules of the API: {message}"),
                self.symptom,
            )),
        }
    }

    /// Draws the case and records the calls.
    fn recorded(&self, arguments: &Arguments) -> Result<Recorded, Failure> {
        let (_, mut worker) = started(Query {
            names: std::slice::from_ref(&arguments.adapter),
            file: arguments.file.adapter_file.as_deref(),
            record: true,
            ..Query::default()
        })?;
        worker
            .recorded(&self.case.scene)
            .map_err(Failure::incomplete)
    }

    /// Judges the recorded frame, which must fail as the case does.
    fn judged(&self, frame: &Frame) -> Result<Judged, Failure> {
        let frames = std::slice::from_ref(frame);
        let judged = Judge::default().judge(0, self.case, "", self.limits, frames);
        match self.symptom.covers(&Symptom::of(&judged.record)) {
            true => Ok(judged),
            false => Err(Failure {
                code: UNEXPECTED,
                message: format!(
                    "the reduced case does not fail while its calls are recorded: it is {}",
                    judged.record.verdict
                ),
            }),
        }
    }

    /// Returns what the frame must hold where it is wrong.
    fn due(&self, frame: &Frame, record: &Record) -> Result<Due, Failure> {
        let wrong = record
            .wrong
            .iter()
            .filter(|w| w.band > etalon_frame::Band::Imprecise);
        let mut due = Due::default();
        for wrong in wrong.take(CHECKED) {
            due.texels.extend(self.texel(frame, wrong)?);
        }
        for (index, counter) in record.counters.iter().enumerate() {
            let range = counter.range();
            if !range.contains(counter.actual) {
                due.counters.push(DueCounter {
                    name: counter.name.clone(),
                    index,
                    range,
                });
            }
        }
        Ok(due)
    }

    /// Returns what a sample must hold in all attachments of its shape.
    fn texel(&self, frame: &Frame, wrong: &WrongTexel) -> Result<Option<DueTexel>, Failure> {
        let WrongTexel { x, y, sample, .. } = *wrong;
        let judged = judge_texel(self.case, 0, self.limits, [x, y], Some(frame));
        let (judgement, _) = judged.map_err(Failure::incomplete)?;
        let own = |image: &&etalon_frame::ImageInfo| {
            let is =
                |m: &ChannelMismatch| m.attachment == image.attachment && m.aspect == image.aspect;
            wrong.channels.iter().any(is)
        };
        let Some(group) = judgement.legal.images.iter().find(own).map(|i| i.group) else {
            return Ok(None);
        };
        let set = judgement.legal.groups[group].sample(x, y, sample);
        let mut channels = Vec::new();
        let mut places = Vec::new();
        for image in judgement.legal.images.iter().filter(|i| i.group == group) {
            for (channel, encoding) in image.channels.iter().enumerate() {
                places.push(image.first_channel + channel);
                channels.push(DueChannel {
                    attachment: image.attachment.clone(),
                    aspect: image.aspect,
                    channel,
                    encoding: *encoding,
                });
            }
        }
        let range = |world: &etalon_frame::WorldBox, place: usize| {
            let interval = world.channels[place];
            [interval.low, interval.high]
        };
        let allowed = set
            .worlds
            .iter()
            .map(|world| places.iter().map(|place| range(world, *place)).collect());
        Ok(Some(DueTexel {
            x,
            y,
            sample,
            channels,
            allowed: allowed.collect(),
        }))
    }

    /// Returns the processes in which the case fails in its way, and all.
    fn frequency(&self, launch: &Launch, timeout: Duration) -> Result<[u32; 2], Failure> {
        let mut failed = 0;
        for _ in 0..RUNS {
            let mut worker = Worker::start(launch).map_err(Failure::incomplete)?;
            let (record, _) = worker.record(self.case, timeout);
            failed += u32::from(self.symptom.covers(&Symptom::of(&record)));
        }
        Ok([failed, RUNS])
    }

    /// Returns the newest release of a line, and whether it draws the case wrong.
    fn newest(
        &self,
        arguments: &Arguments,
        line: &str,
        timeout: Duration,
    ) -> Result<(String, bool), Failure> {
        let file = arguments.file.adapter_file.as_deref();
        let mut releases = releases_of(file, line)?;
        let Some((name, release)) = releases.pop() else {
            return Err(Failure::usage(format!("line {line} has no release")));
        };
        let adapters = discover(&Query {
            names: std::slice::from_ref(&name),
            file,
            ..Query::default()
        })?;
        let Some((_, mut worker)) = adapters.ready.into_iter().next() else {
            return Err(Failure::usage(format!(
                "adapter {name}, the newest release of {line}, cannot be used"
            )));
        };
        let (record, _) = worker.record(self.case, timeout);
        Ok((release.version, record.verdict.is_violation()))
    }
}

/// Returns the pictures: allowed, actual, difference.
fn pictures(judged: &Judged) -> Vec<File> {
    let (Some(file), Some(wrong)) = (&judged.frame, judged.record.wrong.first()) else {
        return Vec::new();
    };
    let Some(mismatch) = wrong.channels.first() else {
        return Vec::new();
    };
    let image = file
        .images
        .iter()
        .find(|i| i.attachment == mismatch.attachment && i.aspect == mismatch.aspect);
    let at = [wrong.x, wrong.y, wrong.sample];
    let Some(ringed) = image.and_then(|i| etalon_report::ringed_pictures(i, at)) else {
        return Vec::new();
    };
    let [due, actual, difference] = ringed.pictures;
    let shown = match ringed.alpha {
        true => ": alpha as grey, since nothing else differs",
        false => "",
    };
    let allowed =
        format!("the picture that is allowed; its least values, where several are{shown}");
    let back = format!("the picture that came back{shown}");
    let about = "wrong texels in orange, the first with a ring";
    vec![
        File::new("expected.png", &allowed, due),
        File::new("actual.png", &back, actual),
        File::new("difference.png", about, difference),
    ]
}

/// Returns the finding that names a case on an adapter.
fn finding(adapter: &AdapterRecord, case: &str) -> Result<Option<Finding>, Failure> {
    let findings = expectations::read(None)?.on(&expectations::today());
    Ok(findings
        .first_bad(adapter, case)
        .and_then(|known| match &known.source {
            Source::Finding(finding) => Some(finding.clone()),
            Source::Entry(_) => None,
        }))
}

fn versions(finding: Option<&Finding>, newest: Option<(String, bool)>) -> Option<Versions> {
    let range = finding.and_then(|f| f.versions.clone());
    if range.is_none() && newest.is_none() {
        return None;
    }
    Some(Versions {
        bad: range.unwrap_or_default(),
        newest,
    })
}

/// Returns the first wrong values in words.
fn expected(record: &Record) -> Vec<Expected> {
    const SHOWN: usize = 4;
    let mut all = Vec::new();
    for wrong in record.wrong.iter().take(SHOWN) {
        for m in &wrong.channels {
            let value = |code: u32| {
                let value = m.encoding.value_of_order(m.encoding.order_of_code(code));
                match m.encoding.is_float() {
                    true => format!("{value}"),
                    false => format!("{code} ({value:.4})"),
                }
            };
            let channel = m.aspect.channel(m.channel.into());
            let sample = match wrong.sample {
                0 => String::new(),
                n => format!(", sample {n}"),
            };
            all.push(Expected {
                place: format!(
                    "{channel} of {}, texel {},{}{sample}",
                    m.attachment, wrong.x, wrong.y
                ),
                due: match m.low == m.high {
                    true => value(m.low),
                    false => format!("{} to {}", value(m.low), value(m.high)),
                },
                actual: value(m.actual),
            });
        }
    }
    for counter in &record.counters {
        if !counter.range().contains(counter.actual) {
            all.push(Expected {
                place: format!("counter {}", counter.name),
                due: counter.range().to_string(),
                actual: counter.actual.to_string(),
            });
        }
    }
    all
}

/// Returns words under which a tracker may know the bug.
fn search(adapter: &AdapterRecord, symptom: &Symptom) -> Vec<String> {
    let driver = adapter.device.split([' ', '(']).next().unwrap_or_default();
    let mut words = vec![driver.to_owned()];
    words.extend(symptom.operations.iter().cloned());
    words.push(symptom.last.clone());
    words.retain(|word| !word.is_empty());
    words.dedup();
    words
}

/// Returns the command that runs the program on the driver, quoted for a shell.
fn run_command(launch: &Launch) -> String {
    let mut words: Vec<String> = Vec::new();
    let mut removed: Vec<String> = Vec::new();
    for (name, value) in &launch.environment {
        match value {
            Some(value) => words.push(format!("{name}={}", quoted(value))),
            None => removed.push(format!("-u {}", quoted(name))),
        }
    }
    words.sort();
    let before = match (removed.is_empty(), words.is_empty()) {
        (true, true) => String::new(),
        (true, false) => format!("{} ", words.join(" ")),
        (false, _) => format!("env {} {} ", removed.join(" "), words.join(" ")),
    };
    format!("{before}./repro")
}

/// Returns a word in one line that a shell takes as it is.
fn quoted(word: &str) -> String {
    etalon_report::quoted(&word.replace(['\n', '\r', '\0'], " "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_value_of_the_environment_leaves_its_word() {
        assert_eq!(quoted("llvmpipe"), "llvmpipe");
        assert_eq!(quoted("a b; rm -rf $HOME"), "'a b; rm -rf $HOME'");
        assert_eq!(quoted("it's"), "'it'\\''s'");
        assert_eq!(quoted(""), "''");
    }
}
