//! An open device and the objects that outlive a scene. They are separate from the backend because a prepared
//! scene needs only them.

use crate::device::Device;
use crate::format::{self, Native};
use crate::limits;
use crate::pipeline::Pipelines;
use crate::pool::UnusedObjects;
use crate::samplers::Samplers;
use crate::samples::SampleReaders;
use crate::slot::Slots;
use etalon_backend::{BackendError, Fault};
use etalon_frame::{Limits, TextureFormat};
use std::cell::RefCell;
use std::collections::BTreeMap;

/// An open device with its limits and pools.
pub(crate) struct Gpu {
    pub(crate) limits: Limits,
    pub(crate) natives: BTreeMap<TextureFormat, Native>,
    pub(crate) pools: RefCell<Pools>,
    /// The fault that a test plants.
    pub(crate) fault: Option<Fault>,
    /// The device is dropped last, because everything else was created from it.
    pub(crate) device: Device,
}

/// The objects that outlive a scene.
#[derive(Default)]
pub(crate) struct Pools {
    pub(crate) slots: Slots,
    pub(crate) memory: UnusedObjects,
    pub(crate) pipelines: Pipelines,
    pub(crate) readers: SampleReaders,
    pub(crate) samplers: Samplers,
}

impl Gpu {
    pub(crate) fn new(device: Device, fault: Option<Fault>) -> Result<Self, BackendError> {
        let natives = format::natives(&device);
        let gpu = Self {
            limits: limits::limits(&device, &natives),
            natives,
            pools: RefCell::default(),
            fault,
            device,
        };
        gpu.pools.borrow_mut().pipelines.create(&gpu.device)?;
        Ok(gpu)
    }
}

impl Drop for Gpu {
    fn drop(&mut self) {
        let pools = self.pools.get_mut();
        // Prepared scenes borrow the device, so all of them have been dropped, and each of them waited for
        // the device to finish.
        pools.slots.destroy(&self.device);
        pools.memory.destroy(&self.device);
        pools.pipelines.destroy(&self.device);
        pools.readers.destroy(&self.device);
        pools.samplers.destroy(&self.device);
    }
}
