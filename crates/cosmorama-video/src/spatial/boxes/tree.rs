//! Boxes in memory: a size, a name of four letters, and content, which may be boxes again.

use super::Fault;

/// Name of a box.
pub(super) type Name = [u8; 4];

/// A box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Boxed<'a> {
    pub(super) name: Name,
    /// Bytes behind size and name.
    pub(super) content: &'a [u8],
    /// All its bytes.
    pub(super) whole: &'a [u8],
}

impl Boxed<'_> {
    /// Returns whether it goes on to the end of what holds it, wherever that is.
    pub(super) fn is_open(&self) -> bool {
        self.whole.starts_with(&[0; 4])
    }
}

/// Boxes of a content at most.
const MOST: usize = 1 << 16;

/// Returns the boxes of a content. Fewer than eight bytes at the end are padding, as QuickTime writes it.
pub(super) fn split(mut bytes: &[u8]) -> Result<Vec<Boxed<'_>>, Fault> {
    let mut found = Vec::new();
    while let Some((size, rest)) = bytes.split_first_chunk::<4>() {
        let Some((name, _)) = rest.split_first_chunk::<4>() else { break };
        let (size, header) = match u32::from_be_bytes(*size) {
            0 => (bytes.len() as u64, 8),
            1 => {
                let large = bytes.get(8..16).and_then(|large| large.first_chunk::<8>());
                (large.map_or(0, |large| u64::from_be_bytes(*large)), 16)
            }
            size => (u64::from(size), 8),
        };
        let size = usize::try_from(size).ok().filter(|size| (header..=bytes.len()).contains(size));
        let name_in_words = || String::from_utf8_lossy(name).escape_debug().to_string();
        let size = size.ok_or_else(|| format!("the size of a box {} is wrong", name_in_words()))?;
        found.push(Boxed { name: *name, content: &bytes[header..size], whole: &bytes[..size] });
        if found.len() > MOST {
            return Err(format!("a box holds more than {MOST} others"));
        }
        bytes = &bytes[size..];
    }
    Ok(found)
}

/// Returns the first box of a name.
pub(super) fn find<'a>(content: &'a [u8], name: &Name) -> Result<Option<Boxed<'a>>, Fault> {
    Ok(split(content)?.into_iter().find(|found| found.name == *name))
}

/// Returns the first box of a name, which must be there.
pub(super) fn get<'a>(content: &'a [u8], name: &Name) -> Result<Boxed<'a>, Fault> {
    find(content, name)?.ok_or_else(|| format!("there is no box {}", String::from_utf8_lossy(name)))
}

/// Returns the bytes of a box.
pub(super) fn boxed(name: &Name, content: &[u8]) -> Result<Vec<u8>, Fault> {
    let size = u32::try_from(content.len() + 8);
    let size = size.map_err(|_| format!("a box {} would be too large", String::from_utf8_lossy(name)))?;
    Ok([size.to_be_bytes().as_slice(), name, content].concat())
}

/// Returns a content in which the first box of a name has another content.
pub(super) fn replaced(
    content: &[u8],
    name: &Name,
    change: impl FnOnce(&[u8]) -> Result<Vec<u8>, Fault>,
) -> Result<Vec<u8>, Fault> {
    let old = get(content, name)?;
    let start = old.whole.as_ptr().addr() - content.as_ptr().addr();
    let new = boxed(name, &change(old.content)?)?;
    Ok([&content[..start], &new, &content[start + old.whole.len()..]].concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_are_split_and_replaced() {
        let content = [boxed(b"free", b"").unwrap(), boxed(b"trak", b"old").unwrap(), vec![0; 4]].concat();
        let names: Vec<_> = split(&content).unwrap().iter().map(|found| found.name).collect();
        assert_eq!(names, [*b"free", *b"trak"]);
        let new = replaced(&content, b"trak", |old| Ok([old, b"er"].concat())).unwrap();
        assert_eq!(get(&new, b"trak").unwrap().content, b"older");
        assert_eq!(new.len(), content.len() + 2);
        assert!(replaced(&content, b"mdia", |old| Ok(old.to_vec())).is_err());
    }

    #[test]
    fn wrong_sizes_are_refused() {
        for wrong in
            [b"\0\0\0\x07free\0".as_slice(), b"\0\0\0\x10free", b"\0\0\0\x01free\0\0\0\0\0\0\0\x08", b"\0\0\0\x01free"]
        {
            assert!(split(wrong).is_err(), "{wrong:?}");
        }
        assert_eq!(split(b"\0\0\0\0restandmore").unwrap()[0].content, b"andmore");
    }
}
