//! Radiance pictures.

pub(crate) mod hdr;
mod rgbe;
