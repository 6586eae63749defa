use std::fmt::Display;
use std::path::Path;

use cosmorama::camera::{CameraModel, Canvas};
use cosmorama_io::{Header, Window};

use crate::diagnostic::{Code, FROM, Result, bail, usage_as};

/// Returns the canvas of an image that is all of it.
pub(crate) fn whole(header: &Header) -> Canvas {
    Canvas { width: header.width, height: header.height, left: 0, top: 0 }
}

/// Converts a window to a canvas.
pub(crate) fn canvas_of(window: Window) -> Canvas {
    Canvas { width: window.canvas_width, height: window.canvas_height, left: window.x as i64, top: window.y as i64 }
}

/// Checks that a file with several pictures is whole, not a window of a canvas.
pub(crate) fn check_whole(path: &Path, header: &Header) -> Result<()> {
    let Some(window) = header.window else { return Ok(()) };
    bail!(
        Unsupported: "{}: only a part of a picture of {}x{} pixels; several pictures in one image are read from whole images",
        path.display(),
        window.canvas_width,
        window.canvas_height
    )
}

/// Checks that a window is not larger than its declared canvas.
pub(crate) fn fits_canvas(path: &Path, header: &Header, canvas: Canvas) -> Result<()> {
    if header.width <= canvas.width && header.height <= canvas.height {
        return Ok(());
    }
    Err(usage_as(
        Code::WrongSize,
        format!(
            "{}: {}x{} pixels are no window of a canvas of {}; give canvas=WxH+X+Y the size of the whole picture",
            path.display(),
            header.width,
            header.height,
            shape(&canvas)
        ),
    ))
}

/// Checks that a picture does not lie entirely beside its canvas. It may extend beyond the edges, but not go all the
/// way round. `name` is that of the picture with so many columns and rows.
pub(crate) fn lies_on_canvas(name: impl Display, (columns, rows): (usize, usize), canvas: Canvas) -> Result<()> {
    let overlaps = |start: i64, length: usize, whole: usize| start < whole as i64 && start + length as i64 > 0;
    if overlaps(canvas.left, columns, canvas.width) && overlaps(canvas.top, rows, canvas.height) {
        return Ok(());
    }
    Err(usage_as(
        Code::WrongSize,
        format!(
            "{name}: {columns}x{rows} pixels at {}, {} lie beside their canvas of {}; give canvas=WxH+X+Y the place of their first \
         pixel in the whole picture",
            canvas.left,
            canvas.top,
            shape(&canvas)
        ),
    ))
}

/// Checks that a map of a fixed shape has that shape; otherwise its pixels would be stretched.
pub(crate) fn fits_shape(path: &Path, frame: &CameraModel, canvas: Canvas) -> Result<()> {
    let (what, whole) = match frame {
        CameraModel::Equirect(_) => ("panorama of its field of view", "hfov=360,vfov=180 (or its own)"),
        CameraModel::WorldMap(_) => ("map of the world", "canvas=WxH+0+0"),
        CameraModel::Octahedral(_) => ("octahedral map", "canvas=WxH+0+0"),
        _ => return Ok(()),
    };
    let expected = frame.natural_height(canvas.width);
    if is_near(expected, canvas.height) {
        return Ok(());
    }
    Err(usage_as(
        Code::WrongSize,
        format!(
            "{}: {} pixels are no {what}: {}x{expected} were expected; if it is stretched, say so with {whole}; if it is a part, \
         give canvas=WxH+X+Y the whole, and if it is something else, another {FROM}",
            path.display(),
            shape(&canvas),
            canvas.width
        ),
    ))
}

/// Returns whether a height is the natural one, within a row of rounding.
pub(crate) fn is_near(natural: usize, height: usize) -> bool {
    natural.abs_diff(height) <= (natural / 100).max(1)
}

fn shape(canvas: &Canvas) -> String {
    format!("{}x{}", canvas.width, canvas.height)
}
