//! Description of a conversion before it runs: figures in numbers ([`Report`]) and drawings ([`Figures`]).

mod figures;
mod footprints;
mod magnification;
mod ownership;
mod path;
mod report;
pub(crate) mod sheet;
mod survey;
mod template;
mod text;
mod unfolded;

pub use figures::Figures;
pub use magnification::{FaceSize, Magnification};
pub use path::{Parallax, PathReport};
pub use report::{Centre, Gathered, Memory, Report, ViewReport};
pub use sheet::lettering;
pub use template::Guide;
use text::Percent;
pub use unfolded::Underlay;
