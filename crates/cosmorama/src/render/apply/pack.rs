use bytemuck::NoUninit;

use crate::render::plan::symmetry::TOGETHER;
use crate::render::scan::tile::SIDE;

/// The light of a pass's windows: by run, lane and mirror, these in the order in which the view's are walked through, from the pass's
/// first one on; elsewhere any.
pub(crate) type GroupLight<L> = [[[L; TOGETHER]; SIDE]; SIDE];

/// What makes pixels of the light of windows.
pub(crate) trait Develop {
    type Light: Copy;
    type Pixel: NoUninit;

    /// The pixel of a window's light.
    fn one(&self, light: Self::Light) -> Self::Pixel;

    /// The pixels of eight, which most of them are made as.
    fn eight(&self, light: [&Self::Light; SIDE]) -> [Self::Pixel; SIDE];
}
