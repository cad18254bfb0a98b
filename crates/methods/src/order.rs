//! The part that the order of draws plays for a method.

/// The part that the order of draws plays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// None: the picture is the same in any order.
    Independent,
    /// The method sorts what it draws.
    Sorted,
    /// The picture depends on the order in which surfaces happen to be drawn.
    Submitted,
}
