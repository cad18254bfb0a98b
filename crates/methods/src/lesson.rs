//! Short explanations of methods, with their sources.

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
        }
    }
}
