//! Instructions of x86 that portable vectors have no word for.

pub(crate) mod blocks;
pub(crate) mod srgb;
