//! Metadata of a file other than those of its pixels and colours, and which of them other files take over.

mod attribute;
mod exif;
pub(crate) mod iptc;
mod text;
mod xmp;

pub use attribute::Attribute;
pub use exif::Exif;
pub use text::TextChunk;

pub(crate) use attribute::LARGEST as LARGEST_ATTRIBUTE;
pub(crate) use exif::{LARGEST as LARGEST_EXIF, is_read, of_stored, stored};
pub(crate) use text::XMP;

use attribute::Fate;

/// Metadata of a file other than those of its pixels and colours.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Carried {
    /// Attributes of an OpenEXR file.
    pub attributes: Vec<Attribute>,
    /// Texts of a PNG.
    pub texts: Vec<TextChunk>,
    /// Exif metadata of a PNG, JPEG or TIFF.
    pub exif: Option<Exif>,
    /// XMP packet of a PNG, JPEG or TIFF.
    pub(crate) xmp: Option<String>,
    /// Kinds of metadata that are never carried, such as IPTC and comments of JPEG.
    pub unread: Vec<&'static str>,
}

/// Makes the metadata of an OpenEXR file.
impl From<Vec<Attribute>> for Carried {
    fn from(attributes: Vec<Attribute>) -> Self {
        Self { attributes, ..Self::default() }
    }
}

/// Metadata that a file takes over, and names of those that it does not.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Kept {
    /// Metadata that the file takes over.
    pub carried: Carried,
    /// Names of metadata that are not true of the output.
    pub untrue: Vec<String>,
    /// Kinds of metadata that the format cannot hold, with some of their names.
    pub lost: Vec<String>,
    /// Kinds that go along to no format.
    pub unread: Vec<&'static str>,
    /// Whether some of the lost metadata name the picture's author or owner.
    pub loses_owner: bool,
}

/// Names of metadata that name a picture's author or owner: OpenEXR's, PNG's and XMP's.
const OWNERS: [&str; 7] =
    ["owner", "Author", "Copyright", "dc:creator", "dc:rights", "photoshop:Credit", "xmpRights:Owner"];

/// Bytes that a description of our own may add to an XMP packet.
const DESCRIPTION: usize = 1024;

/// Metadata that a file format can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MetadataRoom {
    /// Whether the format has attributes of any name and type.
    pub attributes: bool,
    /// Whether the format has texts of any keyword.
    pub texts: bool,
    /// Greatest number of bytes of an Exif block, and of an XMP packet; `None` if the format has neither.
    pub exif: Option<usize>,
}

impl Carried {
    /// Returns the properties of the XMP packet, each with its text.
    pub fn xmp(&self) -> Vec<(String, String)> {
        self.xmp.as_deref().map(xmp::properties).unwrap_or_default()
    }

    /// Takes an XMP packet over; the error says why it is left out.
    pub(crate) fn add_xmp(&mut self, packet: &[u8]) -> Result<(), String> {
        self.xmp = Some(xmp::check(packet)?);
        Ok(())
    }

    /// Takes an Exif block over; the error says why it is left out.
    pub(crate) fn add_exif(&mut self, block: &[u8]) -> Result<(), String> {
        self.exif = Some(Exif::of_block(block)?);
        Ok(())
    }

    /// Returns the metadata that a file with this room takes over. Its picture is another one than the input's.
    pub fn kept(&self, room: MetadataRoom) -> Kept {
        let mut kept = Kept::default();
        self.keep_attributes(room, &mut kept);
        self.keep_texts(room, &mut kept);
        self.keep_exif(room, &mut kept);
        self.keep_xmp(room, &mut kept);
        kept.unread.clone_from(&self.unread);
        kept.loses_owner |= self.unread.contains(&iptc::OF_OWNER);
        kept
    }

    fn keep_attributes(&self, room: MetadataRoom, kept: &mut Kept) {
        let mut names = Vec::new();
        for attribute in &self.attributes {
            match attribute.fate() {
                Fate::Kept if room.attributes => kept.carried.attributes.push(attribute.clone()),
                Fate::Kept => names.push(attribute.name.clone()),
                Fate::Untrue => kept.untrue.push(attribute.name.clone()),
                Fate::Rewritten if attribute.is_lost(&self.attributes) => kept.untrue.push(attribute.name.clone()),
                Fate::Rewritten => {}
            }
        }
        kept.lose("OpenEXR attributes", &names);
    }

    fn keep_texts(&self, room: MetadataRoom, kept: &mut Kept) {
        let mut names = Vec::new();
        for text in self.texts.iter().filter(|text| !text.is_rewritten()) {
            match () {
                () if text.is_untrue() => kept.untrue.push(text.keyword()),
                () if room.texts => kept.carried.texts.push(text.clone()),
                () => names.push(text.keyword()),
            }
        }
        kept.lose("PNG text", &names);
    }

    fn keep_exif(&self, room: MetadataRoom, kept: &mut Kept) {
        let Some(exif) = &self.exif else { return };
        let (rest, untrue) = exif.kept();
        kept.untrue.extend(untrue);
        let Some(rest) = rest else { return };
        if room.exif.is_some_and(|most| rest.len() <= most) {
            kept.carried.exif = Some(rest);
            return;
        }
        kept.loses_owner |= rest.says_whose();
        let names: Vec<String> = rest.told().into_iter().map(|(name, _)| name).collect();
        kept.lose("Exif", &names);
    }

    fn keep_xmp(&self, room: MetadataRoom, kept: &mut Kept) {
        let Some(packet) = &self.xmp else { return };
        let rest = xmp::kept(packet);
        kept.untrue.extend(rest.untrue);
        let Some(rest) = rest.packet else { return };
        if room.exif.is_some_and(|most| rest.len() <= most - DESCRIPTION) {
            kept.carried.xmp = Some(rest);
            return;
        }
        let names: Vec<String> = xmp::properties(&rest).into_iter().map(|(name, _)| name).collect();
        kept.lose("XMP", &names);
    }

    /// Returns the XMP packet to write, with this description added; `None` if there is neither.
    pub(crate) fn packet_to_write(&self, description: Option<String>) -> Option<String> {
        let packet = self.xmp.clone();
        match (packet, description) {
            (Some(packet), Some(description)) => {
                Some(xmp::with_description(&packet, &description).unwrap_or_else(|| super::gpano::around(&description)))
            }
            (Some(packet), None) => Some(packet),
            (None, description) => description.map(|description| super::gpano::around(&description)),
        }
    }
}

impl Kept {
    /// Records metadata that a format cannot hold.
    fn lose(&mut self, kind: &str, names: &[String]) {
        self.loses_owner |= names.iter().any(|name| OWNERS.contains(&&**name));
        match names {
            [] => {}
            [.., _] if names.len() <= 4 => self.lost.push(format!("{kind} ({})", names.join(", "))),
            _ => self.lost.push(format!("{kind} ({} and {} more)", names[..3].join(", "), names.len() - 3)),
        }
    }
}
