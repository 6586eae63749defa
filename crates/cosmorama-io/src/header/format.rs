use std::path::Path;

use cosmorama::raster::{Channels, Depth};

use crate::IoError;

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Portable Network Graphics.
    Png,
    /// JPEG, baseline or progressive.
    Jpeg,
    /// TIFF.
    Tiff,
    /// Truevision Targa.
    Tga,
    /// Radiance RGBE.
    Hdr,
    /// OpenEXR.
    Exr,
    /// The faces of a cube in a KTX 2 texture.
    Ktx2,
    /// The same in the first version, which is only read.
    Ktx,
    /// The same in a DirectDraw surface.
    Dds,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 9] =
        [Self::Png, Self::Jpeg, Self::Tiff, Self::Tga, Self::Hdr, Self::Exr, Self::Ktx2, Self::Ktx, Self::Dds];

    /// The format that a file name asks for.
    ///
    /// # Errors
    /// When its extension is unknown or missing.
    pub fn from_extension(path: &Path) -> Result<Self, IoError> {
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        let extension = extension.to_ascii_lowercase();
        let unknown = || IoError::UnknownExtension { path: path.to_owned() };
        Self::ALL.into_iter().find(|format| format.own_extensions().contains(&&*extension)).ok_or_else(unknown)
    }

    /// The format of a file that begins so. TGA files have no mark of their own: for them the name must do.
    pub(crate) fn from_content(path: &Path, start: &[u8]) -> Result<Self, IoError> {
        match start {
            [0x89, b'P', b'N', b'G', ..] => Ok(Self::Png),
            [0xff, 0xd8, 0xff, ..] => Ok(Self::Jpeg),
            [b'I', b'I', 42 | 43, 0, ..] | [b'M', b'M', 0, 42 | 43, ..] => Ok(Self::Tiff),
            [0x76, 0x2f, 0x31, 0x01, ..] => Ok(Self::Exr),
            [b'#', b'?', ..] => Ok(Self::Hdr),
            [0xab, b'K', b'T', b'X', b' ', b'2', b'0', 0xbb, ..] => Ok(Self::Ktx2),
            [0xab, b'K', b'T', b'X', b' ', b'1', b'1', 0xbb, ..] => Ok(Self::Ktx),
            [b'D', b'D', b'S', b' ', ..] => Ok(Self::Dds),
            [] => Err(IoError::Empty { path: path.to_owned() }),
            _ if Self::from_extension(path).is_ok_and(|format| format == Self::Tga) => Ok(Self::Tga),
            _ => Err(IoError::UnknownContent { path: path.to_owned() }),
        }
    }

    const fn own_extensions(self) -> &'static [&'static str] {
        match self {
            Self::Png => &["png"],
            Self::Jpeg => &["jpg", "jpeg"],
            Self::Tiff => &["tif", "tiff"],
            Self::Tga => &["tga"],
            Self::Hdr => &["hdr", "pic"],
            Self::Exr => &["exr"],
            Self::Ktx2 => &["ktx2"],
            // Files are known by their content; it is never written.
            Self::Ktx => &[],
            Self::Dds => &["dds"],
        }
    }

    /// Every extension of what can be written, for messages.
    pub fn extensions() -> String {
        let all: Vec<_> = Self::ALL.iter().flat_map(|format| format.own_extensions()).copied().collect();
        all.join(", ")
    }

    /// Depths that the format can hold, coarsest first.
    pub const fn depths(self) -> &'static [Depth] {
        match self {
            Self::Png => &[Depth::Eight, Depth::Ten, Depth::Twelve, Depth::Sixteen],
            Self::Jpeg | Self::Tga => &[Depth::Eight],
            Self::Tiff => &Depth::ALL,
            Self::Hdr => &[Depth::Float],
            Self::Exr => &[Depth::Half, Depth::Float],
            Self::Ktx2 | Self::Dds => &[Depth::Eight, Depth::Half],
            Self::Ktx => &[],
        }
    }

    /// Columns, and rows, that a picture has at most, where the format counts no further.
    pub const fn longest_side(self) -> Option<usize> {
        match self {
            Self::Jpeg | Self::Tga => Some(u16::MAX as usize),
            _ => None,
        }
    }

    /// Channels that the format can hold.
    pub const fn channels(self) -> &'static [Channels] {
        match self {
            Self::Png | Self::Tiff | Self::Tga | Self::Exr => &Channels::ALL,
            Self::Jpeg => &[Channels::Grey, Channels::Rgb],
            Self::Hdr => &[Channels::Rgb],
            // What every graphics card takes.
            Self::Ktx2 | Self::Ktx | Self::Dds => &[Channels::Rgba],
        }
    }

    /// Whether the format can hold pixels of this depth with these channels.
    pub fn supports(self, depth: Depth, channels: Channels) -> bool {
        self.depths().contains(&depth) && self.channels().contains(&channels)
    }

    /// The depth itself where the format can hold it, else the one that loses least.
    pub fn nearest_depth(self, depth: Depth) -> Depth {
        if self.depths().contains(&depth) {
            return depth;
        }
        match (self, depth) {
            (Self::Exr, Depth::Sixteen) | (Self::Hdr, _) => Depth::Float,
            (Self::Exr, _) => Depth::Half,
            (Self::Ktx2 | Self::Ktx | Self::Dds, _) => Depth::Half,
            (Self::Png | Self::Tiff, _) => Depth::Sixteen,
            (Self::Jpeg | Self::Tga, _) => Depth::Eight,
        }
    }

    /// The channels themselves where the format can hold them, else those that lose least.
    pub fn nearest_channels(self, channels: Channels) -> Channels {
        match self {
            Self::Png | Self::Tiff | Self::Tga | Self::Exr => channels,
            Self::Jpeg => channels.without_alpha(),
            Self::Hdr => Channels::Rgb,
            Self::Ktx2 | Self::Ktx | Self::Dds => Channels::Rgba,
        }
    }

    /// Whether an integer file of the format can say how its code values relate to light, without an ICC profile.
    pub const fn names_transfer(self) -> bool {
        matches!(self, Self::Png)
    }

    /// Whether its files hold the faces of a cube and nothing else, in an order of their own.
    pub const fn is_cube_map(self) -> bool {
        matches!(self, Self::Ktx2 | Self::Ktx | Self::Dds)
    }

    /// Whether a file can hold a picture with smaller copies of itself.
    pub const fn holds_levels(self) -> bool {
        matches!(self, Self::Ktx2 | Self::Dds)
    }

    /// Whether its files can be pressed more or less without loss.
    pub const fn has_compression(self) -> bool {
        matches!(self, Self::Png | Self::Tiff | Self::Exr)
    }

    /// Whether the format can hold an ICC profile.
    pub const fn holds_icc(self) -> bool {
        matches!(self, Self::Png | Self::Jpeg | Self::Tiff)
    }
}

impl std::fmt::Display for Format {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Png => "PNG",
            Self::Jpeg => "JPEG",
            Self::Tiff => "TIFF",
            Self::Tga => "TGA",
            Self::Hdr => "Radiance HDR",
            Self::Exr => "OpenEXR",
            Self::Ktx2 => "KTX 2",
            Self::Ktx => "KTX",
            Self::Dds => "DDS",
        })
    }
}
