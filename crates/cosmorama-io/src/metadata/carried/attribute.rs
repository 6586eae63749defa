//! Attributes of OpenEXR files, as they are stored.

/// Greatest size of one attribute in bytes. Manifests of Cryptomatte, the largest in use, have a few megabytes.
pub(crate) const LARGEST: usize = 16 << 20;

/// Attributes that the writer sets itself: how pixels are stored, and what their colours are.
const REWRITTEN: [&str; 23] = [
    "channels",
    "chromaticities",
    "chunkCount",
    "colorInteropID",
    "compression",
    "dataWindow",
    "deepImageState",
    "displayWindow",
    "dwaCompressionLevel",
    "lineOrder",
    "maxSamplesPerPixel",
    "name",
    "oiio:ColorSpace",
    "pixelAspectRatio",
    "screenWindowCenter",
    "screenWindowWidth",
    "software",
    "Software",
    "tiles",
    "type",
    "version",
    "whiteLuminance",
    "oiio:subimages",
];

/// Prefix of OpenImageIO's attributes about how the file that it read was stored, such as its number of chunks.
const STORED: &str = "openexr:";

/// Attributes that are not true of the output, which is another picture: projection, field of view, pixels.
const UNTRUE: [&str; 35] = [
    "cameraAperture",
    "cameraFarClip",
    "cameraFarClipPlane",
    "cameraFov",
    "cameraNearClip",
    "cameraNearClipPlane",
    "cameraProjection",
    "cameraTargetDistance",
    "cameraTransform",
    "envmap",
    "far",
    "fieldOfViewHorizontal",
    "fieldOfViewVertical",
    "fovcot",
    "multiView",
    "near",
    "Nl",
    "NP",
    "oiio:AverageColor",
    "oiio:ConstantColor",
    "oiio:SHA-1",
    "Orientation",
    "originalDataWindow",
    "perspective:fov",
    "pinholeFocalLength",
    "preview",
    "screenWindow",
    "sensorAcquisitionRectangle",
    "textureformat",
    "view",
    "worldToCamera",
    "worldtocamera",
    "worldToNDC",
    "worldtoscreen",
    "wrapmodes",
];

/// Usual values of windows and pixels. The loss of any other value is reported.
const USUAL: [(&str, &[f32]); 3] =
    [("pixelAspectRatio", &[1.0]), ("screenWindowCenter", &[0.0, 0.0]), ("screenWindowWidth", &[1.0])];

/// An attribute of an OpenEXR file.
#[derive(Clone, Debug, PartialEq)]
pub struct Attribute {
    /// Name of the attribute.
    pub name: String,
    /// Name of the value's type, such as `string` or `v2f`.
    pub kind: String,
    /// Value as the file has it, in little-endian order.
    pub bytes: Vec<u8>,
}

/// Treatment of an attribute for another file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fate {
    /// The output takes it over.
    Kept,
    /// It says how a file is stored, which the writer sets itself.
    Rewritten,
    /// It is not true of the output.
    Untrue,
}

impl Attribute {
    /// Returns the value as people read it; large and unknown ones by their size.
    pub fn value(&self) -> String {
        let numbers = |width: usize, number: &dyn Fn(&[u8]) -> String| {
            let all: Vec<String> = self.bytes.chunks_exact(width).take(16).map(number).collect();
            all.join(" ")
        };
        let float = |bytes: &[u8]| word(bytes).map_or_else(String::new, |word| f32::from_bits(word).to_string());
        let integer = |bytes: &[u8]| word(bytes).map_or_else(String::new, |word| word.cast_signed().to_string());
        match (&*self.kind, self.bytes.len()) {
            ("string", _) => text(&self.bytes).chars().take(1024).collect(),
            ("int" | "v2i" | "v3i" | "box2i", 4..=16) => numbers(4, &integer),
            ("float" | "v2f" | "v3f" | "m33f" | "m44f" | "box2f" | "chromaticities", 4..=64) => numbers(4, &float),
            ("double", 8) => <[u8; 8]>::try_from(&*self.bytes).map(f64::from_le_bytes).unwrap_or_default().to_string(),
            ("rational", 8) => numbers(4, &integer).replace(' ', "/"),
            ("timecode", 8) => word(&self.bytes).map(time_code).unwrap_or_default(),
            (kind, length) => format!("{kind}, {length} bytes"),
        }
    }

    /// Returns whether the attribute describes how pixels are stored or what their colours are, which `info` reports
    /// elsewhere.
    pub fn is_storage(&self) -> bool {
        self.fate() == Fate::Rewritten
    }

    /// Returns the treatment of the attribute for another file.
    pub(super) fn fate(&self) -> Fate {
        let is_named = |names: &[&str]| names.contains(&&*self.name);
        match () {
            () if is_named(&UNTRUE) => Fate::Untrue,
            () if is_named(&REWRITTEN) || self.name.starts_with(STORED) => Fate::Rewritten,
            () => Fate::Kept,
        }
    }

    /// Returns whether a value is lost although the writer sets the attribute: a special window, or pixels that are not
    /// square.
    pub(super) fn is_lost(&self, all: &[Self]) -> bool {
        if self.name == "dataWindow" {
            let display = all.iter().find(|other| other.name == "displayWindow");
            return display.is_some_and(|display| display.bytes != self.bytes);
        }
        let usual = USUAL.iter().find(|(name, _)| *name == self.name);
        usual.is_some_and(|(_, numbers)| {
            let found = self.bytes.chunks_exact(4).map(|bytes| word(bytes).map(f32::from_bits));
            !found.eq(numbers.iter().copied().map(Some))
        })
    }
}

/// Reads a text: UTF-8 as programs write it today, else Latin letters of 8 bits.
fn text(bytes: &[u8]) -> String {
    std::str::from_utf8(bytes).map_or_else(|_| bytes.iter().map(|byte| char::from(*byte)).collect(), str::to_owned)
}

/// Reads four bytes.
fn word(bytes: &[u8]) -> Option<u32> {
    Some(u32::from_le_bytes(*bytes.first_chunk()?))
}

/// Returns hours, minutes, seconds and frames of a time code, which are packed as decimal digits (SMPTE 12M).
fn time_code(packed: u32) -> String {
    let pair = |at: u32, tens: u32| 10 * (packed >> (at + 4) & tens) + (packed >> at & 0xf);
    format!("{:02}:{:02}:{:02}:{:02}", pair(24, 3), pair(16, 7), pair(8, 7), pair(0, 3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn how_another_file_was_stored_is_not_carried_along() {
        let fate =
            |name: &str| Attribute { name: name.to_owned(), kind: "int".to_owned(), bytes: vec![64, 0, 0, 0] }.fate();
        assert_eq!(["chunkCount", "openexr:chunkCount", "openexr:levelmode"].map(fate), [Fate::Rewritten; 3]);
        assert_eq!(["isoSpeed", "chunkCounter"].map(fate), [Fate::Kept; 2]);
    }

    #[test]
    fn values_are_told_as_people_read_them() {
        let told = |kind: &str, bytes: &[u8]| {
            Attribute { name: "x".to_owned(), kind: kind.to_owned(), bytes: bytes.to_vec() }.value()
        };
        assert_eq!(told("string", b"Studio \xe9"), "Studio é");
        assert_eq!(told("string", "Jürgen".as_bytes()), "Jürgen");
        assert_eq!(told("rational", &[24, 0, 0, 0, 1, 0, 0, 0]), "24/1");
        assert_eq!(told("v2f", &[1.5_f32.to_le_bytes(), (-2.0_f32).to_le_bytes()].concat()), "1.5 -2");
        // OpenEXR's own reading of this word: hours 1, minutes 23, seconds 45, frame 12.
        assert_eq!(told("timecode", &[0x12, 0x45, 0x23, 0x01, 0, 0, 0, 0]), "01:23:45:12");
        assert_eq!(told("int", &[255; 4]), "-1");
        assert_eq!(told("int", &[255; 3]), "int, 3 bytes");
        assert_eq!(told("nuke", &[0; 77]), "nuke, 77 bytes");
    }
}
