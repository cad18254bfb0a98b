//! Clears on load and between draws, and discards: skipped, moved, or larger than requested.

use crate::aspects::{
    ASPECT_PAIRS, ASPECTS, clear, discard, is_cleared, is_discarded, load, reach_both, reaches,
    word,
};
use crate::list::{CONFUSION, bugs};
use crate::plant::{Plant, passes, scene};
use etalon_frame::Aspect;
use etalon_scene::{AttachmentContents, Clear, LoadOperation, Pass, PassOperations, Scene};

const FAST: &str = "AMD, Intel: fast clears and their metadata";

/// Changes every clear command, given its pass.
fn commands(bug: impl Fn(&Pass, &mut Clear) + Send + Sync + 'static) -> Plant {
    passes(move |scene, number, pass| {
        let asked = &scene.passes[number];
        pass.clears
            .iter_mut()
            .for_each(|command| bug(asked, command));
    })
}

/// Removes the commands for which `keeps` is false, given their pass and the earlier commands.
fn without(keeps: impl Fn(&Pass, &[Clear], &Clear) -> bool + Send + Sync + 'static) -> Plant {
    passes(move |scene, number, pass| {
        let asked = &scene.passes[number];
        let clears = asked.clears.iter().enumerate();
        let kept =
            clears.filter(|(number, command)| keeps(asked, &asked.clears[..*number], command));
        pass.clears = kept.map(|(_, command)| *command).collect();
    })
}

/// Loads instead of clearing if the last clear, or the initial contents, had the same value.
fn skip_equal(scene: &mut Scene) {
    let mut last = PassOperations::default();
    for pass in &mut scene.passes {
        let asked = pass.operations.clone();
        let same = asked.color.first() == last.color.first();
        if same && is_cleared(pass, Aspect::Color) {
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
        let first = pass.color.first().map(|i| &scene.attachments[*i].contents);
        if let Some(AttachmentContents::Color(value)) = first
            && pass.color_operations(0).load == LoadOperation::Clear(*value)
        {
            load(pass, Aspect::Color);
        }
        if let Some(index) = pass.depth_stencil
            && let AttachmentContents::DepthStencil { depth, stencil } =
                scene.attachments[index].contents
        {
            if pass.operations.depth.load == LoadOperation::Clear(depth) {
                load(pass, Aspect::Depth);
            }
            if pass.operations.stencil.load == LoadOperation::Clear(stencil) {
                load(pass, Aspect::Stencil);
            }
        }
    }
}

bugs! {
    for aspect in ASPECTS {
        let (name, word) = (aspect.name(), word(aspect));
        "{name}-load-clears: Passes after the first clear {word} instead of loading it." =>
            passes(move |_, number, pass| if number > 0 { clear(pass, aspect) });
        "{name}-store-dropped: The {word} that passes store is discarded." =>
            passes(move |_, _, pass| discard(pass, aspect));
        "{name}-clear-command-skipped: Clear commands of {word} are skipped." =>
            without(move |_, _, command| !reaches(command, aspect));
    }
    "depth-clear-value-of-the-pass-before: Depth is cleared with the value of the clear before." =>
        scene(|scene| {
            let mut before = None;
            for pass in &mut scene.passes {
                if let LoadOperation::Clear(value) = pass.operations.depth.load {
                    pass.operations.depth.load = LoadOperation::Clear(before.unwrap_or(value));
                    before = Some(value);
                }
            }
        });
    source FAST;
    for aspect in ASPECTS {
        let word = word(aspect);
        "{word}-not-cleared-on-load: Where a pass is to clear {word}, it loads it." =>
            passes(move |_, _, pass| load(pass, aspect));
    }
    for (cleared, other, value) in ASPECT_PAIRS {
        let (a, b) = (cleared.name(), other.name());
        "{b}-cleared-with-{a}-on-load: Where {a} is cleared and {b} loaded, {b} becomes {value}." =>
            passes(move |_, _, pass| if is_cleared(pass, cleared) && !is_cleared(pass, other) { clear(pass, other) });
    }
    "empty-pass-does-not-clear: A pass without draws does not clear on load." =>
        passes(|_, _, pass| if pass.draws.is_empty() { pass.operations = PassOperations::default() });
    "clear-on-load-of-both-aspects-alone: Depth and stencil are cleared on load together or not at all." =>
        passes(|_, _, pass| {
            if is_cleared(pass, Aspect::Depth) != is_cleared(pass, Aspect::Stencil) {
                load(pass, Aspect::Depth);
                load(pass, Aspect::Stencil);
            }
        });
    "clear-on-load-to-the-last-value: A clear to the value of the clear before is left out." => scene(skip_equal);
    source FAST;
    "command-ignores-its-rectangle: A clear command clears everything." => commands(|_, command| command.rect = None);
    "commands-at-the-start: Clear commands are made into clears on load." => commands(|_, command| command.before = 0);
    "equal-command-skipped: A clear command like an earlier one of the pass is left out." =>
        without(|_, before, command| {
            let alike = |b: &Clear| (b.target, b.rect) == (command.target, command.rect);
            !before.iter().any(alike)
        });
    source CONFUSION;
    for (name, side) in [("row", 3), ("column", 2)] {
        "command-without-last-{name}: The rectangle of a clear command lacks its last {name}." =>
            commands(move |_, command| if let Some(rect) = &mut command.rect { rect[side] -= 1 });
    }
    "clear-ignores-left-of-rectangle: The rectangle of a clear begins at column 0." =>
        commands(|_, command| command.rect = command.rect.map(|[x, y, w, h]| [0, y, x + w, h]));
    "command-upside-down: The rectangle of a clear is counted from the bottom." =>
        passes(|scene, number, pass| {
            let [_, height] = scene.pass_size(&scene.passes[number]);
            for rect in pass.clears.iter_mut().filter_map(|command| command.rect.as_mut()) {
                rect[1] = height.saturating_sub(rect[1] + rect[3]);
            }
        }), source "OpenGL under another API: y from below";
    for (number, word) in [(0, "first"), (1, "second")] {
        "{word}-clear-command-skipped: The {word} clear command of a pass is skipped." =>
            without(move |_, before, _| before.len() != number);
    }
    "later-commands-skipped: Clear commands behind the first draw are left out." =>
        without(|_, _, command| command.before == 0);
    "last-commands-skipped: Clear commands behind the last draw are left out." =>
        without(|pass, _, command| command.before < pass.draws.len());
    "clears-after-all-draws: Clear commands of a pass are executed after its draws." =>
        commands(|pass, command| command.before = pass.draws.len());
    "clears-one-draw-late: Clear commands are executed after the draw that follows them." =>
        commands(|pass, command| command.before = (command.before + 1).min(pass.draws.len()));
    "command-obeys-the-scissor: A clear stays in the scissor of the draw before it." =>
        commands(|pass, command| {
            let before = command.before.checked_sub(1);
            if let Some([x, y, w, h]) = before.and_then(|draw| pass.draws[draw].scissor) {
                let [left, top, width, height] = command.rect.unwrap_or([0, 0, 16, 16]);
                let (l, t) = (left.max(x), top.max(y));
                let (r, b) = ((left + width).min(x + w), (top + height).min(y + h));
                command.rect = Some([l, t, r.saturating_sub(l), b.saturating_sub(t)]);
            }
        }), source "OpenGL: the scissor test applies to clears";
    for (cleared, other, value) in ASPECT_PAIRS {
        let (a, b) = (cleared.name(), other.name());
        "command-clears-{b}-with-{a}: A clear command of {a} sets {b} to {value}." =>
            commands(move |_, command| if reaches(command, cleared) { reach_both(command) });
    }
    source "Mali, PowerVR: one operation for both aspects";
    for (discarded, other, _) in ASPECT_PAIRS {
        let (a, b) = (discarded.name(), other.name());
        "{b}-discarded-with-{a}: Where {a} is discarded, {b} is too." =>
            passes(move |_, _, pass| if is_discarded(pass, discarded) { discard(pass, other) });
    }
    "depth-and-stencil-discarded-with-colour: Where colour is discarded, depth and stencil are too." =>
        passes(|_, _, pass| {
            if is_discarded(pass, Aspect::Color) {
                discard(pass, Aspect::Depth);
                discard(pass, Aspect::Stencil);
            }
        });
}
