//! Exif metadata, as a block: a TIFF file without a picture.

mod plausible;
mod rules;
mod value;

use std::io::Cursor;

use ::exif::experimental::Writer;
use ::exif::{Context, Error, Field, In, Reader, Tag, Value};

use crate::Metadata;
use rules::Fate;
pub(crate) use value::{of_stored, stored};

/// Greatest size of a block in bytes. Previews and a camera maker's notes are the largest part of most.
pub(crate) const LARGEST: usize = 1 << 20;

/// Exif metadata of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Exif {
    /// The block. It has been read without an error.
    block: Vec<u8>,
}

impl Exif {
    /// Checks that a block can be read; the error says why it is left out.
    pub(crate) fn of_block(block: &[u8]) -> Result<Self, String> {
        if block.len() > LARGEST {
            return Err(format!("they have {} bytes, more than {LARGEST}", block.len()));
        }
        read(block)?;
        Ok(Self { block: block.to_vec() })
    }

    /// Makes a block of fields; `None` if there are none that can be written.
    pub(crate) fn of_fields(fields: &[Field]) -> Option<Self> {
        let mut writer = Writer::new();
        let mut known: Vec<Tag> = Vec::new();
        for field in fields {
            let is_first = !known.contains(&field.tag);
            if is_first && field.ifd_num == In::PRIMARY && !matches!(field.value, Value::Unknown(..)) {
                known.push(field.tag);
                writer.push_field(field);
            }
        }
        if known.is_empty() {
            return None;
        }
        let mut block = Cursor::new(Vec::new());
        writer.write(&mut block, false).ok()?;
        Some(Self { block: block.into_inner() })
    }

    /// Returns the fields of the picture itself and of its preview.
    fn fields(&self) -> Vec<Field> {
        read(&self.block).unwrap_or_default()
    }

    /// Returns the name and the value of each field, as people read them.
    pub fn told(&self) -> Vec<(String, String)> {
        let own = self.fields().into_iter().filter(|field| field.ifd_num == In::PRIMARY);
        let value = |field: &Field| {
            // A long value, such as a maker's notes, is not for people to read.
            if value::bytes(&field.value) > 1024 && !matches!(field.value, Value::Ascii(_)) {
                return format!("{} bytes", value::bytes(&field.value));
            }
            let told: String = field.display_value().with_unit(()).to_string().chars().take(1024).collect();
            told.trim_matches('"').to_owned()
        };
        own.map(|field| (name(field.tag), value(&field))).collect()
    }

    /// Returns the orientation, 2 to 8, by which viewers are asked to turn or mirror the picture.
    pub(crate) fn orientation(&self) -> Option<u16> {
        let field =
            self.fields().into_iter().find(|field| field.tag == Tag::Orientation && field.ifd_num == In::PRIMARY)?;
        field.value.get_uint(0).and_then(|number| u16::try_from(number).ok()).filter(|number| (2..=8).contains(number))
    }

    /// Returns the name of the program that wrote the file.
    pub(crate) fn software(&self) -> Option<String> {
        let own = |field: &Field| field.tag == Tag::Software && field.ifd_num == In::PRIMARY;
        let field = self.fields().into_iter().find(own)?;
        let Value::Ascii(texts) = field.value else { return None };
        // With all that is behind a zero, which may be a damaged letter.
        (!texts.is_empty()).then(|| String::from_utf8_lossy(&texts.join(&0)).trim_end_matches('\0').to_owned())
    }

    /// Returns whether the fields say that a camera was set to Adobe RGB, as files without a profile do (DCF 2.0, CIPA
    /// DC-009-2010): no space of Exif's own, and R03.
    pub(crate) fn is_adobe_rgb(&self) -> bool {
        let fields = self.fields();
        let value =
            |tag: Tag| Some(&fields.iter().find(|field| field.tag == tag && field.ifd_num == In::PRIMARY)?.value);
        let is_r03 = |value: &Value| matches!(value, Value::Ascii(texts) if texts.iter().any(|text| text == b"R03"));
        value(Tag::ColorSpace).is_some_and(|space| space.get_uint(0) == Some(0xffff))
            && value(Tag::InteroperabilityIndex).is_some_and(is_r03)
    }

    /// Returns whether a field names the picture's author or owner.
    pub(super) fn says_whose(&self) -> bool {
        self.fields().iter().any(|field| [Tag::Artist, Tag::Copyright].contains(&field.tag))
    }

    /// Returns the block without the fields that the writer sets itself or that are not true of the output, and the
    /// names of the latter.
    pub(super) fn kept(&self) -> (Option<Self>, Vec<String>) {
        let (mut kept, mut untrue) = (Vec::new(), Vec::new());
        for field in self.fields() {
            if field.ifd_num != In::PRIMARY {
                untrue.push("thumbnail".to_owned());
                continue;
            }
            match rules::fate_of(&field) {
                Fate::Kept => kept.push(field),
                Fate::Rewritten => {}
                Fate::Untrue => untrue.push(name(field.tag)),
            }
        }
        untrue.sort();
        untrue.dedup();
        (Self::of_fields(&kept), untrue)
    }

    /// Makes metadata without a field.
    pub(crate) fn empty() -> Self {
        Self { block: Vec::new() }
    }

    /// Returns the fields to write for a picture of this size.
    pub(crate) fn to_write(&self, (width, height): (usize, usize), metadata: &Metadata) -> Vec<Field> {
        let mut fields = self.fields();
        let mut add = |tag: Tag, value: Value| fields.push(Field { tag, ifd_num: In::PRIMARY, value });
        for (tag, pixels) in [(Tag::PixelXDimension, width), (Tag::PixelYDimension, height)] {
            if let Ok(pixels) = u32::try_from(pixels) {
                add(tag, Value::Long(vec![pixels]));
            }
        }
        // Any other space is "uncalibrated"; tags of colours describe it.
        add(Tag::ColorSpace, Value::Short(vec![if metadata.is_srgb() { 1 } else { 0xffff }]));
        add(Tag::Software, Value::Ascii(vec![metadata.software_to_write().into_owned().into()]));
        fields
    }

    /// Returns the block to write for a picture of this size.
    pub(crate) fn block_to_write(&self, size: (usize, usize), metadata: &Metadata) -> Option<Vec<u8>> {
        Self::of_fields(&self.to_write(size, metadata)).map(|exif| exif.block)
    }

    /// Returns the size of the block in bytes.
    pub(super) fn len(&self) -> usize {
        self.block.len()
    }
}

/// Returns whether a field is read: all are, except those that the writer sets itself.
pub(crate) fn is_read(tag: Tag) -> bool {
    rules::fate(tag) != Fate::Rewritten
}

/// Returns a field's name; its number where it is not known.
fn name(tag: Tag) -> String {
    let Tag(context, number) = tag;
    let name = tag.to_string();
    if !name.starts_with("Tag(") {
        return name;
    }
    let place = match context {
        Context::Exif => "Exif ",
        Context::Gps => "GPS ",
        _ => "",
    };
    format!("{place}tag {number}")
}

/// Reads the fields of a block. Those that are damaged are left out if others are whole.
fn read(block: &[u8]) -> Result<Vec<Field>, String> {
    plausible::check(block)?;
    let read = Reader::new().continue_on_error(true).read_raw(block.to_vec());
    let exif = read.or_else(|error: Error| error.distill_partial_result(|_| {})).map_err(|error| error.to_string())?;
    let mut fields = Vec::new();
    let mut total = 0;
    // Values are read one by one, since several may share the same bytes.
    for field in exif.fields() {
        total += value::bytes(&field.value);
        if total > 2 * block.len() {
            return Err("its values overlap".to_owned());
        }
        fields.push(field.clone());
    }
    if fields.is_empty() { Err("no field can be read".to_owned()) } else { Ok(fields) }
}
