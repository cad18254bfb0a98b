//! Texel formats, frames, limits, features, legal sets and their comparison.
//!
//! This crate has the types that all other crates share, and no arithmetic of the pipeline: what a texel
//! consists of ([`TextureFormat`], [`ChannelEncoding`]), what came back from a device ([`Frame`]), what an
//! adapter can do ([`Limits`], [`Feature`]), what the rules allow ([`LegalSet`]), and how frames are compared
//! with that ([`compare()`]).

#![cfg_attr(
    test,
    expect(clippy::unwrap_used, reason = "a test that panics has failed")
)]

mod accuracy;
mod adapter_info;
mod adapter_name;
mod api;
mod band;
mod case_id;
mod code_bytes;
mod compare;
mod contents;
mod counter;
mod device_offer;
mod distance;
mod encoding;
mod error_kind;
mod event;
mod feature;
mod format;
mod grade;
mod image;
mod legal;
mod limit_error;
mod limits;
mod message;
mod names;
mod operation;
mod path;
mod property;
mod samples;
mod split_mix;
mod story;
pub mod threads;
mod version;
mod work;

pub use accuracy::{Accuracy, Spread, accuracy};
pub use adapter_info::AdapterInfo;
pub use adapter_name::AdapterName;
pub use api::Api;
pub use band::Band;
pub use case_id::CaseId;
pub use compare::{ChannelMismatch, Comparison, TexelCounts, WrongTexel, compare};
pub use contents::{Codes, Contents, ValueRange};
pub use counter::{CountRange, CounterKind, CounterOutcome, CounterSet};
pub use device_offer::DeviceOffer;
pub use distance::{Distance, SizedDistance};
pub use encoding::{ChannelEncoding, linear_of_half_codes, linear_to_srgb, srgb_to_linear};
pub use error_kind::ErrorKind;
pub use event::{
    BlendedChannel, Coverage, DepthTest, Effect, Event, Origin, Rejection, ResolveChoice,
    SceneName, Side, Step, Target,
};
pub use feature::Feature;
pub use format::{Aspect, TextureFormat};
pub use grade::Grade;
pub use image::{Frame, FrameError, Image, ReadPath};
pub use legal::{
    AspectStatistics, CodeInterval, ImageInfo, LegalSet, LegalSetBuilder, SampleGroup, TexelSet,
    WorldBox,
};
pub use limit_error::{LimitError, MAX_SUB_PIXEL_BITS};
pub use limits::{FormatSupport, Limits, Requirement};
pub use message::{is_hidden, printable, shortened, without_mark};
pub use operation::Operation;
pub use path::{
    PathArea, PathClears, PathClip, PathColors, PathCommands, PathDraws, PathEnd, PathLayers,
    PathPass, PathReads, PathResolves, PathResults, PathStart, PathState, PathTarget, PathTests,
    PathValue, PathViewport, PathViews,
};
pub use property::Property;
pub use samples::standard_sample_positions;
pub use split_mix::{SplitMix64, mix};
pub use story::{
    Allowed, ContentSource, DecidingStep, Demand, Initial, Returned, Ruling, Story, ToldLine,
    Values,
};
pub use version::ApiVersion;
pub use work::Work;
