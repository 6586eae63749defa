//! Description of a conversion before it runs: figures in numbers ([`Report`]) and drawings ([`Figures`]).

mod figures;
mod footprints;
mod magnification;
mod ownership;
mod path;
mod path_figure;
mod report;
mod sheet;
mod survey;
mod text;
mod unfolded;

pub use figures::Figures;
pub use magnification::{FaceSize, Magnification};
pub use path::PathReport;
pub use report::{Centre, Gathered, Memory, Report, ViewReport};
pub use sheet::lettering;
use text::Percent;
pub use unfolded::Underlay;
