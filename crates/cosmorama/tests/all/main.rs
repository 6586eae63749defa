//! Tests of the library through its public door, in one program.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should stop where it stands")]

mod explain;
mod harmonic_presets;
mod harmonics;
mod laboratory;
mod lighting;
mod projections;
mod published_points;
mod round_trips;

mod filter {
    mod aliasing;
    mod bound;
    mod classic;
    mod definitions;
    mod footprint;
    mod labels;
    mod narrow;
    mod position;
    mod pyramid;
    mod reference;
    mod rim;
    mod seams;
}

mod render {
    mod need;
    mod packed;
    mod progress;
    mod small;
    mod two_pass;
}
