//! `etalon judge`.

use super::run::{LATEST, verdicts};
use crate::cases::library;
use crate::catalogue::{CataloguePictures, catalogue};
use crate::expectations::ExpectArguments;
use crate::failure::{Failure, IMPROVED, INCOMPLETE, UNEXPECTED};
use crate::flags::OutputFormat;
use crate::frame_folders::manifests;
use crate::frame_limits::{RulesApi, adapter};
use crate::out_folder::Out;
use crate::output::{print_json, summarize, table_options};
use crate::processors::processors;
use crate::{idle, provenance};
use clap::Args;
use etalon_case::{Case, Globs};
use etalon_frame::Frame;
use etalon_frame::threads::each;
use etalon_judge::{
    IMPRECISE_FRAMES, Judge, Judged, ShownDetail, Truths, measured, settled, shorten, undrawn,
};
use etalon_record::{
    AdapterRecord, Expectations, FolderKind, Header, Run, RunWriter, Settings, Verdict,
    selection_digest,
};
use etalon_report::RunReport;
use serde_json::json;
use std::collections::BTreeMap;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Ids of cases, or globs, whose frames are judged. Default: all in the folder
    #[arg(value_name = "CASE")]
    pub(crate) globs: Vec<String>,
    /// Folder with the frames: each has a frame.json, here or in a folder below
    #[arg(long, value_name = "DIR")]
    pub(crate) frame: PathBuf,
    /// The API whose rules bind the frames. Default: that of --limits, or webgpu
    #[arg(long, value_enum)]
    pub(crate) rules: Option<RulesApi>,
    /// What the device can do, as the first line of the open protocol says it. Default: what every device of the
    /// API can do
    #[arg(long, value_name = "FILE")]
    pub(crate) limits: Option<PathBuf>,
    /// Name of the adapter in the records
    #[arg(long, value_name = "NAME", default_value = "external:frames", value_parser = parse_name)]
    pub(crate) name: String,
    /// Read case files from this folder instead of the built-in ones
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
    /// Folder for records and reports
    #[arg(long, value_name = "DIR", default_value = LATEST)]
    pub(crate) out: PathBuf,
    /// Replace the run in the folder
    #[arg(long)]
    pub(crate) force: bool,
    #[command(flatten)]
    pub(crate) expected: ExpectArguments,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

fn parse_name(text: &str) -> Result<String, String> {
    let name = text.strip_prefix("external:").unwrap_or_default();
    let fine = |c: char| c.is_ascii_alphanumeric() || "-_.@".contains(c);
    if !name.is_empty() && name.len() <= 80 && name.chars().all(fine) {
        Ok(text.to_owned())
    } else {
        Err("expected external:NAME, of letters, digits, `-`, `_`, `.` and `@`".to_owned())
    }
}

/// Judges frames from files, writes records and reports.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let adapter = adapter(
        &arguments.name,
        arguments.rules,
        arguments.limits.as_deref(),
    )?;
    let expectations = arguments.expected.read(&[])?;
    let library = library(arguments.cases.as_ref())?;
    let mut manifests = manifests(&arguments.frame)?;
    let folder = arguments.frame.display();
    for glob in &arguments.globs {
        let glob_alone = Globs::new(std::slice::from_ref(glob)).map_err(Failure::usage)?;
        if !manifests.keys().any(|id| glob_alone.matches(id)) {
            return Err(Failure::nothing(format!("{folder} has no frame of {glob}")));
        }
    }
    let globs = Globs::new(&arguments.globs).map_err(Failure::usage)?;
    manifests.retain(|id, _| globs.matches(id));
    if manifests.is_empty() {
        return Err(Failure::nothing(format!("{folder} has no frame.json")));
    }
    let cases = manifests
        .values()
        .map(|m| m.case(&library, &arguments.frame));
    let cases = cases.collect::<Result<Vec<Case>, Failure>>()?;
    let claim = Out {
        folder: &arguments.out,
        kind: FolderKind::Run,
        latest: Some(LATEST),
        cases: arguments.cases.as_deref(),
        resume: None,
        force: arguments.force,
    }
    .claim()?;
    let ids = || cases.iter().map(|case| case.id.as_str());
    let header = Header {
        provenance: provenance::here(),
        settings: Settings {
            selection: selection_digest(ids()),
            ..Settings::default()
        },
        ..Header::new(vec![adapter.clone()], cases.len() as u64)
    };
    let judging = Judging {
        adapter: &adapter,
        expectations: &expectations,
        judge: Judge::default(),
        truths: Truths::default(),
    };
    // Everything is read before an earlier run is replaced.
    let numbered: Vec<_> = manifests.values().zip(&cases).enumerate().collect();
    let judged = each(processors(), &numbered, |(number, (manifest, case))| {
        let frames = manifest.frames(&arguments.frame, case)?;
        Ok(judging.judged(*number, case, &frames))
    });
    let judged = judged.into_iter().collect::<Result<Vec<_>, Failure>>()?;
    let _lock = claim.take()?;
    let mut writer = RunWriter::create(&arguments.out, &header).map_err(Failure::of)?;
    writer.write_cases(ids()).map_err(Failure::of)?;
    let frames = writer.frames();
    let mut imprecise: BTreeMap<String, u32> = BTreeMap::new();
    for Judged { mut record, frame } in judged {
        let file = record.parts().file().to_owned();
        let count = imprecise.entry(file).or_default();
        *count += u32::from(record.verdict == Verdict::Imprecise);
        let kept = frame.filter(|_| record.verdict.is_violation() || *count <= IMPRECISE_FRAMES);
        shorten(&mut record, ShownDetail::Whole, kept.is_some());
        if let Some(frame) = kept {
            let path = frames.write_frame(&frame).map_err(Failure::incomplete)?;
            record.frame = Some(path);
        }
        writer.append(&record).map_err(Failure::incomplete)?;
    }
    writer.sync().map_err(Failure::incomplete)?;
    let run = Run::read(&arguments.out).map_err(Failure::incomplete)?;
    let catalogue = catalogue(&library, &cases, &CataloguePictures::default());
    let written = RunReport {
        folder: &arguments.out,
        run: &run,
        catalogue: Some(&catalogue),
        news: None,
        deqp: false,
    }
    .write()
    .map_err(Failure::incomplete)?;
    if arguments.format == OutputFormat::Json {
        print_json(&json!({
            "records": run.records.len(),
            "unexpected": run.unexpected(),
            "verdicts": verdicts(&run),
            "folder": arguments.out,
            "report": written.html,
        }))?;
    } else {
        summarize(&etalon_report::table(&run, table_options()));
        summarize(&format!("\nReport: {}\n", written.html.display()));
        summarize(&format!("{}\n", etalon_report::conclusion(&run)));
    }
    Ok(if run.unexpected() > 0 {
        UNEXPECTED
    } else if idle::report(&run) {
        INCOMPLETE
    } else if run.records.iter().any(|record| record.improvement()) {
        IMPROVED
    } else {
        0
    })
}

/// What all frames are judged by.
struct Judging<'a> {
    adapter: &'a AdapterRecord,
    expectations: &'a Expectations,
    judge: Judge,
    truths: Truths,
}

impl Judging<'_> {
    fn judged(&self, number: usize, case: &Case, frames: &[Frame]) -> Judged {
        let (adapter, name) = (self.adapter, &self.adapter.info.name);
        let undrawn = undrawn(case, adapter, self.expectations, None);
        let mut judged = match undrawn {
            Some(record) => Judged {
                record,
                frame: None,
            },
            None => self
                .judge
                .judge(number, case, name, &adapter.limits, frames),
        };
        if let Some(method) = &case.method
            && judged.record.is_drawn()
            && let Some(frame) = frames.first()
        {
            let truth = self.truths.get(method);
            judged.record.measured = measured(case, &truth, frame);
        }
        judged.record = settled(judged.record, self.expectations, adapter);
        judged
    }
}
