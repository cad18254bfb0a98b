//! Bugs of resolves.

use crate::hooks::{code, resolve};
use crate::list::{CONFUSION, List, SMALL};
use crate::plant::{Plant, nudge};
use etalon_frame::ChannelEncoding;
use etalon_pipeline::{Arithmetic, Plain};
use etalon_scene::Pass;

const CODES_AVERAGED: &str = "Vulkan: VkResolveModeFlagBits: sRGB samples should be made linear before \
                              they are averaged, and need not be";

/// Replaces a resolved value, given those of the samples, in ascending order, and their average.
fn from_values(bug: fn(&[f32], f32) -> f32) -> Plant {
    resolve(move |encoding, codes| {
        let mean = mean(encoding, codes);
        let mut values = values(encoding, codes);
        values.sort_by(f32::total_cmp);
        code(encoding, bug(&values, mean))
    })
}

fn values(encoding: ChannelEncoding, codes: &[u32]) -> Vec<f32> {
    let decode = |c: &u32| Plain::<1>.decode(encoding, [*c])[0];
    codes.iter().map(decode).collect()
}

fn mean(encoding: ChannelEncoding, codes: &[u32]) -> f32 {
    values(encoding, codes).iter().sum::<f32>() / codes.len() as f32
}

fn average(encoding: ChannelEncoding, codes: &[u32]) -> u32 {
    code(encoding, mean(encoding, codes))
}

pub(super) fn add(list: &mut List) {
    list.class("resolve", "multisample");
    picked(list);
    wrong(list);
    passes(list);
}

fn picked(list: &mut List) {
    list.source("SwiftShader: sRGB resolved non-linearly, and other averages");
    list.bug("srgb-encoded: Samples of sRGB formats are averaged as codes.")
        .legal(CODES_AVERAGED)
        .plant(resolve(|e, c| match e {
            ChannelEncoding::Srgb8 => c.iter().sum::<u32>() / c.len() as u32,
            _ => average(e, c),
        }));
    list.bug("first-sample: A resolve takes the first sample.")
        .plant(resolve(|_, c| c[0]));
    list.bug("last-sample: A resolve takes the last sample.")
        .plant(resolve(|_, c| c[c.len() - 1]));
    list.bug("largest: A resolve takes the largest sample.")
        .plant(from_values(|samples, _| samples[samples.len() - 1]));
    list.bug("smallest: A resolve takes the smallest sample.")
        .plant(from_values(|samples, _| samples[0]));
    list.bug("median: A resolve takes the middle one of the samples.")
        .plant(from_values(|samples, _| samples[samples.len() / 2]));
    list.bug("first-half: A resolve averages the first half of the samples.")
        .plant(resolve(|e, c| average(e, &c[..c.len() / 2])));
    list.bug("all-but-one: A resolve leaves out the last sample.")
        .plant(resolve(|e, c| average(e, &c[..c.len() - 1])));
    list.bug("weighted: The first sample weighs twice.")
        .plant(resolve(|e, c| average(e, &[c, &c[..1]].concat())));
    list.bug("of-4-bits: A resolve computes with four bits.")
        .plant(from_values(|_, mean| (mean * 15.0).floor() / 15.0));
}

fn wrong(list: &mut List) {
    list.source(SMALL);
    list.bug("sum: A resolve adds the samples up.")
        .plant(from_values(|samples, mean| mean * samples.len() as f32));
    list.bug("halved: A resolve gives half the average.")
        .plant(from_values(|_, mean| mean / 2.0));
    list.bug("by-one-more: A resolve divides by one sample too many.")
        .plant(from_values(|samples, mean| {
            mean * samples.len() as f32 / (samples.len() + 1) as f32
        }));
    list.bug("plus-1-lsb: Resolved texels are one code too large.")
        .plant(resolve(|e, c| nudge(e, average(e, c), 1)));
    list.bug("minus-1-lsb: Resolved texels are one code too small.")
        .plant(resolve(|e, c| nudge(e, average(e, c), -1)));
    list.bug("zero: A resolve gives 0.")
        .plant(resolve(|_, _| 0));
}

fn passes(list: &mut List) {
    list.source(CONFUSION);
    list.bug("lost: Nothing is resolved.")
        .passes(|_, _, pass| pass.resolve.fill(None));
    list.bug("first-pass-alone: Passes after the first resolve nothing.")
        .passes(|_, number, pass| {
            if number > 0 {
                pass.resolve.fill(None);
            }
        });
    list.bug("last-pass-to-all: Every resolve takes the final values of the samples.")
        .source("a resolve at the end of the frame and not of the pass")
        .scene(|scene| {
            let mut resolves = Vec::new();
            for pass in &mut scene.passes {
                for (source, target) in pass.color.iter().zip(&mut pass.resolve) {
                    resolves.extend(target.take().map(|t| (*source, t)));
                }
            }
            // Passes that draw nothing hold the resolves.
            let last = scene.passes.last().cloned();
            for (source, target) in resolves {
                scene.passes.extend(last.clone().map(|last| Pass {
                    draws: Vec::new(),
                    color: vec![source],
                    resolve: vec![Some(target)],
                    ..last
                }));
            }
        });
}
