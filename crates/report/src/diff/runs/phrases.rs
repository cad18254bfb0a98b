//! Differences of runs in words, for the terminal and the page.

use super::data::{
    AdapterPair, CaseChange, ChangeDirection, Detail, FrameChange, Only, RunDiff, RunSide,
};
use crate::lists;
use crate::numbers::{change, count, trimmed};
use crate::words::{name, plain};
use etalon_record::Verdict;
use serde_json::Value;
use std::collections::BTreeMap;

/// Returns a sign that distinguishes directions without colour, the colour on a terminal, and the title on a
/// page.
pub(super) fn look(direction: ChangeDirection) -> [&'static str; 3] {
    match direction {
        ChangeDirection::Worse => ["✗", "31", "Worse"],
        ChangeDirection::Better => ["✓", "32", "Better"],
        ChangeDirection::Other => ["≠", "36", "Other changes"],
    }
}

/// Returns `pass → fail (expected)`, or the unchanged verdict with the parts that differ.
pub(super) fn verdicts(change: &CaseChange) -> String {
    let [before, after] = change.verdict;
    if before != after {
        let excused = after.is_bad() && !change.unexpected[1];
        let suffix = if excused { " (expected)" } else { "" };
        return format!("{}{suffix}", transition(change.verdict));
    }
    let what = change.what.iter().map(|what| match *what {
        "frame" => "pixels",
        "texels" => "texel counts",
        "wrong" => "wrong texels",
        other => other,
    });
    let what = what.collect::<Vec<_>>().join(", ");
    format!("{} as before, other {what}", name(before))
}

/// Returns `pass → fail`.
fn transition([before, after]: [Verdict; 2]) -> String {
    format!("{} → {}", name(before), name(after))
}

/// Returns `2 pass → fail, 1 fail → pass`.
pub(super) fn transitions(pair: &AdapterPair) -> String {
    let each = pair
        .transitions
        .iter()
        .map(|t| format!("{} {}", t.records, transition(t.verdict)));
    each.collect::<Vec<_>>().join(", ")
}

/// Returns the change of the expectations, if it alone decides the direction.
pub(super) fn expectation(change: &CaseChange) -> Option<&'static str> {
    match change.unexpected {
        [false, true] if !change.verdict[0].is_bad() => None,
        [false, true] => Some("expected before, and not after"),
        [true, false] if change.verdict[1].is_bad() => Some("expected after, and not before"),
        _ => None,
    }
}

/// Returns a figure as people read it.
pub(super) fn value(value: &Value) -> String {
    match value {
        Value::Null => "–".to_owned(),
        Value::String(text) => text.clone(),
        Value::Number(number) => match (number.as_u64(), number.as_f64()) {
            (Some(integer), _) => integer.to_string(),
            (None, Some(float)) => short(float),
            (None, None) => number.to_string(),
        },
        Value::Array(values) => match values.as_slice() {
            [] => "none".to_owned(),
            values => values
                .iter()
                .map(self::value)
                .collect::<Vec<_>>()
                .join(", "),
        },
        Value::Object(members) => {
            let known = members.iter().filter(|(_, v)| !v.is_null());
            let each = known.map(|(key, v)| format!("{key} {}", self::value(v)));
            each.collect::<Vec<_>>().join(", ")
        }
        Value::Bool(truth) => truth.to_string(),
    }
}

/// Returns four significant digits, with a power of ten if the number would have many zeros.
fn short(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".to_owned()
    } else if !(1e-3..1e6).contains(&size) {
        format!("{value:.3e}")
    } else {
        let digits = (3.0 - size.log10().floor()).clamp(0.0, 6.0) as usize;
        trimmed(format!("{value:.digits$}"))
    }
}

/// Returns `color mean 0.25 → 0.5`.
pub(super) fn detail(detail: &Detail) -> String {
    format!(
        "{}: {} → {}",
        title(detail),
        value(&detail.before),
        value(&detail.after)
    )
}

/// Returns the name of a figure.
pub(super) fn title(detail: &Detail) -> String {
    let kind = match detail.what {
        "texels" => "samples",
        "wrong" => "wrong texels",
        "accuracy" => "codes from the yardstick",
        "counters" => "counter",
        "distance" => "distance from the truth",
        "order" => "order",
        other => other,
    };
    format!("{kind}, {}", detail.name)
}

/// Returns the differences of two frames, image by image.
pub(super) fn frame(frame: &FrameChange) -> Vec<String> {
    let images = frame.images.iter().map(|image| {
        let thing = if image.attachment == image.aspect.name() {
            image.attachment.clone()
        } else {
            format!("{} {}", image.attachment, image.aspect)
        };
        match image.differ {
            0 => format!("{thing}: equal"),
            n => format!(
                "{thing}: {n} of {} differ, by up to {}",
                count(image.samples, "sample"),
                count(image.largest, "code")
            ),
        }
    });
    let unlike = frame.unlike.iter();
    let unlike =
        unlike.map(|name| format!("{name}: of another size or format, or in one run only"));
    images.chain(unlike).collect()
}

/// Returns the changes of one direction. The first change of each kind comes first, then the others in their
/// order.
pub(super) fn spread(changes: &[CaseChange], direction: ChangeDirection) -> Vec<&CaseChange> {
    let these = changes.iter().filter(|c| c.direction == direction);
    let mut these: Vec<&CaseChange> = these.collect();
    lists::spread(&mut these, |c| {
        (&c.case_file, &c.adapter, c.verdict, &c.what)
    });
    these
}

/// Groups the cases that only one run has: by case file, adapter, side, and whether the difference is worse.
/// Returns one case of each group, with the number of cases.
pub(super) fn only_by_file(only: &[Only]) -> Vec<(&Only, u64)> {
    let mut found: BTreeMap<(bool, &str, &str, bool), (&Only, u64)> = BTreeMap::new();
    for feature in only {
        let key = (
            !feature.worse,
            feature.case_file.as_str(),
            feature.adapter.as_str(),
            feature.side == RunSide::After,
        );
        found.entry(key).or_insert((feature, 0)).1 += 1;
    }
    found.into_values().collect()
}

/// Returns `before only` or `after only`.
pub(super) fn side(side: RunSide) -> &'static str {
    match side {
        RunSide::Before => "before only",
        RunSide::After => "after only",
    }
}

/// Returns a text about everything that is worse apart from the changes (lost records, vanished adapters),
/// and about everything that could not be decided. The text is empty or begins with a separator from the
/// counts before it.
pub(super) fn beside(diff: &RunDiff) -> String {
    let mut text = String::new();
    if diff.lost() > 0 {
        text += &format!(", {} lost", count(diff.lost(), "record"));
    }
    let vanished: Vec<String> = diff.vanished().map(|u| plain(&u.adapter, 60)).collect();
    if !vanished.is_empty() {
        text += &format!("; vanished: {}", vanished.join(", "));
    }
    if !diff.untold.is_empty() {
        text += &format!("; cannot tell: {}", diff.untold.join("; "));
    }
    text
}

/// Returns after over before, as a signed change.
pub(super) fn ratio([before, after]: [f64; 2]) -> String {
    change(after / before)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn figures_are_short() {
        let texts = [
            (json!(0.0), "0"),
            (json!(0.25), "0.25"),
            (json!(1.0 / 3.0), "0.3333"),
            (json!(123_456.7), "123457"),
            (json!(100.0), "100"),
            (json!(1e-9), "1.000e-9"),
            (json!(4_294_967_296_u64), "4294967296"),
            (json!(null), "–"),
            (json!(["pass", "fail"]), "pass, fail"),
            (json!([]), "none"),
            (
                json!({ "kind": "died", "signal": 6, "exit": null }),
                "kind died, signal 6",
            ),
        ];
        for (json, expected) in texts {
            assert_eq!(value(&json), expected);
        }
    }
}
