//! How six pictures are the faces of one cube, found from what their borders show.
//!
//! Where two faces meet they show the same. [`Border`]s are compared side by side ([`Mismatch`]); of all ways to lay the
//! pictures round a cube, any order, any quarter turn, any of them mirrored, the most continuous one is searched for, and
//! the given one is judged by it ([`judge`]). Continuity knows no front and no hand: an arrangement and the same turned or
//! mirrored as a whole are one.

mod border;
mod change;
mod mismatch;
mod pose;
mod search;
mod side;
mod symmetry;
mod verdict;

pub use border::Border;
pub use change::{Change, changes};
pub use mismatch::Mismatch;
pub use pose::Pose;
pub use side::Side;
pub use verdict::{Fit, Verdict, fits_as_well, is_continuous, judge};
