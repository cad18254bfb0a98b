//! The messages of a program, and the schema of all messages.

use crate::scene::Request;
use crate::shaders::ShaderLanguage;
use etalon_backend::BackendError;
use etalon_frame::{Api, ApiVersion, Aspect, Feature, TextureFormat};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};

/// The version of the protocol.
pub const PROTOCOL: u32 = 1;

/// The first line of a program: the device, and what it can draw.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hello {
    /// The version of the protocol: 1.
    pub protocol: u32,
    /// The device.
    pub device: String,
    /// The driver or renderer.
    pub driver: String,
    /// Its version.
    #[serde(default)]
    pub driver_version: String,
    /// True if the device is the processor.
    #[serde(default)]
    pub software: bool,
    /// The API whose rules bind the frames.
    pub rules: RulesApi,
    /// The version of that API, such as `1.3`.
    #[serde(default)]
    #[schemars(with = "Option<String>")]
    pub version: ApiVersion,
    /// Bits of sub-pixel precision in vertex positions, at least 4.
    #[serde(default = "least_sub_pixel_bits")]
    pub sub_pixel_bits: u8,
    /// The largest width and height of an attachment.
    pub max_size: u32,
    /// The largest number of colour attachments in a pass.
    pub max_color_attachments: u32,
    /// The formats that attachments can have.
    pub formats: BTreeMap<TextureFormat, FormatOffer>,
    /// The optional features that scenes can use.
    #[serde(default)]
    pub features: BTreeSet<Feature>,
    /// Sample positions per sample count, in 1/256 texel from the top left corner; by default the standard ones.
    #[serde(default)]
    pub sample_positions: BTreeMap<u32, Vec<[u16; 2]>>,
    /// The languages in which scenes bring their shaders.
    #[serde(default = "wgsl")]
    pub shaders: BTreeSet<ShaderLanguage>,
}

fn least_sub_pixel_bits() -> u8 {
    4
}

fn wgsl() -> BTreeSet<ShaderLanguage> {
    [ShaderLanguage::Wgsl].into()
}

/// The API whose rules bind frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RulesApi {
    /// Vulkan.
    Vulkan,
    /// OpenGL, core profile.
    #[serde(rename = "opengl")]
    OpenGl,
    /// OpenGL ES.
    #[serde(rename = "opengl-es")]
    OpenGlEs,
    /// WebGPU.
    #[serde(rename = "webgpu")]
    WebGpu,
}

impl From<Api> for RulesApi {
    fn from(api: Api) -> Self {
        match api {
            Api::Vulkan => Self::Vulkan,
            Api::OpenGl => Self::OpenGl,
            Api::OpenGlEs => Self::OpenGlEs,
            Api::WebGpu => Self::WebGpu,
        }
    }
}

impl From<RulesApi> for Api {
    fn from(api: RulesApi) -> Self {
        match api {
            RulesApi::Vulkan => Self::Vulkan,
            RulesApi::OpenGl => Self::OpenGl,
            RulesApi::OpenGlEs => Self::OpenGlEs,
            RulesApi::WebGpu => Self::WebGpu,
        }
    }
}

/// The support of a format.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FormatOffer {
    /// Sample counts of attachments that can be drawn to, such as `[1, 4]`.
    pub samples: Vec<u32>,
    /// True if attachments can be blended into.
    #[serde(default)]
    pub blendable: bool,
}

/// The answer to a request: exactly one of `frame`, `unsupported` and `error`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Answer {
    /// The number of the request.
    pub number: u64,
    /// What was drawn.
    pub frame: Option<FrameAnswer>,
    /// What the scene needs and the program does not have, such as `triangle fans`.
    pub unsupported: Option<String>,
    /// The failure.
    pub error: Option<DrawFailure>,
    /// The time until the device was done, in seconds; without it, the whole exchange is timed.
    pub seconds: Option<f64>,
}

/// A drawn frame.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrameAnswer {
    /// All aspects of the attachments in `read`, in this order, depth before stencil.
    pub images: Vec<ImageAnswer>,
    /// The values of the scene's counters, in their order.
    #[serde(default)]
    pub counters: Vec<u64>,
}

/// One aspect of an attachment.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ImageAnswer {
    /// The attachment's name.
    pub attachment: String,
    /// The aspect.
    pub aspect: Aspect,
    /// Texels in base64: rows from the top, texels from the left, the samples of a texel after each other. A colour
    /// has the little-endian bytes of its format in WebGPU, depth is a 32-bit float, stencil one byte.
    pub texels: String,
}

/// A failure to draw.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DrawFailure {
    /// The kind of the failure.
    pub kind: DrawFailureKind,
    /// What happened, in the driver's words.
    #[serde(default)]
    pub message: String,
}

/// The kind of a failure.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DrawFailureKind {
    /// The device was lost.
    DeviceLost,
    /// The device refused memory or an object.
    Resource,
    /// A shader was refused.
    Shader,
    /// Any other failure.
    Internal,
}

impl From<DrawFailure> for BackendError {
    fn from(DrawFailure { kind, message }: DrawFailure) -> Self {
        match kind {
            DrawFailureKind::DeviceLost => Self::lost(message),
            DrawFailureKind::Resource => Self::refused("an object", message),
            DrawFailureKind::Shader => Self::shader("of the scene", message),
            DrawFailureKind::Internal => Self::internal_of("the program failed", message),
        }
    }
}

/// Returns the JSON schema of the protocol: a line is any of its three messages.
pub fn schema() -> Value {
    let mut generator = schemars::SchemaGenerator::default();
    let messages = [
        generator.subschema_for::<Hello>(),
        generator.subschema_for::<Request<'_>>(),
        generator.subschema_for::<Answer>(),
    ];
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "A line of etalon's open protocol",
        "anyOf": messages,
        "$defs": generator.take_definitions(true),
    })
}
