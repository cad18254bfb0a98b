//! The shape of a case file.
//!
//! These types only parse: the scene model has no defaults, and its types need not follow the file's
//! spelling.

mod axis;
pub(crate) mod changes;
mod fetch;
mod file;
mod scene;
mod tiles;

pub(crate) use axis::AxisValue;
pub(crate) use fetch::{FetchWire, InstancesWire};
pub(crate) use file::{
    Across, ExpectWire, FileWire, QuickWire, RandomWire, RelationWire, SceneSource, SequenceWire,
    StatesWire, VariantWire,
};
pub(crate) use scene::{
    AttachmentWire, ClearCommandWire, ClearMaskWire, ClearWire, DepthStencilResolveWire, DrawWire,
    PassWire, SceneWire, StencilFaceWire, StencilWire, TexelsWire,
};
pub(crate) use tiles::{TileBy, TilesWire};
