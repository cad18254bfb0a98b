//! Bugs between passes: contents, read-only passes, resolves, textures, queries, and submissions after the
//! first.

use super::super::list::{CONFUSION, List};
use super::super::plant::{Plant, again, scene};
use etalon_scene::{Pass, Scene};

const TILER: &str = "Mali, PowerVR, Turnip: contents that a tiler does not keep";

/// True if two passes draw to one attachment at least.
fn share(a: &Pass, b: &Pass) -> bool {
    let color = a.color.iter().any(|i| b.color.contains(i));
    color || a.depth_stencil.is_some() && a.depth_stencil == b.depth_stencil
}

/// Changes the passes of a scene one after the other, given the unchanged ones before each.
fn passes(bug: impl Fn(&[Pass], &mut Pass) + Send + Sync + 'static) -> Plant {
    scene(move |scene| {
        let asked = scene.passes.clone();
        for (i, pass) in scene.passes.iter_mut().enumerate() {
            bug(&asked[..i], pass);
        }
    })
}

/// Empties the passes of which a later pass would lose what they drew.
fn lose(lost: impl Fn(&Scene, usize, usize) -> bool + Send + Sync + 'static) -> Plant {
    scene(move |scene| {
        let asked = scene.clone();
        let all = 0..asked.passes.len();
        for (i, pass) in scene.passes.iter_mut().enumerate() {
            if all.clone().any(|later| later > i && lost(&asked, i, later)) {
                pass.draws.clear();
            }
        }
    })
}

pub(super) fn add(list: &mut List) {
    contents(list);
    depth_stencil(list);
    textures(list);
    queries(list);
    submissions(list);
}

fn contents(list: &mut List) {
    list.add(
        "pass-not-stored",
        TILER,
        "What a pass drew is lost for the next one on the same attachments.",
        lose(|scene, i, later| later == i + 1 && share(&scene.passes[i], &scene.passes[later])),
    );
    list.add(
        "attachment-lost-while-away",
        TILER,
        "What a pass drew is lost where its attachments come back behind another pass.",
        lose(|scene, i, later| later >= i + 2 && share(&scene.passes[i], &scene.passes[later])),
    );
    list.add(
        "attachment-lost-behind-two-passes",
        TILER,
        "What a pass drew is lost where its attachments come back behind two other passes.",
        lose(|scene, i, later| later >= i + 3 && share(&scene.passes[i], &scene.passes[later])),
    );
    list.add(
        "third-pass-dropped",
        CONFUSION,
        "The third pass on an attachment draws nothing.",
        passes(|before, pass| {
            if before.iter().filter(|b| share(b, pass)).count() == 2 {
                pass.draws.clear();
            }
        }),
    );
    list.add(
        "sixteenth-pass-dropped",
        CONFUSION,
        "Passes behind the fifteenth draw nothing.",
        passes(|before, pass| {
            if before.len() >= 15 {
                pass.draws.clear();
            }
        }),
    );
    list.add(
        "framebuffer-not-switched-back",
        "wgpu's GL: a cached framebuffer",
        "The third framebuffer binding in a row of A, B, A stays B where formats allow.",
        scene(|scene| {
            let asked = scene.passes.clone();
            for i in 2..asked.len() {
                let (pass, before) = (&asked[i], &asked[i - 1]);
                let back = pass.color == asked[i - 2].color && pass.color != before.color;
                let shape = |scene: &Scene, pass: &Pass| -> Vec<_> {
                    let all = pass.color.iter().map(|c| &scene.attachments[*c]);
                    all.map(|a| (a.format, a.size, a.samples)).collect()
                };
                if back && shape(scene, pass) == shape(scene, before) {
                    scene.passes[i].color.clone_from(&before.color);
                }
            }
        }),
    );
    for (name, about, which) in [
        ("first", "Only the first target of a pass is resolved.", 0),
        (
            "second",
            "Of several targets, the second is not resolved.",
            1,
        ),
    ] {
        list.add(
            &format!("resolve-{name}-target"),
            CONFUSION,
            about,
            passes(move |_, pass| {
                for (i, target) in pass.resolve.iter_mut().enumerate() {
                    if (which == 0 && i > 0) || (which == 1 && i == 1) {
                        *target = None;
                    }
                }
            }),
        );
    }
    list.add(
        "resolve-once",
        CONFUSION,
        "A target that was resolved to is not resolved to again.",
        passes(|before, pass| {
            for target in &mut pass.resolve {
                let known = |t: usize| before.iter().any(|b| b.resolve.contains(&Some(t)));
                *target = target.filter(|t| !known(*t));
            }
        }),
    );
}

fn depth_stencil(list: &mut List) {
    list.add(
        "read-only-stays",
        "ANGLE: read-only depth feedback loops",
        "The pass behind a read-only one does not write depth and stencil either.",
        passes(|before, pass| {
            if before.last().is_some_and(|b| b.depth_stencil_read_only) {
                for draw in &mut pass.draws {
                    if let Some(depth) = &mut draw.depth {
                        depth.write = false;
                    }
                    if let Some(stencil) = &mut draw.stencil {
                        stencil.front.write_mask = 0;
                        stencil.back.write_mask = 0;
                    }
                }
            }
        }),
    );
    list.add(
        "read-only-first-draw",
        "ANGLE: read-only depth feedback loops",
        "The first draw behind a read-only pass does not write depth.",
        passes(|before, pass| {
            if before.last().is_some_and(|b| b.depth_stencil_read_only)
                && let Some(depth) = pass.draws.first_mut().and_then(|d| d.depth.as_mut())
            {
                depth.write = false;
            }
        }),
    );
    list.add(
        "read-only-untested",
        CONFUSION,
        "A read-only pass does not test.",
        passes(|_, pass| {
            if pass.depth_stencil_read_only {
                for draw in &mut pass.draws {
                    draw.depth = None;
                    draw.stencil = None;
                }
            }
        }),
    );
    list.add(
        "depth-lost-for-the-next-pass",
        TILER,
        "Depth that a pass wrote is not stored where another pass follows.",
        lose_aspect(true, false),
    );
    list.add(
        "stencil-lost-for-the-next-pass",
        TILER,
        "Stencil that a pass wrote is not stored where another pass follows.",
        lose_aspect(false, true),
    );
    list.add(
        "depth-and-stencil-lost-without-colour",
        TILER,
        "Depth and stencil of a pass without colour are not stored.",
        passes(|_, pass| {
            if pass.color.is_empty() {
                pass.draws.clear();
            }
        }),
    );
}

/// Lets no pass but the last write an aspect.
fn lose_aspect(depth: bool, stencil: bool) -> Plant {
    scene(move |scene| {
        let count = scene.passes.len();
        for pass in scene.passes.iter_mut().take(count.saturating_sub(1)) {
            for draw in &mut pass.draws {
                if let Some(state) = draw.depth.as_mut().filter(|_| depth) {
                    state.write = false;
                }
                if let Some(state) = draw.stencil.as_mut().filter(|_| stencil) {
                    state.front.write_mask = 0;
                    state.back.write_mask = 0;
                }
            }
        }
    })
}

fn textures(list: &mut List) {
    list.add(
        "texture-as-first-sampled",
        "wgpu's GL, Zink: a cache that is not flushed",
        "A texture that was sampled keeps what it held then.",
        scene(|scene| {
            let asked = scene.passes.clone();
            for (i, pass) in scene.passes.iter_mut().enumerate() {
                let read = |p: &Pass, c: &usize| p.draws.iter().any(|d| d.textures.contains(c));
                let drawn = |c: &usize| asked[..i].iter().any(|p| read(p, c));
                if pass.color.iter().any(drawn) {
                    pass.draws.clear();
                }
            }
        }),
    );
    list.add(
        "texture-as-uploaded",
        CONFUSION,
        "What was drawn to a texture does not reach a shader that samples it in the next pass.",
        lose(|scene, i, later| {
            let pass = &scene.passes[later];
            let drawn = &scene.passes[i].color;
            let read = pass.draws.iter().flat_map(|d| &d.textures);
            later == i + 1 && read.into_iter().any(|t| drawn.contains(t))
        }),
    );
}

fn queries(list: &mut List) {
    let counters =
        |bug: fn(&mut Vec<u64>)| Plant::Frame(Box::new(move |_, frame| bug(&mut frame.counters)));
    list.add(
        "second-query-gets-the-first",
        "SwiftShader: one query for all",
        "Every query gets the value of the first one.",
        counters(|all| {
            if let Some(first) = all.first().copied() {
                all.fill(first);
            }
        }),
    );
    list.add(
        "queries-in-reverse",
        CONFUSION,
        "Queries come back in reverse.",
        counters(|all| all.reverse()),
    );
    list.add(
        "last-query-lost",
        CONFUSION,
        "Of several queries the last one stays 0.",
        counters(|all| {
            if let [_, .., last] = &mut all[..] {
                *last = 0;
            }
        }),
    );
    list.add(
        "query-of-the-first-pass-alone",
        CONFUSION,
        "A query over several passes keeps the value of the first.",
        passes(|before, pass| {
            let open: Vec<usize> = before
                .iter()
                .flat_map(|b| &b.draws)
                .flat_map(|d| d.counters.clone())
                .collect();
            for draw in &mut pass.draws {
                if !draw.shader.counts_runs() {
                    draw.counters.retain(|c| !open.contains(c));
                }
            }
        }),
    );
    list.add(
        "query-of-the-last-pass-alone",
        CONFUSION,
        "A query over several passes keeps the value of the last.",
        scene(|scene| {
            let asked = scene.passes.clone();
            for (i, pass) in scene.passes.iter_mut().enumerate() {
                let later = asked[i + 1..].iter().flat_map(|b| &b.draws);
                let again: Vec<usize> = later.flat_map(|d| d.counters.clone()).collect();
                for draw in &mut pass.draws {
                    if !draw.shader.counts_runs() {
                        draw.counters.retain(|c| !again.contains(c));
                    }
                }
            }
        }),
    );
}

fn submissions(list: &mut List) {
    let last_draw = |scene: &mut Scene| {
        if let Some(pass) = scene.passes.last_mut() {
            pass.draws.pop();
        }
    };
    for (from, words) in [(2, "second"), (4, "fourth"), (64, "sixty-fourth")] {
        list.add(
            &format!("draw-lost-from-the-{words}-submission"),
            "a ring of buffers that is used up",
            format!("From the {words} submission on the last draw is lost."),
            again(from, last_draw),
        );
    }
    list.add(
        "draw-twice-from-the-second-submission",
        CONFUSION,
        "From the second submission on the last pass is drawn twice.",
        again(2, |scene| scene.passes.extend(scene.passes.last().cloned())),
    );
    list.add(
        "contents-stay-from-the-second-submission",
        "a clear that is skipped as redundant",
        "From the second submission on attachments keep what the one before drew.",
        again(2, |scene| {
            let passes = scene.passes.clone();
            scene.passes.extend(passes);
        }),
    );
    list.add(
        "params-shared-from-the-second-submission",
        "a ring of uniform buffers that wraps",
        "From the second submission on all draws have the parameters of the last.",
        again(2, |scene| {
            let draws = scene.passes.iter().flat_map(|p| &p.draws);
            if let Some(params) = draws.last().map(|d| d.params) {
                let draws = scene.passes.iter_mut().flat_map(|p| &mut p.draws);
                draws.for_each(|d| d.params = params);
            }
        }),
    );
}
