//! Sampling textures in 32-bit floats.

use crate::lanes::{LANES, Real};
use crate::surface::CpuSurface;
use etalon_pipeline::{Arithmetic, Plain, texel_position};
use etalon_scene::{FilterMode, Sampler};

/// Returns the texture's value at one coordinate per lane.
pub(crate) fn sample(surface: &CpuSurface, sampler: Sampler, u: Real, v: Real) -> [Real; 4] {
    let mut result = [[0.0; LANES]; 4];
    for lane in 0..LANES {
        let coordinates = [
            u[lane] * surface.width as f32,
            v[lane] * surface.height as f32,
        ];
        let texel = match sampler.filter {
            FilterMode::Nearest => tap(surface, sampler, coordinates.map(|c| c.floor() as i64)),
            FilterMode::Linear => weighted(surface, sampler, coordinates.map(|c| c - 0.5)),
        };
        for (channel, value) in result.iter_mut().zip(texel) {
            channel[lane] = value;
        }
    }
    result
}

fn tap(surface: &CpuSurface, sampler: Sampler, position: [i64; 2]) -> [f32; 4] {
    let [across, down] = sampler.address;
    let x = texel_position(across, position[0], surface.width as u32);
    let y = texel_position(down, position[1], surface.height as u32);
    std::array::from_fn(|c| match surface.encodings.get(c) {
        Some(encoding) => {
            let code = surface.plane(c, 0)[y * surface.stride + x];
            let [value] = Plain::<1>.decode(*encoding, [code]);
            value
        }
        // A format without alpha is read with alpha 1.
        None => f32::from(u8::from(c == 3)),
    })
}

/// Returns the weighted average at a position that is relative to the centre of the first texel.
fn weighted(surface: &CpuSurface, sampler: Sampler, position: [f32; 2]) -> [f32; 4] {
    let first = position.map(f32::floor);
    let weight = [position[0] - first[0], position[1] - first[1]];
    let mut sum = [0.0; 4];
    for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        let part = |axis: usize, far: i64| match far {
            0 => 1.0 - weight[axis],
            _ => weight[axis],
        };
        let share = part(0, dx) * part(1, dy);
        let texel = tap(
            surface,
            sampler,
            [
                (first[0] as i64).saturating_add(dx),
                (first[1] as i64).saturating_add(dy),
            ],
        );
        for (sum, value) in sum.iter_mut().zip(texel) {
            *sum += value * share;
        }
    }
    sum
}
