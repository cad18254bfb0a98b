//! The ruler: a fixed piece of work on the processor, whose time shows the present speed of the machine.

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
/// Repetitions, of which the least counts: what interrupts a thread only makes it slower.
const REPEATS: u32 = 3;
/// Floats of each of two tables: 8 KiB, which the nearest cache holds.
const TABLE: usize = 2048;

/// The time that the work takes now, in seconds.
///
/// Independent operations side by side, as rasterizers do them, keep all of a core's units busy. So the
/// ruler notices when a neighbour takes some of these, which work bound by latency would not.
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
        // Each pass counts: without this they could be exchanged with the loop inside.
        black_box(&mut *values);
    }
}
