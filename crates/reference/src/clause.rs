//! The clauses that reject a draw, a primitive or a fragment at a sample, by API and version. They permit
//! nothing and only stories need them, so they are not in [`rules`](crate::rules).

use crate::rules::Rules;
use etalon_frame::{Api, ApiVersion, Limits, Rejection};
use etalon_scene::{Pass, PrimitiveTopology};

/// Returns the clause of a rejection, with document, version and section.
pub(crate) fn clause(
    rejection: Rejection,
    rules: &Rules,
    limits: &Limits,
    (pass, topology): (&Pass, PrimitiveTopology),
) -> String {
    match rejection {
        Rejection::AlphaToCoverage => return rules.alpha_to_coverage_in(pass).citation.to_owned(),
        Rejection::SampleCoverage => return rules.sample_coverage.citation.to_owned(),
        Rejection::Stencil => return rules.stencil.to_owned(),
        _ => {}
    }
    match limits.api {
        Api::Vulkan => format!("Vulkan: {}", vulkan(rejection, topology)),
        Api::WebGpu => format!("WebGPU: {}", webgpu(rejection, topology)),
        Api::OpenGl => {
            let (name, edition) = Edition::of_opengl(limits.version);
            opengl(rejection, name, edition, topology)
        }
        Api::OpenGlEs => {
            let (name, edition) = Edition::of_opengl_es(limits.version);
            opengl(rejection, name, edition, topology)
        }
    }
}

fn vulkan(rejection: Rejection, topology: PrimitiveTopology) -> &'static str {
    match rejection {
        Rejection::RasterizerDiscard => {
            "Rasterization: with rasterizerDiscardEnable, primitives are discarded immediately \
                 before rasterization"
        }
        Rejection::Coverage => match topology {
            PrimitiveTopology::PointList => {
                "Basic Point Rasterization: a fragment for each texel whose centre lies inside the \
                     point's square"
            }
            PrimitiveTopology::LineList | PrimitiveTopology::LineStrip => {
                "Basic Line Segment Rasterization"
            }
            _ => {
                "Basic Polygon Rasterization: a sample outside of the polygon's projection is not \
                     covered"
            }
        },
        Rejection::Viewport => {
            "Primitive Clipping: primitives are clipped to the view volume, whose sides map to the \
                 viewport's"
        }
        Rejection::NearFar => {
            "Primitive Clipping: primitives are clipped to the view volume, 0 to 1 in depth"
        }
        Rejection::ClipDistance => {
            "Primitive Clipping: clip half-space i holds the points whose distance is 0 or more"
        }
        Rejection::CullDistance => {
            "Primitive Clipping: a primitive with a cull distance that is negative at all of its vertices is discarded"
        }
        Rejection::Culling => "Basic Polygon Rasterization: culled by facing and cullMode",
        Rejection::Scissor => {
            "Scissor Test: coverage of samples outside of the rectangle is set to 0"
        }
        Rejection::SampleMask => "Sample Mask Test: coverage is ANDed with the sample mask",
        Rejection::ShaderMask => "Multisample Coverage: coverage is ANDed with SampleMask",
        Rejection::Discard => {
            "Shader Termination and Demotion: a terminated or demoted fragment leaves no coverage"
        }
        Rejection::DepthBounds => {
            "Depth Bounds Test: a stored depth outside of the bounds sets coverage to 0"
        }
        _ => "Depth Test: a comparison that is false sets the sample's coverage to 0",
    }
}

fn webgpu(rejection: Rejection, topology: PrimitiveTopology) -> &'static str {
    match rejection {
        Rejection::RasterizerDiscard => "Rasterization",
        Rejection::Coverage => match topology {
            PrimitiveTopology::PointList => "Point Rasterization",
            PrimitiveTopology::LineList | PrimitiveTopology::LineStrip => "Line Rasterization",
            _ => "Polygon Rasterization: a point outside of the polygon gives no fragment",
        },
        Rejection::Viewport => "Primitive Clipping: -w to w in x and y, the viewport's sides",
        Rejection::NearFar => "Primitive Clipping: depth is clipped to 0 to w",
        Rejection::ClipDistance => {
            "Primitive Clipping: what has an interpolated distance below 0 is clipped"
        }
        Rejection::CullDistance => "no cull distances",
        Rejection::Culling => "Polygon Rasterization: culled by facing and cullMode",
        Rejection::Scissor => {
            "setScissorRect, Rasterization: fragments outside of the rectangle are discarded"
        }
        Rejection::SampleMask | Rejection::ShaderMask => {
            "Sample Masking: a sample whose bit is 0 is neither tested nor written"
        }
        Rejection::Discard => "Fragment Processing; WGSL: Discard Statement",
        Rejection::DepthBounds => "no depth bounds test",
        _ => "Fragment Processing: depthCompare that is false discards the fragment",
    }
}

fn opengl(
    rejection: Rejection,
    name: &str,
    edition: Edition,
    topology: PrimitiveTopology,
) -> String {
    use Edition::{Es30, Es31, Es32, Gl33, Gl45, Gl46};
    if rejection == Rejection::Discard {
        let language = match edition {
            Gl33 => "GLSL 3.30",
            Gl45 => "GLSL 4.50",
            Gl46 => "GLSL 4.60",
            Es30 => "GLSL ES 3.00",
            Es31 => "GLSL ES 3.10",
            Es32 => "GLSL ES 3.20",
        };
        return format!("{language}: 6.4 Jumps: discard abandons the fragment");
    }
    if rejection == Rejection::DepthBounds {
        return "GL_EXT_depth_bounds_test: a stored depth outside of the bounds discards the fragment"
                .to_owned();
    }
    if rejection == Rejection::ShaderMask {
        return match edition {
                Gl33 => "GL_ARB_sample_shading: gl_SampleMask: bits that are 0 leave samples uncovered",
                Gl45 => "OpenGL 4.5: 15.2.3 Shader Outputs: gl_SampleMask: bits that are 0 leave samples uncovered",
                Gl46 => "OpenGL 4.6: 15.2.3 Shader Outputs: gl_SampleMask: bits that are 0 leave samples uncovered",
                Es30 | Es31 => "GL_OES_sample_variables: gl_SampleMask: bits that are 0 leave samples uncovered",
                Es32 => "OpenGL ES 3.2: 14.2.3 Shader Outputs: gl_SampleMask: bits that are 0 leave samples uncovered",
            }
            .to_owned();
    }
    if rejection == Rejection::CullDistance {
        return match edition {
            Gl45 => "OpenGL 4.5: 13.5 Primitive Clipping: a primitive with a cull distance that is negative at all of its vertices is discarded",
            Gl46 => "OpenGL 4.6: 13.7 Primitive Clipping: a primitive with a cull distance that is negative at all of its vertices is discarded",
            Gl33 => "GL_ARB_cull_distance: a primitive with a cull distance that is negative at all of its vertices is discarded",
            Es30 | Es31 | Es32 => "GL_EXT_clip_cull_distance: a primitive with a cull distance that is negative at all of its vertices is discarded",
        }
        .to_owned();
    }
    if rejection == Rejection::ClipDistance && matches!(edition, Es30 | Es31 | Es32) {
        return "GL_EXT_clip_cull_distance: half-space i holds the points whose distance is 0 or more"
                .to_owned();
    }
    // Sections in the order of the editions.
    let (sections, words) = match rejection {
        Rejection::RasterizerDiscard => (
            ["3.1", "14.1", "14.1", "3.1", "13.1", "13.1"],
            "Discarding Primitives Before Rasterization",
        ),
        Rejection::Coverage => match topology {
            PrimitiveTopology::PointList => (
                ["3.4.1", "14.4.1", "14.4.1", "3.4.1", "13.3.1", "13.5.1"],
                "Basic Point Rasterization",
            ),
            PrimitiveTopology::LineList | PrimitiveTopology::LineStrip => (
                ["3.5.1", "14.5.1", "14.5.1", "3.5.1", "13.4.1", "13.6.1"],
                "Basic Line Segment Rasterization",
            ),
            _ => (
                ["3.6.1", "14.6.1", "14.6.1", "3.6.1", "13.5.1", "13.7.1"],
                "Basic Polygon Rasterization: a sample outside of the polygon is not covered",
            ),
        },
        Rejection::Viewport => (
            ["2.19", "13.5", "13.7", "2.18", "12.4", "12.5"],
            "Primitive Clipping: to the view volume, whose sides map to the viewport's",
        ),
        Rejection::NearFar => (
            ["2.19", "13.5", "13.7", "2.18", "12.4", "12.5"],
            "Primitive Clipping: to the view volume, near to far",
        ),
        Rejection::ClipDistance => (
            ["2.19", "13.5", "13.7", "2.18", "12.4", "12.5"],
            "Primitive Clipping: half-space i holds the points whose distance is 0 or more",
        ),
        Rejection::Culling => (
            ["3.6.1", "14.6.1", "14.6.1", "3.6.1", "13.5.1", "13.7.1"],
            "Basic Polygon Rasterization: culled by facing and CullFace",
        ),
        Rejection::Scissor => (
            ["4.1.2", "14.9.2", "14.9.2", "4.1.2", "13.6.2", "13.8.2"],
            "Scissor Test: outside of the rectangle, the fragment is discarded",
        ),
        Rejection::SampleMask => (
            ["4.1.3", "14.9.3", "14.9.3", "4.1.3", "13.6.3", "13.8.3"],
            "Multisample Fragment Operations: coverage is ANDed with SAMPLE_MASK_VALUE",
        ),
        _ => (
            ["4.1.5", "17.3.4", "17.3.4", "4.1.5", "15.1.3", "15.1.3"],
            "Depth Buffer Test: a comparison that is false discards the fragment",
        ),
    };
    format!("{name}: {} {words}", sections[edition as usize])
}

/// An edition of the OpenGL or OpenGL ES specification, which determines the section numbers.
#[derive(Clone, Copy, Debug)]
enum Edition {
    Gl33,
    Gl45,
    Gl46,
    Es30,
    Es31,
    Es32,
}

impl Edition {
    // These editions must match the choice of `Rules::of`.
    fn of_opengl(version: ApiVersion) -> (&'static str, Self) {
        match (version.major, version.minor) {
            (3, _) | (4, 0 | 1) => ("OpenGL 3.3", Self::Gl33),
            (4, 2..=5) => ("OpenGL 4.5", Self::Gl45),
            _ => ("OpenGL 4.6", Self::Gl46),
        }
    }

    fn of_opengl_es(version: ApiVersion) -> (&'static str, Self) {
        match (version.major, version.minor) {
            (3, 0) => ("OpenGL ES 3.0", Self::Es30),
            (3, 1) => ("OpenGL ES 3.1", Self::Es31),
            _ => ("OpenGL ES 3.2", Self::Es32),
        }
    }
}
