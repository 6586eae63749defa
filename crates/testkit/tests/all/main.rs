//! Tests of the whole workspace: its plan, its golden pictures, what needs several crates. In one program.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should stop where it stands")]

mod architecture;
mod arrange;
mod goldens;
mod light_kept;
mod lists;
mod names;
mod source;
