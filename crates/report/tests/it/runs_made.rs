//! Runs to compare.

use crate::synthetic::{adapter, header};
use etalon_frame::{Accuracy, Api, Aspect, CounterKind, CounterOutcome, Distance};
use etalon_record::{Header, Measured, Record, RunWriter, Seconds, Times, Verdict};
use etalon_report::runs::{RunDiff, diff, write_page};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Two folders for runs.
pub(crate) struct Two {
    pub(crate) folder: TempDir,
}

impl Two {
    pub(crate) fn new() -> Self {
        Self {
            folder: tempfile::tempdir().unwrap(),
        }
    }

    pub(crate) fn before(&self) -> PathBuf {
        self.folder.path().join("before")
    }

    pub(crate) fn after(&self) -> PathBuf {
        self.folder.path().join("after")
    }

    pub(crate) fn diff(&self) -> RunDiff {
        diff(&self.before(), &self.after(), None).unwrap()
    }

    pub(crate) fn page(&self, found: &RunDiff) -> String {
        let path = self.folder.path().join("diff.html");
        let folders = [self.before(), self.after()];
        let written = write_page(&path, found, [&folders[0], &folders[1]]).unwrap();
        fs::read_to_string(written).unwrap()
    }
}

pub(crate) fn one_adapter(cases: u64) -> Header {
    header(cases, vec![adapter("gl:a", Api::OpenGl)])
}

pub(crate) fn record_all(folder: &Path, header: &Header, records: &[Record]) {
    let mut writer = RunWriter::create(folder, header).unwrap();
    records.iter().for_each(|r| writer.append(r).unwrap());
}

/// A record with a value for everything that can differ.
pub(crate) fn rich(case: &str) -> Record {
    let mut record = Record::new(case, "gl:a", Verdict::Imprecise);
    record.texels.total = 256;
    record.texels.imprecise = 3;
    record.accuracy = vec![Accuracy {
        channels: 1024,
        mean: 0.25,
        max: 1.0,
        ..Accuracy::none(Aspect::Color, None)
    }];
    record.counters = vec![CounterOutcome {
        name: "samples".to_owned(),
        kind: CounterKind::SamplesPassed,
        low: 100,
        high: Some(256),
        actual: 144,
        band: None,
    }];
    record.measured = Some(Measured {
        question: "transparency".to_owned(),
        scene: "windows".to_owned(),
        method: "sorted".to_owned(),
        parameter: None,
        distance: Distance {
            rmse: 0.01,
            ..Distance::default()
        },
        time: Some(Times {
            samples: 9,
            wall: 0.01,
            cpu: 0.001,
            gpu: None,
            interval: None,
        }),
        sizes: Vec::new(),
        cost: None,
        passes: 1,
        draws: 3,
        fragments: Some(4096),
        bytes: 1024,
        picture: None,
        truth_picture: None,
    });
    record.seconds = Seconds {
        draw: 0.01,
        judge: 0.001,
    };
    record
}
