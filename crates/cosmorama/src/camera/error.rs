use thiserror::Error;

/// Reason why a camera model cannot make a view.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum CameraError {
    /// The image has no pixels.
    #[error("an image of {width}x{height} pixels has nothing to show")]
    NoPixels {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// The field of view is wider than the projection can show.
    #[error("{what} is {}°; it must be more than 0° and {}", rounded(*.found), if *.below { format!("less than {}°", rounded(*.greatest)) } else { format!("at most {}°", rounded(*.greatest)) })]
    FieldOfView {
        /// Kind of field of view, for the message: horizontal, vertical and so on.
        what: &'static str,
        /// Requested angle in degrees.
        found: f64,
        /// The limit in degrees.
        greatest: f64,
        /// Whether the limit itself is excluded.
        below: bool,
    },
    /// The field of view reaches beyond the radius at which the lens's formula turns back.
    #[error(
        "the field of view is {}°, but the lens's formula turns back at radius {}, {}° from the axis: it shows at most {}°",
        rounded(*.found), rounded(*.radius), rounded(.greatest / 2.0), rounded(*.greatest)
    )]
    LensTurnsBack {
        /// Requested angle in degrees.
        found: f64,
        /// The limit in degrees.
        greatest: f64,
        /// Radius at which the formula turns back, in the unit of the formula.
        radius: f64,
    },
    /// The calibration's formula turns back within the image.
    #[error(
        "the calibration's formula turns back {}° from the axis, {} pixels from its centre, and the image reaches further; \
         give fov= (at most {}) to leave out what lies beyond, or calibrate again with points near the corners",
        rounded(.greatest / 2.0), rounded(*.radius), rounded(*.greatest)
    )]
    CalibrationTurnsBack {
        /// Radius at which the formula turns back, in pixels.
        radius: f64,
        /// Greatest field of view that the calibration can show, in degrees.
        greatest: f64,
    },
    /// Hugin's correction turns back within the image.
    #[error(
        "Hugin's a, b, c turn back {}° from the axis, at radius {} pixels before the correction and {} after it, but the image \
         reaches to {} pixels: they cannot be right for this image",
        rounded(*.degrees), rounded(*.ideal), rounded(*.radius), rounded(*.end)
    )]
    CorrectionTurnsBack {
        /// Angle from the axis at which the correction turns back, in degrees.
        degrees: f64,
        /// Radius before the correction, in pixels.
        ideal: f64,
        /// Radius after the correction, in pixels of the image.
        radius: f64,
        /// Distance from the axis to the image's furthest corner, in pixels.
        end: f64,
    },
    /// The picture is a panorama, for which Hugin's correction is not supported.
    #[error("a, b, c correct a lens; for panoramas (f1, f4) they must be 0")]
    CorrectedPanorama,
    /// The coefficients do not make a lens.
    #[error("{0}")]
    Lens(crate::projection::azimuthal::LensError),
    /// The image's shape differs from that of the image that was calibrated.
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
    /// The camera matrix is singular or mirrors the picture.
    #[error("the camera matrix has the determinant {determinant}; it must be more than 0, its numbers finite")]
    CameraMatrix {
        /// Determinant of the matrix's left 2×2 part.
        determinant: f64,
    },
    /// A parameter is out of its range.
    #[error("{what} is {}{unit}; it must be {range}", in_short(*.found))]
    OutOfRange {
        /// Name of the parameter.
        what: &'static str,
        /// Requested value.
        found: f64,
        /// Unit for the message: ` pixels`, or nothing.
        unit: &'static str,
        /// Permitted range, in words.
        range: &'static str,
    },
    /// The circle lies entirely outside the image.
    #[error(
        "a circle of radius {} pixels around {}:{} lies off the picture's {width}x{height} pixels; center=X:Y counts from the \
         upper left corner, and radius= in pixels", rounded(*.radius), rounded(.centre.0), rounded(.centre.1)
    )]
    CircleOffImage {
        /// Centre of the circle in pixels, of the image or of the lens's half of it.
        centre: (f64, f64),
        /// Radius of the circle in pixels.
        radius: f64,
        /// Columns of the image.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// The size that matches the requested resolution is larger than any image file.
    #[error("as fine as the input, the image would have {width:.3e}x{height:.3e} pixels; its size must be given")]
    SizeUnbounded {
        /// Columns.
        width: f64,
        /// Rows.
        height: f64,
    },
    /// The circle is placed in pixels, and the image's size is not known.
    #[error("the lens's centre, radius or focal length is given in pixels, so the size of the image must be given too")]
    SizeNeeded,
}

/// Checks that a field of view is within its limit.
pub(crate) fn check_field_of_view(
    what: &'static str,
    angle: crate::sphere::Angle,
    greatest: f64,
    below: bool,
) -> Result<(), CameraError> {
    let found = angle.degrees();
    // Converting degrees to radians and back has rounding errors.
    let inside = found > 0.0 && if below { found < greatest } else { found <= greatest + 1e-9 };
    if inside { Ok(()) } else { Err(CameraError::FieldOfView { what, found, greatest, below }) }
}

/// Checks that a length or ratio is above zero.
pub(crate) fn check_positive(what: &'static str, found: f64) -> Result<(), CameraError> {
    let is_positive = found > 0.0 && found.is_finite();
    if is_positive { Ok(()) } else { Err(CameraError::OutOfRange { what, found, unit: "", range: "more than 0" }) }
}

/// Rounds a number of everyday size to six decimals, since conversion from degrees to radians and back adds digits.
/// Other numbers stay as they are.
fn in_short(value: f64) -> f64 {
    if (1e-3..1e9).contains(&value.abs()) { rounded(value) } else { value }
}

/// Rounds to six decimals.
pub(crate) fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}
