//! Memories that are filled from the mapped buffer.

use etalon_backend::{Argument, RecordedCall, Recording};

/// A memory that is filled from the mapped buffer.
pub(super) struct FilledMemory {
    /// True if the bytes are single bits, four per texel in each of two images.
    bits: bool,
    /// The parts: offset, distance between rows, bytes per row, number of rows.
    parts: Vec<[u64; 4]>,
}

impl FilledMemory {
    /// Returns an expression for the memory's bytes. `bytes` is an expression for the mapped bytes.
    pub(super) fn expression(&self, bytes: &str) -> String {
        let part = |[offset, pitch, row, rows]: &[u64; 4]| {
            format!("rows({bytes}, {offset}, {pitch}, {row}, {rows})")
        };
        let parts: Vec<String> = self.parts.iter().map(part).collect();
        let parts = parts.join(", ");
        if self.bits {
            format!("bits({parts})")
        } else {
            parts
        }
    }
}

/// Returns the memories in their order.
pub(super) fn memories(recording: &Recording) -> Vec<FilledMemory> {
    let number = |argument: &Argument| match argument {
        Argument::Offset(number) => *number,
        Argument::Unsigned(number) => u64::from(*number),
        _ => 0,
    };
    let memory = |call: &RecordedCall| FilledMemory {
        bits: call.function == "read_bits",
        parts: call
            .arguments
            .chunks_exact(4)
            .map(|p| [number(&p[0]), number(&p[1]), number(&p[2]), number(&p[3])])
            .collect(),
    };
    recording.calls.iter().map(memory).collect()
}
