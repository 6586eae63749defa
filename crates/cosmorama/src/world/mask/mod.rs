//! Masks: which part of an image counts.

pub(crate) mod shape;
pub(crate) mod view_mask;
