//! Exif metadata and XMP among the tags of a TIFF.

use std::io::{Read, Seek, Write};

use exif::{Context, Field, In, Tag as ExifTag};
use tiff::decoder::{Decoder, IfdDecoder};
use tiff::encoder::{DirectoryEncoder, TiffEncoder, TiffKind};
use tiff::tags::{ByteOrder, IfdPointer, Tag, Type, ValueBuffer};
use tiff::{Directory, TiffError};

use crate::metadata::{LARGEST_EXIF, iptc, is_read, of_stored, stored};
use crate::{Carried, Exif, Metadata};

const XMP: Tag = Tag::Unknown(700);
/// Tags of kinds that are not carried.
const UNREAD: [(Tag, &str); 1] = [(Tag::Unknown(34377), "Photoshop's image resources")];
const IPTC: Tag = Tag::Unknown(33723);

/// Byte order of this machine.
const NATIVE: ByteOrder = if cfg!(target_endian = "little") { ByteOrder::LittleEndian } else { ByteOrder::BigEndian };

/// Content of the tags, and complaints about content that is left out.
#[derive(Default)]
pub(super) struct Found {
    pub(super) carried: Carried,
    pub(super) complaints: Vec<String>,
    /// Name of the program that wrote the file; damaged letters are replaced.
    pub(super) software: Option<String>,
    /// Number of values that have been read.
    count: u64,
}

/// Reads the tags.
pub(super) fn read<R: Read + Seek>(decoder: &mut Decoder<R>) -> Found {
    let mut found = Found::default();
    let mut fields = Vec::new();
    let mut own = decoder.image_ifd();
    // First, since all values share a limit.
    let software = found.bytes(&mut own, Tag::Software).filter(|(kind, _)| *kind == Type::ASCII.to_u16());
    found.software = software.map(|(_, name)| String::from_utf8_lossy(&name).trim_end_matches('\0').to_owned());
    found.fields(&mut own, Context::Tiff, &mut fields);
    if let Some((_, packet)) = found.bytes(&mut own, XMP) {
        let added = found.carried.add_xmp(&packet);
        found.complaints.extend(added.err().map(|reason| format!("its XMP metadata are left out: {reason}")));
    }
    let names = UNREAD.iter().filter(|(tag, _)| own.directory().contains(*tag)).map(|(_, name)| *name);
    found.carried.unread.extend(names);
    for (pointer, context) in [(Tag::ExifDirectory, Context::Exif), (Tag::GpsDirectory, Context::Gps)] {
        // As a number: in a BigTIFF it need not be of the type of places.
        let place = decoder.get_tag(pointer).ok().and_then(|value| value.into_u64().ok()).map(IfdPointer);
        if let Some(directory) = place.and_then(|place| decoder.read_directory(place).ok()) {
            found.fields(&mut decoder.read_directory_tags(&directory), context, &mut fields);
        }
    }
    found.carried.exif = Exif::of_fields(&fields);
    // Last, since all values share a limit: of a larger block, only that it is there is told.
    let mut own = decoder.image_ifd();
    if own.directory().contains(IPTC) {
        let block = found.bytes(&mut own, IPTC);
        found.carried.unread.push(block.map_or("IPTC", |(_, block)| iptc::kind(&block)));
    }
    found
}

impl Found {
    /// Reads the fields of a directory.
    fn fields(&mut self, from: &mut IfdDecoder<'_>, context: Context, into: &mut Vec<Field>) {
        let tags: Vec<Tag> = from.directory().iter().map(|(tag, _)| tag).collect();
        for tag in tags {
            let known = ExifTag(context, tag.to_u16());
            if !is_read(known) {
                continue;
            }
            let value = self.bytes(from, tag).and_then(|(kind, bytes)| of_stored(kind, &bytes));
            into.extend(value.map(|value| Field { tag: known, ifd_num: In::PRIMARY, value }));
        }
    }

    /// Reads the number of a tag's type and its bytes, in this machine's order.
    fn bytes(&mut self, from: &mut IfdDecoder<'_>, tag: Tag) -> Option<(u16, Vec<u8>)> {
        let entry = from.find_entry(tag)?;
        let number = tag.to_u16();
        let count = entry.count();
        // The limit is for all values together, since values of several tags may share the same bytes.
        self.count = self.count.saturating_add(count);
        if self.count > LARGEST_EXIF as u64 {
            self.count = self.count.saturating_sub(count);
            self.complaints.push(format!(
                "its tag {number} of {count} values is left out: with others these are more than {LARGEST_EXIF}; remove it"
            ));
            return None;
        }
        let mut value = ValueBuffer::empty(Type::BYTE);
        from.find_tag_buf(tag, &mut value).ok()??;
        value.set_byte_order(NATIVE);
        Some((value.data_type().to_u16(), value.as_bytes().to_vec()))
    }
}

/// Places of the directories that a TIFF's own refers to.
#[derive(Default)]
pub(super) struct Places(Vec<(Tag, IfdPointer)>);

/// Writes the directories of Exif and GPS.
pub(super) fn write_directories<W: Write + Seek, K: TiffKind>(
    encoder: &mut TiffEncoder<W, K>,
    fields: &[Field],
) -> Result<Places, TiffError> {
    let mut places = Places::default();
    for (pointer, context) in [(Tag::ExifDirectory, Context::Exif), (Tag::GpsDirectory, Context::Gps)] {
        let of_context = |field: &&Field| field.tag.0 == context;
        if !fields.iter().any(|field| of_context(&field)) {
            continue;
        }
        let mut directory = encoder.extra_directory()?;
        fields.iter().filter(of_context).try_for_each(|field| write_field(&mut directory, field))?;
        align(&mut directory)?;
        places.0.push((pointer, directory.finish_with_offsets()?.pointer));
    }
    Ok(places)
}

/// Writes the tags of a TIFF's own directory.
pub(super) fn write_tags<W: Write + Seek, K: TiffKind>(
    tags: &mut DirectoryEncoder<'_, W, K>,
    metadata: &Metadata,
    (fields, places): (&[Field], &Places),
    size: (usize, usize),
) -> Result<(), TiffError> {
    let own = fields.iter().filter(|field| field.tag.0 == Context::Tiff);
    own.into_iter().try_for_each(|field| write_field(tags, field))?;
    places.0.iter().try_for_each(|(pointer, place)| tags.write_tag(*pointer, K::convert_offset(place.0)?))?;
    // The input's own description stays.
    let has_description =
        fields.iter().any(|field| (field.tag.0, field.tag.1) == (Context::Tiff, Tag::ImageDescription.to_u16()));
    let remarks: Vec<String> =
        metadata.remarks.iter().map(|remark| format!("{}: {}", remark.name, remark.text)).collect();
    if !has_description && !remarks.is_empty() {
        align(tags)?;
        tags.write_tag(Tag::ImageDescription, remarks.join("; ").as_str())?;
    }
    let packet = metadata.packet_to_write(size);
    packet.map_or(Ok(()), |packet| write_bytes(tags, XMP, Type::BYTE, packet.as_bytes()))
}

/// Has what is written next begin at an even place, as the TIFF specification (6.0, section 2) asks of directories and values.
pub(super) fn align<W: Write + Seek, K: TiffKind>(directory: &mut DirectoryEncoder<'_, W, K>) -> Result<(), TiffError> {
    let place = directory.write_data(&[0u8; 0][..])?;
    if place % 2 == 1 {
        directory.write_data(&[0u8][..])?;
    }
    Ok(())
}

fn write_field<W: Write + Seek, K: TiffKind>(
    directory: &mut DirectoryEncoder<'_, W, K>,
    field: &Field,
) -> Result<(), TiffError> {
    let Some((kind, bytes)) = stored(&field.value) else { return Ok(()) };
    let Some(kind) = Type::from_u16(kind) else { return Ok(()) };
    write_bytes(directory, Tag::from_u16_exhaustive(field.tag.1), kind, &bytes)
}

/// Writes a tag of bytes that are values of this kind.
pub(super) fn write_bytes<W: Write + Seek, K: TiffKind>(
    directory: &mut DirectoryEncoder<'_, W, K>,
    tag: Tag,
    kind: Type,
    bytes: &[u8],
) -> Result<(), TiffError> {
    align(directory)?;
    let entry = directory.write_entry_bytes(kind, bytes)?;
    let mut one = Directory::empty();
    one.extend([(tag, entry)]);
    directory.extend_from(&one);
    Ok(())
}
