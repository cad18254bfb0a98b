//! Adapters that no list names, for they are nobody's driver: the rasterizer with something planted
//! around it, to be watched while it is found.

use super::faulty::{Fault, Faulty};
use super::slower::{self, Slower};
use etalon_backend::Backend;
use etalon_cpu::CpuBackend;
use serde::{Deserialize, Serialize};
use std::fs::File;

/// What is planted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Hidden {
    /// Each frame takes so many per cent longer: `cpu:slower=5%`.
    Slower(f64),
    /// Something goes wrong with the process: `cpu:fault=abort`.
    Fault(Fault),
}

impl Hidden {
    /// What the adapter of this name has planted; `None` where the name is nobody's here.
    pub(crate) fn named(name: &str) -> Option<Self> {
        let slower = slower::percent(name).map(Self::Slower);
        slower.or_else(|| Fault::named(name).map(Self::Fault))
    }

    /// The rasterizer with it, under a name. `pipe` is the one to the parent.
    pub(crate) fn open(&self, name: &str, pipe: File) -> Box<dyn Backend> {
        match self {
            Self::Slower(percent) => Box::new(Slower::new(CpuBackend::new("cpu"), *percent)),
            Self::Fault(fault) => Box::new(Faulty::new(CpuBackend::new(name), name, *fault, pipe)),
        }
    }
}
