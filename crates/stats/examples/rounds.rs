//! Times fixed work in rounds, each in a process of its own, and prints one line per round: the ruler
//! before and after, then the frames, in seconds. This made the files in `tests/data`:
//!
//! ```sh
//! cargo run --release -p etalon-stats --example rounds -- 40 > crates/stats/tests/data/steady.csv
//! ```

use std::env;
use std::hint::black_box;
use std::process::Command;
use std::time::Instant;

/// Frames that are drawn before the first sample.
const WARM_UP: usize = 3;
const FRAMES: usize = 7;

fn main() {
    let argument = env::args().nth(1).unwrap_or_else(|| "60".to_owned());
    if argument == "round" {
        println!("{}", round());
        return;
    }
    let rounds: usize = argument
        .parse()
        .expect("the argument is a number of rounds");
    let itself = env::current_exe().expect("a running program has a path");
    for _ in 0..rounds {
        let output = Command::new(&itself).arg("round").output();
        let output = output.expect("a program can start itself");
        assert!(output.status.success(), "a round failed: {}", output.status);
        print!("{}", String::from_utf8_lossy(&output.stdout));
    }
}

fn round() -> String {
    let mut target = vec![0_u8; 64 * 64 * 4];
    let before = ruler();
    for _ in 0..WARM_UP {
        blend(&mut target);
    }
    let frames: Vec<f64> = (0..FRAMES).map(|_| timed(|| blend(&mut target))).collect();
    let times = [before, ruler()].into_iter().chain(frames);
    let texts: Vec<String> = times.map(|t| format!("{t:.9}")).collect();
    texts.join(",")
}

fn timed(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

/// The fastest of five times of a chain of multiplications that nothing can reorder.
fn ruler() -> f64 {
    let chain = || {
        let mut state = black_box(1_u64);
        for _ in 0..1_000_000 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
        }
        black_box(state);
    };
    (0..5).map(|_| timed(chain)).fold(f64::INFINITY, f64::min)
}

/// Eight translucent layers over 64 x 64 texels of 8 bits a channel.
fn blend(target: &mut [u8]) {
    for layer in 1..=8_u32 {
        let alpha = 20 * layer;
        for (i, channel) in target.iter_mut().enumerate() {
            let source = (i as u32 * layer) & 0xff;
            let sum = source * alpha + u32::from(*channel) * (255 - alpha);
            *channel = ((sum + 127) / 255) as u8;
        }
        black_box(&mut *target);
    }
}
