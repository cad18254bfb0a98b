//! The limits of a program, from its description.

use crate::message::{Hello, ShaderLanguage};
use etalon_backend::codes::webgpu_layout;
use etalon_frame::{
    Feature, FormatSupport, Limits, ReadPath, Requirement, TextureFormat, standard_sample_positions,
};
use std::collections::{BTreeMap, BTreeSet};

/// The features that no message of the protocol expresses.
const NOT_EXPRESSED: [Feature; 23] = [
    Feature::BaseVertex,
    Feature::ClearCommands,
    // Backends change the shader for these two.
    Feature::CullDistances,
    Feature::StencilExport,
    Feature::DepthResolveAverage,
    Feature::DepthResolveMax,
    Feature::DepthResolveMin,
    Feature::DepthStencilResolve,
    Feature::FirstInstance,
    Feature::FragmentStorage,
    Feature::IndependentResolve,
    Feature::IndependentResolveNone,
    Feature::InheritedQueries,
    Feature::MaskedClears,
    Feature::OwnPassDepthReads,
    Feature::OwnPassReads,
    Feature::OwnPassReadsInOrder,
    Feature::OwnPassStencilReads,
    Feature::QueriesOverPasses,
    Feature::StencilResolveMax,
    Feature::StencilResolveMin,
    Feature::Tessellation,
    Feature::UpperLeftDomain,
];

/// The features whose shaders only WGSL expresses: the translation to other languages is wrong.
const ONLY_WGSL: [Feature; 3] = [
    Feature::SampleMaskInput,
    Feature::SampleMaskOutput,
    Feature::SampleMaskOutputWithAlphaToCoverage,
];

/// The largest size that a program can have: no case needs more.
const MAX_SIZE: u32 = 1 << 16;

/// Returns the limits of a program, or what is wrong with its description.
pub(crate) fn limits(hello: &Hello) -> Result<Limits, String> {
    if let Some(feature) = hello.features.iter().find(|f| NOT_EXPRESSED.contains(f)) {
        return Err(format!(
            "`features` has {feature}, which the protocol cannot express: remove it"
        ));
    }
    let translated = hello.shaders.iter().any(|s| *s != ShaderLanguage::Wgsl);
    let only_wgsl = hello.features.iter().find(|f| ONLY_WGSL.contains(f));
    if let Some(feature) = only_wgsl.filter(|_| translated) {
        return Err(format!(
            "`features` has {feature}, whose shaders are in WGSL only: remove it, or the other languages of `shaders`"
        ));
    }
    let mut formats = BTreeMap::new();
    let mut sample_positions = hello.sample_positions.clone();
    for (format, offer) in &hello.formats {
        if format.is_color() && webgpu_layout(*format).is_empty() {
            return Err(format!(
                "`formats` has {format}, which has no layout in WebGPU: remove it"
            ));
        }
        for count in offer.samples.iter().chain(&[1]) {
            sample_positions
                .entry(*count)
                .or_insert_with(|| standard_sample_positions(*count));
        }
        let support = FormatSupport {
            samples: offer.samples.clone(),
            blendable: offer.blendable && format.is_color(),
            // The program does not say how depths are stored.
            depth: format.depth_encodings().to_vec(),
            read: read_path(*format),
        };
        formats.insert(*format, support);
    }
    Ok(Limits {
        version: hello.version,
        sub_pixel_bits: hello.sub_pixel_bits,
        max_size: hello.max_size.min(MAX_SIZE),
        max_color_attachments: hello.max_color_attachments,
        formats,
        features: hello.features.clone(),
        exempt: exempt(),
        sample_positions,
        ..Limits::nothing(hello.rules.into())
    })
}

/// Returns how depths are read: as floats, which are exact only for formats of floats.
pub(crate) fn read_path(format: TextureFormat) -> ReadPath {
    use etalon_frame::ChannelEncoding::Float32;
    match format.depth_encodings() {
        [] | [Float32] => ReadPath::Copy,
        _ => ReadPath::Shader,
    }
}

/// Returns everything: a program may lack what its API requires of drivers.
fn exempt() -> BTreeSet<Requirement> {
    let formats = TextureFormat::ALL.into_iter().flat_map(|format| {
        let samples = [2, 4, 8, 16].map(|n| Requirement::Samples(format, n));
        let uses = [
            Requirement::Format(format),
            Requirement::Drawing(format),
            Requirement::Blending(format),
        ];
        uses.into_iter().chain(samples)
    });
    Feature::ALL
        .map(Requirement::Feature)
        .into_iter()
        .chain(formats)
        .chain([
            Requirement::Size(u32::MAX),
            Requirement::ColorAttachments(u32::MAX),
        ])
        .collect()
}
