//! Query pools, recreated only if a scene needs more queries.

use crate::device::Device;
use crate::error::Check;
use ash::vk;
use etalon_backend::BackendError;

/// Queries of one type.
#[derive(Debug, Default)]
pub(crate) struct TypedQueries {
    /// Null until queries are needed.
    pub(crate) raw: vk::QueryPool,
    room: u32,
}

impl TypedQueries {
    /// Makes room for this many queries. The device must be done with the present ones.
    pub(crate) fn make_room(
        &mut self,
        device: &Device,
        kind: vk::QueryType,
        count: u32,
    ) -> Result<(), BackendError> {
        if count <= self.room {
            return Ok(());
        }
        self.destroy(device);
        *self = Self::default();
        let room = count.next_power_of_two();
        let mut info = vk::QueryPoolCreateInfo::default()
            .query_type(kind)
            .query_count(room);
        if kind == vk::QueryType::PIPELINE_STATISTICS {
            let statistic = vk::QueryPipelineStatisticFlags::FRAGMENT_SHADER_INVOCATIONS;
            info = info.pipeline_statistics(statistic);
        }
        // SAFETY: the device has the feature of every query type.
        let made = unsafe { device.raw.create_query_pool(&info, None) };
        self.raw = made.check("a query pool")?;
        self.room = room;
        Ok(())
    }

    /// Records the reset of the first `count` queries.
    pub(crate) fn reset(&self, device: &Device, commands: vk::CommandBuffer, count: u32) {
        if count > 0 && self.raw != vk::QueryPool::null() {
            // SAFETY: `commands` is being recorded, outside a render pass; the caller made room for the
            // queries.
            unsafe {
                device
                    .raw
                    .cmd_reset_query_pool(commands, self.raw, 0, count);
            }
        }
    }

    /// Returns the results of the first `count` queries. The work that contains them must have finished.
    pub(crate) fn results(&self, device: &Device, count: usize) -> Result<Vec<u64>, BackendError> {
        let mut results = vec![0_u64; count];
        if count > 0 {
            let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
            // SAFETY: each query has one result, and finished work wrote it.
            unsafe {
                device
                    .raw
                    .get_query_pool_results(self.raw, 0, &mut results, flags)
            }
            .check("results of queries")?;
        }
        Ok(results)
    }

    pub(crate) fn destroy(&self, device: &Device) {
        // SAFETY: the device is done with the queries; a null handle is ignored.
        unsafe { device.raw.destroy_query_pool(self.raw, None) };
    }
}
