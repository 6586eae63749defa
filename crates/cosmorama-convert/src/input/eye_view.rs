//! Views of one eye in a file for both.

use std::path::Path;

use cosmorama_io::Header;

use crate::diagnostic::Result;
use crate::input::InputView;
use crate::packing::eye::{squeezed, squeezed_canvas};
use crate::packing::{EyePart, Place};
use crate::source::Access;

/// Reads the header of a file, or of an eye's picture in it.
pub(crate) fn header(access: Access, path: &Path, eye: Option<EyePart>) -> Result<Header> {
    let header = access.probe(path)?;
    eye.map_or(Ok(header.clone()), |eye| eye.header(path, &header))
}

/// Returns an eye's view at its place in the file for both.
pub(crate) fn placed(part: EyePart, view: InputView) -> Result<InputView> {
    let squeeze = part.stereo.squeeze();
    let (name, nominal) = (format!("{} ({} eye)", view.name, part.eye.name()), squeezed(view.nominal, squeeze)?);
    let Some(header) = view.header else { return Ok(InputView { name, nominal, ..view }) };
    let size = (header.width, header.height);
    let Place { corner, of } = view.part.unwrap_or(Place { corner: (0, 0), of: size });
    let (rect, of) = part.rect(corner, size, of)?;
    let window = match view.window {
        Some((held, canvas)) => Some((squeezed(held, squeeze)?, squeezed_canvas(canvas, squeeze)?)),
        None => None,
    };
    Ok(InputView {
        name,
        part: Some(Place { corner: (rect.left, rect.top), of }),
        header: Some(Header { width: rect.width(), height: rect.height(), ..header }),
        nominal,
        window,
        ..view
    })
}
