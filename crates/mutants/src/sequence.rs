//! Bugs of sequences: what draws, clears, passes and submissions leave to the next, contents that an
//! attachment loses between passes, and queries that get each other's values.

mod clears;
mod contents;
mod counts;
mod passes;

use crate::list::List;
use crate::stale;

pub(super) fn add(list: &mut List) {
    list.class("sequence", "sequence");
    stale::reset(list);
    passes::add(list);
    contents::add(list);
    clears::add(list);
    counts::add(list);
    list.source("lavapipe, ANGLE, wgpu: a change that is not tracked");
    stale::stays(list);
}
