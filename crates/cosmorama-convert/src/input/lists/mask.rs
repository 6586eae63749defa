//! Masks of views, from pictures and from shapes.

use std::path::Path;
use std::sync::Arc;

use cosmorama::raster::{EncodedImage, Rgba, Transfer};
use cosmorama::world::{MaskShape, ViewMask};
use cosmorama_io::{Limits, probe_from, read_from};

use crate::diagnostic::{Result, bail};
use crate::input::InputView;
use crate::source::Access;

/// Least code value that counts as visible; 1 is white.
const GREY: f32 = 0.5;

/// Returns the mask in a picture: pixels that are black, darker than middle grey, or transparent are hidden.
pub(crate) fn of_file(path: &Path, view: &InputView, access: Access) -> Result<Arc<ViewMask>> {
    let expected = size(view);
    // Checked before pixels take memory. The choice of parts and channels is for pictures, not for masks.
    let header = probe_from(access.files.open(path)?, path)?;
    let found = (header.width, header.height);
    if found != expected {
        let (mask, picture) = (format!("{}x{}", found.0, found.1), format!("{}x{}", expected.0, expected.1));
        bail!(WrongSize: "{}: the mask has {mask} pixels, but its picture has {picture}; they must have the same", path.display());
    }
    access.memory.check_mask(found, size_of::<Rgba>() as u64)?;
    let limits = Limits::memory(access.memory.bytes);
    let mask = of_image(&read_from(access.files.open(path)?, path, &limits)?.image);
    if mask.is_empty() {
        bail!(Uncovered: "{}: the mask is black all over: nothing of the picture would count", path.display());
    }
    Ok(Arc::new(mask))
}

/// Returns the mask made of shapes, in pixels of a picture in which the view's corner is at (left, top).
pub(crate) fn of_shapes(
    shapes: &[MaskShape],
    corner: (usize, usize),
    size: (usize, usize),
    access: Access,
) -> Result<Arc<ViewMask>> {
    access.memory.check_mask(size, size_of::<bool>() as u64)?;
    let mask = ViewMask::of_shapes(shapes, corner, size);
    if mask.is_empty() {
        bail!(Uncovered: "its masks and its crop leave nothing of it");
    }
    Ok(Arc::new(mask))
}

/// Applies a mask to a view. Hidden parts, and parts that its file lacks of a larger picture, are treated as never
/// photographed.
pub(crate) fn hide(view: &mut InputView, mask: Arc<ViewMask>) {
    view.take_for_whole();
    view.mask = Some(mask);
}

fn size(view: &InputView) -> (usize, usize) {
    let held = view.window.as_ref().map_or(&view.nominal, |(held, _)| held);
    (held.width(), held.height())
}

fn of_image(image: &EncodedImage) -> ViewMask {
    let (width, height) = (image.width(), image.height());
    let mut texels = vec![Rgba::TRANSPARENT; width * height];
    image.decode(&Transfer::Linear, &mut texels);
    ViewMask::new(width, height, |i, j| {
        let Rgba([red, green, blue, _]) = texels[j * width + i];
        (red + green + blue) / 3.0 >= GREY
    })
}
