//! A fixed piece of work on the processor, which shows how fast the machine is at a moment.

use std::hint::black_box;
use std::time::Instant;

/// What [`measure`] does, in words that change when the work does.
pub(crate) const RULER: &str = "1,000,000 dependent steps of integers, floats and a table of 16 KiB, \
                                one thread, least of 3";

/// Steps of one repetition: about two milliseconds on a processor of 2020.
const STEPS: u32 = 1_000_000;
/// Repetitions, of which the least counts: what interrupts a thread only makes it slower.
const REPEATS: u32 = 3;
/// Entries of the table: 16 KiB, which the nearest cache holds.
const TABLE: usize = 4096;

/// How long the work takes now, in seconds.
pub(crate) fn measure() -> f64 {
    let mut table: Vec<u32> = (0..TABLE as u32).collect();
    let one = |_| {
        let start = Instant::now();
        black_box(work(black_box(&mut table)));
        start.elapsed().as_secs_f64()
    };
    let least = (0..REPEATS).map(one).fold(f64::MAX, f64::min);
    least.max(1e-9)
}

fn work(table: &mut [u32]) -> f32 {
    let mut state = 1_u32;
    let mut sum = 0.0_f32;
    for _ in 0..STEPS {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let at = (state >> 20) as usize % TABLE;
        state ^= table[at];
        table[at] = state;
        sum = sum * 0.5 + (state & 0xff) as f32;
    }
    sum
}
