use std::fmt;

use cosmorama::raster::{Channels, Depth, Primaries, Transfer};

use crate::metadata::{MetadataRoom, khronos};

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
    /// KTX 2 texture with the faces of a cube.
    Ktx2,
    /// KTX texture of version 1 with the faces of a cube.
    Ktx,
    /// DirectDraw surface with the faces of a cube.
    Dds,
    /// Frame of a video, or of a stream of pictures; this crate neither reads nor writes its pixels.
    Video,
    /// Portable float map in a stream of pictures, as of a video.
    Pfm,
}

/// Primaries that a format's files can name.
#[derive(Clone, Copy, PartialEq, Eq)]
enum HeldPrimaries {
    /// None; Rec. 709 is assumed.
    None,
    /// Primaries with a number in the Khronos Data Format Specification.
    Numbered,
    /// Primaries with a number in ITU-T H.273.
    Coded,
    /// Any.
    Any,
}

/// Properties of a format's files.
struct Properties {
    /// Name in messages.
    name: &'static str,
    /// Feature of the manifest without which a build lacks the format.
    feature: Option<&'static str>,
    /// Extensions of files that are written, in lower case.
    extensions: &'static [&'static str],
    depths: &'static [Depth],
    channels: &'static [Channels],
    longest_side: Option<usize>,
    primaries: HeldPrimaries,
    is_cube_map: bool,
    holds_levels: bool,
    has_compression: bool,
    holds_icc: bool,
    holds_exif: bool,
    holds_remarks: bool,
}

impl Properties {
    /// Properties that most formats share: 8 bits, any channels, no metadata.
    const PLAIN: Self = Self {
        name: "",
        feature: None,
        extensions: &[],
        depths: &[Depth::Eight],
        channels: &Channels::ALL,
        longest_side: None,
        primaries: HeldPrimaries::None,
        is_cube_map: false,
        holds_levels: false,
        has_compression: false,
        holds_icc: false,
        holds_exif: false,
        holds_remarks: true,
    };

    /// Properties that cube map textures share: the depths and channels that every graphics card supports.
    const TEXTURE: Self = Self {
        feature: Some("textures"),
        depths: &[Depth::Eight, Depth::Half, Depth::Float],
        channels: &[Channels::Rgba],
        is_cube_map: true,
        holds_levels: true,
        ..Self::PLAIN
    };

    const PNG: Self = Self {
        name: "PNG",
        extensions: &["png"],
        depths: &[Depth::Eight, Depth::Ten, Depth::Twelve, Depth::Sixteen],
        primaries: HeldPrimaries::Any,
        has_compression: true,
        holds_icc: true,
        holds_exif: true,
        ..Self::PLAIN
    };

    const JPEG: Self = Self {
        name: "JPEG",
        feature: Some("jpeg"),
        extensions: &["jpg", "jpeg"],
        channels: &[Channels::Grey, Channels::Rgb],
        primaries: HeldPrimaries::Any,
        longest_side: Some(u16::MAX as usize),
        holds_icc: true,
        holds_exif: true,
        ..Self::PLAIN
    };

    const TIFF: Self = Self {
        name: "TIFF",
        feature: Some("tiff"),
        extensions: &["tif", "tiff"],
        depths: &Depth::ALL,
        primaries: HeldPrimaries::Any,
        has_compression: true,
        holds_icc: true,
        holds_exif: true,
        ..Self::PLAIN
    };

    const TGA: Self = Self {
        name: "TGA",
        extensions: &["tga"],
        longest_side: Some(u16::MAX as usize),
        holds_remarks: false,
        ..Self::PLAIN
    };

    const HDR: Self = Self {
        name: "Radiance HDR",
        extensions: &["hdr", "pic"],
        depths: &[Depth::Float],
        channels: &[Channels::Rgb],
        primaries: HeldPrimaries::Any,
        ..Self::PLAIN
    };

    const EXR: Self = Self {
        name: "OpenEXR",
        feature: Some("exr"),
        extensions: &["exr"],
        depths: &[Depth::Half, Depth::Float],
        primaries: HeldPrimaries::Any,
        holds_levels: true,
        has_compression: true,
        ..Self::PLAIN
    };

    const KTX2: Self =
        Self { name: "KTX 2", extensions: &["ktx2"], primaries: HeldPrimaries::Numbered, ..Self::TEXTURE };

    const KTX: Self = Self { name: "KTX", extensions: &["ktx"], ..Self::TEXTURE };

    const VIDEO: Self = Self {
        name: "video",
        depths: &[Depth::Eight, Depth::Ten, Depth::Twelve, Depth::Sixteen],
        channels: &[Channels::Rgb],
        primaries: HeldPrimaries::Coded,
        holds_remarks: false,
        ..Self::PLAIN
    };

    const PFM: Self =
        Self { name: "PFM", depths: &[Depth::Float], channels: &[Channels::Rgb], holds_remarks: false, ..Self::PLAIN };

    const DDS: Self = Self { name: "DDS", extensions: &["dds"], holds_remarks: false, ..Self::TEXTURE };
}

/// Greatest number of bytes in a segment of a JPEG, without its length and its longest name.
const LARGEST_SEGMENT: usize = 65_533 - 29;

impl Format {
    /// All formats of picture files.
    pub const ALL: [Self; 9] =
        [Self::Png, Self::Jpeg, Self::Tiff, Self::Tga, Self::Hdr, Self::Exr, Self::Ktx2, Self::Ktx, Self::Dds];

    const fn properties(self) -> &'static Properties {
        match self {
            Self::Png => &Properties::PNG,
            Self::Jpeg => &Properties::JPEG,
            Self::Tiff => &Properties::TIFF,
            Self::Tga => &Properties::TGA,
            Self::Hdr => &Properties::HDR,
            Self::Exr => &Properties::EXR,
            Self::Ktx2 => &Properties::KTX2,
            Self::Ktx => &Properties::KTX,
            Self::Dds => &Properties::DDS,
            Self::Video => &Properties::VIDEO,
            Self::Pfm => &Properties::PFM,
        }
    }

    /// Returns the format with this extension, in any case, among those that can be written.
    pub fn of_extension(extension: &str) -> Option<Self> {
        let extension = extension.to_ascii_lowercase();
        Self::ALL.into_iter().find(|format| format.properties().extensions.contains(&&*extension))
    }

    /// Lists every extension that this build can write, for messages.
    pub fn extensions() -> String {
        let built = Self::ALL.into_iter().filter(|format| format.is_built());
        let all: Vec<_> = built.flat_map(|format| format.properties().extensions).copied().collect();
        all.join(", ")
    }

    /// Returns the feature of the manifest without which a build lacks the format; none for formats that every build has.
    pub const fn feature(self) -> Option<&'static str> {
        self.properties().feature
    }

    /// Returns the extensions of files that are written; none for a format that is only read.
    pub const fn own_extensions(self) -> &'static [&'static str] {
        self.properties().extensions
    }

    /// Returns the depths that the format can hold, coarsest first.
    pub const fn depths(self) -> &'static [Depth] {
        self.properties().depths
    }

    /// Returns the greatest number of columns and rows that the format can hold, if it has such a limit.
    pub const fn longest_side(self) -> Option<usize> {
        self.properties().longest_side
    }

    /// Returns the channels that the format can hold.
    pub const fn channels(self) -> &'static [Channels] {
        self.properties().channels
    }

    /// Returns whether the format can hold pixels of this depth with these channels.
    pub fn supports(self, depth: Depth, channels: Channels) -> bool {
        self.depths().contains(&depth) && self.channels().contains(&channels)
    }

    /// Returns this depth if the format can hold it, else the one that loses least. Light in textures is in halves, which graphics
    /// cards filter: floats only where they are asked for.
    pub fn nearest_depth(self, depth: Depth) -> Depth {
        let is_large = self.is_cube_map() && depth == Depth::Float;
        if self.depths().contains(&depth) && !is_large {
            return depth;
        }
        match (self, depth) {
            (Self::Exr, Depth::Sixteen) | (Self::Hdr | Self::Pfm, _) => Depth::Float,
            (Self::Exr, _) => Depth::Half,
            (Self::Ktx2 | Self::Ktx | Self::Dds, _) => Depth::Half,
            (Self::Png | Self::Tiff | Self::Video, _) => Depth::Sixteen,
            (Self::Jpeg | Self::Tga, _) => Depth::Eight,
        }
    }

    /// Returns these channels if the format can hold them, else those that lose least.
    pub fn nearest_channels(self, channels: Channels) -> Channels {
        match self {
            Self::Png | Self::Tiff | Self::Tga | Self::Exr => channels,
            Self::Jpeg => channels.without_alpha(),
            Self::Hdr | Self::Video | Self::Pfm => Channels::Rgb,
            Self::Ktx2 | Self::Ktx | Self::Dds => Channels::Rgba,
        }
    }

    /// Returns whether integer files keep this transfer function of their input: they can name it, and programs follow it.
    pub fn keeps_transfer(self, transfer: &Transfer, channels: Channels) -> bool {
        match (self, transfer) {
            (Self::Png, _) => true,
            // Those with a number in ITU-T H.273.
            (Self::Video, Transfer::Curve(_) | Transfer::Gamma(_)) => false,
            (Self::Video, _) => true,
            (Self::Jpeg | Self::Tiff, Transfer::Curve(_)) => true,
            (Self::Jpeg | Self::Tiff | Self::Ktx2, Transfer::Pq | Transfer::Hlg) => channels.is_colour(),
            _ => *transfer == Transfer::Srgb,
        }
    }

    /// Returns whether files can name these primaries, or programs assume them without a name.
    pub fn holds_primaries(self, primaries: &Primaries) -> bool {
        match self.properties().primaries {
            HeldPrimaries::Any => true,
            HeldPrimaries::Numbered => khronos::primaries_code(Some(primaries)) != khronos::UNSPECIFIED,
            HeldPrimaries::Coded => primaries.number().is_some(),
            HeldPrimaries::None => primaries.is_same(&Primaries::REC709),
        }
    }

    /// Returns whether it is that of frames in one file.
    pub const fn is_video(self) -> bool {
        matches!(self, Self::Video | Self::Pfm)
    }

    /// Returns whether the format's files hold the faces of a cube and nothing else, in an order of the format's own.
    pub const fn is_cube_map(self) -> bool {
        self.properties().is_cube_map
    }

    /// Returns whether a file can hold a picture with its mip levels.
    pub const fn holds_levels(self) -> bool {
        self.properties().holds_levels
    }

    /// Returns whether a file can be written row by row, so that its picture is never held whole.
    pub const fn takes_rows(self) -> bool {
        matches!(self, Self::Png | Self::Exr | Self::Tiff | Self::Hdr | Self::Jpeg | Self::Tga)
    }

    /// Returns whether the format offers several levels of lossless compression.
    pub const fn has_compression(self) -> bool {
        self.properties().has_compression
    }

    /// Returns the metadata that the format can hold.
    pub const fn room(self) -> MetadataRoom {
        let segment = if matches!(self, Self::Jpeg) { LARGEST_SEGMENT } else { usize::MAX };
        MetadataRoom {
            attributes: matches!(self, Self::Exr),
            texts: matches!(self, Self::Png),
            exif: if self.properties().holds_exif { Some(segment) } else { None },
        }
    }

    /// Returns whether the format has a place for statements of the program about the pixels.
    pub const fn holds_remarks(self) -> bool {
        self.properties().holds_remarks
    }

    /// Returns whether the format can hold an ICC profile.
    pub const fn holds_icc(self) -> bool {
        self.properties().holds_icc
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.properties().name)
    }
}
