//! The shares of the processor's limits that a cell reaches.

use etalon_record::{CellRate, ProcessorLimits};

/// The bytes and operations of a cell in a second, and the limits that they are compared with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reached {
    pub(crate) bytes: f64,
    pub(crate) operations: f64,
    limits: ProcessorLimits,
}

impl Reached {
    /// Returns what a cell reaches, if its work was counted and has a rate.
    pub(crate) fn new(times: &CellRate, limits: ProcessorLimits) -> Option<Self> {
        let units = times.slope.rate()? / times.work as f64;
        let [bytes, operations] = times.traffic.map(|amount| amount as f64 * units);
        (bytes > 0.0).then_some(Self {
            bytes,
            operations,
            limits,
        })
    }

    /// Returns the share of the limit of memory.
    pub(crate) fn of_memory(&self) -> f64 {
        self.bytes / self.limits.bytes
    }

    /// Returns the share of the limit of arithmetic.
    pub(crate) fn of_arithmetic(&self) -> f64 {
        self.operations / self.limits.operations
    }
}
