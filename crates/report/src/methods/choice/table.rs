//! A question's methods in its scenes: error, time, and the parameter at which each breaks.

use super::{FrameSize, QuestionPoints, error, time};
use crate::chart::key;
use crate::methods::breaks::Break;
use crate::methods::data::{MethodSeries, SceneSetting, ShownScene};
use crate::methods::name::{row_anchor, title};
use crate::methods::stability;
use crate::numbers::{round_duration, share};
use crate::table::{Cell, Table};
use maud::{Markup, html};

/// Returns the table of a question, by its number, on an adapter at a size.
pub(super) fn table(
    number: usize,
    points: &QuestionPoints<'_, '_>,
    adapter: usize,
    size: FrameSize,
) -> Markup {
    let mut table = Table::<&str>::new("numbers sortable").head("Method", |method| {
        let place = points.question.methods.iter().position(|m| m == method);
        Cell::from(html! { (key(points.question.style(method))) " " (method) })
            .with("id", place.map(|place| row_anchor(number, adapter, place)))
    });
    for (scene, shown) in points.scenes.iter().enumerate() {
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
            let broken = broken_at(shown, method, adapter);
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
fn broken_at(shown: &ShownScene<'_, '_>, method: &str, adapter: usize) -> Option<String> {
    let setting = shown.settings.get(shown.main)?;
    let (parameter, _) = setting.parameter?;
    let along = |s: &&MethodSeries<'_>| {
        s.method == method && s.variant == setting.variant && s.parameter == Some(parameter)
    };
    let series = shown.scene.series.iter().find(along)?;
    match stability::break_of(shown.scene, series, adapter)? {
        Break::Crossings(crossings) => Some(format!("{parameter} {}", crossings.first()?.text())),
        Break::Never | Break::Always => None,
    }
}
