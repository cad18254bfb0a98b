//! Notes of what does not happen: the draws, primitives and fragments that change nothing at a sample.
//! Primitives are told by reason, not one by one: most of a mesh covers another texel.

use crate::clause::Rejection;
use crate::notes::{Effect, Note, Notes, Origin, Skipped};
use crate::walk::{Hit, Place, Walk};
use etalon_frame::StoryLine;
use etalon_scene::Draw;

/// A draw with the numbers of its pass and of itself.
type Numbered<'a> = (usize, usize, &'a Draw);

impl Walk<'_> {
    /// Notes an operation on a fragment that stores or rejects.
    pub(crate) fn note_effect(
        &self,
        notes: &mut Notes<'_>,
        place: Place<'_>,
        effect: Effect,
        operation: &str,
        [detail, citation]: [&dyn Fn() -> String; 2],
    ) {
        notes.push(|| Note {
            line: StoryLine {
                at: place.name(),
                operation: operation.to_owned(),
                detail: detail(),
                citation: Some(citation()),
            },
            origin: Some(Origin {
                pass: place.pass,
                draw: place.draw_index,
                primitives: vec![place.primitive_index as u32],
            }),
            effect,
        });
    }

    /// Notes that a fragment ends by an operation, or may end.
    pub(crate) fn note_rejection(
        &self,
        notes: &mut Notes<'_>,
        place: Place<'_>,
        rejection: Rejection,
        certain: bool,
        detail: &dyn Fn() -> String,
    ) {
        let effect = match certain {
            true => Effect::Rejects(rejection),
            false => Effect::MayReject(rejection),
        };
        let clause = || rejection.clause(self.rules, self.limits, place.draw.topology);
        self.note_effect(
            notes,
            place,
            effect,
            rejection.operation(),
            [detail, &clause],
        );
    }

    /// Notes that a draw ends as a whole: by rasterizer discard, or else by its scissor rectangle.
    pub(crate) fn note_draw(&self, notes: &mut Notes<'_>, draw: Numbered<'_>) {
        if draw.2.rasterizer_discard {
            let detail = || "primitives are discarded before rasterization".to_owned();
            self.note_primitives(
                notes,
                draw,
                Vec::new(),
                Rejection::RasterizerDiscard,
                detail,
            );
        } else {
            self.note_primitives(notes, draw, Vec::new(), Rejection::Scissor, || {
                let rect = draw.2.scissor.unwrap_or_default().map(|v| v.to_string());
                format!("outside its scissor rectangle [{}]", rect.join(","))
            });
        }
    }

    /// Notes the primitives that were skipped, by reason. Those that were never added do not reach the
    /// texel.
    pub(crate) fn note_skipped(&self, notes: &mut Notes<'_>, draw: Numbered<'_>, skipped: Skipped) {
        let Some(all) = skipped.0 else { return };
        let count = draw.2.primitives().len();
        let mut reasons = vec![Some(Rejection::Coverage); count];
        for (primitive, reason) in all {
            if let Some(slot) = reasons.get_mut(primitive as usize) {
                *slot = reason;
            }
        }
        for rejection in [
            Rejection::Coverage,
            Rejection::Viewport,
            Rejection::NearFar,
            Rejection::ClipDistance,
        ] {
            let of = |i: &u32| reasons[*i as usize] == Some(rejection);
            let which: Vec<u32> = (0..count as u32).filter(of).collect();
            if which.is_empty() {
                continue;
            }
            let who = match (which.len(), count) {
                (1, 1) => "the primitive".to_owned(),
                (1, _) => format!("primitive {}", which[0]),
                (2, 2) => "both primitives".to_owned(),
                (n, all) if n == all => format!("all {n} primitives"),
                _ => format!("primitives {}", ranges(&which)),
            };
            let [lie, cover] = match which.len() {
                1 => ["lies", "does not cover"],
                _ => ["lie", "do not cover"],
            };
            let detail = match rejection {
                Rejection::Viewport => {
                    let rect = draw.2.viewport.area().map(|v| v.to_string());
                    let rect = rect.join(",");
                    match which.len() == count {
                        true => format!("outside its viewport [{rect}]"),
                        false => format!("outside its viewport [{rect}] with {who}"),
                    }
                }
                Rejection::NearFar => format!("{who} {lie} beyond the near or far plane"),
                Rejection::ClipDistance => format!("{who} {lie} behind a clip distance"),
                _ => format!("{who} {cover} the sample"),
            };
            self.note_primitives(notes, draw, which, rejection, || detail);
        }
    }

    /// Notes that a whole draw, or some of its primitives, ends at a sample. No primitives stand for the
    /// draw.
    fn note_primitives(
        &self,
        notes: &mut Notes<'_>,
        (pass, index, draw): Numbered<'_>,
        primitives: Vec<u32>,
        rejection: Rejection,
        detail: impl FnOnce() -> String,
    ) {
        notes.push(|| Note {
            line: StoryLine {
                at: format!("pass {pass}, draw {index}"),
                operation: rejection.operation().to_owned(),
                detail: detail(),
                citation: Some(rejection.clause(self.rules, self.limits, draw.topology)),
            },
            origin: Some(Origin {
                pass,
                draw: index,
                primitives,
            }),
            effect: Effect::Rejects(rejection),
        });
    }

    /// Notes a primitive that the sides of the view volume, or else its near and far planes, may clip.
    pub(crate) fn note_clipping(&self, notes: &mut Notes<'_>, place: Place<'_>, hit: Hit) {
        let (rejection, plane) = match (hit.in_viewport, hit.in_depth) {
            (false, _) => (Rejection::Viewport, "an edge of the viewport"),
            (true, false) => (Rejection::NearFar, "the near or far plane"),
            (true, true) => (Rejection::ClipDistance, "where a clip distance is 0"),
        };
        self.note_rejection(notes, place, rejection, false, &|| {
            format!("too near {plane} to tell: two worlds, clipped away at the sample or not")
        });
    }
}

/// Returns increasing numbers as ranges: `0 to 4, 6 and 9`. Many ranges are cut short.
fn ranges(numbers: &[u32]) -> String {
    const SHOWN: usize = 6;
    let mut all: Vec<(u32, u32)> = Vec::new();
    for n in numbers {
        match all.last_mut() {
            Some((_, last)) if *last + 1 == *n => *last = *n,
            _ => all.push((*n, *n)),
        }
    }
    let rest: u32 = all.iter().skip(SHOWN).map(|(a, b)| b - a + 1).sum();
    let mut texts: Vec<String> = all
        .iter()
        .take(SHOWN)
        .map(|(a, b)| match b - a {
            0 => a.to_string(),
            1 => format!("{a}, {b}"),
            _ => format!("{a} to {b}"),
        })
        .collect();
    if rest > 0 {
        texts.push(format!("{rest} more"));
    }
    match texts.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, before)) => format!("{} and {last}", before.join(", ")),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::ranges;

    #[test]
    fn many_primitives_are_told_in_few_words() {
        assert_eq!(ranges(&[3]), "3");
        assert_eq!(ranges(&[0, 1, 2, 4, 5, 9]), "0 to 2, 4, 5 and 9");
        let thousand: Vec<u32> = (0..1000).filter(|n| *n != 7).collect();
        assert_eq!(ranges(&thousand), "0 to 6 and 8 to 999");
        let even: Vec<u32> = (0..1000).step_by(2).collect();
        assert_eq!(ranges(&even), "0, 2, 4, 6, 8, 10 and 494 more");
    }
}
