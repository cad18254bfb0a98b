//! Rendering methods: accuracy against speed, stability, and claims of the literature. Also the accuracy of
//! drivers.

mod breaks;
mod choice;
mod claims;
mod data;
mod driver;
mod front;
mod grid;
mod layers;
mod name;
mod page;
mod pictures;
mod points;
mod scatter;
mod stability;
mod summary;

pub(crate) use data::Methods;
pub(crate) use driver::section as driver_section;
pub(crate) use name::PAGE;
pub use page::methods_html;
pub(crate) use page::page;
pub use points::{MethodPoint, method_points};
pub(crate) use points::{POINTS, csv};
pub(crate) use summary::{lines, section};

#[cfg(test)]
mod tests {
    pub(crate) mod made;
}
