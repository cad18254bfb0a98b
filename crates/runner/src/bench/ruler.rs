//! The ruler: a fixed amount of work on the processor, whose time shows the current speed of the machine.

use std::hint::black_box;
use std::time::Instant;

/// The description of the work, which changes when the work does.
pub(crate) const RULER: &str = if cfg!(debug_assertions) {
    "80 passes of multiply and add over 2,048 floats, one thread, least of 3, not optimized"
} else {
    "8,000 passes of multiply and add over 2,048 floats, one thread, least of 3"
};

/// Passes of one repetition: about two milliseconds on a processor of 2020. Tests need no meaningful times.
const PASSES: u32 = if cfg!(debug_assertions) { 80 } else { 8000 };
/// The number of repetitions. The least time counts, because interruptions only make a thread slower.
const REPEATS: u32 = 3;
/// Floats in each of two tables: 8 KiB, which fits into the nearest cache.
const TABLE: usize = 2048;

/// Returns the time that the work takes now, in seconds.
///
/// Independent operations, as in a rasterizer, keep all units of a core busy. The ruler therefore shows
/// when another process uses some of these units, which work bound by latency would not.
pub(crate) fn measure() -> f64 {
    let mut values: Vec<f32> = (0..TABLE).map(|i| i as f32).collect();
    let steps: Vec<f32> = (0..TABLE).map(|i| (i % 7) as f32).collect();
    let frame = |_| {
        let start = Instant::now();
        work(black_box(&mut values), black_box(&steps));
        start.elapsed().as_secs_f64()
    };
    let least = (0..REPEATS).map(frame).fold(f64::MAX, f64::min);
    least.max(1e-9)
}

fn work(values: &mut [f32], steps: &[f32]) {
    for _ in 0..PASSES {
        for (value, step) in values.iter_mut().zip(steps) {
            *value = *value * 0.5 + step;
        }
        // Keeps the compiler from exchanging the loop over passes with the inner loop.
        black_box(&mut *values);
    }
}
