//! The best methods of every scene, for the first page and the terminal.

use super::breaks::LIMIT;
use super::data::{DeviceKind, MethodSeries, Methods, SceneSeries, SceneSetting, SeriesPoint};
use super::name::PAGE;
use super::{choice, claims, stability};
use crate::numbers::{duration, share};
use crate::table::{Cell, Table};
use crate::words::plain;
use maud::{Markup, html};

/// The maximum number of lines of each part on a terminal.
const LISTED: usize = 60;
/// The maximum number of characters of a line on a terminal.
const LONGEST: usize = 500;

/// The best methods of a scene on adapters of a kind, all at one setting.
struct Best<'a> {
    /// The scene's index in the page of methods.
    anchor: String,
    scene: String,
    setting: SceneSetting<'a>,
    kind: DeviceKind,
    /// The most accurate method and its error.
    accurate: (&'a str, f64),
    fast: Fast<'a>,
}

/// The fastest method within one percent.
enum Fast<'a> {
    /// The method, its time and its adapter.
    Method(&'a str, f64, &'a str),
    /// No method is within one percent.
    Nothing,
    /// Only one method was measured, so nothing can be compared.
    Alone,
}

/// Finds the best methods of all scenes.
fn best<'a>(methods: &Methods<'a>) -> Vec<Best<'a>> {
    let mut found = Vec::new();
    for shown in methods.shown() {
        let Some(setting) = shown.scene.main() else {
            continue;
        };
        for kind in methods.kinds() {
            let timed: Vec<_> = candidates(methods, shown.scene, &setting, kind).collect();
            let Some((series, _, error)) = accurate(&timed) else {
                continue;
            };
            found.push(Best {
                anchor: shown.anchor.clone(),
                scene: format!("{}/{}", shown.scene.question, shown.scene.name),
                setting: setting.clone(),
                kind,
                accurate: (series.method, *error),
                fast: fast(methods, &timed),
            });
        }
    }
    found
}

/// A method on an adapter with its error.
type RankedMethod<'s, 'a> = (&'s MethodSeries<'a>, &'s SeriesPoint<'a>, f64);

fn candidates<'s, 'a>(
    methods: &'s Methods<'a>,
    scene: &'s SceneSeries<'a>,
    setting: &'s SceneSetting<'a>,
    kind: DeviceKind,
) -> impl Iterator<Item = RankedMethod<'s, 'a>> {
    let of_kind = scene
        .at(setting)
        .filter(move |(_, p)| methods.adapters[p.adapter].kind == kind);
    of_kind.filter_map(|(series, point)| Some((series, point, point.error()?)))
}

/// Returns the most accurate method; if several are equal, the fastest of them.
fn accurate<'s, 'a, 'c>(
    candidates: &'c [RankedMethod<'s, 'a>],
) -> Option<&'c RankedMethod<'s, 'a>> {
    let time = |point: &SeriesPoint<'_>| point.wall().unwrap_or(f64::INFINITY);
    candidates
        .iter()
        .min_by(|(_, a, a_error), (_, b, b_error)| {
            let errors = a_error.total_cmp(b_error);
            errors.then(time(a).total_cmp(&time(b)))
        })
}

fn fast<'a>(methods: &Methods<'a>, candidates: &[RankedMethod<'_, 'a>]) -> Fast<'a> {
    let first = candidates.first().map(|(series, ..)| series.method);
    if candidates
        .iter()
        .all(|(series, ..)| Some(series.method) == first)
    {
        return Fast::Alone;
    }
    let good = candidates.iter().filter(|(.., error)| *error <= LIMIT);
    let timed = good.filter_map(|(series, point, _)| Some((series, point, point.wall()?)));
    match timed.min_by(|a, b| a.2.total_cmp(&b.2)) {
        Some((series, point, time)) => {
            Fast::Method(series.method, time, methods.adapters[point.adapter].name)
        }
        None => Fast::Nothing,
    }
}

/// Returns the section of `index.html` that leads to the page of methods.
pub(crate) fn section(methods: &Methods<'_>) -> Markup {
    let mut table = Table::<Best<'_>>::new("text")
        .head(
            "Scene",
            |best| html! { a href={ (PAGE) "#" (best.anchor) } { (best.scene) } },
        )
        .text("At", |best| best.setting.text());
    if methods.kinds().len() > 1 {
        table = table.text("Adapters", |best| best.kind.name());
    }
    let table = table
        .text("Most accurate", |best| match best.fast {
            Fast::Alone => format!("only {} measured", best.accurate.0),
            _ => best.accurate.0.to_owned(),
        })
        .number("RMSE", |best| share(best.accurate.1))
        .text("Fastest within 1 % RMSE", |best| match best.fast {
            Fast::Method(method, ..) => Cell::from(method),
            Fast::Nothing => Cell::from("none"),
            Fast::Alone => Cell::from("nothing to compare").class("u"),
        })
        .number("Frame time", |best| match best.fast {
            Fast::Method(_, time, _) => Some(duration(time)),
            _ => None,
        })
        .text("On", |best| match best.fast {
            Fast::Method(.., adapter) => Some(adapter),
            _ => None,
        });
    html! {
        section id="methods" {
            h2 { "Methods: accuracy against speed" }
            p {
                "The best methods of every scene, all at the same parameters. Charts, break points and "
                "claims are on " a href=(PAGE) { "the page of methods" } "."
            }
            (table.page(best(methods)))
        }
    }
}

/// Returns the methods of a run for a terminal, in the order of their page: the answer to each question, break
/// points, scenes, claims.
pub(crate) fn lines(methods: &Methods<'_>) -> String {
    let shown = methods.shown();
    let parts = [
        (
            "Methods: accuracy against time",
            choice::lines(methods, &shown),
        ),
        ("Break points, at 1 % RMSE", stability::lines(methods)),
        (
            "Scenes: the most accurate method, and the fastest within 1 % RMSE",
            scenes(methods),
        ),
        ("Claims of the literature", claims::lines(methods)),
    ];
    let mut text = String::new();
    for (title, lines) in parts.iter().filter(|(_, lines)| !lines.is_empty()) {
        text += &format!("\n{title}\n");
        for line in lines.iter().take(LISTED) {
            text += &format!("  {}\n", plain(line, LONGEST));
        }
        if let Some(more @ 1..) = lines.len().checked_sub(LISTED) {
            text += &format!("  and {more} more\n");
        }
    }
    text
}

/// Returns a line per scene.
fn scenes(methods: &Methods<'_>) -> Vec<String> {
    let several = methods.kinds().len() > 1;
    let line = |best: Best<'_>| {
        let mut line = format!("{}{}", best.scene, best.setting.at());
        if several {
            line += &format!(" ({})", best.kind.name());
        }
        let (method, error) = (best.accurate.0, share(best.accurate.1));
        line.push_str(&match best.fast {
            Fast::Alone => format!(": only {method} measured, {error}"),
            Fast::Nothing => format!(": {method} {error}; none within"),
            Fast::Method(fast, time, adapter) => {
                format!(": {method} {error}; {fast} {} on {adapter}", duration(time))
            }
        });
        line
    };
    best(methods).into_iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::tests::made::{Made, run};

    #[test]
    fn only_methods_at_one_setting_are_ranked_and_a_lone_one_is_not() {
        let candidate = |method: &str, opening, error: f64| {
            Made::new(&format!("aa/wedge/method={method}"))
                .at("opening", opening)
                .off(error)
        };
        // `none` looks best at a setting where nothing else was drawn.
        let mixed = run(&[
            candidate("none", 24.0, 0.001),
            candidate("msaa-4", 4.0, 0.02),
            candidate("ssaa", 4.0, 0.015),
        ]);
        let methods = Methods::of(&mixed).unwrap();
        let text = lines(&methods);
        assert!(
            text.contains("aa/wedge at opening 4: ssaa 1.5\u{a0}%; none within"),
            "{text}"
        );
        let html = section(&methods).into_string();
        assert!(
            html.contains("opening 4") && !html.contains("<td>none</td><td class=\"num\">0.1"),
            "{html}"
        );

        let alone = run(&[
            candidate("none", 24.0, 0.001),
            candidate("msaa-4", 4.0, 0.02),
        ]);
        let methods = Methods::of(&alone).unwrap();
        let text = lines(&methods);
        assert!(
            text.contains("aa/wedge at opening 24: only none measured, 0.1\u{a0}%"),
            "{text}"
        );
        assert!(
            section(&methods)
                .into_string()
                .contains("nothing to compare")
        );
    }
}
