//! The functions that record calls.

/// Declares functions that call the driver's function and keep the call unless it fails.
macro_rules! functions {
    ($($name:ident $(-> $result:ty)? { $($argument:ident: $type:ty = $kind:expr,)+ })+) => {
        #[expect(non_snake_case, reason = "the names are the API's")]
        mod recording {
            use super::*;
            use crate::recording::layout::members;
            use crate::recording::recorder::{driver, keep};
            use std::mem::transmute;
            $(
                pub(in crate::recording) unsafe extern "system" fn $name($($argument: $type),+) $(-> $result)? {
                    #[repr(C)]
                    struct Arguments {
                        $($argument: $type,)+
                    }
                    static FIELDS: &[StructField] = &[$(StructField {
                        name: stringify!($argument),
                        offset: offset_of!(Arguments, $argument),
                        kind: $kind,
                    }),+];
                    type Own = unsafe extern "system" fn($($type),+) $(-> $result)?;
                    // SAFETY: the backend found this function instead of the driver's, whose address was
                    // kept, and the registry gives the name this type.
                    let own: Own = unsafe { transmute(driver(stringify!($name))) };
                    // SAFETY: the caller passed the arguments to a function of this type.
                    let result = unsafe { own($($argument),+) };
                    let failed = false $(|| <$result>::as_raw(result) < 0)?;
                    if !failed {
                        let arguments = Arguments { $($argument),+ };
                        // SAFETY: the arguments are as the specification requires, and the driver wrote the
                        // objects it created.
                        let members = || unsafe { members(FIELDS, (&raw const arguments).cast()) };
                        keep(stringify!($name), || members().into_iter().map(|member| member.value).collect());
                    }
                    result
                }
            )+
        }

        /// Returns the function that records the device's function of this name, with its name.
        pub(super) fn shim(name: &str) -> Option<(&'static str, *const ())> {
            match name {
                $(stringify!($name) => Some((stringify!($name), recording::$name as *const ())),)+
                _ => None,
            }
        }
    };
}
pub(super) use functions;
