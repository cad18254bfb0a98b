//! The requirements of each version of an API for every implementation: formats, limits and features, as rows
//! with their citations.
//!
//! Only requirements that a driver can deny are listed. A row for a requirement that a backend assumes from
//! the version could never fail.

use etalon_frame::{Api, ApiVersion, Feature, Limits, Requirement, TextureFormat};

/// Something that an API requires from a version on.
#[derive(Clone, Copy, Debug)]
pub struct Required {
    /// The API.
    pub api: Api,
    /// The first version that requires it, among those whose specification was read.
    pub since: ApiVersion,
    /// The requirement.
    pub requirement: Requirement,
    /// The section of the specification.
    pub citation: &'static str,
}

/// Returns the first of the requirements that the limits deny although the adapter's API and version require
/// it, and the row that does; `None` if the adapter is allowed to lack everything that it lacks.
pub fn denied(limits: &Limits, requirements: &[Requirement]) -> Option<(Requirement, Required)> {
    let is_exempt = |needed| limits.exempt.iter().any(|exempt| covers(*exempt, needed));
    let lacks =
        |needed: &&Requirement| limits.missing(&[**needed]).is_some() && !is_exempt(**needed);
    requirements
        .iter()
        .filter(lacks)
        .find_map(|needed| Some((*needed, row(limits, *needed)?)))
}

/// Returns the requirements that the limits deny, if the adapter lacks nothing else; empty if it lacks something
/// that it is allowed to lack, or nothing at all.
pub fn only_denied(limits: &Limits, requirements: &[Requirement]) -> Vec<(Requirement, Required)> {
    let lacking = requirements
        .iter()
        .filter(|needed| limits.missing(&[**needed]).is_some());
    let rows = lacking.map(|needed| denied(limits, &[*needed]));
    rows.collect::<Option<_>>().unwrap_or_default()
}

/// Returns the row that requires something of an adapter.
fn row(limits: &Limits, needed: Requirement) -> Option<Required> {
    let binds = |required: &Required| {
        required.api == limits.api
            && required.since <= limits.version
            && covers(required.requirement, needed)
    };
    rows().into_iter().find(binds)
}

/// Returns true if what is required includes what is needed.
fn covers(required: Requirement, needed: Requirement) -> bool {
    match (required, needed) {
        (Requirement::Size(most), Requirement::Size(size)) => size <= most,
        (Requirement::ColorAttachments(most), Requirement::ColorAttachments(n)) => n <= most,
        // A drawable format is also a texture format that can be cleared and read.
        (Requirement::Drawing(format), Requirement::Format(needed)) => format == needed,
        (required, needed) => required == needed,
    }
}

/// The 8-bit colour formats that every API draws to, blends and multisamples.
const BYTES: [TextureFormat; 4] = [
    TextureFormat::R8Unorm,
    TextureFormat::Rg8Unorm,
    TextureFormat::Rgba8Unorm,
    TextureFormat::Rgba8UnormSrgb,
];

const SHORT: [TextureFormat; 3] = [
    TextureFormat::B5g6r5Unorm,
    TextureFormat::Bgr5a1Unorm,
    TextureFormat::Bgra4Unorm,
];

const DEPTH: [TextureFormat; 5] = [
    TextureFormat::Depth16Unorm,
    TextureFormat::Depth24Plus,
    TextureFormat::Depth24PlusStencil8,
    TextureFormat::Depth32Float,
    TextureFormat::Depth32FloatStencil8,
];

/// Returns all rows.
pub fn rows() -> Vec<Required> {
    let mut rows = Vec::new();
    vulkan(&mut rows);
    opengl(&mut rows);
    opengl_es(&mut rows);
    webgpu(&mut rows);
    rows
}

/// Appends what an API requires from a version on, all from one section of its specification.
fn add<const N: usize>(
    rows: &mut Vec<Required>,
    (api, since): (Api, ApiVersion),
    citation: &'static str,
    requirements: [Requirement; N],
) {
    rows.extend(requirements.map(|requirement| Required {
        api,
        since,
        requirement,
        citation,
    }));
}

/// Appends Vulkan's rows. The tables have not changed since 1.0: 1.0 (2016-02-16), 1.3.302 and 1.4.303 were
/// compared.
fn vulkan(rows: &mut Vec<Required>) {
    use Requirement::{Blending, ColorAttachments, Drawing, Feature as Has, Format, Samples, Size};
    let since = (Api::Vulkan, ApiVersion::new(1, 0));
    let formats = "Vulkan: Required Format Support";
    // COLOR_ATTACHMENT and COLOR_ATTACHMENT_BLEND.
    let blended = [
        TextureFormat::Bgra8Unorm,
        TextureFormat::Rgb10a2Unorm,
        TextureFormat::B5g6r5Unorm,
        TextureFormat::Bgr5a1Unorm,
        TextureFormat::Rgba16Float,
    ];
    let drawn = [TextureFormat::Rgba8Uint, TextureFormat::Rgba32Float];
    // D24 or D32 for the first, D24S8 or D32S8 for the others.
    let depth = [
        TextureFormat::Depth16Unorm,
        TextureFormat::Depth24Plus,
        TextureFormat::Depth24PlusStencil8,
        TextureFormat::Stencil8,
    ];
    let fetched = [
        TextureFormat::Bgra4Unorm,
        TextureFormat::Rgba8Snorm,
        TextureFormat::Rg11b10Ufloat,
    ];
    add(rows, since, formats, BYTES.map(Drawing));
    add(rows, since, formats, BYTES.map(Blending));
    add(rows, since, formats, blended.map(Drawing));
    add(rows, since, formats, blended.map(Blending));
    add(rows, since, formats, drawn.map(Drawing));
    add(rows, since, formats, depth.map(Drawing));
    add(rows, since, formats, fetched.map(Format));
    let counts = "Vulkan: Required Limits, framebufferColorSampleCounts, framebufferDepthSampleCounts, framebufferStencilSampleCounts and the sampledImage counts beside them: 1 and 4";
    let four = |format| Samples(format, 4);
    add(rows, since, counts, BYTES.map(four));
    add(rows, since, counts, blended.map(four));
    add(rows, since, counts, depth.map(four));
    add(rows, since, counts, [four(TextureFormat::Rgba32Float)]);
    let limits =
        "Vulkan: Required Limits, maxImageDimension2D, maxFramebufferWidth, maxColorAttachments";
    add(rows, since, limits, [Size(4096), ColorAttachments(4)]);
    add(
        rows,
        (Api::Vulkan, ApiVersion::new(1, 2)),
        "Vulkan 1.2: VkPhysicalDeviceDepthStencilResolveProperties: both sets hold sample zero",
        [Has(Feature::DepthStencilResolve)],
    );
    add(
        rows,
        (Api::Vulkan, ApiVersion::new(1, 4)),
        "Vulkan 1.4: Feature Requirements",
        [
            Has(Feature::DepthBiasClamp),
            Has(Feature::DepthClamp),
            Has(Feature::IndependentBlend),
            Has(Feature::LinearInterpolation),
            Has(Feature::SampleInterpolation),
            Has(Feature::SampleShading),
            Has(Feature::StorageCounters),
        ],
    );
}

fn opengl(rows: &mut Vec<Required>) {
    use Requirement::{ColorAttachments, Drawing, Feature as Has, Samples, Size};
    let since = (Api::OpenGl, ApiVersion::new(3, 3));
    let formats = "OpenGL 3.3: 3.8.1, Required Texture Formats";
    let wide = [
        TextureFormat::Rgb10a2Unorm,
        TextureFormat::Rg11b10Ufloat,
        TextureFormat::Rgba8Uint,
        TextureFormat::Rgba16Float,
        TextureFormat::Rgba32Float,
    ];
    add(rows, since, formats, BYTES.map(Drawing));
    add(rows, since, formats, wide.map(Drawing));
    add(rows, since, formats, DEPTH.map(Drawing));
    let counts = "OpenGL 3.3: 4.4.2, Required Renderbuffer Formats, with up to MAX_SAMPLES samples, which is at least 4; integers have fewer";
    let four = |format| Samples(format, 4);
    let floats = [
        TextureFormat::Rgb10a2Unorm,
        TextureFormat::Rg11b10Ufloat,
        TextureFormat::Rgba16Float,
        TextureFormat::Rgba32Float,
    ];
    add(rows, since, counts, BYTES.map(four));
    add(rows, since, counts, floats.map(four));
    add(rows, since, counts, DEPTH.map(four));
    add(
        rows,
        since,
        "OpenGL 3.3: tables 6.38 and 6.48, MAX_TEXTURE_SIZE, MAX_RENDERBUFFER_SIZE, MAX_COLOR_ATTACHMENTS, MAX_DRAW_BUFFERS",
        [Size(1024), ColorAttachments(8)],
    );
    add(
        rows,
        since,
        "OpenGL 3.3: 4.1.7, MAX_DUAL_SOURCE_DRAW_BUFFERS is at least 1",
        [Has(Feature::DualSourceBlending)],
    );
    let since = (Api::OpenGl, ApiVersion::new(4, 5));
    let formats = "OpenGL 4.5: 8.5.1, tables 8.12 and 8.13";
    add(rows, since, formats, SHORT.map(Drawing));
    add(rows, since, formats, [Drawing(TextureFormat::Stencil8)]);
    add(
        rows,
        since,
        "OpenGL 4.5: table 23.54, MAX_TEXTURE_SIZE, MAX_RENDERBUFFER_SIZE",
        [Size(16384)],
    );
    add(
        rows,
        since,
        "OpenGL 4.5: chapter 23, MAX_FRAGMENT_SHADER_STORAGE_BLOCKS is at least 8",
        [Has(Feature::StorageCounters)],
    );
    add(
        rows,
        since,
        "OpenGL 4.5: 14.3.1.1 Sample Shading",
        [Has(Feature::MinSampleShading)],
    );
}

fn opengl_es(rows: &mut Vec<Required>) {
    use Requirement::{ColorAttachments, Drawing, Feature as Has, Samples, Size};
    let since = (Api::OpenGlEs, ApiVersion::new(3, 0));
    let formats =
        "OpenGL ES 3.0: 3.8.3.1, Required Texture Formats; 4.4.2.2, Required Renderbuffer Formats";
    // Stencil alone is required as a renderbuffer.
    let more = [
        TextureFormat::Rgb10a2Unorm,
        TextureFormat::Rgba8Uint,
        TextureFormat::Stencil8,
    ];
    add(rows, since, formats, BYTES.map(Drawing));
    add(rows, since, formats, SHORT.map(Drawing));
    add(rows, since, formats, more.map(Drawing));
    add(rows, since, formats, DEPTH.map(Drawing));
    let counts = "OpenGL ES 3.0: 4.4.2.2, Required Renderbuffer Formats, with up to MAX_SAMPLES samples, which is at least 4; integers have fewer";
    let four = |format| Samples(format, 4);
    let more = [TextureFormat::Rgb10a2Unorm, TextureFormat::Stencil8];
    add(rows, since, counts, BYTES.map(four));
    add(rows, since, counts, SHORT.map(four));
    add(rows, since, counts, more.map(four));
    add(rows, since, counts, DEPTH.map(four));
    add(
        rows,
        since,
        "OpenGL ES 3.0: table 6.28, MAX_TEXTURE_SIZE, MAX_RENDERBUFFER_SIZE, MAX_COLOR_ATTACHMENTS, MAX_DRAW_BUFFERS",
        [Size(2048), ColorAttachments(4)],
    );
    let since = (Api::OpenGlEs, ApiVersion::new(3, 2));
    let floats = [
        TextureFormat::Rg11b10Ufloat,
        TextureFormat::Rgba16Float,
        TextureFormat::Rgba32Float,
    ];
    add(
        rows,
        since,
        "OpenGL ES 3.2: 8.5.1, table 8.10",
        floats.map(Drawing),
    );
    add(
        rows,
        since,
        "OpenGL ES 3.2: chapter 21, MAX_FRAGMENT_SHADER_STORAGE_BLOCKS is at least 4",
        [Has(Feature::StorageCounters)],
    );
    add(
        rows,
        since,
        "OpenGL ES 3.2: 13.4.1 Sample Shading",
        [Has(Feature::MinSampleShading)],
    );
}

fn webgpu(rows: &mut Vec<Required>) {
    use Requirement::{Blending, Drawing, Feature as Has, Samples, Size};
    let since = (Api::WebGpu, ApiVersion::UNKNOWN);
    let formats = "WebGPU: Texture Format Capabilities";
    let blended = [
        TextureFormat::Bgra8Unorm,
        TextureFormat::Rgb10a2Unorm,
        TextureFormat::Rgba16Float,
    ];
    let drawn = [TextureFormat::Rgba8Uint, TextureFormat::Rgba32Float];
    let depth = [
        TextureFormat::Depth16Unorm,
        TextureFormat::Depth24Plus,
        TextureFormat::Depth24PlusStencil8,
        TextureFormat::Depth32Float,
        TextureFormat::Stencil8,
    ];
    let four = |format| Samples(format, 4);
    add(rows, since, formats, BYTES.map(Drawing));
    add(rows, since, formats, BYTES.map(Blending));
    add(rows, since, formats, BYTES.map(four));
    add(rows, since, formats, blended.map(Drawing));
    add(rows, since, formats, blended.map(Blending));
    add(rows, since, formats, blended.map(four));
    add(rows, since, formats, drawn.map(Drawing));
    add(rows, since, formats, depth.map(Drawing));
    add(rows, since, formats, depth.map(four));
    add(
        rows,
        since,
        "WebGPU: Limits, maxTextureDimension2D is at least 8192",
        [Size(8192)],
    );
    add(
        rows,
        since,
        "WebGPU: GPURenderPipelineDescriptor, which has it without a feature",
        [
            Has(Feature::CentroidInterpolation),
            Has(Feature::DepthBiasClamp),
            Has(Feature::IndependentBlend),
            Has(Feature::SampleInterpolation),
            Has(Feature::SampleShading),
            Has(Feature::StorageCounters),
        ],
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_limits::limits;

    fn limits_of(api: Api, major: u8, minor: u8) -> Limits {
        Limits {
            api,
            version: ApiVersion::new(major, minor),
            formats: Default::default(),
            features: Default::default(),
            paths: Default::default(),
            max_size: 1,
            ..limits(api)
        }
    }

    #[test]
    fn a_format_is_required_from_its_version_on() {
        let short = [Requirement::Drawing(TextureFormat::B5g6r5Unorm)];
        assert!(denied(&limits_of(Api::OpenGl, 3, 3), &short).is_none());
        let (needed, found) =
            denied(&limits_of(Api::OpenGl, 4, 6), &short).expect("4.6 requires it");
        assert_eq!(needed, short[0]);
        assert!(found.citation.starts_with("OpenGL 4.5:"));
        assert!(denied(&limits_of(Api::OpenGlEs, 3, 0), &short).is_some());
        let float = [Requirement::Drawing(TextureFormat::Rgba16Float)];
        assert!(denied(&limits_of(Api::OpenGlEs, 3, 1), &float).is_none());
        assert!(denied(&limits_of(Api::OpenGlEs, 3, 2), &float).is_some());
        assert!(denied(&limits_of(Api::OpenGl, 3, 3), &float).is_some());
    }

    #[test]
    fn a_limit_is_required_up_to_its_least_value() {
        let of_size = |size| [Requirement::Size(size)];
        let gl = limits_of(Api::OpenGl, 3, 3);
        assert!(denied(&gl, &of_size(1024)).is_some());
        assert!(denied(&gl, &of_size(1025)).is_none());
        assert!(denied(&limits_of(Api::WebGpu, 0, 0), &of_size(8192)).is_some());
    }

    #[test]
    fn a_feature_that_is_there_or_exempt_is_not_denied() {
        let needed = [Requirement::Drawing(TextureFormat::Rgba8Unorm)];
        assert!(denied(&limits(Api::Vulkan), &needed).is_none());
        let mut excused = limits_of(Api::Vulkan, 1, 3);
        assert!(denied(&excused, &needed).is_some());
        excused.exempt.insert(needed[0]);
        assert!(denied(&excused, &needed).is_none());
    }

    #[test]
    fn every_row_names_its_specification() {
        for row in rows() {
            let name = match row.api {
                Api::Vulkan => "Vulkan",
                Api::OpenGl => "OpenGL ",
                Api::OpenGlEs => "OpenGL ES ",
                Api::WebGpu => "WebGPU: ",
            };
            assert!(row.citation.starts_with(name), "{row:?}");
        }
    }
}
