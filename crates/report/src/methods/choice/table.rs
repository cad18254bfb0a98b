//! A question's methods in its scenes: error, time, and the parameter at which each breaks.

use super::{FrameSize, QuestionPoints, error, time};
use crate::chart::key;
use crate::methods::breaks::Break;
use crate::methods::data::{Methods, SceneSetting, ShownScene};
use crate::methods::name::title;
use crate::methods::stability::CurveBreak;
use crate::numbers::{round_duration, share};
use crate::table::{Cell, Table};
use maud::{Markup, html};

/// Returns the table of a question on an adapter at a size; `breaks` are those of each scene.
pub(super) fn table(
    methods: &Methods<'_>,
    points: &QuestionPoints<'_, '_>,
    breaks: &[Vec<CurveBreak<'_>>],
    adapter: usize,
    size: FrameSize,
) -> Markup {
    let name = methods.adapters[adapter].name;
    let mut table = Table::<&str>::new("numbers sortable").head("Method", |method| {
        html! { (key(points.question.style(method))) " " (method) }
    });
    for (scene, (shown, breaks)) in points.scenes.iter().zip(breaks).enumerate() {
        let heading = html! {
            a href={ "#" (shown.anchor) } { (title(shown.scene.name)) }
            @let setting = shown.settings.get(shown.main).map(SceneSetting::text).unwrap_or_default();
            @if !setting.is_empty() { br; small { (setting) } }
        };
        table = table.text(heading, move |method| {
            let here = |p: &&super::ScenePoint<'_>| {
                p.method == *method && p.adapter == adapter && p.scene == scene
            };
            let measured = points.points.iter().find(here).map(|p| p.measured)?;
            let Some([rmse, _]) = error(measured, size) else {
                return Some(Cell::from("not at this size"));
            };
            let time = time(measured, size).map(|[_, time, _]| round_duration(time));
            let broken = broken_at(breaks, method, name, shown);
            let shown = html! {
                (share(rmse))
                @if let Some(time) = time { br; small { (time) } }
                @if let Some(broken) = broken { br; small { "breaks at " (broken) } }
            };
            Some(Cell::from(shown).with("data-value", format!("{rmse:e}")))
        });
    }
    table.page(points.question.methods.clone())
}

/// Returns the first value of the parameter at which a method's error crosses the limit, if it does.
fn broken_at(
    breaks: &[CurveBreak<'_>],
    method: &str,
    adapter: &str,
    shown: &ShownScene<'_, '_>,
) -> Option<String> {
    let of_method = |b: &&CurveBreak<'_>| b.method == method && b.adapters.contains(&adapter);
    let Break::Crossings(crossings) = &breaks.iter().find(of_method)?.found else {
        return None;
    };
    let (parameter, _) = shown.settings.get(shown.main)?.parameter?;
    Some(format!("{parameter} {}", crossings.first()?.text()))
}
