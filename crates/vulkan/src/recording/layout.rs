//! The layouts of the API's structures and arguments, by which the recorder takes them apart.

use super::recorder::{fail, flags_of, new_output};
use ash::vk;
use etalon_backend::{Argument, Constant, Member};
use std::ffi::CStr;
use std::slice::from_raw_parts;

/// A structure.
pub(super) struct StructLayout {
    /// The name in C.
    pub(super) name: &'static str,
    /// The size in bytes.
    pub(super) size: usize,
    pub(super) fields: &'static [StructField],
}

/// A field of a structure, or an argument of a function.
pub(super) struct StructField {
    /// The name in C.
    pub(super) name: &'static str,
    /// The offset in bytes.
    pub(super) offset: usize,
    pub(super) kind: ValueKind,
}

/// The kind of a value.
pub(super) enum ValueKind {
    U32,
    I32,
    F32,
    U64,
    /// 32 bits with named values.
    Named(fn(u32) -> String),
    /// A handle of this type.
    Handle(&'static str),
    /// A structure stored inline.
    Struct(&'static StructLayout),
    /// Values stored inline.
    Values(&'static ValueKind, usize),
    /// The address of values.
    Array(&'static ValueKind, ArrayCount),
    /// The address of bytes.
    Bytes(ArrayCount),
    /// The address of a zero-terminated string.
    Text,
    /// The address of the next structure of a chain; its type gives its layout.
    Next(fn(vk::StructureType) -> Option<&'static StructLayout>),
    /// The address of handles of this type, which the call creates.
    Made(&'static str, ArrayCount),
    /// The address of bytes that the call writes.
    Output(ArrayCount),
    /// The address where the call stores the address of mapped memory.
    Mapped,
    /// The address of memory requirements, which differ between drivers.
    Requirements,
    /// A memory type index. It is recorded as the properties of the memory type.
    MemoryType,
    /// An address that the backend always leaves null.
    Unused,
}

/// The number of values at an address.
#[derive(Clone, Copy)]
pub(super) enum ArrayCount {
    Fixed(usize),
    /// The value of another field of the structure, or of a field of a structure that it points to:
    /// `pInfo->count`.
    By(&'static str),
}

/// Declares structures with the kinds of their fields.
macro_rules! structures {
    ($($name:ident: $type:ty { $($c:ident = $field:ident: $kind:expr,)+ })+) => {
        $(
            static $name: StructLayout = StructLayout {
                name: stringify!($name),
                size: size_of::<$type>(),
                fields: &[$(StructField {
                    name: stringify!($c),
                    offset: offset_of!($type, $field),
                    kind: $kind,
                }),+],
            };
        )+
    };
}

/// Declares unions, whose values are recorded as words.
macro_rules! unions {
    ($($name:ident: $type:ty,)+) => {
        $(
            static $name: StructLayout = StructLayout {
                name: stringify!($name),
                size: size_of::<$type>(),
                fields: &[StructField {
                    name: "bits",
                    offset: 0,
                    kind: Values(&U32, size_of::<$type>() / 4),
                }],
            };
        )+
    };
}

/// Declares the structures that a chain can contain.
macro_rules! chained {
    ($($name:ident: $type:ident,)+) => {
        /// Returns the layout of the structure with this type, if it is recorded.
        fn chained(kind: vk::StructureType) -> Option<&'static StructLayout> {
            match kind {
                $(vk::StructureType::$type => Some(&$name),)+
                _ => None,
            }
        }
    };
}

/// The kind of an enumeration, with the names of its values.
macro_rules! named {
    ($type:ty) => {
        Named(|raw| format!("{:?}", <$type>::from_raw(raw.cast_signed())))
    };
}

/// The kind of a bit mask, with the names of its bits.
macro_rules! flags {
    ($type:ty) => {
        Named(|raw| format!("{:?}", <$type>::from_raw(raw)))
    };
}

pub(super) use {chained, flags, named, structures, unions};

/// Returns the values of fields, with their names.
///
/// # Safety
/// `address` points to a structure with these fields, and everything that they point to is as the
/// specification requires.
pub(super) unsafe fn members(fields: &'static [StructField], address: *const u8) -> Vec<Member> {
    let member = |field: &StructField| Member {
        name: field.name.to_owned(),
        // SAFETY: the field is in the structure.
        value: unsafe { field.kind.read(address.add(field.offset), fields, address) },
    };
    fields.iter().map(member).collect()
}

impl StructLayout {
    /// Returns the structure at an address.
    ///
    /// # Safety
    /// As for [`members`].
    unsafe fn read(&self, address: *const u8) -> Argument {
        Argument::Struct {
            kind: self.name.to_owned(),
            size: self.size as u64,
            // SAFETY: upheld by the caller.
            members: unsafe { members(self.fields, address) },
        }
    }
}

/// Returns the value at an address.
///
/// # Safety
/// `address` points to a value of this type, aligned or not.
unsafe fn get<T: Copy>(address: *const u8) -> T {
    // SAFETY: upheld by the caller.
    unsafe { address.cast::<T>().read_unaligned() }
}

/// Returns a value with its name.
fn constant(value: u32, name: fn(u32) -> String) -> Argument {
    Argument::Constant(Constant {
        name: name(value),
        value,
    })
}

impl ArrayCount {
    /// Returns the number, which can be the value of one of the fields at `address`.
    ///
    /// # Safety
    /// As for [`members`].
    unsafe fn of(self, fields: &[StructField], address: *const u8) -> usize {
        let path = match self {
            Self::Fixed(count) => return count,
            Self::By(path) => path,
        };
        let (name, behind) = path.split_once("->").unwrap_or((path, ""));
        let Some(field) = fields.iter().find(|field| field.name == name) else {
            fail(path);
            return 0;
        };
        // SAFETY: upheld by the caller.
        unsafe {
            let place = address.add(field.offset);
            match field.kind {
                ValueKind::Array(ValueKind::Struct(layout), _) => {
                    Self::By(behind).of(layout.fields, get(place))
                }
                ValueKind::U32 => get::<u32>(place) as usize,
                _ => get(place),
            }
        }
    }
}

impl ValueKind {
    /// Returns the size of a value in bytes.
    fn size(&self) -> usize {
        match self {
            Self::U32 | Self::I32 | Self::F32 | Self::Named(_) => 4,
            Self::Struct(layout) => layout.size,
            Self::Values(kind, count) => kind.size() * count,
            _ => 8,
        }
    }

    /// Returns the values of consecutive elements.
    ///
    /// # Safety
    /// `start` points to `count` elements, each as for [`members`].
    unsafe fn run(&self, start: *const u8, count: usize) -> Vec<Argument> {
        let places = (0..count).map(|i| start.wrapping_add(i * self.size()));
        // SAFETY: upheld by the caller. The kind of an element takes no count from a field.
        places
            .map(|place| unsafe { self.read(place, &[], place) })
            .collect()
    }

    /// Returns the value at `place`, which is one of the fields of the structure at `structure`.
    ///
    /// # Safety
    /// As for [`members`].
    unsafe fn read(
        &self,
        place: *const u8,
        fields: &[StructField],
        structure: *const u8,
    ) -> Argument {
        // SAFETY: upheld by the caller; kinds and counts are the registry's.
        unsafe {
            // The address stored at `place`, and the number of values there.
            let start = || get::<*const u8>(place);
            let count = |count: &ArrayCount| {
                if start().is_null() {
                    0
                } else {
                    count.of(fields, structure)
                }
            };
            match self {
                Self::U32 => Argument::Unsigned(get(place)),
                Self::I32 => Argument::Integer(get(place)),
                Self::F32 => Argument::Float(get(place)),
                Self::U64 => Argument::Size(get(place)),
                Self::Named(name) => constant(get(place), *name),
                Self::Handle(kind) => Argument::Object((*kind).to_owned(), get(place)),
                Self::Struct(layout) => layout.read(place),
                Self::Values(kind, count) => Argument::Values(kind.run(place, *count)),
                Self::Array(kind, length) => match count(length) {
                    0 => Argument::Null,
                    length => Argument::Array(kind.run(start(), length)),
                },
                Self::Bytes(length) => match count(length) {
                    0 => Argument::Null,
                    length => Argument::Bytes(from_raw_parts(start(), length).to_vec()),
                },
                Self::Text if start().is_null() => Argument::Null,
                Self::Text => {
                    let text = CStr::from_ptr(start().cast());
                    Argument::Text(text.to_string_lossy().into_owned())
                }
                Self::Next(_) if start().is_null() => Argument::Null,
                Self::Next(chained) => {
                    // Each structure of a chain begins with its type.
                    let kind = get(start());
                    match chained(kind) {
                        Some(layout) => Argument::Array(vec![layout.read(start())]),
                        None => unknown(&format!("a structure of type {kind:?}")),
                    }
                }
                Self::Made(kind, length) => {
                    let handles =
                        (0..count(length)).map(|i| get(start().add(i * size_of::<u64>())));
                    Argument::Created((*kind).to_owned(), handles.collect())
                }
                Self::Output(length) => new_output(count(length) as u64),
                Self::Mapped => Argument::Created("mapped".to_owned(), vec![get(start())]),
                Self::Requirements => Argument::Offset(0),
                Self::MemoryType => {
                    let info: vk::MemoryAllocateInfo<'_> = get(start());
                    constant(flags_of(info.memory_type_index), |raw| {
                        format!("{:?}", vk::MemoryPropertyFlags::from_raw(raw))
                    })
                }
                Self::Unused if start().is_null() => Argument::Null,
                Self::Unused => unknown("an address that is not followed"),
            }
        }
    }
}

/// Ends the recording at something that it cannot represent.
fn unknown(what: &str) -> Argument {
    fail(what);
    Argument::Null
}
