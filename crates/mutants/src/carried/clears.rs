//! Clears between and within passes: skipped, moved, or wider than they were asked for.

use super::super::list::{CONFUSION, List};
use super::super::plant::{Plant, scene};
use etalon_scene::{Clear, ClearTarget, LoadOperation, Pass, StoreOperation};

/// Changes every pass, given its number.
fn passes(bug: impl Fn(usize, &mut Pass) + Send + Sync + 'static) -> Plant {
    scene(move |scene| {
        for (number, pass) in scene.passes.iter_mut().enumerate() {
            bug(number, pass);
        }
    })
}

/// Changes every clear command.
fn clears(bug: fn(&mut Clear)) -> Plant {
    passes(move |_, pass| pass.clears.iter_mut().for_each(bug))
}

/// Removes clear commands.
fn kept(keeps: fn(usize, &Clear) -> bool) -> Plant {
    passes(move |_, pass| {
        let mut number = 0;
        pass.clears.retain(|clear| {
            number += 1;
            keeps(number - 1, clear)
        });
    })
}

fn is_color(clear: &Clear) -> bool {
    matches!(clear.target, ClearTarget::Color { .. })
}

pub(super) fn add(list: &mut List) {
    loads(list);
    commands(list);
    moved(list);
}

fn loads(list: &mut List) {
    type Bug = (&'static str, &'static str, fn(usize, &mut Pass));
    let bugs: [Bug; 6] = [
        (
            "color-load-clears",
            "Passes after the first clear colour instead of loading it.",
            |n, pass| {
                if n > 0 {
                    let count = pass.color.len();
                    pass.operations.color.resize_with(count, Default::default);
                    for own in &mut pass.operations.color {
                        own.load = LoadOperation::Clear([0.0; 4]);
                    }
                }
            },
        ),
        (
            "depth-load-clears",
            "Passes after the first clear depth instead of loading it.",
            |n, pass| {
                if n > 0 && !pass.depth_stencil_read_only {
                    pass.operations.depth.load = LoadOperation::Clear(1.0);
                }
            },
        ),
        (
            "stencil-load-clears",
            "Passes after the first clear stencil instead of loading it.",
            |n, pass| {
                if n > 0 && !pass.depth_stencil_read_only {
                    pass.operations.stencil.load = LoadOperation::Clear(0);
                }
            },
        ),
        (
            "color-store-dropped",
            "Colour that passes store is discarded.",
            |_, pass| {
                let count = pass.color.len();
                pass.operations.color.resize_with(count, Default::default);
                for own in &mut pass.operations.color {
                    own.store = StoreOperation::Discard;
                }
            },
        ),
        (
            "depth-store-dropped",
            "Depth that passes store is discarded.",
            |_, pass| {
                if pass.depth_stencil.is_some() && !pass.depth_stencil_read_only {
                    pass.operations.depth.store = StoreOperation::Discard;
                }
            },
        ),
        (
            "stencil-store-dropped",
            "Stencil that passes store is discarded.",
            |_, pass| {
                if pass.depth_stencil.is_some() && !pass.depth_stencil_read_only {
                    pass.operations.stencil.store = StoreOperation::Discard;
                }
            },
        ),
    ];
    for (name, about, bug) in bugs {
        list.add(name, CONFUSION, about, passes(bug));
    }
    list.add(
        "depth-clear-value-of-the-pass-before",
        CONFUSION,
        "A load operation clears depth with the value of the pass before that cleared.",
        scene(|scene| {
            let mut before = None;
            for pass in &mut scene.passes {
                if let LoadOperation::Clear(value) = pass.operations.depth.load {
                    pass.operations.depth.load = LoadOperation::Clear(before.unwrap_or(value));
                    before = Some(value);
                }
            }
        }),
    );
}

fn commands(list: &mut List) {
    type Bug = (&'static str, &'static str, fn(&mut Clear));
    let bugs: [Bug; 1] = [(
        "clear-ignores-left-of-rectangle",
        "The rectangle of a clear command begins at column 0.",
        |clear| {
            if let Some([x, _, w, _]) = &mut clear.rect {
                *w += *x;
                *x = 0;
            }
        },
    )];
    for (name, about, bug) in bugs {
        list.add(name, CONFUSION, about, clears(bug));
    }
    type Keep = (&'static str, &'static str, fn(usize, &Clear) -> bool);
    let keeps: [Keep; 5] = [
        (
            "color-clear-command-skipped",
            "Clear commands of colour are skipped.",
            |_, c| !is_color(c),
        ),
        (
            "depth-clear-command-skipped",
            "Clear commands of depth are skipped.",
            |_, c| !matches!(c.target, ClearTarget::DepthStencil { depth: Some(_), .. }),
        ),
        (
            "stencil-clear-command-skipped",
            "Clear commands of stencil are skipped.",
            |_, c| {
                !matches!(
                    c.target,
                    ClearTarget::DepthStencil {
                        stencil: Some(_),
                        ..
                    }
                )
            },
        ),
        (
            "second-clear-command-skipped",
            "The second clear command of a pass is skipped.",
            |n, _| n != 1,
        ),
        (
            "first-clear-command-skipped",
            "The first clear command of a pass is skipped.",
            |n, _| n != 0,
        ),
    ];
    for (name, about, keep) in keeps {
        list.add(name, CONFUSION, about, kept(keep));
    }
}

fn moved(list: &mut List) {
    list.add(
        "clears-after-all-draws",
        CONFUSION,
        "Clear commands of a pass are executed after its draws.",
        passes(|_, pass| {
            let end = pass.draws.len();
            pass.clears.iter_mut().for_each(|c| c.before = end);
        }),
    );
    list.add(
        "clears-one-draw-late",
        CONFUSION,
        "Clear commands are executed after the draw that follows them.",
        passes(|_, pass| {
            let end = pass.draws.len();
            pass.clears
                .iter_mut()
                .for_each(|c| c.before = (c.before + 1).min(end));
        }),
    );
}
