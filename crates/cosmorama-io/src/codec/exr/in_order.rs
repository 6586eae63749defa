//! Attributes in the order of their names, as OpenEXR's own library writes them. The encoder has those of a picture in a table
//! without an order, so that two files of one picture would differ.

use std::io::{self, Seek, SeekFrom, Write};
use std::mem::take;

/// Output of an encoder, whose header is held until it is whole.
pub(super) struct InOrder<W> {
    output: W,
    /// Bytes of the header so far; `None` when it is written.
    header: Option<Vec<u8>>,
}

/// Bytes of the mark, the version and its flags, before the first attribute.
const START: usize = 8;

impl<W: Write> InOrder<W> {
    pub(super) fn new(output: W) -> Self {
        Self { output, header: Some(Vec::new()) }
    }
}

impl<W: Write> Write for InOrder<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let Some(header) = &mut self.header else { return self.output.write(bytes) };
        header.extend_from_slice(bytes);
        if let Some(sorted) = sorted(header) {
            self.output.write_all(&sorted)?;
            self.header = None;
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.output.flush()
    }
}

impl<W: Write + Seek> Seek for InOrder<W> {
    fn seek(&mut self, place: SeekFrom) -> io::Result<u64> {
        // A header that is left before it is whole goes out as it came.
        if let Some(header) = self.header.as_mut().filter(|header| !header.is_empty()) {
            self.output.write_all(&take(header))?;
            self.header = None;
        }
        self.output.seek(place)
    }
}

/// Returns a header whose attributes are sorted, with what follows it; `None` while it is not whole.
fn sorted(header: &[u8]) -> Option<Vec<u8>> {
    let mut attributes = Vec::new();
    let mut rest = header.get(START..)?;
    while *rest.first()? != 0 {
        let (attribute, others) = rest.split_at_checked(length(rest)?)?;
        attributes.push(attribute);
        rest = others;
    }
    attributes.sort_unstable();
    Some([&header[..START], &attributes.concat(), rest].concat())
}

/// Returns the bytes of the first attribute: its name and its type, each with a zero, the number of its bytes, and these.
fn length(bytes: &[u8]) -> Option<usize> {
    let zero = |from: usize| Some(from + bytes.get(from..)?.iter().position(|byte| *byte == 0)? + 1);
    let start = zero(zero(0)?)?;
    let size = u32::from_le_bytes(*bytes.get(start..)?.first_chunk()?);
    (start + size_of::<u32>()).checked_add(usize::try_from(size).ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn attribute(name: &str, value: &[u8]) -> Vec<u8> {
        [name.as_bytes(), b"\0kind\0", &(value.len() as u32).to_le_bytes(), value].concat()
    }

    #[test]
    fn attributes_are_sorted_however_they_come() {
        let [a, b, c] = [attribute("a", &[0; 9]), attribute("b", b""), attribute("c", b"cba")];
        let file = [&[1; START][..], &c, &a, &b, b"\0rest"].concat();
        let expected = [&[1; START][..], &a, &b, &c, b"\0rest"].concat();
        for size in 1..=file.len() {
            let mut output = InOrder::new(io::Cursor::new(Vec::new()));
            file.chunks(size).for_each(|part| output.write_all(part).unwrap());
            assert_eq!(output.output.into_inner(), expected, "{size}");
        }
    }

    #[test]
    fn what_is_no_header_goes_out_as_it_came() {
        let mut output = InOrder::new(io::Cursor::new(Vec::new()));
        assert_eq!(output.stream_position().unwrap(), 0);
        output.write_all(b"short").unwrap();
        assert_eq!(output.stream_position().unwrap(), 5);
        output.write_all(b"er").unwrap();
        assert_eq!(output.output.into_inner(), b"shorter");
    }
}
