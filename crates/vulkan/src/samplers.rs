//! Samplers, shared by all scenes.

use crate::device::Device;
use crate::error::Check;
use ash::vk;
use etalon_backend::BackendError;
use etalon_scene::{AddressMode, FilterMode, Sampler};
use std::collections::HashMap;

/// The samplers created so far. Few are distinct, so all are kept.
#[derive(Debug, Default)]
pub(crate) struct Samplers {
    samplers: HashMap<Sampler, vk::Sampler>,
}

impl Samplers {
    /// Returns the Vulkan sampler, created on first use.
    pub(crate) fn get(
        &mut self,
        device: &Device,
        sampler: Sampler,
    ) -> Result<vk::Sampler, BackendError> {
        if let Some(raw) = self.samplers.get(&sampler) {
            return Ok(*raw);
        }
        let filter = match sampler.filter {
            FilterMode::Nearest => vk::Filter::NEAREST,
            FilterMode::Linear => vk::Filter::LINEAR,
        };
        let [across, down] = sampler.address.map(|mode| match mode {
            AddressMode::ClampToEdge => vk::SamplerAddressMode::CLAMP_TO_EDGE,
            AddressMode::Repeat => vk::SamplerAddressMode::REPEAT,
            AddressMode::MirrorRepeat => vk::SamplerAddressMode::MIRRORED_REPEAT,
        });
        let info = vk::SamplerCreateInfo::default()
            .mag_filter(filter)
            .min_filter(filter)
            .address_mode_u(across)
            .address_mode_v(down);
        // SAFETY: the device is alive.
        let raw = unsafe { device.raw.create_sampler(&info, None) }.check("a sampler")?;
        self.samplers.insert(sampler, raw);
        Ok(raw)
    }

    /// Destroys everything. The device must still exist.
    pub(crate) fn destroy(&mut self, device: &Device) {
        for (_, raw) in self.samplers.drain() {
            // SAFETY: nothing uses it any longer.
            unsafe { device.raw.destroy_sampler(raw, None) };
        }
    }
}
