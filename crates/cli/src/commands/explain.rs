//! `etalon explain`.

use crate::cases::{find, library};
use crate::discovery::{discover, refuse_absent};
use crate::failure::{Failure, UNEXPECTED};
use crate::flags::AdapterFileArguments;
use crate::output::print;
use crate::recorded_frame::recorded_frame;
use crate::saved_run::UnpackArguments;
use clap::Args;
use etalon_adapters::Query;
use etalon_assert::{AskedTexel, AssertError};
use etalon_backend::Backend;
use etalon_case::Case;
use etalon_cpu::CpuBackend;
use etalon_frame::{Band, Frame, Limits};
use etalon_judge::Judge;
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) file: AdapterFileArguments,
    /// Id of the case
    #[arg(value_name = "CASE")]
    pub(crate) case: String,
    /// Column and row of the texel, counted from the top left corner. Default: the first wrong one
    #[arg(long, value_name = "X,Y", value_parser = parse_texel)]
    pub(crate) texel: Option<[u32; 2]>,
    /// Explain only this sample, counted from 0. Default: all samples of the texel
    #[arg(long, value_name = "S")]
    pub(crate) sample: Option<u32>,
    /// Draw the case on this adapter and judge the texel
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,
    /// Draw nothing, and judge the texel in the frame that this run keeps: a run folder, or a run that the page saved
    /// (`*.tar.gz`). If it has several adapters, choose one with --adapter
    #[arg(long, value_name = "RUN")]
    pub(crate) run: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) unpack: UnpackArguments,
    /// Also compare the texel with the yardstick, the band of good quality within the legal values
    #[arg(long)]
    pub(crate) yardstick: bool,
    /// Read case files from this folder instead of the built-in ones
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
}

/// Explains one texel by the rules; with an adapter, also judges the value that it returned.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let library = library(arguments.cases.as_ref())?;
    let found = find(&library, &arguments.case)?;
    let case = found.build().map_err(Failure::usage)?;
    let (limits, frames) = match (&arguments.run, &arguments.adapter) {
        (Some(run), adapter) => {
            let folder = arguments.unpack.folder(run)?;
            let recorded = recorded_frame(&folder, adapter.as_deref(), &case.id, &case.scene)?;
            (recorded.adapter.limits, vec![recorded.frame])
        }
        (None, None) => (CpuBackend::new("cpu").limits().clone(), Vec::new()),
        (None, Some(name)) => draw(name, arguments.file.adapter_file.as_deref(), &case)?,
    };
    let texel = match arguments.texel {
        Some(texel) => texel,
        None => first_wrong(&case, &limits, &frames)?,
    };
    let asked = AskedTexel {
        case: &case,
        texel,
        sample: arguments.sample,
        frames: &frames,
    };
    let explained = asked.explain(&limits, arguments.yardstick)?;
    print(&explained.text(&case))?;
    let bad = explained.worst() > Some(Band::Imprecise);
    Ok(if bad && case.judged_as.is_none() {
        UNEXPECTED
    } else {
        0
    })
}

/// Returns the first wrong texel of a drawn case. A case with only wrong counters has the first texel.
fn first_wrong(case: &Case, limits: &Limits, frames: &[Frame]) -> Result<[u32; 2], Failure> {
    if frames.is_empty() {
        return Err(Failure::usage(
            "name a texel by --texel X,Y; or a driver that draws the case by --adapter, whose first wrong texel is \
             explained",
        ));
    }
    let record = Judge::default().judge(0, case, "", limits, frames).record;
    match record.wrong.first() {
        Some(wrong) => Ok([wrong.x, wrong.y]),
        None if record.verdict.is_violation() => Ok([0, 0]),
        None => Err(Failure::nothing(format!(
            "no texel of {} is wrong ({}); --texel X,Y explains any",
            case.id, record.verdict
        ))),
    }
}

/// Draws the case on an adapter. The frame of the case's own scene comes first, then those of its variants.
fn draw(name: &str, file: Option<&Path>, case: &Case) -> Result<(Limits, Vec<Frame>), Failure> {
    let adapters = discover(&Query {
        names: &[name.to_owned()],
        file,
        ..Query::default()
    })?;
    refuse_absent(std::slice::from_ref(&name.to_owned()), &adapters)?;
    let Some((_, mut worker)) = adapters.ready.into_iter().next() else {
        return Err(Failure::usage(format!("adapter {name} cannot be used")));
    };
    let limits = worker.hello.limits.clone();
    if let Some(missing) = limits.missing(&case.requirements()) {
        return Err(Failure::usage(format!("{name} does not support {missing}")));
    }
    let frames = worker.draw(case).map_err(Failure::incomplete)?;
    if frames.is_empty() {
        return Err(Failure::incomplete("no frame was returned"));
    }
    Ok((limits, frames))
}

impl From<AssertError> for Failure {
    fn from(error: AssertError) -> Self {
        match error {
            AssertError::Unfit(_) => Self::incomplete(error),
            _ => Self::usage(error),
        }
    }
}

fn parse_texel(text: &str) -> Result<[u32; 2], String> {
    let wrong = || "expected X,Y: two whole numbers".to_owned();
    let (x, y) = text.split_once(',').ok_or_else(wrong)?;
    let number = |t: &str| t.trim().parse().map_err(|_| wrong());
    Ok([number(x)?, number(y)?])
}
