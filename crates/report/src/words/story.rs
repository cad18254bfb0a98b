//! Stories in words: the ruling in one sentence, then the operations line by line.

use super::event::{detail_of, draw_name, event_line, rejection_predicate};
use super::subject::{list, scene_name, side_name, texel_name};
use super::value::{codes_list, color_name};
use etalon_frame::{
    Allowed, Aspect, Band, ChannelMismatch, CodeInterval, Codes, ContentSource, Contents,
    DecidingStep, Demand, Effect, Event, Initial, Rejection, Returned, Ruling, Step, Story, Target,
    ToldLine, Values,
};
use std::fmt::Write as _;

/// Returns the ruling of a story in one sentence.
pub fn sentence(story: &Story) -> Option<String> {
    if let Some(ruling) = &story.ruling {
        return Some(ruling_sentence(ruling));
    }
    let verdict = told_verdict(story)?;
    Some(format!("{} {}", verdict.at, verdict.detail))
}

/// Returns the rules by which a story's ruling was made, with the strength of the evidence.
pub fn judged_by(story: &Story) -> Option<String> {
    match &story.ruling {
        Some(ruling) => Some(ruling_judged_by(ruling)),
        None => told_verdict(story)?.citation.clone(),
    }
}

/// Returns the clause behind a story's ruling: that of the first operation that decides it.
pub(crate) fn clause(story: &Story) -> Option<&str> {
    let Demand::Values(values) = &story.ruling.as_ref()?.demand else {
        return None;
    };
    fn event(step: &DecidingStep) -> Option<&str> {
        match step {
            // A shader that cites a clause can be wrong by more than the conversion of its value.
            DecidingStep::Stored {
                store,
                shade: Some(shade),
                ..
            } => shade.citation.as_deref().or(store.citation.as_deref()),
            DecidingStep::Open(event)
            | DecidingStep::Stored { store: event, .. }
            | DecidingStep::Cleared(event)
            | DecidingStep::Resolved(event)
            | DecidingStep::Kept(event)
            | DecidingStep::Ended { by: event, .. } => event.citation.as_deref(),
            DecidingStep::Unwritten { .. } => None,
        }
    }
    values.reasons.iter().find_map(event)
}

/// Returns the operations of a story in words.
pub(crate) fn operations(story: &Story) -> Vec<ToldLine> {
    let mut lines = story.told[usize::from(told_verdict(story).is_some())..].to_vec();
    let mut alone = story.alone.iter().peekable();
    for event in &story.events {
        // The ruling on a single scene comes before its events.
        if let Some((scene, ruling)) =
            alone.next_if(|(scene, _)| event.scene.as_ref() == Some(scene))
        {
            lines.push(line(scene_name(scene), "alone", ruling_sentence(ruling)));
        }
        lines.push(event_line(event));
    }
    if story.cut {
        let cut = "the rest of the story did not fit".to_owned();
        lines.push(line("end of the record".to_owned(), "cut", cut));
    }
    lines
}

fn line(place: String, operation: &str, detail: String) -> ToldLine {
    ToldLine {
        at: place,
        operation: operation.to_owned(),
        detail,
        citation: None,
    }
}

/// Returns a whole story as text, each line with its newline.
pub fn story_text(story: &Story) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    if let Some(sentence) = sentence(story) {
        let _ = writeln!(text, "{sentence}");
        if let Some(judged_by) = judged_by(story) {
            let _ = writeln!(text, "  {judged_by}");
        }
    }
    text + &operations_text(story)
}

/// Returns the operations of a story as text, each line with its newline.
pub fn operations_text(story: &Story) -> String {
    let mut text = String::new();
    let lines = operations(story);
    for group in lines.chunk_by(|a, b| a.at == b.at) {
        let _ = writeln!(text, "{}", group[0].at);
        for line in group {
            let _ = writeln!(text, "  {}: {}", line.operation, line.detail);
            if let Some(citation) = &line.citation {
                let _ = writeln!(text, "      [{citation}]");
            }
        }
    }
    text
}

/// Returns the verdict of a story that an earlier version wrote.
fn told_verdict(story: &Story) -> Option<&ToldLine> {
    story
        .told
        .first()
        .filter(|line| line.operation == "verdict")
}

/// Returns a ruling in one sentence.
fn ruling_sentence(ruling: &Ruling) -> String {
    let subject = texel_name(ruling.texel, &ruling.samples);
    let subject = match &ruling.variant {
        Some(variant) => format!("in variant {variant}, {subject}"),
        None => subject,
    };
    let predicate = match &ruling.demand {
        Demand::Open {
            returned,
            several_colors,
        } => {
            let came = returned.as_ref().map(|contents| {
                let values = contents_text(contents, *several_colors);
                format!("; the driver returned {values}")
            });
            format!(
                "is open: the rules leave it too many outcomes to assert any{}",
                came.unwrap_or_default()
            )
        }
        Demand::Values(values) => values_predicate(values),
        Demand::Same {
            sides,
            texel,
            channels,
            ..
        } => {
            let [first, second] = sides.each_ref().map(side_name);
            let other = texel_name(*texel, &ruling.samples);
            if sides[0] == sides[1] {
                let there = format!("in {other}");
                let differences = differences(channels, ["here", &there]);
                format!(
                    "must have the colour of {other}, which has the same source and destination: {differences}"
                )
            } else {
                let same = if *texel == ruling.texel {
                    format!("{first} and {second}")
                } else {
                    format!("{first} and, as {other}, {second}")
                };
                let differences = differences(channels, [&first, &second]);
                format!("must be the same {same}: {differences}")
            }
        }
    };
    let mut sentence = format!("{subject} {predicate}");
    if !ruling.after.is_empty() {
        let _ = write!(
            sentence,
            "; only when drawn after {}",
            ruling.after.join(", then ")
        );
    }
    sentence
}

fn ruling_judged_by(ruling: &Ruling) -> String {
    let mut text = format!("judged by {}", ruling.rules);
    if let Demand::Same { citation, .. } = &ruling.demand {
        let _ = write!(text, ": {citation}");
    }
    let grade = ruling.band.map(|band| match band {
        Band::Fail => "proven: the text forbids it",
        Band::RequiredByCts => {
            "required by the CTS: the text is open, a Khronos mustpass case is not"
        }
        Band::Disputed => "disputed: only one reading of the text forbids it",
        Band::Imprecise => "imprecise: legal, but not as good as it should be",
    });
    if let Some(grade) = grade {
        let _ = write!(text, "; {grade}");
    }
    text
}

/// Returns the values on both sides: `red is 51 in the scene and 52 in variant twice`.
fn differences(channels: &[ChannelMismatch], [first, second]: [&str; 2]) -> String {
    let channel = |m: &ChannelMismatch| {
        let name = m.aspect.channel(m.channel.into());
        let value = |code: u32| {
            let order = m.encoding.order_of_code(code);
            let codes = Codes::new(m.encoding, CodeInterval::exact(order));
            codes_list(&[codes])
        };
        let (legal, actual) = (value(m.low), value(m.actual));
        format!("{name} is {legal} {first} and {actual} {second}")
    };
    channels.iter().map(channel).collect::<Vec<_>>().join(", ")
}

fn values_predicate(values: &Values) -> String {
    let modal = if values.yardstick { "should" } else { "must" };
    let mut sentence = format!("{modal} {}", demand(values));
    let reason = reasons(values);
    if !reason.is_empty() {
        sentence = format!("{sentence}: {reason}");
    }
    let several = values.several_colors;
    match &values.returned {
        None => sentence,
        Some(Returned::Allowed(contents)) => {
            let returned = contents_text(contents, several);
            format!("{sentence}; the driver returned {returned}, which is allowed")
        }
        Some(Returned::Wrote(contents)) => {
            format!(
                "{sentence}; the driver wrote {}",
                contents_text(contents, several)
            )
        }
        Some(Returned::Kept { contents, from }) => {
            let value = value(contents, several);
            let kept = match from {
                ContentSource::Initial(initial) => first_contents(contents, *initial, several),
                ContentSource::Operation => value,
                ContentSource::Draw { pass, draw } => {
                    format!(
                        "{value} of {}",
                        draw_name(*pass, *draw, values.several_passes)
                    )
                }
            };
            format!("{sentence}; the driver kept {kept}")
        }
    }
}

/// Returns the demand: `keep the clear colour [0, 0, 0, 0] and hold depth 0.5`.
fn demand(values: &Values) -> String {
    let several = values.several_colors;
    if let [outcome] = values.allowed.as_slice()
        && values.more_outcomes == 0
    {
        let part = |allowed: &Allowed| match (allowed.kept, allowed.contents.aspect) {
            (Some(initial), _) => {
                format!(
                    "keep {}",
                    first_contents(&allowed.contents, initial, several)
                )
            }
            (None, Aspect::Color) => format!("be {}", value(&allowed.contents, several)),
            (None, _) => format!("hold {}", value(&allowed.contents, several)),
        };
        return list(&outcome.iter().map(part).collect::<Vec<_>>(), "and");
    }
    let mut parts: Vec<String> = values
        .allowed
        .iter()
        .map(|outcome| {
            let each: Vec<String> = outcome
                .iter()
                .map(|a| value(&a.contents, several))
                .collect();
            each.join(" with ")
        })
        .collect();
    if values.more_outcomes > 0 {
        parts.push(format!("one of {} more outcomes", values.more_outcomes));
    }
    format!("be {}", list(&parts, "or"))
}

/// Returns the reasons for the demand: the operations that decide it.
fn reasons(values: &Values) -> String {
    let reason = |reason: &DecidingStep| reason_text(reason, values.several_passes);
    let mut parts: Vec<String> = values.reasons.iter().map(reason).collect();
    match values.more_draws {
        0 => {}
        1 => parts.push("one more draw ends before it".to_owned()),
        n => parts.push(format!("{n} more draws end before it")),
    }
    if parts.is_empty() {
        return "no draw concerns it".to_owned();
    }
    list(&parts, "and")
}

fn reason_text(reason: &DecidingStep, several_passes: bool) -> String {
    let name = |event: &Event| {
        let (pass, draw) = event.origin.draw().unwrap_or_default();
        draw_name(pass, draw, several_passes)
    };
    match reason {
        DecidingStep::Open(event) => format!("of {}, {}", name(event), detail_of(event)),
        DecidingStep::Stored {
            store,
            shade,
            blended,
        } => {
            let name = name(store);
            match (&store.effect, shade) {
                (_, Some(shade)) => {
                    let verb = if *blended { "blends" } else { "stores" };
                    let gives = detail_of(shade);
                    format!("{name} passes all its tests and {verb} it ({gives})")
                }
                (
                    Effect::Stores(Target {
                        aspect: Aspect::Stencil,
                        ..
                    }),
                    None,
                ) => {
                    format!("{name} stores it ({})", detail_of(store))
                }
                _ => format!("{name} passes all its tests and stores it"),
            }
        }
        DecidingStep::Cleared(event) => {
            let line = event_line(event);
            format!("{}, {} after a clear", line.at, line.detail)
        }
        DecidingStep::Resolved(event) => format!("it is resolved from {}", detail_of(event)),
        DecidingStep::Kept(event) => format!("{} leaves it: {}", name(event), detail_of(event)),
        DecidingStep::Ended { by, draws } => {
            let Some(rejection) = by.effect.rejection() else {
                return format!("{} ends before it", name(by));
            };
            match by.step {
                Step::Coverage(coverage) if coverage.is_edge() => {
                    format!("{} does not cover it: {}", name(by), detail_of(by))
                }
                _ if *draws > 1 => format!("{draws} draws {}", rejections(rejection)),
                _ => format!(
                    "{} {}",
                    name(by),
                    rejection_predicate(rejection, &detail_of(by))
                ),
            }
        }
        DecidingStep::Unwritten { pass, draw, aspect } => {
            let name = draw_name(*pass, *draw, several_passes);
            format!("{name} does not write {}", aspect.name())
        }
    }
}

/// Returns the predicate of several draws that do not reach a sample.
fn rejections(rejection: Rejection) -> &'static str {
    match rejection {
        Rejection::Viewport => "are outside their viewports",
        Rejection::Scissor => "are outside their scissor rectangles",
        _ => "do not cover it",
    }
}

/// Returns values as one outcome: `red [255, 0, 0, 255] with depth 0.5`.
fn contents_text(contents: &[Contents], several_colors: bool) -> String {
    let values = contents.iter().map(|c| value(c, several_colors));
    values.collect::<Vec<_>>().join(" with ")
}

/// Returns the name and value of the contents that an attachment starts with.
fn first_contents(contents: &Contents, initial: Initial, several_colors: bool) -> String {
    let word = match initial {
        Initial::Upload => "uploaded",
        Initial::Clear => "clear",
    };
    match contents.aspect {
        Aspect::Color => format!(
            "the {word} colour [{}]{}",
            codes_list(&contents.codes),
            place(contents, several_colors)
        ),
        _ => format!("the {word} {}", value(contents, several_colors)),
    }
}

/// Returns a value in words: `red [255, 0, 0, 255]`, `depth 0.5`, `stencil 3`.
fn value(contents: &Contents, several_colors: bool) -> String {
    let codes = codes_list(&contents.codes);
    match contents.aspect {
        Aspect::Color => {
            let name = color_name(&contents.codes);
            let name = name.map_or(String::new(), |name| format!("{name} "));
            format!("{name}[{codes}]{}", place(contents, several_colors))
        }
        other => format!("{} {codes}", other.name()),
    }
}

/// Returns the attachment of a colour, if several are read back.
fn place(contents: &Contents, several_colors: bool) -> String {
    if several_colors {
        format!(" in {}", contents.attachment)
    } else {
        String::new()
    }
}
