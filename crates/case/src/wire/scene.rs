//! The keys of a scene.

use super::fetch::{FetchWire, InstancesWire};
use super::tiles::TilesWire;
use etalon_frame::{CounterKind, TextureFormat};
use etalon_scene::{
    AdvancedBlend, BlendState, CompareFunction, CullMode, DepthBias, DepthState, EarlyTests,
    FrontFace, LogicOperation, MeshSource, Multisample, PassOperations, Path, PolygonMode, Pool,
    PrimitiveTopology, ProvokingVertex, QueryScope, ResolveMode, Sampler, Shader, Splat,
    StencilOperation, Tessellation, Viewport,
};
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;

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
    /// The part of the scene that one query encloses; the counts are the same.
    #[serde(default)]
    pub(crate) queries: QueryScope,
    /// The pool that fragment shaders fill and read.
    pub(crate) pool: Option<Pool>,
    /// The path on which the scene reaches the driver; it does not change the picture.
    #[serde(default)]
    pub(crate) path: Path,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct AttachmentWire {
    pub(crate) format: TextureFormat,
    /// Width and height in texels; by default those of the scene's other attachments, or 16 by 16.
    pub(crate) size: Option<[u32; 2]>,
    /// Samples per texel.
    pub(crate) samples: Option<u32>,
    /// A list of four numbers for colour, a number for depth or for stencil alone, an object for both.
    pub(crate) clear: Option<ClearWire>,
    /// Uploaded values, in place of a clear.
    pub(crate) texels: Option<TexelsWire>,
}

/// A clear value, whose form depends on the format.
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
        /// One texel per column.
        values: Vec<[f64; 4]>,
    },
    /// One texel per row, the same in all columns.
    Rows {
        /// One texel per row.
        values: Vec<[f64; 4]>,
    },
    /// Every texel, row by row from the top.
    Grid {
        /// All texels of the attachment, row by row.
        values: Vec<Vec<[f64; 4]>>,
    },
    /// Codes computed from the format, which distinguish rows, columns, channels and bits.
    Codes,
    /// Values beside the codes of another format, for a float format.
    BesideCodes(BesideCodesWire),
}

/// Values beside the codes of a format.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct BesideCodesWire {
    /// The format whose codes they are beside.
    pub(crate) of: TextureFormat,
    /// Parts of the distance to the next code, which take turns.
    pub(crate) by: Vec<f64>,
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PassWire {
    /// Names of the colour attachments.
    #[serde(default)]
    pub(crate) color: Vec<String>,
    /// Names of the attachments that the colour attachments are resolved to, `null` for none.
    #[serde(default)]
    pub(crate) resolve: Vec<Option<String>>,
    /// Name of the depth-stencil attachment.
    pub(crate) depth_stencil: Option<String>,
    /// True if the pass declares that it writes neither depth nor stencil.
    #[serde(default)]
    pub(crate) depth_stencil_read_only: bool,
    /// The resolve of depth and stencil at the end of the pass.
    pub(crate) depth_stencil_resolve: Option<DepthStencilResolveWire>,
    /// Load and store operations; by default, everything is loaded and stored.
    #[serde(default)]
    pub(crate) operations: PassOperations,
    /// Clear commands, in order.
    #[serde(default)]
    pub(crate) clears: Vec<ClearCommandWire>,
    /// Draws, in order.
    pub(crate) draws: Vec<DrawWire>,
}

/// A resolve of depth and stencil.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct DepthStencilResolveWire {
    /// Name of the attachment that it writes.
    pub(crate) to: String,
    #[serde(default = "no_resolve")]
    pub(crate) depth: ResolveMode,
    #[serde(default = "no_resolve")]
    pub(crate) stencil: ResolveMode,
}

fn no_resolve() -> ResolveMode {
    ResolveMode::None
}

/// A clear command: of one colour attachment, of depth, of stencil, or of depth and stencil together.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ClearCommandWire {
    /// The index of the draw before which it is executed; the number of draws for the end of the pass.
    pub(crate) before: usize,
    /// The location of a colour attachment in the pass; requires `value`.
    pub(crate) color: Option<usize>,
    /// Red, green, blue and alpha of a colour.
    pub(crate) value: Option<[f32; 4]>,
    /// Instead of `value`: one clear for each texel, to its own value.
    pub(crate) values: Option<BesideCodesWire>,
    /// A depth.
    pub(crate) depth: Option<f32>,
    /// A stencil value.
    pub(crate) stencil: Option<u8>,
    /// Left, top, width and height in texels; by default, everything.
    pub(crate) rect: Option<[u32; 4]>,
    /// Written channels, as letters of `rgba`; `false` for depth; bits of stencil; an object for depth and
    /// stencil.
    pub(crate) write_mask: Option<ClearMaskWire>,
}

/// The mask of a clear command, whose form depends on what is cleared.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum ClearMaskWire {
    Channels(String),
    Depth(bool),
    Stencil(u8),
    Both { depth: bool, stencil: u8 },
}

#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct DrawWire {
    pub(crate) mesh: MeshSource,
    /// The factors of the vertices' positions, repeated as needed: they become the w of positions with w 1. A
    /// positive factor does not move a vertex in the picture.
    #[serde(default = "unit_w")]
    pub(crate) w: Vec<f32>,
    /// The route by which the mesh's vertices reach the pipeline.
    #[serde(default)]
    pub(crate) fetch: FetchWire,
    /// Instances of the mesh; by default, one without a colour of its own.
    pub(crate) instances: Option<InstancesWire>,
    /// Repeats the draw once for each tile of the attachments.
    pub(crate) tiles: Option<TilesWire>,
    #[serde(default = "triangle_list")]
    pub(crate) topology: PrimitiveTopology,
    /// Patches of three vertices with all levels 1; by default, no tessellation.
    pub(crate) tessellation: Option<Tessellation>,
    /// The vertex whose attributes are flat over a primitive; by default, either.
    pub(crate) provoking: Option<ProvokingVertex>,
    pub(crate) shader: Shader,
    #[serde(default)]
    pub(crate) params: ParamsWire,
    /// The order of fragment tests and fragment shader.
    #[serde(default = "implicit")]
    pub(crate) early_tests: EarlyTests,
    /// Names of the attachments that the shader reads.
    #[serde(default)]
    pub(crate) textures: Vec<String>,
    /// The sampler of the shader's texture.
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
    /// The viewport; by default, the whole attachments and depths 0 to 1.
    pub(crate) viewport: Option<Viewport>,
    /// Left, top, width and height in texels; by default, everything.
    pub(crate) scissor: Option<[u32; 4]>,
    /// Bits of the shader's enabled clip distances; by default, all.
    #[serde(default = "all_bits")]
    pub(crate) clip_distances: u8,
    #[serde(default)]
    pub(crate) depth_bias: DepthBias,
    #[serde(default)]
    pub(crate) depth_clamp: bool,
    /// The least and the greatest stored depth for which fragments pass; off by default.
    pub(crate) depth_bounds: Option<[f32; 2]>,
    /// The depth test; off by default.
    pub(crate) depth: Option<DepthState>,
    /// The stencil test; off by default.
    pub(crate) stencil: Option<StencilWire>,
    /// Blending; off by default.
    pub(crate) blend: Option<BlendState>,
    /// Advanced blending of the only colour attachment, in place of `blend`; off by default.
    pub(crate) advanced_blend: Option<AdvancedBlend>,
    /// Written channels, as letters of `rgba`.
    #[serde(default = "all_channels")]
    pub(crate) write_mask: String,
    /// Blending and write mask of each colour attachment separately, in place of `blend` and `write_mask`.
    pub(crate) targets: Option<Vec<TargetWire>>,
    /// A logic operation, under which nothing is blended; off by default.
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

fn unit_w() -> Vec<f32> {
    vec![1.0]
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

pub(super) fn all_channels() -> String {
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

/// The stencil test. Masks and reference apply to both faces unless a face has its own.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct StencilWire {
    pub(crate) front: StencilFaceWire,
    /// The back face; by default, like the front face.
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
