//! The distance of a method's picture from the truth, and its cost.

use etalon_case::{Case, Method};
use etalon_frame::{Frame, SizedDistance};
use etalon_record::{Measured, Parameter};
use etalon_scene::Scene;
use etalon_truth::{
    Lattice, LatticeTruth, MethodScene, Truth, TruthPicture, at_size, distance, lattice_distance,
    truth, truth_on,
};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// The truths of a run's method cases, each computed once for all methods and adapters.
#[derive(Debug, Default)]
pub struct Truths {
    /// The truths, by question and scene.
    scenes: Mutex<KnownTruths<TruthPicture>>,
    /// The truths at other sizes, on a lattice.
    sized: Mutex<KnownTruths<LatticeTruth>>,
}

/// Truths by question and scene, each with what is computed from it once.
type KnownTruths<T> = HashMap<(String, String), Vec<(Truth, Arc<OnceLock<Arc<T>>>)>>;

/// Returns what is computed from a truth, which all methods share that should show the same picture.
fn shared<T>(
    known: &Mutex<KnownTruths<T>>,
    method: &Method,
    truth: &Truth,
    compute: impl FnOnce() -> T,
) -> Arc<T> {
    let entry = {
        let mut scenes = known.lock().unwrap_or_else(PoisonError::into_inner);
        let key = (method.question.clone(), method.scene.clone());
        let known = scenes.entry(key).or_default();
        match known.iter().find(|(other, _)| other == truth) {
            Some((_, entry)) => Arc::clone(entry),
            None => {
                let entry = Arc::default();
                known.push((truth.clone(), Arc::clone(&entry)));
                entry
            }
        }
    };
    Arc::clone(entry.get_or_init(|| Arc::new(compute())))
}

impl Truths {
    /// Returns the exact picture of a method.
    pub fn get(&self, method: &Method) -> Arc<TruthPicture> {
        shared(&self.scenes, method, &method.truth, || truth(&method.truth))
    }

    /// Returns a case's scene at another size of frames, with its truth on a lattice; `None` for a case without a
    /// method.
    pub fn sized(&self, case: &Case, size: [u32; 2]) -> Option<SizedScene> {
        let method = case.method.as_ref()?;
        let MethodScene { scene, truth } = at_size(&case.scene, &method.truth, size);
        let on_lattice = || truth_on(&truth, Lattice::over(size));
        Some(SizedScene {
            size,
            scene,
            truth: Some(shared(&self.sized, method, &truth, on_lattice)),
        })
    }
}

/// A method's scene at one size of frames.
#[derive(Clone, Debug)]
pub struct SizedScene {
    /// Width and height in texels.
    pub size: [u32; 2],
    /// The scene.
    pub scene: Scene,
    /// The truth of its frames; `None` at the size of the case's picture, which is compared as a whole.
    pub truth: Option<Arc<LatticeTruth>>,
}

impl SizedScene {
    /// Returns a case's scene at the size of its picture; `None` for a case without a method.
    pub fn of_picture(case: &Case) -> Option<Self> {
        Some(Self {
            size: case.method.as_ref()?.truth.size,
            scene: case.scene.clone(),
            truth: None,
        })
    }

    /// Returns the distance of a frame from the truth; `None` without a truth or a picture to compare.
    pub fn distance(&self, frame: &Frame) -> Option<SizedDistance> {
        lattice_distance(self.truth.as_ref()?, frame.images.first()?)
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
        sizes: Vec::new(),
        cost: None,
        passes: case.scene.passes.len() as u32,
        draws: draws as u32,
        fragments: None,
        bytes: case.scene.bytes(),
        picture: None,
        truth_picture: None,
    })
}
