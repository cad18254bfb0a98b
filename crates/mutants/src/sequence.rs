//! Bugs of sequences: state that draws, clears, passes and submissions leave to the next, contents that an
//! attachment loses between passes, and queries that get each other's values.

mod clears;
mod contents;
mod counts;
mod passes;

use crate::list::bugs;
use crate::stale;

bugs! {
    class "sequence", "sequence";
    also stale::reset;
    also passes::add;
    also contents::add;
    also clears::add;
    also counts::add;
    source "lavapipe, ANGLE, wgpu: a change that is not tracked";
    also stale::stays;
}
