//! Sheets for figures: shapes, lines of text, colours, unfolded faces, contours.

pub(crate) mod contour;
pub(crate) mod drawing;
pub(crate) mod field;
pub(crate) mod heading;
pub mod lettering;
pub(crate) mod net;
pub(crate) mod theme;
