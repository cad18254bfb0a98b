//! The head of a program: sentences for people.

/// The head of a program: sentences for people.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Head {
    /// The bug in a line.
    pub title: String,
    /// What is wrong.
    pub sentence: String,
    /// The command that runs the program on the driver.
    pub run: String,
}
