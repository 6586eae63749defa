//! Radiance pictures.

mod hdr;
mod rgbe;

pub(crate) use hdr::Hdr;
