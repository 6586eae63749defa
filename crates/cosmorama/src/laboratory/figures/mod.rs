//! Drawings of the papers' figures that are not of a conversion: pixels on the screen, the paraboloid Q, kernels, and a
//! reflection cone. They are SVG documents, as those of [`explain`](crate::explain) are.

mod cone;
mod kernel;
mod paraboloid;
mod plot;
mod screen;

pub use cone::cone;
pub use kernel::kernel;
pub use paraboloid::paraboloid;
pub use screen::circles;
