pub(crate) mod gpano;
pub(crate) mod icc;

use cosmorama::raster::Transfer;

/// What a file says about its pixels, and what is carried from input to output.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Metadata {
    /// How code values relate to light; `None` where the file says nothing.
    /// In a PNG, cICP goes before iCCP, iCCP before sRGB, sRGB before gAMA, as the specification has it.
    pub transfer: Option<Transfer>,
    /// An ICC profile, carried to outputs that can hold one (PNG, JPEG, TIFF). When writing, it goes before
    /// `transfer`: leave it out where the output is encoded by another curve than the profile's.
    pub icc: Option<Vec<u8>>,
    /// What the file says that it is a picture of.
    pub envmap: Option<EnvMap>,
    /// The equirectangular panorama of which the image is this window, as GPano metadata of JPEG and PNG have it.
    pub panorama: Option<Window>,
    /// What the file says of itself that cannot be right and is left out, or is not followed: in words, one a line.
    pub complaints: Vec<String>,
    /// Channels of the file that are not read.
    pub other_channels: Vec<String>,
    /// Colour primaries by their number in ITU-T H.273 (cICP); they are carried, never converted.
    pub primaries: Option<u8>,
    /// How the file asks viewers to turn or mirror its picture: the Orientation of TIFF (tag 274), 2 to 8; `None` where it
    /// is to stay as it is. Nothing here turns it: pixels are read as they are stored.
    pub orientation: Option<u16>,
    /// The program that wrote the file.
    pub software: Option<String>,
}

/// A picture of the whole world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnvMap {
    /// OpenEXR's equirectangular panorama, its samples on the edges.
    LatLong,
    /// OpenEXR's six faces one below the other: +X −X +Y −Y +Z −Z in a right-handed frame, samples on the edges.
    Cube,
    /// The faces of a KTX or DDS file, one below the other: +X −X +Y −Y +Z −Z, left-handed, +Z ahead.
    GlCube,
}

/// Where an image lies in a larger canvas: OpenEXR's data window in its display window, a part of a panorama.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Columns of the canvas.
    pub canvas_width: usize,
    /// Rows of the canvas.
    pub canvas_height: usize,
    /// Column of the canvas in which the image's first column lies.
    pub x: usize,
    /// Row of the canvas in which the image's first row lies.
    pub y: usize,
}
