//! GPU time of a submit.

use std::time::Duration;
use wgpu::BufferUsages;

/// Two timestamps around the passes of a submit.
pub(crate) struct Clock {
    pub(crate) queries: wgpu::QuerySet,
    pub(crate) resolved: wgpu::Buffer,
    pub(crate) mapped: wgpu::Buffer,
    /// Nanoseconds per tick.
    pub(crate) period: f32,
}

impl Clock {
    /// The size of both timestamps in bytes.
    pub(crate) const BYTES: u64 = 16;

    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        let buffer = |usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: Self::BYTES,
                usage,
                mapped_at_creation: false,
            })
        };
        Self {
            queries: device.create_query_set(&wgpu::QuerySetDescriptor {
                label: None,
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            }),
            resolved: buffer(BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC),
            mapped: buffer(BufferUsages::MAP_READ | BufferUsages::COPY_DST),
            period: queue.get_timestamp_period(),
        }
    }

    /// Returns the time between the two timestamps, which must be mapped, and unmaps them.
    pub(crate) fn elapsed(&self) -> Option<Duration> {
        let ticks = {
            let bytes = self.mapped.slice(..).get_mapped_range().ok()?;
            let tick = |start: usize| {
                let bytes = bytes.get(start..start + 8)?.try_into().ok()?;
                Some(u64::from_le_bytes(bytes))
            };
            // If the clock went backwards, there is no time.
            tick(8)?.checked_sub(tick(0)?)
        };
        self.mapped.unmap();
        let nanoseconds = ticks? as f64 * f64::from(self.period);
        Some(Duration::from_nanos(nanoseconds as u64))
    }
}
