//! The driver under test.

use etalon_backend::Backend;
use etalon_conformance::{TestedDriver, known};
use etalon_vulkan::{VulkanBackend, VulkanOptions, enumerate, open};

/// The name of the adapter under test.
fn name() -> String {
    std::env::var("ETALON_VULKAN_ADAPTER").unwrap_or("vulkan:lavapipe".to_owned())
}

/// Returns true if the adapter under test must support everything.
pub(crate) fn is_lavapipe() -> bool {
    name() == "vulkan:lavapipe"
}

/// Opens the adapter under test, or fails the test: without the adapter nothing is tested.
pub(crate) fn backend(validate: bool) -> VulkanBackend {
    let name = name();
    let adapters = enumerate().unwrap_or_else(|e| panic!("these tests need {name}: {e}"));
    let names: Vec<_> = adapters.iter().map(|a| a.name.as_str()).collect();
    let Some(device) = names.iter().position(|n| *n == name) else {
        panic!(
            "these tests need {name}, and there is only {names:?}; apt-get install \
             mesa-vulkan-drivers, or name another in ETALON_VULKAN_ADAPTER"
        );
    };
    let options = VulkanOptions {
        device,
        validate,
        fault: None,
        record: false,
    };
    open(&name, &options).unwrap_or_else(|e| panic!("{name}: {e}"))
}

pub(crate) fn lavapipe() -> TestedDriver<'static> {
    let mut known = known("vulkan:lavapipe");
    if !is_lavapipe() {
        // Other drivers can lack any feature.
        known.lacks = None;
    }
    TestedDriver {
        known,
        environment: Vec::new(),
        open: |validate| -> Box<dyn Backend> { Box::new(backend(validate)) },
        tolerated: &[],
    }
}
