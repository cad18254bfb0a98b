//! The names of the files in a recorded folder, and the folder's kind.

use std::fs;
use std::path::Path;

/// The file of a run folder that holds the header and the records.
pub const RUN_FILE: &str = "run.jsonl";
/// The file of a bench folder that holds the header and the frame times.
pub const BENCH_FILE: &str = "bench.jsonl";
/// The file of a run folder that lists the selected ids, one per line, before sharding.
pub const CASES_FILE: &str = "cases.txt";
/// The file of a merged run that lists the adapter and case of each record that no part has.
pub const MISSING_FILE: &str = "missing.txt";
/// The file of a run folder that lists the dead expectations.
pub const DEAD_FILE: &str = "dead-expectations.json";
/// The file of a run folder with the records beside those of its selected cases.
pub const BESIDE_FILE: &str = "beside.json";
/// The file that lists the files that etalon wrote into a folder: [`LIST_MARK`], then a path per line, with `/` as
/// separator.
pub(crate) const LIST: &str = ".files";
/// The first line of a list. A file of the same name without it is somebody else's.
pub(crate) const LIST_MARK: &str =
    "# The files that etalon wrote here. Only these are replaced or removed.";
/// The file of a search of random scenes.
pub const FUZZ_FILE: &str = "fuzz.jsonl";
/// The file of a search over releases.
pub const VERSIONS_FILE: &str = "versions.jsonl";
/// The folder of a search over releases in which it draws, with `/` after it. It is a run folder.
pub const WORK_FOLDER: &str = "work/";
/// The folder of a run with frame times, with `/` after it. It is a bench folder.
pub const TIMED_FOLDER: &str = "timed/";
/// The file of a hunt for planted bugs.
pub const HUNT_FILE: &str = "mutants.json";
/// The folder of frame files in a run folder.
pub(crate) const FRAMES: &str = "frames";
/// The folder of pictures in a run folder.
pub(crate) const PICTURES: &str = "pictures";

/// The kind of a folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FolderKind {
    /// A bench: `bench.jsonl`.
    Bench,
    /// A run: `run.jsonl`.
    Run,
    /// Random scenes that fail: `fuzz.jsonl`.
    Fuzz,
    /// Cases over the releases of a driver: `versions.jsonl`.
    Versions,
    /// A hunt for planted bugs: `mutants.json`.
    Hunt,
}

impl FolderKind {
    /// Every kind.
    pub(crate) const ALL: [Self; 5] = [
        Self::Bench,
        Self::Run,
        Self::Fuzz,
        Self::Versions,
        Self::Hunt,
    ];

    /// Returns the noun for messages: run, bench, search or hunt.
    pub fn noun(self) -> &'static str {
        match self {
            Self::Bench => "bench",
            Self::Run => "run",
            Self::Fuzz => "search of random scenes",
            Self::Versions => "search over releases",
            Self::Hunt => "hunt",
        }
    }

    /// Returns the file that begins with the header.
    pub fn file(self) -> &'static str {
        match self {
            Self::Bench => BENCH_FILE,
            Self::Run => RUN_FILE,
            Self::Fuzz => FUZZ_FILE,
            Self::Versions => VERSIONS_FILE,
            Self::Hunt => HUNT_FILE,
        }
    }

    /// Returns the names at the top of a folder of this kind, with `/` after those of folders.
    pub fn names(self) -> &'static [&'static str] {
        match self {
            Self::Bench => &[
                BENCH_FILE,
                "index.html",
                "bencher.json",
                "benchmark-action.json",
                "matrix.html",
                "matrix.csv",
                BESIDE_FILE,
            ],
            Self::Run => &[
                RUN_FILE,
                CASES_FILE,
                MISSING_FILE,
                DEAD_FILE,
                BESIDE_FILE,
                "index.html",
                "details.html",
                "methods.html",
                "methods.csv",
                "junit.xml",
                "ctrf.json",
                "summary.md",
                "frames/",
                "pictures/",
                "cases/",
                "records/",
                "results/",
                TIMED_FOLDER,
            ],
            Self::Fuzz => &[FUZZ_FILE, "found/", "known/"],
            Self::Versions => &[VERSIONS_FILE, "versions.html", WORK_FOLDER],
            Self::Hunt => &[HUNT_FILE, "mutants.html", "recall.txt"],
        }
    }

    /// Returns the names of the reports among [`FolderKind::names`]: they are made from the records.
    pub fn reports(self) -> impl Iterator<Item = &'static str> {
        const RECORDED: [&str; 8] = [
            CASES_FILE,
            MISSING_FILE,
            DEAD_FILE,
            BESIDE_FILE,
            "frames/",
            "pictures/",
            WORK_FOLDER,
            TIMED_FOLDER,
        ];
        let names = self.names().iter().copied();
        names.filter(move |name| *name != self.file() && !RECORDED.contains(name))
    }

    /// Returns the kind of a folder, by the file in it; `None` if it holds no such file or is not a folder. A link
    /// counts as the file, so that an error names it.
    pub fn of(folder: &Path) -> Option<Self> {
        let mut kinds = Self::ALL.into_iter();
        kinds.find(|kind| {
            let found = fs::symlink_metadata(folder.join(kind.file()));
            found.is_ok_and(|found| found.is_file() || found.is_symlink())
        })
    }
}
