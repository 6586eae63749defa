//! Further channels of a frame: read, filtered by the rule for what they hold, and kept for the outputs.

mod files;
mod fill;
mod finish;
mod labels;
mod pass;

pub(crate) use files::FurtherFiles;
pub(crate) use pass::LayerPass;

use std::path::PathBuf;

use cosmorama_io::{Plane, PlaneSamples};

use crate::packing::Place;

/// Channels of a frame's file, with the views whose pixels they hold.
struct FilePlanes {
    path: PathBuf,
    views: Vec<usize>,
    planes: Vec<Plane>,
}

/// The planes of a view's file, and the place of its pixels in them.
struct ViewPlanes<'a> {
    /// Samples of each channel of a group.
    planes: Vec<&'a PlaneSamples>,
    place: Place,
}

impl ViewPlanes<'_> {
    /// Returns the index in the planes of the first pixel of a row.
    fn row(&self, j: usize) -> usize {
        (self.place.corner.1 + j) * self.place.of.0 + self.place.corner.0
    }
}
