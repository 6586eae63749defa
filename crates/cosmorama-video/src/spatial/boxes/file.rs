//! The box `moov` in its file.

use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

use super::tree::boxed;
use crate::VideoError;

/// Content of the box that describes a file's tracks, with its place.
#[derive(Debug)]
pub(super) struct Movie {
    pub(super) content: Vec<u8>,
    start: u64,
    /// Place behind it.
    end: u64,
}

/// Largest `moov` that is read: it grows with the number of frames, ten hours take some ten megabytes.
const LARGEST: u64 = 256 << 20;

/// Boxes that are passed over at most.
const MOST_BOXES: usize = 1 << 16;

impl Movie {
    pub(super) fn read(path: &Path) -> Result<Self, VideoError> {
        let unread = |source| VideoError::Read { path: path.to_owned(), source };
        let refused = |reason: &str| VideoError::Boxes { path: path.to_owned(), reason: reason.to_owned() };
        let mut file = File::open(path).map_err(unread)?;
        let length = file.metadata().map_err(unread)?.len();
        let mut start = 0;
        for _ in 0..MOST_BOXES {
            let Some(head) = Head::read(&mut file, start, length).map_err(unread)? else { break };
            if head.name == *b"moov" {
                if head.size - head.header > LARGEST {
                    return Err(refused(
                        "its box moov is larger than 256 MiB; expected less: the file is damaged, make it again",
                    ));
                }
                let mut content = vec![0; (head.size - head.header) as usize];
                file.seek(SeekFrom::Start(start + head.header)).map_err(unread)?;
                file.read_exact(&mut content).map_err(unread)?;
                return Ok(Self { content, start, end: start + head.size });
            }
            start += head.size;
        }
        Err(refused("there is no whole box moov in it, as MP4 and MOV files have; the file is damaged, make it again"))
    }

    /// Writes another content. Frames stay in their places: what does not fit goes to the end of the file.
    pub(super) fn replace(&self, path: &Path, content: &[u8]) -> Result<(), VideoError> {
        let failed = |source: io::Error| VideoError::Boxes {
            path: path.to_owned(),
            reason: format!("its boxes cannot be written: {source}"),
        };
        let new = boxed(b"moov", content).map_err(|reason| VideoError::Boxes { path: path.to_owned(), reason })?;
        let mut file = OpenOptions::new().read(true).write(true).open(path).map_err(failed)?;
        let length = file.metadata().map_err(failed)?.len();
        let is_last = self.end == length;
        if !is_last && !is_tiled(&mut file, self.end, length).map_err(failed)? {
            let reason = "behind its box moov is another, or bytes that are no whole boxes; make the file again";
            return Err(VideoError::Boxes { path: path.to_owned(), reason: reason.to_owned() });
        }
        let start = if is_last { self.start } else { length };
        file.seek(SeekFrom::Start(start)).map_err(failed)?;
        file.write_all(&new).map_err(failed)?;
        file.set_len(start + new.len() as u64).map_err(failed)?;
        if !is_last {
            // Now that the new one is there, the old one is passed over.
            file.seek(SeekFrom::Start(self.start + 4)).map_err(failed)?;
            file.write_all(b"free").map_err(failed)?;
        }
        Ok(())
    }
}

/// Returns whether other boxes that have sizes of their own follow each other from a place to the end: a `moov` is found behind them.
fn is_tiled(file: &mut File, mut start: u64, length: u64) -> io::Result<bool> {
    for _ in 0..MOST_BOXES {
        match Head::read(file, start, length)? {
            Some(head) if !head.is_open && head.name != *b"moov" => start += head.size,
            _ => break,
        }
    }
    Ok(start == length)
}

/// Beginning of a box.
struct Head {
    name: [u8; 4],
    header: u64,
    size: u64,
    /// Whether it goes on to the end of the file, wherever that is.
    is_open: bool,
}

impl Head {
    /// Reads the beginning of the box at a place; `None` if no whole box is there.
    fn read(file: &mut File, start: u64, length: u64) -> io::Result<Option<Self>> {
        let rest = length.saturating_sub(start);
        if rest < 8 {
            return Ok(None);
        }
        file.seek(SeekFrom::Start(start))?;
        let (mut size, mut name, mut large) = ([0; 4], [0; 4], [0; 8]);
        file.read_exact(&mut size)?;
        file.read_exact(&mut name)?;
        let told = u32::from_be_bytes(size);
        let (size, header) = match told {
            0 => (rest, 8),
            1 if rest >= 16 => {
                file.read_exact(&mut large)?;
                (u64::from_be_bytes(large), 16)
            }
            size => (u64::from(size), 8),
        };
        Ok((header..=rest).contains(&size).then_some(Self { name, header, size, is_open: told == 0 }))
    }
}
