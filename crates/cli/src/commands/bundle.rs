//! `etalon bundle`.

use crate::built_program::{ProgramRun, built_and_run};
use crate::discovery::discover;
use crate::expectations;
use crate::failure::{Failure, NOTHING, UNEXPECTED};
use crate::flags::OutputFormat;
use crate::interruption::listen;
use crate::out_folder::apart;
use crate::output::{print_json, say, summarize};
use crate::processors::processors;
use crate::provenance;
use crate::recorded_frame::recorded_frame;
use crate::reducing::{Failing, FailingArguments, started};
use crate::saved_recording::saved_recording;
use crate::saved_run::UnpackArguments;
use crate::scene_text;
use clap::Args;
use etalon_adapters::{Query, releases_of};
use etalon_backend::Recording;
use etalon_bundle::{
    BadReleases, Checks, Due, DueChannel, DueCounter, DueTexel, File, Head, Language, Program,
    Report, Trim, Written, WrongValue,
};
use etalon_case::Case;
use etalon_diagnose::{Symptom, WrongPart};
use etalon_explore::{Candidate, states};
use etalon_frame::threads::share;
use etalon_frame::{ChannelMismatch, Frame, WrongTexel};
use etalon_judge::{Judge, Judged, judge_texel};
use etalon_record::{AdapterRecord, Finding, KnownSource, Machine, Record, check_folder};
use etalon_report::{ReducedCase, story_text};
use etalon_runner::{Launch, Recorded, Worker, smallest};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

/// The largest number of wrong samples that a program checks.
const CHECKED: usize = 8;
/// The exit status of a program that shows its bug.
const BUG: i32 = 1;
/// The number of processes that draw the case to count how often it fails.
const RUNS: u32 = 20;
/// The same number for browsers, which take a second or more to start.
const BROWSERS: u32 = 5;
/// The number of these processes that run at the same time.
const AT_ONCE: usize = 4;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) failing: FailingArguments,
    /// Line of a driver; its newest release draws the case too
    #[arg(long, value_name = "LINE")]
    pub(crate) latest: Option<String>,
    /// Draw nothing, and use the frame that this run keeps: a run folder, or a run that the page saved (`*.tar.gz`).
    /// The case is not reduced. Only for browsers
    #[arg(long, value_name = "RUN", conflicts_with = "latest")]
    pub(crate) run: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) unpack: UnpackArguments,
    /// Folder for the bundle, which is a folder with the case's name, and the same as .tar.gz
    #[arg(long, value_name = "DIR", default_value = "reports/bundles")]
    pub(crate) out: PathBuf,
    /// Replace the bundle of the same name
    #[arg(long)]
    pub(crate) force: bool,
}

/// Writes a program that shows a failing case without the suite, and a report.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    apart(&arguments.out, arguments.failing.cases.as_deref())?;
    match &arguments.run {
        Some(run) => saved(arguments, run),
        None => drawn(arguments),
    }
}

/// Reduces the case, and draws the smallest one.
fn drawn(arguments: &Arguments) -> Result<u8, Failure> {
    let failing = &arguments.failing;
    if let Some(line) = &arguments.latest {
        // Refuses a wrong line before anything is drawn.
        releases_of(failing.adapter_file(), line).map_err(Failure::usage)?;
    }
    let Failing {
        name,
        candidate,
        launch,
        worker,
    } = Failing::find(failing)?;
    free(arguments, &name)?;
    let adapter = AdapterRecord::from(&worker);
    let timeout = failing.timeout();
    let smallest = smallest(
        &failing.case,
        candidate,
        &launch,
        worker,
        timeout,
        listen()?,
    )?;
    let bundled = Bundled {
        arguments,
        case: &alone(smallest.reduction.smallest.case.clone()),
        document: &smallest.reduction.smallest.document,
        symptom: &smallest.symptom,
        adapter: &adapter,
        machine: &provenance::machine(),
    };
    let driver = ReadyDriver {
        launch: &launch,
        timeout,
    };
    let evidence = bundled.evidence(driver)?;
    bundled.write(&name, &evidence, Some(driver))
}

/// Takes the frame from a run.
fn saved(arguments: &Arguments, run: &Path) -> Result<u8, Failure> {
    let failing = &arguments.failing;
    let Candidate { document, case } = failing.candidate()?;
    let name = failing.name();
    free(arguments, &name)?;
    let case = alone(case);
    let adapter = Some(failing.adapter.as_str());
    let folder = arguments.unpack.folder(run)?;
    let recorded = recorded_frame(&folder, adapter, &failing.case, &case.scene)?;
    let frames = std::slice::from_ref(&recorded.frame);
    let judged = Judge::default().judge(0, &case, "", &recorded.adapter.limits, frames);
    if !judged.record.verdict.is_violation() {
        return Err(Failure {
            code: NOTHING,
            message: format!("{}: the frame of this case is not wrong", run.display()),
        });
    }
    let bundled = Bundled {
        arguments,
        case: &case,
        document: &document,
        symptom: &Symptom::of(&judged.record),
        adapter: &recorded.adapter,
        machine: &recorded.machine,
    };
    bundled.require_value()?;
    let recording = saved_recording(&recorded.adapter, &case.scene);
    let evidence = DriverResults {
        checks: Checks::Absent,
        recording: recording.map_err(|why| bundled.refused(&why))?,
        due: bundled.due(&recorded.frame, &judged.record)?,
        judged,
        frequency: None,
        finding: finding(&recorded.adapter, &failing.case)?,
        newest: None,
    };
    bundled.write(&name, &evidence, None)
}

/// Fails if the folder has a bundle of this name that must not be replaced.
fn free(arguments: &Arguments, name: &str) -> Result<(), Failure> {
    check_folder(&arguments.out).map_err(Failure::usage)?;
    etalon_bundle::free(&arguments.out, name, arguments.force).map_err(Failure::usage)
}

fn print(arguments: &Arguments, report: &Report, written: &Written) -> Result<(), Failure> {
    let FailingArguments { case, adapter, .. } = &arguments.failing;
    let frequency = report.frequency.map_or(String::new(), |[failed, runs]| {
        format!("  fails in {failed} of {runs} processes\n")
    });
    match arguments.failing.format {
        OutputFormat::Text => summarize(&format!(
            "{case} on {adapter}\n  {}\n  {}\n{frequency}  {}\nBundle: {}\nArchive: {}\n",
            report.title,
            report.sentence,
            report.way(),
            written.folder.display(),
            written.archive.display(),
        )),
        OutputFormat::Json => print_json(&json!({
            "case": case,
            "adapter": adapter,
            "title": report.title,
            "sentence": report.sentence,
            "clause": report.clause,
            "failed": report.frequency.map(|[failed, _]| failed),
            "runs": report.frequency.map(|[_, runs]| runs),
            "clean": report.checks != Checks::Absent,
            "folder": written.folder,
            "archive": written.archive,
        }))?,
    }
    Ok(())
}

/// Returns the shortest program that shows the bug when it is built and run, with that run. Returns the whole
/// program if no shorter one does, or if programs cannot run here.
fn shortest(
    program: impl Fn(Trim) -> Result<Program, Failure>,
    run: impl Fn(&Program) -> Result<Option<ProgramRun>, Failure>,
) -> Result<(Program, Option<ProgramRun>), Failure> {
    let untrimmed = program(Trim::Nothing)?;
    for trim in Trim::ALL {
        let shorter = program(trim)?;
        if shorter != untrimmed || trim == Trim::Nothing {
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
    Ok((untrimmed, None))
}

/// Returns the case without its variants: the program draws one picture.
fn alone(mut case: Case) -> Case {
    case.variants.clear();
    case
}

/// The case of a bundle, and the adapter on which it fails.
struct Bundled<'a> {
    arguments: &'a Arguments,
    case: &'a Case,
    document: &'a Value,
    symptom: &'a Symptom,
    adapter: &'a AdapterRecord,
    machine: &'a Machine,
}

/// A driver that can draw here.
#[derive(Clone, Copy)]
struct ReadyDriver<'a> {
    launch: &'a Launch,
    timeout: Duration,
}

/// The driver's results on the case.
struct DriverResults {
    checks: Checks,
    recording: Recording,
    judged: Judged,
    due: Due,
    /// The number of processes in which the case failed, and of all that drew it.
    frequency: Option<[u32; 2]>,
    finding: Option<Finding>,
    /// The newest release of a line, and whether it draws the case wrong.
    newest: Option<(String, bool)>,
}

impl Bundled<'_> {
    /// Returns the error of a case that has no bundle.
    fn refused(&self, why: &str) -> Failure {
        let FailingArguments { case, adapter, .. } = &self.arguments.failing;
        let other = match self.arguments.run {
            Some(_) => "",
            None => "; `etalon reduce` writes it as a case file",
        };
        Failure {
            code: UNEXPECTED,
            message: format!(
                "no bundle of {case} on {adapter}: {why} ({}){other}",
                self.symptom
            ),
        }
    }

    /// Writes the bundle, and prints a summary.
    fn write(
        &self,
        name: &str,
        evidence: &DriverResults,
        driver: Option<ReadyDriver<'_>>,
    ) -> Result<u8, Failure> {
        let arguments = self.arguments;
        let (program, ran) = self.program(evidence, driver)?;
        let mut files = self.files(evidence)?;
        let made = ran.as_ref().map_or(&[][..], |ran| ran.made.as_slice());
        files.splice(0..0, program.files.iter().chain(made).cloned());
        let run = run_command(driver);
        let built = ran.map(|ran| ran.line);
        let report = self.report(evidence, program.language, (run, built), &files);
        files.insert(0, File::text("report.md", "the report", report.markdown()));
        let written = etalon_bundle::write(&arguments.out, name, &files, arguments.force)
            .map_err(Failure::of)?;
        print(arguments, &report, &written)?;
        Ok(0)
    }

    /// Fails if the symptom is not a wrong value in one picture.
    fn require_value(&self) -> Result<(), Failure> {
        match self.symptom.subject {
            WrongPart::Picture(_) | WrongPart::Counter(_) => Ok(()),
            _ => Err(self.refused("it is not a wrong value in one picture")),
        }
    }

    fn evidence(&self, driver: ReadyDriver<'_>) -> Result<DriverResults, Failure> {
        self.require_value()?;
        let checks = self.checks()?;
        let recorded = self.recorded()?;
        let judged = self.judged(&recorded.frame)?;
        let demanded = self.due(&recorded.frame, &judged.record)?;
        let Some(recording) = recorded.recording else {
            let backend = &self.adapter.info.backend;
            return Err(self.refused(&format!("calls of backend {backend} are not recorded")));
        };
        let newest = self.arguments.latest.as_ref();
        Ok(DriverResults {
            checks,
            recording,
            judged,
            due: demanded,
            frequency: Some(self.frequency(driver)?),
            finding: finding(self.adapter, &self.arguments.failing.case)?,
            newest: newest.map(|line| self.newest(line, driver)).transpose()?,
        })
    }

    fn described<'a>(&'a self, evidence: &'a DriverResults) -> ReducedCase<'a> {
        ReducedCase {
            record: &evidence.judged.record,
            symptom: self.symptom,
            states: states(&self.document["scene"]),
        }
    }

    fn title(&self, finding: Option<&Finding>) -> String {
        match finding {
            Some(finding) => finding.title.clone(),
            None => format!("{}: wrong {}", self.adapter.info.device, self.symptom),
        }
    }

    /// Returns the program, and its run if it ran here. Fails if that run does not show the bug.
    fn program(
        &self,
        evidence: &DriverResults,
        driver: Option<ReadyDriver<'_>>,
    ) -> Result<(Program, Option<ProgramRun>), Failure> {
        let head = Head {
            title: self.title(evidence.finding.as_ref()),
            sentence: self.described(evidence).sentence(),
            scene: scene_text::lines(&self.case.scene),
            run: run_command(driver),
        };
        let (program, ran) = shortest(
            |trim| {
                etalon_bundle::program(&head, &evidence.recording, &evidence.due, trim)
                    .map_err(|e| self.refused(&format!("no program can be printed: {e}")))
            },
            |program| match driver {
                Some(ReadyDriver { launch, timeout }) => built_and_run(program, launch, timeout),
                None => Ok(None),
            },
        )?;
        if let Some(run) = ran.as_ref().filter(|run| run.status != Some(BUG)) {
            return Err(self.refused(&format!(
                "the program made of its calls does not show the bug: {}, {}",
                run.ending, run.line
            )));
        }
        Ok((program, ran))
    }

    /// Returns the files next to the program: the case and the pictures.
    fn files(&self, evidence: &DriverResults) -> Result<Vec<File>, Failure> {
        let FailingArguments { case, adapter, .. } = &self.arguments.failing;
        let origin = match self.arguments.run {
            Some(_) => format!("Drawn as {case} on {adapter}."),
            None => format!("Reduced from {case} on {adapter}."),
        };
        let mut document = self.document.clone();
        document["about"] = json!(self.described(evidence).about(&origin));
        let text = serde_json::to_string_pretty(&document).map_err(Failure::incomplete)?;
        let about = "the scene as a case file of etalon";
        let mut files = vec![File::text("case.json", about, format!("{text}\n"))];
        files.extend(pictures(&evidence.judged));
        Ok(files)
    }

    /// Returns the report. `run` is the command that runs the program, and `built` the program's last line of
    /// output, if it ran here; `files` are the files next to the report.
    fn report(
        &self,
        evidence: &DriverResults,
        language: Language,
        (run, built): (String, Option<String>),
        files: &[File],
    ) -> Report {
        let finding = evidence.finding.as_ref();
        let described = self.described(evidence);
        let record = &evidence.judged.record;
        let known = finding.map(|f| f.clause.clone()).filter(|c| !c.is_empty());
        let story = record.story.iter().map(story_text);
        Report {
            title: self.title(finding),
            sentence: described.sentence(),
            clause: known.or_else(|| described.clause()),
            device: self.adapter.info.clone(),
            machine: {
                let known = [self.machine.os.as_str(), self.machine.cpu.as_str()];
                let known = known.into_iter().filter(|text| !text.is_empty());
                known.collect::<Vec<_>>().join(", ")
            },
            versions: versions(finding, evidence.newest.clone()),
            expected: expected(record),
            states: states(&self.document["scene"]),
            frequency: evidence.frequency,
            checks: evidence.checks.clone(),
            language,
            run,
            built,
            search: search(self.adapter, self.symptom),
            story: story
                .flat_map(|s| s.lines().map(str::to_owned).collect::<Vec<_>>())
                .collect(),
            files: files
                .iter()
                .map(|f| (f.name.clone(), f.about.clone()))
                .collect(),
        }
    }

    /// Draws the case with validation, to check that its calls are valid.
    fn checks(&self) -> Result<Checks, Failure> {
        let FailingArguments { adapter, file, .. } = &self.arguments.failing;
        let opened = started(Query {
            names: std::slice::from_ref(adapter),
            file: file.adapter_file.as_deref(),
            validate: true,
            ..Query::default()
        });
        let Ok((_, mut worker)) = opened else {
            say!("{adapter} has no debug output or validation layer: the calls are not checked");
            return Ok(Checks::Absent);
        };
        let recorded = worker
            .recorded(&self.case.scene)
            .map_err(Failure::incomplete)?;
        match recorded.messages.into_iter().next() {
            None => Ok(Checks::Clean),
            // wgpu itself refuses invalid calls, so the message is about the native calls that wgpu makes.
            Some(message) if self.adapter.info.backend == "wgpu" => Ok(Checks::Below(message)),
            Some(message) => Err(self.refused(&format!(
                "the case does not keep to the rules of the API: {message}"
            ))),
        }
    }

    /// Draws the case and records the calls.
    fn recorded(&self) -> Result<Recorded, Failure> {
        let (_, mut worker) = started(Query {
            names: std::slice::from_ref(&self.arguments.failing.adapter),
            file: self.arguments.failing.adapter_file(),
            record: true,
            ..Query::default()
        })?;
        worker
            .recorded(&self.case.scene)
            .map_err(Failure::incomplete)
    }

    /// Judges the recorded frame. Fails if the frame does not show the case's symptom.
    fn judged(&self, frame: &Frame) -> Result<Judged, Failure> {
        let frames = std::slice::from_ref(frame);
        let judged = Judge::default().judge(0, self.case, "", &self.adapter.limits, frames);
        if self.symptom.covers(&Symptom::of(&judged.record)) {
            Ok(judged)
        } else {
            Err(Failure {
                code: UNEXPECTED,
                message: format!(
                    "the reduced case does not fail while its calls are recorded: it is {}",
                    judged.record.verdict
                ),
            })
        }
    }

    /// Returns the required values at the places where the frame is wrong.
    fn due(&self, frame: &Frame, record: &Record) -> Result<Due, Failure> {
        let wrong = record
            .wrong
            .iter()
            .filter(|w| w.band > etalon_frame::Band::Imprecise);
        let mut demanded = Due::default();
        for wrong in wrong.take(CHECKED) {
            demanded.texels.extend(self.texel(frame, wrong)?);
        }
        for (index, counter) in record.counters.iter().enumerate() {
            let range = counter.range();
            if !range.contains(counter.actual) {
                demanded.counters.push(DueCounter {
                    name: counter.name.clone(),
                    index,
                    range,
                });
            }
        }
        Ok(demanded)
    }

    /// Returns the required values of a sample in all attachments of the same size and sample count.
    fn texel(&self, frame: &Frame, wrong: &WrongTexel) -> Result<Option<DueTexel>, Failure> {
        let WrongTexel { x, y, sample, .. } = *wrong;
        let judged = judge_texel(self.case, 0, &self.adapter.limits, [x, y], Some(frame));
        let (judgement, _) = judged.map_err(Failure::incomplete)?;
        let is_asked = |image: &&etalon_frame::ImageInfo| {
            let is =
                |m: &ChannelMismatch| m.attachment == image.attachment && m.aspect == image.aspect;
            wrong.channels.iter().any(is)
        };
        let Some(group) = judgement
            .legal
            .images
            .iter()
            .find(is_asked)
            .map(|i| i.group)
        else {
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

    /// Returns the number of processes in which the case fails with its symptom, and the number of all
    /// processes.
    fn frequency(&self, driver: ReadyDriver<'_>) -> Result<[u32; 2], Failure> {
        let (runs, at_once) = if self.adapter.info.backend == "webgpu" {
            (BROWSERS, 1)
        } else {
            (RUNS, processors().min(AT_ONCE))
        };
        let begun = AtomicU32::new(0);
        let failed = share(at_once, || {
            let mut failed = 0;
            while begun.fetch_add(1, Ordering::Relaxed) < runs {
                let mut worker = Worker::start(driver.launch).map_err(Failure::incomplete)?;
                let (record, _) = worker.record(self.case, driver.timeout);
                failed += u32::from(self.symptom.covers(&Symptom::of(&record)));
            }
            Ok(failed)
        });
        let failed = failed.into_iter().sum::<Result<u32, Failure>>()?;
        Ok([failed, runs])
    }

    /// Returns the newest release of a line, and whether it draws the case wrong.
    fn newest(&self, line: &str, driver: ReadyDriver<'_>) -> Result<(String, bool), Failure> {
        let file = self.arguments.failing.adapter_file();
        let mut releases = releases_of(file, line).map_err(Failure::usage)?;
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
        let (record, _) = worker.record(self.case, driver.timeout);
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
    let sample = [wrong.x, wrong.y, wrong.sample];
    let Some(ringed) = image.and_then(|i| etalon_report::ringed_pictures(i, sample)) else {
        return Vec::new();
    };
    let [legal, actual, difference] = ringed.pictures;
    let shown = if ringed.alpha {
        ": alpha as grey, since nothing else differs"
    } else {
        ""
    };
    let allowed = format!("the allowed picture; the lowest values if several are allowed{shown}");
    let back = format!("the picture that came back{shown}");
    let about = "wrong texels in orange, the first with a ring";
    vec![
        File::new("expected.png", &allowed, legal),
        File::new("actual.png", &back, actual),
        File::new("difference.png", about, difference),
    ]
}

/// Returns the finding that names a case on an adapter.
fn finding(adapter: &AdapterRecord, case: &str) -> Result<Option<Finding>, Failure> {
    let findings = expectations::built_in()?;
    Ok(findings
        .first_bad(adapter, case)
        .and_then(|known| match &known.source {
            KnownSource::Finding(finding) => Some(Finding::clone(finding)),
            KnownSource::Entry { .. } => None,
        }))
}

fn versions(finding: Option<&Finding>, newest: Option<(String, bool)>) -> Option<BadReleases> {
    let range = finding.and_then(|f| f.versions.clone());
    if range.is_none() && newest.is_none() {
        return None;
    }
    Some(BadReleases {
        bad: range.unwrap_or_default(),
        newest,
    })
}

/// Returns the first wrong values in words.
fn expected(record: &Record) -> Vec<WrongValue> {
    const SHOWN: usize = 4;
    let mut lines = Vec::new();
    for wrong in record.wrong.iter().take(SHOWN) {
        for m in &wrong.channels {
            let value = |code: u32| {
                let value = m.encoding.value_of_order(m.encoding.order_of_code(code));
                if m.encoding.is_float() {
                    format!("{value}")
                } else {
                    format!("{code} ({value:.4})")
                }
            };
            let channel = m.aspect.channel(m.channel.into());
            let sample = match wrong.sample {
                0 => String::new(),
                n => format!(", sample {n}"),
            };
            lines.push(WrongValue {
                place: format!(
                    "{channel} of {}, texel {},{}{sample}",
                    m.attachment, wrong.x, wrong.y
                ),
                due: if m.low == m.high {
                    value(m.low)
                } else {
                    format!("{} to {}", value(m.low), value(m.high))
                },
                actual: value(m.actual),
            });
        }
    }
    for counter in &record.counters {
        if !counter.range().contains(counter.actual) {
            lines.push(WrongValue {
                place: format!("counter {}", counter.name),
                due: counter.range().to_string(),
                actual: counter.actual.to_string(),
            });
        }
    }
    lines
}

/// Returns search words under which a bug tracker might list the bug.
fn search(adapter: &AdapterRecord, symptom: &Symptom) -> Vec<String> {
    let driver = adapter
        .info
        .device
        .split([' ', '('])
        .next()
        .unwrap_or_default();
    let mut words = vec![driver.to_owned()];
    let operations = symptom.operations.iter().chain(&symptom.last);
    words.extend(operations.map(|o| o.name().to_owned()));
    words.retain(|word| !word.is_empty());
    words.dedup();
    words
}

/// Returns the command that runs the program on the driver, quoted for a shell; empty without a driver.
fn run_command(driver: Option<ReadyDriver<'_>>) -> String {
    let Some(ReadyDriver { launch, .. }) = driver else {
        return String::new();
    };
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

/// Returns a word quoted for a shell, without line breaks.
fn quoted(word: &str) -> String {
    etalon_report::quoted(&word.replace(['\n', '\r', '\0'], " "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_the_environment_are_quoted_as_one_shell_word() {
        assert_eq!(quoted("llvmpipe"), "llvmpipe");
        assert_eq!(quoted("a b; rm -rf $HOME"), "'a b; rm -rf $HOME'");
        assert_eq!(quoted("it's"), "'it'\\''s'");
        assert_eq!(quoted(""), "''");
    }
}
