//! The stencil state with which a fragment is tested: the state of its face, with the reference of the draw
//! or of its shader.
//!
//! Tests before the shader use the draw's reference, whatever the shader writes.

use crate::notes::Notes;
use crate::range::Range;
use crate::walk::{FragmentPlace, Walk};
use etalon_frame::{Api, Step};
use etalon_pipeline::exported_reference;
use etalon_pipeline::shader::FragmentOutput;
use etalon_scene::{Draw, StencilFace};
use smallvec::{SmallVec, smallvec};

/// The stencil state of a fragment's face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Face {
    /// The state, with the reference that applies.
    pub(crate) state: StencilFace,
    /// True if the shader wrote that reference.
    pub(crate) exported: bool,
}

impl Face {
    /// Returns the state of a draw for one face; `None` if the draw has no stencil test.
    pub(crate) fn of(draw: &Draw, front: bool) -> Option<Self> {
        let stencil = draw.stencil.as_ref()?;
        Some(Self {
            state: if front { stencil.front } else { stencil.back },
            exported: false,
        })
    }
}

impl Walk<'_> {
    /// Returns the stencil states that a fragment can be tested with after its shader: several if the
    /// reference that the shader writes is not known exactly.
    pub(crate) fn faces(
        &self,
        place: &FragmentPlace<'_>,
        front: bool,
        output: &FragmentOutput<Range>,
        notes: &mut Notes<'_>,
    ) -> SmallVec<[Option<Face>; 1]> {
        let (Some(face), Some(reference)) = (Face::of(place.draw, front), &output.reference) else {
            return smallvec![Face::of(place.draw, front)];
        };
        let with = |reference: u8| {
            Some(Face {
                state: StencilFace {
                    reference,
                    ..face.state
                },
                exported: true,
            })
        };
        let number = reference.number.hull();
        if number.low.to_bits() != number.high.to_bits() {
            return (0..=u8::MAX).map(with).collect();
        }
        let written = reference.written(number.low as f32);
        let counts = exported_reference(written);
        notes.add(
            || place.origin(),
            || Step::StencilExport {
                written,
                reference: counts,
                draw: face.state.reference,
            },
            Some(replaces(self.limits.api)),
        );
        smallvec![with(counts)]
    }

    /// Notes that the reference that a shader writes comes too late.
    pub(crate) fn note_late_reference(
        &self,
        place: &FragmentPlace<'_>,
        front: bool,
        notes: &mut Notes<'_>,
    ) {
        let Some(face) = Face::of(place.draw, front) else {
            return;
        };
        if place.draw.shader.writes_reference() {
            notes.add(
                || place.origin(),
                || Step::LateStencilExport {
                    draw: face.state.reference,
                },
                Some(comes_late(self.limits.api)),
            );
        }
    }
}

/// Returns the clause that lets a shader's reference replace the draw's.
fn replaces(api: Api) -> &'static str {
    match api {
        Api::Vulkan => {
            "Vulkan: Stencil Reference Replacement: stencil testing after the fragment shader uses the new \
             value; FragStencilRefEXT: higher bits than the attachment's are discarded"
        }
        Api::OpenGl => {
            "GL_ARB_shader_stencil_export: gl_FragStencilRefARB establishes the fragment's reference; bits \
             past STENCIL_BITS are discarded"
        }
        Api::OpenGlEs | Api::WebGpu => "no stencil export",
    }
}

/// Returns the clause that makes forced early tests use the draw's reference.
fn comes_late(api: Api) -> &'static str {
    match api {
        Api::Vulkan => {
            "Vulkan: Stencil Reference Replacement: the new value is for stencil testing after the fragment \
             shader; Early Fragment Test: with EarlyFragmentTests it comes before"
        }
        Api::OpenGl => {
            "OpenGL 4.6: 14.9.4 The Early Fragment Test Qualifier: the stencil test is performed prior to \
             fragment shader execution, and not again after it"
        }
        Api::OpenGlEs | Api::WebGpu => "no stencil export",
    }
}
