//! Row numbers of one database. They are meaningless in any other.

use std::fmt;

macro_rules! id {
    ($(#[$meta:meta])* $name:ident) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub(crate) u32);

        impl $name {
            /// Returns the number.
            pub fn number(self) -> u32 {
                self.0
            }
        }

        impl From<u32> for $name {
            fn from(number: u32) -> Self {
                Self(number)
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.0.fmt(f)
            }
        }
    };
}

id! {
    /// A run, numbered from 1 in the order in which runs were added.
    RunId
}
id! {
    /// A case.
    CaseNumber
}
id! {
    /// An outcome. Two records with the same outcome are equal in everything that the history keeps.
    OutcomeId
}
id! {
    /// A machine.
    MachineId
}
