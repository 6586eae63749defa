//! Tests of what is read and written, in one program.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should stop where it stands")]
#![allow(clippy::print_stderr, reason = "a check that is left out says so")]

mod calibrations;
mod colour;
mod common;
mod face_sets;
mod hostile;
mod interop;
mod interrupt;
mod pto;
mod real_files;
mod round_trips;

mod contents {
    mod attributes;
    mod layers;
    mod several;
}
