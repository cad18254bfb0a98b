//! Bugs of resolves.

use crate::hooks::{code, resolve};
use crate::list::{CONFUSION, SMALL, bugs};
use crate::permission::under;
use crate::plant::{Plant, nudge, passes, scene};
use etalon_cpu::steps::{Faithful, Steps};
use etalon_frame::ChannelEncoding;
use etalon_pipeline::{Arithmetic, Plain};
use etalon_reference::rules::Resolve;
use etalon_scene::Pass;

/// Replaces a resolved value, given the samples' values in ascending order, and their average.
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

bugs! {
    class "resolve", "multisample";
    source "SwiftShader: sRGB resolved non-linearly, and other averages";
    "srgb-encoded: Samples of sRGB formats are averaged as codes." =>
        resolve(|e, c| match e {
            ChannelEncoding::Srgb8 => c.iter().sum::<u32>() / c.len() as u32,
            _ => Faithful.resolve(e, c),
        }), permitted vec![under!(resolve: Resolve::Between | Resolve::BetweenOrFirst | Resolve::CoarseAverage)];
    "first-sample: A resolve takes the first sample." => resolve(|_, c| c[0]), permitted vec![under!(resolve: Resolve::Between | Resolve::BetweenOrFirst)];
    "last-sample: A resolve takes the last sample." => resolve(|e, c| c[if matches!(e, ChannelEncoding::Uint(_)) { 0 } else { c.len() - 1 }]), permitted vec![under!(resolve: Resolve::Between | Resolve::BetweenOrFirst)];
    "largest: A resolve takes the largest sample." => from_values(|samples, _| samples[samples.len() - 1]);
    "smallest: A resolve takes the smallest sample." => from_values(|samples, _| samples[0]);
    "median: A resolve takes the middle one of the samples." => resolve(|e, c| match e {
            ChannelEncoding::Uint(_) => c[0],
            _ => {
                let mut samples = values(e, c);
                samples.sort_by(f32::total_cmp);
                code(e, samples[samples.len() / 2])
            }
        }), permitted vec![under!(resolve: Resolve::Between | Resolve::BetweenOrFirst)];
    "first-half: A resolve averages the first half of the samples." => resolve(|e, c| average(e, &c[..c.len() / 2]));
    "all-but-one: A resolve leaves out the last sample." => resolve(|e, c| average(e, &c[..c.len() - 1]));
    "weighted: The first sample weighs twice." => resolve(|e, c| average(e, &[c, &c[..1]].concat()));
    "of-4-bits: A resolve computes with four bits." => from_values(|_, mean| (mean * 15.0).floor() / 15.0);
    source SMALL;
    "sum: A resolve adds the samples up." => from_values(|samples, mean| mean * samples.len() as f32);
    "halved: A resolve gives half the average." => from_values(|_, mean| mean / 2.0);
    "by-one-more: A resolve divides by one sample too many." =>
        from_values(|samples, mean| mean * samples.len() as f32 / (samples.len() + 1) as f32);
    "plus-1-lsb: Resolved texels are one code too large." => resolve(|e, c| nudge(e, average(e, c), 1));
    "minus-1-lsb: Resolved texels are one code too small." => resolve(|e, c| nudge(e, average(e, c), -1));
    "zero: A resolve gives 0." => resolve(|_, _| 0);
    source CONFUSION;
    "lost: Nothing is resolved." => passes(|_, _, pass| pass.resolve.fill(None));
    "first-pass-alone: Passes after the first resolve nothing." =>
        passes(|_, number, pass| if number > 0 { pass.resolve.fill(None) });
    "last-pass-to-all: Every resolve takes the final values of the samples." =>
        scene(|scene| {
            let mut resolves = Vec::new();
            for pass in &mut scene.passes {
                for (source, target) in pass.color.iter().zip(&mut pass.resolve) {
                    resolves.extend(target.take().map(|t| (*source, t)));
                }
            }
            // Passes without draws perform the resolves.
            let last = scene.passes.last().cloned();
            for (source, target) in resolves {
                scene.passes.extend(last.clone().map(|last| Pass {
                    draws: Vec::new(),
                    color: vec![source],
                    resolve: vec![Some(target)], ..last
                }));
            }
        }), source "a resolve at the end of the frame and not of the pass";
}
