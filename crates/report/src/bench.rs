//! Frame times: the page, the files for dashboards, the terminal table, and the comparison of two
//! benches. All of it is computed anew from the recorded samples.

mod data;
mod page;
mod picture;
mod terminal;

pub(crate) use data::{Figures, samples};
pub(crate) use page::frame;
pub use terminal::{bench_table, diff_table};

use crate::export::dashboards;
use crate::{ReportError, replace};
use etalon_record::{AdapterRecord, Bench};
use std::path::{Path, PathBuf};

/// The files that [`write_bench`] made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenBench {
    /// The page for people.
    pub html: PathBuf,
    /// Wall times in Bencher's metric format.
    pub bencher: PathBuf,
    /// Wall times for github-action-benchmark, tool `customSmallerIsBetter`.
    pub action: PathBuf,
}

/// Writes `index.html`, `bencher.json` and `benchmark-action.json` into a bench folder. Each is
/// written beside its place and then renamed, so that a reader never sees half a report.
///
/// # Errors
/// When the folder holds no readable bench, or cannot be written to.
pub fn write_bench(folder: &Path) -> Result<WrittenBench, ReportError> {
    let bench = Bench::read(folder)?;
    let figures = Figures::new(&bench);
    let html = page::page(&bench, &figures);
    let bencher = dashboards::bencher(&figures)?;
    let action = dashboards::action(&figures)?;
    Ok(WrittenBench {
        html: replace(folder, "index.html", html.as_bytes())?,
        bencher: replace(folder, "bencher.json", &bencher)?,
        action: replace(folder, "benchmark-action.json", &action)?,
    })
}

/// The two kinds of adapters, which never share a ranking.
pub(crate) const KINDS: [(bool, &str); 2] = [(true, "Software"), (false, "Hardware")];

/// Whether an adapter is the processor. One that no header names counts as hardware, which is
/// compared with no ruler.
pub(crate) fn software(adapter: Option<&AdapterRecord>) -> bool {
    adapter.is_some_and(|a| a.software)
}

/// `1.234 ms`: four digits, in the unit that leaves one to three before the point.
pub(crate) fn duration(seconds: f64) -> String {
    let (value, unit) = match seconds {
        s if s >= 1.0 => (s, "s"),
        s if s >= 1e-3 => (s * 1e3, "ms"),
        s if s >= 1e-6 => (s * 1e6, "µs"),
        s => (s * 1e9, "ns"),
    };
    let digits = match value {
        v if v >= 100.0 => 1,
        v if v >= 10.0 => 2,
        _ => 3,
    };
    format!("{value:.digits$} {unit}")
}

/// A ratio as a signed change: `+3.1 %`; as a factor from two on.
pub(crate) fn change(ratio: f64) -> String {
    if !ratio.is_finite() {
        "∞".to_owned()
    } else if ratio >= 2.0 {
        format!("×{ratio:.2}")
    } else {
        format!("{:+.1} %", (ratio - 1.0) * 100.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_have_four_digits_and_a_unit() {
        assert_eq!(duration(1.5), "1.500 s");
        assert_eq!(duration(0.0123456), "12.35 ms");
        assert_eq!(duration(0.000_234_56), "234.6 µs");
        assert_eq!(duration(5e-9), "5.000 ns");
    }

    #[test]
    fn changes_have_a_sign() {
        assert_eq!(change(1.031), "+3.1 %");
        assert_eq!(change(0.9), "-10.0 %");
        assert_eq!(change(2.5), "×2.50");
        assert_eq!(change(f64::INFINITY), "∞");
    }
}
