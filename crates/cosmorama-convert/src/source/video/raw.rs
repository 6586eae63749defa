//! Streams of raw pictures, without ffmpeg: YUV4MPEG2, PAM and PFM, from any source of bytes and into files.

use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufWriter, Write};
use std::path::Path;

use cosmorama::raster::{Depth, EncodedImage, Transfer};
use cosmorama_io::pending::{Pending, Unfinished};
use cosmorama_io::{Format, Header, IoError, Limits, Metadata};
use cosmorama_spec::FrameRate;
use cosmorama_video::{
    ByteOrder, PamReader, PamWriter, PfmReader, PfmWriter, Ratio, VideoError, Y4mFormat, Y4mReader, Y4mWriter,
};

use super::{PictureSink, RawKind};

/// Bytes of a stream.
pub(super) type Bytes = Box<dyn BufRead + Send>;

/// Properties of a stream.
#[derive(Debug)]
pub(super) struct RawInfo {
    /// Header that all pictures share.
    pub(super) header: Header,
    /// Rate, if the stream says one.
    pub(super) rate: Option<FrameRate>,
}

/// Reader of a stream.
pub(super) enum RawReader {
    Y4m(Y4mReader<Bytes>),
    Pam(PamReader<Bytes>),
    Pfm(PfmReader<Bytes>),
}

/// Writer of a stream: into a file that appears when it is whole, or on to whoever takes its pictures as they are made.
pub(super) struct RawWriter {
    pictures: Pictures,
    /// File in progress; `None` where pictures are passed on.
    pending: Option<Pending>,
}

enum Pictures {
    Y4m(Y4mWriter<Goal>),
    Pam(PamWriter<Goal>),
    Pfm(PfmWriter<Goal>),
}

/// Place where the bytes of pictures go.
type Goal = Box<dyn Write + Send>;

/// Wraps the error of a reader or writer of videos.
pub(super) fn foreign(error: VideoError) -> IoError {
    match error {
        VideoError::Output(error) => error,
        error => IoError::Video(Box::new(error)),
    }
}

/// Does work on a thread of its own. A thread of a pool that waits for others in the midst of this work might be given another
/// frame to work on, which would wait for this one.
pub(super) fn aside<T: Send>(work: impl FnOnce() -> Result<T, VideoError> + Send, name: &str) -> Result<T, VideoError> {
    let ended = std::thread::scope(|scope| scope.spawn(work).join());
    ended.unwrap_or_else(|_| {
        let reason = "its decoder failed; make it again".to_owned();
        Err(VideoError::Stream { name: name.to_owned(), frame: 0, reason })
    })
}

impl RawInfo {
    /// Reads a stream to its end, to know its pictures and their number.
    pub(super) fn read(kind: RawKind, bytes: Bytes, name: &str) -> Result<(Self, u64), VideoError> {
        let mut reader = RawReader::open(kind, bytes, name, Limits::default().memory)?;
        let (_, info) = reader.begin(kind, name)?;
        let mut count = 1;
        while reader.next_picture(name)?.is_some() {
            count += 1;
        }
        Ok((info, count))
    }
}

impl RawKind {
    /// Returns the metadata of pictures: YUV is shown as television is, and RGB as pictures are.
    pub(super) fn metadata(self) -> Metadata {
        let transfer = if self == Self::Y4m { Some(Transfer::Bt1886) } else { None };
        Metadata { transfer, ..Metadata::default() }
    }
}

impl std::fmt::Debug for RawReader {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("RawReader")
    }
}

impl RawReader {
    /// Opens a stream whose pictures may take so much memory.
    pub(super) fn open(kind: RawKind, bytes: Bytes, name: &str, memory: u64) -> Result<Self, VideoError> {
        Ok(match kind {
            RawKind::Y4m => Self::Y4m(Y4mReader::new(bytes, name, memory)?),
            RawKind::Pam => Self::Pam(PamReader::new(bytes, name, memory)),
            RawKind::Pfm => Self::Pfm(PfmReader::new(bytes, name, memory)),
        })
    }

    /// Reads the first picture of a stream, which tells what all are.
    pub(super) fn begin(&mut self, kind: RawKind, name: &str) -> Result<(EncodedImage, RawInfo), VideoError> {
        let empty = || VideoError::Stream {
            name: name.to_owned(),
            frame: 0,
            reason: "it has no picture; make it again".to_owned(),
        };
        let first = self.next_picture(name)?.ok_or_else(empty)?;
        let header = Header {
            format: Format::Video,
            width: first.width(),
            height: first.height(),
            channels: first.channels(),
            depth: first.depth(),
            metadata: kind.metadata(),
            window: None,
        };
        Ok((first, RawInfo { header, rate: self.rate() }))
    }

    fn rate(&self) -> Option<FrameRate> {
        match self {
            Self::Y4m(reader) => {
                let rate = reader.format().rate;
                Some(FrameRate { frames: rate.numerator(), seconds: rate.denominator() })
            }
            Self::Pam(_) | Self::Pfm(_) => None,
        }
    }

    /// Returns the next picture; `None` after the last.
    pub(super) fn next_picture(&mut self, name: &str) -> Result<Option<EncodedImage>, VideoError> {
        let next = || match self {
            Self::Y4m(reader) => reader.next_frame(),
            Self::Pam(reader) => reader.next_frame(),
            Self::Pfm(reader) => reader.next_frame(),
        };
        aside(next, name)
    }
}

impl std::fmt::Debug for RawWriter {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("RawWriter")
    }
}

impl RawWriter {
    /// Begins a stream of pictures of a size, a depth and a rate. Without a sink, it becomes a file.
    pub(super) fn create(
        kind: RawKind,
        path: &Path,
        (size, depth, rate): ((usize, usize), Depth, Ratio),
        (sink, unfinished): (Option<&PictureSink>, &Unfinished),
    ) -> Result<Self, IoError> {
        let (pending, goal): (Option<Pending>, Goal) = match sink {
            Some(sink) => (None, Box::new(sink.clone())),
            None => {
                let pending = Pending::create(path, unfinished)?;
                let file = opened(&pending, path)?;
                (Some(pending), Box::new(BufWriter::new(file)))
            }
        };
        let name = path.display().to_string();
        let pictures = match kind {
            RawKind::Y4m => {
                let bits = match depth {
                    Depth::Eight => 8,
                    Depth::Ten => 10,
                    Depth::Twelve => 12,
                    Depth::Sixteen | Depth::Half | Depth::Float => 16,
                };
                let format = Y4mFormat { bits, ..Y4mFormat::new(size, rate) };
                Pictures::Y4m(Y4mWriter::new(goal, &name, format).map_err(foreign)?)
            }
            RawKind::Pam => Pictures::Pam(PamWriter::new(goal, &name)),
            RawKind::Pfm => Pictures::Pfm(PfmWriter::new(goal, &name, ByteOrder::Little)),
        };
        Ok(Self { pictures, pending })
    }

    /// Writes the next picture.
    pub(super) fn write(&mut self, picture: &EncodedImage, name: &str) -> Result<(), VideoError> {
        let write = || match &mut self.pictures {
            Pictures::Y4m(writer) => writer.write(picture),
            Pictures::Pam(writer) => writer.write(picture),
            Pictures::Pfm(writer) => writer.write(picture),
        };
        aside(write, name)
    }

    /// Ends the stream; if it goes into a file, that then appears.
    pub(super) fn finish(self) -> Result<(), VideoError> {
        match self.pictures {
            Pictures::Y4m(writer) => drop(writer.finish()?),
            Pictures::Pam(writer) => drop(writer.finish()?),
            Pictures::Pfm(writer) => drop(writer.finish()?),
        }
        Ok(self.pending.map_or(Ok(()), Pending::finish)?)
    }
}

/// Opens a file in progress for writing.
fn opened(pending: &Pending, path: &Path) -> Result<File, IoError> {
    let opened = OpenOptions::new().write(true).truncate(true).open(pending.path());
    opened.map_err(|source| IoError::Open { path: path.to_owned(), source })
}
