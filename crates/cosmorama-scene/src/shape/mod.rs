//! Shapes that rays meet.

mod edge;
mod solid;
mod sphere;

pub(crate) use edge::Edge;
pub(crate) use solid::{Solid, Wall};
pub(crate) use sphere::Meeting;
pub use sphere::Sphere;
