//! Bugs of resolves.

use super::hooks::{code, resolve};
use super::list::{CONFUSION, List, Row, SMALL};
use super::plant::{nudge, scene};
use etalon_frame::ChannelEncoding;
use etalon_pipeline::{Arithmetic, Plain};

pub(super) fn add(list: &mut List) {
    list.class("resolve", "multisample");
    resolves(list);
}

const CODES_AVERAGED: &str = "Vulkan: VkResolveModeFlagBits: sRGB samples should be made linear before \
                              they are averaged, and need not be";

fn values(encoding: ChannelEncoding, codes: &[u32]) -> Vec<f32> {
    let decode = |c: &u32| Plain::<1>.decode(encoding, [*c])[0];
    codes.iter().map(decode).collect()
}

fn resolves(list: &mut List) {
    type Bug = fn(ChannelEncoding, &[u32]) -> u32;
    list.add(
        "srgb-encoded",
        "SwiftShader: sRGB resolved non-linearly, and other averages",
        "Samples of sRGB formats are averaged as codes.",
        resolve(|e, c| match e {
            ChannelEncoding::Srgb8 => c.iter().sum::<u32>() / c.len() as u32,
            _ => average(e, c),
        }),
    )
    .legal(CODES_AVERAGED);
    let picked: [Row<Bug>; 9] = [
        (
            "first-sample",
            "A resolve takes the first sample.",
            |_, c| c[0],
        ),
        ("last-sample", "A resolve takes the last sample.", |_, c| {
            c[c.len() - 1]
        }),
        ("largest", "A resolve takes the largest sample.", |e, c| {
            code(e, values(e, c).into_iter().fold(f32::MIN, f32::max))
        }),
        (
            "smallest",
            "A resolve takes the smallest sample.",
            |e, c| code(e, values(e, c).into_iter().fold(f32::MAX, f32::min)),
        ),
        (
            "median",
            "A resolve takes the middle one of the samples.",
            |e, c| {
                let mut all = values(e, c);
                all.sort_by(f32::total_cmp);
                code(e, all[all.len() / 2])
            },
        ),
        (
            "first-half",
            "A resolve averages the first half of the samples.",
            |e, c| average(e, &c[..c.len() / 2]),
        ),
        (
            "all-but-one",
            "A resolve leaves out the last sample.",
            |e, c| average(e, &c[..c.len() - 1]),
        ),
        ("weighted", "The first sample weighs twice.", |e, c| {
            let all: Vec<u32> = c.iter().chain(&c[..1]).copied().collect();
            average(e, &all)
        }),
        ("of-4-bits", "A resolve computes with four bits.", |e, c| {
            let mean = values(e, c).iter().sum::<f32>() / c.len() as f32;
            code(e, (mean * 15.0).floor() / 15.0)
        }),
    ];
    let source = "SwiftShader: sRGB resolved non-linearly, and other averages";
    list.rows(source, resolve, &picked);
    let wrong: [Row<Bug>; 6] = [
        ("sum", "A resolve adds the samples up.", |e, c| {
            code(e, values(e, c).iter().sum())
        }),
        ("halved", "A resolve gives half the average.", |e, c| {
            code(e, values(e, c).iter().sum::<f32>() / c.len() as f32 / 2.0)
        }),
        (
            "by-one-more",
            "A resolve divides by one sample too many.",
            |e, c| code(e, values(e, c).iter().sum::<f32>() / (c.len() + 1) as f32),
        ),
        (
            "plus-1-lsb",
            "Resolved texels are one code too large.",
            |e, c| nudge(e, average(e, c), 1),
        ),
        (
            "minus-1-lsb",
            "Resolved texels are one code too small.",
            |e, c| nudge(e, average(e, c), -1),
        ),
        ("zero", "A resolve gives 0.", |_, _| 0),
    ];
    list.rows(SMALL, resolve, &wrong);
    list.add(
        "lost",
        CONFUSION,
        "Nothing is resolved.",
        scene(|scene| scene.passes.iter_mut().for_each(|p| p.resolve.fill(None))),
    );
    list.add(
        "first-pass-alone",
        CONFUSION,
        "Passes after the first resolve nothing.",
        scene(|scene| {
            let rest = scene.passes.iter_mut().skip(1);
            rest.for_each(|p| p.resolve.fill(None));
        }),
    );
    list.add(
        "last-pass-to-all",
        "a resolve at the end of the frame and not of the pass",
        "Every resolve takes the final values of the samples.",
        scene(|scene| {
            let mut targets = Vec::new();
            for pass in &mut scene.passes {
                for (source, target) in pass.color.iter().zip(&mut pass.resolve) {
                    targets.extend(target.take().map(|t| (*source, t)));
                }
            }
            // Passes that draw nothing hold the resolves.
            let last = scene.passes.last().cloned();
            for (source, target) in targets {
                scene.passes.extend(last.clone().map(|mut pass| {
                    pass.draws.clear();
                    pass.color = vec![source];
                    pass.resolve = vec![Some(target)];
                    pass
                }));
            }
        }),
    );
}

fn average(encoding: ChannelEncoding, codes: &[u32]) -> u32 {
    code(
        encoding,
        values(encoding, codes).iter().sum::<f32>() / codes.len() as f32,
    )
}
