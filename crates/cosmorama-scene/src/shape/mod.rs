//! Shapes that rays meet.

mod edge;
mod solid;
mod sphere;

pub(crate) use edge::Edge;
pub(crate) use sphere::Meeting;
pub(crate) use solid::{Solid, Wall};
pub use sphere::Sphere;
