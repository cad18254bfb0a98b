//! The processor's limits: the fastest copy and the fastest arithmetic, measured. No cell of the performance matrix
//! can be faster than both, unless caches keep its texels.

use crate::tiles::{KernelMachine, on_threads};
use fearless_simd::{dispatch, f32x16, prelude::*};
use std::hint::black_box;
use std::time::Instant;

/// The highest rates that the processor reaches with a number of threads.
#[derive(Clone, Copy, Debug)]
pub struct ProcessorRates {
    /// The number of threads.
    pub threads: usize,
    /// The bytes that a copy larger than the caches reads and writes in a second.
    pub bytes: f64,
    /// The products and sums of 32-bit floats in a second, not fused, in the widest vectors.
    pub operations: f64,
}

/// The words that are copied, for all threads together: 64 MiB to 64 MiB, more than most caches. Tests need no
/// meaningful rates.
const WORDS: usize = if cfg!(debug_assertions) {
    1 << 16
} else {
    1 << 24
};
/// Products and sums of each chain.
const STEPS: usize = if cfg!(debug_assertions) {
    1 << 10
} else {
    1 << 20
};
/// Chains that a thread computes side by side, so that none waits for the other's result.
const CHAINS: usize = 8;
/// The lanes of a chain.
const WIDTH: usize = 16;
/// The number of repetitions. The least time counts, because interruptions only make a thread slower.
const REPEATS: usize = 5;

/// Measures the limits with one thread and with all threads of this machine.
pub fn limits() -> Vec<ProcessorRates> {
    let machine = KernelMachine::whole();
    let mut counts = vec![1, machine.threads];
    counts.dedup();
    let (from, mut to) = (vec![1_u64; WORDS / 2], vec![2_u64; WORDS / 2]);
    let measured = counts.into_iter().map(|threads| ProcessorRates {
        threads,
        bytes: copied(&from, &mut to, threads),
        operations: computed(KernelMachine { threads, ..machine }),
    });
    measured.collect()
}

/// Returns the bytes that a copy moves in a second.
fn copied(from: &[u64], to: &mut [u64], threads: usize) -> f64 {
    let each = from.len().div_ceil(threads);
    let bytes = 2 * size_of_val(from);
    let seconds = least(|| {
        let parts = from.chunks(each).zip(to.chunks_mut(each)).collect();
        on_threads(parts, &|(from, to): (&[u64], &mut [u64])| {
            black_box(to).copy_from_slice(black_box(from));
        });
    });
    bytes as f64 / seconds
}

/// Returns the products and sums in a second.
fn computed(machine: KernelMachine) -> f64 {
    let seconds = least(|| {
        on_threads(vec![(); machine.threads], &|()| {
            dispatch!(machine.level, simd => chains(simd));
        });
    });
    (2 * STEPS * CHAINS * WIDTH * machine.threads) as f64 / seconds
}

#[inline(always)]
fn chains<S: Simd>(simd: S) {
    simd.vectorize(
        #[inline(always)]
        || {
            let splat = |value: f32| f32x16::splat(simd, black_box(value));
            let (factor, summand) = (splat(0.5), splat(1.0));
            let mut chains = [splat(3.0); CHAINS];
            for _ in 0..STEPS {
                for chain in &mut chains {
                    *chain = *chain * factor + summand;
                }
            }
            for chain in chains {
                let mut values = [0.0; WIDTH];
                chain.store_slice(&mut values);
                black_box(values);
            }
        },
    );
}

/// Returns the least time of some work, in seconds.
fn least(mut work: impl FnMut()) -> f64 {
    let time = |_| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64()
    };
    (0..REPEATS).map(time).fold(f64::MAX, f64::min).max(1e-9)
}

#[cfg(test)]
mod tests {
    #[test]
    fn limits_are_measured_for_one_thread_and_for_all() {
        let limits = super::limits();
        assert_eq!(limits[0].threads, 1);
        for limit in limits {
            assert!(limit.bytes > 0.0 && limit.operations > 0.0, "{limit:?}");
            assert!(limit.bytes.is_finite() && limit.operations.is_finite());
        }
    }
}
