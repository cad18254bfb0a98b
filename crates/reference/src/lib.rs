//! The reference: the values that the specifications allow at every sample of a scene.
//!
//! [`legal_set()`] walks a scene sample by sample with the judging number system ([`Judging`]) and returns a
//! [`LegalSet`](etalon_frame::LegalSet) per band; [`explain`] returns the story of one sample. A sample is
//! followed through worlds, not through one hull: a texel on an edge is covered or it is not, and no value in
//! between is legal. The permissions are data in [`rules`], with their citations.

mod bias;
mod bins;
mod clause;
mod clip;
mod contents;
mod context;
mod counting;
mod coverage;
mod cut;
mod depth;
mod depth_resolve;
mod distance;
mod fit;
mod fragment;
mod fragment_notes;
mod geometry;
mod input_mask;
mod interval;
mod judging;
mod known_sets;
mod legal_sets;
mod line_shape;
mod lines;
mod notes;
mod pass_operations;
mod picture;
mod possible;
mod primitive;
mod range;
mod read_back;
mod readings;
mod rejections;
mod rounding;
pub mod rules;
mod ruling;
mod sample;
mod sample_state;
mod sampling;
mod scene_key;
mod setup;
mod setups;
mod sides;
mod signature;
mod snap;
mod states;
mod stencil_face;
mod store;
mod strokes;
#[cfg(test)]
mod test_limits;
mod texels;
mod undefined;
mod varying;
mod vertex;
mod viewport_bounds;
mod walk;
mod world;

pub use fit::{FittedRules, fit};
pub use geometry::Geometries;
pub use interval::Interval;
pub use judging::Judging;
pub use known_sets::KnownSets;
pub use legal_sets::{
    Judgement, Sets, explain, judgements, judgements_by, judgements_of, legal_set,
    legal_set_of_texels, set_by, shared_sets,
};
pub use lines::{LineGap, counts_lines, line_gap};
pub use range::Range;
pub use rules::{Permission, Rules};
pub use sample::Sample;
pub use scene_key::SceneKey;
pub use texels::Texels;
