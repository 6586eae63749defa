//! Masks: which part of an image counts.

pub(crate) mod mask;
pub(crate) mod shape;
