//! Legal sets as an adapter reads them back. A picture is walked as if attachments were copied. If a shader
//! reads them instead, the set of the floats that it stores follows from the set of the codes, so adapters
//! that differ only in how they read share the walk.

use crate::judging::Judging;
use crate::range::Range;
use crate::rounding::all_codes;
use crate::rules::Rules;
use crate::undefined::Undefined;
use etalon_frame::{
    Aspect, ChannelEncoding, CodeInterval, ImageInfo, LegalSet, LegalSetBuilder, Limits, ReadPath,
    TexelSet, TextureFormat,
};
use etalon_pipeline::Arithmetic;
use etalon_scene::Scene;
use std::collections::HashMap;
use std::sync::Arc;

/// Returns how an adapter reads back attachments of a format.
pub(crate) fn read_path(limits: &Limits, format: TextureFormat) -> ReadPath {
    let support = limits.formats.get(&format);
    support.map_or(ReadPath::Copy, |support| support.read)
}

/// Returns the encoding in which an attachment stores its depth.
pub(crate) fn depth_encoding(scene: &Scene, limits: &Limits, attachment: usize) -> ChannelEncoding {
    let format = scene.attachments[attachment].format;
    let first = |encodings: &[ChannelEncoding]| encodings.first().copied();
    limits
        .formats
        .get(&format)
        .and_then(|support| first(&support.depth))
        .or_else(|| first(format.depth_encodings()))
        .unwrap_or(ChannelEncoding::Float32)
}

/// Returns the codes that reading a stored depth can give in another encoding than the stored one.
pub(crate) fn converted(
    rules: &Rules,
    stored: (ChannelEncoding, CodeInterval),
    read: ChannelEncoding,
) -> CodeInterval {
    let mut judging = Judging::new(rules);
    let value = judging.decode(stored.0, stored.1);
    judging.encode(read, Range::same(value.float))
}

/// Converts a set that was computed for copied attachments to what the adapter reads back.
pub(crate) fn as_read(
    set: Arc<LegalSet>,
    scene: &Scene,
    limits: &Limits,
    rules: &Rules,
) -> Arc<LegalSet> {
    let by_shader =
        |index: &usize| read_path(limits, scene.attachments[*index].format) == ReadPath::Shader;
    if !scene.read.iter().any(by_shader) {
        return set;
    }
    let undefined = Undefined::of(scene);
    let mut builder = LegalSetBuilder::default();
    let mut changes = Vec::new();
    let images = scene.read.iter().flat_map(|index| {
        let aspects = scene.attachments[*index].format.aspects().iter();
        aspects.map(move |aspect| (*index, *aspect))
    });
    for ((index, aspect), image) in images.zip(&set.images) {
        let mut read = image.read;
        let mut channels = image.channels.clone();
        if aspect != Aspect::Stencil && by_shader(&index) {
            read = ReadPath::Shader;
        }
        if aspect == Aspect::Depth && read == ReadPath::Shader {
            channels = vec![ChannelEncoding::Float32];
            changes.push(ShaderDepth {
                image,
                stored: depth_encoding(scene, limits, index),
                open: undefined.aspect(index, aspect),
            });
        }
        let (size, samples) = (image.size, image.samples);
        builder.image(&image.attachment, aspect, size, samples, &channels, read);
    }
    for (number, group) in set.groups.iter().enumerate() {
        let mut start = 0;
        // Most sets occur in many runs.
        let mut known: HashMap<*const TexelSet, u32> = HashMap::new();
        for (end, texel) in group.runs() {
            let read = *known.entry(texel).or_insert_with(|| {
                let mut read = texel.clone();
                for change in changes.iter().filter(|c| c.image.group == number) {
                    change.apply(rules, &mut read);
                }
                builder.set(number, read)
            });
            builder.samples(number, read, end - start);
            start = end;
        }
    }
    for counter in &set.counters {
        builder.counter(counter.clone());
    }
    Arc::new(builder.build())
}

/// A depth that a shader reads.
struct ShaderDepth<'s> {
    image: &'s ImageInfo,
    stored: ChannelEncoding,
    /// True if the depth's contents are undefined.
    open: bool,
}

impl ShaderDepth<'_> {
    fn apply(&self, rules: &Rules, set: &mut TexelSet) {
        for world in &mut set.worlds {
            let depth = &mut world.channels[self.image.first_channel];
            if self.open {
                *depth = all_codes(ChannelEncoding::Float32);
            } else if self.stored != ChannelEncoding::Float32 {
                *depth = converted(rules, (self.stored, *depth), ChannelEncoding::Float32);
            }
        }
    }
}
