use std::path::Path;

use cosmorama::camera::{Canvas, PixelRect, View};
use cosmorama::layout::{Eye, LayoutError, Stereo};
use cosmorama_io::{Header, Metadata};
use cosmorama_spec::Size;

use crate::diagnostic::{Code, ConvertError, FROM, Result, failure, usage, usage_as};
use crate::packing::canvas::check_whole;

/// An eye's part of a stereo image.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EyePart {
    pub(crate) stereo: Stereo,
    pub(crate) eye: Eye,
}

impl EyePart {
    /// Returns the header of an eye's picture, as if it were a file of its own and not squeezed.
    pub(crate) fn header(self, path: &Path, header: &Header) -> Result<Header> {
        check_whole(path, header)?;
        let (across, down) = self.stereo.squeeze();
        let part = self.stereo.part(self.eye, header.width, header.height).map_err(
            |error| failure!(WrongSize: "{}: {error} for two eyes; give {FROM} stereo= as it is", path.display()),
        )?;
        // Metadata of the file are about the two pictures together.
        let metadata = Metadata { envmap: None, panorama: None, ..header.metadata.clone() };
        Ok(Header { width: part.width() * across, height: part.height() * down, metadata, ..header.clone() })
    }

    /// Returns the place of a part of this eye's picture in the image for both, and that image's size.
    pub(crate) fn rect(
        self,
        corner: (usize, usize),
        size: (usize, usize),
        of: (usize, usize),
    ) -> Result<(PixelRect, (usize, usize))> {
        let image = self.stereo.image_size(of).map_err(halved)?;
        let eye = self.stereo.part(self.eye, image.0, image.1).map_err(halved)?;
        let squeeze = self.stereo.squeeze();
        let (corner, (width, height)) = (divided(corner, squeeze)?, divided(size, squeeze)?);
        let (left, top) = (eye.left + corner.0, eye.top + corner.1);
        Ok((PixelRect { left, top, right: left + width, bottom: top + height }, image))
    }
}

/// Returns the size of one eye's picture before it is squeezed, in an image of a given size. A width alone is that of
/// one eye.
pub(crate) fn eye_size(stereo: Stereo, given: Size) -> Result<Size> {
    let Size { width, height: Some(height) } = given else { return Ok(given) };
    let part = stereo.part(Eye::Left, width, height).map_err(halved)?;
    let (across, down) = stereo.squeeze();
    Ok(Size { width: part.width() * across, height: Some(part.height() * down) })
}

fn halved(error: LayoutError) -> ConvertError {
    usage(format!("stereo=: {error}"))
}

/// Returns the geometry of a squeezed picture.
pub(crate) fn squeezed(view: View, squeeze: (usize, usize)) -> Result<View> {
    divided((view.width(), view.height()), squeeze)?;
    Ok(View { grid: view.grid.squeezed(squeeze), ..view })
}

/// Returns the canvas of a squeezed picture.
pub(crate) fn squeezed_canvas(canvas: Canvas, (across, down): (usize, usize)) -> Result<Canvas> {
    let (width, height) = divided((canvas.width, canvas.height), (across, down))?;
    let (left, top) = (canvas.left / across as i64, canvas.top / down as i64);
    if (left * across as i64, top * down as i64) != (canvas.left, canvas.top) {
        return Err(odd((canvas.width, canvas.height)));
    }
    Ok(Canvas { width, height, left, top })
}

/// Returns the columns and rows of a squeezed picture.
fn divided((x, y): (usize, usize), (across, down): (usize, usize)) -> Result<(usize, usize)> {
    if x % across != 0 || y % down != 0 {
        return Err(odd((x, y)));
    }
    Ok((x / across, y / down))
}

fn odd((x, y): (usize, usize)) -> ConvertError {
    usage_as(
        Code::WrongSize,
        format!(
            "stereo=: {x}x{y} pixels of a picture cannot be squeezed to half; give sizes and places in even numbers, or a \
         packing without -half"
        ),
    )
}
