//! Draws that read attachments of their own pass: through textures and texture barriers, or by framebuffer
//! fetch.

use crate::caps::{FETCH, FETCH_BY_BARRIERS, FETCH_DEPTH_STENCIL};
use crate::context::Context;
use etalon_backend::BackendError;
use etalon_frame::{Aspect, Feature, PathReads, PathValue, Requirement};
use etalon_scene::{Draw, Pass, Scene};

/// The way in which draws read attachments of their pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum OwnPassWay {
    /// Texel fetches of bound attachments.
    Textures,
    /// Framebuffer fetch with barriers.
    FetchByBarriers,
    /// Framebuffer fetch in the order of primitives.
    FetchInOrder,
}

/// A texture of a shader that is an attachment of the pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum OwnTexel {
    /// The colour attachment at this location.
    Color(usize),
    Depth,
    Stencil,
}

/// The attachments that a fragment shader fetches from the framebuffer, in place of its textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct OwnFetch {
    way: OwnPassWay,
    texels: [Option<OwnTexel>; 2],
}

/// Returns true if a context has a way.
fn has(context: &Context, way: OwnPassWay) -> bool {
    match way {
        OwnPassWay::Textures => context.entry_points.texture_barrier.is_some(),
        OwnPassWay::FetchByBarriers => context.entry_points.fetch_barrier.is_some(),
        OwnPassWay::FetchInOrder => context.caps.fetches_in_order,
    }
}

/// Returns true if a context has the way that a path names.
pub(crate) fn offers(context: &Context, reads: PathReads) -> bool {
    match reads {
        PathReads::Barriers | PathReads::Subpasses => false,
        PathReads::LocalRead => has(context, OwnPassWay::FetchByBarriers),
        PathReads::FeedbackLoop => has(context, OwnPassWay::Textures),
        PathReads::Ordered => has(context, OwnPassWay::FetchInOrder),
    }
}

/// Returns true if a context has a feature of draws that read their pass.
pub(crate) fn supports(context: &Context, feature: Feature) -> bool {
    let caps = &context.caps;
    let any = |ways: &[OwnPassWay]| ways.iter().any(|way| has(context, *way));
    let textures = has(context, OwnPassWay::Textures);
    match feature {
        Feature::OwnPassReadsInOrder => caps.fetches_in_order,
        Feature::OwnPassDepthReads => textures || caps.fetches_depth_stencil,
        Feature::OwnPassStencilReads => {
            textures && caps.stencil_texturing || caps.fetches_depth_stencil
        }
        _ => any(&[
            OwnPassWay::Textures,
            OwnPassWay::FetchByBarriers,
            OwnPassWay::FetchInOrder,
        ]),
    }
}

/// Returns the way in which draws of a pass read attachments of the pass; `None` if no draw does.
pub(crate) fn way(
    context: &Context,
    scene: &Scene,
    pass: &Pass,
) -> Result<Option<OwnPassWay>, BackendError> {
    if !pass.reads_itself() {
        return Ok(None);
    }
    let in_order = Requirement::Feature(Feature::OwnPassReadsInOrder);
    let overlaps = scene.requirements().contains(&in_order);
    let (textures, barriers, ordered) = (
        OwnPassWay::Textures,
        OwnPassWay::FetchByBarriers,
        OwnPassWay::FetchInOrder,
    );
    let ways = match scene.path.reads {
        PathReads::Barriers if overlaps => vec![ordered],
        PathReads::Barriers => vec![textures, barriers, ordered],
        PathReads::Subpasses => Vec::new(),
        PathReads::LocalRead => vec![barriers],
        PathReads::FeedbackLoop => vec![textures],
        PathReads::Ordered => vec![ordered],
    };
    let can = |way: &OwnPassWay| {
        let fetches = *way != textures;
        let mut draws = pass.draws.iter().filter(|draw| draw.reads_own(pass));
        has(context, *way)
            && (!overlaps || *way == ordered)
            && draws.all(|draw| {
                let mut textures = draw.textures.iter();
                textures.all(
                    |index| match draw.aspect_read(scene.attachments[*index].format) {
                        Aspect::Color => true,
                        Aspect::Depth => !fetches || context.caps.fetches_depth_stencil,
                        Aspect::Stencil if fetches => context.caps.fetches_depth_stencil,
                        Aspect::Stencil => context.caps.stencil_texturing,
                    },
                )
            })
    };
    let value = PathValue::Reads(scene.path.reads);
    let way = ways.into_iter().find(can);
    way.map(Some)
        .ok_or(BackendError::NotSupported(Requirement::Path(value)))
}

/// Returns what a draw fetches from the framebuffer in place of its textures.
pub(crate) fn fetch(way: Option<OwnPassWay>, pass: &Pass, draw: &Draw) -> Option<OwnFetch> {
    let way = way.filter(|way| *way != OwnPassWay::Textures && draw.reads_own(pass))?;
    let mut texels = [None; 2];
    for (texel, index) in texels.iter_mut().zip(&draw.textures) {
        let location = pass.color.iter().position(|color| color == index);
        *texel = Some(match location {
            Some(location) => OwnTexel::Color(location),
            None if draw.shader.reads_stencil() => OwnTexel::Stencil,
            None => OwnTexel::Depth,
        });
    }
    Some(OwnFetch { way, texels })
}

/// Makes what earlier draws wrote visible to the reads of the next.
pub(crate) fn barrier(context: &Context, way: OwnPassWay) {
    let barrier = match way {
        OwnPassWay::Textures => context.entry_points.texture_barrier,
        OwnPassWay::FetchByBarriers => context.entry_points.fetch_barrier,
        OwnPassWay::FetchInOrder => None,
    };
    if let Some(barrier) = barrier {
        // SAFETY: the context is current and defines the function.
        unsafe { barrier() };
    }
}

/// Returns a fragment shader that fetches from the framebuffer in place of the textures with these names.
pub(crate) fn fetching(
    fragment: &str,
    textures: &[(String, u32)],
    fetch: OwnFetch,
) -> Result<String, String> {
    let mut text = fragment.to_owned();
    let mut extensions = String::new();
    for (name, unit) in textures {
        let Some(Some(texel)) = fetch.texels.get(*unit as usize) else {
            continue;
        };
        let (extension, value) = match texel {
            OwnTexel::Color(location) => {
                let extension = match fetch.way {
                    OwnPassWay::FetchByBarriers => FETCH_BY_BARRIERS,
                    _ => FETCH,
                };
                (extension, with_input(&mut text, *location, fetch.way))
            }
            OwnTexel::Depth => (
                FETCH_DEPTH_STENCIL,
                "vec4(gl_LastFragDepthARM, 0.0, 0.0, 1.0)".to_owned(),
            ),
            OwnTexel::Stencil => (
                FETCH_DEPTH_STENCIL,
                "uvec4(uint(gl_LastFragStencilARM), 0u, 0u, 1u)".to_owned(),
            ),
        };
        let line = format!("#extension {extension} : require\n");
        if !extensions.contains(&line) {
            extensions += &line;
        }
        text = replaced(&text, name, &value)?;
    }
    let (version, body) = text.split_once('\n').ok_or("naga writes no version")?;
    Ok(format!("{version}\n{extensions}{body}"))
}

/// Makes the output at a location also an input, and returns its name.
fn with_input(text: &mut String, location: usize, way: OwnPassWay) -> String {
    let declared = format!("layout(location = {location}) out vec4 ");
    let qualifier = match way {
        OwnPassWay::FetchByBarriers => "noncoherent, ",
        _ => "",
    };
    let input = format!("layout({qualifier}location = {location}) inout highp vec4 ");
    match text.split_once(&declared) {
        Some((before, behind)) => {
            let name = behind.split(';').next().unwrap_or_default().to_owned();
            *text = format!("{before}{input}{behind}");
            name
        }
        None => {
            let name = format!("own_{location}");
            let already = format!("{input}{name};\n");
            if !text.contains(&already) {
                let start = text.find("void main()").unwrap_or(text.len());
                text.insert_str(start, &already);
            }
            name
        }
    }
}

/// Returns a shader without a texture: its declaration is removed, and a value replaces its fetches.
fn replaced(text: &str, name: &str, value: &str) -> Result<String, String> {
    let mut made = String::new();
    for line in text.split_inclusive('\n') {
        if line.starts_with("uniform") && line.contains(name) {
            continue;
        }
        let Some((before, call)) = line.split_once(&format!("texelFetch({name}, ")) else {
            made += line;
            continue;
        };
        let mut depth = 1;
        let end = call.find(|c| {
            depth += match c {
                '(' => 1,
                ')' => -1,
                _ => 0,
            };
            depth == 0
        });
        let end = end.ok_or("naga splits a fetch over lines")?;
        made += &format!("{before}{value}{}", &call[end + 1..]);
    }
    Ok(made)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "#version 320 es\nuniform highp sampler2D t;\nlayout(location = 0) out vec4 a;\n\
                        void main() {\nvec4 b = texelFetch(t, ivec2(p.xy), 0);\na = b;\n}\n";

    #[test]
    fn a_fetch_of_an_output_becomes_its_input() {
        let fetch = OwnFetch {
            way: OwnPassWay::FetchByBarriers,
            texels: [Some(OwnTexel::Color(0)), None],
        };
        let expected = "#version 320 es\n\
                        #extension GL_EXT_shader_framebuffer_fetch_non_coherent : require\n\
                        layout(noncoherent, location = 0) inout highp vec4 a;\n\
                        void main() {\nvec4 b = a;\na = b;\n}\n";
        let made = fetching(TEXT, &[("t".to_owned(), 0)], fetch);
        assert_eq!(made.as_deref(), Ok(expected));
    }

    #[test]
    fn other_attachments_are_declared_or_built_in() {
        let other = |texel| OwnFetch {
            way: OwnPassWay::FetchInOrder,
            texels: [Some(texel), None],
        };
        let textures = [("t".to_owned(), 0)];
        let color = fetching(TEXT, &textures, other(OwnTexel::Color(1))).expect("it has a fetch");
        assert!(color.contains("layout(location = 1) inout highp vec4 own_1;\nvoid main()"));
        assert!(color.contains("vec4 b = own_1;"));
        let depth = fetching(TEXT, &textures, other(OwnTexel::Depth)).expect("it has a fetch");
        assert!(depth.contains("vec4 b = vec4(gl_LastFragDepthARM, 0.0, 0.0, 1.0);"));
        assert!(depth.contains("layout(location = 0) out vec4 a;"));
    }
}
