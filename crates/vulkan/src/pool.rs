//! The bounded pool from which scenes take buffers and images.

use crate::buffer::{BufferUse, MappedBuffer};
use crate::device::Device;
use crate::image::{DeviceImage, ImageKey};
use etalon_backend::BackendError;

/// The largest number of objects that a pool keeps, and their largest total size in bytes.
const KEPT_OBJECTS: usize = 64;
const KEPT_BYTES: u64 = 256 << 20;
/// Unused objects, oldest first.
#[derive(Debug, Default)]
pub(crate) struct UnusedObjects {
    buffers: Vec<MappedBuffer>,
    images: Vec<DeviceImage>,
}

impl UnusedObjects {
    /// Returns a buffer of at least this size.
    pub(crate) fn buffer(
        &mut self,
        device: &Device,
        usage: BufferUse,
        size: u64,
    ) -> Result<MappedBuffer, BackendError> {
        let fits = |b: &MappedBuffer| b.usage == usage && b.size >= size;
        match self.buffers.iter().rposition(fits) {
            Some(index) => Ok(self.buffers.remove(index)),
            None => MappedBuffer::new(device, usage, size),
        }
    }

    /// Returns an image with undefined contents.
    pub(crate) fn image(
        &mut self,
        device: &Device,
        key: ImageKey,
    ) -> Result<DeviceImage, BackendError> {
        match self.images.iter().rposition(|i| i.key == key) {
            Some(index) => Ok(self.images.remove(index)),
            None => DeviceImage::new(device, key),
        }
    }

    /// Returns objects to the pool once the device is done with them.
    pub(crate) fn give_back(
        &mut self,
        device: &Device,
        buffers: impl IntoIterator<Item = MappedBuffer>,
        images: impl IntoIterator<Item = DeviceImage>,
    ) {
        self.buffers.extend(buffers);
        self.images.extend(images);
        let excess = excess(self.buffers.iter().map(|b| b.size));
        self.buffers.drain(..excess).for_each(|b| b.destroy(device));
        let excess = self::excess(self.images.iter().map(|i| i.bytes));
        self.images.drain(..excess).for_each(|i| i.destroy(device));
    }

    /// Destroys everything. The device must still exist.
    pub(crate) fn destroy(&mut self, device: &Device) {
        self.buffers.drain(..).for_each(|b| b.destroy(device));
        self.images.drain(..).for_each(|i| i.destroy(device));
    }
}

/// Returns how many of the oldest objects to destroy so that the rest are within the bounds.
fn excess(sizes: impl DoubleEndedIterator<Item = u64> + ExactSizeIterator) -> usize {
    let count = sizes.len();
    let mut bytes = 0_u64;
    let kept = sizes
        .rev()
        .take(KEPT_OBJECTS)
        .take_while(|size| {
            bytes = bytes.saturating_add(*size);
            bytes <= KEPT_BYTES
        })
        .count();
    count - kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pools_keep_the_newest_within_their_bounds() {
        assert_eq!(excess([1_u64; 10].into_iter()), 0);
        assert_eq!(excess([1_u64; KEPT_OBJECTS + 3].into_iter()), 3);
        assert_eq!(excess([KEPT_BYTES, 1, 1].into_iter()), 1);
        assert_eq!(excess([KEPT_BYTES + 1].into_iter()), 1);
    }
}
