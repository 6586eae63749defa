//! Tests of the built-in worlds, in one program.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should stop where it stands")]

mod demo;
mod pictures;
