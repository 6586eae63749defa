//! Worlds: radiance by direction, held as a set of views.

mod coverage;
mod field_stop;
mod frame;
mod framing;
mod grid;
mod view;
#[allow(clippy::module_inception)]
mod world;

pub use coverage::ScreenPixel;
pub use field_stop::FieldStop;
pub use frame::{
    Canvas, CubeFaceFrame, CylinderFrame, CylinderKind, EquirectFrame, FieldOfView, FisheyeFit, FisheyeFrame, Frame,
    FrameError, FulldomeFrame, LensCircle, LensScale, Mirror, MirrorBallFrame, OctahedralFrame, OmnimaxFrame,
    PanniniFrame, PerspectiveFrame, Placement, SamplePositions, StereographicFrame, WorldMapFrame,
};
pub use framing::OmnimaxFraming;
pub use grid::{PixelGrid, PixelPoint, PixelRect};
pub use view::{Footprint, View};
pub use world::{Source, World, WorldError};
