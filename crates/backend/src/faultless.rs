//! A build without planted faults. [`Fault`] has no value, so the compiler removes whatever a fault would change.

use crate::fault_name::FaultNameError;
use etalon_frame::{AdapterName, Api, ChannelEncoding};
use serde::{Deserialize, Serialize};

/// The kinds of faults in the names of adapters.
const KINDS: [&str; 5] = ["call-fault", "fault", "limit", "read-fault", "slower"];

/// A planted fault. No value exists without the feature `faults`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Fault {}

impl Fault {
    /// Returns `None`, since no name of an adapter contains a fault.
    ///
    /// # Errors
    /// If the name has a fault.
    pub fn in_name(name: &str) -> Result<Option<(&str, Self)>, FaultNameError> {
        match AdapterName::new(name).fault() {
            Some((_, kind, fault)) if KINDS.contains(&kind) => Err(FaultNameError::Absent {
                name: name.escape_default().to_string(),
                fault: format!("{kind}={}", fault.escape_default()),
            }),
            _ => Ok(None),
        }
    }

    /// Returns true if a backend for this API, or the rasterizer for `None`, can have the fault.
    pub fn fits(self, _api: Option<Api>) -> bool {
        match self {}
    }

    /// Changes the codes of an image that a backend reads back.
    pub fn change_codes(
        self,
        _codes: &mut [u32],
        _size: [u32; 2],
        _samples: u32,
        _channels: &[ChannelEncoding],
    ) {
        match self {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_is_refused_with_a_remedy() {
        let refused = Fault::in_name("vulkan:lavapipe:call-fault=last-row");
        assert_eq!(
            refused.map_err(|error| error.to_string()),
            Err("adapter vulkan:lavapipe:call-fault=last-row cannot be used: `call-fault=last-row` is a planted fault, \
             and this build has none; build etalon with `--features faults`"
                .to_owned())
        );
        for name in [
            "cpu:fault=abort@scissor",
            "cpu:limit=one-sample",
            "gl:llvmpipe:read-fault=off-by-one",
            "cpu:slower=5%",
        ] {
            assert!(Fault::in_name(name).is_err(), "{name}");
        }
    }

    #[test]
    fn a_name_without_a_fault_is_not_refused() {
        for name in ["cpu", "gl:es:softpipe@mesa-22.3.6", "mine:colour=red", "="] {
            assert_eq!(Fault::in_name(name), Ok(None), "{name}");
        }
    }
}
