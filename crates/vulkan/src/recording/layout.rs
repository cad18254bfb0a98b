//! The layouts by which structures of the API are taken apart.

use super::recorder::fail;
use ash::vk;
use etalon_backend::{Argument, Constant, Member};
use std::ffi::{CStr, c_char, c_void};

/// A structure.
pub(super) struct Layout {
    /// The name in C.
    pub(super) name: &'static str,
    /// The size in bytes.
    pub(super) size: usize,
    /// The value of its `sType`, if it has one.
    pub(super) structure: Option<vk::StructureType>,
    pub(super) fields: &'static [Field],
}

/// A field of a structure.
pub(super) struct Field {
    /// The name in Rust.
    pub(super) name: &'static str,
    /// The offset in bytes.
    pub(super) offset: usize,
    pub(super) kind: Kind,
}

/// The kind of a field's value.
pub(super) enum Kind {
    U32,
    I32,
    F32,
    U64,
    /// 32 bits whose values have names.
    Named(fn(u32) -> String),
    /// A handle of this type.
    Handle(&'static str),
    /// A structure in place.
    Struct(&'static Layout),
    /// Floats in place.
    F32s(usize),
    /// Words in place.
    U32s(usize),
    /// The address of the chain's next structure, one of these.
    Next(&'static &'static [&'static Layout]),
    /// The address of a text that ends with a zero byte.
    Text,
    /// The address of such addresses.
    Texts(Count),
    /// The address of structures.
    Structs(&'static Layout, Count),
    /// The address of words.
    Words(Count),
    /// The address of words whose values have names.
    NamedWords(fn(u32) -> String, Count),
    /// The address of floats.
    Floats(Count),
    /// The address of handles.
    Handles(&'static str, Count),
    /// The address of words of code, whose size in bytes stands at this offset.
    Code(usize),
    /// An address that the backend never gives.
    Unused,
}

/// The number of values behind an address.
#[derive(Clone, Copy)]
pub(super) enum Count {
    One,
    /// The word at this offset.
    Field(usize),
}

impl Layout {
    /// Returns a structure as an argument.
    ///
    /// # Safety
    /// Such a structure is at the address, and everything that it points to is as the specification says.
    pub(super) unsafe fn read(&self, address: *const u8) -> Argument {
        let fields = self.fields.iter().map(|field| Member {
            name: name_in_c(field.name),
            offset: field.offset as u64,
            // SAFETY: the field lies in the structure.
            value: unsafe { field.kind.read(address, address.add(field.offset)) },
        });
        Argument::Struct {
            kind: self.name.to_owned(),
            size: self.size as u64,
            members: fields.collect(),
        }
    }

    /// Returns structures behind an address as an array.
    ///
    /// # Safety
    /// As for [`Layout::read`]; so many are there.
    pub(super) unsafe fn array(&self, address: *const c_void, count: usize) -> Argument {
        if address.is_null() || count == 0 {
            return Argument::Null;
        }
        let address = address.cast::<u8>();
        // SAFETY: the caller's.
        let all = (0..count).map(|i| unsafe { self.read(address.add(i * self.size)) });
        Argument::Array(all.collect())
    }
}

/// Returns the value at an address.
///
/// # Safety
/// It is there.
unsafe fn get<T: Copy>(address: *const u8) -> T {
    // SAFETY: the caller's.
    unsafe { address.cast::<T>().read_unaligned() }
}

/// Returns the values behind the address at an address; none where it is null.
///
/// # Safety
/// So many are there.
unsafe fn behind<T: Copy>(address: *const u8, count: usize) -> Vec<T> {
    // SAFETY: the caller's.
    let start: *const T = unsafe { get(address) };
    if start.is_null() || count == 0 {
        return Vec::new();
    }
    // SAFETY: the caller's.
    unsafe { std::slice::from_raw_parts(start, count) }.to_vec()
}

fn array(values: impl ExactSizeIterator<Item = Argument>) -> Argument {
    match values.len() {
        0 => Argument::Null,
        _ => Argument::Array(values.collect()),
    }
}

/// Returns a value with its name.
pub(super) fn constant(value: u32, name: fn(u32) -> String) -> Argument {
    Argument::Constant(Constant {
        name: name(value),
        value,
    })
}

impl Count {
    /// Returns the number in a structure.
    ///
    /// # Safety
    /// The structure is there.
    unsafe fn of(self, structure: *const u8) -> usize {
        match self {
            Self::One => 1,
            // SAFETY: the caller's.
            Self::Field(offset) => unsafe { get::<u32>(structure.add(offset)) as usize },
        }
    }
}

impl Kind {
    /// Returns the value at an address, in the structure at another.
    ///
    /// # Safety
    /// As for [`Layout::read`].
    unsafe fn read(&self, structure: *const u8, at: *const u8) -> Argument {
        // SAFETY: the caller's; kinds and counts are those of the specification.
        unsafe {
            match self {
                Self::U32 => Argument::Unsigned(get(at)),
                Self::I32 => Argument::Integer(get(at)),
                Self::F32 => Argument::Float(get(at)),
                Self::U64 => Argument::Size(get(at)),
                Self::Named(name) => constant(get(at), *name),
                Self::Handle(kind) => Argument::Object((*kind).to_owned(), get(at)),
                Self::Struct(layout) => layout.read(at),
                Self::F32s(count) => Argument::Values(
                    (0..*count)
                        .map(|i| Argument::Float(get(at.add(4 * i))))
                        .collect(),
                ),
                Self::U32s(count) => Argument::Values(
                    (0..*count)
                        .map(|i| Argument::Unsigned(get(at.add(4 * i))))
                        .collect(),
                ),
                Self::Next(tagged) => next(tagged, get(at)),
                Self::Text => text(get(at)),
                Self::Texts(count) => {
                    let all: Vec<*const c_char> = behind(at, count.of(structure));
                    array(all.into_iter().map(|t| text(t)))
                }
                Self::Structs(layout, count) => layout.array(get(at), count.of(structure)),
                Self::Words(count) => array(
                    behind(at, count.of(structure))
                        .into_iter()
                        .map(Argument::Unsigned),
                ),
                Self::NamedWords(name, count) => {
                    let all: Vec<u32> = behind(at, count.of(structure));
                    array(all.into_iter().map(|value| constant(value, *name)))
                }
                Self::Floats(count) => array(
                    behind(at, count.of(structure))
                        .into_iter()
                        .map(Argument::Float),
                ),
                Self::Handles(kind, count) => {
                    let all: Vec<u64> = behind(at, count.of(structure));
                    array(
                        all.into_iter()
                            .map(|raw| Argument::Object((*kind).to_owned(), raw)),
                    )
                }
                Self::Code(size) => Argument::Bytes(behind(at, get::<usize>(structure.add(*size)))),
                Self::Unused => {
                    if !get::<*const c_void>(at).is_null() {
                        fail("an address that is not followed");
                    }
                    Argument::Null
                }
            }
        }
    }
}

/// Returns the structure that a chain goes on with.
///
/// # Safety
/// A structure of the API is at the address, or it is null.
unsafe fn next(tagged: &[&Layout], address: *const c_void) -> Argument {
    if address.is_null() {
        return Argument::Null;
    }
    // SAFETY: each structure of a chain begins with its type.
    let kind: vk::StructureType = unsafe { get(address.cast()) };
    match tagged.iter().find(|layout| layout.structure == Some(kind)) {
        // SAFETY: the type says so.
        Some(layout) => unsafe { layout.array(address, 1) },
        None => {
            fail(&format!("a structure of type {kind:?}"));
            Argument::Null
        }
    }
}

/// Returns the text at an address.
///
/// # Safety
/// A terminated text is there, or the address is null.
unsafe fn text(address: *const c_char) -> Argument {
    if address.is_null() {
        return Argument::Null;
    }
    // SAFETY: the caller's.
    let text = unsafe { CStr::from_ptr(address) };
    Argument::Text(text.to_string_lossy().into_owned())
}

/// Returns the name of a field in C: `p_next` is `pNext`.
fn name_in_c(name: &str) -> String {
    let mut upper = false;
    let mut text = String::new();
    for c in name.chars() {
        match c {
            '_' => upper = true,
            c if upper => {
                text.extend(c.to_uppercase());
                upper = false;
            }
            c => text.push(c),
        }
    }
    if text == "ty" {
        "type".to_owned()
    } else {
        text
    }
}
