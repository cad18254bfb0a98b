//! The measured points of methods, for charts of other programs: as JSON and as CSV.

use super::data::DeviceKind;
use crate::csv::{field, line, number};
use etalon_record::{Measured, Record, Run, Times};
use serde::Serialize;

/// The name of the file in a run folder.
pub(crate) const POINTS: &str = "methods.csv";

/// A method in a scene on an adapter, at one size of frames.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MethodPoint<'a> {
    /// The case.
    pub case: &'a str,
    /// The question: `transparency`.
    pub question: &'a str,
    /// The scene: `windows`.
    pub scene: &'a str,
    /// The method: `sorted`.
    pub method: &'a str,
    /// The parameter of the scene's curve: `alpha`.
    pub parameter: Option<&'a str>,
    /// The parameter's value.
    pub value: Option<f64>,
    /// The adapter.
    pub adapter: &'a str,
    /// `hardware`, `software` or `unknown`.
    pub device: &'static str,
    /// Width and height in texels; `None` for the small picture that is judged.
    pub size: Option<[u32; 2]>,
    /// The median time in seconds until the device was done; `None` if the picture is wrong, or was not drawn at this
    /// size.
    pub seconds: Option<f64>,
    /// The 95 % confidence interval of this median.
    pub interval: Option<[f64; 2]>,
    /// The median time in seconds by the device's timestamps, if it has them.
    pub device_seconds: Option<f64>,
    /// Root of the mean squared difference from the truth, 0 to 1.
    pub rmse: Option<f64>,
    /// The largest difference of any channel, 0 to 1.
    pub largest: Option<f64>,
}

/// Returns the points of a run, in the order of its records: the picture of each, then each size of frames.
pub fn method_points(run: &Run) -> Vec<MethodPoint<'_>> {
    let records = run.records.iter();
    let measured = records.filter_map(|record| Some((record, record.measured.as_ref()?)));
    measured
        .flat_map(|(record, m)| of_record(run, record, m))
        .collect()
}

fn of_record<'a>(
    run: &Run,
    record: &'a Record,
    m: &'a Measured,
) -> impl Iterator<Item = MethodPoint<'a>> {
    let device = DeviceKind::of(run, &record.adapter).name();
    let point =
        move |size: Option<[u32; 2]>, times: Option<&Times>, error: Option<[f64; 2]>| MethodPoint {
            case: &record.case,
            question: &m.question,
            scene: &m.scene,
            method: &m.method,
            parameter: m.parameter.as_ref().map(|p| p.name.as_str()),
            value: m.parameter.as_ref().map(|p| p.value),
            adapter: &record.adapter,
            device,
            size,
            seconds: times.map(|t| t.wall),
            interval: times.and_then(|t| t.interval),
            device_seconds: times.and_then(|t| t.gpu),
            rmse: error.map(|[rmse, _]| rmse),
            largest: error.map(|[_, largest]| largest),
        };
    let picture = point(
        None,
        m.time.as_ref(),
        Some([m.distance.rmse, m.distance.max]),
    );
    let sized = m.sizes.iter().map(move |frame| {
        let error = frame.distance.map(|d| [d.rmse, d.max]);
        point(Some(frame.size), frame.time.as_ref(), error)
    });
    std::iter::once(picture).chain(sized)
}

const COLUMNS: [&str; 16] = [
    "case",
    "question",
    "scene",
    "method",
    "parameter",
    "value",
    "adapter",
    "device",
    "width",
    "height",
    "seconds",
    "low",
    "high",
    "device_seconds",
    "rmse",
    "largest",
];

/// Returns a line per point, with the names of the columns first. What was not measured is empty.
pub(crate) fn csv(points: &[MethodPoint<'_>]) -> String {
    let mut text = line(&COLUMNS);
    for point in points {
        let side = |axis: usize| point.size.map_or_else(String::new, |s| s[axis].to_string());
        let end = |end: usize| number(point.interval.map(|i| i[end]));
        let fields: [String; COLUMNS.len()] = [
            field(point.case),
            field(point.question),
            field(point.scene),
            field(point.method),
            field(point.parameter.unwrap_or_default()),
            number(point.value),
            field(point.adapter),
            point.device.to_owned(),
            side(0),
            side(1),
            number(point.seconds),
            end(0),
            end(1),
            number(point.device_seconds),
            number(point.rmse),
            number(point.largest),
        ];
        text.push_str(&line(&fields));
    }
    text
}
