//! The rasterizer from outside: its pictures, and its kernels against the span code.
#![expect(clippy::expect_used, reason = "a test that panics has failed")]

mod kernels;
mod pictures;
