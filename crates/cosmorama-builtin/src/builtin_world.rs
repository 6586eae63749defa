use cosmorama::camera::View;
use cosmorama::raster::{Image, Rgba};

use crate::{Checker, DemoWorld, Directions, Grid, ZonePlate, picture};

/// A world that comes with the program, by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BuiltinWorld {
    /// A grid of azimuth and elevation ([`Grid`]).
    Grid,
    /// A checkerboard ([`Checker`]).
    Checker,
    /// Colours that are directions ([`Directions`]).
    Directions,
    /// Rings of rising frequency ([`ZonePlate`]).
    ZonePlate,
    /// The demo's arcade ([`DemoWorld`]).
    Demo,
}

impl BuiltinWorld {
    /// All built-in worlds.
    pub const ALL: [Self; 5] = [Self::Grid, Self::Checker, Self::Directions, Self::ZonePlate, Self::Demo];

    /// Returns the name after `builtin:`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Grid => "grid",
            Self::Checker => "checker",
            Self::Directions => "directions",
            Self::ZonePlate => "zone-plate",
            Self::Demo => "demo",
        }
    }

    /// Returns a line of help.
    pub const fn about(self) -> &'static str {
        match self {
            Self::Grid => "degrees of azimuth and elevation, to align the projectors of a dome by",
            Self::Checker => "black and white checks of 10 degrees of azimuth and elevation",
            Self::Directions => "the colour is the direction: (x + 1)/2, (y + 1)/2, (z + 1)/2, linear",
            Self::ZonePlate => "rings around the six axes, ever finer: 8 cycles a degree at 45 degrees",
            Self::Demo => "the demo's arcade under a glazed vault",
        }
    }

    /// Renders a view of the world ([`picture()`]).
    pub fn picture(self, view: &View) -> Image<Rgba> {
        match self {
            Self::Grid => picture(&Grid::new(), view),
            Self::Checker => picture(&Checker, view),
            Self::Directions => picture(&Directions, view),
            Self::ZonePlate => picture(&ZonePlate, view),
            Self::Demo => picture(&DemoWorld, view),
        }
    }
}
