//! Enumerations whose values have names.
//!
//! The names, the list of all values and the serialized form come from one list, so they cannot disagree.

/// Declares an enumeration whose values have names, the same in case files, records and stories.
///
/// `Name { … }` makes `ALL` a slice, `Name: array { … }` an array.
#[macro_export]
macro_rules! state_enum {
    ($(#[$meta:meta])* $name:ident $(: $array:ident)? { $($(#[$doc:meta])* $variant:ident = $text:literal),+ $(,)? }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
        pub enum $name { $($(#[$doc])* #[serde(rename = $text)] $variant),+ }

        impl $name {
            $crate::state_enum!(@all $($array)? $($variant)+);

            /// Returns the name in case files, records and stories.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $text),+ }
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.name())
            }
        }
    };
    (@all array $($variant:ident)+) => {
        /// Every value, in declaration order.
        pub const ALL: [Self; [$(stringify!($variant)),+].len()] = [$(Self::$variant),+];
    };
    (@all $($variant:ident)+) => {
        /// Every value, in declaration order.
        pub const ALL: &'static [Self] = &[$(Self::$variant),+];
    };
}
