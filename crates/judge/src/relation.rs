//! Comparison of frames, or of attachments of one frame, that a relation requires to be equal.

use etalon_case::{Case, Relation};
use etalon_frame::{Aspect, Band, ChannelMismatch, Frame, Image, LegalSet, Limits, WrongTexel};
use etalon_record::{ComparedPair, MAX_WRONG_TEXELS, Reason};
use etalon_reference::Rules;
use etalon_scene::Invariance;
use std::collections::HashMap;
use std::num::NonZeroU64;

/// The demand of a specification that pictures, or samples of one, are equal.
pub(crate) struct Equality {
    /// The name of what they have in common.
    pub(crate) name: &'static str,
    pub(crate) band: Band,
    pub(crate) citation: &'static str,
}

impl Equality {
    /// Returns the demand of a relation; `None` if it does not bind the API.
    pub(crate) fn of_relation(relation: &Relation, limits: &Limits) -> Option<Self> {
        let permission = Rules::invariance(limits, relation.invariance);
        Some(Self {
            name: relation.invariance.name(),
            band: permission.value()?,
            citation: permission.citation,
        })
    }

    /// Returns the demand that colours with the same operands are equal.
    pub(crate) fn of_operands(limits: &Limits) -> Self {
        let permission = Rules::equal_operands(limits);
        Self {
            name: "operands",
            band: permission.value(),
            citation: permission.citation,
        }
    }
}

/// The differences between compared frames.
#[derive(Clone, Debug, Default)]
pub(crate) struct Differences {
    /// Samples compared.
    pub(crate) compared: u64,
    /// Samples that differ.
    pub(crate) differing: u64,
    /// The frames or attachments between which the first difference was found.
    pub(crate) between: Option<ComparedPair>,
    /// The first differing samples, with one side as the legal value and the other as the actual one. Their
    /// band is Fail; the caller replaces it by the permission's.
    pub(crate) wrong: Vec<WrongTexel>,
    /// The two texels of the first difference.
    pub(crate) sides: Option<[Compared; 2]>,
}

/// One of two compared texels that must be equal.
#[derive(Clone, Debug)]
pub(crate) struct Compared {
    /// 0 for the case's own scene, otherwise the variant's index plus 1.
    pub(crate) scene: usize,
    /// The attachment, if attachments of one frame are compared.
    pub(crate) attachment: Option<String>,
    pub(crate) size: [u32; 2],
    pub(crate) samples: u32,
    pub(crate) at: [u32; 2],
    pub(crate) sample: u32,
}

/// Compares the colours of a frame's samples with the same number in their texels that come from the same operands.
pub(crate) fn check_operands(frame: &Frame, scene: usize, legal: &LegalSet) -> Differences {
    let mut found = Differences::default();
    for (number, group) in legal.groups.iter().enumerate() {
        let images = legal.images.iter().zip(&frame.images);
        let colors =
            images.filter(|(info, _)| info.group == number && info.aspect == Aspect::Color);
        let colors: Vec<&Image> = colors.map(|(_, image)| image).collect();
        let mut firsts: HashMap<(NonZeroU64, u32), [u32; 3]> = HashMap::new();
        let mut start = 0;
        for (end, set) in group.runs() {
            let indices = std::mem::replace(&mut start, end)..end;
            let Some(operands) = set.operands else {
                continue;
            };
            for place in indices.map(|index| group.position(index)) {
                let first = *firsts.entry((operands, place[2])).or_insert(place);
                for image in &colors {
                    let sides = [(*image, scene, first), (*image, scene, place)];
                    found.compare_samples(sides, 0b1111, &ComparedPair::Operands);
                }
            }
        }
    }
    found
}

/// Compares a case's frames as its relation demands.
pub(crate) fn check(relation: &Relation, case: &Case, frames: &[Frame]) -> Differences {
    let mut found = Differences::default();
    if relation.attachments.is_empty() {
        let Some((first, others)) = frames.split_first() else {
            return found;
        };
        for (i, (variant, frame)) in case.variants.iter().zip(others).enumerate() {
            let between = ComparedPair::Variant(variant.name.clone());
            for (expected, came) in first.images.iter().zip(&frame.images) {
                found.compare(
                    relation,
                    (expected, 0),
                    (came, i + 1),
                    relation.offset,
                    &between,
                );
            }
        }
        return found;
    }
    for (scene, frame) in frames.iter().enumerate() {
        let names: Vec<&str> = relation
            .attachments
            .iter()
            .map(|index| case.scene.attachments[*index].name.as_str())
            .collect();
        let images_of = |name: &str| -> Vec<&Image> {
            let images = frame.images.iter();
            images.filter(|image| image.attachment == name).collect()
        };
        let Some((first, others)) = names.split_first() else {
            continue;
        };
        for other in others {
            let between = ComparedPair::Attachments((*first).to_owned(), (*other).to_owned());
            for (expected, came) in images_of(first).into_iter().zip(images_of(other)) {
                found.compare(relation, (expected, scene), (came, scene), [0, 0], &between);
            }
        }
    }
    found
}

impl Differences {
    fn compare(
        &mut self,
        relation: &Relation,
        (expected, expected_scene): (&Image, usize),
        (came, came_scene): (&Image, usize),
        offset: [i32; 2],
        between: &ComparedPair,
    ) {
        let [left, top, width, height] =
            relation
                .within
                .unwrap_or([0, 0, expected.size[0], expected.size[1]]);
        let right = left.saturating_add(width).min(expected.size[0]);
        let bottom = top.saturating_add(height).min(expected.size[1]);
        for y in top..bottom {
            for x in left..right {
                let moved = [(x, offset[0]), (y, offset[1])].map(|(v, o)| v.checked_add_signed(o));
                let [Some(to_x), Some(to_y)] = moved else {
                    continue;
                };
                if to_x >= came.size[0] || to_y >= came.size[1] {
                    continue;
                }
                for sample in 0..expected.samples.min(came.samples) {
                    let sides = [
                        (expected, expected_scene, [x, y, sample]),
                        (came, came_scene, [to_x, to_y, sample]),
                    ];
                    self.compare_samples(sides, relation.channels, between);
                }
            }
        }
    }

    /// Compares two samples, each of the image of a scene, at a column, a row and a sample of the texel.
    fn compare_samples(
        &mut self,
        sides: [(&Image, usize, [u32; 3]); 2],
        mask: u8,
        between: &ComparedPair,
    ) {
        self.compared += 1;
        let pair = sides.map(|(image, _, [x, y, sample])| image.sample(x, y, sample));
        let (came, _, [x, y, sample]) = sides[1];
        let channels = differing(mask, came, pair);
        if channels.is_empty() {
            return;
        }
        self.differing += 1;
        if self.between.is_none() {
            self.between = Some(between.clone());
            self.sides = Some(sides.map(|(image, scene, [x, y, sample])| {
                Compared {
                    scene,
                    attachment: matches!(between, ComparedPair::Attachments(..))
                        .then(|| image.attachment.clone()),
                    size: image.size,
                    samples: image.samples,
                    at: [x, y],
                    sample,
                }
            }));
        }
        if self.wrong.len() < MAX_WRONG_TEXELS {
            self.wrong.push(WrongTexel {
                x,
                y,
                sample,
                band: Band::Fail,
                channels,
            });
        }
    }
}

/// Returns the message about a frame that differs from the judged one; `None` if the API permits that.
pub fn changed_picture(limits: &Limits) -> Option<Reason> {
    let promise = Rules::invariance(limits, Invariance::Repeat);
    let broken = promise.value();
    broken.map(|_| Reason::ChangedPicture(promise.citation.to_owned()))
}

/// Returns the channels in which two samples differ; zeros of either sign are equal.
fn differing(mask: u8, came: &Image, pair: [&[u32]; 2]) -> Vec<ChannelMismatch> {
    let mut result = Vec::new();
    for (c, encoding) in came.channels.iter().enumerate() {
        if came.aspect == Aspect::Color && mask & (1 << c) == 0 {
            continue;
        }
        let [expected, actual] = pair.map(|codes| codes[c]);
        if encoding.order_of_code(expected) != encoding.order_of_code(actual) {
            result.push(ChannelMismatch {
                attachment: came.attachment.clone(),
                aspect: came.aspect,
                channel: c as u8,
                encoding: *encoding,
                low: expected,
                high: expected,
                actual,
            });
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use crate::Judge;
    use etalon_backend::Backend;
    use etalon_case::{Case, Library, Profile};
    use etalon_cpu::CpuBackend;
    use etalon_frame::{Api, Aspect, Band, Frame, LegalSet, Limits};
    use etalon_record::{ComparedPair, Reason, Verdict};
    use etalon_reference::judgements;

    fn limits(api: Api) -> Limits {
        Limits {
            api,
            ..CpuBackend::new("cpu").limits().clone()
        }
    }

    fn drawn(case: &Case) -> Frame {
        let backend = CpuBackend::new("cpu");
        let mut prepared = backend.prepare(&case.scene).expect("it prepares");
        prepared.submit().expect("it draws");
        prepared.read_back().expect("it is read back")
    }

    /// Changes the colour of one of several samples with the same operands to another legal code; `None` if the set
    /// has no such samples.
    fn unequal(legal: &LegalSet, mut frame: Frame) -> Option<Frame> {
        let index = legal
            .images
            .iter()
            .position(|image| image.aspect == Aspect::Color)?;
        let image = &legal.images[index];
        let group = &legal.groups[image.group];
        let mut start = 0;
        for (end, set) in group.runs() {
            let place = std::mem::replace(&mut start, end);
            let [world] = &set.worlds[..] else { continue };
            let codes = world.channels[image.first_channel];
            if set.operands.is_none() || end - place < 2 || codes.low == codes.high {
                continue;
            }
            let encoding = image.channels[0];
            let code = &mut frame.images[index].codes[place * image.channels.len()];
            let held = encoding.order_of_code(*code);
            let other = if held == codes.low {
                codes.high
            } else {
                codes.low
            };
            *code = encoding.code_of_order(other);
            return Some(frame);
        }
        None
    }

    #[test]
    fn legal_colours_that_differ_for_equal_operands_are_a_fail() {
        let library = Library::built_in();
        let mut cases = library
            .cases(Profile::Quick)
            .filter(|case| case.id().starts_with("blend/"));
        let (case, frame) = cases
            .find_map(|listed| {
                let case = listed.build().ok()?;
                let judgement = judgements(&case.scene, &limits(Api::Vulkan))
                    .into_iter()
                    .next()?;
                let changed = unequal(&judgement.legal, drawn(&case))?;
                (case.variants.is_empty() && case.relation.is_none()).then_some((case, changed))
            })
            .expect("some blend has several samples with the same operands");
        for (api, verdict, band) in [
            (Api::Vulkan, Verdict::Fail, Band::Fail),
            (Api::OpenGl, Verdict::Fail, Band::Fail),
            (Api::OpenGlEs, Verdict::Fail, Band::Fail),
            (Api::WebGpu, Verdict::Imprecise, Band::Imprecise),
        ] {
            let frames = [frame.clone()];
            let record = Judge::default()
                .judge(0, &case, "test", &limits(api), &frames)
                .record;
            assert_eq!(record.verdict, verdict, "{api} {}", case.id);
            assert!(record.wrong.iter().any(|wrong| wrong.band == band));
            let differs = |reason: &Reason| {
                matches!(
                    reason,
                    Reason::Difference {
                        pair: ComparedPair::Operands,
                        ..
                    }
                )
            };
            assert!(record.reasons.iter().any(differs), "{:?}", record.reasons);
            let story = record.story.and_then(|story| story.ruling);
            assert_eq!(story.and_then(|ruling| ruling.band), Some(band));
            let judged = Judge::default().judge(0, &case, "test", &limits(api), &[drawn(&case)]);
            assert!(!judged.record.verdict.is_violation());
        }
    }
}
