//! Two benches compared: as data, and as a page.

pub(crate) mod compare;
pub(crate) mod page;
