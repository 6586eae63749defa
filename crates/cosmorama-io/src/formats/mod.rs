//! One file for each format: `probe` reads a header, `read` reads pixels, `write` writes them.

pub(crate) mod exr;
pub(crate) mod hdr;
pub(crate) mod jpeg;
pub(crate) mod png;
pub(crate) mod tga;
pub(crate) mod tiff;
