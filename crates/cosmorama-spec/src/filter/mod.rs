//! Filters and kernels by name.

mod kernel;
mod name;

pub use kernel::KernelName;
pub use name::FilterName;
