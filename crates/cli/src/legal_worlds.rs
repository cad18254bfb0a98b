//! Legal sets as JSON, for programs that compare frames by themselves.

use etalon_frame::ChannelEncoding::{Srgb8, Uint, Unorm};
use etalon_frame::{Aspect, ChannelEncoding, CodeInterval, LegalSet, SampleGroup, TexelSet};
use serde_json::{Value, json};

/// Returns the legal sets of one scene, by the readings that an API leaves open: a frame is legal if one of them allows
/// it. See the page of exported folders for the keys.
pub(crate) fn worlds<'a>(sets: impl Iterator<Item = &'a LegalSet>) -> Value {
    let reading = |set: &LegalSet| {
        let groups = set.groups.iter().enumerate();
        let groups: Vec<Value> = groups.map(|(n, group)| of_group(set, n, group)).collect();
        json!({ "groups": groups })
    };
    json!({ "readings": sets.map(reading).collect::<Vec<_>>() })
}

/// One channel of a group.
#[derive(Clone, Copy)]
struct Channel {
    aspect: Aspect,
    encoding: ChannelEncoding,
}

fn of_group(set: &LegalSet, number: usize, group: &SampleGroup) -> Value {
    let mut channels = Vec::new();
    let mut named = Vec::new();
    for image in set.images.iter().filter(|image| image.group == number) {
        for (channel, encoding) in image.channels.iter().enumerate() {
            channels.push(Channel {
                aspect: image.aspect,
                encoding: *encoding,
            });
            named.push(json!({
                "attachment": image.attachment,
                "aspect": image.aspect,
                "channel": channel,
                "encoding": encoding,
            }));
        }
    }
    let boxes = |set: &TexelSet| -> Vec<Vec<[Value; 2]>> {
        let bounds = |world: &etalon_frame::WorldBox| {
            let bounds = channels.iter().zip(&world.channels);
            bounds
                .map(|(channel, interval)| channel.bounds(*interval))
                .collect()
        };
        set.worlds.iter().map(bounds).collect()
    };
    let palette: Vec<&TexelSet> = group.distinct().into_iter().map(|(set, _)| set).collect();
    let place = |set: &TexelSet| palette.iter().position(|other| std::ptr::eq(*other, set));
    let runs: Vec<Value> = group
        .runs()
        .map(|(end, set)| json!([end, place(set)]))
        .collect();
    json!({
        "size": group.size,
        "samples": group.samples,
        "channels": named,
        "sets": palette.into_iter().map(boxes).collect::<Vec<_>>(),
        "runs": runs,
    })
}

impl Channel {
    /// Returns the bounds: codes where these are in the order of their values, otherwise values; `null` for no number.
    fn bounds(self, interval: CodeInterval) -> [Value; 2] {
        [interval.low, interval.high].map(|order| match (self.aspect, self.encoding) {
            (Aspect::Color | Aspect::Stencil, Unorm(_) | Uint(_) | Srgb8) => {
                json!(self.encoding.code_of_order(order))
            }
            // Files have depths as 32-bit floats.
            (Aspect::Depth, encoding) => json!(f64::from(encoding.value_of_order(order) as f32)),
            (_, encoding) => json!(encoding.value_of_order(order)),
        })
    }
}
