//! Tests of conversions as values, in one program.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should stop where it stands")]

mod at_once;
mod changed;
mod diagnostics;
mod hostile;
mod in_memory;
mod stop;
#[cfg(feature = "video")]
mod videos;
