//! `methods.html`.

use super::data::{
    MethodSeries, Methods, Question, SceneSeries, SceneSetting, SeriesPoint, ShownScene,
};
use super::name::{title, value_text};
use super::pictures::PagePictures;
use super::{choice, claims, grid, layers, scatter, stability};
use crate::chart::{self, color, key, line_key};
use crate::command::quoted;
use crate::lists::{distinct, grouped};
use crate::numbers::{between, bytes, count, digits, duration, share};
use crate::page::adapter::breakable;
use crate::page::{self, Page};
use crate::table::Table;
use crate::words;
use etalon_methods::{Lesson, lessons};
use etalon_record::{Run, Times};
use maud::{Markup, html};
use std::path::Path;

const STYLE: &str = include_str!("page/methods.css");

/// The script of the sliders, the legend's pins, the choice and the pictures. Nothing else needs a script.
const SCRIPT: &str = concat!(
    "\"use strict\";\n",
    include_str!("../page/base.js"),
    include_str!("page/flip.js"),
    include_str!("page/pictures.js"),
    include_str!("page/settings.js"),
    include_str!("page/choice.js"),
);

/// Returns the whole page. Pictures are read from the folder when they are needed.
pub(crate) fn page(folder: &Path, run: &Run, methods: &Methods<'_>) -> String {
    let main = html! {
        (head(methods))
        noscript { p.note { "Scripts are off: each scene shows one setting, and its pictures are not compared with the truth." } }
        (sections(run, methods, &mut PagePictures::in_folder(folder)))
        (about(run, methods))
        (page::script(SCRIPT))
    };
    Page::new(
        &format!("etalon methods {}", run.header.provenance.started),
        "run.jsonl and pictures/ in this folder",
        &main,
    )
    .style(&style())
    .script(SCRIPT, false)
    .html()
}

/// Returns the sections of the page of a run's methods as HTML, and their style sheet; `None` if the run has no
/// methods. `read` returns the PNG file of a path below the run folder. Without the page's script, each scene shows one
/// setting.
pub fn methods_html(run: &Run, read: impl Fn(&str) -> Option<Vec<u8>>) -> Option<(String, String)> {
    let methods = Methods::of(run)?;
    let html = sections(run, &methods, &mut PagePictures::new(&read));
    Some((html.into_string(), style()))
}

fn style() -> String {
    chart::style() + STYLE
}

fn sections(run: &Run, methods: &Methods<'_>, pictures: &mut PagePictures<'_>) -> Markup {
    let shown = methods.shown();
    let scenes: Vec<Markup> = shown
        .iter()
        .map(|shown| in_scene(run, pictures, shown))
        .collect();
    html! {
        (choice::section(methods, &shown))
        (grid::section(methods, &shown))
        @for (q, question) in methods.questions.iter().enumerate() {
            section id={ "q" (q) } {
                h2 { (title(question.name)) }
                (choice::tables(methods, q, &shown))
                (explained(question))
                @for (shown, scene) in shown.iter().zip(&scenes) { @if std::ptr::eq(shown.question, question) { (scene) } }
            }
        }
        section id="reading" {
            h2 { "Reading the charts" }
            h3 { "Accuracy against speed" }
            (scatter::caption())
            h3 { "Stability" }
            (stability::caption())
        }
        section id="claims" {
            h2 { "Claims of the literature" }
            (claims::section(methods))
        }
    }
}

fn head(methods: &Methods<'_>) -> Markup {
    html! {
        header {
            h1 { "Methods: which one, at which price?" }
            nav {
                a href="#breaks" { "Break points" } " "
                @for (q, question) in methods.questions.iter().enumerate() {
                    a href={ "#q" (q) } { (title(question.name)) } " "
                }
                a href="#reading" { "Reading the charts" } " "
                a href="#claims" { "Claims" } " "
                a href="#run" { "This run" }
            }
        }
    }
}

/// Returns the facts about the run, which stand last.
fn about(run: &Run, methods: &Methods<'_>) -> Markup {
    let h = &run.header;
    let scenes = methods.scenes().count() as u64;
    let points = methods.scenes().flat_map(|s| &s.series);
    let records: usize = points.map(|s| s.points.len()).sum();
    html! {
        section id="run" {
            h2 { "This run" }
            dl.facts {
                dt { "Run" } dd { a href="index.html" { "verdicts and findings" } ", " (h.provenance.started) }
                dt { "Profile" } dd { (profile(run)) }
                dt { "Command" } dd { code { (h.provenance.command.join(" ")) } }
                dt { "Machine" } dd { (words::machine(&h.provenance.machine)) }
                dt { "Scope" } dd {
                    (count(scenes, "scene")) ", " (count(records as u64, "record")) " on "
                    @for (i, adapter) in methods.adapters.iter().enumerate() {
                        @if i > 0 { ", " }
                        code { (breakable(adapter.name)) } " (" (adapter.kind.name()) ")"
                    }
                }
            }
        }
    }
}

/// Returns the profile of the run, and what it leaves out.
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

/// Returns how each method of a question works, and where and why it fails.
fn explained(question: &Question<'_>) -> Markup {
    let lesson_of = |method: &&str| lessons(question.name).iter().find(|l| l.method == *method);
    let known: Vec<&Lesson> = question.methods.iter().filter_map(lesson_of).collect();
    html! {
        @if !known.is_empty() {
            details {
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

fn in_scene(run: &Run, pictures: &mut PagePictures<'_>, shown: &ShownScene<'_, '_>) -> Markup {
    let (methods, scene) = (shown.methods, shown.scene);
    let truth = scene
        .series
        .iter()
        .flat_map(|s| &s.points)
        .map(|p| p.measured.distance.truth_error)
        .fold(0.0, f64::max);
    let (speed, curves) = (scatter::charts(shown), stability::charts(shown));
    let together = speed.len() == 1;
    html! {
        article.scene id=(shown.anchor) data-name={ (scene.question) "/" (scene.name) } {
            h3 { (title(scene.name)) }
            p.legend {
                @for name in scene.methods() {
                    @let style = shown.style(name);
                    button class={ "key " (color(style)) } type="button" aria-pressed="false" { (line_key(style)) " " (name) }
                }
            }
            (slider(shown))
            @for (i, kind) in speed.iter().enumerate() {
                @if let Some(heading) = kind.heading { p.cap { (heading) } }
                div.charts.speed {
                    @for panel in &kind.panels { (panel) }
                    @if together && i == 0 { @for panel in &curves { (panel) } }
                }
            }
            @if !together && !curves.is_empty() {
                div.charts { @for panel in &curves { (panel) } }
            }
            @for (i, setting) in shown.settings.iter().enumerate() { (unmeasured(shown, setting, i)) }
            (pictures.of(shown))
            p.cap {
                @if truth > 0.0 { "The truth itself may be off by " (share(truth)) " in a channel. " }
                @else { "The truth is exact. " }
            }
            @if let Some(costs) = layers::section(shown) { (costs) }
            details {
                summary { "Table and command" }
                p.again { "Drawn by " code { (run.header.provenance.command.join(" ")) } "; this scene alone by "
                    code { "etalon run " @if scene.name.starts_with("gltf=") { "--gltf FILE " }
                        (quoted(&format!("methods/{}/{}/*", scene.question, scene.name))) } }
                (table(methods, scene))
            }
        }
    }
}

/// Returns the setting of the charts and pictures, and the slider to other settings. Without scripts the
/// setting is fixed.
fn slider(shown: &ShownScene<'_, '_>) -> Markup {
    let names: Vec<String> = shown.settings.iter().map(SceneSetting::text).collect();
    let input = format!("{}-at", shown.anchor);
    html! {
        @match shown.settings.as_slice() {
            [] => {},
            [only] => { @if !only.text().is_empty() { p.setting { "At " b { (only.text()) } } } },
            several => {
                p.setting {
                    label for=(input) { "At " output for=(input) { (names[shown.main]) } }
                    " " input id=(input) type="range" min="0" max=(several.len() - 1) step="1" value=(shown.main)
                        data-names=(serde_json::json!(names)) aria-valuetext=(names[shown.main]) disabled;
                }
            }
        }
    }
}

/// Returns the methods of the scene without an error, or without a time, at a setting.
fn unmeasured(shown: &ShownScene<'_, '_>, setting: &SceneSetting<'_>, index: usize) -> Markup {
    let (methods, scene) = (shown.methods, shown.scene);
    let drew = |i: &usize| scene.series.iter().any(|s| s.on(*i).next().is_some());
    let drew: Vec<usize> = (0..methods.adapters.len()).filter(drew).collect();
    let missing = grouped(drew.iter().flat_map(|i| {
        let missing = scene.unmeasured(setting, *i).into_iter();
        missing.map(|method| (method, methods.adapters[*i].name))
    }));
    let untimed = scene
        .at(setting)
        .filter(|(_, p)| p.error().is_some() && p.wall().is_none());
    let untimed = distinct(untimed.map(|(s, _)| s.method));
    html! {
        @if !missing.is_empty() || !untimed.is_empty() {
            p class=(shown.class("missing", index)) data-at=(index) {
                @if !missing.is_empty() {
                    span.chip.u { "not measured" } (setting.at()) ": "
                    @for (i, (method, on)) in missing.iter().enumerate() {
                        @if i > 0 { ", " }
                        (method)
                        @if on.len() < drew.len() { " on " (on.join(" and ")) }
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
    type Row<'s, 'a> = (&'s MethodSeries<'a>, &'s SeriesPoint<'a>);
    let time = |point: &SeriesPoint<'_>, part: fn(&Times) -> Option<f64>| {
        point.measured.time.as_ref().and_then(part).map(duration)
    };
    let mut table =
        Table::<Row<'_, '_>>::new("numbers").head("Method", |(series, _)| series.name());
    if scene.series.iter().any(|s| s.parameter.is_some()) {
        table = table.text("Parameter", |(series, point)| {
            let value = series.parameter.zip(point.value);
            value.map_or_else(String::new, |(name, value)| {
                format!("{name} {}", value_text(value))
            })
        });
    }
    table
        .text("Adapter", |(_, p)| methods.adapters[p.adapter].name)
        .text("RMSE", |(_, p)| share(p.measured.distance.rmse))
        .text("Largest", |(_, p)| share(p.measured.distance.max))
        .text("FLIP", |(_, p)| digits(p.measured.distance.flip, 3))
        .text("Wrong texels", |(_, p)| share(p.measured.distance.wrong))
        .text("Wall", move |(_, p)| time(p, |t| Some(t.wall)))
        .text("Interval", |(_, p)| {
            p.interval().map(|ends| between(ends, duration))
        })
        .text("CPU", move |(_, p)| time(p, |t| Some(t.cpu)))
        .text("GPU", move |(_, p)| time(p, |t| t.gpu))
        .text("Frames", |(_, p)| p.measured.time.map_or(0, |t| t.samples))
        .text("Passes", |(_, p)| p.measured.passes)
        .text("Draws", |(_, p)| p.measured.draws)
        .text("Fragments", |(_, p)| p.measured.fragments)
        .text("Attachments", |(_, p)| bytes(p.measured.bytes))
        .text("Verdict", |(_, p)| {
            let verdict = p.record.verdict;
            format!("{} {}", words::symbol(verdict), words::name(verdict))
        })
        .page(
            scene
                .series
                .iter()
                .flat_map(|s| s.points.iter().map(move |p| (s, p))),
        )
}
