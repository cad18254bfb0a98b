//! Hidden adapters: the rasterizer with a fault around it. They are not listed, since they test the suite and not a
//! driver.

use super::faulty::{Fault, Faulty, Marked};
use super::slower::{self, Slower};
use etalon_backend::Backend;
use etalon_cpu::CpuBackend;
use serde::{Deserialize, Serialize};
use std::fs::File;

/// The fault of a hidden adapter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Hidden {
    /// Each frame takes this many per cent longer: `cpu:slower=5%`.
    Slower(f64),
    /// The process fails: `cpu:fault=abort`.
    Fault(Fault, Marked),
}

impl Hidden {
    /// Returns the fault of the adapter of this name, if it is a hidden one.
    pub(crate) fn named(name: &str) -> Option<Self> {
        let slower = slower::percent(name).map(Self::Slower);
        slower.or_else(|| Fault::named(name).map(|(fault, marked)| Self::Fault(fault, marked)))
    }

    /// Opens the rasterizer with the fault. `pipe` leads to the parent.
    pub(crate) fn open(&self, name: &str, pipe: File) -> Box<dyn Backend> {
        match self {
            Self::Slower(percent) => Box::new(Slower::new(CpuBackend::spans("cpu"), *percent)),
            Self::Fault(fault, marked) => {
                let planted = (*fault, *marked);
                Box::new(Faulty::new(CpuBackend::spans(name), name, planted, pipe))
            }
        }
    }
}
