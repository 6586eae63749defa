//! Worlds: radiance by direction, held as a set of views.

mod blend;
mod coverage;
mod field_stop;
mod frame;
mod framing;
mod grid;
mod layout;
mod overlap;
mod view;
#[allow(clippy::module_inception)]
mod world;

pub use blend::Blend;
pub use coverage::ScreenPixel;
pub use field_stop::FieldStop;
pub use frame::{
    Canvas, CubeFaceFrame, CylinderFrame, CylinderKind, EquirectFrame, FaceMapping, FieldOfView, FisheyeFit,
    FisheyeFrame, Frame, FrameError, FulldomeFrame, LayoutFaceFrame, LensCircle, LensScale, Mirror, MirrorBallFrame,
    OctahedralFrame, OmnimaxFrame, PanniniFrame, PerspectiveFrame, Placement, SamplePositions, StMapFrame,
    StereographicFrame, WorldMapFrame,
};
pub use framing::OmnimaxFraming;
pub use grid::{PixelGrid, PixelPoint, PixelRect};
pub use layout::{CubeLayout, FaceOrder, FacePart, FacePlacement, LayoutError, LayoutKind, PlacedFace};
pub use view::{Footprint, View};
pub use world::{Source, World, WorldError};
