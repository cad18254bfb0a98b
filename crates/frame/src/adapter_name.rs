//! Names of adapters.

/// The name of an adapter: its backend, the API below it if there are several, its driver, the driver's release and a
/// planted fault, such as `gl:es:softpipe@mesa-22.3.6:call-fault=last-row`. Only the backend is always there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct AdapterName<'a>(&'a str);

impl<'a> AdapterName<'a> {
    /// Takes a name apart. Any text has parts, also if no adapter has this name.
    pub fn new(name: &'a str) -> Self {
        Self(name)
    }

    /// Returns the parts between colons.
    pub fn parts(self) -> impl DoubleEndedIterator<Item = &'a str> {
        self.0.split(':')
    }

    /// Returns the backend: the first part.
    pub fn backend(self) -> &'a str {
        let first = self.parts().next().unwrap_or_default();
        first.split_once('@').map_or(first, |(backend, _)| backend)
    }

    /// Returns the driver, without the API that leads to it, its release and a planted fault; the backend if the name
    /// has no driver.
    pub fn driver(self) -> &'a str {
        let last = self.parts().rfind(|part| !part.contains('='));
        let last = last.unwrap_or(self.0);
        last.split_once('@').map_or(last, |(driver, _)| driver)
    }

    /// Returns the name before its release. Releases of one driver have it in common.
    pub fn without_release(self) -> &'a str {
        self.0.split_once('@').map_or(self.0, |(name, _)| name)
    }

    /// Returns the name without its planted fault, the fault's kind and the fault; `None` without a fault.
    pub fn fault(self) -> Option<(&'a str, &'a str, &'a str)> {
        let (name, fault) = self.0.rsplit_once(':')?;
        let (kind, fault) = fault.split_once('=')?;
        Some((name, kind, fault))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_has_a_backend_a_driver_a_release_and_a_fault() {
        for (name, backend, driver, without_release) in [
            ("cpu", "cpu", "cpu", "cpu"),
            ("vulkan:lavapipe", "vulkan", "lavapipe", "vulkan:lavapipe"),
            ("gl:es:softpipe", "gl", "softpipe", "gl:es:softpipe"),
            (
                "gl:es:softpipe@mesa-22.3.6:call-fault=last-row",
                "gl",
                "softpipe",
                "gl:es:softpipe",
            ),
            ("cpu:fault=abort", "cpu", "cpu", "cpu:fault=abort"),
            (
                "wgpu:vulkan:lavapipe",
                "wgpu",
                "lavapipe",
                "wgpu:vulkan:lavapipe",
            ),
            ("mine@7", "mine", "mine", "mine"),
            ("a=b", "a=b", "a=b", "a=b"),
            (":", "", "", ":"),
            ("", "", "", ""),
        ] {
            let parsed = AdapterName::new(name);
            assert_eq!(parsed.backend(), backend, "{name}");
            assert_eq!(parsed.driver(), driver, "{name}");
            assert_eq!(parsed.without_release(), without_release, "{name}");
        }
        let fault = |name| AdapterName::new(name).fault();
        assert_eq!(
            fault("cpu:fault=abort@scissor"),
            Some(("cpu", "fault", "abort@scissor"))
        );
        assert_eq!(fault("gl:es:softpipe"), None);
    }
}
