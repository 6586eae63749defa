//! Filters and kernels by name.

mod kernel;
mod name;
mod names;

pub use kernel::KernelName;
pub use name::FilterName;
