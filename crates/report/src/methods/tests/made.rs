//! Runs made up for tests, with one line per record.

use etalon_frame::{AdapterInfo, Api, Distance, Limits};
use etalon_record::{
    AdapterRecord, Header, Measured, Parameter, Provenance, Record, Run, Times, Verdict,
};

/// A record with all values that claims use, and defaults for the others.
#[derive(Clone, Debug)]
pub(crate) struct Made {
    pub(crate) adapter: &'static str,
    /// Question, scene, method and further axes: `culling/box/method=back/size=4`.
    pub(crate) id: String,
    pub(crate) parameter: Option<(&'static str, f64)>,
    pub(crate) rmse: f64,
    pub(crate) max: f64,
    pub(crate) wall: Option<f64>,
    pub(crate) interval: Option<[f64; 2]>,
    pub(crate) passes: u32,
    pub(crate) draws: u32,
    pub(crate) fragments: Option<u64>,
}

impl Made {
    /// Returns a method of a scene on `cpu`, exact, in a millisecond and one pass.
    pub(crate) fn new(id: &str) -> Self {
        Self {
            adapter: "cpu",
            id: id.to_owned(),
            parameter: None,
            rmse: 0.0,
            max: 0.0,
            wall: Some(0.001),
            interval: None,
            passes: 1,
            draws: 1,
            fragments: None,
        }
    }

    pub(crate) fn at(self, parameter: &'static str, value: f64) -> Self {
        let parameter = Some((parameter, value));
        Self { parameter, ..self }
    }

    pub(crate) fn off(self, rmse: f64) -> Self {
        let max = rmse;
        Self { rmse, max, ..self }
    }

    pub(crate) fn on(self, adapter: &'static str) -> Self {
        Self { adapter, ..self }
    }

    fn record(&self) -> Record {
        let mut parts = self.id.split('/');
        let mut next = || parts.next().unwrap_or_default().to_owned();
        let (question, scene) = (next(), next());
        let method = parts.find_map(|p| p.strip_prefix("method="));
        let method = method.unwrap_or_default().to_owned();
        let mut id = format!("methods/{}", self.id);
        if let Some((name, value)) = self.parameter {
            id += &format!("/{name}={value}");
        }
        let mut record = Record::new(id, self.adapter, Verdict::Measured);
        record.measured = Some(Measured {
            question,
            scene,
            method,
            parameter: self.parameter.map(|(name, value)| Parameter {
                name: name.to_owned(),
                value,
            }),
            distance: Distance {
                rmse: self.rmse,
                max: self.max,
                ..Distance::default()
            },
            time: self.wall.map(|wall| Times {
                samples: 9,
                wall,
                cpu: wall,
                gpu: None,
                interval: self.interval,
            }),
            sizes: Vec::new(),
            cost: None,
            passes: self.passes,
            draws: self.draws,
            fragments: self.fragments,
            bytes: 4,
            picture: None,
            truth_picture: None,
        });
        record
    }
}

/// Returns a run of these records. Adapters whose names begin with `hw` are hardware.
pub(crate) fn run(made: &[Made]) -> Run {
    let mut names: Vec<&str> = made.iter().map(|m| m.adapter).collect();
    names.dedup();
    names.sort_unstable();
    names.dedup();
    let adapter = |name: &str| AdapterRecord {
        info: AdapterInfo {
            name: name.to_owned(),
            backend: "cpu".to_owned(),
            software: !name.starts_with("hw"),
            ..AdapterInfo::default()
        },
        release: None,
        limits: Limits {
            version: etalon_frame::ApiVersion::new(1, 3),
            sub_pixel_bits: 8,
            max_size: 1024,
            max_color_attachments: 4,
            ..Limits::nothing(Api::Vulkan)
        },
    };
    Run {
        header: Header {
            provenance: Provenance {
                command: vec!["etalon".to_owned()],
                ..Provenance::default()
            },
            ..Header::new(names.into_iter().map(adapter).collect(), made.len() as u64)
        },
        records: made.iter().map(Made::record).collect(),
        beside: Vec::new(),
        truncated: false,
    }
}
