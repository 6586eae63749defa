pub(crate) mod gpano;
pub(crate) mod icc;

use cosmorama::raster::Transfer;

/// Metadata of a file about its pixels, of which the parts that apply are carried from input to output.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Metadata {
    /// Transfer function; `None` if the file does not name one. In a PNG, cICP takes precedence over iCCP, iCCP over
    /// sRGB, and sRGB over gAMA, as the specification requires.
    pub transfer: Option<Transfer>,
    /// ICC profile, carried to outputs that can hold one (PNG, JPEG, TIFF). When writing, it takes precedence over
    /// `transfer`: omit it if the output is encoded by another curve than the profile's.
    pub icc: Option<Vec<u8>>,
    /// Kind of environment map that the file declares.
    pub envmap: Option<EnvMap>,
    /// Whole panorama of which the image is this window, as in the GPano metadata of JPEG and PNG.
    pub panorama: Option<Window>,
    /// Statements of the file that cannot be right, or that are ignored, in words, one per line.
    pub complaints: Vec<String>,
    /// What the file holds beside its picture and is rightly not read: in words, one a line.
    pub notes: Vec<String>,
    /// Names of channels that are not read.
    pub other_channels: Vec<String>,
    /// Colour primaries by their number in ITU-T H.273 (cICP). They are carried, never converted.
    pub primaries: Option<u8>,
    /// Orientation tag of TIFF (274), 2 to 8, by which the file asks viewers to turn or mirror its picture; `None` for
    /// no change. Pixels are read as stored.
    pub orientation: Option<u16>,
    /// Name of the program that wrote the file.
    pub software: Option<String>,
}

/// An environment map: a picture of the whole world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnvMap {
    /// OpenEXR's equirectangular panorama, with samples on the edges.
    LatLong,
    /// OpenEXR's six faces one below the other: +X −X +Y −Y +Z −Z in a right-handed frame, with samples on the edges.
    Cube,
    /// Faces of a KTX or DDS file, one below the other: +X −X +Y −Y +Z −Z, left-handed, with +Z ahead.
    GlCube,
}

/// Place of an image in a larger canvas: OpenEXR's data window in its display window, or a part of a panorama.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Columns of the canvas.
    pub canvas_width: usize,
    /// Rows of the canvas.
    pub canvas_height: usize,
    /// Column of the canvas at which the image begins.
    pub x: usize,
    /// Row of the canvas at which the image begins.
    pub y: usize,
}
