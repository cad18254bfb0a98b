//! Scenes.
//!
//! Scenes are valid by construction: whoever builds one keeps indices in range, sizes equal within a
//! pass, and no pass reading what it draws to. Backends and the judge rely on it.

use crate::attachment::Attachment;
use crate::draw::Draw;
use crate::pass::Pass;
use crate::path::Path;
use crate::pool::Pool;
use crate::query_scope::QueryScope;
use etalon_frame::{CounterKind, PathColors, PathLayers, TextureFormat};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Everything a device needs to know of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// Textures that passes draw to or read, each under a name of its own.
    pub attachments: Vec<Attachment>,
    /// Passes, in order.
    pub passes: Vec<Pass>,
    /// Indices of the attachments to read back at the end: all aspects, depth before stencil.
    pub read: Vec<usize>,
    /// The counters, by name in ascending order. All are read back; each starts from 0.
    pub counters: Vec<Counter>,
    /// The part of the scene that one query encloses.
    #[serde(default)]
    pub query_scope: QueryScope,
    /// The pool that fragment shaders fill and read, if any does.
    #[serde(default)]
    pub pool: Option<Pool>,
    /// The way in which the scene reaches the driver.
    #[serde(default)]
    pub path: Path,
}

/// Something that is counted over one or more draws.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counter {
    /// Name in the case file.
    pub name: String,
    /// The kind of count.
    pub kind: CounterKind,
}

impl Scene {
    /// The size of a pass's attachments in texels.
    pub fn pass_size(&self, pass: &Pass) -> [u32; 2] {
        let first = pass.color.first().copied().or(pass.depth_stencil);
        first.map_or([1, 1], |index| self.attachments[index].size)
    }

    /// The samples per texel of a pass's attachments.
    pub fn pass_samples(&self, pass: &Pass) -> u32 {
        let first = pass.color.first().copied().or(pass.depth_stencil);
        first.map_or(1, |index| self.attachments[index].samples)
    }

    /// The layers of passes by the path: one if draws count or store, which they would do for each layer, or if the vertex
    /// shader is not the last stage before rasterization.
    pub fn layers(&self) -> PathLayers {
        let mut draws = self.passes.iter().flat_map(|p| &p.draws);
        let once = draws.any(|d| d.shader.uses_storage() || d.tessellation.is_some());
        if once || !self.counters.is_empty() {
            PathLayers::One
        } else {
            self.path.layers
        }
    }

    /// True if the path leaves a colour attachment out of its passes: nothing reads it, and each of them has another.
    pub fn is_gap(&self, index: usize) -> bool {
        let mut passes = self.passes.iter().filter(|p| p.color.contains(&index));
        self.path.colors == PathColors::Gaps
            && self.is_unread(index)
            && passes.all(|pass| pass.color.iter().any(|other| !self.is_unread(*other)))
    }

    /// True if nobody reads an attachment: neither the host nor a draw nor a resolve.
    fn is_unread(&self, index: usize) -> bool {
        let read = |pass: &Pass| {
            let mut resolved = pass.color.iter().zip(&pass.resolve);
            resolved.any(|(from, to)| *from == index && to.is_some())
                || pass.resolve_targets().any(|to| to == index)
                || pass.draws.iter().any(|draw| draw.textures.contains(&index))
        };
        !self.read.contains(&index) && !self.passes.iter().any(read)
    }

    /// The scene with something counted over all its draws, and nothing else.
    pub fn counting(&self, kind: CounterKind) -> Self {
        let mut scene = self.clone();
        scene.counters = vec![Counter {
            name: kind.name().to_owned(),
            kind,
        }];
        for pass in &mut scene.passes {
            for draw in &mut pass.draws {
                draw.counters = vec![0];
            }
        }
        scene
    }

    /// Bytes of all attachments, by their formats' texel sizes, and of the pool.
    pub fn bytes(&self) -> u64 {
        let bytes = |a: &Attachment| {
            let texels = u64::from(a.size[0]) * u64::from(a.size[1]) * u64::from(a.samples);
            texels * u64::from(a.format.texel_bytes())
        };
        let attachments: u64 = self.attachments.iter().map(bytes).sum();
        attachments + self.pool.map_or(0, Pool::bytes)
    }

    /// The formats of all attachments.
    pub fn formats(&self) -> Vec<TextureFormat> {
        let set: BTreeSet<_> = self.attachments.iter().map(|a| a.format).collect();
        set.into_iter().collect()
    }
}

impl Draw {
    /// The index of the counter of a kind that this draw adds to.
    pub fn counter(&self, scene: &Scene, kind: impl Fn(CounterKind) -> bool) -> Option<usize> {
        let all = self.counters.iter().copied();
        all.filter(|i| scene.counters.get(*i).is_some_and(|c| kind(c.kind)))
            .min()
    }
}
