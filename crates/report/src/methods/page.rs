//! `methods.html`.

use super::data::{Methods, Point, Question, SceneSeries, Series};
use super::name::{anchor, value_text};
use super::{claims, scatter, stability};
use crate::chart::{self, key};
use crate::command::quoted;
use crate::numbers::{bytes, count, digits, duration, share};
use crate::page::Page;
use crate::page::adapter::breakable;
use crate::words;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use etalon_record::Run;
use maud::{Markup, html};
use std::path::Path;

/// The most bytes of one picture, and of all pictures together, that the page holds.
const PICTURE: u64 = 256 << 10;
const PICTURES: usize = 6 << 20;

/// The whole page. Pictures are read from the folder as they are needed.
pub(crate) fn page(folder: &Path, run: &Run, methods: &Methods<'_>) -> String {
    let mut pictures = Pictures {
        folder,
        room: PICTURES,
    };
    let questions: Vec<Markup> = methods
        .questions
        .iter()
        .enumerate()
        .map(|(q, question)| in_question(run, methods, &mut pictures, (q, question)))
        .collect();
    let main = html! {
        (head(run, methods))
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
    };
    Page {
        title: &format!("etalon methods {}", run.header.started),
        styles: &[chart::STYLE],
        script: None,
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

/// A name of the records as a heading: `cut-outs` is Cut outs.
pub(super) fn title(name: &str) -> String {
    let mut letters = name.chars();
    match letters.next() {
        Some(first) => first
            .to_uppercase()
            .chain(letters)
            .collect::<String>()
            .replace('-', " "),
        None => "(no name)".to_owned(),
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
    let (broken, steady): (Vec<_>, Vec<_>) = rows.into_iter().partition(|(_, _, _, f)| f.crosses());
    html! {
        section id="breaks" {
            h2 { "Break points" }
            p {
                "The parameter at which a method's RMSE crosses 1 % of full brightness."
            }
            @if broken.is_empty() { p { "No method crosses it." } }
            @else {
                div.wide { table.text {
                    thead { tr { th { "Scene" } th { "Method" } th { "Break" } th { "Adapters" } } }
                    tbody {
                        @for (anchor, question, scene, found) in &broken {
                            tr {
                                td { a href={ "#" (anchor) } { (question.name) "/" (scene.name) } }
                                td { (key(question.style(found.method))) " " (found.series) }
                                td { (found.sentence) }
                                td { (stability::who(methods, found)) }
                            }
                        }
                    }
                } }
            }
            @if !steady.is_empty() {
                p.note { (count(steady.len() as u64, "curve")) " along a parameter never cross it; they are listed beside their charts." }
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
            @for scene in scenes { (scene) }
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
    let mut names: Vec<&str> = scene.series.iter().map(|s| s.method).collect();
    names.dedup();
    let truth = scene
        .series
        .iter()
        .flat_map(|s| &s.points)
        .map(|p| p.measured.distance.truth_error)
        .fold(0.0, f64::max);
    html! {
        article.scene id=(anchor) {
            h3 { (title(scene.name)) }
            p.legend {
                @for name in &names {
                    span.key { (key(question.style(name))) " " (name) }
                }
            }
            @if let Some(text) = middles(scene) { p.cap { (text) } }
            (scatter::charts(methods, question, scene))
            (stability::charts(methods, question, scene))
            (pictures.strip(scene))
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

/// The values that stand for methods with a parameter in the charts of accuracy against speed.
fn middles(scene: &SceneSeries<'_>) -> Option<String> {
    let mut shown: Vec<(String, Vec<&str>)> = Vec::new();
    for series in &scene.series {
        if let (Some(parameter), Some(value)) = (series.parameter, series.middle()) {
            let text = format!("{parameter} {}", value_text(value));
            match shown.iter_mut().find(|(t, _)| *t == text) {
                Some((_, of)) => of.push(series.method),
                None => shown.push((text, vec![series.method])),
            }
        }
    }
    let parts: Vec<String> = match shown.as_mut_slice() {
        [] => return None,
        [(text, _)] => vec![text.clone()],
        several => several
            .iter_mut()
            .map(|(text, of)| {
                of.dedup();
                format!("{text} ({})", of.join(", "))
            })
            .collect(),
    };
    Some(format!("Full points: {}.", parts.join("; ")))
}

fn table(methods: &Methods<'_>, scene: &SceneSeries<'_>) -> Markup {
    let parameter = scene.series.iter().any(|s| s.parameter.is_some());
    html! {
        div.wide { table.numbers {
            thead { tr {
                th { "Method" }
                @if parameter { th { "Parameter" } }
                th { "Adapter" } th { "RMSE" } th { "Largest" } th { "FLIP" } th { "Wrong texels" }
                th { "Wall" } th { "CPU" } th { "GPU" } th { "Frames" } th { "Passes" } th { "Draws" }
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

/// Pictures below the run folder, as far as there is room for them in the page.
struct Pictures<'a> {
    folder: &'a Path,
    room: usize,
}

impl Pictures<'_> {
    /// The truth and what each method drew, at its middle value where there is a picture of that.
    fn strip(&mut self, scene: &SceneSeries<'_>) -> Markup {
        let mut figures: Vec<(String, String)> = Vec::new();
        for series in &scene.series {
            let middle = series.middle();
            let drawn = || {
                series
                    .points
                    .iter()
                    .filter(|p| p.measured.picture.is_some())
            };
            let Some(point) = drawn()
                .find(|p| p.value == middle)
                .or_else(|| drawn().next())
            else {
                continue;
            };
            let m = point.measured;
            if figures.is_empty()
                && let Some(truth) = m.truth.as_deref().and_then(|t| self.read(t))
            {
                figures.push(("truth".to_owned(), truth));
            }
            if let Some(picture) = m.picture.as_deref().and_then(|p| self.read(p)) {
                let name = match (series.parameter, point.value) {
                    (Some(p), Some(v)) => format!("{}, {p} {}", series.name(), value_text(v)),
                    _ => series.name(),
                };
                figures.push((name, picture));
            }
        }
        html! {
            @if !figures.is_empty() {
                div.pictures {
                    @for (name, data) in &figures {
                        figure { img src=(data) alt={ "Picture: " (name) } width="128"; figcaption { (name) } }
                    }
                }
            }
        }
    }

    /// A picture as a link that holds it. One that cannot be read has no place in a page of numbers.
    fn read(&mut self, path: &str) -> Option<String> {
        let bytes = Run::read_picture(self.folder, path, PICTURE).ok()??;
        self.room = self.room.checked_sub(bytes.len())?;
        Some(format!("data:image/png;base64,{}", STANDARD.encode(bytes)))
    }
}
