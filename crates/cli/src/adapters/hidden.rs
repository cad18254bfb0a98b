//! Adapters that no list names, for they are nobody's driver: the rasterizer with something planted
//! around it, to be watched while it is found.

use crate::slower::{self, Slower};
use etalon_backend::Backend;
use etalon_cpu::CpuBackend;
use serde::{Deserialize, Serialize};

/// What is planted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Hidden {
    /// Each frame takes so many per cent longer: `cpu:slower=5%`.
    Slower(f64),
}

impl Hidden {
    /// What the adapter of this name has planted; `None` where the name is nobody's here.
    pub(crate) fn named(name: &str) -> Option<Self> {
        slower::percent(name).map(Self::Slower)
    }

    /// The rasterizer with it.
    pub(crate) fn open(&self) -> Box<dyn Backend> {
        match self {
            Self::Slower(percent) => Box::new(Slower::new(CpuBackend::new("cpu"), *percent)),
        }
    }
}
