//! Rendering methods: ways to draw one scene that differ in accuracy and time.
//!
//! A question (transparency, anti-aliasing, …) has scenes and methods. A method turns one of its scenes
//! into passes and draws of the common scene model, so that it is written once and every backend draws the
//! same. The scene also gives the [`Truth`]: the geometry that should be seen, which does not depend on the
//! method.

mod accumulation;
mod anti_aliasing;
mod claim;
#[cfg(test)]
mod corners;
mod culling;
mod cut_outs;
mod depth_precision;
mod depth_shown;
mod error;
mod grid;
mod hashed_plane;
mod lesson;
mod method;
mod method_scene;
mod model;
mod noise;
mod order;
mod polygon;
mod question;
mod seen_model;
mod sizes;
mod stage;
mod stencil_effects;
#[cfg(test)]
mod tests;
mod texture_sampling;
mod transparency;
mod truth;
#[cfg(test)]
mod validity;
mod view;
mod visibility_cost;

pub use claim::{Claim, ClaimedValues, FigureCondition, Quantity, Test};
pub use error::ParameterError;
pub use lesson::Lesson;
pub use method::{Method, MethodParameter};
pub use method_scene::MethodScene;
pub use model::{MOST_TRIANGLES, Model};
pub use order::Order;
pub use question::{MethodWire, QUESTIONS, claims, lessons, make, order};
pub use seen_model::ModelTriangle;
pub use sizes::at_size;
pub use truth::{FlatSurface, Paint, StraightTexture, TexelCoverage, Truth};
pub use view::{Camera, Lens};
