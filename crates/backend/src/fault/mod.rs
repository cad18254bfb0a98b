//! Faults that a test plants, to show that the suite finds them.
//!
//! A [`Fault`] describes a fault. The name of an adapter can end in the name of a fault:
//! `gl:llvmpipe:read-fault=off-by-one`. Such an adapter is not listed. The backends of drivers apply faults
//! to calls, through [`FaultyCalls`], and to the values read back; `etalon` applies the other faults to the
//! rasterizer's process.

mod calls;
mod limit;
mod process;
mod read;

pub use calls::{DrawNumbers, FaultyCalls, OpenQuery};
pub use limit::LimitFault;
pub use process::{FaultyScenes, ProcessFault};
pub use read::ReadFault;

use crate::CallFault;
use crate::fault_name::FaultNameError;
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
    /// If no fault has the name, or if the name has a fault and this build has no planted faults.
    pub fn in_name(name: &str) -> Result<Option<(&str, Self)>, FaultNameError> {
        let Some((driver, kind, fault)) = AdapterName::new(name).fault() else {
            return Ok(None);
        };
        match Self::parsed(kind, fault) {
            Ok(fault) => Ok(Some((driver, fault))),
            Err(why) => Err(FaultNameError::Unknown {
                name: name.escape_default().to_string(),
                fault: format!("{kind}={fault}").escape_default().to_string(),
                why,
            }),
        }
    }

    /// Returns the fault of a name's end, or what is wrong with it.
    fn parsed(kind: &str, fault: &str) -> Result<Self, String> {
        Ok(match kind {
            "call-fault" => Self::Call(named(fault)?),
            "read-fault" => Self::Read(named(fault)?),
            "fault" => match fault.strip_suffix("@scissor") {
                Some(fault) => Self::Process(named(fault)?, FaultyScenes::Scissor),
                None => Self::Process(named(fault)?, FaultyScenes::ByHash),
            },
            "limit" => Self::Limit(match fault.strip_prefix("sub-pixel-bits-") {
                Some(bits) => {
                    let wrong =
                        |_| "expected a number from 0 to 255 after `sub-pixel-bits-`".to_owned();
                    LimitFault::SubPixelBits(bits.parse().map_err(wrong)?)
                }
                None => named(fault)?,
            }),
            "slower" => {
                let percent = fault.strip_suffix('%').and_then(|p| p.parse().ok());
                let percent = percent.filter(|p| (0.0..=1000.0).contains(p));
                Self::Slower(
                    percent
                        .ok_or("expected a number of percent from 0 to 1000, as in `slower=5%`")?,
                )
            }
            _ => return Err(format!("expected one of {}", KINDS.join(", "))),
        })
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

/// The kinds of faults, as names spell them.
const KINDS: [&str; 5] = ["call-fault", "fault", "limit", "read-fault", "slower"];

/// Returns the fault of this name.
fn named<'a, T: Deserialize<'a>>(name: &'a str) -> Result<T, String> {
    let read = T::deserialize(StrDeserializer::<Error>::new(name));
    read.map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_fault_of_calls_is_found_by_its_name() {
        for fault in CallFault::ALL {
            let name = format!("gl:llvmpipe:call-fault={}", fault.name());
            let found = Fault::in_name(&name);
            assert_eq!(found, Ok(Some(("gl:llvmpipe", Fault::Call(*fault)))));
        }
        assert_eq!(Fault::in_name("gl:llvmpipe"), Ok(None));
    }

    #[test]
    fn a_mistyped_fault_is_refused_with_the_names_that_exist() {
        for (name, known) in [
            ("gl:llvmpipe:call-fault=last", "`last-row`"),
            ("cpu:fault=abrt", "`segv`"),
            ("cpu:fault=abrt@scissor", "`segv`"),
            ("gl:llvmpipe:read-fault=", "`off-by-one`"),
            ("cpu:limit=none", "`one-sample`"),
            ("cpu:limit=sub-pixel-bits-x", "0 to 255"),
            ("cpu:slower=5", "slower=5%"),
            ("cpu:falt=abort", "call-fault, fault, limit"),
        ] {
            let refused = Fault::in_name(name).map_err(|error| error.to_string());
            let is_told = |text: String| text.contains(name) && text.contains(known);
            assert!(refused.is_err_and(is_told), "{name}");
        }
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
            let Ok(Some(("cpu", Fault::Process(fault, FaultyScenes::ByHash)))) =
                Fault::in_name(&adapter)
            else {
                panic!("{name} is not a fault");
            };
            assert_eq!(format!("{fault:?}").to_lowercase(), name);
            let adapter = format!("{adapter}@scissor");
            let scissor = Fault::Process(fault, FaultyScenes::Scissor);
            assert_eq!(Fault::in_name(&adapter), Ok(Some(("cpu", scissor))));
        }
        for other in ["cpu:fault=", "cpu:fault=Abort", "cpu:fault=abort@"] {
            assert!(Fault::in_name(other).is_err(), "{other}");
        }
    }

    #[test]
    fn a_limit_fault_is_parsed_from_its_name() {
        let limit = |name: &str| Fault::in_name(name).ok().flatten().map(|(_, fault)| fault);
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
            assert_eq!(
                Fault::in_name(name),
                Ok(Some(("cpu", Fault::Slower(percent))))
            );
        }
        for other in [
            "cpu:slower=5",
            "cpu:slower=%",
            "cpu:slower=-1%",
            "cpu:slower=NaN%",
            "cpu:slower=1e9%",
        ] {
            assert!(Fault::in_name(other).is_err(), "{other}");
        }
    }
}
