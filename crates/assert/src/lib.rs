//! Judges what a renderer of your own drew, in its tests: there is no tolerance to choose, because the specification of
//! the API says which values are allowed.
//!
//! A [`case()`] has scenes: attachments, passes, draws with all their states. Draw them with your renderer, pack the
//! texels that it read back into [`frame()`]s, and let [`judge_frame`] decide:
//!
//! ```
//! use etalon_assert::{Api, case, frame, judge_frame};
//!
//! let case = case("capabilities/clear/format=rgba8unorm/samples=1")?;
//! // Your renderer goes here. The scene is cleared to one colour and read back.
//! let frames = [frame(&case.scene, &[], |form| {
//!     assert_eq!((form.attachment.as_str(), form.size), ("color", [5, 3]));
//!     [0, 0, 255, 255].repeat(5 * 3)
//! })?];
//! let judged = judge_frame(&case, &frames, Api::WebGpu, None)?;
//! // The case asks for red.
//! assert!(!judged.is_allowed());
//! println!("{}", judged.explain()?);
//! # Ok::<(), etalon_assert::AssertError>(())
//! ```
//!
//! The parts of a scene are in [`scene`]: [attachments](scene::Attachment) with their first contents, and
//! [passes](scene::Pass) of [draws](scene::Draw). [`Draw::call`](scene::Draw::call) gives a draw's vertices, ten 32-bit
//! floats each (position in clip space, colour, texture coordinates: locations 0, 1 and 2), and its indices;
//! [`Shader::wgsl`](scene::Shader::wgsl) gives its shader with the entry points `vs` and `fs`, and
//! [`Params::to_bytes`](scene::Params::to_bytes) the uniform block at binding 0. Textures are at bindings 1 and 2, their
//! sampler at 4. `examples/blending.rs` draws with `wgpu`.
//!
//! Units are those of the APIs: texels from the top left corner, depth from 0 to 1, clip space with y up. Colours are
//! codes of their formats, so sRGB is never decoded, and alpha is a channel like the others. This crate uses no graphics
//! API. Its interface changes only with its version, by the rules of Semantic Versioning.

mod error;
mod explain;
mod judged;

pub use error::AssertError;
pub use etalon_backend::texels::AspectForm;
pub use etalon_case::Case;
pub use etalon_frame::{Api, Frame, Limits};
pub use etalon_record::{Record, Verdict};
pub use etalon_scene as scene;
pub use etalon_scene::Scene;
pub use explain::{AskedTexel, Explanation};
pub use judged::{Judged, judge_frame};

use etalon_backend::open_limits::file_limits;
use etalon_case::{Library, Profile};
use etalon_cpu::limits_of;
use etalon_glob::did_you_mean;

/// Returns a built-in case by its id, as `etalon list --profile full` prints it.
///
/// # Errors
/// If there is no such case, with a suggestion.
pub fn case(id: &str) -> Result<Case, AssertError> {
    let library = Library::built_in();
    let named = library.cases_that_begin(id).find(|case| case.id() == id);
    let Some(named) = named else {
        let ids: Vec<String> = library.cases(Profile::Full).map(|c| c.id()).collect();
        return Err(AssertError::UnknownCase {
            id: id.to_owned(),
            near: did_you_mean(id, ids.iter().map(String::as_str)),
        });
    };
    named.build().map_err(|e| AssertError::Case(e.to_string()))
}

/// Returns the frame of a scene. `counters` are the values of the scene's counters, in their order. `texels` returns the
/// bytes of each aspect that the scene reads back: rows from the top, texels from the left, the samples of a texel after
/// each other; a colour in the little-endian bytes of its format in WebGPU without padding, depth as 32-bit floats,
/// stencil as bytes.
///
/// # Errors
/// If an aspect has the wrong number of bytes.
pub fn frame(
    scene: &Scene,
    counters: &[u64],
    mut texels: impl FnMut(&AspectForm) -> Vec<u8>,
) -> Result<Frame, AssertError> {
    let forms = AspectForm::of_scene(scene);
    let images = forms.iter().map(|form| form.image(&texels(form)));
    Ok(Frame {
        images: images
            .collect::<Result<_, _>>()
            .map_err(AssertError::Unfit)?,
        counters: counters.to_vec(),
    })
}

/// Returns limits that every device of an API meets: the coarsest grid of vertices, standard sample positions, and any
/// encoding of depths. All formats and features are there, because a frame shows that they were.
pub fn any_device(api: Api) -> Limits {
    file_limits(limits_of(api))
}
