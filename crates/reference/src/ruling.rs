//! The ruling on one sample: the value that the rules demand, the operations that decide it, and the value
//! that came back. It is made from the legal set and the effects of the notes alone, so it cannot contradict
//! the judge.

use crate::notes::{Note, Notes};
use crate::sample::Sample;
use crate::walk::Walk;
use crate::world::World;
use etalon_frame::{
    Allowed, Aspect, ChannelEncoding, CodeInterval, Codes, ContentSource, Contents, DecidingStep,
    Demand, Effect, Event, Frame, Initial, Rejection, Returned, Ruling, Step, TexelSet, Values,
};
use etalon_scene as scene;

/// The maximum number of outcomes, and of draws, that a ruling lists.
const LISTED: usize = 3;

/// An aspect of an attachment, as part of a legal set.
struct AspectView {
    attachment: usize,
    name: String,
    aspect: Aspect,
    encodings: Vec<ChannelEncoding>,
    /// The index of the aspect's first channel in the set.
    first: usize,
}

impl AspectView {
    fn of<'a, T>(&self, channels: &'a [T]) -> &'a [T] {
        &channels[self.first..self.first + self.encodings.len()]
    }

    /// Returns the view's contents, given all channels of the set.
    fn contents(&self, channels: &[CodeInterval]) -> Contents {
        self.holding(self.of(channels))
    }

    /// Returns these codes as contents of the view.
    fn holding(&self, codes: &[CodeInterval]) -> Contents {
        Contents {
            attachment: self.name.clone(),
            aspect: self.aspect,
            codes: Codes::of_channels(&self.encodings, codes.iter().copied()),
        }
    }
}

/// The sample of a ruling, with everything known about it.
struct RuledSample<'a> {
    walk: &'a Walk<'a>,
    notes: &'a [Note],
    set: &'a TexelSet,
    /// The initial contents, in the channels of the set.
    initial: Vec<CodeInterval>,
    views: Vec<AspectView>,
}

/// Returns the ruling on a sample. If a frame is given, the ruling also has the values that came back.
pub(crate) fn ruling(
    walk: &Walk<'_>,
    at: Sample,
    set: &TexelSet,
    initial: &World,
    notes: &[Note],
    frame: Option<&Frame>,
) -> Ruling {
    let first = walk.finish(std::slice::from_ref(initial), at, &mut Notes(None));
    let known = RuledSample {
        walk,
        notes,
        set,
        initial: first.worlds[0].channels.to_vec(),
        views: views(walk, at),
    };
    let actual = frame.and_then(|frame| known.actual(at, frame));
    Ruling {
        variant: None,
        texel: [at.x, at.y],
        samples: (at.samples > 1).then_some(at.sample).into_iter().collect(),
        demand: known.demand(actual.as_deref()),
        rules: walk.rules.text.to_string(),
        after: Vec::new(),
        band: None,
    }
}

fn views(walk: &Walk<'_>, at: Sample) -> Vec<AspectView> {
    let mut first = 0;
    let mut views = Vec::new();
    for index in walk.scene.read.iter().filter(|i| walk.has_shape(**i, at)) {
        let attachment = &walk.scene.attachments[*index];
        for aspect in attachment.format.aspects() {
            let encodings = walk.read_encoding(*index, *aspect).0.into_owned();
            let next = first + encodings.len();
            views.push(AspectView {
                attachment: *index,
                name: attachment.name.clone(),
                aspect: *aspect,
                encodings,
                first,
            });
            first = next;
        }
    }
    views
}

impl RuledSample<'_> {
    /// Returns the values that came back, in the channels of the set; `None` if the frame does not fit the
    /// scene.
    fn actual(&self, at: Sample, frame: &Frame) -> Option<Vec<i64>> {
        let mut orders = Vec::new();
        for view in &self.views {
            let image = frame.images.iter().find(|i| {
                i.attachment == view.name
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

    fn demand(&self, actual: Option<&[i64]>) -> Demand {
        let colors = self.views.iter().filter(|v| v.aspect == Aspect::Color);
        let several_colors = colors.count() > 1;
        let views: Vec<&AspectView> = self.views.iter().collect();
        if self.set.is_open() {
            return Demand::Open {
                returned: actual.map(|orders| returned(&views, orders)),
                several_colors,
            };
        }
        let wrong = actual.filter(|orders| !self.set.allows(orders));
        let focus = wrong.map_or_else(|| views.clone(), |orders| self.wrong_views(orders));
        let (allowed, more_outcomes) = self.allowed(&focus);
        let (reasons, more_draws) = self.reasons(focus[0]);
        Demand::Values(Box::new(Values {
            yardstick: self.walk.rules.is_yardstick(),
            allowed,
            more_outcomes,
            reasons,
            more_draws,
            returned: match (actual, wrong) {
                (_, Some(orders)) => {
                    let kept = match focus.as_slice() {
                        [view] => self.kept(view, orders),
                        _ => None,
                    };
                    Some(kept.unwrap_or_else(|| Returned::Wrote(returned(&focus, orders))))
                }
                (Some(orders), None) => Some(Returned::Allowed(returned(&focus, orders))),
                (None, None) => None,
            },
            several_colors,
            several_passes: self.walk.scene.passes.len() > 1,
        }))
    }

    /// Returns the views whose values differ from the nearest outcome. If each of these values is legal in
    /// some other outcome, returns all views: then only the combination is wrong.
    fn wrong_views(&self, orders: &[i64]) -> Vec<&AspectView> {
        let inside = |channels: &[CodeInterval], view: &AspectView| {
            let both = view.of(channels).iter().zip(view.of(orders));
            both.into_iter().all(|(c, o)| c.contains(*o))
        };
        let outside = |view: &&AspectView| {
            let nearest = self.set.nearest(orders);
            nearest.is_some_and(|w| !inside(&w.channels, view))
        };
        let wrong: Vec<&AspectView> = self.views.iter().filter(outside).collect();
        let legal = |view: &&AspectView| self.set.worlds.iter().any(|w| inside(&w.channels, view));
        if wrong.iter().all(legal) {
            self.views.iter().collect()
        } else {
            wrong
        }
    }

    /// Returns the allowed outcomes in some views, and the number of outcomes that are not listed.
    fn allowed(&self, focus: &[&AspectView]) -> (Vec<Vec<Allowed>>, usize) {
        let mut outcomes: Vec<Vec<&[CodeInterval]>> = Vec::new();
        for world in &self.set.worlds {
            let outcome: Vec<&[CodeInterval]> =
                focus.iter().map(|v| v.of(&world.channels)).collect();
            if !outcomes.contains(&outcome) {
                outcomes.push(outcome);
            }
        }
        let is_single = outcomes.len() == 1;
        let allowed = outcomes.iter().take(LISTED).map(|outcome| {
            let views = focus.iter().zip(outcome);
            views
                .map(|(view, codes)| {
                    let untouched = self.stores(view).next().is_none();
                    let kept = is_single
                        && *codes == view.of(&self.initial)
                        && (untouched || codes.iter().all(|v| v.is_exact()));
                    Allowed {
                        contents: view.holding(codes),
                        kept: kept.then(|| self.first_source(view)),
                    }
                })
                .collect()
        });
        (allowed.collect(), outcomes.len().saturating_sub(LISTED))
    }

    /// Returns earlier contents of a view that came back although later draws had to replace them.
    fn kept(&self, view: &AspectView, orders: &[i64]) -> Option<Returned> {
        if self.set.worlds.len() != 1 {
            return None;
        }
        let actual = view.of(orders);
        let came_back = |values: &[CodeInterval]| {
            let both = values.iter().zip(actual);
            both.into_iter().all(|(v, o)| v.contains(*o))
        };
        let stores: Vec<(&Note, Vec<CodeInterval>)> = self.stores(view).collect();
        let (_, before) = stores.split_last()?;
        let earlier = before.iter().rev().find(|(_, values)| came_back(values));
        if let Some((note, values)) = earlier {
            return Some(Returned::Kept {
                contents: view.holding(values),
                from: match note.event.origin.draw() {
                    Some((pass, draw)) => ContentSource::Draw { pass, draw },
                    None => ContentSource::Operation,
                },
            });
        }
        came_back(view.of(&self.initial)).then(|| Returned::Kept {
            contents: view.contents(&self.initial),
            from: ContentSource::Initial(self.first_source(view)),
        })
    }

    /// Returns the stores to a view in order, with the contents as they would be read back.
    fn stores(&self, view: &AspectView) -> impl Iterator<Item = (&Note, Vec<CodeInterval>)> {
        let (attachment, aspect, n) = (view.attachment, view.aspect, view.encodings.len());
        let name = view.name.clone();
        self.notes.iter().filter_map(move |note| {
            let (Effect::Stores(target), Some(cell)) = (&note.event.effect, &note.stored) else {
                return None;
            };
            let here = target.attachment == name && target.aspect == aspect;
            here.then(|| {
                let codes = match aspect {
                    Aspect::Color => cell.channels()[..n].to_vec(),
                    Aspect::Depth => vec![self.walk.read_depth(attachment, cell.channel(0))],
                    Aspect::Stencil => vec![CodeInterval::exact(i64::from(cell.stencil))],
                };
                (note, codes)
            })
        })
    }

    /// Returns the operations that decide a view: the last draw that stores, and the rejections of later
    /// draws; then the number of rejected draws that are not listed.
    fn reasons(&self, view: &AspectView) -> (Vec<DecidingStep>, usize) {
        let mut reasons = Vec::new();
        let mut since = None;
        if let Some((note, _)) = self.stores(view).last() {
            let event = &note.event;
            let Some(draw) = event.origin.draw() else {
                let reason = match event.step {
                    Step::Clear(_) => DecidingStep::Cleared(event.clone()),
                    _ => DecidingStep::Resolved(event.clone()),
                };
                return (vec![reason], 0);
            };
            since = Some(draw);
            let open = self.events().rev().find(|e| {
                matches!(e.effect, Effect::MayReject(_)) && e.origin.draw() == Some(draw)
            });
            reasons.push(match open {
                Some(open) if self.set.worlds.len() > 1 => DecidingStep::Open(open.clone()),
                _ => self.stored(event, view.aspect),
            });
        }
        let ends = self.ends(view, since);
        let more = ends.len().saturating_sub(LISTED);
        reasons.extend(ends.into_iter().take(LISTED));
        (reasons, more)
    }

    fn events(&self) -> impl DoubleEndedIterator<Item = &Event> {
        self.notes.iter().map(|note| &note.event)
    }

    /// Returns the reason for the contents that the last storing draw leaves.
    fn stored(&self, store: &Event, aspect: Aspect) -> DecidingStep {
        let of_fragment = || self.events().rev().filter(|e| e.origin == store.origin);
        let color = aspect == Aspect::Color;
        let shade = of_fragment().find(|e| color && matches!(e.step, Step::Shade { .. }));
        let mut steps = of_fragment().map(|e| &e.step);
        DecidingStep::Stored {
            store: store.clone(),
            shade: shade.cloned().map(Box::new),
            blended: steps.any(|s| matches!(s, Step::Blend(_) | Step::AdvancedBlend { .. })),
        }
    }

    /// Returns the rejections of all draws, or of the draws after `since`. A rejection is the last operation
    /// that a draw reaches.
    fn ends(&self, view: &AspectView, since: Option<(usize, usize)>) -> Vec<DecidingStep> {
        let mut draws: Vec<(usize, usize)> = Vec::new();
        let effective = self.events().filter(|e| !e.effect.is_none());
        for draw in effective.filter_map(|e| e.origin.draw()) {
            if since.is_none_or(|s| draw > s) && !draws.contains(&draw) {
                draws.push(draw);
            }
        }
        let ends: Vec<DecidingStep> = draws.iter().map(|draw| self.end(view, *draw)).collect();
        // Adjacent draws that miss the sample for the same reason share an entry.
        let together = ends.chunk_by(|a, b| elsewhere(a).is_some() && elsewhere(a) == elsewhere(b));
        together
            .map(|group| match &group[0] {
                DecidingStep::Ended { by, .. } => DecidingStep::Ended {
                    by: by.clone(),
                    draws: group.len(),
                },
                reason => reason.clone(),
            })
            .collect()
    }

    /// Returns the rejection of a draw that does not store to a view.
    fn end(&self, view: &AspectView, (pass, draw): (usize, usize)) -> DecidingStep {
        let events = || {
            let mine = |e: &&Event| e.origin.draw() == Some((pass, draw));
            self.events().filter(mine)
        };
        let mut keeps = events().filter(|e| match &e.effect {
            Effect::Keeps(target) => target.attachment == view.name && target.aspect == view.aspect,
            _ => false,
        });
        if let Some(kept) = keeps.next() {
            return DecidingStep::Kept(kept.clone());
        }
        let certain = events().filter_map(|e| match e.effect {
            Effect::Rejects(rejection) => Some((rejection, e)),
            _ => None,
        });
        let possible = events().filter_map(|e| match e.effect {
            Effect::MayReject(rejection) => Some((rejection, e)),
            _ => None,
        });
        let last = certain.max_by_key(|(rejection, _)| *rejection);
        match last.or_else(|| possible.max_by_key(|(rejection, _)| *rejection)) {
            Some((_, by)) => DecidingStep::Ended {
                by: by.clone(),
                draws: 1,
            },
            None => DecidingStep::Unwritten {
                pass,
                draw,
                aspect: view.aspect,
            },
        }
    }

    /// Returns the source of a view's initial contents.
    fn first_source(&self, view: &AspectView) -> Initial {
        match &self.walk.scene.attachments[view.attachment].contents {
            scene::AttachmentContents::Texels(_) => Initial::Upload,
            _ => Initial::Clear,
        }
    }
}

/// Returns the rejection that keeps a draw away from a sample; `None` for a draw that reaches it.
fn elsewhere(reason: &DecidingStep) -> Option<Rejection> {
    let DecidingStep::Ended { by, .. } = reason else {
        return None;
    };
    if matches!(by.step, Step::Coverage(coverage) if coverage.is_edge()) {
        return None;
    }
    by.effect.rejection().filter(|rejection| {
        matches!(
            rejection,
            Rejection::Coverage | Rejection::Viewport | Rejection::Scissor
        )
    })
}

/// Returns the values that came back, in some views.
fn returned(views: &[&AspectView], orders: &[i64]) -> Vec<Contents> {
    let exact: Vec<CodeInterval> = orders.iter().map(|o| CodeInterval::exact(*o)).collect();
    views.iter().map(|view| view.contents(&exact)).collect()
}
