//! The calls that a backend made to draw and read one scene, as data.

use etalon_frame::{Aspect, ChannelEncoding};
use serde::{Deserialize, Serialize};

/// The calls of one scene, and where its texels and counts came back.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recording {
    /// The context in which the calls were made.
    pub context: RecordedContext,
    /// The calls in order, without queries of errors and limits.
    pub calls: Vec<RecordedCall>,
    /// The images that were read.
    pub images: Vec<RecordedImage>,
    /// The counters, in the order of the scene's counters.
    pub counters: Vec<RecordedCounter>,
}

/// The context of recorded calls.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum RecordedContext {
    /// An EGL context without a surface.
    Egl {
        /// True for OpenGL ES.
        es: bool,
        /// The major and minor version.
        version: [u32; 2],
        /// The EGL library, if it is not the system's.
        library: Option<String>,
        /// The index of the EGL device; `None` for the surfaceless platform.
        device: Option<u32>,
    },
    /// A Vulkan device; the recorded calls create the rest.
    Vulkan {
        /// The device's name.
        device: String,
        /// The Vulkan version that the instance requests.
        version: u32,
        /// The abilities that the device must have in addition to features and extensions.
        needs: VulkanNeeds,
    },
    /// A wgpu device.
    Wgpu {
        /// The API under wgpu: `vulkan` or `gl`.
        api: String,
        /// The adapter's name.
        device: String,
        /// The features that the device has, by wgpu's names.
        features: Vec<String>,
        /// The list of calls, as JSON of `etalon-webgpu`.
        list: String,
    },
}

/// The abilities of a Vulkan device that a scene needs and that no feature or extension expresses.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct VulkanNeeds {
    /// The formats that are blended into, as `VkFormat`.
    pub blended: Vec<u32>,
    /// The modes in which depth is resolved, as `VkResolveModeFlags`.
    pub depth_resolve: u32,
    /// The modes in which stencil is resolved, as `VkResolveModeFlags`.
    pub stencil_resolve: u32,
    /// True if depth and stencil are resolved in different modes.
    pub independent_resolve: bool,
    /// True if one of depth and stencil is resolved and the other is not.
    pub independent_resolve_none: bool,
}

/// The part of a scene's work that a call belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Phase {
    /// Creating objects and uploading data.
    Prepare,
    /// Drawing.
    Submit,
    /// Reading back.
    Read,
}

/// A recorded call.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RecordedCall {
    /// The part of the work that the call belongs to.
    pub phase: Phase,
    /// The function's name in the API.
    pub function: String,
    /// The call's arguments.
    pub arguments: Vec<Argument>,
    /// The new object or location that the call returns, if later calls can use it.
    pub result: Option<Argument>,
}

/// The value of an argument.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Argument {
    /// A 32-bit signed integer.
    Integer(i32),
    /// A 32-bit unsigned integer.
    Unsigned(u32),
    /// A boolean.
    Boolean(bool),
    /// A size or an offset, as wide as an address.
    Size(i64),
    /// The bits of an `f32`.
    Float(u32),
    /// The bits of an `f64`.
    Double(u64),
    /// A constant of the API.
    Constant(Constant),
    /// A bit mask of these constants.
    Bits(Vec<Constant>),
    /// An object of a kind, by the API's number, or 0. An earlier call created it.
    Object(String, u64),
    /// The memory in which the call stores the numbers of new objects of a kind.
    Created(String, Vec<u64>),
    /// The address of these bytes.
    Bytes(Vec<u8>),
    /// The address of these values, which are of one kind.
    Array(Vec<Argument>),
    /// A zero-terminated string.
    Text(String),
    /// An offset, passed as an address.
    Offset(u64),
    /// A null address.
    Null,
    /// Memory of the program that the driver writes: its number in the [`Recording`], and its size in bytes.
    Output(u32, u64),
    /// Values stored inline, which are of one kind.
    Values(Vec<Argument>),
    /// A structure.
    Struct {
        /// The name of the structure's type.
        kind: String,
        /// The structure's size in bytes.
        size: u64,
        /// The members in order.
        members: Vec<Member>,
    },
}

/// A member of a structure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Member {
    /// The member's name.
    pub name: String,
    /// The member's value.
    pub value: Argument,
}

/// A constant of an API.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Constant {
    /// The name, or empty if the backend has no name for the value.
    pub name: String,
    /// The value.
    pub value: u32,
}

/// An image of a scene, as it was read back.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RecordedImage {
    /// The attachment.
    pub attachment: String,
    /// The aspect.
    pub aspect: Aspect,
    /// The encodings of the image's channels.
    pub channels: Vec<ChannelEncoding>,
    /// Width and height.
    pub size: [u32; 2],
    /// The planes of texels, one per sample.
    pub planes: Vec<RecordedPlane>,
}

/// The texels of one sample in memory that calls wrote: rows from the top, without gaps.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RecordedPlane {
    /// The number of the memory.
    pub output: u32,
    /// The size of a texel in bytes.
    pub texel: u32,
    /// The first bit and the number of bits of each channel in a texel, which is a little-endian number.
    pub channels: Vec<[u32; 2]>,
    /// The form of the numbers.
    pub form: NumberForm,
}

/// The form of a number that was read back, which determines its code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum NumberForm {
    /// The number is the code.
    Code,
    /// The code was widened to a byte.
    Byte,
    /// The number is the code's value as the bits of an `f32`.
    Float,
    /// The number is the code divided by the largest code, as the bits of an `f32`: sRGB that is read without
    /// conversion.
    Fraction,
}

/// A counter of a scene, as it was read back.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RecordedCounter {
    /// The parts whose sum is the counter.
    pub parts: Vec<CounterPart>,
    /// True if each part, and the sum, count as at most 1.
    pub any: bool,
}

/// A part of a counter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CounterPart {
    /// The number of the memory.
    pub output: u32,
    /// The offset of the number in the memory, in bytes.
    pub offset: u32,
    /// The size of the little-endian number: 4 or 8 bytes.
    pub bytes: u32,
}
