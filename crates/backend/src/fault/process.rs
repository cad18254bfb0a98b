//! Faults of processes.

use serde::{Deserialize, Serialize};

/// The failure of an adapter's process when it draws one of the [`FaultyScenes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ProcessFault {
    /// The process aborts.
    Abort,
    /// The process reads unmapped memory.
    Segv,
    /// The process ends with status 7.
    Exit,
    /// The process aborts, but a program that it started holds its output.
    Child,
    /// The process reads unmapped memory when its device is destroyed.
    Close,
    /// The suite's own code panics.
    Panic,
    /// The process sleeps endlessly.
    Hang,
    /// The process loops endlessly.
    Spin,
    /// The process allocates memory endlessly.
    Memory,
    /// The process writes bytes that are not a message.
    Garbage,
    /// The process ends in the middle of a message.
    Half,
    /// The device is lost.
    Lost,
    /// An allocation is refused.
    Refused,
    /// The process writes 100,000 lines to standard error, then aborts.
    Chatter,
    /// The process reports a validation message.
    Validation,
    /// Pictures are wrong in about half of all processes.
    Flaky,
    /// Every code of `rgb10a2unorm` is read back one too high in every scene, including round trips.
    Misread,
    /// Pictures of some scenes are wrong if certain other scenes were drawn earlier in the same process.
    After,
    /// Every scene waits for a device: 5 ms for its pipelines and 1 ms for its frame.
    Latency,
    /// The process ends while the driver is opened.
    Start,
    /// The driver never finishes opening.
    Mute,
}

/// The scenes that a fault affects.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FaultyScenes {
    /// Every eighth scene, chosen by a hash.
    ByHash,
    /// The scenes with a draw that has a scissor rectangle.
    Scissor,
}
