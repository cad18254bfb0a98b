//! The uses of attachments.

use etalon_frame::PathReads;
use etalon_scene::{Pass, Scene};

/// The use of an attachment in a pass, or in all passes together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// A colour or resolve attachment. Other passes can fetch from it.
    Color,
    DepthStencil,
    /// A read-only depth-stencil attachment.
    DepthStencilReadOnly,
    /// The resolve target of depth and stencil.
    DepthStencilResolve,
    Fetched,
    /// An attachment that draws of its own pass read in this way.
    Own(PathReads),
    /// No pass uses the image. It can still be read back.
    Idle,
}

impl Role {
    /// Returns the role of an attachment in all passes together. A pass that draws to it decides.
    pub(crate) fn of(scene: &Scene, index: usize) -> Self {
        let role_in = |pass| roles(pass).into_iter().find(|(i, _)| *i == index);
        let mut found = Self::Idle;
        for (_, role) in scene.passes.iter().filter_map(role_in) {
            match role {
                Self::Color => return Self::Color,
                Self::DepthStencil | Self::DepthStencilReadOnly | Self::DepthStencilResolve => {
                    return Self::DepthStencil;
                }
                Self::Fetched | Self::Own(_) | Self::Idle => found = role,
            }
        }
        found
    }
}

/// Returns the attachments of a pass, each once, with their roles, if its draws read those of the pass in this
/// way.
pub(crate) fn roles_by(pass: &Pass, way: Option<PathReads>) -> Vec<(usize, Role)> {
    let mut roles = roles(pass);
    for (index, role) in &mut roles {
        let read = pass.draws.iter().any(|d| d.textures.contains(index));
        if let Some(way) = way.filter(|_| read && pass.attaches(*index)) {
            *role = Role::Own(way);
        }
    }
    roles
}

/// Returns the attachments of a pass, each once, with their roles, if no draw reads those of the pass.
fn roles(pass: &Pass) -> Vec<(usize, Role)> {
    let drawn = pass.color.iter().chain(pass.resolve.iter().flatten());
    let mut roles: Vec<_> = drawn.map(|index| (*index, Role::Color)).collect();
    let tested = if pass.depth_stencil_read_only {
        Role::DepthStencilReadOnly
    } else {
        Role::DepthStencil
    };
    roles.extend(pass.depth_stencil.map(|index| (index, tested)));
    let resolve = pass.depth_stencil_resolve.as_ref();
    roles.extend(resolve.map(|r| (r.to, Role::DepthStencilResolve)));
    for texture in pass.draws.iter().flat_map(|d| &d.textures) {
        if roles.iter().all(|(index, _)| index != texture) {
            roles.push((*texture, Role::Fetched));
        }
    }
    roles
}
