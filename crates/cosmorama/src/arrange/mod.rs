//! Arrangement of six pictures as the faces of one cube, found from their borders.
//!
//! Where two faces meet they show the same. [`Border`]s are compared side by side ([`Mismatch`]). A search finds the
//! most continuous arrangement of the pictures around a cube, over any order, any quarter turns and any mirroring. The
//! declared arrangement is compared with it ([`judge`]). Continuity does not determine the front or the handedness: an
//! arrangement is the same when it is turned or mirrored as a whole.

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
