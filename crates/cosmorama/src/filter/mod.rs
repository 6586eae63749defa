//! Filters: what is averaged over a footprint.

pub(crate) mod classic;
pub(crate) mod ewa;
pub(crate) mod ewa_pyramid;
pub(crate) mod gather;
pub(crate) mod kernel;
pub(crate) mod lookup;
pub(crate) mod reference;
pub(crate) mod rim;
pub(crate) mod settings;
pub(crate) mod taps;
pub(crate) mod traits;

pub use classic::{Classic, ClassicTables, IntegrationOrder, WeighedClassic};
pub(crate) use classic::{Passes, TwoPass};
pub use ewa::Ewa;
pub use ewa::paper::{TextureDerivatives, WeightTable, ewa};
pub use ewa_pyramid::EwaPyramid;
pub use ewa_pyramid::level::MOST_TEXELS;
pub use ewa_pyramid::texture::{Texture, TextureFootprint, Wrap};
pub use gather::ellipse::Ellipse;
pub(crate) use gather::ellipse::semi_axes;
pub(crate) use gather::pixel_taps::PixelTaps;
pub(crate) use kernel::KernelTable;
pub use kernel::{CrossSection, Kernel};
pub use lookup::{Bilinear, Feline, LabelRule, Labels, Point};
pub use reference::Reference;
pub use settings::{FilterKind, FilterSettings};
pub use traits::{Filter, PrepareError, Prepared, SetupCost, WIDEST};
