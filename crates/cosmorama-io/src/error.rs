use std::io;
use std::path::{Path, PathBuf};

use cosmorama::raster::{Channels, Depth};
use thiserror::Error;

use crate::Format;

/// Reason why a file cannot be read, written or found. Each message names the file, what was found, what was expected,
/// and a remedy.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum IoError {
    /// A file or folder cannot be opened.
    #[error("cannot open {}: {source}", path.display())]
    Open {
        /// Path of the file or folder.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The file name's extension belongs to no format that can be written.
    #[error("{}: {}", path.display(), unnamed(path))]
    UnknownExtension {
        /// The file to write.
        path: PathBuf,
    },
    /// The file is of a format that this build of the library leaves out.
    #[error(
        "{}: this build has no {format}; it was made without the feature `{}`: use a program that was made with it, or convert the \
         file", path.display(), format.feature().unwrap_or("default")
    )]
    NotBuilt {
        /// The file to read or to write.
        path: PathBuf,
        /// Format of the file.
        format: Format,
    },
    /// The first bytes of a file match no known format.
    #[error("{}: {}", path.display(), known(path))]
    UnknownContent {
        /// The file read.
        path: PathBuf,
    },
    /// The first bytes of a file that was to be a picture are those of a video.
    #[error(
        "{}: a video by its first bytes, where a picture was expected; give it as a file whose name ends with .{extension}",
        path.display()
    )]
    VideoContent {
        /// The file read.
        path: PathBuf,
        /// Extension of such videos.
        extension: &'static str,
    },
    /// The first bytes of a file that was to be a video are those of a picture.
    #[error(
        "{}: a {format} file by its first bytes, though its name is that of a video; name it {}", path.display(),
        path.with_extension(format.own_extensions().first().unwrap_or(&"")).display()
    )]
    PictureContent {
        /// The file read.
        path: PathBuf,
        /// Format of the picture.
        format: Format,
    },
    /// The file has no bytes, often because a program was interrupted or a disk was full.
    #[error("{}: an empty file (0 bytes), where an image was expected; make it again", path.display())]
    Empty {
        /// The file read.
        path: PathBuf,
    },
    /// The file breaks the rules of its format, or ends too early.
    #[error("{}: damaged or truncated {format} file ({reason}); make it again", path.display())]
    Damaged {
        /// The file read.
        path: PathBuf,
        /// Format of the file.
        format: Format,
        /// Finding of the decoder.
        reason: String,
    },
    /// The file is valid, but of a kind that is not supported.
    #[error("{}: this {format} file holds {found}; expected {expected}; convert it first", path.display())]
    Unsupported {
        /// The file read.
        path: PathBuf,
        /// Format of the file.
        format: Format,
        /// Content of the file.
        found: String,
        /// Supported content.
        expected: &'static str,
    },
    /// A file holds several pictures, of which only the first would be used.
    #[error("{}: this {format} file holds {count} {found}; expected one; {}", path.display(), apart(*format, found))]
    Several {
        /// The file read.
        path: PathBuf,
        /// Format of the file.
        format: Format,
        /// Number of pictures.
        count: usize,
        /// Kind of the pictures, in words.
        found: String,
    },
    /// A file has no part of this name or number.
    #[error("{}: no part is called {asked}; there are {existing}", path.display())]
    NoSuchPart {
        /// The file read.
        path: PathBuf,
        /// Part that was requested.
        asked: String,
        /// Existing parts.
        existing: String,
    },
    /// A file has no channel of this name.
    #[error("{}: no channel is called {asked}; there are {existing}", path.display())]
    NoSuchChannel {
        /// The file read.
        path: PathBuf,
        /// Name that was requested; it may be one of several.
        asked: String,
        /// Existing channels.
        existing: String,
    },
    /// A channel is named twice.
    #[error("{}: {channel} is named twice, by {first} and by {second}; name it once", path.display())]
    ChannelTwice {
        /// The file read.
        path: PathBuf,
        /// Channel.
        channel: String,
        /// First name or pattern that names it.
        first: String,
        /// Second one.
        second: String,
    },
    /// A header declares more columns or rows than any picture has.
    #[error(
        "{}: its {format} header says {width}x{height} pixels, but a side may have at most {longest}; if no program made so \
         large a picture, the header is damaged: make the file again", path.display()
    )]
    TooLong {
        /// The file read.
        path: PathBuf,
        /// Format of the file.
        format: Format,
        /// Declared columns.
        width: u64,
        /// Declared rows.
        height: u64,
        /// Most columns or rows.
        longest: u64,
    },
    /// The declared pixels do not fit into the permitted memory.
    #[error(
        "{}: {width}x{height} pixels, {channels}, depth {depth}, need {needed} bytes, \
         but only {limit} may be used; if the file is right, raise --memory",
        path.display()
    )]
    TooLarge {
        /// The file read.
        path: PathBuf,
        /// Declared columns.
        width: u64,
        /// Declared rows.
        height: u64,
        /// Declared channels.
        channels: Channels,
        /// Declared depth.
        depth: Depth,
        /// Bytes of all samples.
        needed: u128,
        /// Permitted bytes.
        limit: u64,
    },
    /// The format cannot hold the picture.
    #[error("{}: {format} cannot hold {found}; it can hold {expected}", path.display())]
    CannotHold {
        /// The file to write.
        path: PathBuf,
        /// Format of the file.
        format: Format,
        /// Property of the picture that the format cannot hold.
        found: String,
        /// Properties that the format can hold.
        expected: String,
    },
    /// The file cannot be written; nothing was left behind.
    #[error("cannot write {}: {reason}", path.display())]
    Write {
        /// The file to write.
        path: PathBuf,
        /// Cause of the failure.
        reason: String,
    },
    /// A frame of a video, or a video, cannot be read or written. The message of its own reader or writer names it.
    #[error(transparent)]
    Video(Box<dyn std::error::Error + Send + Sync>),
    /// A damaged frame of a video is left out, as was asked for.
    #[error("{}: damaged or missing, and left out as was asked for; make the video again, or choose other frames", path.display())]
    LeftOut {
        /// Name of the frame.
        path: PathBuf,
    },
    /// The face pattern contains neither `{face}` nor `%c`.
    #[error(
        "{pattern}: no {{face}} or %c in this pattern; put one where the face's name stands, as in faces/{{face}}.png"
    )]
    NotAFacePattern {
        /// The pattern.
        pattern: String,
    },
    /// No file matches any naming preset.
    #[error("{pattern}: no face found in {}; tried {tried}", folder.display())]
    NoFaces {
        /// The pattern.
        pattern: String,
        /// Folder that was searched.
        folder: PathBuf,
        /// Names that were tried.
        tried: String,
    },
    /// Some faces of a cube have no files, although all six are needed.
    #[error("{}: no such file, where a face of a cube was expected; missing faces: {missing}", path.display())]
    MissingFaces {
        /// Expected file of the first missing face.
        path: PathBuf,
        /// Names of the missing faces.
        missing: String,
    },
    /// A folder has the name of a face, and no file is found.
    #[error("{}: a folder, where the file of a face was expected; write which file in it, as in {pattern}/{{face}}.png", path.display())]
    FaceIsFolder {
        /// The pattern.
        pattern: String,
        /// The folder.
        path: PathBuf,
    },
    /// Two naming presets match files and disagree about them.
    #[error(
        "{pattern}: the files fit two namings: {first} ({first_faces}) and {second} ({second_faces}); \
         say which with naming={first} or naming={second}"
    )]
    AmbiguousNaming {
        /// The pattern.
        pattern: String,
        /// First preset.
        first: &'static str,
        /// Faces that the first preset finds.
        first_faces: String,
        /// Second preset.
        second: &'static str,
        /// Faces that the second preset finds.
        second_faces: String,
    },
    /// The sequence has no frames.
    #[error("{pattern}: no frame found in {}; {}", folder.display(), expected_frames(example, found.as_deref()))]
    NoFrames {
        /// The pattern.
        pattern: String,
        /// Folder that was searched.
        folder: PathBuf,
        /// Name of frame 1.
        example: String,
        /// Longest sequence in the folder.
        found: Option<String>,
    },
    /// The first and the last frame of a sequence are too far apart for one.
    #[error(
        "{pattern}: the first frame is {} and the last {}, too far apart for one sequence; move what does not belong to it, or choose frames, \
         as with --frames {}-{}",
        existing.0, existing.1, existing.0, existing.0.saturating_add(99)
    )]
    FarFrames {
        /// The pattern.
        pattern: String,
        /// First and last existing frame.
        existing: (u64, u64),
    },
    /// Frames of a sequence are missing.
    #[error(
        "{pattern}: {} missing: {missing}; the first that exists is {}, the last {}; {}choose others with --frames",
        counted(*count), existing.0, existing.1, to_make(pattern, *count)
    )]
    MissingFrames {
        /// The pattern.
        pattern: String,
        /// Number of missing frames.
        count: usize,
        /// Missing frames, as a list that `--frames` accepts.
        missing: String,
        /// First and last existing frame.
        existing: (u64, u64),
    },
}

/// Returns the advice to make missing frames, except of a film.
fn to_make(pattern: &str, count: usize) -> &'static str {
    match count {
        _ if is_video(Path::new(pattern)) => "",
        1 => "make it, or ",
        _ => "make them, or ",
    }
}

/// Returns the expected names of a sequence, and the names of the sequence that was found instead.
fn expected_frames(example: &str, found: Option<&str>) -> String {
    let expected = format!("expected names like {example}");
    found.map_or_else(|| expected.clone(), |found| format!("{expected}, but there are {found}; write that pattern"))
}

/// Returns how to split a file of several pictures into one file for each.
fn apart(format: Format, found: &str) -> &'static str {
    match format {
        Format::Tiff if found.starts_with("pages") => {
            "write each page to a file of its own, as tiffsplit does, and convert those, as in page_####.tif"
        }
        Format::Exr if found.starts_with("parts") => {
            "write the part that you mean to a file of its own, as exrmultipart -separate does"
        }
        _ => {
            "write each frame to a file of its own, as ffmpeg does for the name frame_%04d.png, and convert \
             frame_####.png"
        }
    }
}

/// Returns the remedy for a file name without the extension of a format.
fn unnamed(path: &Path) -> String {
    let is_folder = path.is_dir() || path.as_os_str().to_string_lossy().ends_with('/');
    let extensions = Format::extensions();
    if is_folder {
        let file = path.join("out.png");
        return format!("a folder, where a file name was expected; write one in it, as in {}", file.display());
    }
    if is_video(path) {
        return "a video, where pictures were expected: write frames, as in frames/#####.png, of which ffmpeg makes the video \
                (docs/video.md)"
            .to_owned();
    }
    if path.extension().is_none() {
        return format!(
            "without an extension, which names the format; write {}.png, or one of {extensions}",
            path.display()
        );
    }
    format!("the extension names no format; use one of {extensions}")
}

/// Extensions of videos, which hold many pictures.
const VIDEOS: [&str; 43] = [
    "mp4", "m4v", "mov", "qt", "3gp", "3g2", "mj2", "mkv", "webm", "avi", "divx", "mxf", "ts", "trp", "mts", "m2ts",
    "mpg", "mpeg", "m2p", "vob", "m1v", "m2v", "wmv", "asf", "flv", "f4v", "ogv", "ogm", "gif", "nut", "dv", "ivf",
    "obu", "h264", "264", "avc", "h265", "265", "hevc", "insv", "lrv", "osv", "360",
];

/// Returns whether a file is a video by its name.
pub fn is_video(path: &Path) -> bool {
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default().to_ascii_lowercase();
    VIDEOS.contains(&extension.as_str())
}

/// Returns the expected content of a file whose format is unknown.
fn known(path: &Path) -> String {
    if is_video(path) {
        return "a video, where pictures were expected: take it apart, as with ffmpeg -i FILE -fps_mode passthrough \
                frames/%05d.png (docs/video.md)"
            .to_owned();
    }
    "not an image of a known format (PNG, JPEG, TIFF, Radiance HDR, OpenEXR, KTX or DDS; TGA is known by its extension .tga)"
        .to_owned()
}

/// Returns a number of frames in words.
fn counted(count: usize) -> String {
    if count == 1 { "1 frame is".to_owned() } else { format!("{count} frames are") }
}

/// Parts of decoders' messages about a file that ends too early.
const SHORT: [&str; 6] = [
    "failed to fill whole buffer",
    "reference to missing bytes",
    "Not enough bytes",
    "unexpected end of file",
    "unexpected EOF",
    "Unexpected end of",
];

impl IoError {
    pub(crate) fn open(path: &Path, source: io::Error) -> Self {
        Self::Open { path: path.to_owned(), source }
    }

    pub(crate) fn damaged(path: &Path, format: Format, reason: impl ToString) -> Self {
        let reason = reason.to_string();
        // Decoders report missing bytes in different words.
        let is_short = SHORT.iter().any(|words| reason.contains(words));
        let reason = if is_short { "it ends too early".to_owned() } else { reason };
        Self::Damaged { path: path.to_owned(), format, reason }
    }

    pub(crate) fn too_long(path: &Path, format: Format, (width, height): (u64, u64), longest: u64) -> Self {
        Self::TooLong { path: path.to_owned(), format, width, height, longest }
    }

    pub(crate) fn several(path: &Path, format: Format, count: usize, found: impl ToString) -> Self {
        Self::Several { path: path.to_owned(), format, count, found: found.to_string() }
    }

    pub(crate) fn write(path: &Path, reason: impl ToString) -> Self {
        Self::Write { path: path.to_owned(), reason: reason.to_string() }
    }

    pub(crate) fn unsupported(path: &Path, format: Format, found: impl ToString, expected: &'static str) -> Self {
        Self::Unsupported { path: path.to_owned(), format, found: found.to_string(), expected }
    }
}
