//! The parts of a scene that its legal sets depend on.

use etalon_scene::{Fetch, Mesh, Path, RESTART, Scene};
use std::hash::{DefaultHasher, Hasher};

/// Everything in a scene that its legal sets depend on: scenes with equal keys have equal sets under equal limits
/// and rules. The path is no part of it, nor is the route by which vertices reach the pipeline.
///
/// A key is a SipHash of 64 bits: among 100,000 scenes, two that differ share one with a probability of 3·10⁻¹⁰.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SceneKey(u64);

impl SceneKey {
    /// Returns the key of a scene.
    pub fn of(scene: &Scene) -> Self {
        let mut hasher = DefaultHasher::new();
        let mut rest = scene.clone();
        rest.path = Path::default();
        for draw in rest.passes.iter_mut().flat_map(|pass| &mut pass.draws) {
            let mesh = std::mem::take(&mut draw.mesh);
            // Whether a restart is found can depend on the base vertex.
            if !mesh.indices.iter().flatten().any(|i| *i == RESTART) {
                draw.fetch = Fetch::default();
            }
            add_mesh(&mesh, &mut hasher);
        }
        match postcard::to_stdvec(&rest) {
            Ok(bytes) => hasher.write(&bytes),
            Err(_) => hasher.write(format!("{rest:?}").as_bytes()),
        }
        Self(hasher.finish())
    }
}

/// Adds the drawn vertices in order, bit for bit.
fn add_mesh(mesh: &Mesh, hasher: &mut DefaultHasher) {
    let mut add = |index: Option<u32>| {
        let vertex = index.and_then(|i| mesh.vertices.get(i as usize));
        hasher.write_u8(u8::from(vertex.is_some()));
        if let Some(vertex) = vertex {
            hasher.write(bytemuck::bytes_of(vertex));
        }
    };
    match &mesh.indices {
        Some(indices) => indices
            .iter()
            .for_each(|i| add(Some(*i).filter(|i| *i != RESTART))),
        None => (0..mesh.vertices.len() as u32).for_each(|i| add(Some(i))),
    }
    hasher.write_usize(mesh.indices.as_ref().map_or(mesh.vertices.len(), Vec::len));
}
