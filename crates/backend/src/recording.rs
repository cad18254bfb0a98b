//! The calls that a backend made to draw and read one scene, as data.

use etalon_frame::{Aspect, ChannelEncoding};
use serde::{Deserialize, Serialize};

/// The calls of one scene, and where its texels and counts came back.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recording {
    /// The context in which they were made.
    pub context: RecordedContext,
    /// The calls in their order. Queries of errors and limits are left out.
    pub calls: Vec<Call>,
    /// The images that were read.
    pub images: Vec<RecordedImage>,
    /// The counters, in the order of the scene's.
    pub counters: Vec<RecordedCounter>,
}

/// The context of recorded calls.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum RecordedContext {
    /// A context of EGL without a surface.
    Egl {
        /// True for OpenGL ES.
        es: bool,
        /// Major and minor version.
        version: [u32; 2],
        /// The EGL library, if it is not the system's.
        library: Option<String>,
        /// The index of the EGL device; `None` for the platform without a surface.
        device: Option<u32>,
    },
    /// A device of Vulkan, and all that is made of it.
    Vulkan {
        /// The device's name.
        device: String,
        /// The version of Vulkan that the instance asks for.
        version: u32,
        /// The abilities that the device must have besides features and extensions.
        needs: VulkanNeeds,
    },
    /// A device of wgpu.
    Wgpu {
        /// The backend of wgpu: `vulkan` or `gl`.
        api: String,
        /// The adapter's name.
        device: String,
        /// The features that the device has, by wgpu's names.
        features: Vec<String>,
        /// The list of calls, as JSON of `etalon-webgpu`.
        list: String,
    },
}

/// The abilities of a device of Vulkan that a scene needs and that no feature or extension stands for.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct VulkanNeeds {
    /// The formats that are blended into, as `VkFormat`.
    pub blended: Vec<u32>,
    /// The modes in which depth is resolved, as `VkResolveModeFlags`.
    pub depth_resolve: u32,
    /// The modes in which stencil is resolved.
    pub stencil_resolve: u32,
    /// True if depth and stencil are resolved in different modes.
    pub independent_resolve: bool,
    /// True if one of them is not resolved.
    pub independent_resolve_none: bool,
}

/// The part of a scene's work that a call belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Phase {
    /// Creating objects and uploading.
    Prepare,
    /// Drawing.
    Submit,
    /// Reading back.
    Read,
}

/// One call.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Call {
    /// The part of the work.
    pub phase: Phase,
    /// The function's name in the API.
    pub function: String,
    /// Its arguments.
    pub arguments: Vec<Argument>,
    /// The new object or place that it returns, if later calls may use it.
    pub result: Option<Argument>,
}

/// The value of an argument.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Argument {
    /// A signed integer of 32 bits.
    Integer(i32),
    /// An unsigned integer of 32 bits.
    Unsigned(u32),
    /// True or false.
    Boolean(bool),
    /// A size or an offset, as wide as an address.
    Size(i64),
    /// The bits of an `f32`.
    Float(u32),
    /// The bits of an `f64`.
    Double(u64),
    /// A constant of the API.
    Constant(Constant),
    /// The bits of these constants.
    Bits(Vec<Constant>),
    /// The object of a kind that an earlier call made, by the API's number; 0 is none.
    Object(String, u64),
    /// The place where the call stores the numbers of new objects of a kind.
    Created(String, Vec<u64>),
    /// An address of these bytes.
    Bytes(Vec<u8>),
    /// An address of these values, all of one kind.
    Array(Vec<Argument>),
    /// A text that ends with a zero byte.
    Text(String),
    /// An offset, passed as an address.
    Offset(u64),
    /// No address.
    Null,
    /// Memory of the program that the driver writes to, by its number in [`Recording`], and its size in bytes.
    Output(u32, u64),
    /// Values in place, all of one kind.
    Values(Vec<Argument>),
    /// A structure.
    Struct {
        /// The name of its type.
        kind: String,
        /// Its size in bytes.
        size: u64,
        /// Its members, in their order.
        members: Vec<Member>,
    },
}

/// A member of a structure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Member {
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: Argument,
}

/// A constant of an API.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Constant {
    /// The name; empty if the backend has none for the value.
    pub name: String,
    /// The value.
    pub value: u32,
}

/// An image of a scene, as it came back.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RecordedImage {
    /// The attachment.
    pub attachment: String,
    /// The aspect.
    pub aspect: Aspect,
    /// The encodings of its channels.
    pub channels: Vec<ChannelEncoding>,
    /// Width and height.
    pub size: [u32; 2],
    /// One plane of texels for each sample.
    pub planes: Vec<Plane>,
}

/// The texels of one sample in memory that calls wrote, rows from the top, without gaps.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Plane {
    /// The number of the memory.
    pub output: u32,
    /// The size of a texel in bytes.
    pub texel: u32,
    /// Of each channel, the first bit in the texel, a little-endian number, and the number of bits.
    pub channels: Vec<[u32; 2]>,
    /// The form of the numbers there.
    pub form: Form,
}

/// The form of a number that came back, of which a code is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Form {
    /// It is the code.
    Code,
    /// The code was widened to a byte.
    Byte,
    /// It is the code's value as the bits of an `f32`.
    Float,
    /// It is the code's share of the greatest code as the bits of an `f32`: sRGB that is read without conversion.
    Fraction,
}

/// A counter of a scene, as it came back.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RecordedCounter {
    /// The parts that it is the sum of: memory and the first byte there, little-endian numbers of 4 or 8 bytes.
    pub parts: Vec<CounterPart>,
    /// True if each part counts as 1 at most, and so does their sum.
    pub any: bool,
}

/// A part of a counter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CounterPart {
    /// The number of the memory.
    pub output: u32,
    /// The first byte.
    pub offset: u32,
    /// 4 or 8.
    pub bytes: u32,
}
