//! States that a pass change resets.

use super::super::list::{CONFUSION, List};
use super::super::plant::scene;
use super::super::sticky::LEFTOVERS;
use etalon_scene::{ColorTarget, Draw, Viewport};

pub(super) fn add(list: &mut List) {
    for (what, _, take) in LEFTOVERS {
        // What is off by default cannot be left on, and its parameters do not act.
        let parameter = matches!(
            what,
            "depth-compare"
                | "depth-write"
                | "stencil-reference"
                | "stencil-write-mask"
                | "stencil-operations"
        );
        if parameter || what.ends_with("-when-off") {
            continue;
        }
        list.add(
            &format!("{what}-reset-in-the-next-pass"),
            CONFUSION,
            format!("The first draw of every pass but the first has the default {what}."),
            scene(move |scene| {
                for at in 1..scene.passes.len() {
                    let size = scene.pass_size(&scene.passes[at]);
                    if let Some(first) = scene.passes[at].draws.first_mut() {
                        let viewport = Viewport::whole(size);
                        let mut plain = Draw::new(first.shader, first.mesh.clone(), viewport);
                        plain.targets = vec![ColorTarget::default(); first.targets.len()];
                        take(&plain, first);
                    }
                }
            }),
        );
    }
}
