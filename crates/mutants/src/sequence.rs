//! Bugs of sequences: what a draw or a pass leaves to the next, on the same attachments and on others.

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
