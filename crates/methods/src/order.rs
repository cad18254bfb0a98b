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

/// Returns the part that the order of draws plays; `None` for questions whose surfaces hide each other, so that the depth
/// test makes up for any order.
pub fn order(question: &str, method: &str) -> Option<Order> {
    let order = match method {
        "sorted" | "sorted-triangles" | "front-to-back" => Order::Sorted,
        "unsorted" | "depth-write-off" => Order::Submitted,
        _ => Order::Independent,
    };
    (question == "transparency").then_some(order)
}
