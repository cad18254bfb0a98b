//! The rasterizer with a planted bug.

use super::mutant::Mutant;
use super::plant::{Plant, all_draws};
use crate::mutants;
use etalon_backend::{Backend, BackendError, FrameTime, Prepared};
use etalon_cpu::steps::Faithful;
use etalon_cpu::{CpuBackend, CpuScene};
use etalon_frame::{AdapterInfo, Frame, Limits};
use etalon_scene::{RESTART, Scene};
use std::cell::RefCell;

/// The rasterizer with one planted bug.
#[derive(Debug)]
pub struct MutantBackend {
    inner: CpuBackend,
    mutant: &'static Mutant,
    /// The previous scene, for bugs in which its state persists.
    before: RefCell<Option<Scene>>,
}

impl MutantBackend {
    /// Returns the rasterizer with the bug of this name; `None` if no bug has this name.
    pub fn new(name: &str) -> Option<Self> {
        let mutant = mutants().iter().find(|m| m.name == name)?;
        Some(Self {
            inner: CpuBackend::spans(&format!("cpu:{name}")),
            mutant,
            before: RefCell::new(None),
        })
    }

    /// Returns the scene that the bug makes of a scene.
    fn believed(&self, scene: &Scene) -> Scene {
        let before = self.before.replace(Some(scene.clone()));
        let mut believed = scene.clone();
        match &self.mutant.plant {
            Plant::Scene(bug) | Plant::Again(_, bug) => bug(before.as_ref(), &mut believed),
            Plant::Draws(bug) => all_draws(&mut believed).for_each(bug),
            Plant::Steps(_) | Plant::Memory(_) | Plant::Frame(_) => return believed,
        }
        keep_possible(scene, &mut believed);
        believed
    }
}

/// Reverts tests of aspects that a pass lacks, which no bug can make a driver test, and removes indices of
/// vertices that a bug removed.
fn keep_possible(asked: &Scene, believed: &mut Scene) {
    for (pass, original) in believed.passes.iter_mut().zip(&asked.passes) {
        let format = pass.depth_stencil.map(|i| asked.attachments[i].format);
        for (draw, original) in pass.draws.iter_mut().zip(&original.draws) {
            if !format.is_some_and(|f| f.has_depth()) {
                draw.depth = original.depth;
            }
            if !format.is_some_and(|f| f.has_stencil()) {
                draw.stencil = original.stencil;
            }
            let count = draw.mesh.vertices.len() as u32;
            if let Some(indices) = &mut draw.mesh.indices {
                indices.retain(|i| *i == RESTART || *i < count);
            }
        }
    }
}

impl Backend for MutantBackend {
    fn adapter(&self) -> &AdapterInfo {
        self.inner.adapter()
    }

    fn limits(&self) -> &Limits {
        self.inner.limits()
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Prepared + '_>, BackendError> {
        if let Some(missing) = self.limits().missing(&scene.requirements()) {
            return Err(BackendError::NotSupported(missing));
        }
        let believed = self.believed(scene);
        Ok(match &self.mutant.plant {
            Plant::Steps(hooks) => Box::new(CpuScene::new(believed, hooks.as_ref())),
            Plant::Memory(bug) => Box::new(CpuScene::new(believed, bug())),
            Plant::Frame(bug) => Box::new(PreparedMutant {
                inner: self.inner.prepare(&believed)?,
                scene: believed,
                bug,
            }),
            Plant::Again(from, _) => Box::new(PreparedAgain {
                right: CpuScene::new(scene.clone(), Faithful),
                wrong: CpuScene::new(believed, Faithful),
                from: *from,
                submissions: 0,
            }),
            Plant::Scene(_) | Plant::Draws(_) => Box::new(CpuScene::new(believed, Faithful)),
        })
    }
}

/// A scene that another scene replaces, starting at submission `from`.
struct PreparedAgain<P> {
    right: P,
    wrong: P,
    from: u32,
    submissions: u32,
}

impl<P> PreparedAgain<P> {
    /// Returns the frame of the last submission.
    fn drawn(&mut self) -> &mut P {
        if self.submissions >= self.from {
            &mut self.wrong
        } else {
            &mut self.right
        }
    }
}

impl<P: Prepared> Prepared for PreparedAgain<P> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        self.submissions += 1;
        self.drawn().submit()
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        self.drawn().read_back()
    }
}

/// A scene whose frame is changed when it is read back.
struct PreparedMutant<'a, F: ?Sized> {
    inner: Box<dyn Prepared + 'a>,
    scene: Scene,
    bug: &'a F,
}

impl<F: Fn(&Scene, &mut Frame) + ?Sized> Prepared for PreparedMutant<'_, F> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        self.inner.submit()
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        let mut frame = self.inner.read_back()?;
        (self.bug)(&self.scene, &mut frame);
        Ok(frame)
    }
}
