//! Tests of videos and streams, in one program.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should stop where it stands")]
#![allow(clippy::print_stderr, reason = "a check that is left out says so")]

mod avi;
mod carried;
mod colour;
mod common;
mod damage;
mod hostile;
mod reading;
mod spatial;
mod streams;
mod turned;
mod writing;
