use glam::DVec2;

use crate::camera::error::{check_field_of_view, check_positive};
use crate::camera::{Camera, CameraError, FieldStop, PixelGrid, PixelPoint, View};
use crate::projection::{Projection, ProjectionKind};
use crate::sphere::{Angle, Direction, Orientation};

/// Cylindrical projection: the height as a function of the latitude.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CylinderKind {
    /// Mercator's map.
    Mercator,
    /// The central cylinder.
    Central,
    /// Lambert's equal-area cylinder.
    EqualArea,
}

impl CylinderKind {
    fn projection(self) -> ProjectionKind {
        match self {
            Self::Mercator => ProjectionKind::MERCATOR,
            Self::Central => ProjectionKind::CENTRAL_CYLINDER,
            Self::EqualArea => ProjectionKind::EQUAL_AREA_CYLINDER,
        }
    }

    /// Returns half the plane's height for an image whose height is not given. Mercator's map is the square of web
    /// maps, the central cylinder shows 45° up and down, and the equal-area cylinder shows everything.
    fn usual_height(self) -> f64 {
        match self {
            Self::Mercator => std::f64::consts::PI,
            Self::Central | Self::EqualArea => 1.0,
        }
    }
}

/// A panorama on a cylinder, with the front in its middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CylinderCamera {
    /// Cylindrical projection.
    pub kind: CylinderKind,
    /// Range of longitudes.
    pub horizontal: Angle,
    /// Latitude of the upper edge, and of the lower one. The pixels' shape follows from it. Without it, pixels have the
    /// shape of `pixel_aspect` at the equator.
    pub top: Option<Angle>,
    /// A pixel's width over its height, at the equator; unused where the top is given.
    pub pixel_aspect: f64,
}

impl CylinderCamera {
    /// Returns a full turn of 360° with square pixels at the equator.
    pub const fn new(kind: CylinderKind) -> Self {
        Self { kind, horizontal: Angle::TURN, top: None, pixel_aspect: 1.0 }
    }
}

impl Camera for CylinderCamera {
    fn view(&self, width: usize, height: usize) -> Result<View, CameraError> {
        check_field_of_view("the horizontal field of view", self.horizontal, 360.0, false)?;
        check_positive("the pixel aspect", self.pixel_aspect)?;
        let (w, h) = (width as f64, height as f64);
        let step = self.horizontal.radians() / w;
        let step_y = match self.half_height()? {
            Some(half) => 2.0 * half / h,
            None => step / self.pixel_aspect,
        };
        Ok(View {
            projection: self.kind.projection(),
            orientation: Orientation::IDENTITY,
            grid: PixelGrid::centred(width, height, PixelPoint::new(w / 2.0, h / 2.0), DVec2::new(step, step_y)),
            stop: FieldStop::NONE,
        })
    }

    fn natural_ratio(&self) -> f64 {
        let given = self.half_height().ok().flatten();
        let half = given.unwrap_or_else(|| self.kind.usual_height() * self.pixel_aspect);
        2.0 * half / self.horizontal.radians()
    }
}

impl CylinderCamera {
    /// Returns the plane's height at the upper edge, if `top` is given.
    fn half_height(&self) -> Result<Option<f64>, CameraError> {
        let Some(top) = self.top else { return Ok(None) };
        let whole = top * 2.0;
        check_field_of_view("the vertical field of view", whole, 180.0, self.kind != CylinderKind::EqualArea)?;
        let edge = self.kind.projection().project(Direction::from_longitude_latitude(Angle::ZERO, top));
        Ok(edge.map(|edge| edge.y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_are_where_they_are_asked_for() {
        for kind in [CylinderKind::Mercator, CylinderKind::Central, CylinderKind::EqualArea] {
            let frame = CylinderCamera { top: Some(Angle::from_degrees(70.0)), ..CylinderCamera::new(kind) };
            let view = frame.view(400, 100).unwrap();
            let up = view.direction(PixelPoint::new(200.0, 0.0)).unwrap();
            let (_, latitude) = up.longitude_latitude();
            assert!((latitude.degrees() - 70.0).abs() < 1e-9, "{kind:?}");
            let square = CylinderCamera::new(kind).view(400, 100).unwrap().grid.step();
            assert!((square.x - square.y).abs() < 1e-15);
            let whole = CylinderCamera { top: Some(Angle::from_degrees(90.0)), ..frame };
            assert_eq!(whole.view(400, 100).is_ok(), kind == CylinderKind::EqualArea, "{kind:?}");
        }
    }

    #[test]
    fn the_web_s_map_is_square() {
        let frame = CylinderCamera::new(CylinderKind::Mercator);
        assert!((frame.natural_ratio() - 1.0).abs() < 1e-12);
        let corner = frame.view(256, 256).unwrap().direction(PixelPoint::new(0.0, 0.0)).unwrap();
        // The latitude at which the tiles of web maps end.
        assert!((corner.longitude_latitude().1.degrees() - 85.051_129).abs() < 1e-6);
    }
}
