//! The circle that a fisheye lens leaves on a photograph, found from the black around it.

mod fit;
mod picture;
mod rim;

pub use fit::Circle;
pub use picture::{Found, find};
