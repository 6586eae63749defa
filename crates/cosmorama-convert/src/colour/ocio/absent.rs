//! Stands in for OpenColorIO in programs built without it.

use std::convert::Infallible;

use cosmorama::raster::Rgba;

use super::{Spaces, Wanted, WantedOutput};
use crate::diagnostic::{Code, Diagnostic, OCIO, Result, usage_as};

/// Conversion that does not exist.
#[derive(Debug)]
pub(crate) struct SpaceConversion(Infallible);

impl SpaceConversion {
    /// Converts nothing, since there is no such conversion.
    pub(crate) fn convert(&self, _: &mut [Rgba]) {
        match self.0 {}
    }
}

impl Spaces {
    /// Refuses, and says how to build a program that has OpenColorIO.
    pub(super) fn open(wanted: &Wanted<'_>, _: &mut Vec<Diagnostic>) -> Result<Self> {
        let Wanted { config, in_space, out: WantedOutput::Space(out) | WantedOutput::View(out) } = wanted;
        Err(usage_as(
            Code::Unsupported,
            format!(
                "{OCIO} {config}: this program was built without OpenColorIO, and cannot bring colours from {in_space} to \
                 {out}; build one with the feature ocio, as docs/colour.md shows"
            ),
        ))
    }
}
