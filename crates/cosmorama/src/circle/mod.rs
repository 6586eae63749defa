//! Detection of a fisheye lens's circle in a photograph, by the black around it.

mod fit;
mod picture;
mod rim;

pub use fit::Circle;
pub use picture::{Found, find};
