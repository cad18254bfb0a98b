//! Bugs of resolves.

use crate::hooks::{code, resolve};
use crate::list::{CONFUSION, List, SMALL};
use crate::plant::{nudge, scene};
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
    list.bug("srgb-encoded: Samples of sRGB formats are averaged as codes.")
        .source("SwiftShader: sRGB resolved non-linearly, and other averages")
        .legal(CODES_AVERAGED)
        .plant(resolve(|e, c| match e {
            ChannelEncoding::Srgb8 => c.iter().sum::<u32>() / c.len() as u32,
            _ => average(e, c),
        }));

    let source = "SwiftShader: sRGB resolved non-linearly, and other averages";
    list.source(source);
    list.bug("first-sample: A resolve takes the first sample.")
        .plant(resolve(|_, c| c[0]));
    list.bug("last-sample: A resolve takes the last sample.")
        .plant(resolve(|_, c| c[c.len() - 1]));
    list.bug("largest: A resolve takes the largest sample.")
        .plant(resolve(|e, c| {
            code(e, values(e, c).into_iter().fold(f32::MIN, f32::max))
        }));
    list.bug("smallest: A resolve takes the smallest sample.")
        .plant(resolve(|e, c| {
            code(e, values(e, c).into_iter().fold(f32::MAX, f32::min))
        }));
    list.bug("median: A resolve takes the middle one of the samples.")
        .plant(resolve(|e, c| {
            let mut all = values(e, c);
            all.sort_by(f32::total_cmp);
            code(e, all[all.len() / 2])
        }));
    list.bug("first-half: A resolve averages the first half of the samples.")
        .plant(resolve(|e, c| average(e, &c[..c.len() / 2])));
    list.bug("all-but-one: A resolve leaves out the last sample.")
        .plant(resolve(|e, c| average(e, &c[..c.len() - 1])));
    list.bug("weighted: The first sample weighs twice.")
        .plant(resolve(|e, c| {
            let all: Vec<u32> = c.iter().chain(&c[..1]).copied().collect();
            average(e, &all)
        }));
    list.bug("of-4-bits: A resolve computes with four bits.")
        .plant(resolve(|e, c| {
            let mean = values(e, c).iter().sum::<f32>() / c.len() as f32;
            code(e, (mean * 15.0).floor() / 15.0)
        }));

    list.source(SMALL);
    list.bug("sum: A resolve adds the samples up.")
        .plant(resolve(|e, c| code(e, values(e, c).iter().sum())));
    list.bug("halved: A resolve gives half the average.")
        .plant(resolve(|e, c| {
            code(e, values(e, c).iter().sum::<f32>() / c.len() as f32 / 2.0)
        }));
    list.bug("by-one-more: A resolve divides by one sample too many.")
        .plant(resolve(|e, c| {
            code(e, values(e, c).iter().sum::<f32>() / (c.len() + 1) as f32)
        }));
    list.bug("plus-1-lsb: Resolved texels are one code too large.")
        .plant(resolve(|e, c| nudge(e, average(e, c), 1)));
    list.bug("minus-1-lsb: Resolved texels are one code too small.")
        .plant(resolve(|e, c| nudge(e, average(e, c), -1)));
    list.bug("zero: A resolve gives 0.")
        .plant(resolve(|_, _| 0));
    list.source(CONFUSION);
    list.bug("lost: Nothing is resolved.").plant(scene(|scene| {
        scene.passes.iter_mut().for_each(|p| p.resolve.fill(None))
    }));
    list.bug("first-pass-alone: Passes after the first resolve nothing.")
        .plant(scene(|scene| {
            let rest = scene.passes.iter_mut().skip(1);
            rest.for_each(|p| p.resolve.fill(None));
        }));
    list.bug("last-pass-to-all: Every resolve takes the final values of the samples.")
        .source("a resolve at the end of the frame and not of the pass")
        .plant(scene(|scene| {
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
        }));
}

fn average(encoding: ChannelEncoding, codes: &[u32]) -> u32 {
    code(
        encoding,
        values(encoding, codes).iter().sum::<f32>() / codes.len() as f32,
    )
}
