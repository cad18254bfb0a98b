//! Random scenes over the whole model, made from choices.
//!
//! A scene is made as the JSON of a case file, which `reduce` takes. Inputs are limited to what can be
//! proven, as in the built-in random scenes: written depths are equal or far apart, most edges stay clear
//! of samples, and colours avoid values whose rounding is open. Nearly every sequence of choices is a valid
//! scene; the checks of case files decide. A scene has only a few uncommon features (swarm testing: Groce
//! and others 2012), because states hide each other if all are on at once.

mod attachments;
mod draws;
mod meshes;
mod palette;
mod passes;
mod states;
mod textures;
mod values;

use crate::choices::{Choices, StateHash};
use crate::space::Space;
use etalon_frame::{Feature, PathValue, TextureFormat};
use palette::Palette;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

/// A random scene.
pub(crate) struct Made {
    /// The scene, as in a case file.
    pub(crate) scene: Value,
    /// Further submissions that are read back; empty if there is only one.
    pub(crate) submissions: Vec<u32>,
    /// The states of the scene, then those of each draw.
    pub(crate) scopes: Vec<Vec<StateHash>>,
}

/// Makes the scene that the choices give.
pub(crate) fn scene(choices: Choices, space: &Space) -> Made {
    let mut maker = Maker::new(choices, space);
    let scene = maker.scene();
    let submissions = if maker.choices.once_in(16) {
        vec![maker.choices.range(1, 3)]
    } else {
        Vec::new()
    };
    Made {
        scene,
        submissions,
        scopes: maker.choices.finish(),
    }
}

/// A pass whose draws are being made.
#[derive(Clone, Debug)]
struct PassDraft {
    /// The names of its colour attachments, and their formats.
    color: Vec<(String, TextureFormat)>,
    depth_stencil: Option<TextureFormat>,
    samples: u32,
    read_only: bool,
    /// The names of single-sample attachments that earlier passes drew to and this pass does not.
    drawn: Vec<String>,
    /// The provoking vertex of all draws in the pass.
    provoking: Option<&'static str>,
}

impl PassDraft {
    /// Returns true if alpha to coverage requires no unusual format of the first colour attachment.
    fn has_alpha(&self) -> bool {
        let first = self.color.first();
        first.is_some_and(|(_, format)| format.has_alpha())
    }

    fn is_integer(&self) -> bool {
        self.color.iter().any(|(_, f)| f.is_integer())
    }

    fn has_depth(&self) -> bool {
        self.depth_stencil.is_some_and(TextureFormat::has_depth)
    }

    fn has_stencil(&self) -> bool {
        self.depth_stencil.is_some_and(TextureFormat::has_stencil)
    }
}

/// A scene that is being made.
struct Maker<'s> {
    choices: Choices,
    space: &'s Space,
    size: [u32; 2],
    palette: Palette,
    /// True if alpha is 0 or 1.
    whole_alpha: bool,
    /// The stencil reference of most draws. Random references would almost never be equal.
    reference: u32,
    /// The uncommon traits, and whether the scene has them.
    swarm: BTreeMap<&'static str, bool>,
    attachments: Map<String, Value>,
    counters: Map<String, Value>,
}

impl<'s> Maker<'s> {
    fn new(choices: Choices, space: &'s Space) -> Self {
        Self {
            choices,
            space,
            size: [16, 16],
            palette: Palette::Normalized,
            whole_alpha: false,
            reference: 0,
            swarm: BTreeMap::new(),
            attachments: Map::new(),
            counters: Map::new(),
        }
    }

    fn scene(&mut self) -> Value {
        const SIZES: [[u32; 2]; 14] = [
            [8, 8],
            [4, 4],
            [1, 1],
            [5, 3],
            [16, 16],
            [11, 7],
            [17, 5],
            [2, 9],
            [12, 13],
            [33, 3],
            [8, 8],
            [16, 9],
            [67, 11],
            [7, 130],
        ];
        self.size = self.choices.of(&SIZES);
        self.reference = self.choices.range(0, 254);
        let (passes, mut read) = self.passes();
        if self.choices.once_in(4) && read.len() > 1 {
            let gone = self.choices.below(read.len() as u32);
            read.remove(gone as usize);
        }
        let mut scene = json!({ "attachments": self.attachments, "passes": passes, "read": read });
        if !self.counters.is_empty() {
            scene["counters"] = json!(self.counters);
        }
        if let Some(path) = self.path() {
            scene["path"] = json!({ path.key(): path.name() });
        }
        scene
    }

    /// Returns the path to the driver, usually the default.
    fn path(&mut self) -> Option<PathValue> {
        if self.space.paths.is_empty() || !self.choices.once_in(4) {
            return None;
        }
        let path = self.choices.of(&self.space.paths);
        self.choices.note("path", path);
        Some(path)
    }

    /// Returns true if an uncommon state is to be set: never in two thirds of the scenes, and half of the
    /// time in the others.
    fn extra(&mut self, state: &'static str) -> bool {
        let known = self.swarm.get(state).copied();
        let on = known.unwrap_or_else(|| self.choices.once_in(3));
        self.swarm.insert(state, on);
        on && self.choices.once_in(2)
    }

    /// Like [`Maker::extra`], for a state that needs a feature.
    fn extra_with(&mut self, state: &'static str, feature: Feature) -> bool {
        self.space.has(feature) && self.extra(state)
    }

    /// Returns an 8-bit number from a short list.
    fn bits(&mut self) -> u32 {
        let some = [0xff, 0x0f, 0xf0, 0x55, 0xaa, 0x3c, 0x81, 0, 1, 0x80, 0x7f];
        self.choices.of(&some)
    }

    /// Returns a rectangle inside the scene's size.
    fn rect(&mut self) -> [u32; 4] {
        let [w, h] = self.size;
        let mut side = |length: u32| {
            let start = self.choices.below(length);
            (start, self.choices.range(1, length - start))
        };
        let ((x, w), (y, h)) = (side(w), side(h));
        [x, y, w, h]
    }
}
