//! `--history`: compares a run with the previous run of each adapter.

use crate::failure::Failure;
#[cfg(not(feature = "history"))]
use crate::failure::left_out;
#[cfg(feature = "history")]
use crate::history_file::failure;
use crate::labels::LabelArguments;
use crate::output::say;
use clap::Args;
#[cfg(feature = "history")]
use etalon_history::{History, HistoryError};
use etalon_record::{Labels, Run};
use etalon_report::{RunNews, quoted};
use std::borrow::Cow;
use std::path::{Path, PathBuf};

#[derive(Clone, Debug, Args)]
pub(crate) struct NewsArguments {
    /// Compare with the previous run of each adapter in this history, and report what is new first. Bad
    /// verdicts that `etalon history triage` marks as real or ignored do not count. A missing file is
    /// reported and otherwise ignored
    #[arg(long, value_name = "FILE")]
    pub(crate) history: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) labels: LabelArguments,
}

impl NewsArguments {
    /// Refuses invalid labels and an unusable file, before anything is drawn.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        let labels = self.labels.labels()?;
        let Some(path) = &self.history else {
            return if labels.is_empty() {
                Ok(())
            } else {
                Err(Failure::usage("--label is for --history: name its file"))
            };
        };
        check_file(path)
    }

    /// Returns the news of a run; `None` without a history, or if it cannot be read, which is printed.
    pub(crate) fn news(&self, run: &Run) -> Result<Option<RunNews>, Failure> {
        let Some(path) = &self.history else {
            return Ok(None);
        };
        Ok(news_since(path, run, &self.labels.labels()?))
    }

    /// If a history was named, prints the command that adds the run to it.
    pub(crate) fn tell_how_to_add(&self, folder: &Path) {
        if let Some(path) = &self.history {
            let words = ["--db".to_owned(), path.display().to_string()].into_iter();
            let words = words.chain(self.labels.words().map(str::to_owned));
            let words: Vec<String> = words.map(|word| quoted(&word)).collect();
            let folder = quoted(&folder.display().to_string());
            say!(
                "add it with: etalon history add {folder} {}",
                words.join(" ")
            );
        }
    }
}

#[cfg(feature = "history")]
fn check_file(path: &Path) -> Result<(), Failure> {
    match History::open_read(path) {
        Ok(_) | Err(HistoryError::None { .. } | HistoryError::Busy { .. }) => Ok(()),
        Err(error) => Err(failure(error)),
    }
}

#[cfg(not(feature = "history"))]
fn check_file(_: &Path) -> Result<(), Failure> {
    Err(Failure::usage(format_args!(
        "--history: {}",
        left_out("history")
    )))
}

#[cfg(feature = "history")]
fn news_since(path: &Path, run: &Run, labels: &Labels) -> Option<RunNews> {
    History::open_read(path)
        .and_then(|history| RunNews::of(&history, run, labels))
        .inspect_err(|error| say!("{error}; the run is judged without a history"))
        .ok()
}

/// Is not reached: `check_file` has refused the history.
#[cfg(not(feature = "history"))]
fn news_since(_: &Path, _: &Run, _: &Labels) -> Option<RunNews> {
    None
}

/// Returns the run as its reports show it.
pub(crate) fn shown<'r>(run: &'r Run, news: Option<&RunNews>) -> Cow<'r, Run> {
    news.map_or(Cow::Borrowed(run), |news| news.settle(run))
}
