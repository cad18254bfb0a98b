//! Faults in the names of adapters: `gl:llvmpipe:read-fault=off-by-one`, `vulkan:lavapipe:call-fault=last-row`. Such an
//! adapter is the driver as it is, which a test spoils inside the backend, and it is not listed.

use super::backend_name::BackendName;
use etalon_backend::{CallFault, ReadFault};

/// A fault that a test plants in a driver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PlantedFault {
    /// In the read path.
    Read(ReadFault),
    /// Between the backend and the driver.
    Call(CallFault),
}

impl PlantedFault {
    /// Returns the driver and the fault of an adapter's name.
    pub(super) fn in_name(name: &str) -> Option<(&str, Self)> {
        if let Some((driver, fault)) = name.rsplit_once(":read-fault=") {
            return Some((driver, Self::Read(ReadFault::named(fault)?)));
        }
        let (driver, fault) = name.rsplit_once(":call-fault=")?;
        Some((driver, Self::Call(CallFault::named(fault)?)))
    }

    /// True if a backend has a place for it.
    pub(super) fn fits(self, backend: BackendName) -> bool {
        match self {
            Self::Read(_) => backend != BackendName::Cpu,
            Self::Call(fault) => match backend {
                BackendName::Vulkan => fault.is_in_vulkan(),
                BackendName::Gl | BackendName::GlEs => fault.is_in_opengl(),
                _ => false,
            },
        }
    }

    pub(super) fn read(self) -> Option<ReadFault> {
        match self {
            Self::Read(fault) => Some(fault),
            Self::Call(_) => None,
        }
    }

    pub(super) fn call(self) -> Option<CallFault> {
        match self {
            Self::Read(_) => None,
            Self::Call(fault) => Some(fault),
        }
    }
}
