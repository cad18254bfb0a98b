//! Short explanations of methods, with their sources.

use crate::order::Order;

/// One method: how it works, and where and why it fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lesson {
    /// The method, as ids name it.
    pub method: &'static str,
    /// An explanation of the method, in a sentence.
    pub works: &'static str,
    /// Where and why the method fails, in a sentence.
    pub fails: &'static str,
    /// The publication or specification.
    pub source: &'static str,
    /// The part that the order of draws plays; `None` for questions whose surfaces hide each other, so that the depth test
    /// makes up for any order.
    pub order: Option<Order>,
}

impl Lesson {
    pub(crate) const fn new(
        method: &'static str,
        works: &'static str,
        fails: &'static str,
        source: &'static str,
    ) -> Self {
        Self {
            method,
            works,
            fails,
            source,
            order: None,
        }
    }

    /// Returns the lesson with the part that the order of draws plays.
    pub(crate) const fn ordered(mut self, order: Order) -> Self {
        self.order = Some(order);
        self
    }
}
