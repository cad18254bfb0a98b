//! Conversion of clip distances to cull distances, which WGSL lacks.

use crate::spirv::{BUILT_IN, CAPABILITY, DECORATE, instructions};

/// The capabilities ClipDistance and CullDistance.
const CAPABILITIES: [u32; 2] = [32, 33];
/// The built-ins ClipDistance and CullDistance.
const BUILT_INS: [u32; 2] = [3, 4];

/// Returns the module with its clip distances turned into cull distances.
pub(crate) fn as_cull_distances(words: &[u32]) -> Vec<u32> {
    let (header, instructions) = instructions(words);
    let mut out = header.to_vec();
    for line in instructions {
        let start = out.len();
        out.extend(line);
        let made = &mut out[start..];
        match *made {
            [head, capability] if head & 0xffff == CAPABILITY && capability == CAPABILITIES[0] => {
                made[1] = CAPABILITIES[1];
            }
            [head, _, BUILT_IN, built_in]
                if head & 0xffff == DECORATE && built_in == BUILT_INS[0] =>
            {
                made[3] = BUILT_INS[1];
            }
            _ => {}
        }
    }
    out
}
