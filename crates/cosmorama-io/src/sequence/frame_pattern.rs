use std::collections::BTreeSet;
use std::ffi::OsString;
use std::path::{Component, Path, PathBuf};

use super::frame_list::LAST_FRAME;
use crate::IoError;

/// A file name with a placeholder for the frame number: `####` or `@@@@` (one sign per digit), `%04d` or `%d`.
///
/// The placeholder may occur in several places, folders included; all hold the same number. Numbers with more digits
/// than the placeholder are written and found without truncation.
///
/// ```
/// use cosmorama_io::FramePattern;
/// let pattern = FramePattern::parse("shot/dome_####.png").unwrap();
/// assert_eq!(pattern.path(7).to_str(), Some("shot/dome_0007.png"));
/// assert!(FramePattern::parse("dome.png").is_none());
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FramePattern {
    text: String,
    pieces: Vec<Piece>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Piece {
    Text(String),
    /// Frame number with at least this many digits.
    Number(usize),
}

impl FramePattern {
    /// Parses a file name; `None` if it has no placeholder. A single `@`, as in `texture@2x.png`, is not one.
    pub fn parse(text: &str) -> Option<Self> {
        let pieces = pieces(text);
        let numbered = pieces.iter().any(|piece| matches!(piece, Piece::Number(_)));
        numbered.then(|| Self { text: text.to_owned(), pieces })
    }

    /// Returns the pattern as it was typed.
    pub fn as_str(&self) -> &str {
        &self.text
    }

    /// Builds the file name of a frame.
    pub fn path(&self, frame: u64) -> PathBuf {
        let write = |piece: &Piece| match piece {
            Piece::Text(text) => text.clone(),
            Piece::Number(digits) => format!("{frame:0digits$}"),
        };
        self.pieces.iter().map(write).collect::<String>().into()
    }

    /// Returns the folder above the first part that varies with the frame.
    pub fn folder(&self) -> PathBuf {
        let fixed = self.fixed();
        if fixed.as_os_str().is_empty() { PathBuf::from(".") } else { fixed.to_owned() }
    }

    /// Returns the frame whose file has this path below the [`folder`](Self::folder), whether it exists or not.
    ///
    /// ```
    /// use cosmorama_io::FramePattern;
    /// let pattern = FramePattern::parse("shot/dome_####.png").unwrap();
    /// assert_eq!(pattern.frame_at("dome_0007.png".as_ref()), Some(7));
    /// assert_eq!(pattern.frame_at("dome_7.png".as_ref()), None);
    /// ```
    pub fn frame_at(&self, below: &Path) -> Option<u64> {
        let varying = Path::new(&self.text).strip_prefix(self.fixed()).ok()?;
        number_in(below.to_str()?, &pieces(varying.to_str()?))
    }

    /// Finds the frames whose files exist, in order.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn existing(&self) -> Result<BTreeSet<u64>, IoError> {
        let folder = self.folder();
        let fail = |error| IoError::open(&folder, error);
        let Some(varying) = self.first_varying() else { return Ok(BTreeSet::new()) };
        let varying = pieces(&varying.to_string_lossy());
        let mut frames = BTreeSet::new();
        for entry in std::fs::read_dir(&folder).map_err(fail)? {
            let name = entry.map_err(fail)?.file_name();
            if let Some(frame) = name.to_str().and_then(|name| number_in(name, &varying)) {
                // The rest of the path may contain the number again.
                if self.path(frame).is_file() {
                    frames.insert(frame);
                }
            }
        }
        Ok(frames)
    }

    /// Returns the path above the first part that varies; empty where that is the first of all.
    fn fixed(&self) -> &Path {
        Path::new(&self.text).ancestors().find(|path| !is_numbered(path)).unwrap_or(Path::new(""))
    }

    /// Returns the first part of the path that varies.
    fn first_varying(&self) -> Option<OsString> {
        let names = Path::new(&self.text).components().filter_map(|part| match part {
            Component::Normal(name) => Some(name.to_owned()),
            _ => None,
        });
        names.into_iter().find(|name| is_numbered(Path::new(name)))
    }
}

fn is_numbered(path: &Path) -> bool {
    pieces(&path.to_string_lossy()).iter().any(|piece| matches!(piece, Piece::Number(_)))
}

fn pieces(text: &str) -> Vec<Piece> {
    let mut pieces = Vec::new();
    let mut plain = String::new();
    let mut rest = text;
    while let Some(letter) = rest.chars().next() {
        if let Some((digits, length)) = marker(rest) {
            if !plain.is_empty() {
                pieces.push(Piece::Text(std::mem::take(&mut plain)));
            }
            pieces.push(Piece::Number(digits));
            rest = &rest[length..];
        } else {
            plain.push(letter);
            rest = &rest[letter.len_utf8()..];
        }
    }
    if !plain.is_empty() {
        pieces.push(Piece::Text(plain));
    }
    pieces
}

/// Longest file name that any system permits, which limits the number of digits.
const LONGEST_NAME: usize = 255;

/// Returns the number of digits of the marker at the start of a text, and the marker's length.
fn marker(text: &str) -> Option<(usize, usize)> {
    let run = |sign: u8| {
        let length = text.bytes().take_while(|byte| *byte == sign).count();
        Some((length.min(LONGEST_NAME), length))
    };
    match text.as_bytes() {
        [b'#', ..] => run(b'#'),
        [b'@', b'@', ..] => run(b'@'),
        [b'%', after @ ..] => {
            let digits = after.iter().take_while(|byte| byte.is_ascii_digit()).count();
            let width = &text[1..1 + digits];
            // No file name has a width of more than two digits.
            (after.get(digits) == Some(&b'd') && digits <= 2).then(|| (width.parse().unwrap_or(1), digits + 2))
        }
        _ => None,
    }
}

/// Returns the frame number in a file name.
fn number_in(name: &str, pieces: &[Piece]) -> Option<u64> {
    let mut rest = name;
    let mut found = None;
    for piece in pieces {
        match piece {
            Piece::Text(text) => rest = rest.strip_prefix(text.as_str())?,
            Piece::Number(least) => {
                let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
                let (number, after) = rest.split_at(digits);
                // More digits than the placeholder has are valid only without leading zeros. Otherwise a frame could
                // have two names.
                if digits < *least || (digits > *least && digits > 1 && number.starts_with('0')) {
                    return None;
                }
                let number = number.parse().ok().filter(|frame| *frame <= LAST_FRAME)?;
                if found.is_some_and(|found| found != number) {
                    return None;
                }
                found = Some(number);
                rest = after;
            }
        }
    }
    found.filter(|_| rest.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_the_markers() {
        for pattern in ["a_####.png", "a_@@@@.png", "a_%04d.png"] {
            let pattern = FramePattern::parse(pattern).unwrap();
            assert_eq!(pattern.path(12).to_str(), Some("a_0012.png"));
            assert_eq!(pattern.path(123_456).to_str(), Some("a_123456.png"));
        }
        assert_eq!(FramePattern::parse("%d.png").unwrap().path(3).to_str(), Some("3.png"));
        assert_eq!(FramePattern::parse("##/a_#.png").unwrap().path(3).to_str(), Some("03/a_3.png"));
        for plain in ["a.png", "a@2x.png", "100%.png", "%c.png", "%s_%x.png", "%004d.png"] {
            assert!(FramePattern::parse(plain).is_none(), "{plain}");
        }
    }

    #[test]
    fn a_name_longer_than_any_is_one_that_no_file_has() {
        let pattern = FramePattern::parse(&"#".repeat(66_000)).unwrap();
        assert_eq!(pattern.path(7).to_str().unwrap().len(), LONGEST_NAME);
        assert_eq!(pattern.existing().unwrap(), BTreeSet::new());
    }

    #[test]
    fn numbers_are_found_as_they_are_written() {
        let number = |pattern: &str, name: &str| number_in(name, &pieces(pattern));
        assert_eq!(number("a_####.png", "a_0012.png"), Some(12));
        assert_eq!(number("a_####.png", "a_12.png"), None);
        assert_eq!(number("a_####.png", "a_00012.png"), None);
        assert_eq!(number("a_####.png", "a_12345.png"), Some(12345));
        assert_eq!(number("a_####.png", "a_0012.jpg"), None);
        assert_eq!(number("##_#.png", "07_7.png"), Some(7));
        assert_eq!(number("##_#.png", "07_8.png"), None);
        assert_eq!(number("%d.png", "0.png"), Some(0));
    }

    #[test]
    fn folders_may_vary_too() {
        let folder = tempfile::tempdir().unwrap();
        for frame in [1, 2, 12] {
            let shot = folder.path().join(format!("{frame:03}"));
            std::fs::create_dir(&shot).unwrap();
            std::fs::write(shot.join(format!("f{frame}.png")), "").unwrap();
        }
        std::fs::remove_file(folder.path().join("002/f2.png")).unwrap();
        let pattern = FramePattern::parse(&format!("{}/###/f%d.png", folder.path().display())).unwrap();
        assert_eq!(pattern.existing().unwrap().into_iter().collect::<Vec<_>>(), [1, 12]);
        let at = |below: &str| pattern.frame_at(Path::new(below));
        assert_eq!(["002/f2.png", "002/f3.png", "f2.png"].map(at), [Some(2), None, None]);
    }
}
