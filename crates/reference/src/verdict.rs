//! The verdict on one sample in one sentence: the value that the rules demand, the operation that decides
//! it, and the value that came back. Made from the legal set and from the effects of the notes alone, so
//! that it cannot contradict the judge.

use crate::clause::Rejection;
use crate::notes::{Effect, Note};
use crate::sample::Sample;
use crate::walk::{Walk, codes_text};
use crate::world::World;
use etalon_frame::{Aspect, ChannelEncoding, CodeInterval, Frame, StoryLine, TexelSet};
use etalon_scene::Contents;

/// The most values, and the most draws, that a sentence lists.
const LISTED: usize = 3;

/// One aspect of one attachment, as part of a legal set.
struct View {
    attachment: usize,
    aspect: Aspect,
    encodings: Vec<ChannelEncoding>,
    /// Its first channel in the set.
    first: usize,
}

impl View {
    fn of<'a, T>(&self, channels: &'a [T]) -> &'a [T] {
        &channels[self.first..self.first + self.encodings.len()]
    }
}

/// The sample of which a sentence is made, with all that is known of it.
struct Telling<'a> {
    walk: &'a Walk<'a>,
    notes: &'a [Note],
    set: &'a TexelSet,
    /// The first contents, in the channels of the set.
    initial: Vec<CodeInterval>,
    views: Vec<View>,
}

/// Returns the line of the verdict. With a frame, it also tells what came back.
pub(crate) fn verdict(
    walk: &Walk<'_>,
    at: Sample,
    set: &TexelSet,
    initial: &World,
    notes: &[Note],
    frame: Option<&Frame>,
) -> StoryLine {
    let mut nothing = crate::notes::Notes(None);
    let first = walk.finish(std::slice::from_ref(initial), at, &mut nothing);
    let telling = Telling {
        walk,
        notes,
        set,
        initial: first.worlds[0].channels.to_vec(),
        views: views(walk, at),
    };
    let actual = frame.and_then(|frame| telling.actual(at, frame));
    let subject = match at.samples {
        1 => format!("texel {},{}", at.x, at.y),
        _ => format!("sample {} of texel {},{}", at.sample, at.x, at.y),
    };
    StoryLine::verdict(
        subject,
        telling.predicate(actual.as_deref()),
        format!("judged by {}", walk.rules.text),
    )
}

fn views(walk: &Walk<'_>, at: Sample) -> Vec<View> {
    let mut first = 0;
    let mut views = Vec::new();
    for index in &walk.scene.read {
        let attachment = &walk.scene.attachments[*index];
        if (attachment.size, attachment.samples) != (at.size, at.samples) {
            continue;
        }
        for aspect in attachment.format.aspects() {
            let encodings = walk.read_encoding(*index, *aspect).0.into_owned();
            let next = first + encodings.len();
            views.push(View {
                attachment: *index,
                aspect: *aspect,
                encodings,
                first,
            });
            first = next;
        }
    }
    views
}

/// The end of a draw before a sample.
struct End {
    /// What is said of several draws that do not reach the sample for the same reason.
    elsewhere: Option<&'static str>,
    text: String,
}

impl End {
    fn here(text: String) -> Self {
        Self {
            elsewhere: None,
            text,
        }
    }
}

impl Telling<'_> {
    /// Returns the values that came back, in the channels of the set; `None` if the frame is of another
    /// scene.
    fn actual(&self, at: Sample, frame: &Frame) -> Option<Vec<i64>> {
        let mut orders = Vec::new();
        for view in &self.views {
            let name = &self.walk.scene.attachments[view.attachment].name;
            let image = frame.images.iter().find(|i| {
                &i.attachment == name
                    && i.aspect == view.aspect
                    && (i.size, i.samples) == (at.size, at.samples)
                    && i.channels == view.encodings
                    && i.codes.len() == i.expected_len()
            })?;
            let codes = image.sample(at.x, at.y, at.sample).iter();
            let both = codes.zip(&view.encodings);
            orders.extend(both.map(|(code, e)| e.order_of_code(*code)));
        }
        Some(orders)
    }

    fn predicate(&self, actual: Option<&[i64]>) -> String {
        let all: Vec<&View> = self.views.iter().collect();
        if self.set.is_open() {
            let came = actual.map(|a| format!("; the driver returned {}", self.came(&all, a)));
            return format!(
                "is open: the rules leave it too many outcomes to assert any{}",
                came.unwrap_or_default()
            );
        }
        let wrong = actual.filter(|orders| !self.set.allows(orders));
        let focus = wrong.map_or_else(|| all.clone(), |orders| self.wrong_views(orders));
        let modal = match self.walk.rules.name {
            "yardstick" => "should",
            _ => "must",
        };
        let mut sentence = format!("{modal} {}", self.demand(&focus));
        let reason = self.reason(focus[0]);
        if !reason.is_empty() {
            sentence = format!("{sentence}: {reason}");
        }
        match (actual, wrong) {
            (Some(_), Some(orders)) => {
                let kept = match focus.as_slice() {
                    [one] => self.kept(one, orders),
                    _ => None,
                };
                let came = match kept {
                    Some(kept) => format!("kept {kept}"),
                    None => format!("wrote {}", self.came(&focus, orders)),
                };
                format!("{sentence}; the driver {came}")
            }
            (Some(orders), None) => {
                let came = self.came(&focus, orders);
                format!("{sentence}; the driver returned {came}, which is allowed")
            }
            (None, _) => sentence,
        }
    }

    /// Returns the views in which values leave the nearest outcome. If each of them is legal in some other
    /// outcome, all views: then only the values together are wrong.
    fn wrong_views(&self, orders: &[i64]) -> Vec<&View> {
        let inside = |channels: &[CodeInterval], view: &View| {
            let both = view.of(channels).iter().zip(view.of(orders));
            both.into_iter().all(|(c, o)| c.contains(*o))
        };
        let outside = |view: &&View| {
            let nearest = self.set.nearest(orders);
            nearest.is_some_and(|w| !inside(&w.channels, view))
        };
        let wrong: Vec<&View> = self.views.iter().filter(outside).collect();
        let legal = |view: &&View| self.set.worlds.iter().any(|w| inside(&w.channels, view));
        if wrong.iter().all(legal) {
            self.views.iter().collect()
        } else {
            wrong
        }
    }

    /// Returns what the rules demand: `keep the clear colour [0, 0, 0, 0] and hold depth 0.5`.
    fn demand(&self, focus: &[&View]) -> String {
        let mut worlds: Vec<Vec<&[CodeInterval]>> = Vec::new();
        for world in &self.set.worlds {
            let one: Vec<&[CodeInterval]> = focus.iter().map(|v| v.of(&world.channels)).collect();
            if !worlds.contains(&one) {
                worlds.push(one);
            }
        }
        if let [one] = worlds.as_slice() {
            let parts: Vec<String> = focus
                .iter()
                .zip(one)
                .map(|(view, values)| {
                    let untouched = self.stores(view).next().is_none();
                    let kept = *values == view.of(&self.initial)
                        && (untouched || values.iter().all(|v| v.is_exact()));
                    let value = self.value(view, values);
                    match (kept, view.aspect) {
                        (true, _) => format!("keep {}", self.first_contents(view)),
                        (false, Aspect::Color) => format!("be {value}"),
                        (false, _) => format!("hold {value}"),
                    }
                })
                .collect();
            return list(&parts, "and");
        }
        let mut parts: Vec<String> = worlds
            .iter()
            .take(LISTED)
            .map(|world| {
                let each = focus.iter().zip(world);
                let each: Vec<String> = each.map(|(v, c)| self.value(v, c)).collect();
                each.join(" with ")
            })
            .collect();
        if worlds.len() > LISTED {
            parts.push(format!("one of {} more outcomes", worlds.len() - LISTED));
        }
        format!("be {}", list(&parts, "or"))
    }

    fn came(&self, views: &[&View], orders: &[i64]) -> String {
        let text = |view: &&View| {
            let orders = view.of(orders).iter();
            let exact: Vec<CodeInterval> = orders.map(|o| CodeInterval::exact(*o)).collect();
            self.value(view, &exact)
        };
        views.iter().map(text).collect::<Vec<_>>().join(" with ")
    }

    /// Returns earlier contents of a view that came back instead of what later draws had to store.
    fn kept(&self, view: &View, orders: &[i64]) -> Option<String> {
        if self.set.worlds.len() != 1 {
            return None;
        }
        let actual = view.of(orders);
        let is = |values: &[CodeInterval]| {
            let both = values.iter().zip(actual);
            both.into_iter().all(|(v, o)| v.contains(*o))
        };
        let stores: Vec<(&Note, Vec<CodeInterval>)> = self.stores(view).collect();
        let (_, before) = stores.split_last()?;
        if let Some((note, values)) = before.iter().rev().find(|(_, values)| is(values)) {
            let who = note
                .origin
                .as_ref()
                .map(|o| self.draw_name((o.pass, o.draw)));
            let value = self.value(view, values);
            return Some(match who {
                Some(who) => format!("{value} of {who}"),
                None => value,
            });
        }
        is(view.of(&self.initial)).then(|| self.first_contents(view))
    }

    /// Returns the stores to a view in order, with the contents as they would be read back.
    fn stores(&self, view: &View) -> impl Iterator<Item = (&Note, Vec<CodeInterval>)> {
        let (attachment, aspect, n) = (view.attachment, view.aspect, view.encodings.len());
        self.notes
            .iter()
            .filter_map(move |note| match &note.effect {
                Effect::Stores {
                    attachment: a,
                    aspect: b,
                    contents,
                } if (*a, *b) == (attachment, aspect) => {
                    let values = match aspect {
                        Aspect::Color => contents.channels[..n].to_vec(),
                        Aspect::Depth => {
                            vec![self.walk.read_depth(attachment, contents.channels[0])]
                        }
                        Aspect::Stencil => vec![CodeInterval::exact(i64::from(contents.stencil))],
                    };
                    Some((note, values))
                }
                _ => None,
            })
    }

    /// Returns the operations that decide a view: the last draw that stores, and the ends of those after
    /// it.
    fn reason(&self, view: &View) -> String {
        let mut parts = Vec::new();
        let last = self.stores(view).last().map(|(note, _)| note);
        let mut since = None;
        if let Some(note) = last {
            match &note.origin {
                Some(origin) => {
                    since = Some((origin.pass, origin.draw));
                    let name = self.draw_name((origin.pass, origin.draw));
                    let open = self.notes.iter().rev().find(|n| {
                        let same = |o: &crate::notes::Origin| {
                            (o.pass, o.draw) == (origin.pass, origin.draw)
                        };
                        matches!(n.effect, Effect::MayReject(_))
                            && n.origin.as_ref().is_some_and(same)
                    });
                    parts.push(match open {
                        Some(open) if self.set.worlds.len() > 1 => {
                            format!("of {name}, {}", open.line.detail)
                        }
                        _ => self.stored(&name, note),
                    });
                }
                None if note.line.operation == "clear" => {
                    return format!(
                        "{}, {} is what a clear left",
                        note.line.at, note.line.detail
                    );
                }
                None => return format!("it is resolved from {}", note.line.detail),
            }
        }
        let ends = self.ends(view, since);
        let more = ends.len().saturating_sub(LISTED);
        parts.extend(ends.into_iter().take(LISTED));
        match more {
            0 => {}
            1 => parts.push("one more draw ends before it".to_owned()),
            n => parts.push(format!("{n} more draws end before it")),
        }
        if parts.is_empty() {
            return "no draw concerns it".to_owned();
        }
        list(&parts, "and")
    }

    /// Returns what is said of the draw that stores last.
    fn stored(&self, name: &str, store: &Note) -> String {
        let of_fragment = |operation: &str| {
            let own = |n: &&Note| n.line.at == store.line.at && n.line.operation == operation;
            self.notes.iter().rfind(own)
        };
        let aspect = match store.effect {
            Effect::Stores { aspect, .. } => aspect,
            _ => Aspect::Color,
        };
        match (aspect, of_fragment("shade")) {
            (Aspect::Color, Some(shade)) => {
                let blends = ["blend", "advanced blend"];
                let verb = match blends.iter().any(|o| of_fragment(o).is_some()) {
                    true => "blends it",
                    false => "stores it",
                };
                let gives = &shade.line.detail;
                format!("{name} passes all its tests and {verb} ({gives})")
            }
            (Aspect::Stencil, _) => format!("{name} stores it ({})", store.line.detail),
            _ => format!("{name} passes all its tests and stores it"),
        }
    }

    /// Returns the ends of all draws after one, or of all: the operation that each comes to at last.
    fn ends(&self, view: &View, since: Option<(usize, usize)>) -> Vec<String> {
        let mut draws: Vec<(usize, usize)> = Vec::new();
        for origin in self.notes.iter().filter_map(|n| n.origin.as_ref()) {
            let draw = (origin.pass, origin.draw);
            if since.is_none_or(|s| draw > s) && !draws.contains(&draw) {
                draws.push(draw);
            }
        }
        let end = |draw: &(usize, usize)| {
            let own = |n: &&Note| {
                let origin = n.origin.as_ref();
                origin.is_some_and(|o| (o.pass, o.draw) == *draw)
            };
            let kept = self.notes.iter().filter(own).find(|n| {
                let Effect::Keeps { attachment, aspect } = n.effect else {
                    return false;
                };
                (attachment, aspect) == (view.attachment, view.aspect)
            });
            let name = self.draw_name(*draw);
            if let Some(kept) = kept {
                return End::here(format!("{name} leaves it: {}", kept.line.detail));
            }
            let all = || self.notes.iter().filter(own);
            let certain = all().filter_map(|n| match n.effect {
                Effect::Rejects(rejection) => Some((rejection, &n.line.detail)),
                _ => None,
            });
            let possible = all().filter_map(|n| match n.effect {
                Effect::MayReject(rejection) => Some((rejection, &n.line.detail)),
                _ => None,
            });
            let last = certain.max_by_key(|(rejection, _)| *rejection);
            match last.or_else(|| possible.max_by_key(|(rejection, _)| *rejection)) {
                Some((Rejection::Coverage, detail)) if detail.contains("edge") => {
                    End::here(format!("{name} does not cover it: {detail}"))
                }
                Some((rejection, detail)) => End {
                    elsewhere: rejection.elsewhere(),
                    text: format!("{name} {}", rejection.predicate(detail)),
                },
                None => End::here(format!("{name} does not write {}", view.aspect.name())),
            }
        };
        // Draws that are elsewhere for the same reason are told together.
        let all: Vec<End> = draws.iter().map(end).collect();
        let together = all.chunk_by(|a, b| a.elsewhere.is_some() && a.elsewhere == b.elsewhere);
        together
            .map(|group| match (group[0].elsewhere, group.len()) {
                (Some(place), 2..) => format!("{} draws {place}", group.len()),
                _ => group[0].text.clone(),
            })
            .collect()
    }

    fn draw_name(&self, (pass, draw): (usize, usize)) -> String {
        match self.walk.scene.passes.len() {
            1 => format!("draw {draw}"),
            _ => format!("draw {draw} of pass {pass}"),
        }
    }

    /// Returns the name and value of the contents that a view starts from.
    fn first_contents(&self, view: &View) -> String {
        let word = match &self.walk.scene.attachments[view.attachment].contents {
            Contents::Texels(_) => "uploaded",
            _ => "clear",
        };
        let values = view.of(&self.initial);
        match view.aspect {
            Aspect::Color => {
                let codes = codes(&view.encodings, values);
                format!("the {word} colour [{codes}]{}", self.place(view))
            }
            _ => format!("the {word} {}", self.value(view, values)),
        }
    }

    /// Returns values in words: `red [255, 0, 0, 255]`, `depth 0.5`, `stencil 3`.
    fn value(&self, view: &View, values: &[CodeInterval]) -> String {
        let codes = codes(&view.encodings, values);
        match view.aspect {
            Aspect::Color => {
                let name = color_name(&view.encodings, values);
                let name = name.map_or(String::new(), |name| format!("{name} "));
                format!("{name}[{codes}]{}", self.place(view))
            }
            other => format!("{} {codes}", other.name()),
        }
    }

    /// Returns the attachment of a colour, where several are read back.
    fn place(&self, view: &View) -> String {
        let colors = self.views.iter().filter(|v| v.aspect == Aspect::Color);
        match colors.count() {
            0 | 1 => String::new(),
            _ => format!(" in {}", self.walk.scene.attachments[view.attachment].name),
        }
    }
}

fn codes(encodings: &[ChannelEncoding], values: &[CodeInterval]) -> String {
    let both = encodings.iter().zip(values);
    let texts: Vec<String> = both.map(|(e, v)| codes_text(*e, *v)).collect();
    texts.join(", ")
}

/// Returns the name of a colour whose channels are 0 or 1 exactly; `None` for others.
fn color_name(encodings: &[ChannelEncoding], values: &[CodeInterval]) -> Option<&'static str> {
    let mut bits = [false; 4];
    if encodings.len() < 3 {
        return None;
    }
    bits[3] = encodings.len() == 3;
    for (i, (encoding, value)) in encodings.iter().zip(values).enumerate() {
        if matches!(encoding, ChannelEncoding::Uint(_)) || !value.is_exact() {
            return None;
        }
        let value = encoding.value_of_order(value.low);
        if value != 0.0 && value != 1.0 {
            return None;
        }
        bits[i] = value == 1.0;
    }
    Some(match bits {
        [false, false, false, false] => "transparent black",
        [false, false, false, true] => "black",
        [true, false, false, _] => "red",
        [false, true, false, _] => "green",
        [false, false, true, _] => "blue",
        [true, true, false, _] => "yellow",
        [true, false, true, _] => "magenta",
        [false, true, true, _] => "cyan",
        [true, true, true, _] => "white",
    })
}

/// Returns `a, b and c`.
fn list(parts: &[String], word: &str) -> String {
    match parts.split_last() {
        Some((last, before)) if !before.is_empty() => {
            format!("{} {word} {last}", before.join(", "))
        }
        Some((last, _)) => last.clone(),
        None => String::new(),
    }
}
