//! Bugs of clears when passes load, of clear commands between draws, and of discards.

use super::super::list::{CONFUSION, List};
use super::super::plant::{Plant, scene};
use etalon_scene::{
    Clear, ClearTarget, LoadOperation, Operations, Pass, PassOperations, Scene, StoreOperation,
};

const FAST: &str = "AMD, Intel: fast clears and their metadata";

/// Changes every pass.
fn passes(bug: impl Fn(&mut Pass) + Send + Sync + 'static) -> Plant {
    scene(move |scene| scene.passes.iter_mut().for_each(&bug))
}

/// Changes every clear command, given the commands of the pass before it.
fn commands(bug: impl Fn(&[Clear], &mut Clear) + Send + Sync + 'static) -> Plant {
    passes(move |pass| {
        let asked = pass.clears.clone();
        for (i, clear) in pass.clears.iter_mut().enumerate() {
            bug(&asked[..i], clear);
        }
    })
}

/// Leaves commands out.
fn keep(keep: impl Fn(&Pass, &[Clear], &Clear) -> bool + Send + Sync + 'static) -> Plant {
    passes(move |pass| {
        let asked = pass.clone();
        let mut at = 0;
        pass.clears.retain(|clear| {
            at += 1;
            keep(&asked, &asked.clears[..at - 1], clear)
        });
    })
}

fn load<V: Default>() -> Operations<V> {
    Operations::default()
}

fn color_loads(pass: &mut Pass) {
    for operations in &mut pass.operations.color {
        operations.load = LoadOperation::Load;
    }
}

/// Takes the load operations that clear to the same value as the last clear of the aspect did, which may
/// be the contents at the start.
fn skip_equal(scene: &mut Scene) {
    let mut last = PassOperations::default();
    for pass in &mut scene.passes {
        let asked = pass.operations.clone();
        if asked
            .color
            .first()
            .is_some_and(|c| c.load != LoadOperation::Load)
            && asked.color.first() == last.color.first()
        {
            pass.operations.color.clear();
        }
        if asked.depth.load == last.depth.load {
            pass.operations.depth.load = LoadOperation::Load;
        }
        if asked.stencil.load == last.stencil.load {
            pass.operations.stencil.load = LoadOperation::Load;
        }
        if asked != PassOperations::default() {
            last = asked;
        }
    }
}

/// A bug's name, its description, and what it does to a pass.
type Row = (&'static str, &'static str, fn(&mut Pass));

pub(super) fn add(list: &mut List) {
    loads(list);
    between(list);
    discards(list);
}

fn loads(list: &mut List) {
    let rows: [Row; 7] = [
        (
            "colour-not-cleared-on-load",
            "Colour is loaded where it is to be cleared.",
            color_loads,
        ),
        (
            "depth-not-cleared-on-load",
            "Depth is loaded where it is to be cleared.",
            |pass| pass.operations.depth = load(),
        ),
        (
            "stencil-not-cleared-on-load",
            "Stencil is loaded where it is to be cleared.",
            |pass| pass.operations.stencil = load(),
        ),
        (
            "stencil-cleared-with-depth-on-load",
            "Where depth is cleared and stencil loaded, stencil becomes 0.",
            |pass| {
                let operations = &mut pass.operations;
                let both = [
                    operations.depth.load != LoadOperation::Load,
                    operations.stencil.load == LoadOperation::Load,
                ];
                if both == [true; 2] {
                    operations.stencil.load = LoadOperation::Clear(0);
                }
            },
        ),
        (
            "depth-cleared-with-stencil-on-load",
            "Where stencil is cleared and depth loaded, depth becomes 1.",
            |pass| {
                let operations = &mut pass.operations;
                let both = [
                    operations.stencil.load != LoadOperation::Load,
                    operations.depth.load == LoadOperation::Load,
                ];
                if both == [true; 2] {
                    operations.depth.load = LoadOperation::Clear(1.0);
                }
            },
        ),
        (
            "empty-pass-does-not-clear",
            "A pass without draws does not clear what it is to clear on load.",
            |pass| {
                if pass.draws.is_empty() {
                    pass.operations = PassOperations::default();
                }
            },
        ),
        (
            "clear-on-load-of-both-aspects-alone",
            "Depth and stencil are cleared on load together or not at all.",
            |pass| {
                let operations = &mut pass.operations;
                let depth = operations.depth.load != LoadOperation::Load;
                let stencil = operations.stencil.load != LoadOperation::Load;
                if depth != stencil {
                    operations.depth = load();
                    operations.stencil = load();
                }
            },
        ),
    ];
    list.rows(FAST, |bug| passes(bug), &rows);
    list.add(
        "clear-on-load-to-the-last-value",
        FAST,
        "A clear on load to the value of the clear before it is left out, whatever was drawn between.",
        scene(skip_equal_to_contents),
    );
}

/// As [`skip_equal`], with the contents at the start as the first clears.
fn skip_equal_to_contents(scene: &mut Scene) {
    use etalon_scene::Contents;
    let contents: Vec<Contents> = scene
        .attachments
        .iter()
        .map(|a| a.contents.clone())
        .collect();
    skip_equal(scene);
    for pass in &mut scene.passes {
        if let Some(first) = pass.color.first()
            && let Contents::Color(value) = contents[*first]
            && pass.color_operations(0).load == LoadOperation::Clear(value)
        {
            color_loads(pass);
        }
        if let Some(index) = pass.depth_stencil
            && let Contents::DepthStencil { depth, stencil } = contents[index]
        {
            let operations = &mut pass.operations;
            if operations.depth.load == LoadOperation::Clear(depth) {
                operations.depth = load();
            }
            if operations.stencil.load == LoadOperation::Clear(stencil) {
                operations.stencil = load();
            }
        }
    }
}

fn between(list: &mut List) {
    list.add(
        "command-ignores-its-rectangle",
        FAST,
        "A clear command clears everything.",
        commands(|_, clear| clear.rect = None),
    );
    for (name, about, change) in [
        (
            "command-without-last-row",
            "The rectangle of a clear command lacks its last row.",
            [0, 0, 0, 1],
        ),
        (
            "command-without-last-column",
            "The rectangle of a clear command lacks its last column.",
            [0, 0, 1, 0],
        ),
    ] {
        list.add(
            name,
            CONFUSION,
            about,
            commands(move |_, clear| {
                if let Some(rect) = &mut clear.rect {
                    for (side, less) in rect.iter_mut().zip(change) {
                        *side -= less;
                    }
                }
            }),
        );
    }
    list.add(
        "command-upside-down",
        "OpenGL under another API: y from below",
        "The rectangle of a clear command is counted from the bottom of 16 rows.",
        commands(|_, clear| {
            if let Some([_, y, _, h]) = &mut clear.rect {
                *y = 16_u32.saturating_sub(*y + *h);
            }
        }),
    );
    list.add(
        "commands-at-the-start",
        FAST,
        "Clear commands are made into clears on load.",
        commands(|_, clear| clear.before = 0),
    );
    list.add(
        "equal-command-skipped",
        FAST,
        "A clear command like an earlier one of the pass is left out.",
        keep(|_, before, clear| {
            let alike = |b: &Clear| (b.target, b.rect) == (clear.target, clear.rect);
            !before.iter().any(alike)
        }),
    );
    list.add(
        "later-commands-skipped",
        CONFUSION,
        "Clear commands behind the first draw are left out.",
        keep(|_, _, clear| clear.before == 0),
    );
    list.add(
        "last-commands-skipped",
        CONFUSION,
        "Clear commands behind the last draw are left out.",
        keep(|pass, _, clear| clear.before < pass.draws.len()),
    );
    list.add(
        "command-obeys-the-scissor",
        "OpenGL: the scissor test applies to clears",
        "A clear command stays in the scissor rectangle of the draw before it.",
        passes(|pass| {
            for i in 0..pass.clears.len() {
                let before = pass.clears[i].before.checked_sub(1);
                let scissor = before.and_then(|draw| pass.draws[draw].scissor);
                if let Some([x, y, w, h]) = scissor {
                    let [left, top, width, height] = pass.clears[i].rect.unwrap_or([0, 0, 16, 16]);
                    let (l, t) = (left.max(x), top.max(y));
                    let (r, b) = ((left + width).min(x + w), (top + height).min(y + h));
                    let size = [r.saturating_sub(l), b.saturating_sub(t)];
                    pass.clears[i].rect = Some([l, t, size[0], size[1]]);
                }
            }
        }),
    );
    for (name, about, swap) in [
        (
            "command-clears-stencil-with-depth",
            "A clear command of depth sets stencil to 0.",
            true,
        ),
        (
            "command-clears-depth-with-stencil",
            "A clear command of stencil sets depth to 1.",
            false,
        ),
    ] {
        list.add(
            name,
            CONFUSION,
            about,
            commands(move |_, clear| {
                if let ClearTarget::DepthStencil { depth, stencil, .. } = &mut clear.target {
                    match (depth.is_some(), stencil.is_some()) {
                        (true, false) if swap => *stencil = Some(0),
                        (false, true) if !swap => *depth = Some(1.0),
                        _ => {}
                    }
                }
            }),
        );
    }
}

fn discards(list: &mut List) {
    let rows: [Row; 3] = [
        (
            "stencil-discarded-with-depth",
            "Where depth is discarded, stencil is too.",
            |pass| {
                if pass.operations.depth.store == StoreOperation::Discard {
                    pass.operations.stencil.store = StoreOperation::Discard;
                }
            },
        ),
        (
            "depth-discarded-with-stencil",
            "Where stencil is discarded, depth is too.",
            |pass| {
                if pass.operations.stencil.store == StoreOperation::Discard {
                    pass.operations.depth.store = StoreOperation::Discard;
                }
            },
        ),
        (
            "depth-and-stencil-discarded-with-colour",
            "Where colour is discarded, depth and stencil are too.",
            |pass| {
                let discarded = |o: &Operations<[f32; 4]>| o.store == StoreOperation::Discard;
                if pass.operations.color.iter().any(discarded) {
                    pass.operations.depth.store = StoreOperation::Discard;
                    pass.operations.stencil.store = StoreOperation::Discard;
                }
            },
        ),
    ];
    list.rows(
        "Mali, PowerVR: one operation for both aspects",
        |bug| passes(bug),
        &rows,
    );
}
