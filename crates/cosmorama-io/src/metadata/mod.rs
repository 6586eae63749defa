mod carried;
mod colour_name;
pub(crate) mod gpano;
mod h273;
pub(crate) mod icc;
pub(crate) mod khronos;
mod layers;
pub(crate) mod orientation;

pub use carried::{Attribute, Carried, Exif, Kept, MetadataRoom, TextChunk};
pub(crate) use carried::{LARGEST_ATTRIBUTE, LARGEST_EXIF, XMP, iptc, is_read, of_stored, stored};
pub(crate) use colour_name::{ADOBE_GAMMA, colour_name};
pub use gpano::Pose;
pub use h273::transfer_of_number;
pub use layers::{FilePart, Layers, NamedChannel, SampleKind};

use std::borrow::Cow;
use std::sync::Arc;

use cosmorama::raster::{Channels, Depth, Primaries, Transfer};

/// Name of the program in files that it writes.
pub(crate) const SOFTWARE: &str = "cosmorama";

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
    /// Other content of the file that is rightly not read, such as previews; a sentence each.
    pub notes: Vec<String>,
    /// Number of partly transparent pixels whose colour exceeds alpha, of integers that the file says are premultiplied. Such
    /// colour is cut to white when pixels are read, because integers are straight in memory.
    pub cut_colours: usize,
    /// Names of channels that are not read.
    pub other_channels: Vec<String>,
    /// Channels beside the picture's, and parts, of formats that name them.
    pub layers: Layers,
    /// Primaries of the pixels; `None` if the file does not name them. In a PNG, cICP, iCCP and sRGB take precedence
    /// over cHRM.
    pub primaries: Option<Primaries>,
    /// Luminance of white in cd/m², from OpenEXR's `whiteLuminance`.
    pub white_luminance: Option<f32>,
    /// Reason why the ICC profile cannot be applied; `None` where it can, or there is none.
    pub profile_fault: Option<ProfileFault>,
    /// Orientation by TIFF's and Exif's tag 274, 2 to 8, by which the stored pixels were turned or mirrored when the file
    /// was read; `None` for no change. Written files need none.
    pub orientation: Option<u16>,
    /// Name of the program that wrote the file. Written files name this library.
    pub software: Option<String>,
    /// Words about how this library made the picture, 1 to 256 printable letters of ASCII; others are not written. Formats that name the
    /// program hold them behind its name. If that name, or a letter of the words, is damaged on its way, they are read together, with `?`
    /// for what is no letter: not as they were written, but not as none.
    pub origin: Option<String>,
    /// Description of the stored codes where those that are read are others, such as "of 4 bits".
    pub rescaled: Option<String>,
    /// Pose of the camera, from the GPano metadata of a panorama.
    pub pose: Option<Pose>,
    /// Other metadata of the file, which outputs may take over.
    pub carried: Arc<Carried>,
    /// Statements of the program about the pixels to write, each under a name, such as the unit of a map of light. Reading finds
    /// them again among `carried`, where the format has a place for both.
    pub remarks: Vec<Remark>,
}

/// Statement about the pixels: a name and a text, both in ASCII.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Remark {
    /// Name, at most 31 letters.
    pub name: &'static str,
    /// Text.
    pub text: Cow<'static, str>,
}

/// Reason why an ICC profile cannot be applied.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ProfileFault {
    /// The profile consists of tables of colours instead of curves and primaries.
    Tables,
    /// The profile is damaged, or is for other pictures than this one; in words.
    Damaged(String),
}

/// Returns whether words can be an origin: every format holds them.
fn is_origin(words: &str) -> bool {
    (1..=LONGEST_ORIGIN).contains(&words.len()) && words.chars().all(is_plain)
}

/// Letters of an origin, at most.
const LONGEST_ORIGIN: usize = 256;

/// Returns whether a letter is printable ASCII.
fn is_plain(letter: char) -> bool {
    (' '..='~').contains(&letter)
}

/// Returns the words behind the name of the program that wrote a file. If the name is ours but for one letter, or the words are not as they may
/// be, it returns name and words: few formats have checksums of texts, and damaged words are not the same as none.
fn origin_of(software: &str) -> Option<String> {
    let words = software.strip_prefix(SOFTWARE).and_then(|rest| rest.strip_prefix(" (")?.strip_suffix(')'));
    match words {
        Some(words) if is_origin(words) => Some(words.to_owned()),
        _ => {
            let letters = software.chars().map(|letter| if is_plain(letter) { letter } else { '?' });
            is_nearly_ours(software).then(|| letters.take(LONGEST_ORIGIN).collect())
        }
    }
}

/// Returns whether at most one letter around the words of an origin is another.
fn is_nearly_ours(software: &str) -> bool {
    let start: Vec<char> = SOFTWARE.chars().chain(" (".chars()).collect();
    let letters = software.chars().count();
    let differ = start.iter().zip(software.chars()).filter(|(expected, found)| **expected != *found).count();
    letters > start.len() + 1 && differ + usize::from(!software.ends_with(')')) <= 1
}

impl Metadata {
    /// Returns the name of the colour space as people say it, such as "Rec. 2020, PQ"; `None` where the file does not
    /// name both primaries and transfer function.
    pub fn colour_space(&self) -> Option<String> {
        colour_name(self.primaries.as_ref(), self.transfer.as_ref())
    }

    /// Returns the metadata of a file that names the program which wrote it.
    pub(crate) fn by(software: Option<String>) -> Self {
        let origin = software.as_deref().and_then(origin_of);
        // A zero ends a name for other programs.
        let software = software.and_then(|name| Some(name.split('\0').next()?.to_owned()));
        Self { software, origin, ..Self::default() }
    }

    /// Returns the name of the program to write, with how it made the picture.
    pub(crate) fn software_to_write(&self) -> Cow<'static, str> {
        let origin = self.origin.as_deref().filter(|words| is_origin(words));
        origin.map_or(SOFTWARE.into(), |words| format!("{SOFTWARE} ({words})").into())
    }

    /// Returns whether the pixels are those of sRGB.
    pub(crate) fn is_srgb(&self) -> bool {
        let is_usual = self.primaries.is_none_or(|primaries| primaries.is_same(&Primaries::REC709));
        self.icc.is_none() && is_usual && *self.transfer.as_ref().unwrap_or(&Transfer::Srgb) == Transfer::Srgb
    }

    /// Returns the XMP packet to write for a picture of this size: the input's, with the picture's place in a panorama.
    pub(crate) fn packet_to_write(&self, size: (usize, usize)) -> Option<String> {
        self.carried.packet_to_write(self.panorama.map(|window| gpano::description(window, size)))
    }

    /// Returns the ICC profile for a file that can describe its colours in no other way. Without one, sRGB is assumed of
    /// integers and linear Rec. 709 of floats; grey has no primaries.
    pub(crate) fn profile_to_write(&self, channels: Channels, depth: Depth) -> Option<Cow<'_, [u8]>> {
        if let Some(profile) = &self.icc {
            return Some(profile.into());
        }
        let is_colour = channels.is_colour();
        let primaries = self.primaries.filter(|_| is_colour).unwrap_or(Primaries::REC709);
        let usual = if depth.is_float() { Transfer::Linear } else { Transfer::Srgb };
        let transfer = self.transfer.as_ref().unwrap_or(&usual);
        if *transfer == usual && primaries.is_same(&Primaries::REC709) {
            return None;
        }
        let profile = if is_colour { icc::made(transfer, &primaries) } else { icc::made_grey(transfer) };
        profile.map(Into::into)
    }

    /// Notes that the file has an ICC profile which cannot be read at all.
    pub(crate) fn with_damaged_profile(self, reason: &str) -> Self {
        Self { profile_fault: Some(ProfileFault::Damaged(reason.to_owned())), ..self }
    }

    /// Adds an ICC profile and what it says.
    pub(crate) fn with_profile(self, profile: Option<Vec<u8>>) -> Self {
        let icc::Profile { transfer, primaries, fault } = profile.as_deref().map(icc::read).unwrap_or_default();
        Self { transfer, primaries, profile_fault: fault, icc: profile, ..self }
    }
}

/// An environment map: a picture of the whole world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnvMap {
    /// OpenEXR's equirectangular panorama, with samples on the edges.
    LatLong,
    /// OpenEXR's six faces one below the other: +X −X +Y −Y +Z −Z in a right-handed frame, with samples on the edges.
    Cube,
    /// Faces of a KTX or DDS file, one below the other: +X −X +Y −Y +Z −Z, left-handed, with +Z ahead, unless they are mirrored.
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
