//! The limits of a program, from its description.

use crate::message::{FormatOffer, Hello, PROTOCOL};
use crate::shaders::ShaderLanguage;
use etalon_backend::open_limits::exempt;
use etalon_backend::texels::{has_form, read_path};
use etalon_frame::{
    AdapterInfo, Feature, FormatSupport, Limits, Requirement, standard_sample_positions,
};
use etalon_scene::Scene;
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

/// Returns the limits of a program.
///
/// # Errors
/// If the protocol cannot express what it describes.
pub fn limits(hello: &Hello) -> Result<Limits, String> {
    if let Some(feature) = hello.features.iter().find(|f| !is_expressed(f)) {
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
        if !has_form(*format) {
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

/// Returns the description of an adapter, without the features that the protocol cannot express.
pub fn description(info: &AdapterInfo, limits: &Limits) -> Hello {
    let formats = limits
        .formats
        .iter()
        .filter(|(format, _)| has_form(**format));
    let offer = |support: &FormatSupport| FormatOffer {
        samples: support.samples.clone(),
        blendable: support.blendable,
    };
    Hello {
        protocol: PROTOCOL,
        device: info.device.clone(),
        driver: info.driver.clone(),
        driver_version: info.driver_version.clone(),
        software: info.software,
        rules: limits.api.into(),
        version: limits.version,
        sub_pixel_bits: limits.sub_pixel_bits,
        max_size: limits.max_size,
        max_color_attachments: limits.max_color_attachments,
        formats: formats
            .map(|(format, support)| (*format, offer(support)))
            .collect(),
        features: limits
            .features
            .iter()
            .copied()
            .filter(is_expressed)
            .collect(),
        sample_positions: limits.sample_positions.clone(),
        shaders: [ShaderLanguage::Wgsl].into(),
    }
}

/// Returns true if the protocol expresses a feature.
fn is_expressed(feature: &Feature) -> bool {
    !NOT_EXPRESSED.contains(feature)
}

/// Returns the first requirement of a scene that the protocol cannot express.
pub fn not_expressed(scene: &Scene) -> Option<Requirement> {
    let requirements = scene.requirements().into_iter();
    let mut others = requirements.filter(|requirement| match requirement {
        Requirement::Feature(feature) => !is_expressed(feature),
        Requirement::Format(format) => !has_form(*format),
        _ => false,
    });
    others.next()
}

/// Returns the languages in which a scene's shaders mean the same.
pub fn languages(scene: &Scene) -> BTreeSet<ShaderLanguage> {
    use ShaderLanguage::{Glsl, Spirv, Wgsl};
    if features(scene).any(|feature| ONLY_WGSL.contains(&feature)) {
        [Wgsl].into()
    } else {
        [Wgsl, Spirv, Glsl].into()
    }
}

fn features(scene: &Scene) -> impl Iterator<Item = Feature> {
    let requirements = scene.requirements().into_iter();
    requirements.filter_map(|requirement| match requirement {
        Requirement::Feature(feature) => Some(feature),
        _ => None,
    })
}
