//! The distance of a method's picture from the truth, and its cost.

use etalon_case::{Case, Method};
use etalon_frame::Frame;
use etalon_record::{Measured, Parameter};
use etalon_truth::{Truth, TruthPicture, distance, truth};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// The truths of a run's method cases, each computed once for all methods and adapters.
#[derive(Debug, Default)]
pub struct Truths {
    /// The truths, by question and scene.
    scenes: Mutex<HashMap<(String, String), Vec<CachedTruth>>>,
}

/// A truth, and its picture once it has been computed.
type CachedTruth = (Truth, Arc<OnceLock<Arc<TruthPicture>>>);

impl Truths {
    /// Returns the exact picture of a method. Methods that should show the same picture share it.
    pub fn get(&self, method: &Method) -> Arc<TruthPicture> {
        let entry = {
            let mut scenes = self.scenes.lock().unwrap_or_else(PoisonError::into_inner);
            let key = (method.question.clone(), method.scene.clone());
            let known = scenes.entry(key).or_default();
            match known.iter().find(|(truth, _)| *truth == method.truth) {
                Some((_, entry)) => Arc::clone(entry),
                None => {
                    let entry = Arc::default();
                    known.push((method.truth.clone(), Arc::clone(&entry)));
                    entry
                }
            }
        };
        let picture = entry.get_or_init(|| Arc::new(truth(&method.truth)));
        Arc::clone(picture)
    }
}

/// Returns the distance of a case's picture from the truth, and the costs that need no device. `None` if
/// the frame has no picture to compare.
pub fn measured(case: &Case, truth: &TruthPicture, frame: &Frame) -> Option<Measured> {
    let method = case.method.as_ref()?;
    let distance = distance(truth, frame.images.first()?)?;
    let draws: usize = case.scene.passes.iter().map(|p| p.draws.len()).sum();
    Some(Measured {
        question: method.question.clone(),
        scene: method.scene.clone(),
        method: method.name.clone(),
        parameter: method.parameter.as_ref().map(|p| Parameter {
            name: p.name.clone(),
            value: p.value,
        }),
        distance,
        time: None,
        passes: case.scene.passes.len() as u32,
        draws: draws as u32,
        fragments: None,
        bytes: case.scene.bytes(),
        picture: None,
        truth_picture: None,
    })
}
