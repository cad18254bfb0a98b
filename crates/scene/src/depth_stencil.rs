//! Depth and stencil tests.

use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// A depth or stencil comparison: incoming (reference) value on the left, stored on the right.
    CompareFunction {
        /// Never true.
        Never = "never",
        /// Incoming below stored.
        Less = "less",
        /// Incoming equals stored.
        Equal = "equal",
        /// Incoming not above stored.
        LessEqual = "less-equal",
        /// Incoming above stored.
        Greater = "greater",
        /// Incoming differs from stored.
        NotEqual = "not-equal",
        /// Incoming not below stored.
        GreaterEqual = "greater-equal",
        /// Always true.
        Always = "always",
    }
}

/// The depth test of a draw. A draw without one neither tests nor writes depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DepthState {
    /// The comparison, incoming depth on the left.
    pub compare: CompareFunction,
    /// True if passing fragments store their depth.
    pub write: bool,
}

impl DepthState {
    /// A test that always fails.
    pub const REJECTING: Self = Self {
        compare: CompareFunction::Never,
        write: true,
    };
}

/// The depth bias of a polygon: `constant * r + slope * m`, where `r` is the least step of the attachment's
/// depth and `m` the polygon's steepest slope, then limited by `clamp` unless that is 0. Off if all three are
/// 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DepthBias {
    /// The constant term in least steps; WebGPU requires an integer.
    pub constant: i32,
    /// The factor of the polygon's slope.
    pub slope: f32,
    /// The upper limit of the bias if positive, the lower limit if negative.
    pub clamp: f32,
}

state_enum! {
    /// An operation on a stored stencil value.
    StencilOperation {
        /// Unchanged.
        Keep = "keep",
        /// Set to 0.
        Zero = "zero",
        /// Set to the reference.
        Replace = "replace",
        /// Inverts all bits.
        Invert = "invert",
        /// Plus one, clamped to the largest value.
        IncrementClamp = "increment-clamp",
        /// Minus one, clamped to 0.
        DecrementClamp = "decrement-clamp",
        /// Plus one, the largest value becoming 0.
        IncrementWrap = "increment-wrap",
        /// Minus one, 0 becoming the largest value.
        DecrementWrap = "decrement-wrap",
    }
}

/// The stencil test of a draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
pub struct StencilState {
    /// The test for front faces.
    pub front: StencilFace,
    /// The test for back faces.
    pub back: StencilFace,
}

/// The stencil test for one face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
pub struct StencilFace {
    /// The comparison: masked reference on the left, masked stored value on the right.
    pub compare: CompareFunction,
    /// The operation if the stencil test fails.
    pub fail_op: StencilOperation,
    /// The operation if the stencil test passes and the depth test fails.
    pub depth_fail_op: StencilOperation,
    /// The operation if both pass.
    pub pass_op: StencilOperation,
    /// The bits of reference and stored value that are compared.
    pub read_mask: u8,
    /// The bits that an operation can change.
    pub write_mask: u8,
    /// The value on the left of the comparison, which `replace` stores.
    pub reference: u8,
}

impl StencilFace {
    /// A test that always fails, and an operation that changes all bits.
    pub const REJECTING: Self = Self {
        compare: CompareFunction::Never,
        fail_op: StencilOperation::Invert,
        depth_fail_op: StencilOperation::Invert,
        pass_op: StencilOperation::Invert,
        read_mask: 0xff,
        write_mask: 0xff,
        reference: 0,
    };
}
