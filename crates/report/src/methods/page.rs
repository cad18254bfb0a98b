//! `methods.html`.

use super::data::{Methods, Point, Question, SceneSeries, Series, Setting};
use super::name::{anchor, title, value_text};
use super::pictures::Pictures;
use super::{claims, scatter, stability};
use crate::chart::{self, color, key, line_key};
use crate::command::quoted;
use crate::numbers::{bytes, count, digits, duration, share};
use crate::page::adapter::breakable;
use crate::page::{self, Page};
use crate::words;
use etalon_methods::{Lesson, lessons};
use etalon_record::Run;
use maud::{Markup, html};
use std::path::Path;

const STYLE: &str = include_str!("page/methods.css");

/// The sliders, the legend's pins, other limits of breaks, and the enlarged pictures. All else needs no script.
const SCRIPT: &str = concat!(
    include_str!("page/flip.js"),
    include_str!("page/story.js"),
    include_str!("page/pictures.js"),
    include_str!("page/breaks.js"),
    include_str!("page/settings.js"),
);

/// The whole page. Pictures are read from the folder as they are needed.
pub(crate) fn page(folder: &Path, run: &Run, methods: &Methods<'_>) -> String {
    let mut pictures = Pictures::new(folder);
    let questions: Vec<Markup> = methods
        .questions
        .iter()
        .enumerate()
        .map(|(q, question)| in_question(run, methods, &mut pictures, (q, question)))
        .collect();
    let main = html! {
        (head(run, methods))
        noscript { p.note { "Scripts are off: each scene shows one setting, and its pictures cannot be enlarged." } }
        section id="claims" {
            h2 { "Claims of the literature" }
            (claims::section(methods))
        }
        (breaks(methods))
        section id="reading" {
            h2 { "Reading the charts" }
            h3 { "Accuracy against speed" }
            (scatter::caption())
            h3 { "Stability" }
            (stability::caption())
        }
        @for question in questions { (question) }
        (page::script(SCRIPT))
    };
    Page {
        title: &format!("etalon methods {}", run.header.started),
        styles: &[chart::STYLE, STYLE],
        script: Some(SCRIPT),
        beside: false,
        main,
        source: "run.jsonl and pictures/ in this folder",
    }
    .html()
}

fn head(run: &Run, methods: &Methods<'_>) -> Markup {
    let h = &run.header;
    let scenes = methods.scenes().count() as u64;
    let records: usize = methods
        .scenes()
        .flat_map(|s| &s.series)
        .map(|s| s.points.len())
        .sum();
    html! {
        header {
            h1 { "Methods: accuracy against speed" }
            p.lead {
                "Cost and error of rendering methods, and the parameter at which each breaks."
            }
            dl.facts {
                dt { "Run" } dd { a href="index.html" { "verdicts and findings" } ", " (h.started) }
                dt { "Profile" } dd { (profile(run)) }
                dt { "Command" } dd { code { (h.command.join(" ")) } }
                dt { "Machine" } dd { (words::machine(&h.machine)) }
                dt { "Scope" } dd {
                    (count(scenes, "scene")) ", " (count(records as u64, "record")) " on "
                    @for (i, adapter) in methods.adapters.iter().enumerate() {
                        @if i > 0 { ", " }
                        code { (breakable(adapter.name)) } " (" (adapter.kind.name()) ")"
                    }
                }
            }
            nav {
                a href="#claims" { "Claims" } " "
                a href="#breaks" { "Break points" } " "
                a href="#reading" { "Reading the charts" } " "
                @for (q, question) in methods.questions.iter().enumerate() {
                    a href={ "#q" (q) } { (title(question.name)) } " "
                }
            }
        }
    }
}

/// The profile of the run, and what it leaves out.
fn profile(run: &Run) -> Markup {
    let settings = &run.header.settings;
    let left = settings.left_out.unwrap_or(0);
    html! {
        @match settings.profile.as_deref() {
            None => "not recorded: a run of an older version",
            Some("full") => { b { "full" } ": every method of a scene at every value of its parameter" }
            Some(name) => {
                b { (name) } ": whole scenes at a few parameters, every method of a scene at the same ones. Left out: "
                (count(left, "case")) " at other values, and so most curves and break points; "
                code { "--profile full" } " draws them"
            }
        }
    }
}

/// Every break point in one table; curves that never cross are listed beside their charts.
fn breaks(methods: &Methods<'_>) -> Markup {
    let mut rows = Vec::new();
    for (q, question) in methods.questions.iter().enumerate() {
        for (s, scene) in question.scenes.iter().enumerate() {
            for found in stability::found(methods, scene) {
                rows.push((anchor(q, s), question, scene, found));
            }
        }
    }
    let curves = rows.len();
    let (broken, steady): (Vec<_>, Vec<_>) = rows.into_iter().partition(|(_, _, _, f)| f.crosses());
    let single = single_values(methods);
    html! {
        section id="breaks" data-curves=(stability::json(methods)) {
            h2 { "Break points" }
            p {
                "The parameter at which a method's RMSE crosses "
                span #limit-text { "1 %" } " of full brightness, interpolated between the two values beside it that were drawn."
            }
            @if curves > 0 {
                p #limit-field hidden {
                    label for="limit" { "Limit of RMSE in percent " }
                    input #limit type="number" value="1" min="0.001" max="100" step="any" inputmode="decimal";
                }
            }
            @if curves == 0 {
                p.u { "Not measured: no method was drawn at two values of its parameter." }
            } @else if broken.is_empty() { p { "No method crosses it." } }
            @else {
                div.wide { table.text {
                    thead { tr { th scope="col" { "Scene" } th scope="col" { "Method" } th scope="col" { "Break" } th scope="col" { "Pictures" } th scope="col" { "Adapters" } } }
                    tbody #break-rows {
                        @for (anchor, question, scene, found) in &broken {
                            tr {
                                td { a href={ "#" (anchor) } { (question.name) "/" (scene.name) } }
                                td { (key(question.style(found.method))) " " (found.series) }
                                td { (found.sentence) }
                                td { (beside(scene, anchor, &found.between)) }
                                td { (stability::who(methods, found)) }
                            }
                        }
                    }
                } }
            }
            @if !steady.is_empty() {
                p.note #steady { (count(steady.len() as u64, "curve")) " along a parameter never cross it; they are listed beside their charts." }
            }
            @if curves > 0 && single > 0 {
                p.note { "Not measured: " (count(single, "method")) " drawn at one value of a parameter only." }
            }
        }
    }
}

/// The number of series with a parameter of which there is one value.
fn single_values(methods: &Methods<'_>) -> u64 {
    let all = methods.scenes().flat_map(|s| &s.series);
    all.filter(|s| s.values().len() == 1).count() as u64
}

/// Links to the pictures on both sides of crossings.
fn beside(scene: &SceneSeries<'_>, anchor: &str, between: &[[Setting<'_>; 2]]) -> Markup {
    let settings = scene.settings();
    html! {
        @for (i, pair) in between.iter().enumerate() {
            @if i > 0 { "; " }
            @for (j, setting) in pair.iter().enumerate() {
                @if j > 0 { " → " }
                @let at = settings.iter().position(|s| s == setting);
                a href={ "#" (anchor) } data-go=[at] { @if let Some((_, value)) = setting.parameter { (value_text(value)) } }
            }
        }
    }
}

fn in_question(
    run: &Run,
    methods: &Methods<'_>,
    pictures: &mut Pictures<'_>,
    (q, question): (usize, &Question<'_>),
) -> Markup {
    let scenes: Vec<Markup> = question
        .scenes
        .iter()
        .enumerate()
        .map(|(s, scene)| in_scene(run, methods, pictures, question, (&anchor(q, s), scene)))
        .collect();
    html! {
        section id={ "q" (q) } {
            h2 { (title(question.name)) }
            (explained(question))
            @for scene in scenes { (scene) }
        }
    }
}

/// The methods of a question: how each works, and where and why it fails.
fn explained(question: &Question<'_>) -> Markup {
    let of = |method: &&str| lessons(question.name).iter().find(|l| l.method == *method);
    let known: Vec<&Lesson> = question.methods.iter().filter_map(of).collect();
    html! {
        @if !known.is_empty() {
            details open {
                summary { "The methods, and where they fail" }
                dl.lessons {
                    @for lesson in known {
                        dt { (key(question.style(lesson.method))) " " (lesson.method) }
                        dd { (lesson.works) " " (lesson.fails) " " cite { (lesson.source) } }
                    }
                }
            }
        }
    }
}

fn in_scene(
    run: &Run,
    methods: &Methods<'_>,
    pictures: &mut Pictures<'_>,
    question: &Question<'_>,
    (anchor, scene): (&str, &SceneSeries<'_>),
) -> Markup {
    let truth = scene
        .series
        .iter()
        .flat_map(|s| &s.points)
        .map(|p| p.measured.distance.truth_error)
        .fold(0.0, f64::max);
    let settings = scene.settings();
    let shown = scene.main();
    let main = settings.iter().position(|s| Some(s) == shown.as_ref());
    let main = main.unwrap_or(0);
    let speed = scatter::charts(methods, question, scene, &settings, main);
    let curves = stability::charts(methods, question, scene, &settings, main);
    let together = speed.len() == 1;
    // One chart leaves room beside it on a wide page, two of them for a few pictures.
    let shots = pictures.of(methods, question, scene, &settings, main);
    let panels = speed.iter().map(|k| k.panels.len()).sum::<usize>() + curves.len();
    let few = scene.methods().len() <= 4;
    let beside = together && (panels == 1 || (panels == 2 && few));
    html! {
        article.scene id=(anchor) data-name={ (scene.question) "/" (scene.name) } {
            h3 { (title(scene.name)) }
            p.legend {
                @for name in scene.methods() {
                    @let style = question.style(name);
                    button class={ "key " (color(style)) } type="button" aria-pressed="false" { (line_key(style)) " " (name) }
                }
            }
            (slider(anchor, &settings, main))
            @for (i, kind) in speed.iter().enumerate() {
                @if let Some(heading) = kind.heading { p.cap { (heading) } }
                div.charts.speed {
                    @for panel in &kind.panels { (panel) }
                    @if together && i == 0 { @for panel in &curves { (panel) } }
                    @if beside { (shots) }
                }
            }
            @if !together && !curves.is_empty() {
                div.charts { @for panel in &curves { (panel) } }
            }
            @for (i, setting) in settings.iter().enumerate() {
                (unmeasured(methods, scene, setting, (i, i == main)))
            }
            @if !curves.is_empty() { (stability::list(methods, scene)) }
            @if !beside { (shots) }
            p.cap {
                @if truth > 0.0 { "The truth itself may be off by " (share(truth)) " in a channel. " }
                @else { "The truth is exact. " }
            }
            details {
                summary { "Table and command" }
                p.again { "Drawn by " code { (run.header.command.join(" ")) } "; this scene alone by "
                    code { "etalon run " (quoted(&format!("methods/{}/{}/*", scene.question, scene.name))) } }
                (table(methods, scene))
            }
        }
    }
}

/// The setting that charts and pictures show, and the slider to others. Without scripts it stays where it is.
fn slider(anchor: &str, settings: &[Setting<'_>], main: usize) -> Markup {
    let names: Vec<String> = settings.iter().map(Setting::text).collect();
    let input = format!("{anchor}-at");
    html! {
        @match settings {
            [] => {},
            [only] => { @if !only.text().is_empty() { p.setting { "At " b { (only.text()) } } } },
            several => {
                p.setting {
                    label for=(input) { "At " output for=(input) { (names[main]) } }
                    " " input id=(input) type="range" min="0" max=(several.len() - 1) step="1" value=(main)
                        data-names=(serde_json::json!(names)) aria-valuetext=(names[main]) disabled;
                }
            }
        }
    }
}

/// The methods of the scene that have no error, or no time, at a setting.
fn unmeasured(
    methods: &Methods<'_>,
    scene: &SceneSeries<'_>,
    setting: &Setting<'_>,
    (index, shown): (usize, bool),
) -> Markup {
    let mut missing: Vec<(&str, Vec<&str>)> = Vec::new();
    let mut drew = 0;
    for (i, adapter) in methods.adapters.iter().enumerate() {
        if !scene.series.iter().any(|s| s.on(i).next().is_some()) {
            continue;
        }
        drew += 1;
        for method in scene.unmeasured(setting, i) {
            match missing.iter_mut().find(|(m, _)| *m == method) {
                Some((_, on)) => on.push(adapter.name),
                None => missing.push((method, vec![adapter.name])),
            }
        }
    }
    let untimed: Vec<&str> = {
        let all = scene
            .at(setting)
            .filter(|(_, p)| p.error().is_some() && p.wall().is_none());
        let mut names: Vec<&str> = all.map(|(s, _)| s.method).collect();
        names.dedup();
        names
    };
    let class = if shown {
        "missing at"
    } else {
        "missing at off"
    };
    html! {
        @if !missing.is_empty() || !untimed.is_empty() {
            p class=(class) data-at=(index) {
                @if !missing.is_empty() {
                    span.chip.u { "not measured" } (setting.at()) ": "
                    @for (i, (method, on)) in missing.iter().enumerate() {
                        @if i > 0 { ", " }
                        (method)
                        @if on.len() < drew { " on " (on.join(" and ")) }
                    }
                    ". "
                }
                @if !untimed.is_empty() {
                    span.chip.u { "no frame time" } (setting.at()) ": " (untimed.join(", ")) "."
                }
            }
        }
    }
}

fn table(methods: &Methods<'_>, scene: &SceneSeries<'_>) -> Markup {
    let parameter = scene.series.iter().any(|s| s.parameter.is_some());
    html! {
        div.wide { table.numbers {
            thead { tr {
                th { "Method" }
                @if parameter { th { "Parameter" } }
                th { "Adapter" } th { "RMSE" } th { "Largest" } th { "FLIP" } th { "Wrong texels" }
                th { "Wall" } th { "Interval" } th { "CPU" } th { "GPU" } th { "Frames" } th { "Passes" } th { "Draws" }
                th { "Fragments" } th { "Attachments" } th { "Verdict" }
            } }
            tbody {
                @for series in &scene.series {
                    @for point in &series.points { (row(methods, series, point, parameter)) }
                }
            }
        } }
    }
}

fn row(methods: &Methods<'_>, series: &Series<'_>, point: &Point<'_>, parameter: bool) -> Markup {
    let m = point.measured;
    let time = |of: Option<f64>| of.map_or_else(|| "–".to_owned(), duration);
    let record = point.record;
    html! {
        tr {
            th scope="row" { (series.name()) }
            @if parameter {
                td { @if let (Some(p), Some(v)) = (series.parameter, point.value) { (p) " " (value_text(v)) } }
            }
            td { (methods.adapters[point.adapter].name) }
            td { (share(m.distance.rmse)) }
            td { (share(m.distance.max)) }
            td { (digits(m.distance.flip, 3)) }
            td { (share(m.distance.wrong)) }
            td { (time(m.time.map(|t| t.wall))) }
            td { @if let Some([low, high]) = point.interval() { (duration(low)) " to " (duration(high)) } @else { "–" } }
            td { (time(m.time.map(|t| t.cpu))) }
            td { (time(m.time.and_then(|t| t.gpu))) }
            td { (m.time.map_or(0, |t| t.samples)) }
            td { (m.passes) }
            td { (m.draws) }
            td { @if let Some(n) = m.fragments { (n) } @else { "–" } }
            td { (bytes(m.bytes)) }
            td { (words::symbol(record.verdict)) " " (words::name(record.verdict)) }
        }
    }
}
