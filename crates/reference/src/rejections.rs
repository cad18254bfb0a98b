//! Notes of rejections: the draws, primitives and fragments that change nothing at a sample. Primitives with
//! the same reason share a note: most of a mesh covers other texels.

use crate::clause::clause;
use crate::notes::{Note, Notes, Skipped};
use crate::walk::{FragmentPlace, Hit, Walk};
use etalon_frame::{Effect, Event, Origin, Rejection, Step};
use etalon_scene::Draw;

/// A draw with its pass index and its own index.
type Numbered<'a> = (usize, usize, &'a Draw);

impl Walk<'_> {
    /// Notes that the whole draw is rejected: by rasterizer discard, or otherwise by its scissor rectangle.
    pub(crate) fn note_draw(&self, notes: &mut Notes<'_>, draw: Numbered<'_>) {
        let (rejection, step) = if draw.2.rasterizer_discard {
            (Rejection::RasterizerDiscard, Step::RasterizerDiscard)
        } else {
            let rect = draw.2.scissor.unwrap_or_default();
            (Rejection::Scissor, Step::Scissor(rect))
        };
        self.note_primitives(notes, draw, Vec::new(), rejection, step);
    }

    /// Notes the skipped primitives by reason. Primitives missing from `skipped` do not reach the texel.
    pub(crate) fn note_skipped(&self, notes: &mut Notes<'_>, draw: Numbered<'_>, skipped: Skipped) {
        let Some(rejections) = skipped.0 else { return };
        let count = draw.2.primitives().len();
        let mut reasons = vec![Some(Rejection::Coverage); count];
        for (primitive, reason) in rejections {
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
            let skipped = |i: &u32| reasons[*i as usize] == Some(rejection);
            let primitives: Vec<u32> = (0..count as u32).filter(skipped).collect();
            if primitives.is_empty() {
                continue;
            }
            let viewport = (rejection == Rejection::Viewport).then(|| draw.2.viewport.area());
            let step = Step::Primitives { count, viewport };
            self.note_primitives(notes, draw, primitives, rejection, step);
        }
    }

    /// Notes that some primitives of a draw are rejected at a sample; an empty list means the whole draw.
    fn note_primitives(
        &self,
        notes: &mut Notes<'_>,
        (pass, index, draw): Numbered<'_>,
        primitives: Vec<u32>,
        rejection: Rejection,
        step: Step,
    ) {
        notes.push(|| Note {
            event: Event {
                scene: None,
                origin: Origin::Draw {
                    pass,
                    draw: index,
                    primitives,
                },
                step,
                effect: Effect::Rejects(rejection),
                citation: Some(clause(
                    rejection,
                    self.rules,
                    self.limits,
                    (&self.scene.passes[pass], draw.topology),
                )),
            },
            stored: None,
        });
    }

    /// Notes a primitive that the sides of the view volume, or otherwise its near and far planes, can clip.
    pub(crate) fn note_clipping(&self, notes: &mut Notes<'_>, place: &FragmentPlace<'_>, hit: Hit) {
        let rejection = match (hit.in_viewport, hit.in_depth) {
            (false, _) => Rejection::Viewport,
            (true, false) => Rejection::NearFar,
            (true, true) => Rejection::ClipDistance,
        };
        self.note_rejection(notes, place, rejection, false, || Step::Clipping);
    }
}
