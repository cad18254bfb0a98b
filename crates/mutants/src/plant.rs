//! Planting a bug in the scene, in a step, or in the frame.

use crate::fields::FieldPlaces;
use crate::hooks::Hooks;
use crate::memory::StoredDataBug;
use etalon_cpu::steps::{Moment, Stored};
use etalon_frame::{Aspect, ChannelEncoding, Frame, Image};
use etalon_scene::{Attachment, Draw, Pass, Scene};
use std::fmt;

type SceneBug = dyn Fn(Option<&Scene>, &mut Scene) + Send + Sync;
type DrawBug = dyn Fn(&mut Draw) + Send + Sync;
type MemoryBug = dyn Fn() -> StoredDataBug + Send + Sync;
pub(super) type FrameBug = dyn Fn(&Scene, &mut Frame) + Send + Sync;

/// A planted bug.
pub(super) enum Plant {
    /// The driver draws another scene, which can depend on the previous scene.
    Scene(Box<SceneBug>),
    /// Every draw is changed.
    Draws(Box<DrawBug>),
    /// The driver draws another scene, starting at this submission of a prepared scene, counted from 1.
    Again(u32, Box<SceneBug>),
    /// A step of the rasterizer is replaced.
    Steps(Box<Hooks>),
    /// The data that a submission has stored is changed. Each prepared scene has its own bug, which can
    /// remember earlier moments and submissions.
    Memory(Box<MemoryBug>),
    /// The frame is changed when it is read back.
    Frame(Box<FrameBug>),
}

impl fmt::Debug for Plant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Plant")
    }
}

impl Plant {
    /// Restricts a bug of draws to draws for which `strikes` is true.
    ///
    /// # Panics
    /// If the bug does not change draws.
    pub(super) fn when(self, strikes: fn(&Draw) -> bool) -> Self {
        let Self::Draws(bug) = self else {
            panic!("only bugs of draws have a condition");
        };
        draws(move |draw| {
            if strikes(draw) {
                bug(draw);
            }
        })
    }
}

impl From<Hooks> for Plant {
    fn from(hooks: Hooks) -> Self {
        Self::Steps(Box::new(hooks))
    }
}

/// Changes stored data at some moments. Each prepared scene has its own state.
pub(super) fn memory<S: Default + 'static>(
    bug: impl Fn(&mut S, Moment, &Scene, Stored<'_>) + Clone + Send + Sync + 'static,
) -> Plant {
    Plant::Memory(Box::new(move || {
        let (bug, mut state) = (bug.clone(), S::default());
        StoredDataBug::new(move |moment, scene, stored| bug(&mut state, moment, scene, stored))
    }))
}

/// Changes the scene.
pub(super) fn scene(bug: impl Fn(&mut Scene) + Send + Sync + 'static) -> Plant {
    Plant::Scene(Box::new(move |_, scene| bug(scene)))
}

/// Changes the scene, starting at a submission.
pub(super) fn again(from: u32, bug: impl Fn(&mut Scene) + Send + Sync + 'static) -> Plant {
    Plant::Again(from, Box::new(move |_, scene| bug(scene)))
}

/// Changes every pass, given the original scene and the index of the pass.
pub(super) fn passes(bug: impl Fn(&Scene, usize, &mut Pass) + Send + Sync + 'static) -> Plant {
    scene(move |scene| {
        let original = scene.clone();
        for (number, pass) in scene.passes.iter_mut().enumerate() {
            bug(&original, number, pass);
        }
    })
}

/// Changes the draws of every pass.
pub(super) fn calls(bug: impl Fn(&mut Vec<Draw>) + Send + Sync + 'static) -> Plant {
    passes(move |_, _, pass| bug(&mut pass.draws))
}

/// Changes every draw.
pub(super) fn draws(bug: impl Fn(&mut Draw) + Send + Sync + 'static) -> Plant {
    Plant::Draws(Box::new(bug))
}

/// Changes a field of every draw that has it.
pub(super) fn each<T: 'static>(
    field: FieldPlaces<T>,
    bug: impl Fn(&mut T) + Send + Sync + 'static,
) -> Plant {
    draws(move |draw| field(draw).into_iter().for_each(&bug))
}

/// Returns a function that sets a field of a draw to a value.
pub(super) fn setter<T: Copy + Send + Sync + 'static>(
    field: FieldPlaces<T>,
    value: T,
) -> impl Fn(&mut Draw) + Copy + Send + Sync + 'static {
    move |draw| field(draw).into_iter().for_each(|place| *place = value)
}

/// Sets a field of every draw to a value.
pub(super) fn set<T: Copy + Send + Sync + 'static>(field: FieldPlaces<T>, value: T) -> Plant {
    draws(setter(field, value))
}

/// Makes one value of a field act as another.
pub(super) fn swapped<T: Copy + PartialEq + Send + Sync + 'static>(
    field: FieldPlaces<T>,
    right: T,
    wrong: T,
) -> Plant {
    each(field, move |value| {
        if *value == right {
            *value = wrong;
        }
    })
}

/// Returns the draws of all passes.
pub(super) fn all_draws(scene: &mut Scene) -> impl Iterator<Item = &mut Draw> {
    scene.passes.iter_mut().flat_map(|pass| &mut pass.draws)
}

/// Changes draws, given the size of the attachments.
pub(super) fn sized(bug: impl Fn(&mut Draw, [u32; 2]) + Send + Sync + 'static) -> Plant {
    passes(move |scene, number, pass| {
        let size = scene.pass_size(&scene.passes[number]);
        pass.draws.iter_mut().for_each(|d| bug(d, size));
    })
}

/// Changes the initial contents of attachments.
pub(super) fn contents(bug: impl Fn(&mut Attachment) + Send + Sync + 'static) -> Plant {
    scene(move |scene| scene.attachments.iter_mut().for_each(&bug))
}

/// Changes the first draw of a scene, given the last draw of the previous scene.
pub(super) fn from_case(bug: impl Fn(&Draw, &mut Draw) + Send + Sync + 'static) -> Plant {
    Plant::Scene(Box::new(move |previous, scene| {
        let last =
            previous.and_then(|previous| previous.passes.iter().flat_map(|p| &p.draws).last());
        if let (Some(last), Some(first)) = (last, all_draws(scene).next()) {
            bug(last, first);
        }
    }))
}

/// Changes every draw except the first, given the unchanged previous draw.
pub(super) fn from_draw(bug: impl Fn(&Draw, &mut Draw) + Send + Sync + 'static) -> Plant {
    scene(move |scene| {
        let mut previous: Option<Draw> = None;
        for draw in all_draws(scene) {
            let original = draw.clone();
            if let Some(previous) = &previous {
                bug(previous, draw);
            }
            previous = Some(original);
        }
    })
}

/// Changes the frame, given the scene.
pub(super) fn frames(bug: impl Fn(&Scene, &mut Frame) + Send + Sync + 'static) -> Plant {
    Plant::Frame(Box::new(bug))
}

/// Changes every image of one aspect.
pub(super) fn images(aspect: Aspect, bug: impl Fn(&mut Image) + Send + Sync + 'static) -> Plant {
    frames(move |_, frame| {
        let chosen = frame.images.iter_mut().filter(|i| i.aspect == aspect);
        chosen.for_each(&bug);
    })
}

/// Changes every image of some attachments.
pub(super) fn images_of(
    which: impl Fn(&Attachment) -> bool + Send + Sync + 'static,
    bug: impl Fn(&mut Image) + Send + Sync + 'static,
) -> Plant {
    frames(move |scene, frame| {
        for image in &mut frame.images {
            let mut attachments = scene.attachments.iter();
            if attachments.any(|a| a.name == image.attachment && which(a)) {
                bug(image);
            }
        }
    })
}

/// Replaces every texel of an aspect by another texel of the image: `from([x, y], [width, height])`.
pub(super) fn moved(
    aspect: Aspect,
    from: impl Fn([u32; 2], [u32; 2]) -> [u32; 2] + Send + Sync + 'static,
) -> Plant {
    images(aspect, move |image| move_texels(image, &from))
}

/// Replaces every texel of an image by another of its texels.
pub(super) fn move_texels(image: &mut Image, from: impl Fn([u32; 2], [u32; 2]) -> [u32; 2]) {
    let original = image.codes.clone();
    let [width, height] = image.size;
    // A texel's samples are adjacent and move together.
    let n = image.channels.len() * image.samples as usize;
    for (number, texel) in (0..).zip(image.codes.chunks_exact_mut(n)) {
        let [x, y] = from([number % width, number / width], image.size);
        let source = (y.min(height - 1) * width + x.min(width - 1)) as usize * n;
        texel.copy_from_slice(&original[source..source + n]);
    }
}

/// Moves a code by a number of steps, within the range of its encoding.
pub(super) fn nudge(encoding: ChannelEncoding, code: u32, steps: i64) -> u32 {
    let order = encoding.order_of_code(code) + steps;
    encoding.code_of_order(order.clamp(encoding.min_order(), encoding.max_order()))
}

/// Rounds a value to a normalized integer with `bits` bits.
pub(super) fn in_bits(value: f32, bits: u32) -> f32 {
    let most = ((1_u64 << bits) - 1) as f32;
    (value * most).round() / most
}
