use thiserror::Error;

/// Reason why a camera model gives no view.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum CameraError {
    /// An image of nothing.
    #[error("an image of {width}x{height} pixels has nothing to show")]
    NoPixels {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// A field of view that the projection cannot show.
    #[error("{what} is {}°; it must be more than 0° and {}", rounded(*.found), if *.below { format!("less than {}°", rounded(*.greatest)) } else { format!("at most {}°", rounded(*.greatest)) })]
    FieldOfView {
        /// Which one.
        what: &'static str,
        /// Degrees asked for.
        found: f64,
        /// The limit in degrees.
        greatest: f64,
        /// Whether the limit itself is excluded.
        below: bool,
    },
    /// A field of view beyond the place where the lens's formula turns back.
    #[error(
        "the field of view is {}°, but the lens's formula turns back at radius {}, {}° from the axis: it shows at most {}°",
        rounded(*.found), rounded(*.radius), rounded(.greatest / 2.0), rounded(*.greatest)
    )]
    LensTurnsBack {
        /// Degrees asked for.
        found: f64,
        /// The limit in degrees.
        greatest: f64,
        /// Where that is, in the unit of the formula.
        radius: f64,
    },
    /// A calibration whose formula turns back within the image.
    #[error(
        "the calibration's formula turns back {}° from the axis, {} pixels from its centre, and the image reaches further; \
         give fov= (at most {}) to leave out what lies beyond, or calibrate again with points near the corners",
        rounded(.greatest / 2.0), rounded(*.radius), rounded(*.greatest)
    )]
    CalibrationTurnsBack {
        /// The radius in pixels.
        radius: f64,
        /// Degrees that it shows at most.
        greatest: f64,
    },
    /// Hugin's correction turns back within the image.
    #[error(
        "Hugin's a, b, c turn back {}° from the axis, at radius {} pixels before the correction and {} after it, but the image \
         reaches to {} pixels: they cannot be right for this image",
        rounded(*.degrees), rounded(*.ideal), rounded(*.radius), rounded(*.end)
    )]
    CorrectionTurnsBack {
        /// From the axis.
        degrees: f64,
        /// In pixels, by the lens before its correction.
        ideal: f64,
        /// In pixels, in the image.
        radius: f64,
        /// How far the image reaches from the axis, in pixels.
        end: f64,
    },
    /// Hugin's correction of a picture that is a panorama.
    #[error("a, b, c correct a lens; for panoramas (f1, f4) they must be 0")]
    CorrectedPanorama,
    /// Coefficients of which no lens can be made.
    #[error("{0}")]
    Lens(crate::projection::azimuthal::LensError),
    /// An image of another shape than the one that was measured.
    #[error(
        "the image has {}x{} pixels, but the calibration was made for {}x{}, which has another shape; if the image is a part \
         of such a picture, give canvas=", found.0, found.1, measured.0, measured.1
    )]
    CalibrationSize {
        /// Columns and rows of the image.
        found: (usize, usize),
        /// Columns and rows of the image that was measured.
        measured: (usize, usize),
    },
    /// A camera matrix that no camera has.
    #[error("the camera matrix has the determinant {determinant}; it must be more than 0, its numbers finite")]
    CameraMatrix {
        /// Of its left part.
        determinant: f64,
    },
    /// A number out of its range.
    #[error("{what} is {found}{unit}; it must be {range}")]
    OutOfRange {
        /// Which one.
        what: &'static str,
        /// What was asked for.
        found: f64,
        /// In what: ` pixels`, or nothing.
        unit: &'static str,
        /// What there is.
        range: &'static str,
    },
    /// A circle of which nothing is on the image.
    #[error(
        "a circle of radius {} pixels around {}:{} lies off the picture's {width}x{height} pixels; center=X:Y counts from the \
         upper left corner, and radius= in pixels", rounded(*.radius), rounded(.centre.0), rounded(.centre.1)
    )]
    CircleOffImage {
        /// Its centre, in pixels of the image, or of the half that is its.
        centre: (f64, f64),
        /// Its radius in pixels.
        radius: f64,
        /// Columns of the image.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// A resolution that no image can hold.
    #[error("as fine as the input, the image would have {width:.3e}x{height:.3e} pixels; its size must be given")]
    SizeUnbounded {
        /// Columns.
        width: f64,
        /// Rows.
        height: f64,
    },
    /// The circle is placed in pixels of an unknown image.
    #[error("the lens's centre, radius or focal length is given in pixels, so the size of the image must be given too")]
    SizeNeeded,
}

/// A field of view within its limit.
pub(crate) fn check_field_of_view(
    what: &'static str,
    angle: crate::sphere::Angle,
    greatest: f64,
    below: bool,
) -> Result<(), CameraError> {
    let found = angle.degrees();
    // Degrees that were turned to radians and back have rounding errors.
    let inside = found > 0.0 && if below { found < greatest } else { found <= greatest + 1e-9 };
    if inside { Ok(()) } else { Err(CameraError::FieldOfView { what, found, greatest, below }) }
}

/// A length or ratio above zero.
pub(crate) fn check_positive(what: &'static str, found: f64) -> Result<(), CameraError> {
    let is_positive = found > 0.0 && found.is_finite();
    if is_positive { Ok(()) } else { Err(CameraError::OutOfRange { what, found, unit: "", range: "more than 0" }) }
}

/// Six decimals, without zeros at the end.
pub(crate) fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}
