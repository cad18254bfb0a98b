//! The calls of a scene on the device of a run, without that device.

use etalon_backend::{Fault, Recording};
use etalon_record::AdapterRecord;
use etalon_scene::Scene;
use etalon_webgpu::{adapter, lower, plant, recording};

/// Returns the calls that drew a scene on an adapter of backend `webgpu`, as they follow from what its device offers.
///
/// # Errors
/// If the run does not state what the device offers, or the device cannot draw the scene.
pub(crate) fn saved_recording(adapter: &AdapterRecord, scene: &Scene) -> Result<Recording, String> {
    let Some(offer) = &adapter.info.offer else {
        return Err(
            "the run does not state what the device offers, so the calls are unknown; \
             `etalon bundle` without --run draws the case"
                .to_owned(),
        );
    };
    let device = adapter::device(offer)?;
    let mut list = lower(&device, scene).map_err(|missing| missing.to_string())?;
    let fault = Fault::in_name(&adapter.info.name).map_err(|e| e.to_string())?;
    plant(fault.map(|(_, fault)| fault), &mut list);
    recording(
        &list,
        "webgpu",
        &adapter.info.device,
        offer.features.clone(),
    )
    .map_err(|e| e.to_string())
}
