//! XMP packets: properties that are not true of the output are cut out of the text, and the rest stays as it is.

use std::ops::Range;

use roxmltree::{Document, Node};

use crate::metadata::gpano;

/// Greatest size of a packet in bytes.
const LARGEST: usize = 1 << 20;

const RDF: &str = "http://www.w3.org/1999/02/22-rdf-syntax-ns#";
/// Namespace of the element around a packet's content.
const META: &str = "adobe:ns:meta/";
const TIFF: &str = "http://ns.adobe.com/tiff/1.0/";
const EXIF: &str = "http://ns.adobe.com/exif/1.0/";
const EXIF_EX: &str = "http://cipa.jp/exif/1.0/";
const XMP: &str = "http://ns.adobe.com/xap/1.0/";
const PHOTOSHOP: &str = "http://ns.adobe.com/photoshop/1.0/";

/// Properties that the writer sets itself or need not repeat: how pixels are stored, and what their colours are.
const REWRITTEN: [(&str, &[&str]); 5] = [
    (gpano::NAMESPACE, &[]),
    (
        TIFF,
        &[
            "ImageWidth",
            "ImageLength",
            "BitsPerSample",
            "Compression",
            "PhotometricInterpretation",
            "Orientation",
            "SamplesPerPixel",
            "PlanarConfiguration",
            "YCbCrSubSampling",
            "YCbCrPositioning",
            "YCbCrCoefficients",
            "TransferFunction",
            "WhitePoint",
            "PrimaryChromaticities",
            "ReferenceBlackWhite",
            "NativeDigest",
            "Software",
        ],
    ),
    (
        EXIF,
        &[
            "PixelXDimension",
            "PixelYDimension",
            "ColorSpace",
            "ComponentsConfiguration",
            "CompressedBitsPerPixel",
            "NativeDigest",
            "ExifImageWidth",
            "ExifImageHeight",
        ],
    ),
    (EXIF_EX, &["Gamma"]),
    (PHOTOSHOP, &["ICCProfile", "ColorMode"]),
];

/// Properties that are not true of another picture than the input. An empty list of names means the whole namespace.
const UNTRUE: [(&str, &[&str]); 22] = [
    (
        EXIF,
        &[
            "SubjectArea",
            "SubjectLocation",
            "FocalPlaneXResolution",
            "FocalPlaneYResolution",
            "FocalPlaneResolutionUnit",
            "FocalLengthIn35mmFilm",
            "DigitalZoomRatio",
            "GPSImgDirection",
            "GPSImgDirectionRef",
            "MakerNote",
            "SpatialFrequencyResponse",
            "CFAPattern",
        ],
    ),
    (XMP, &["Thumbnails", "ThumbnailURL"]),
    // Refers to the rest of a packet that is too large for a JPEG's segment, which is not read.
    ("http://ns.adobe.com/xmp/note/", &["HasExtendedXMP"]),
    // Crop and lens corrections by a raw developer, which the pixels already have.
    ("http://ns.adobe.com/camera-raw-settings/1.0/", &[]),
    // Faces of people in the picture, by their place.
    ("http://www.metadataworkinggroup.com/schemas/regions/", &[]),
    ("http://ns.microsoft.com/photo/1.2/", &[]),
    ("http://iptc.org/std/Iptc4xmpExt/2008-02-29/", &["ImageRegion"]),
    // Where a drone's camera looked.
    (
        "http://www.dji.com/drone-dji/1.0/",
        &[
            "GimbalYawDegree",
            "GimbalPitchDegree",
            "GimbalRollDegree",
            "FlightYawDegree",
            "FlightPitchDegree",
            "FlightRollDegree",
        ],
    ),
    ("http://pix4d.com/camera/1.0", &["Yaw", "Pitch", "Roll"]),
    ("http://pix4d.com/camera/1.0/", &["Yaw", "Pitch", "Roll"]),
    ("http://ns.microsoft.com/photo/1.2/t/RegionInfo#", &[]),
    // Pictures, depth, sound and films that lie in the file or behind the picture.
    ("http://ns.google.com/photos/1.0/camera/", &[]),
    ("http://ns.google.com/photos/1.0/container/", &[]),
    ("http://ns.google.com/photos/1.0/container/item/", &[]),
    ("http://ns.google.com/photos/1.0/image/", &[]),
    ("http://ns.google.com/photos/1.0/audio/", &[]),
    ("http://ns.google.com/photos/1.0/depthmap/", &[]),
    ("http://ns.google.com/photos/dd/1.0/device/", &[]),
    ("http://ns.google.com/videos/1.0/spherical/", &[]),
    ("http://ns.adobe.com/hdr-gain-map/1.0/", &[]),
    ("http://ns.apple.com/HDRGainMap/1.0/", &[]),
    ("http://ns.apple.com/pixeldatainfo/1.0/", &[]),
];

/// Returns the text between the padding that packets have.
fn text(packet: &[u8]) -> Option<&str> {
    let text = std::str::from_utf8(packet).ok()?;
    Some(text.trim_start_matches('\u{feff}').trim_matches(|c: char| c == '\0' || c.is_whitespace()))
}

/// Checks that bytes are an XMP packet; the error says why it is left out.
pub(super) fn check(packet: &[u8]) -> Result<String, String> {
    if packet.len() > LARGEST {
        return Err(format!("they have {} bytes, more than {LARGEST}", packet.len()));
    }
    let text = text(packet).ok_or("they are no UTF-8")?;
    let document = Document::parse(text).map_err(|error| error.to_string())?;
    rdf(&document).map(|_| text.to_owned()).ok_or_else(|| "they hold no rdf:RDF".to_owned())
}

fn rdf<'a>(document: &'a Document<'a>) -> Option<Node<'a, 'a>> {
    document.descendants().find(|node| node.has_tag_name((RDF, "RDF")))
}

/// A packet without properties that are not true of the output.
pub(super) struct Kept {
    /// The packet; `None` if nothing is left.
    pub(super) packet: Option<String>,
    /// Names of properties that were cut out.
    pub(super) untrue: Vec<String>,
}

/// Cuts out properties that are not true of the output.
pub(super) fn kept(packet: &str) -> Kept {
    let Ok(document) = Document::parse(packet) else { return Kept { packet: None, untrue: Vec::new() } };
    let mut cutter = Cutter::default();
    for node in document.descendants().filter(Node::is_element) {
        let (tag, range) = (node.tag_name(), node.range());
        // In the order of the text: an element that is cut out takes its content with it.
        if cutter.has_cut(&range) || cutter.judge(node, tag.namespace(), tag.name(), range) {
            continue;
        }
        for attribute in node.attributes() {
            cutter.judge(node, attribute.namespace(), attribute.name(), attribute.range());
        }
    }
    let Cutter { cuts, mut untrue, has_more } = cutter;
    untrue.sort();
    untrue.dedup();
    let mut rest = String::with_capacity(packet.len());
    let mut at = 0;
    for cut in cuts {
        rest.push_str(&packet[at..cut.start]);
        at = cut.end;
    }
    rest.push_str(&packet[at..]);
    Kept { packet: has_more.then_some(rest), untrue }
}

/// Finds the parts of a packet to cut out, from its beginning to its end.
#[derive(Default)]
struct Cutter {
    cuts: Vec<Range<usize>>,
    /// Names of properties that are not true of the output.
    untrue: Vec<String>,
    /// Whether a property is left.
    has_more: bool,
}

impl Cutter {
    /// Returns whether this part of the text has been cut out together with an element around it.
    fn has_cut(&self, range: &Range<usize>) -> bool {
        self.cuts.last().is_some_and(|cut| cut.end >= range.end)
    }

    /// Cuts a property out if it is on one of the lists; returns whether it was.
    fn judge(&mut self, node: Node<'_, '_>, namespace: Option<&str>, name: &str, range: Range<usize>) -> bool {
        let Some(namespace) = namespace else { return false };
        let is_among = |list: &[(&str, &[&str])]| {
            list.iter().any(|(space, names)| *space == namespace && (names.is_empty() || names.contains(&name)))
        };
        let is_untrue = is_among(&UNTRUE);
        if is_untrue {
            let prefix = node.lookup_prefix(namespace).map_or_else(String::new, |prefix| format!("{prefix}:"));
            self.untrue.push(format!("{prefix}{name}"));
        }
        if is_untrue || is_among(&REWRITTEN) {
            self.cuts.push(range);
            return true;
        }
        self.has_more |= ![RDF, META].contains(&namespace);
        false
    }
}

/// Adds a description to a packet, at the end of its list.
pub(super) fn with_description(packet: &str, description: &str) -> Option<String> {
    let document = Document::parse(packet).ok()?;
    let end = rdf(&document)?.range().end;
    // An element without content has no closing tag.
    let at = packet[..end].rfind("</")?;
    Some([&packet[..at], description, &packet[at..]].concat())
}

/// Returns the properties of a packet, each with its text.
pub(super) fn properties(packet: &str) -> Vec<(String, String)> {
    let Ok(document) = Document::parse(packet) else { return Vec::new() };
    let Some(rdf) = rdf(&document) else { return Vec::new() };
    let mut found = Vec::new();
    for description in rdf.children().filter(Node::is_element) {
        let mut tell = |namespace: Option<&str>, name: &str, text: String| {
            if let Some(namespace) = namespace.filter(|namespace| *namespace != RDF) {
                let prefix = description.lookup_prefix(namespace).unwrap_or("?");
                found.push((format!("{prefix}:{name}"), text.split_whitespace().collect::<Vec<_>>().join(" ")));
            }
        };
        for attribute in description.attributes() {
            tell(attribute.namespace(), attribute.name(), attribute.value().to_owned());
        }
        for node in description.children().filter(Node::is_element) {
            let text: Vec<&str> =
                node.descendants().filter(|node| node.is_text()).filter_map(|node| node.text()).collect();
            tell(node.tag_name().namespace(), node.tag_name().name(), text.join(" "));
        }
    }
    found
}
