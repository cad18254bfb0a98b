//! Globs over ids and names.
//!
//! | glob | matches |
//! |---|---|
//! | `*` | any text, also with `/` |
//! | `?` | one character |
//! | `[ab]`, `[a-z]` | one of these characters |
//! | `[!ab]`, `[^ab]` | one other character |
//! | `{a,b}` | one of these globs, which can hold more of them |
//! | `\*` | the character itself |
//!
//! `**` is the same as `*`, except that `**/` as a whole part of a path also matches nothing.
//!
//! Matching takes time in proportion to the lengths of glob and text, whatever the glob.
//!
//! [`did_you_mean`] suggests names for one that matches nothing.

mod glob;
mod index;
mod matching;
mod near;
mod parsing;
mod step;

pub use glob::{Glob, escape};
pub use index::GlobIndex;
pub use near::did_you_mean;
pub use parsing::GlobError;
