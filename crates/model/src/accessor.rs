//! Numbers of vertices and indices. Nothing is believed about their places in a buffer.

use crate::error::{ModelError, part};
use crate::files::Buffers;
use gltf::Accessor;
use gltf::accessor::sparse::IndexType;
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::View;

/// Returns the items of an accessor, each with `N` components; integers as they are stored, or as fractions if the file
/// says so.
///
/// # Errors
/// If the items have another number of components, or are not in the buffer.
pub(crate) fn items<const N: usize>(
    accessor: &Accessor<'_>,
    buffers: &Buffers,
) -> Result<Vec<[f64; N]>, ModelError> {
    let place = || part("accessor", accessor.index(), accessor.name());
    let components = components(accessor.dimensions());
    if components != Some(N) {
        let message = format!("its items have not {N} components; export the file again");
        return Err(ModelError::new(place(), message));
    }
    let outside = || {
        ModelError::new(
            place(),
            "it reaches beyond its buffer; export the file again",
        )
    };
    let kind = Kind {
        data: accessor.data_type(),
        normalized: accessor.normalized(),
    };
    let count = accessor.count();
    let mut items = match accessor.view() {
        Some(view) => {
            let offset = accessor.offset();
            kind.items(&view, offset, count, buffers)
                .ok_or_else(outside)?
        }
        None if count > MOST_ITEMS => return Err(outside()),
        None => vec![[0.0; N]; count],
    };
    if let Some(sparse) = accessor.sparse() {
        let (indices, values) = (sparse.indices(), sparse.values());
        let index = Kind {
            data: match indices.index_type() {
                IndexType::U8 => DataType::U8,
                IndexType::U16 => DataType::U16,
                IndexType::U32 => DataType::U32,
            },
            normalized: false,
        };
        let count = sparse.count();
        let places = index.items::<1>(&indices.view(), indices.offset(), count, buffers);
        let values = kind.items(&values.view(), values.offset(), count, buffers);
        for ([place], value) in places
            .ok_or_else(outside)?
            .into_iter()
            .zip(values.ok_or_else(outside)?)
        {
            *items.get_mut(place as usize).ok_or_else(outside)? = value;
        }
    }
    Ok(items)
}

/// The maximum number of items without a place in a buffer.
const MOST_ITEMS: usize = 1 << 24;

fn components(dimensions: Dimensions) -> Option<usize> {
    match dimensions {
        Dimensions::Scalar => Some(1),
        Dimensions::Vec2 => Some(2),
        Dimensions::Vec3 => Some(3),
        Dimensions::Vec4 => Some(4),
        _ => None,
    }
}

/// The type of a component.
#[derive(Clone, Copy)]
struct Kind {
    data: DataType,
    normalized: bool,
}

impl Kind {
    fn size(self) -> usize {
        match self.data {
            DataType::I8 | DataType::U8 => 1,
            DataType::I16 | DataType::U16 => 2,
            DataType::U32 | DataType::F32 => 4,
        }
    }

    /// Returns items from an offset on; `None` if one is outside of the view.
    fn items<const N: usize>(
        self,
        view: &View<'_>,
        offset: usize,
        count: usize,
        buffers: &Buffers,
    ) -> Option<Vec<[f64; N]>> {
        let bytes = buffers.view(view)?.get(offset..)?;
        let size = self.size() * N;
        let stride = view.stride().unwrap_or(size);
        let end = count
            .checked_sub(1)?
            .checked_mul(stride)?
            .checked_add(size)?;
        if stride < size || end > bytes.len() {
            return None;
        }
        let item = |i: usize| {
            let item = &bytes[i * stride..][..size];
            std::array::from_fn(|c| self.number(&item[c * self.size()..]))
        };
        Some((0..count).map(item).collect())
    }

    /// Returns the number at the start of some bytes.
    fn number(self, bytes: &[u8]) -> f64 {
        let two = || [bytes[0], bytes[1]];
        let four = || [bytes[0], bytes[1], bytes[2], bytes[3]];
        let (number, largest) = match self.data {
            DataType::I8 => (f64::from(bytes[0] as i8), 127.0),
            DataType::U8 => (f64::from(bytes[0]), 255.0),
            DataType::I16 => (f64::from(i16::from_le_bytes(two())), 32_767.0),
            DataType::U16 => (f64::from(u16::from_le_bytes(two())), 65_535.0),
            DataType::U32 => (f64::from(u32::from_le_bytes(four())), f64::from(u32::MAX)),
            DataType::F32 => return f64::from(f32::from_le_bytes(four())),
        };
        if self.normalized {
            (number / largest).max(-1.0)
        } else {
            number
        }
    }
}
