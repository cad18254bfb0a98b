//! The shape of a case file. These types parse; [`crate::scene`] computes.

use crate::random::Flavor;
use etalon_frame::{CounterKind, TextureFormat};
use etalon_methods::MethodWire;
use etalon_scene::{
    BlendState, CompareFunction, CullMode, DepthBias, DepthState, EarlyTests, FrontFace,
    Invariance, LogicOperation, MeshSource, Multisample, PolygonMode, PrimitiveTopology, Sampler,
    Shader, Splat, StencilOperation, Viewport,
};
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::num::NonZeroUsize;

/// A case file. In `scene`, `judged_as` and `expect`, the string `"$name"` stands for the value of
/// the axis or derived value of that name.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct FileWire {
    /// What the cases prove, in a sentence.
    pub(crate) about: String,
    /// The clauses of the specifications that bind, each as `API: section`.
    pub(crate) spec: Vec<String>,
    /// Which cases of the product the quick profile takes; without it, all.
    pub(crate) quick: Option<QuickWire>,
    /// The axes; the file stands for their whole product.
    #[serde(default)]
    pub(crate) axes: BTreeMap<String, Axis>,
    /// Values that follow from an axis and are no part of the id.
    #[serde(default)]
    pub(crate) derived: BTreeMap<String, DerivedWire>,
    /// What is drawn.
    #[serde(default)]
    #[schemars(with = "SceneWire")]
    pub(crate) scene: Value,
    /// Instead of `scene`: a scene that is made from a seed.
    #[serde(default)]
    #[schemars(with = "RandomWire")]
    pub(crate) random: Value,
    /// Instead of `scene`: many draws, each with a state of its own.
    #[serde(default)]
    #[schemars(with = "StatesWire")]
    pub(crate) states: Value,
    /// Instead of `scene`: a scene that is drawn by a rendering method, whose picture is held against
    /// the truth. The file lies in `methods/<question>/<scene>.json` and has an axis `method`.
    #[serde(default)]
    #[schemars(with = "MethodWire")]
    pub(crate) method: Value,
    /// Methods only: the axis with numbers along which the methods' errors are followed.
    pub(crate) parameter: Option<String>,
    /// Changes to the scene, each of which is drawn too.
    #[serde(default)]
    pub(crate) variants: Vec<VariantWire>,
    /// What the frames of the variants have to do with the scene's own.
    #[serde(default)]
    #[schemars(with = "Option<RelationWire>")]
    pub(crate) relation: Value,
    /// Selftests only: changes to the scene, as JSON pointers and values, that the judge sees and
    /// the adapter does not. A Fail is then due.
    #[serde(default)]
    pub(crate) judged_as: BTreeMap<String, Value>,
    /// Literal values that must come back.
    #[serde(default)]
    #[schemars(with = "Vec<ExpectWire>")]
    pub(crate) expect: Value,
}

/// A scene that is made from a seed: the same in every run and every release.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RandomWire {
    /// What the scene is made of.
    pub(crate) flavor: Flavor,
    /// The seed.
    pub(crate) seed: u64,
}

/// A scene of many draws, each with a state and a place of its own.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct StatesWire {
    /// How many draws.
    pub(crate) count: u32,
    /// Width and height in texels.
    pub(crate) size: [u32; 2],
}

/// The scene again with some changes.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct VariantWire {
    /// Its name in records.
    pub(crate) name: String,
    /// JSON pointers into the scene and what stands there instead.
    #[serde(default)]
    pub(crate) patch: BTreeMap<String, Value>,
    /// JSON pointers to lists and the order in which their items stand instead.
    #[serde(default)]
    pub(crate) permute: BTreeMap<String, Vec<usize>>,
}

/// Frames, or attachments of one frame, that must be the same.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RelationWire {
    /// Why they must.
    pub(crate) same: Invariance,
    /// Left, top, width and height of the texels that are compared; without it, all.
    pub(crate) within: Option<[u32; 4]>,
    /// The colour channels that are compared, as letters of `rgba`.
    #[serde(default = "all_channels")]
    pub(crate) channels: String,
    /// How many texels the variants' pictures are moved to the right and down.
    #[serde(default)]
    pub(crate) offset: [i32; 2],
    /// Attachments of each frame that are compared with each other, instead of frames.
    #[serde(default)]
    pub(crate) attachments: Vec<String>,
}

/// Which cases of a product the quick profile takes: `"pairwise"`, `{ "each": n }`, `{ "first": n }` or
/// `{ "where": { axis: value } }`.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum QuickWire {
    /// So many that every two values of every two axes meet.
    Pairwise,
    /// So many that every value of every axis stands in this many, beside different others: for
    /// products of two long axes, of which pairs leave nothing out.
    Each(NonZeroUsize),
    /// So many from the first on: for seeds, of which one is as good as another.
    First(NonZeroUsize),
    /// Those in which these axes have the values of these names: for sizes that only a benchmark wants.
    Where(BTreeMap<String, String>),
}

/// The values of an axis: a list, or so many integers from one on.
#[derive(Clone, Debug)]
pub(crate) struct Axis(Vec<AxisValue>);

impl std::ops::Deref for Axis {
    type Target = [AxisValue];

    fn deref(&self) -> &[AxisValue] {
        &self.0
    }
}

/// So many integers from one on.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Count {
    from: u32,
    count: u16,
}

impl<'de> Deserialize<'de> for Axis {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
        use serde::de::{MapAccess, SeqAccess, Visitor};
        struct Values;
        impl<'de> Visitor<'de> for Values {
            type Value = Axis;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a list of values or {\"from\": …, \"count\": …}")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Axis, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(seq)).map(Axis)
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Axis, A::Error> {
                let range = Count::deserialize(MapAccessDeserializer::new(map))?;
                let all = (0..u64::from(range.count)).map(|i| {
                    let number = u64::from(range.from) + i;
                    AxisValue {
                        name: number.to_string(),
                        value: number.into(),
                    }
                });
                Ok(Axis(all.collect()))
            }
        }
        deserializer.deserialize_any(Values)
    }
}

impl JsonSchema for Axis {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Axis".into()
    }
    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let value = generator.subschema_for::<AxisValue>();
        let range = generator.subschema_for::<Count>();
        schemars::json_schema!({
            "description": "The values of an axis: a list, or so many integers from one on.",
            "anyOf": [{ "type": "array", "items": value }, range]
        })
    }
}

/// One value of an axis: a string, number or boolean, or a named value of any kind.
#[derive(Clone, Debug)]
pub(crate) struct AxisValue {
    pub(crate) name: String,
    pub(crate) value: Value,
}

impl<'de> Deserialize<'de> for AxisValue {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Named {
            name: String,
            value: Value,
        }
        use serde::de::Error;
        let value = Value::deserialize(deserializer)?;
        let name = match &value {
            Value::String(text) => text.clone(),
            Value::Bool(flag) => flag.to_string(),
            Value::Number(number) => match number.as_f64() {
                Some(float) if !number.is_i64() && !number.is_u64() => float.to_string(),
                _ => number.to_string(),
            },
            Value::Object(_) => {
                let named: Named = serde_json::from_value(value).map_err(D::Error::custom)?;
                return Ok(Self {
                    name: named.name,
                    value: named.value,
                });
            }
            Value::Null | Value::Array(_) => {
                return Err(D::Error::custom(
                    "an axis value is a string, number, boolean or {\"name\": …, \"value\": …}",
                ));
            }
        };
        Ok(Self { name, value })
    }
}

impl JsonSchema for AxisValue {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "AxisValue".into()
    }
    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({
            "description": "A value of an axis, or any value with a name for the id.",
            "anyOf": [
                { "type": ["string", "number", "boolean"] },
                {
                    "type": "object",
                    "properties": { "name": { "type": "string" }, "value": {} },
                    "required": ["name", "value"],
                    "additionalProperties": false
                }
            ]
        })
    }
}

/// A value that follows from an axis: the axis's own some places further on, so that two states differ
/// in every case, or one of a list beside the axis.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct DerivedWire {
    /// The axis.
    pub(crate) axis: String,
    /// How many values further on, past the end from the start again.
    #[serde(default)]
    pub(crate) shift: usize,
    /// As many values as the axis has, each instead of the axis's own.
    pub(crate) values: Option<Vec<Value>>,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SceneWire {
    /// Textures by name.
    pub(crate) attachments: BTreeMap<String, AttachmentWire>,
    /// Passes, in order.
    pub(crate) passes: Vec<PassWire>,
    /// The attachments to read back.
    pub(crate) read: Vec<String>,
    /// Counters by name; all are read back.
    #[serde(default)]
    pub(crate) counters: BTreeMap<String, CounterKind>,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct AttachmentWire {
    pub(crate) format: TextureFormat,
    /// Width and height in texels; without it, what the scene's other attachments say, or 16 by 16.
    pub(crate) size: Option<[u32; 2]>,
    /// Samples per texel.
    pub(crate) samples: Option<u32>,
    /// A list of four numbers for colour, a number for depth or for stencil alone, both for both.
    pub(crate) clear: Option<ClearWire>,
    /// Uploaded values, instead of a clear.
    pub(crate) texels: Option<TexelsWire>,
}

/// A clear value, whose form follows the format.
#[derive(Clone, Debug)]
pub(crate) enum ClearWire {
    Number(f64),
    Color([f32; 4]),
    DepthStencil(DepthStencilWire),
}

#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct DepthStencilWire {
    pub(crate) depth: f32,
    pub(crate) stencil: u8,
}

impl<'de> Deserialize<'de> for ClearWire {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        use serde::de::Error;
        let value = Value::deserialize(deserializer)?;
        match &value {
            Value::Number(number) => number
                .as_f64()
                .map(Self::Number)
                .ok_or_else(|| D::Error::custom("the number is too large")),
            Value::Array(_) => serde_json::from_value(value)
                .map(Self::Color)
                .map_err(D::Error::custom),
            Value::Object(_) => serde_json::from_value(value)
                .map(Self::DepthStencil)
                .map_err(D::Error::custom),
            _ => Err(D::Error::custom(
                "a clear value is a number, four numbers or {\"depth\": …, \"stencil\": …}",
            )),
        }
    }
}

impl JsonSchema for ClearWire {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Clear".into()
    }
    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let both = generator.subschema_for::<DepthStencilWire>();
        schemars::json_schema!({
            "anyOf": [
                { "type": "number" },
                { "type": "array", "items": { "type": "number" }, "minItems": 4, "maxItems": 4 },
                both
            ]
        })
    }
}

/// Uploaded values: integer codes for normalized formats, numbers for float formats.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum TexelsWire {
    /// One texel per column, the same in all rows.
    Columns {
        /// As many texels as the attachment is wide.
        values: Vec<[f64; 4]>,
    },
    /// One texel per row, the same in all columns.
    Rows {
        /// As many texels as the attachment is high.
        values: Vec<[f64; 4]>,
    },
    /// Every texel, row by row from the top.
    Grid {
        /// As many rows as the attachment is high, each of as many texels as it is wide.
        values: Vec<Vec<[f64; 4]>>,
    },
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PassWire {
    /// Names of the colour attachments.
    #[serde(default)]
    pub(crate) color: Vec<String>,
    /// Names of the attachments that the colour attachments are averaged to, `null` for none.
    #[serde(default)]
    pub(crate) resolve: Vec<Option<String>>,
    /// Name of the depth-stencil attachment.
    pub(crate) depth_stencil: Option<String>,
    /// Whether the pass promises to write neither depth nor stencil.
    #[serde(default)]
    pub(crate) depth_stencil_read_only: bool,
    /// Draws, in order.
    pub(crate) draws: Vec<DrawWire>,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct DrawWire {
    pub(crate) mesh: MeshSource,
    #[serde(default = "triangle_list")]
    pub(crate) topology: PrimitiveTopology,
    pub(crate) shader: Shader,
    #[serde(default)]
    pub(crate) params: ParamsWire,
    /// When the fragment tests happen.
    #[serde(default = "implicit")]
    pub(crate) early_tests: EarlyTests,
    /// Names of the attachments that the shader reads.
    #[serde(default)]
    pub(crate) textures: Vec<String>,
    /// How the shader samples its texture.
    pub(crate) sampler: Option<Sampler>,
    /// Names of the counters that the draw adds to.
    #[serde(default)]
    pub(crate) counters: Vec<String>,
    #[serde(default = "cull_none")]
    pub(crate) cull: CullMode,
    #[serde(default = "ccw")]
    pub(crate) front_face: FrontFace,
    #[serde(default = "fill")]
    pub(crate) polygon_mode: PolygonMode,
    #[serde(default)]
    pub(crate) rasterizer_discard: bool,
    /// Without it, the whole attachments and depths 0 to 1.
    pub(crate) viewport: Option<Viewport>,
    /// Left, top, width and height in texels; without it, everything.
    pub(crate) scissor: Option<[u32; 4]>,
    #[serde(default)]
    pub(crate) depth_bias: DepthBias,
    #[serde(default)]
    pub(crate) depth_clamp: bool,
    /// Least and greatest stored depth that lets fragments through; without it, off.
    pub(crate) depth_bounds: Option<[f32; 2]>,
    /// The depth test; without it, off.
    pub(crate) depth: Option<DepthState>,
    /// The stencil test; without it, off.
    pub(crate) stencil: Option<StencilWire>,
    /// Blending; without it, off.
    pub(crate) blend: Option<BlendState>,
    /// Written channels, as letters of `rgba`.
    #[serde(default = "all_channels")]
    pub(crate) write_mask: String,
    /// Blending and write mask of each colour attachment apart, instead of `blend` and `write_mask`.
    pub(crate) targets: Option<Vec<TargetWire>>,
    /// A logic operation instead of blending; without it, off.
    pub(crate) logic: Option<LogicOperation>,
    #[serde(default)]
    pub(crate) multisample: Multisample,
    /// The blend constant.
    #[serde(default)]
    pub(crate) blend_constant: Splat,
}

/// Blending and write mask of one colour attachment.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct TargetWire {
    pub(crate) blend: Option<BlendState>,
    #[serde(default = "all_channels")]
    pub(crate) write_mask: String,
}

fn implicit() -> EarlyTests {
    EarlyTests::Implicit
}

fn fill() -> PolygonMode {
    PolygonMode::Fill
}

fn triangle_list() -> PrimitiveTopology {
    PrimitiveTopology::TriangleList
}

fn cull_none() -> CullMode {
    CullMode::None
}

fn ccw() -> FrontFace {
    FrontFace::Ccw
}

fn all_channels() -> String {
    "rgba".to_owned()
}

#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ParamsWire {
    #[serde(default)]
    pub(crate) color: Splat,
    #[serde(default)]
    pub(crate) back_color: Splat,
}

/// The stencil test. Masks and reference hold for both faces unless a face has its own.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct StencilWire {
    pub(crate) front: StencilFaceWire,
    /// Without it, as the front.
    pub(crate) back: Option<StencilFaceWire>,
    #[serde(default = "all_bits")]
    pub(crate) read_mask: u8,
    #[serde(default = "all_bits")]
    pub(crate) write_mask: u8,
    #[serde(default)]
    pub(crate) reference: u8,
}

fn all_bits() -> u8 {
    0xff
}

#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct StencilFaceWire {
    pub(crate) compare: CompareFunction,
    #[serde(default = "keep")]
    pub(crate) fail_op: StencilOperation,
    #[serde(default = "keep")]
    pub(crate) depth_fail_op: StencilOperation,
    #[serde(default = "keep")]
    pub(crate) pass_op: StencilOperation,
    pub(crate) read_mask: Option<u8>,
    pub(crate) write_mask: Option<u8>,
    pub(crate) reference: Option<u8>,
}

fn keep() -> StencilOperation {
    StencilOperation::Keep
}

/// One literal colour that must come back.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ExpectWire {
    pub(crate) attachment: String,
    /// Column and row.
    pub(crate) texel: [u32; 2],
    /// The values, channel by channel, as the textbook gives them; the nearest code is meant.
    pub(crate) value: Vec<f64>,
}
