//! The rasterizer with planted changes.

use crate::changes;
use crate::hooks::CombinedHooks;
use crate::mutant::Mutant;
use crate::plant::{FrameBug, Plant, all_draws};
use etalon_backend::{Backend, BackendError, FrameTime, Prepared};
use etalon_cpu::steps::Faithful;
use etalon_cpu::{CpuBackend, CpuScene};
use etalon_frame::{AdapterInfo, Frame, Limits};
use etalon_scene::{RESTART, Scene};
use std::cell::RefCell;

/// The rasterizer with a planted bug, or with legal changes.
#[derive(Debug)]
pub struct MutantBackend {
    inner: CpuBackend,
    limits: Limits,
    changes: Vec<&'static Mutant>,
    /// The previous scene, for bugs in which its state persists.
    before: RefCell<Option<Scene>>,
}

impl MutantBackend {
    /// Returns the rasterizer with the changes of these names, joined by `+`, or without any for an empty name; `None`
    /// if a name is unknown.
    pub fn new(name: &str) -> Option<Self> {
        let names = name.split('+').filter(|name| !name.is_empty());
        let find = |name| changes().iter().find(|change| change.name == name);
        let changes: Vec<&Mutant> = names.map(find).collect::<Option<_>>()?;
        let inner = CpuBackend::spans(&format!("cpu:{name}"));
        let mut limits = inner.limits().clone();
        for change in &changes {
            limits = change.reported(limits);
        }
        Some(Self {
            inner,
            limits,
            changes,
            before: RefCell::new(None),
        })
    }

    /// Returns the scene that the bug makes of a scene.
    fn believed(&self, scene: &Scene) -> Scene {
        let before = self.before.replace(Some(scene.clone()));
        let mut believed = scene.clone();
        for change in &self.changes {
            match &change.plant {
                Plant::Scene(bug) | Plant::Again(_, bug) => bug(before.as_ref(), &mut believed),
                Plant::Draws(bug) => all_draws(&mut believed).for_each(bug),
                Plant::Steps(_) | Plant::Memory(_) | Plant::Frame(_) => {}
            }
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
        &self.limits
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Prepared + '_>, BackendError> {
        if let Some(missing) = self.limits().missing(&scene.requirements()) {
            return Err(BackendError::NotSupported(missing));
        }
        let believed = self.believed(scene);
        let mut hooks = CombinedHooks::default();
        let mut frame_bugs: Vec<&FrameBug> = Vec::new();
        for change in &self.changes {
            match &change.plant {
                Plant::Scene(_) | Plant::Draws(_) => {}
                Plant::Steps(steps) => hooks.0.push(steps),
                Plant::Frame(bug) => frame_bugs.push(bug.as_ref()),
                Plant::Memory(bug) => return Ok(Box::new(CpuScene::new(believed, bug()))),
                Plant::Again(from, _) => {
                    return Ok(Box::new(PreparedAgain {
                        right: CpuScene::new(scene.clone(), Faithful),
                        wrong: CpuScene::new(believed, Faithful),
                        from: *from,
                        submissions: 0,
                    }));
                }
            }
        }
        let inner: Box<dyn Prepared> = if hooks.0.is_empty() {
            Box::new(CpuScene::new(believed.clone(), Faithful))
        } else {
            Box::new(CpuScene::new(believed.clone(), hooks))
        };
        Ok(Box::new(PreparedMutant {
            inner,
            scene: believed,
            frame_bugs,
        }))
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
struct PreparedMutant<'a> {
    inner: Box<dyn Prepared + 'a>,
    scene: Scene,
    frame_bugs: Vec<&'a FrameBug>,
}

impl Prepared for PreparedMutant<'_> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        self.inner.submit()
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        let mut frame = self.inner.read_back()?;
        for bug in &self.frame_bugs {
            bug(&self.scene, &mut frame);
        }
        Ok(frame)
    }
}
