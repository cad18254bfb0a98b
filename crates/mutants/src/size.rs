//! Bugs of size: tiles, edges, batches and counts that small pictures do not reach.

use super::list::List;

mod batches;
mod clears;
mod copies;
mod edges;
mod extent;

/// The sides of tiles, in texels.
const TILES: [u32; 4] = [8, 16, 32, 64];

pub(super) fn add(list: &mut List) {
    list.class("size", "size");
    extent::add(list);
    edges::add(list);
    clears::add(list);
    copies::add(list);
    batches::add(list);
}
