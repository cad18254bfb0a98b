//! The keys of a case file.

use super::axis::{Axis, DerivedWire};
use super::scene::{AttachmentWire, DrawWire, SceneWire, all_channels};
use crate::error::At;
use crate::random::Flavor;
use etalon_methods::MethodWire;
use etalon_scene::Invariance;
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::num::{NonZeroU32, NonZeroUsize};

/// A case file. In `scene`, `judged_as` and `expect`, the string `"$name"` is replaced by the value of the
/// axis or derived value with that name.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct FileWire {
    /// The location of the JSON schema, for editors.
    #[serde(rename = "$schema")]
    _schema: Option<String>,
    /// The purpose of the cases, in a sentence.
    pub(crate) about: String,
    /// The clauses of the specifications that bind the cases, each as `API: section`.
    pub(crate) spec: Vec<String>,
    /// The cases of the product that the quick profile takes; by default all.
    pub(crate) quick: Option<QuickWire>,
    /// The axes; the file expands to their product.
    #[serde(default)]
    pub(crate) axes: BTreeMap<String, Axis>,
    /// Values that are derived from an axis and are not part of the id.
    #[serde(default)]
    pub(crate) derived: BTreeMap<String, DerivedWire>,
    /// Changes of the scene by name, each as JSON pointers and values. The values of the axis `with` name those of a
    /// case, joined by `+`.
    #[serde(default)]
    pub(crate) changes: BTreeMap<String, BTreeMap<String, Value>>,
    /// The scene.
    #[serde(default)]
    #[schemars(with = "SceneWire")]
    scene: Value,
    /// In place of `scene`: a scene that is made from a seed.
    #[serde(default)]
    #[schemars(with = "RandomWire")]
    random: Value,
    /// In place of `scene`: many draws, each with a state of its own.
    #[serde(default)]
    #[schemars(with = "StatesWire")]
    states: Value,
    /// In place of `scene`: draws that alternate between two states.
    #[serde(default)]
    #[schemars(with = "SequenceWire")]
    sequence: Value,
    /// In place of `scene`: a scene that a rendering method draws, and whose picture is compared with the
    /// truth. The file must be `methods/<question>/<scene>.json` and have an axis `method`.
    #[serde(default)]
    #[schemars(with = "MethodWire")]
    method: Value,
    /// For methods only: the numeric axis along which the methods' errors are plotted.
    pub(crate) parameter: Option<String>,
    /// Changed copies of the scene, all of them drawn too.
    #[serde(default)]
    pub(crate) variants: Vec<VariantWire>,
    /// Further submissions of the prepared scene. After each, the frame is read again and must be the same.
    #[serde(default)]
    pub(crate) submissions: Vec<NonZeroU32>,
    /// The relation of the variants' frames to the scene's own.
    #[serde(default)]
    #[schemars(with = "Option<RelationWire>")]
    pub(crate) relation: Value,
    /// For selftests only: changes to the scene, as JSON pointers and values, that the judge sees and the
    /// adapter does not. A Fail is then expected.
    #[serde(default)]
    pub(crate) judged_as: BTreeMap<String, Value>,
    /// Literal values that must come back.
    #[serde(default)]
    #[schemars(with = "Vec<ExpectWire>")]
    pub(crate) expect: Value,
}

/// The key of a case file that its scenes are made from, with its value. Names of axes stand for their values.
#[derive(Clone, Debug)]
pub(crate) enum SceneSource {
    /// A scene.
    Scene(Value),
    /// A [`RandomWire`].
    Random(Value),
    /// A [`StatesWire`].
    States(Value),
    /// A [`SequenceWire`].
    Sequence(Value),
    /// A [`MethodWire`].
    Method(Value),
}

impl SceneSource {
    /// Returns the key.
    pub(crate) fn key(&self) -> &'static str {
        match self {
            Self::Scene(_) => "scene",
            Self::Random(_) => "random",
            Self::States(_) => "states",
            Self::Sequence(_) => "sequence",
            Self::Method(_) => "method",
        }
    }

    /// Returns the value.
    pub(crate) fn value(&self) -> &Value {
        match self {
            Self::Scene(value)
            | Self::Random(value)
            | Self::States(value)
            | Self::Sequence(value)
            | Self::Method(value) => value,
        }
    }
}

impl FileWire {
    /// Takes the one source of the scenes.
    ///
    /// # Errors
    /// If the file has none or several.
    pub(crate) fn take_source(&mut self) -> Result<SceneSource, At> {
        let mut given = [
            SceneSource::Scene(self.scene.take()),
            SceneSource::Random(self.random.take()),
            SceneSource::States(self.states.take()),
            SceneSource::Sequence(self.sequence.take()),
            SceneSource::Method(self.method.take()),
        ]
        .into_iter()
        .filter(|source| !source.value().is_null());
        let source = given
            .next()
            .ok_or_else(|| At::new("a case file needs a scene").key("scene"))?;
        match given.next() {
            None => Ok(source),
            Some(other) => {
                let message = format!("`{}` excludes `{}`", other.key(), source.key());
                Err(At::new(message).key(other.key()))
            }
        }
    }
}

/// A scene that is made from a seed: the same in every run and every release.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RandomWire {
    /// The states of the scene.
    pub(crate) flavor: Flavor,
    /// The seed.
    pub(crate) seed: u64,
}

/// A scene of many draws, each with a state and a place of its own.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct StatesWire {
    /// The number of draws.
    pub(crate) count: u32,
    /// Width and height in texels.
    pub(crate) size: [u32; 2],
}

/// A scene of draws that alternate between two states.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SequenceWire {
    /// Textures by name, as in a scene.
    #[schemars(with = "BTreeMap<String, AttachmentWire>")]
    pub(crate) attachments: BTreeMap<String, Value>,
    /// The pass without its draws.
    pub(crate) pass: Value,
    /// Draws that come first, once on each framebuffer.
    #[serde(default)]
    #[schemars(with = "Vec<DrawWire>")]
    pub(crate) prepare: Vec<Value>,
    /// The common part of all steps: a draw.
    pub(crate) draw: Value,
    /// The changes of each step to the draw, as JSON merge patches.
    pub(crate) steps: Vec<Value>,
    /// The state of the first, the third and so on of the steps: a change to the draw.
    pub(crate) first: Value,
    /// The state of the other steps.
    pub(crate) then: Value,
    /// The kind of separation between the steps.
    pub(crate) across: Across,
    /// Counters by name; all are read back.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, etalon_frame::CounterKind>")]
    pub(crate) counters: BTreeMap<String, Value>,
    /// The attachments to read back; those of the second framebuffer follow.
    pub(crate) read: Vec<String>,
    /// The path, as in a scene.
    #[serde(default)]
    #[schemars(with = "etalon_scene::Path")]
    pub(crate) path: BTreeMap<String, Value>,
}

/// The kind of separation between a sequence's steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Across {
    /// In draws of one pass.
    Draw,
    /// In passes on the same attachments.
    Pass,
    /// In passes that alternate between these attachments and a second set with the same formats and size.
    Framebuffer,
}

/// The scene with some changes.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct VariantWire {
    /// The variant's name in records.
    pub(crate) name: String,
    /// JSON pointers into the scene, and the values that replace what is there.
    #[serde(default)]
    pub(crate) patch: BTreeMap<String, Value>,
    /// JSON pointers to lists, and the new order of their items.
    #[serde(default)]
    pub(crate) permute: BTreeMap<String, Vec<usize>>,
}

/// Frames, or attachments of one frame, that must be the same.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RelationWire {
    /// The reason why they must be the same.
    pub(crate) same: Invariance,
    /// Left, top, width and height of the texels that are compared; by default all.
    pub(crate) within: Option<[u32; 4]>,
    /// The colour channels that are compared, as letters of `rgba`.
    #[serde(default = "all_channels")]
    pub(crate) channels: String,
    /// The offset of the variants' pictures in texels, to the right and down.
    #[serde(default)]
    pub(crate) offset: [i32; 2],
    /// Attachments of each frame that are compared with each other, in place of frames.
    #[serde(default)]
    pub(crate) attachments: Vec<String>,
}

/// The cases of a product that the quick profile takes: `"pairwise"`, `{ "each": n }`, `{ "first": n }`,
/// `{ "where": { axis: value } }` or `{ "any": [{ axis: value }] }`.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum QuickWire {
    /// Enough that every two values of every two axes occur together.
    Pairwise,
    /// Enough that every value of every axis occurs in this many cases, each time with different other values:
    /// for products of two long axes, since a covering array of those would take every case.
    Each(NonZeroUsize),
    /// This many from the first one on: for seeds, which are interchangeable.
    First(NonZeroUsize),
    /// The cases in which these axes have the values of these names: for sizes that only a benchmark needs.
    Where(BTreeMap<String, String>),
    /// The cases that have all the values of one of these rows: for products that a few rows represent.
    Any(Vec<BTreeMap<String, String>>),
}

impl QuickWire {
    /// Returns true if each case has a counterpart with every value of an axis.
    pub(crate) fn takes_all_of(&self, axis: &str) -> bool {
        match self {
            Self::Pairwise | Self::Each(_) | Self::First(_) => false,
            Self::Where(chosen) => !chosen.contains_key(axis),
            Self::Any(rows) => rows.iter().all(|chosen| !chosen.contains_key(axis)),
        }
    }
}

/// A colour that a texel of the frame must have.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ExpectWire {
    pub(crate) attachment: String,
    /// Column and row.
    pub(crate) texel: [u32; 2],
    /// The exact value of each channel; the frame must have the nearest code.
    pub(crate) value: Vec<f64>,
}
