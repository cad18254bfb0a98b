//! Comparison of frames, or of attachments of one frame, that a relation requires to be equal.

use etalon_case::{Case, Relation};
use etalon_frame::{Aspect, Band, ChannelMismatch, Frame, Image, Limits, WrongTexel};
use etalon_record::{ComparedPair, MAX_WRONG_TEXELS, Reason};
use etalon_reference::Rules;
use etalon_scene::Invariance;

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
                    self.compared += 1;
                    let pair = (
                        expected.sample(x, y, sample),
                        came.sample(to_x, to_y, sample),
                    );
                    let channels = differing(relation, came, pair);
                    if channels.is_empty() {
                        continue;
                    }
                    self.differing += 1;
                    if self.between.is_none() {
                        self.between = Some(between.clone());
                        let side = |image: &Image, scene, at| Compared {
                            scene,
                            attachment: (!relation.attachments.is_empty())
                                .then(|| image.attachment.clone()),
                            size: image.size,
                            samples: image.samples,
                            at,
                        };
                        self.sides = Some([
                            side(expected, expected_scene, [x, y]),
                            side(came, came_scene, [to_x, to_y]),
                        ]);
                    }
                    if self.wrong.len() < MAX_WRONG_TEXELS {
                        self.wrong.push(WrongTexel {
                            x: to_x,
                            y: to_y,
                            sample,
                            band: Band::Fail,
                            channels,
                        });
                    }
                }
            }
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
fn differing(relation: &Relation, came: &Image, pair: (&[u32], &[u32])) -> Vec<ChannelMismatch> {
    let mut result = Vec::new();
    for (c, encoding) in came.channels.iter().enumerate() {
        if came.aspect == Aspect::Color && relation.channels & (1 << c) == 0 {
            continue;
        }
        let (expected, actual) = (pair.0[c], pair.1[c]);
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
