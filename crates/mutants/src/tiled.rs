//! Bugs of large pictures: tiles that draws, clears and resolves leave out, edges where tiles end, and numbers
//! of draws and primitives where batches end.

use super::list::List;

mod batches;
mod clears;
mod copies;
mod edges;
mod extent;
mod tiles;

pub(super) fn add(list: &mut List) {
    list.class("size", "size");
    extent::add(list);
    edges::add(list);
    clears::add(list);
    copies::add(list);
    batches::add(list);
}
