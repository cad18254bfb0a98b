//! The frame file of a judged frame: its codes and the allowed ones.

use etalon_case::Case;
use etalon_frame::{Frame, LegalSet, SampleGroup};
use etalon_record::{FrameFile, FrameImage, Verdict};
use etalon_reference::Judgement;

/// Returns the frame file of a frame: for a failed frame with the legal set, otherwise with the yardstick.
pub(crate) fn frame_file(
    case: &Case,
    adapter: &str,
    frame: &Frame,
    judgement: &Judgement,
    verdict: Verdict,
) -> FrameFile {
    let shown = match verdict {
        verdict if verdict.is_violation() => &judgement.legal,
        _ => &judgement.yardstick,
    };
    let mut images = Vec::new();
    for (image, info) in frame.images.iter().zip(&shown.images) {
        let group = &shown.groups[info.group];
        let mut low = Vec::with_capacity(image.codes.len());
        let mut high = Vec::with_capacity(image.codes.len());
        let mut wrong = Vec::new();
        let mut orders = Vec::new();
        for y in 0..image.size[1] {
            for x in 0..image.size[0] {
                for sample in 0..image.samples {
                    let set = group.sample(x, y, sample);
                    for (c, encoding) in info.channels.iter().enumerate() {
                        let hull = set.hull(info.first_channel + c);
                        let (l, h) = hull.map_or_else(
                            || (encoding.min_order(), encoding.max_order()),
                            |hull| (hull.low, hull.high),
                        );
                        low.push(encoding.code_of_order(l));
                        high.push(encoding.code_of_order(h));
                    }
                    sample_orders(frame, shown, group, info.group, (x, y, sample), &mut orders);
                    let legal = judgement.legal.groups[info.group].sample(x, y, sample);
                    let tight = judgement.yardstick.groups[info.group].sample(x, y, sample);
                    wrong.push(if !legal.allows(&orders) {
                        FrameImage::FAIL
                    } else if !tight.allows(&orders) {
                        FrameImage::IMPRECISE
                    } else {
                        FrameImage::FINE
                    });
                }
            }
        }
        images.push(FrameImage {
            attachment: image.attachment.clone(),
            aspect: image.aspect,
            size: image.size,
            samples: image.samples,
            channels: image.channels.clone(),
            low,
            high,
            actual: image.codes.clone(),
            wrong,
        });
    }
    FrameFile {
        case: case.id.clone(),
        adapter: adapter.to_owned(),
        about: case.about.clone(),
        spec: case.spec.clone(),
        images,
    }
}

/// Returns the orders of one sample in all images of its group.
fn sample_orders(
    frame: &Frame,
    set: &LegalSet,
    group: &SampleGroup,
    index: usize,
    (x, y, sample): (u32, u32, u32),
    orders: &mut Vec<i64>,
) {
    orders.clear();
    orders.reserve(group.channels.len());
    for (image, info) in frame.images.iter().zip(&set.images) {
        if info.group == index {
            let codes = image.sample(x, y, sample);
            orders.extend(
                codes
                    .iter()
                    .zip(&info.channels)
                    .map(|(code, e)| e.order_of_code(*code)),
            );
        }
    }
}
