//! Tests of case files and of the built-in families.

mod damage;
mod families;
mod sequence;
