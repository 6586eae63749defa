//! GPano metadata of panoramas that are written.

use cosmorama::camera::{CameraModel, Canvas, EquirectCamera, Mirror, Placement, SamplePositions};
use cosmorama::sphere::Angle;
use cosmorama_io::{Format, Window};
use cosmorama_spec::{Shape, Single, Spec};

use crate::diagnostic::{Code, Diagnostic, SIZE};
use crate::settings::GeometrySettings;
use crate::target::Target;

/// Returns the metadata of a panorama of 360°×180°, or of a window of one, of so many columns and rows.
pub(crate) fn window(single: &Single, (width, height): (usize, usize)) -> Option<Window> {
    let frame = described(single)?;
    let part = single.placement.canvas.unwrap_or(Canvas { width, height, left: 0, top: 0 });
    // The whole sphere in pixels of the part, which lies in its middle.
    let (whole_width, left) = around(part.width, frame.horizontal, 360.0)?;
    let (whole_height, top) = around(part.height, frame.vertical, 180.0)?;
    let (x, y) = (usize::try_from(left + part.left).ok()?, usize::try_from(top + part.top).ok()?);
    let inside = x.checked_add(width)? <= whole_width && y.checked_add(height)? <= whole_height;
    // Viewers take pixels for square.
    (inside && whole_width == 2 * whole_height).then_some(Window {
        canvas_width: whole_width,
        canvas_height: whole_height,
        x,
        y,
    })
}

/// Returns the panorama if GPano can describe it.
fn described(single: &Single) -> Option<EquirectCamera> {
    let Placement { frame: CameraModel::Equirect(frame), mirror, .. } = single.placement else { return None };
    (frame.samples == SamplePositions::Centres && mirror == Mirror::default()).then_some(frame)
}

/// Returns the pixels of the full angle, and those before the picture, where `pixels` span the field of view. `None` if
/// they are not whole numbers, because the metadata holds only those.
fn around(pixels: usize, field_of_view: Angle, degrees: f64) -> Option<(usize, i64)> {
    let exact = pixels as f64 * degrees / field_of_view.degrees();
    let whole = exact.round();
    let is_whole = (exact - whole).abs() < 0.01 && whole < i64::MAX as f64;
    let before = (whole as i64).checked_sub(i64::try_from(pixels).ok()?)?;
    (is_whole && before >= 0 && before % 2 == 0).then_some((whole as usize, before / 2))
}

/// Returns a warning if a part of a panorama is written to a format with GPano metadata, but this size cannot be
/// described.
pub(crate) fn warning(geometry: &GeometrySettings, target: &Target) -> Option<Diagnostic> {
    let Some(Spec { shape: Shape::Single(single), stereo: None, .. }) = &geometry.to else { return None };
    let frame = described(single)?;
    let output = target.views.first()?;
    let size = (output.view.width(), output.view.height());
    let is_whole = single.placement.canvas.is_none() && frame == EquirectCamera::default();
    if target.panorama.is_some() || is_whole || !matches!(target.format, Format::Jpeg | Format::Png) {
        return None;
    }
    let fitting = if single.placement.canvas.is_none() { near(single, size.0) } else { None };
    let advice = fitting.map_or_else(String::new, |(width, height)| format!("; {SIZE} {width}x{height} would do"));
    let message = format!(
        "{}: no GPano metadata are written, so that programs take it for a whole panorama: they need its place in that as whole \
         numbers of square pixels, which {}x{} pixels do not give{advice}",
        output.name, size.0, size.1
    );
    Some(Diagnostic::warning(Code::Panorama, message).about(&output.name))
}

/// Greatest difference to a suggested size.
const FURTHEST: usize = 1024;

/// Returns the size nearest to a width for which there is metadata.
fn near(single: &Single, width: usize) -> Option<(usize, usize)> {
    let frame = &single.placement.frame;
    let widths = (0..FURTHEST.min(width)).flat_map(|off| [width + off, width - off]);
    let mut sizes = widths.map(|width| (width, frame.natural_height(width)));
    sizes.find(|size| window(single, *size).is_some())
}
