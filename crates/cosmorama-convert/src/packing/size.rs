use cosmorama::camera::{CameraError, CameraModel};
use cosmorama_spec::{Dual, Size};

use crate::diagnostic::{Code, Mark, Result, SIZE, usage, usage_as};

/// Returns the size of an image: as given, from a width, as a calibration has it, or with so many pixels per radian at
/// its centre. `option` is the setting that holds the camera model.
pub(crate) fn size(
    frame: CameraModel,
    given: Option<Size>,
    pixels_per_radian: Option<f64>,
    option: Mark,
) -> Result<(usize, usize)> {
    if let (None, Some(size)) = (given, measured(&frame)) {
        return Ok(size);
    }
    match (given, pixels_per_radian) {
        (Some(Size { width, height: Some(height) }), _) => Ok((width, height)),
        (Some(Size { width, height: None }), _) => match frame.natural_height(width) {
            height if height > Size::MOST => Err(usage(format!(
                "{option}: its shape makes {SIZE} {width} more than {} pixels high; give {SIZE} WxH, or a smaller field of view",
                Size::MOST
            ))),
            height => Ok((width, height)),
        },
        (None, Some(pixels)) => frame.size_at(pixels).map_err(|error| match error {
            CameraError::SizeNeeded | CameraError::SizeUnbounded { .. } => {
                usage(format!("{option}: {error}, with {SIZE} WxH"))
            }
            error => usage(format!("{option}: {error}")),
        }),
        (None, None) => Err(usage_as(
            Code::MissingSetting,
            format!(
                "{SIZE} is missing: without a picture as input, nothing tells how large the output is to be; as in {SIZE} 1024"
            ),
        )),
    }
}

/// Returns the size of the image by which a camera was calibrated.
fn measured(frame: &CameraModel) -> Option<(usize, usize)> {
    let CameraModel::Calibrated(camera) = frame else { return None };
    camera.size
}

/// Returns the size of an image of two circles. A width alone is that of one circle.
pub(crate) fn lens_image_size(
    dual: &Dual,
    given: Option<Size>,
    pixels_per_radian: Option<f64>,
    option: Mark,
) -> Result<(usize, usize)> {
    if let Some(Size { width, height: Some(height) }) = given {
        return Ok((width, height));
    }
    let of = |frame| size(CameraModel::Fisheye(frame), given, pixels_per_radian, option);
    let (front, back) = (of(dual.picture.front.frame)?, of(dual.picture.back.frame)?);
    Ok(dual.picture.arrangement.whole((front.0.max(back.0), front.1.max(back.1))))
}
