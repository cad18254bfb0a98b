//! Coverage of a sample by primitives, world by world.

use crate::line_shape::shape_holds;
use crate::notes::Notes;
use crate::primitive::{CoverTimes, EdgeSide, Shape, Triangle, inside_of, is_outside};
use crate::rules::SharedEdge;
use crate::snap::{SnapBox, SubTexels};
use crate::walk::{Forced, FragmentPlace, Walk};
use crate::world::{Decision, World, Worlds};
use etalon_frame::{Coverage, Effect, Rejection, Step};
use etalon_pipeline::{front_facing, is_top_left};
use etalon_scene::Draw;
use smallvec::SmallVec;

impl Walk<'_> {
    /// Carries worlds through one primitive.
    pub(crate) fn primitive(
        &self,
        place: &FragmentPlace<'_>,
        worlds: &[World],
        notes: &mut Notes<'_>,
    ) -> Worlds {
        let mut result = SmallVec::new();
        let count = worlds.len();
        let several = count > 1;
        for (w, world) in worlds.iter().enumerate() {
            let numbered = FragmentPlace {
                world: (w + 1, count),
                ..*place
            };
            let place = if several { &numbered } else { place };
            if several {
                self.note_world(notes, place, world);
            }
            match &place.primitive.shape {
                Shape::Triangle(triangle) => {
                    self.triangle(place, triangle, world, &mut result, notes);
                }
                Shape::Outline(triangle) => {
                    let (least, most) = triangle.area;
                    for (possible, positive) in [(most > 0, true), (least < 0, false)] {
                        if possible {
                            self.repeat(place, world, positive, &mut result, notes);
                        }
                    }
                    // A primitive without an area faces back, and its edges may be missing.
                    if least <= 0 && most >= 0 {
                        let back = !self.draw_front(place.draw);
                        self.repeat(place, world, back, &mut result, notes);
                        result.push(world.clone());
                    }
                }
                Shape::Line(_) | Shape::Point { .. } => {
                    let front = self.draw_front(place.draw);
                    self.repeat(place, world, front, &mut result, notes);
                    if !self.rules.points_face_front.value() {
                        self.repeat(place, world, !front, &mut result, notes);
                    }
                }
            }
        }
        result
    }

    /// Returns true if a positive area faces front.
    fn draw_front(&self, draw: &Draw) -> bool {
        front_facing(1, draw.front_face)
    }

    /// Returns how often a point, a line or an outline can cover a sample under the rules for lines.
    pub(crate) fn times(&self, place: &FragmentPlace<'_>) -> CoverTimes {
        let sample = SnapBox::of_sample(place.point, self.anywhere(place.at.samples));
        let (least, most) = place.primitive.times(place.point, sample, self.units);
        let is_line = matches!(place.primitive.shape, Shape::Line(_) | Shape::Outline(_));
        let forced = Forced {
            at: place.at,
            draw: place.draw_id,
            primitive: place.primitive.index,
        };
        if is_line && self.forced.get() == Some(forced) {
            return (least.max(1), most.max(1));
        }
        if let Shape::Line(ends) = &place.primitive.shape
            && most > 0
            && self.rules.lines_cover_their_shape.value()
            && self.is_whole(place)
        {
            let grid = SubTexels {
                units: self.units,
                bits: &self.rules.sub_pixel_bits,
            };
            let (is_inside, can_be_inside) =
                shape_holds(*ends, place.point, self.units, grid.step() as f64);
            return (
                if is_inside { 1 } else { least },
                if can_be_inside { most } else { least },
            );
        }
        if least > 0 && is_line && !self.rules.lines_cover_texels.value() {
            (0, most)
        } else {
            (least, most)
        }
    }

    /// Repeats the fragment of a point, line or outline at the sample as often as the primitive can cover it.
    fn repeat(
        &self,
        place: &FragmentPlace<'_>,
        world: &World,
        positive_area: bool,
        result: &mut Worlds,
        notes: &mut Notes<'_>,
    ) {
        let (least, most) = self.times(place);
        if most == 0 || least < most {
            self.note_rejection(notes, place, Rejection::Coverage, most == 0, || {
                Step::Coverage(match most {
                    0 => Coverage::Outside,
                    _ => Coverage::Times { least, most },
                })
            });
        }
        let mut worlds: Worlds = SmallVec::new();
        worlds.push(world.clone());
        for time in 0..=most {
            if time == most {
                result.append(&mut worlds);
                break;
            }
            if time >= least {
                result.extend(worlds.iter().cloned());
            }
            let mut next = SmallVec::new();
            for world in &worlds {
                self.fragment(place, world, positive_area, &mut next, notes);
            }
            worlds = next;
        }
    }

    fn triangle(
        &self,
        place: &FragmentPlace<'_>,
        triangle: &Triangle,
        world: &World,
        result: &mut Worlds,
        notes: &mut Notes<'_>,
    ) {
        let (least, most) = triangle.area;
        if least > 0 || most < 0 {
            self.covered(place, triangle, world, least > 0, result, notes);
            return;
        }
        for (possible, positive) in [(most > 0, true), (least < 0, false)] {
            if possible {
                self.covered(place, triangle, world, positive, result, notes);
            }
        }
        // Legal snapping can flatten the triangle, which then covers nothing.
        let certain = least == 0 && most == 0;
        self.note_rejection(notes, place, Rejection::Coverage, certain, || {
            Step::Coverage(if certain {
                Coverage::NoArea
            } else {
                Coverage::PerhapsNoArea
            })
        });
        result.push(world.clone());
    }

    /// Splits a world by the edges that may or may not include the sample.
    fn covered(
        &self,
        place: &FragmentPlace<'_>,
        primitive: &Triangle,
        world: &World,
        positive_area: bool,
        result: &mut Worlds,
        notes: &mut Notes<'_>,
    ) {
        let inside = inside_of(positive_area);
        let sides = place.sides;
        if sides == [inside; 3] {
            self.fragment(place, world, positive_area, result, notes);
            return;
        }
        let mut pending: Worlds = SmallVec::new();
        pending.push(world.clone());
        if sides
            .into_iter()
            .any(|side| is_outside(side, positive_area))
        {
            let (least, most) = primitive.area;
            let certain = least > 0 || most < 0;
            self.note_rejection(notes, place, Rejection::Coverage, certain, || {
                Step::Coverage(if certain {
                    Coverage::Outside
                } else {
                    Coverage::OutsideOneWay
                })
            });
            result.append(&mut pending);
            return;
        }
        for (i, side) in sides.into_iter().enumerate() {
            if side == inside {
                continue;
            }
            if side == EdgeSide::On && self.rules.shared_edge.value() == SharedEdge::TopLeft {
                let inner = primitive.edge(i).is_some_and(|(p, q)| {
                    let (p, q) = if positive_area { (q, p) } else { (p, q) };
                    is_top_left(p, q)
                });
                if !inner {
                    self.note_rejection(notes, place, Rejection::Coverage, true, || {
                        Step::Coverage(Coverage::NotTopLeft { edge: i })
                    });
                    result.append(&mut pending);
                    return;
                }
                continue;
            }
            let (a, b) = (primitive.ids[i], primitive.ids[(i + 1) % 3]);
            let decision = Decision::Edge {
                draw: place.draw_id,
                ends: (a.min(b), a.max(b)),
                owner: (self.rules.shared_edge.value() == SharedEdge::Independent
                    || primitive.edge(i).is_none())
                .then_some(place.primitive_index as u32),
            };
            // The side is relative to the edge's canonical direction.
            let wanted = (inside == EdgeSide::Positive) == (a < b);
            let mut inside_worlds = SmallVec::new();
            let edge = SampleEdge { number: i, side };
            for world in pending {
                match world.decided(decision) {
                    Some(outcome) if outcome == wanted => {
                        self.note_edge(notes, place, edge, Some(true));
                        inside_worlds.push(world);
                    }
                    Some(_) => {
                        self.note_edge(notes, place, edge, Some(false));
                        result.push(world);
                    }
                    None => {
                        self.note_edge(notes, place, edge, None);
                        result.push(world.with(decision, !wanted));
                        inside_worlds.push(world.with(decision, wanted));
                    }
                }
            }
            pending = inside_worlds;
        }
        for world in &pending {
            self.fragment(place, world, positive_area, result, notes);
        }
    }

    /// Notes the state of the world that a primitive is drawn in, if there are several worlds.
    fn note_world(&self, notes: &mut Notes<'_>, place: &FragmentPlace<'_>, world: &World) {
        let pass = &self.scene.passes[place.pass];
        let targets = pass.color.iter().chain(&pass.depth_stencil);
        let contents = |i: &usize| self.all_contents(*i, &world.cells[*i]);
        notes.add(
            || place.origin(),
            || Step::World(targets.flat_map(contents).collect()),
            None,
        );
    }

    /// Notes the outcome at an edge that passes so close to the sample that it may include or exclude it. An
    /// earlier primitive with the same edge decides it, or it is open.
    fn note_edge(
        &self,
        notes: &mut Notes<'_>,
        place: &FragmentPlace<'_>,
        edge: SampleEdge,
        covers: Option<bool>,
    ) {
        let effect = match covers {
            Some(true) => Effect::None,
            Some(false) => Effect::Rejects(Rejection::Coverage),
            None => Effect::MayReject(Rejection::Coverage),
        };
        let citation = match edge.side {
            EdgeSide::On => self.rules.shared_edge.citation,
            _ => self.rules.snap.citation,
        };
        self.note_effect(notes, place, citation, None, || {
            let step = Step::Coverage(Coverage::Edge {
                edge: edge.number,
                exact: edge.side == EdgeSide::On,
                covers,
            });
            (effect, step)
        });
    }
}

/// An edge of a triangle, and the side of it that the sample is on.
#[derive(Clone, Copy)]
struct SampleEdge {
    number: usize,
    side: EdgeSide,
}
