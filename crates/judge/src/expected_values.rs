//! The literal values of a case, compared with the frame and the legal set.

use etalon_case::Case;
use etalon_frame::{Aspect, Band, ChannelMismatch, Frame, LegalSet, WrongTexel};
use etalon_record::{Reason, Record, Verdict};

/// Compares the case's literal values with the frame and the legal set. A literal outside the legal set is an
/// error of the reference; a legal frame that differs from the literal is imprecise.
pub(crate) fn expected_values(case: &Case, frame: &Frame, legal: &LegalSet, record: &mut Record) {
    for expect in &case.expect {
        let name = &case.scene.attachments[expect.attachment].name;
        let found = legal
            .images
            .iter()
            .position(|i| &i.attachment == name && i.aspect == Aspect::Color);
        let Some(index) = found else { continue };
        let info = &legal.images[index];
        let [x, y] = expect.texel;
        let set = legal.groups[info.group].sample(x, y, 0);
        let mut channels = Vec::new();
        for (c, value) in expect.value.iter().enumerate() {
            let encoding = info.channels[c];
            let expected = encoding.nearest_code(*value);
            let channel = info.first_channel + c;
            let legal_here = set
                .hull(channel)
                .is_none_or(|hull| hull.contains(encoding.order_of_code(expected)));
            if !legal_here {
                record.verdict = Verdict::InternalError;
                record.reasons = vec![Reason::IllegalLiteral {
                    value: *value,
                    channel: c as u8,
                    at: expect.texel,
                }];
                return;
            }
            let actual = frame.images[index].sample(x, y, 0)[c];
            if actual != expected {
                channels.push(ChannelMismatch {
                    attachment: name.clone(),
                    aspect: Aspect::Color,
                    channel: c as u8,
                    encoding,
                    low: expected,
                    high: expected,
                    actual,
                });
            }
        }
        if !channels.is_empty() {
            if record.verdict == Verdict::Pass {
                record.verdict = Verdict::Imprecise;
                record.texels.imprecise += 1;
            }
            record.reasons = vec![Reason::MissedLiteral(expect.texel)];
            record.wrong.push(WrongTexel {
                x,
                y,
                sample: 0,
                band: Band::Imprecise,
                channels,
            });
        }
    }
}
