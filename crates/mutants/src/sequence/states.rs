//! States that a pass change keeps or resets.

use super::super::list::{CONFUSION, List};
use super::super::plant::scene;
use super::super::sticky::LEFTOVERS;
use etalon_scene::{ColorTarget, Draw, Viewport};

pub(super) fn add(list: &mut List) {
    for (what, _, take) in LEFTOVERS {
        list.add(
            &format!("{what}-kept-in-the-next-pass"),
            "lavapipe, ANGLE: stale state",
            format!(
                "The {what} of a pass's last draw persists in the first draw of the next pass."
            ),
            scene(move |scene| {
                let mut before: Option<Draw> = None;
                for pass in &mut scene.passes {
                    let last = pass.draws.last().cloned();
                    if let (Some(before), Some(first)) = (&before, pass.draws.first_mut()) {
                        take(before, first);
                    }
                    before = last.or(before);
                }
            }),
        );
    }
    for (what, _, take) in LEFTOVERS {
        // What is off by default cannot be left on.
        if what.ends_with("-when-off") {
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
