//! What a conversion will do before it does it: figures in numbers ([`Report`]) and in pictures ([`Figures`]).

mod contour;
mod drawing;
mod field;
mod figures;
mod footprints;
pub mod lettering;
mod magnification;
mod net;
mod ownership;
mod report;
mod survey;
mod text;
mod theme;
mod unfolded;

pub use figures::{Figures, Underlay};
pub use magnification::{FaceSize, Magnification};
pub use report::{Centre, Gathered, Memory, Report, ViewReport};
