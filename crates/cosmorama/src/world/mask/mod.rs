//! Masks: the part of an image that counts.

pub(crate) mod shape;
pub(crate) mod view_mask;
