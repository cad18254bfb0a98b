//! Faults that a test plants, to show that the suite finds them.
//!
//! A [`Fault`] describes a fault. The name of an adapter can end in the name of a fault:
//! `gl:llvmpipe:read-fault=off-by-one`. Such an adapter is not listed. The backends of drivers apply faults
//! to calls, through [`FaultyCalls`], and to the values read back; `etalon` applies the other faults to the
//! rasterizer's process.

mod call;
mod calls;
mod limit;
mod process;
mod read;

pub use call::CallFault;
pub use calls::{DrawNumbers, FaultyCalls, OpenQuery};
pub use limit::LimitFault;
pub use process::{FaultyScenes, ProcessFault};
pub use read::ReadFault;

use crate::no_faults::NoFaults;
use etalon_frame::{AdapterName, Api, ChannelEncoding};
use serde::de::value::{Error, StrDeserializer};
use serde::{Deserialize, Serialize};

/// A planted fault, classified by what it affects. For tests of the suite only.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fault {
    /// The calls between a backend and its driver: `call-fault=last-row`.
    Call(CallFault),
    /// Every image that a backend reads back: `read-fault=off-by-one`.
    Read(ReadFault),
    /// The process that draws, for some of the scenes: `fault=abort`, `fault=abort@scissor`.
    Process(ProcessFault, FaultyScenes),
    /// A limit that the adapter reports: `limit=sub-pixel-bits-64`.
    Limit(LimitFault),
    /// The time of each frame, increased by this many per cent: `slower=5%`.
    Slower(f64),
}

impl Fault {
    /// Splits an adapter's name into the name of its driver and the fault that is planted in it.
    ///
    /// # Errors
    /// If the name has a fault, and this build has no planted faults.
    pub fn in_name(name: &str) -> Result<Option<(&str, Self)>, NoFaults> {
        Ok(Self::parsed(name))
    }

    fn parsed(name: &str) -> Option<(&str, Self)> {
        let (driver, kind, fault) = AdapterName::new(name).fault()?;
        let fault = match kind {
            "call-fault" => Self::Call(named(fault)?),
            "read-fault" => Self::Read(named(fault)?),
            "fault" => match fault.strip_suffix("@scissor") {
                Some(fault) => Self::Process(named(fault)?, FaultyScenes::Scissor),
                None => Self::Process(named(fault)?, FaultyScenes::ByHash),
            },
            "limit" => Self::Limit(match fault.strip_prefix("sub-pixel-bits-") {
                Some(bits) => LimitFault::SubPixelBits(bits.parse().ok()?),
                None => named(fault)?,
            }),
            "slower" => {
                let percent = fault.strip_suffix('%')?.parse().ok()?;
                (0.0..=1000.0)
                    .contains(&percent)
                    .then_some(Self::Slower(percent))?
            }
            _ => return None,
        };
        Some((driver, fault))
    }

    /// Returns true if a backend for this API, or the rasterizer for `None`, can have the fault.
    pub fn fits(self, api: Option<Api>) -> bool {
        match self {
            Self::Call(fault) => api.is_some_and(|api| fault.is_in(api)),
            Self::Read(_) => api.is_some(),
            Self::Process(..) | Self::Limit(_) | Self::Slower(_) => api.is_none(),
        }
    }

    /// Changes the codes of an image that a backend reads back.
    pub fn change_codes(
        self,
        codes: &mut [u32],
        size: [u32; 2],
        samples: u32,
        channels: &[ChannelEncoding],
    ) {
        if let Self::Read(fault) = self {
            fault.apply(codes, size, samples, channels);
        }
    }
}

/// Returns the fault of this name.
fn named<'a, T: Deserialize<'a>>(name: &'a str) -> Option<T> {
    T::deserialize(StrDeserializer::<Error>::new(name)).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_fault_of_calls_is_found_by_its_name() {
        for fault in CallFault::ALL {
            let name = format!("gl:llvmpipe:call-fault={}", fault.name());
            let found = Fault::parsed(&name);
            assert_eq!(found, Some(("gl:llvmpipe", Fault::Call(*fault))));
        }
        assert_eq!(Fault::parsed("gl:llvmpipe:call-fault=none"), None);
    }

    #[test]
    fn a_process_fault_is_parsed_from_its_name() {
        for name in [
            "abort",
            "segv",
            "exit",
            "child",
            "close",
            "panic",
            "hang",
            "spin",
            "memory",
            "garbage",
            "half",
            "lost",
            "refused",
            "chatter",
            "validation",
            "flaky",
            "misread",
            "after",
            "start",
            "mute",
        ] {
            let adapter = format!("cpu:fault={name}");
            let Some(("cpu", Fault::Process(fault, FaultyScenes::ByHash))) =
                Fault::parsed(&adapter)
            else {
                panic!("{name} is not a fault");
            };
            assert_eq!(format!("{fault:?}").to_lowercase(), name);
            let adapter = format!("{adapter}@scissor");
            let scissor = Fault::Process(fault, FaultyScenes::Scissor);
            assert_eq!(Fault::parsed(&adapter), Some(("cpu", scissor)));
        }
        for other in ["cpu", "cpu:fault=", "cpu:fault=Abort", "cpu:fault=abort@"] {
            assert_eq!(Fault::parsed(other), None, "{other}");
        }
    }

    #[test]
    fn a_limit_fault_is_parsed_from_its_name() {
        let limit = |name: &str| Fault::parsed(name).map(|(_, fault)| fault);
        for (name, fault) in [
            ("cpu:limit=sub-pixel-bits-64", LimitFault::SubPixelBits(64)),
            ("cpu:limit=sample-outside", LimitFault::SampleOutside),
            ("cpu:limit=one-sample", LimitFault::OneSample),
        ] {
            assert_eq!(limit(name), Some(Fault::Limit(fault)));
        }
        assert_eq!(limit("cpu:limit=sub-pixel-bits-256"), None);
    }

    #[test]
    fn a_slowdown_is_parsed_from_its_percentage() {
        for (name, percent) in [("cpu:slower=5%", 5.0), ("cpu:slower=0.5%", 0.5)] {
            assert_eq!(Fault::parsed(name), Some(("cpu", Fault::Slower(percent))));
        }
        for other in [
            "cpu:slower=5",
            "cpu:slower=%",
            "cpu:slower=-1%",
            "cpu:slower=NaN%",
            "cpu:slower=1e9%",
        ] {
            assert_eq!(Fault::parsed(other), None, "{other}");
        }
    }
}
