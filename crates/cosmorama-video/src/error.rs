use std::io;
use std::path::PathBuf;

use cosmorama_io::IoError;
use thiserror::Error;

/// Way to install ffmpeg, for messages.
const INSTALL: &str = "install it with `apt install ffmpeg`, `brew install ffmpeg` or `winget install ffmpeg`";

/// Reason why a video or a stream cannot be read or written. Each message names the file, what was found, what was expected, and
/// a remedy.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum VideoError {
    /// A program is not installed.
    #[error("{program} is not on the search path, but videos are read and written by it; {INSTALL}")]
    NotInstalled {
        /// Name of the program.
        program: &'static str,
    },
    /// The installed program is too old, or says nothing of its version.
    #[error("{program} is of version {found}, but {needed} or later is needed; {INSTALL}")]
    TooOld {
        /// Name of the program.
        program: &'static str,
        /// Version that it says.
        found: String,
        /// Oldest version that is used.
        needed: String,
    },
    /// A program cannot be started or spoken to.
    #[error("cannot run {program}: {source}")]
    Run {
        /// Name of the program.
        program: String,
        /// Error of the operating system.
        source: io::Error,
    },
    /// A program does not end in time.
    #[error("{}: {program} has not answered for {seconds} seconds; see whether the file, or its disk, can be read", path.display())]
    TooSlow {
        /// The file.
        path: PathBuf,
        /// Name of the program.
        program: &'static str,
        /// Seconds that were waited.
        seconds: u64,
    },
    /// A file cannot be opened or read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The file is no video, or holds none.
    #[error("{}: no video that ffmpeg can read ({reason}); if it is one, it is damaged: make it again", path.display())]
    NoVideo {
        /// The file.
        path: PathBuf,
        /// Finding.
        reason: String,
    },
    /// The video is of a kind that cannot be read right.
    #[error("{}: {found}; expected {expected}; convert it first", path.display())]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// Property of the video.
        found: String,
        /// Supported properties.
        expected: String,
    },
    /// The file ends before its own structure does.
    #[error(
        "{}: the file is cut: it has {found} bytes, but its own structure needs at least {expected}; copy or make it again{}",
        path.display(),
        if *is_described { ", or take what there is with --damaged hold or skip" } else { ": what describes its frames is lost" }
    )]
    Cut {
        /// The file.
        path: PathBuf,
        /// Bytes that its structure needs.
        expected: u64,
        /// Bytes that it has.
        found: u64,
        /// Whether it still describes its frames, so that those before its end can be read.
        is_described: bool,
    },
    /// A frame is damaged or missing.
    #[error(
        "{}: frame {frame} is damaged or missing ({reason}); make the video again, or convert it with --damaged hold or skip",
        path.display()
    )]
    DamagedFrame {
        /// The file.
        path: PathBuf,
        /// Number of the frame, from 0.
        frame: u64,
        /// Finding.
        reason: String,
    },
    /// There are fewer frames than the file announces.
    #[error(
        "{}: the video ends before frame {found}, but {announced} frames were announced; make the video again, or convert it with --damaged \
         hold or skip", path.display()
    )]
    FewerFrames {
        /// The file.
        path: PathBuf,
        /// Number of frames that there are.
        found: u64,
        /// Number of frames that are announced.
        announced: u64,
    },
    /// The frames asked for are not in the video.
    #[error("{}: no frame {asked}; its frames are 0 to {last}; choose others", path.display())]
    NoSuchFrame {
        /// The file.
        path: PathBuf,
        /// Frame asked for.
        asked: u64,
        /// Last frame.
        last: u64,
    },
    /// A frame takes more memory than permitted.
    #[error(
        "{name}: a frame of {}x{} pixels takes {needed} bytes, but only {limit} may be used; if the file is right, raise --memory",
        size.0, size.1
    )]
    TooLarge {
        /// Name of the file or stream.
        name: String,
        /// Columns and rows.
        size: (u64, u64),
        /// Bytes that a frame takes.
        needed: u128,
        /// Permitted bytes.
        limit: u64,
    },
    /// ffmpeg failed while it decoded.
    #[error("{}: ffmpeg cannot decode it: {reason}", path.display())]
    Decode {
        /// The file.
        path: PathBuf,
        /// Last words of ffmpeg.
        reason: String,
    },
    /// The output's extension belongs to no container.
    #[error("{}: films are not written with this extension; expected .mp4, .m4v, .mov, .mkv or .webm", path.display())]
    UnknownContainer {
        /// The file to write.
        path: PathBuf,
    },
    /// This build of ffmpeg has no such encoder.
    #[error(
        "{codec}: this ffmpeg has no encoder for it (it would need {needed}); it has those for {existing}; choose one of them"
    )]
    NoEncoder {
        /// Preset asked for.
        codec: &'static str,
        /// Encoders of which one is needed.
        needed: String,
        /// Presets that this build can make.
        existing: String,
    },
    /// A codec, or every encoder of it, makes no frames of this size.
    #[error("{}: {codec} takes no frames of {}x{} pixels; expected {expected}", path.display(), size.0, size.1)]
    UnfitSize {
        /// The file to write.
        path: PathBuf,
        /// Preset.
        codec: &'static str,
        /// Columns and rows.
        size: (usize, usize),
        /// Sizes that it takes.
        expected: String,
    },
    /// A container or codec cannot hold what the settings ask for.
    #[error("{}: {found}; expected {expected}", path.display())]
    CannotHold {
        /// The file to write.
        path: PathBuf,
        /// Part of the settings.
        found: String,
        /// Possible settings.
        expected: String,
    },
    /// A frame to write is not as the settings said.
    #[error("{name}: frame {frame} {found}; expected {expected}")]
    WrongFrame {
        /// Name of the file or stream.
        name: String,
        /// Number of the frame, from 0.
        frame: u64,
        /// Property of the frame.
        found: String,
        /// Expected property.
        expected: String,
    },
    /// A word among ffmpeg's further arguments cannot stand there.
    #[error(
        "ffmpeg's further argument {word}: {reason}; expected options with their values, as in -crf 20 -preset slow"
    )]
    UnfitArgument {
        /// The word.
        word: String,
        /// Why it is refused.
        reason: String,
    },
    /// ffmpeg failed while it encoded; nothing was left behind.
    #[error("cannot write {}: ffmpeg failed: {reason}", path.display())]
    Encode {
        /// The file to write.
        path: PathBuf,
        /// Last words of ffmpeg.
        reason: String,
    },
    /// The video that was written is not what was given; nothing was left behind.
    #[error("cannot write {}: {found} in what ffmpeg wrote, but {expected}; look at the encoder's arguments", path.display())]
    NotAsGiven {
        /// The file to write.
        path: PathBuf,
        /// Finding in the written file.
        found: String,
        /// Expected finding.
        expected: String,
    },
    /// A file's boxes are damaged, or have no room for the tags.
    #[error("{}: {reason}", path.display())]
    Boxes {
        /// The file.
        path: PathBuf,
        /// Finding and remedy.
        reason: String,
    },
    /// A stream of pictures is damaged, or of a kind that is not read.
    #[error("{name}: frame {frame}: {reason}")]
    Stream {
        /// Name of the stream.
        name: String,
        /// Number of the frame, from 0.
        frame: u64,
        /// Finding, expectation and remedy.
        reason: String,
    },
    /// A stream cannot be written.
    #[error("cannot write {name}: {source}")]
    WriteStream {
        /// Name of the stream.
        name: String,
        /// Error of the operating system.
        source: io::Error,
    },
    /// An output cannot be written; nothing was left behind.
    #[error(transparent)]
    Output(#[from] IoError),
}
