//! Method cases: question, scene, method and truth.

use crate::truth::Truth;

/// The question, scene and method of a case, with the truth.
#[derive(Clone, Debug, PartialEq)]
pub struct Method {
    /// The question, the second part of the id: `transparency`.
    pub question: String,
    /// The scene, the third part of the id: `windows`.
    pub scene: String,
    /// The method, as the id names it: `depth-peeling`.
    pub name: String,
    /// The parameter that the stability curve is drawn over.
    pub parameter: Option<MethodParameter>,
    /// The truth of the first attachment that is read back, ignoring alpha.
    pub truth: Truth,
}

/// A parameter of a family of method cases.
#[derive(Clone, Debug, PartialEq)]
pub struct MethodParameter {
    /// The axis.
    pub name: String,
    /// The parameter's value in this case.
    pub value: f64,
}
