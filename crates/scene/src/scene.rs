//! Scenes.
//!
//! Scenes are valid by construction: their builder keeps indices in range and sizes equal within a pass, and
//! lets no draw read what it changes elsewhere. Backends and the judge rely on it.

use crate::attachment::{Attachment, AttachmentContents};
use crate::draw::Draw;
use crate::pass::Pass;
use crate::path::Path;
use crate::pool::Pool;
use crate::query_scope::QueryScope;
use etalon_frame::{CounterKind, PathColors, PathLayers, TextureFormat};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Everything that a device needs to know about a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// The textures that passes draw to or read, with distinct names.
    pub attachments: Vec<Attachment>,
    /// Passes in the order of submission; each sees what the earlier ones stored.
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
    /// The path on which the scene reaches the driver.
    #[serde(default)]
    pub path: Path,
}

/// A count over some of the scene's draws.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counter {
    /// Name in the case file, by which draws and records refer to it.
    pub name: String,
    /// What is counted, and so the type of query that a backend uses.
    pub kind: CounterKind,
}

impl Scene {
    /// Returns the size of a pass's attachments in texels.
    pub fn pass_size(&self, pass: &Pass) -> [u32; 2] {
        let first = pass.color.first().copied().or(pass.depth_stencil);
        first.map_or([1, 1], |index| self.attachments[index].size)
    }

    /// Returns the samples per texel of a pass's attachments.
    pub fn pass_samples(&self, pass: &Pass) -> u32 {
        let first = pass.color.first().copied().or(pass.depth_stencil);
        first.map_or(1, |index| self.attachments[index].samples)
    }

    /// Returns the layers that the path gives to passes. There is only one if draws count or store, which
    /// they would do once per layer, if they read their own pass, or if the vertex shader is not the last stage
    /// before rasterization.
    pub fn layers(&self) -> PathLayers {
        let mut draws = self.passes.iter().flat_map(|p| &p.draws);
        let once = draws.any(|d| d.shader.uses_storage() || d.tessellation.is_some());
        let reads_itself = self.passes.iter().any(Pass::reads_itself);
        if once || reads_itself || !self.counters.is_empty() {
            PathLayers::One
        } else {
            self.path.layers
        }
    }

    /// Returns true if the path leaves a colour attachment out of its passes. Such an attachment is never
    /// read, and each of its passes has another one.
    pub fn is_gap(&self, index: usize) -> bool {
        let mut passes = self.passes.iter().filter(|p| p.color.contains(&index));
        self.path.colors == PathColors::Gaps
            && self.is_unread(index)
            && passes.all(|pass| pass.color.iter().any(|other| !self.is_unread(*other)))
    }

    /// Returns true if nothing reads an attachment: neither the host nor a draw nor a resolve.
    fn is_unread(&self, index: usize) -> bool {
        let read = |pass: &Pass| {
            let mut resolved = pass.color.iter().zip(&pass.resolve);
            resolved.any(|(from, to)| *from == index && to.is_some())
                || pass.resolve_targets().any(|to| to == index)
                || pass.draws.iter().any(|draw| draw.textures.contains(&index))
        };
        !self.read.contains(&index) && !self.passes.iter().any(read)
    }

    /// Returns the scene with one counter over all its draws in place of its own counters.
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

    /// Returns the size of all attachments in bytes, by their formats' texel sizes, plus the pool.
    pub fn bytes(&self) -> u64 {
        let bytes = |a: &Attachment| {
            let texels = u64::from(a.size[0]) * u64::from(a.size[1]) * u64::from(a.samples);
            texels * u64::from(a.format.texel_bytes())
        };
        let attachments: u64 = self.attachments.iter().map(bytes).sum();
        attachments + self.pool.map_or(0, Pool::bytes)
    }

    /// The maximum of [`Scene::content_bytes`]. A scene goes to another process in one message.
    pub const MOST_CONTENT: u64 = (1 << 30) - (1 << 20);

    /// Returns the most bytes that the uploaded texels, the vertices and the indices take in a message: a code takes up to
    /// five.
    pub fn content_bytes(&self) -> u64 {
        let uploaded = self.attachments.iter().map(|a| match &a.contents {
            AttachmentContents::Texels(codes) => 5 * codes.len(),
            AttachmentContents::Color(_) | AttachmentContents::DepthStencil { .. } => 0,
        });
        let meshes = self.passes.iter().flat_map(|pass| &pass.draws).map(|draw| {
            let indices = draw.mesh.indices.as_ref().map_or(0, Vec::len);
            draw.mesh.bytes().len() + size_of::<u32>() * indices
        });
        uploaded.chain(meshes).sum::<usize>() as u64
    }

    /// Returns the formats of all attachments.
    pub fn formats(&self) -> Vec<TextureFormat> {
        let set: BTreeSet<_> = self.attachments.iter().map(|a| a.format).collect();
        set.into_iter().collect()
    }
}

impl Draw {
    /// Returns the index of a counter of this kind that the draw adds to.
    pub fn counter(&self, scene: &Scene, kind: impl Fn(CounterKind) -> bool) -> Option<usize> {
        let counters = self.counters.iter().copied();
        counters
            .filter(|i| scene.counters.get(*i).is_some_and(|c| kind(c.kind)))
            .min()
    }
}
