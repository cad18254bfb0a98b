//! The method records of a run, sorted by question, scene and method.

use super::name::{anchor, value_text};
use crate::lists::distinct;
use etalon_methods::{QUESTIONS, lessons};
use etalon_record::{Measured, Record, Run};
use std::collections::{BTreeMap, BTreeSet};

/// The records of methods.
pub(crate) struct Methods<'a> {
    /// Adapters that drew a method, in the header's order.
    pub(crate) adapters: Vec<ChartAdapter<'a>>,
    /// The questions by name.
    pub(crate) questions: Vec<Question<'a>>,
}

/// An adapter of the charts.
pub(crate) struct ChartAdapter<'a> {
    pub(crate) name: &'a str,
    pub(crate) kind: DeviceKind,
}

/// The device that an adapter draws with. Kinds are ranked separately.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum DeviceKind {
    /// The processor.
    Software,
    /// A separate device.
    Hardware,
    /// Unknown, because the run has no facts of the adapter.
    Unknown,
}

impl DeviceKind {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Software => "software",
            Self::Hardware => "hardware",
            Self::Unknown => "unknown",
        }
    }

    /// Returns the kind of an adapter of a run.
    pub(crate) fn of(run: &Run, adapter: &str) -> Self {
        match run.header.adapter(adapter) {
            Some(a) if a.info.software => Self::Software,
            Some(_) => Self::Hardware,
            None => Self::Unknown,
        }
    }
}

/// All scenes of a question.
pub(crate) struct Question<'a> {
    pub(crate) name: &'a str,
    pub(crate) scenes: Vec<SceneSeries<'a>>,
    /// Method names in order. A method looks the same in all charts of its question.
    pub(crate) methods: Vec<&'a str>,
}

/// One family of cases: a scene, drawn by many methods along at most one parameter. Two families can draw the
/// same scene along two parameters.
pub(crate) struct SceneSeries<'a> {
    pub(crate) question: &'a str,
    /// The last part of the case file's name: the scene's name, with a suffix or without.
    pub(crate) name: &'a str,
    /// The series in the order of methods and variants.
    pub(crate) series: Vec<MethodSeries<'a>>,
}

/// A method with its settings, ordered along its parameter if it has one.
pub(crate) struct MethodSeries<'a> {
    pub(crate) method: &'a str,
    /// Axis values, other than the method and the parameter, that differ within the scene:
    /// `format=rgba16float`.
    pub(crate) variant: String,
    /// The parameter's name.
    pub(crate) parameter: Option<&'a str>,
    /// The points in the order of the parameter's values, then of adapters.
    pub(crate) points: Vec<SeriesPoint<'a>>,
}

/// A record as a point of a series.
pub(crate) struct SeriesPoint<'a> {
    /// The index in [`Methods::adapters`].
    pub(crate) adapter: usize,
    /// The parameter's value.
    pub(crate) value: Option<f64>,
    pub(crate) record: &'a Record,
    pub(crate) measured: &'a Measured,
}

/// The parameters of a scene at which methods are compared. Points are compared only if their settings are
/// equal.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SceneSetting<'a> {
    /// See [`MethodSeries::variant`].
    pub(crate) variant: String,
    /// The parameter and its value.
    pub(crate) parameter: Option<(&'a str, f64)>,
}

impl SceneSetting<'_> {
    /// Returns the setting in words: `alpha 0.4, address=repeat`; empty if the scene has no parameter.
    pub(crate) fn text(&self) -> String {
        let parameter = self
            .parameter
            .map(|(name, value)| format!("{name} {}", value_text(value)));
        let variant = (!self.variant.is_empty()).then(|| self.variant.clone());
        let parts: Vec<String> = parameter.into_iter().chain(variant).collect();
        parts.join(", ")
    }

    /// Returns the setting as a suffix of a name: ` at alpha 0.4`; empty if the scene has no parameter.
    pub(crate) fn at(&self) -> String {
        match self.text() {
            text if text.is_empty() => text,
            text => format!(" at {text}"),
        }
    }
}

/// A scene as the page shows it.
pub(crate) struct ShownScene<'s, 'a> {
    pub(crate) methods: &'s Methods<'a>,
    pub(crate) question: &'s Question<'a>,
    pub(crate) scene: &'s SceneSeries<'a>,
    /// The id of the element that holds its charts.
    pub(crate) anchor: String,
    /// All settings at which a method was drawn.
    pub(crate) settings: Vec<SceneSetting<'a>>,
    /// The index of the setting that represents the scene.
    pub(crate) main: usize,
}

impl ShownScene<'_, '_> {
    /// Returns the classes of an element that is shown at one setting only.
    pub(crate) fn class(&self, class: &str, setting: usize) -> String {
        let off = if setting == self.main { "" } else { " off" };
        format!("{class} at{off}")
    }

    /// Returns the position of a method in its question, which determines its colour and shape.
    pub(crate) fn style(&self, method: &str) -> usize {
        self.question.style(method)
    }
}

/// The records of a family of cases.
type Family<'a> = Vec<(&'a Record, &'a Measured)>;

/// Returns true if a chart can show the number. A run folder can contain any number.
pub(crate) fn usable(value: f64) -> bool {
    value.is_finite() && value.abs() <= 1e12
}

impl SeriesPoint<'_> {
    /// Returns the error, if a chart can show it.
    pub(crate) fn error(&self) -> Option<f64> {
        let rmse = self.measured.distance.rmse;
        (usable(rmse) && rmse >= 0.0).then_some(rmse)
    }

    /// Returns the frame time in seconds, if there is one and a chart can show it.
    pub(crate) fn wall(&self) -> Option<f64> {
        let wall = self.measured.time?.wall;
        (usable(wall) && wall >= 1e-12).then_some(wall)
    }

    /// Returns the interval of the frame time, if it contains the time and a chart can show it.
    pub(crate) fn interval(&self) -> Option<[f64; 2]> {
        let wall = self.wall()?;
        let [low, high] = self.measured.time?.interval?;
        let drawn = usable(high) && low >= 1e-12 && low <= wall && wall <= high;
        drawn.then_some([low, high])
    }
}

impl<'a> MethodSeries<'a> {
    /// Returns the setting of one of the series' points.
    pub(crate) fn setting(&self, point: &SeriesPoint<'a>) -> SceneSetting<'a> {
        SceneSetting {
            variant: self.variant.clone(),
            parameter: self.parameter.zip(point.value),
        }
    }

    /// Returns method and variant in one text.
    pub(crate) fn name(&self) -> String {
        match self.variant.as_str() {
            "" => self.method.to_owned(),
            variant => format!("{} ({variant})", self.method),
        }
    }

    /// Returns the parameter's values in order, without repetitions.
    pub(crate) fn values(&self) -> Vec<f64> {
        let mut values: Vec<f64> = self.points.iter().filter_map(|p| p.value).collect();
        values.dedup();
        values
    }

    /// Returns the points of one adapter in the order of values.
    pub(crate) fn on(&self, adapter: usize) -> impl Iterator<Item = &SeriesPoint<'a>> {
        self.points.iter().filter(move |p| p.adapter == adapter)
    }

    /// Returns value and error along the parameter on one adapter.
    pub(crate) fn curve(&self, adapter: usize) -> Vec<(f64, f64)> {
        self.on(adapter)
            .filter_map(|p| Some((p.value?, p.error()?)))
            .collect()
    }
}

impl<'a> SceneSeries<'a> {
    /// Returns all settings at which a method was drawn, by variant, then along the parameter.
    pub(crate) fn settings(&self) -> Vec<SceneSetting<'a>> {
        let settings_of = |series: &MethodSeries<'a>| -> Vec<SceneSetting<'a>> {
            series.points.iter().map(|p| series.setting(p)).collect()
        };
        let mut settings = distinct(self.series.iter().flat_map(settings_of));
        settings.sort_by(|a, b| {
            let key = |s: &SceneSetting<'a>| s.parameter.map_or(("", 0.0), |p| p);
            let ((a_name, a_value), (b_name, b_value)) = (key(a), key(b));
            a.variant
                .cmp(&b.variant)
                .then(a_name.cmp(b_name))
                .then(a_value.total_cmp(&b_value))
        });
        settings
    }

    /// Returns the setting that represents the scene. Of the settings at which the most methods were
    /// measured, it is the middle one of the first variant.
    pub(crate) fn main(&self) -> Option<SceneSetting<'a>> {
        let settings = self.settings();
        let measured = |s: &SceneSetting<'a>| self.measured(s).len();
        let most = settings.iter().map(measured).max()?;
        let mut best: Vec<SceneSetting<'a>> = settings
            .into_iter()
            .filter(|s| measured(s) == most)
            .collect();
        let variant = best.first()?.variant.clone();
        best.retain(|s| s.variant == variant);
        Some(best.swap_remove(best.len() / 2))
    }

    /// Returns the points drawn at a setting.
    pub(crate) fn at<'s>(
        &'s self,
        setting: &'s SceneSetting<'a>,
    ) -> impl Iterator<Item = (&'s MethodSeries<'a>, &'s SeriesPoint<'a>)> {
        self.series.iter().flat_map(move |series| {
            let here = move |p: &&SeriesPoint<'a>| series.setting(p) == *setting;
            series.points.iter().filter(here).map(move |p| (series, p))
        })
    }

    /// Returns the methods that have an error at a setting on some adapter, without repetitions.
    pub(crate) fn measured(&self, setting: &SceneSetting<'a>) -> Vec<&'a str> {
        let some = self.at(setting).filter(|(_, p)| p.error().is_some());
        let mut names: Vec<&str> = some.map(|(s, _)| s.method).collect();
        names.dedup();
        names
    }

    /// Returns the methods that drew the scene at any setting, without repetitions.
    pub(crate) fn methods(&self) -> Vec<&'a str> {
        let mut names: Vec<&str> = self.series.iter().map(|s| s.method).collect();
        names.dedup();
        names
    }

    /// Returns the methods that were drawn at another setting or on another adapter, but not at this setting
    /// on this adapter.
    pub(crate) fn unmeasured(&self, setting: &SceneSetting<'a>, adapter: usize) -> Vec<&'a str> {
        let here = |method: &str| {
            self.at(setting)
                .any(|(s, p)| s.method == method && p.adapter == adapter && p.error().is_some())
        };
        let mut names = self.methods();
        names.retain(|method| !here(method));
        names
    }
}

impl Question<'_> {
    /// Returns the number that determines a method's colour and shape: its place among all methods of the question, so
    /// that it looks the same in all runs, whichever others they draw.
    pub(crate) fn style(&self, method: &str) -> usize {
        let known = lessons(self.name);
        let of_lesson = known.iter().position(|lesson| lesson.method == method);
        let unknown = || self.methods.iter().position(|m| *m == method);
        of_lesson.unwrap_or_else(|| known.len() + unknown().unwrap_or(0))
    }
}

impl<'a> Methods<'a> {
    /// Returns the method records of a run; `None` if it has none.
    pub(crate) fn of(run: &'a Run) -> Option<Self> {
        let measured: Vec<(&Record, &Measured)> = run
            .records
            .iter()
            .filter_map(|r| Some((r, r.measured.as_ref()?)))
            .collect();
        if measured.is_empty() {
            return None;
        }
        let from_header = run.header.adapters.iter().map(|a| a.info.name.as_str());
        let names = from_header.chain(measured.iter().map(|(r, _)| r.adapter.as_str()));
        let drew = |name: &&str| measured.iter().any(|(r, _)| r.adapter == *name);
        let adapters = distinct(names)
            .into_iter()
            .filter(drew)
            .map(|name| ChartAdapter {
                name,
                kind: DeviceKind::of(run, name),
            });
        let adapters: Vec<ChartAdapter<'a>> = adapters.collect();
        let mut sorted: BTreeMap<&str, BTreeMap<&str, Family<'_>>> = BTreeMap::new();
        for (record, m) in measured {
            let scenes = sorted.entry(&m.question).or_default();
            scenes
                .entry(family(record, m))
                .or_default()
                .push((record, m));
        }
        let questions = sorted.into_iter().map(|(name, scenes)| {
            let methods = scenes.values().flatten().map(|(_, m)| &*m.method);
            let methods: BTreeSet<&str> = methods.collect();
            let scenes = scenes.into_iter();
            Question {
                name,
                scenes: scenes
                    .map(|(s, series)| scene(name, s, &series, &adapters))
                    .collect(),
                methods: methods.into_iter().collect(),
            }
        });
        let mut questions: Vec<Question<'a>> = questions.collect();
        let place = |question: &Question<'_>| QUESTIONS.iter().position(|q| *q == question.name);
        questions.sort_by_key(|question| place(question).unwrap_or(QUESTIONS.len()));
        Some(Self {
            adapters,
            questions,
        })
    }

    /// Returns all scenes as the page shows them.
    pub(crate) fn shown(&self) -> Vec<ShownScene<'_, 'a>> {
        let mut shown = Vec::new();
        for (q, question) in self.questions.iter().enumerate() {
            shown.extend(question.scenes.iter().enumerate().map(|(s, scene)| {
                let settings = scene.settings();
                let main = scene.main();
                let main = settings.iter().position(|s| Some(s) == main.as_ref());
                ShownScene {
                    methods: self,
                    question,
                    scene,
                    anchor: anchor(q, s),
                    settings,
                    main: main.unwrap_or(0),
                }
            }));
        }
        shown
    }

    /// Returns all scenes of all questions.
    pub(crate) fn scenes(&self) -> impl Iterator<Item = &SceneSeries<'a>> {
        self.questions.iter().flat_map(|q| &q.scenes)
    }

    /// Returns the kinds of adapters that occur, in order.
    pub(crate) fn kinds(&self) -> BTreeSet<DeviceKind> {
        self.adapters.iter().map(|a| a.kind).collect()
    }
}

/// Returns the family that a record belongs to.
fn family<'a>(record: &'a Record, m: &'a Measured) -> &'a str {
    let file = record.parts().file();
    match file.rsplit_once('/') {
        // A scene of one's own has no case file.
        Some((_, name)) if name != m.question => name,
        _ => &m.scene,
    }
}

fn scene<'a>(
    question: &'a str,
    name: &'a str,
    records: &[(&'a Record, &'a Measured)],
    adapters: &[ChartAdapter<'a>],
) -> SceneSeries<'a> {
    // An axis with one value in the whole scene is not part of the variant.
    let mut values: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (axis, value) in records.iter().flat_map(|(record, m)| settings(record, m)) {
        values.entry(axis).or_default().insert(value);
    }
    let variant = |record: &'a Record, m: &'a Measured| {
        let telling = settings(record, m).filter(|(axis, _)| values[axis].len() > 1);
        let parts: Vec<String> = telling
            .map(|(axis, value)| format!("{axis}={value}"))
            .collect();
        parts.join(" ")
    };
    let mut sorted: BTreeMap<(&str, String, Option<&str>), Vec<SeriesPoint<'a>>> = BTreeMap::new();
    for (record, measured) in records {
        let Some(adapter) = adapters.iter().position(|a| a.name == record.adapter) else {
            continue;
        };
        let parameter = measured.parameter.as_ref().filter(|p| usable(p.value));
        let name = parameter.map(|p| p.name.as_str());
        let key = (&*measured.method, variant(record, measured), name);
        sorted.entry(key).or_default().push(SeriesPoint {
            adapter,
            value: parameter.map(|p| p.value),
            record,
            measured,
        });
    }
    let series = sorted
        .into_iter()
        .map(|((method, variant, parameter), mut points)| {
            let place = |p: &SeriesPoint<'_>| (p.value.unwrap_or(0.0), p.adapter);
            points.sort_by(|a, b| {
                let (a, b) = (place(a), place(b));
                a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
            });
            // A run has one record per case and adapter. If a damaged run has two, the first record counts.
            points.dedup_by(|a, b| place(a) == place(b));
            MethodSeries {
                method,
                variant,
                parameter,
                points,
            }
        });
    SceneSeries {
        question,
        name,
        series: series.collect(),
    }
}

/// Returns the axis values of a case's id, except its method and its parameter.
fn settings<'a>(record: &'a Record, m: &'a Measured) -> impl Iterator<Item = (&'a str, &'a str)> {
    record.parts().axes().filter(|(axis, _)| {
        let parameter = m.parameter.as_ref().is_some_and(|p| p.name == *axis);
        *axis != "method" && !parameter
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::tests::made::{Made, run};

    #[test]
    fn records_are_sorted_into_families_and_series() {
        let made = |id: &str, value| Made::new(id).at("alpha", value);
        let run = run(&[
            made("t/windows/format=f/method=b/size=4", 0.9),
            made("t/windows/format=f/method=b/size=4", 0.1).on("hw:a"),
            made("t/windows/format=f/method=b/size=4", 0.1),
            made("t/windows/format=f/method=b/size=8", 0.5),
            made("t/windows/format=f/method=a/size=4", 0.5),
            Made::new("t/windows-k/method=a").at("k", 2.0),
            Made::new("s/mirror/method=a"),
        ]);
        let methods = Methods::of(&run).unwrap();
        let names: Vec<(&str, &str)> = methods.scenes().map(|s| (s.question, s.name)).collect();
        assert_eq!(
            names,
            [("s", "mirror"), ("t", "windows"), ("t", "windows-k")]
        );
        let windows = methods.scenes().nth(1).unwrap();
        let series: Vec<String> = windows.series.iter().map(MethodSeries::name).collect();
        assert_eq!(series, ["a (size=4)", "b (size=4)", "b (size=8)"]);
        let values: Vec<_> = windows.series[1]
            .points
            .iter()
            .map(|p| (p.value, p.adapter))
            .collect();
        assert_eq!(values, [(Some(0.1), 0), (Some(0.1), 1), (Some(0.9), 0)]);
        let settings: Vec<String> = windows.settings().iter().map(SceneSetting::text).collect();
        let expected = [
            "alpha 0.1, size=4",
            "alpha 0.5, size=4",
            "alpha 0.9, size=4",
            "alpha 0.5, size=8",
        ];
        assert_eq!(settings, expected);
        assert_eq!(
            methods.kinds(),
            [DeviceKind::Software, DeviceKind::Hardware].into()
        );
        assert_eq!(methods.questions[1].style("b"), 1);
    }

    #[test]
    fn only_methods_with_the_same_parameters_are_compared() {
        let setting_of =
            |method: &str, value| Made::new(&format!("t/wedge/method={method}")).at("o", value);
        // A covering array: each method has its own value, except two methods with 4.
        let run = run(&[
            setting_of("a", 1.0),
            setting_of("b", 2.0),
            setting_of("c", 4.0),
            setting_of("d", 4.0),
        ]);
        let methods = Methods::of(&run).unwrap();
        let scene = methods.scenes().next().unwrap();
        let main = scene.main().unwrap();
        assert_eq!(main.text(), "o 4");
        assert_eq!(scene.measured(&main), ["c", "d"]);
        assert_eq!(scene.unmeasured(&main, 0), ["a", "b"]);
        assert_eq!(scene.methods().len(), 4);
    }

    #[test]
    fn numbers_that_no_chart_can_show_are_left_out() {
        let odd = |rmse, wall, value| Made {
            rmse,
            wall: Some(wall),
            ..Made::new("q/s/method=a").at("p", value)
        };
        let run = run(&[
            odd(-1.0, 0.0, 1.0),
            odd(f64::NAN, -3.0, 2.0),
            odd(f64::INFINITY, 1e300, 3.0),
            odd(0.5, 0.1, 1e300),
        ]);
        let methods = Methods::of(&run).unwrap();
        let scene = methods.scenes().next().unwrap();
        let points: Vec<&SeriesPoint<'_>> = scene.series.iter().flat_map(|s| &s.points).collect();
        assert_eq!(points.len(), 4);
        assert_eq!(points.iter().filter(|p| p.error().is_some()).count(), 1);
        assert_eq!(points.iter().filter(|p| p.wall().is_some()).count(), 1);
        assert_eq!(points.iter().filter(|p| p.value.is_some()).count(), 3);
    }
}
