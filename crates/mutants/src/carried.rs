//! Bugs of sequences: what clears, passes and submissions carry from one to the next, beside the states of
//! draws.

use super::list::List;

mod clears;
mod contents;
mod counts;
mod passes;
mod states;

pub(super) fn add(list: &mut List) {
    list.class("sequence", "sequence");
    states::add(list);
    passes::add(list);
    contents::add(list);
    clears::add(list);
    counts::add(list);
}
