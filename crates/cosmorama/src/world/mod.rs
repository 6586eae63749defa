//! Worlds: radiance by direction, held as a set of views.

mod blend;
mod edge_decontamination;
mod halved;
mod light;
pub(crate) mod mask;
mod overlap;
mod search;
mod solid_angles;
mod st_pixels;
mod watertight;
#[allow(clippy::module_inception)]
mod world;

pub use blend::Blend;
pub use edge_decontamination::RimTexels;
pub(crate) use halved::held;
pub use light::{Light, LightError, PictureError};
pub use mask::shape::MaskShape;
pub use mask::view_mask::ViewMask;
pub use search::coverage::SphereCoverage;
pub(crate) use search::view_index::Near;
pub use solid_angles::SolidAngles;
pub use st_pixels::{ST_NOWHERE, StPixel};
pub(crate) use world::TexelPlace;
pub use world::{Source, World, WorldError, WorldView};

/// Returns an upright panorama of the whole sphere, for tests.
#[cfg(test)]
pub(crate) fn panorama(width: usize, height: usize) -> crate::camera::View {
    use crate::camera::{FieldStop, PixelGrid, View};
    use crate::projection::{PlanePoint, PlaneRect, ProjectionKind};

    let (x, y) = (std::f64::consts::PI, std::f64::consts::FRAC_PI_2);
    let rect = PlaneRect { min: PlanePoint::new(-x, -y), max: PlanePoint::new(x, y) };
    View {
        projection: ProjectionKind::EQUIRECTANGULAR,
        orientation: crate::sphere::Orientation::IDENTITY,
        grid: PixelGrid::spanning(width, height, rect),
        stop: FieldStop::NONE,
    }
}
