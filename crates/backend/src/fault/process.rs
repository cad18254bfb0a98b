//! Faults of processes.

use serde::{Deserialize, Serialize};

/// The failure of an adapter's process when it draws one of the [`FaultyScenes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ProcessFault {
    /// The process aborts.
    Abort,
    /// It reads where there is no memory.
    Segv,
    /// It ends with status 7.
    Exit,
    /// The code of the suite panics.
    Panic,
    /// It sleeps endlessly.
    Hang,
    /// It loops endlessly.
    Spin,
    /// It allocates memory endlessly.
    Memory,
    /// It writes bytes that are not a message.
    Garbage,
    /// It ends in the middle of a message.
    Half,
    /// The device is lost.
    Lost,
    /// An allocation is refused.
    Refused,
    /// It writes 100,000 lines to standard error, then aborts.
    Chatter,
    /// It reports a validation message.
    Validation,
    /// Pictures are wrong in about half of all processes.
    Flaky,
    /// Every code of `rgb10a2unorm` is read back one too high, in every scene, round trips included.
    Misread,
    /// Pictures of some scenes are wrong after certain others were drawn in the same process.
    After,
    /// The driver ends the process while it opens.
    Start,
    /// The driver never opens.
    Mute,
}

/// The scenes that fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FaultyScenes {
    /// Every eighth one, chosen by a hash.
    ByHash,
    /// Those with a draw that has a scissor rectangle.
    Scissor,
}
