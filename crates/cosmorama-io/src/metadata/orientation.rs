//! Orientation of stored pictures: tag 274 of TIFF and Exif.

use cosmorama::layout::FacePlacement;

/// Returns columns and rows of a picture of this orientation, once it is upright.
pub(crate) fn turned((width, height): (usize, usize), orientation: Option<u16>) -> (usize, usize) {
    let is_sideways = orientation.is_some_and(|orientation| placement(orientation).quarter_turns % 2 == 1);
    if is_sideways { (height, width) } else { (width, height) }
}

/// Returns the placement that turns a picture of this orientation, 1 to 8, upright: mirrored first, and then turned
/// clockwise.
pub(crate) fn placement(orientation: u16) -> FacePlacement {
    let (quarter_turns, mirrored) = match orientation {
        2 => (0, true),
        3 => (2, false),
        4 => (2, true),
        5 => (3, true),
        6 => (1, false),
        7 => (1, true),
        8 => (3, false),
        _ => (0, false),
    };
    FacePlacement { quarter_turns, mirrored }
}
