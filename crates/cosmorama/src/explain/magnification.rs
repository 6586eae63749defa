use glam::DMat2;

use crate::camera::{Footprint, PixelPoint, View};
use crate::filter::semi_axes;
use crate::projection::{PlanePoint, Projection};

/// Length of a target pixel in texels: less than 1 enlarges, more than 1 reduces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Magnification {
    /// Length along the direction with the fewest texels.
    pub least: f64,
    /// Length along the direction with the most texels.
    pub greatest: f64,
}

impl Magnification {
    /// Texels per pixel above which they are any number, as at a map's pole, whose last row is one point.
    pub const MANY: f64 = 1e6;

    /// Computes the singular values of a footprint's matrix.
    pub(crate) fn of(jacobian: DMat2) -> Self {
        let [greatest, least] = semi_axes(jacobian);
        Self { least, greatest }
    }

    /// Returns the range that holds both.
    #[must_use]
    pub(crate) fn union(self, other: Self) -> Self {
        Self { least: self.least.min(other.least), greatest: self.greatest.max(other.greatest) }
    }
}

/// Sizes of a source image that suit the target's centre.
///
/// At parity, a texel at the source's centre is as large as a pixel at the target's centre. The Omnimax lens has a
/// slope of 1.411269 radians per radius there, so a cube face at parity is 2·radius/1.411269 texels wide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceSize {
    /// Texels per target pixel, along columns and rows, with the present source: the source to destination ratio.
    pub ratio: (f64, f64),
    /// Width and height at parity.
    pub parity: (usize, usize),
    /// Width and height at 2:3.
    ///
    /// Greene & Heckbert give their faces and frame a source to destination ratio of 2:3 at the centre. When the
    /// limiting circle spans the frame's 1966 pixels, a pixel is 1.411269/983 radians. A texel of a 1024×960 face is
    /// 2/1024 by 2/960, so the ratio is 0.735 by 0.689.
    pub two_thirds: (usize, usize),
}

impl FaceSize {
    /// Computes the sizes of `source` for a target whose central pixel has this footprint; `None` where either is
    /// singular.
    pub(crate) fn of(source: &View, footprint: &Footprint) -> Option<Self> {
        let pixel = footprint.jacobian.solid_angle().sqrt();
        let step = source.grid.step();
        // The texel at the plane's origin, whether or not the image holds it, so that all faces get one advice.
        let jacobian = source.projection.jacobian(PlanePoint::new(0.0, 0.0))?;
        let texel = (jacobian.dx.length() * step.x.abs(), jacobian.dy.length() * step.y.abs());
        if !(pixel > 0.0 && texel.0 > 0.0 && texel.1 > 0.0) {
            return None;
        }
        let ratio = (pixel / texel.0, pixel / texel.1);
        let size = |part: f64| {
            let along = |texels: usize, ratio: f64| (texels as f64 / ratio * part).round().max(1.0) as usize;
            (along(source.width(), ratio.0), along(source.height(), ratio.1))
        };
        Some(Self { ratio, parity: size(1.0), two_thirds: size(2.0 / 3.0) })
    }
}

/// Returns the footprint of the pixel at a target's centre: on the lens's axis, or else in the middle of the frame.
pub(crate) fn central_footprint(target: &View) -> Option<Footprint> {
    let axis = target.grid.to_pixel(PlanePoint::new(0.0, 0.0));
    let middle = PixelPoint::new(target.width() as f64 / 2.0, target.height() as f64 / 2.0);
    let centre = if target.shows(axis) { axis } else { middle };
    target.footprint(centre)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn singular_values() {
        let turn = DMat2::from_angle(0.7);
        let matrix = turn * DMat2::from_diagonal(DVec2::new(3.0, -0.5)) * DMat2::from_angle(-1.1);
        let found = Magnification::of(matrix);
        assert!((found.least - 0.5).abs() < 1e-12 && (found.greatest - 3.0).abs() < 1e-12, "{found:?}");
    }
}
