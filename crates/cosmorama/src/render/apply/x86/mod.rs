//! Instructions of x86 that have no portable equivalent.

pub(crate) mod blocks;
pub(crate) mod srgb;
