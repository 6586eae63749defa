use glam::DVec2;

use crate::camera::error::{check_field_of_view, check_positive};
use crate::camera::{Camera, CameraError, CameraModel, FieldStop, LensCircle, PixelGrid, PixelPoint, View};
use crate::projection::ProjectionKind;
use crate::projection::azimuthal::{FisheyeLens, Lens, LensError};
use crate::sphere::{Angle, Orientation};

/// Dimension of the image that the fisheye's circle spans.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FisheyeFit {
    /// The shorter side: the whole circle is in the image.
    #[default]
    Short,
    /// The longer side: the circle is cut off at the two longer edges.
    Long,
    /// The width.
    Width,
    /// The height.
    Height,
    /// The diagonal: the circle covers the whole image, corners included.
    Diagonal,
}

impl FisheyeFit {
    fn of(self, width: f64, height: f64) -> f64 {
        match self {
            Self::Short => width.min(height),
            Self::Long => width.max(height),
            Self::Width => width,
            Self::Height => height,
            Self::Diagonal => width.hypot(height),
        }
    }
}

/// Scale of a lens's picture in its image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LensScale {
    /// The circle of the field of view spans a dimension of the image.
    Circle(FisheyeFit),
    /// Pixel widths per unit of the lens's formula; for most lenses that unit is the focal length.
    Focal(f64),
    /// Width of the image in units of the lens's formula: millimetres on a sensor.
    SensorWidth(f64),
}

impl Default for LensScale {
    fn default() -> Self {
        Self::Circle(FisheyeFit::default())
    }
}

/// A fisheye camera; its field of view ends at a circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FisheyeCamera {
    /// Lens formula: the angle from the axis as a function of the radius.
    pub lens: FisheyeLens,
    /// Angle across the circle's diameter.
    pub field_of_view: Angle,
    /// Scale of the picture.
    pub scale: LensScale,
    /// Place of the circle, if it is not centred.
    pub circle: LensCircle,
    /// A pixel's width over its height.
    pub pixel_aspect: f64,
}

impl Default for FisheyeCamera {
    fn default() -> Self {
        Self {
            lens: FisheyeLens::EQUIDISTANT,
            field_of_view: Angle::HALF_TURN,
            scale: LensScale::default(),
            circle: LensCircle::FITTED,
            pixel_aspect: 1.0,
        }
    }
}

impl FisheyeCamera {
    /// Returns the widest field of view that the lens can show, limited to what an image can hold.
    pub fn whole_field(lens: FisheyeLens) -> Angle {
        let reach = lens.reach();
        let ends = lens.radius(reach).is_some_and(|radius| radius < INFINITELY_FAR);
        Angle::from_radians(2.0 * if ends { reach } else { lens.angle(BEYOND_IMAGES).0 })
    }
}

impl Camera for FisheyeCamera {
    fn view(&self, width: usize, height: usize) -> Result<View, CameraError> {
        check_positive("the pixel aspect", self.pixel_aspect)?;
        let (w, h) = (width as f64, height as f64);
        let radius = self.rim()?;
        let step = match self.scale {
            // Lengths are measured in heights of a pixel, so that the circle is round.
            LensScale::Circle(fit) => 2.0 * radius / fit.of(w * self.pixel_aspect, h) * self.pixel_aspect,
            LensScale::Focal(pixels) => check_positive("the focal length", pixels).map(|()| pixels.recip())?,
            LensScale::SensorWidth(units) => check_positive("the sensor's width", units).map(|()| units / w)?,
        };
        let centre = PixelPoint::new(w / 2.0, h / 2.0);
        let fitted = PixelGrid::centred(width, height, centre, DVec2::new(step, step / self.pixel_aspect));
        Ok(View {
            projection: ProjectionKind::fisheye(self.lens),
            orientation: Orientation::IDENTITY,
            grid: self.circle.place(fitted, radius)?,
            stop: FieldStop::circle(radius),
        })
    }

    fn with_field_of_view(&self, field_of_view: Angle) -> Option<CameraModel> {
        let is_fitted = matches!(self.scale, LensScale::Circle(_));
        is_fitted.then(|| Self { field_of_view, ..*self }.into())
    }

    fn natural_ratio(&self) -> f64 {
        self.pixel_aspect
    }

    fn is_measured_in_pixels(&self) -> bool {
        self.circle != LensCircle::FITTED || matches!(self.scale, LensScale::Focal(_))
    }
}

impl FisheyeCamera {
    /// Returns the radius at which the field of view ends, in the unit of the lens's formula.
    fn rim(&self) -> Result<f64, CameraError> {
        self.check_lens()?;
        check_field_of_view("the field of view", self.field_of_view, 360.0, false)?;
        let (half, reach) = (self.field_of_view.radians() / 2.0, self.lens.reach());
        if half > reach + 1e-9 {
            let turn = self.lens.radius(reach).filter(|radius| *radius < INFINITELY_FAR);
            let (found, greatest) = (self.field_of_view.degrees(), 2.0 * reach.to_degrees());
            return Err(match turn {
                Some(radius) => CameraError::LensTurnsBack { found, greatest, radius },
                None => CameraError::FieldOfView { what: "the field of view", found, greatest, below: true },
            });
        }
        let rim = self.lens.radius(half.min(reach)).filter(|radius| *radius < INFINITELY_FAR);
        rim.ok_or(CameraError::FieldOfView {
            what: "the field of view",
            found: self.field_of_view.degrees(),
            greatest: 2.0 * reach.to_degrees(),
            below: true,
        })
    }
}

impl FisheyeCamera {
    /// Checks that the lens has an image near its axis. Coefficients of a measured lens may be far off.
    fn check_lens(&self) -> Result<(), CameraError> {
        let angle = self.lens.reach().min(NEAR_AXIS);
        match self.lens.radius(angle) {
            Some(radius) if radius.is_nan() || radius >= INFINITELY_FAR => {
                Err(CameraError::Lens(LensError::Endless { degrees: angle.to_degrees(), radius }))
            }
            _ => Ok(()),
        }
    }
}

/// Angle from the axis, in radians, at which every useful lens has a radius that an image can have.
const NEAR_AXIS: f64 = 0.5;

/// Radius, in the lens's unit, beyond which an image point counts as infinitely far.
const INFINITELY_FAR: f64 = 1e9;

/// Radius, in the lens's unit, that no image's corner reaches.
const BEYOND_IMAGES: f64 = 1e6;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::projection::azimuthal::{KannalaBrandt, Unified};

    fn angle_from_axis(frame: &FisheyeCamera, x: f64, y: f64) -> f64 {
        let view = frame.view(400, 300).unwrap();
        let direction = view.direction(PixelPoint::new(x, y)).unwrap();
        direction.angle_to(crate::sphere::Direction::FRONT).degrees()
    }

    #[test]
    fn the_circle_spans_what_is_asked_for() {
        for (fit, edge) in [
            (FisheyeFit::Short, (200.0, 0.0)),
            (FisheyeFit::Height, (200.0, 300.0)),
            (FisheyeFit::Long, (0.0, 150.0)),
            (FisheyeFit::Width, (400.0, 150.0)),
            (FisheyeFit::Diagonal, (400.0, 300.0)),
        ] {
            let frame = FisheyeCamera { scale: LensScale::Circle(fit), ..FisheyeCamera::default() };
            assert!((angle_from_axis(&frame, edge.0, edge.1) - 90.0).abs() < 1e-9, "{fit:?}");
        }
    }

    #[test]
    fn the_circle_may_be_placed() {
        let circle = LensCircle { centre: Some(PixelPoint::new(100.0, 50.0)), radius: Some(80.0) };
        let frame = FisheyeCamera { circle, ..FisheyeCamera::default() };
        assert!(angle_from_axis(&frame, 100.0, 50.0) < 1e-9);
        assert!((angle_from_axis(&frame, 180.0, 50.0) - 90.0).abs() < 1e-9);
    }

    #[test]
    fn a_fisheye_may_see_everything_but_no_more() {
        let frame = |degrees| FisheyeCamera { field_of_view: Angle::from_degrees(degrees), ..FisheyeCamera::default() };
        assert!(frame(360.0).view(4, 4).is_ok());
        assert!(frame(361.0).view(4, 4).is_err());
        assert!(frame(0.0).view(4, 4).is_err());
    }

    #[test]
    fn a_lens_shows_what_it_has_an_image_of_and_no_more() {
        let frame = |lens, degrees| {
            FisheyeCamera { lens, field_of_view: Angle::from_degrees(degrees), ..FisheyeCamera::default() }
                .view(100, 100)
        };
        let error = frame(FisheyeLens::ORTHOGRAPHIC, 190.0).unwrap_err().to_string();
        assert!(error.contains("190°") && error.contains("radius 1,") && error.contains("at most 180°"), "{error}");
        let error = frame(FisheyeLens::STEREOGRAPHIC, 360.0).unwrap_err().to_string();
        assert!(error.contains("less than 360°"), "{error}");
        for lens in FisheyeLens::all() {
            let whole = FisheyeCamera::whole_field(lens).degrees();
            assert!(frame(lens, whole - 1.0).is_ok(), "{lens:?}");
            assert!(whole > 359.9 || frame(lens, whole + 1.0).is_err(), "{lens:?}");
        }
    }

    #[test]
    fn coefficients_that_reach_beyond_any_image_are_named() {
        let lens = KannalaBrandt::from_opencv([1e300, 0.0, 0.0, 0.0]).map(FisheyeLens::KannalaBrandt).unwrap();
        for scale in [LensScale::default(), LensScale::Focal(300.0)] {
            let field_of_view = FisheyeCamera::whole_field(lens);
            for field_of_view in [field_of_view, Angle::HALF_TURN] {
                let frame = FisheyeCamera { lens, scale, field_of_view, ..FisheyeCamera::default() };
                let error = frame.view(100, 100).unwrap_err().to_string();
                assert!(error.contains("from the axis: the coefficients cannot be right"), "{error}");
            }
        }
    }

    #[test]
    fn every_lens_shows_its_whole_field() {
        let infinite = [(0.0, 180.0), (0.3, 230.753_867), (0.5, 360.0)];
        let lenses = infinite.map(|(alpha, degrees)| {
            let lens = Unified::from_parameters(alpha, 1.0).map(FisheyeLens::Unified).unwrap();
            assert!((FisheyeCamera::whole_field(lens).degrees() - degrees).abs() < 1e-3, "{alpha}");
            lens
        });
        for lens in FisheyeLens::all().into_iter().chain(lenses) {
            let field_of_view = FisheyeCamera::whole_field(lens);
            for scale in [LensScale::Focal(50.0), LensScale::SensorWidth(0.1)] {
                let frame = FisheyeCamera { lens, field_of_view, scale, ..FisheyeCamera::default() };
                let view = frame.view(400, 300).unwrap();
                assert!(view.direction(PixelPoint::new(210.0, 140.0)).is_some(), "{lens:?}");
            }
        }
    }

    #[test]
    fn a_focal_length_in_pixels_or_a_sensor_in_millimetres() {
        let focal = FisheyeCamera { scale: LensScale::Focal(100.0), ..FisheyeCamera::default() };
        assert!((angle_from_axis(&focal, 300.0, 150.0).to_radians() - 1.0).abs() < 1e-12);
        let sensor = FisheyeCamera { scale: LensScale::SensorWidth(4.0), ..FisheyeCamera::default() };
        assert!((angle_from_axis(&sensor, 300.0, 150.0).to_radians() - 1.0).abs() < 1e-12);
    }
}
