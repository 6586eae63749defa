use std::path::Path;

use cosmorama::raster::{Image, Rgba};

/// Content of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PictureKind {
    /// Colours, to be decoded to light.
    Colour,
    /// Numbers, which are what their codes are.
    Numbers,
}

/// Place of a picture that a file names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureSource<'a> {
    /// A file of its own.
    File(&'a Path),
    /// Bytes of a file, which are inside the other one.
    Bytes(&'a [u8]),
}

/// Reader of the pictures that files name.
pub trait PictureReader {
    /// Reads a picture. Its alpha does not count: surfaces are opaque, and colours under an alpha of 0 are wanted, too.
    ///
    /// # Errors
    /// When it cannot be read; the reason is told behind what names it.
    fn picture(&mut self, source: PictureSource, kind: PictureKind) -> Result<Image<Rgba>, String>;
}
