//! Attributes of a header: read as they are stored, and written.

use std::io::{self, Read};
use std::path::Path;

use exr::meta::attribute::{AttributeValue, EnvironmentMap, Text};
use exr::meta::header::LayerAttributes;

use super::colour;
use super::reader::MARK;
use crate::codec::interface::Source;
use crate::metadata::{Attribute, LARGEST_ATTRIBUTE};
use crate::{Carried, EnvMap, Format, IoError, Metadata};

/// Greatest number of bytes of a name, by the format.
const LONGEST_NAME: u64 = 255;
/// Greatest number of bytes of all attributes of a file.
const LARGEST_HEADER: usize = 4 * LARGEST_ATTRIBUTE;

/// Reads the attributes of each part. A damaged header is left for the decoder to refuse. A header that is too large is
/// refused here, before it is read.
pub(super) fn read(path: &Path, source: Source<'_>) -> Result<Vec<Vec<Attribute>>, IoError> {
    let mut scan = Scan { path, source, total: 0 };
    let mut parts = Vec::new();
    let start = scan.bytes(8).map_err(|error| IoError::open(path, error))?;
    let is_several = start.get(5).is_some_and(|flags| flags & 0x10 != 0);
    if start.starts_with(&MARK) {
        while let Some(attributes) = scan.part()? {
            let is_end = attributes.is_empty();
            parts.push(attributes);
            if is_end || !is_several {
                break;
            }
        }
    }
    source.rewind().map_err(|error| IoError::open(path, error))?;
    Ok(parts)
}

struct Scan<'a> {
    path: &'a Path,
    source: Source<'a>,
    total: usize,
}

impl Scan<'_> {
    /// Reads the attributes of a part; `None` where the file ends too early.
    fn part(&mut self) -> Result<Option<Vec<Attribute>>, IoError> {
        let mut attributes = Vec::new();
        loop {
            match self.attribute()? {
                Next::Attribute(attribute) => attributes.push(attribute),
                Next::End => return Ok(Some(attributes)),
                Next::Damage => return Ok(None),
            }
        }
    }

    fn attribute(&mut self) -> Result<Next, IoError> {
        let fail = |error| IoError::open(self.path, error);
        let Some(name) = name(self.source).map_err(fail)? else { return Ok(Next::Damage) };
        if name.is_empty() {
            return Ok(Next::End);
        }
        let Some(kind) = self::name(self.source).map_err(fail)? else { return Ok(Next::Damage) };
        let size = self.bytes(4).map_err(fail)?;
        let size = size.first_chunk().map(|size| u32::from_le_bytes(*size)).and_then(|size| i32::try_from(size).ok());
        let Some(size) = size.and_then(|size| usize::try_from(size).ok()) else { return Ok(Next::Damage) };
        self.total = self.total.saturating_add(size);
        if size > LARGEST_ATTRIBUTE || self.total > LARGEST_HEADER {
            let found = format!("an attribute {name} of {size} bytes, {} with those before it", self.total);
            return Err(IoError::unsupported(
                self.path,
                Format::Exr,
                found,
                "at most 16 MiB in each, and 64 MiB in all",
            ));
        }
        let bytes = self.bytes(size).map_err(fail)?;
        Ok(if bytes.len() == size { Next::Attribute(Attribute { name, kind, bytes }) } else { Next::Damage })
    }

    /// Reads so many bytes, or as many as there are.
    fn bytes(&mut self, count: usize) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        (&mut *self.source).take(count as u64).read_to_end(&mut bytes)?;
        Ok(bytes)
    }
}

/// Next thing in a header.
enum Next {
    Attribute(Attribute),
    End,
    Damage,
}

/// Reads a name, of Latin letters of 8 bits; `None` where it does not end.
fn name(source: Source<'_>) -> io::Result<Option<String>> {
    let mut name = Vec::new();
    io::BufRead::read_until(&mut source.take(LONGEST_NAME + 1), 0, &mut name)?;
    Ok((name.pop() == Some(0)).then(|| name.into_iter().map(char::from).collect()))
}

/// Returns the attributes to write: our own, those carried along, and remarks.
pub(super) fn written(metadata: &Metadata) -> LayerAttributes {
    let remarks = metadata.remarks.iter();
    let remarks = remarks.map(|remark| (Text::from(remark.name), AttributeValue::Text(Text::from(&*remark.text))));
    let other = colour::interop_id(metadata).into_iter().chain(stored(&metadata.carried)).chain(remarks);
    LayerAttributes {
        environment_map: metadata.envmap.and_then(|kind| match kind {
            EnvMap::LatLong => Some(EnvironmentMap::LatitudeLongitude),
            EnvMap::Cube => Some(EnvironmentMap::Cube),
            EnvMap::GlCube => None,
        }),
        software_name: Some(Text::from(&*metadata.software_to_write())),
        white_luminance: metadata.white_luminance,
        other: other.collect(),
        ..LayerAttributes::default()
    }
}

/// Returns the attributes carried along, byte by byte. The encoder's own fields for standard attributes would change some: exr
/// 1.74 leaves a number of `keyCode` out, and refuses time codes of more than 30 frames a second.
fn stored(carried: &Carried) -> impl Iterator<Item = (Text, AttributeValue)> {
    let kept = carried.attributes.iter().filter(|attribute| !attribute.is_storage() && attribute.name != "envmap");
    kept.filter_map(|Attribute { name, kind, bytes }| {
        let kind = Text::new_or_none(kind)?;
        Some((Text::new_or_none(name)?, AttributeValue::Custom { kind, bytes: bytes.as_slice().into() }))
    })
}
