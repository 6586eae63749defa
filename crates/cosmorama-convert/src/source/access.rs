use std::collections::BTreeMap;
use std::fmt::Debug;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use cosmorama::raster::FramePool;
use cosmorama_io::pending::Unfinished;
use cosmorama_io::{
    Calibration, CalibrationError, Choice, Header, ImageFile, IoError, Limits, Plane, PtoError, PtoProject, ReadSeek,
    StPairs, open, probe_chosen, probe_pairs_from, read_chosen, read_layers, read_pairs_from,
};

use super::decoded_picture::DecodedPicture;
use super::lock::lock;
use super::stamp::Stamp;
use crate::source::MemoryBudget;
use crate::source::video::{DamagedFrames, FrameName, RawBytes, RawFiles, Videos};

/// Greatest length in bytes of a file that is read whole, which is a camera's path or belongs to one.
const LONGEST: u64 = 1 << 30;

/// Source of the bytes of inputs: disk, memory, an archive. Inputs are pictures, masks, st maps, calibrations, world
/// files and Hugin projects. Patterns of frames and faces are always searched on disk.
pub trait Files: Debug + Send + Sync {
    /// Opens a file.
    ///
    /// # Errors
    /// When the file cannot be opened.
    fn open(&self, path: &Path) -> Result<Box<dyn ReadSeek + Send>, IoError>;

    /// Returns whether a file is held here, whatever is on disk.
    fn holds(&self, path: &Path) -> bool;

    /// Returns the part and the channels to read of pictures that have several.
    fn choice(&self) -> Choice {
        Choice::default()
    }

    /// Returns the videos whose frames are pictures here; `None` where videos are files like others.
    fn videos(&self) -> Option<&Videos> {
        None
    }

    /// Returns a stream whose bytes come once, one behind the other; `None` for files. It can be opened by this alone.
    fn live(&self, _path: &Path) -> Option<&LiveStream> {
        None
    }

    /// Returns a stamp that differs once a file has changed; `None` where files do not change, or are gone.
    fn stamp(&self, _path: &Path) -> Option<Stamp> {
        None
    }
}

/// Stream of raw pictures whose bytes come once, such as standard input. Whoever takes it reads it as it comes.
pub struct LiveStream(Mutex<Option<Box<dyn BufRead + Send>>>);

impl LiveStream {
    fn take(&self) -> Option<Box<dyn BufRead + Send>> {
        lock(&self.0).take()
    }
}

/// Returns a source of inputs in which frames of videos are pictures, too. Videos are always read from disk, and streams of raw pictures
/// from `files`.
pub fn with_videos(files: Arc<dyn Files>) -> Arc<dyn Files> {
    Arc::new(ChosenFiles::new(files, Choice::default(), DamagedFrames::default()))
}

/// Files of which only a part, or some of the channels, is read, with frames of videos.
#[derive(Debug)]
pub(crate) struct ChosenFiles {
    /// Source of bytes.
    pub(crate) files: Arc<dyn Files>,
    /// Selection of what is read.
    pub(crate) choice: Choice,
    /// Videos whose frames are read.
    pub(crate) videos: Videos,
}

/// Source of the bytes of streams of raw pictures.
#[derive(Debug)]
struct Streams(Arc<dyn Files>);

impl RawFiles for Streams {
    fn open(&self, path: &Path) -> Result<RawBytes, IoError> {
        let live = self.0.live(path).and_then(LiveStream::take).map(RawBytes::Live);
        live.map_or_else(|| Ok(RawBytes::Kept(self.0.open(path)?)), Ok)
    }
}

impl ChosenFiles {
    /// Creates files of which a part is read, with an answer to damaged frames of videos.
    pub(crate) fn new(files: Arc<dyn Files>, choice: Choice, damaged: DamagedFrames) -> Self {
        let videos = Videos::new(damaged, Arc::new(Streams(Arc::clone(&files))));
        Self { files, choice, videos }
    }

    /// Has programs that read videos end with unfinished files when the job is interrupted.
    pub(crate) fn ending_with(self, unfinished: &Unfinished) -> Self {
        Self { videos: self.videos.ending_with(unfinished), ..self }
    }
}

impl Files for ChosenFiles {
    fn open(&self, path: &Path) -> Result<Box<dyn ReadSeek + Send>, IoError> {
        self.files.open(&FrameName::file(path))
    }

    fn holds(&self, path: &Path) -> bool {
        self.files.holds(path)
    }

    fn choice(&self) -> Choice {
        self.choice.clone()
    }

    fn videos(&self) -> Option<&Videos> {
        Some(&self.videos)
    }

    fn live(&self, path: &Path) -> Option<&LiveStream> {
        self.files.live(path)
    }

    fn stamp(&self, path: &Path) -> Option<Stamp> {
        self.files.stamp(path)
    }
}

/// Files on disk.
#[derive(Clone, Copy, Debug, Default)]
pub struct Disk;

impl Files for Disk {
    fn open(&self, path: &Path) -> Result<Box<dyn ReadSeek + Send>, IoError> {
        Ok(Box::new(open(path)?))
    }

    fn holds(&self, _: &Path) -> bool {
        false
    }

    fn stamp(&self, path: &Path) -> Option<Stamp> {
        Stamp::of(path)
    }
}

/// Named files in memory, for example standard input; all other files are on disk.
#[derive(Clone, Default)]
pub struct InMemory {
    files: BTreeMap<PathBuf, Held>,
}

/// Bytes of a named file.
#[derive(Clone)]
enum Held {
    Memory(Arc<[u8]>),
    /// In another file, which may have no name.
    Disk(Arc<Mutex<File>>),
    /// As they come, once.
    Live(Arc<LiveStream>),
}

impl InMemory {
    /// Adds a file.
    pub fn insert(&mut self, name: impl Into<PathBuf>, bytes: Vec<u8>) {
        self.files.insert(name.into(), Held::Memory(bytes.into()));
    }

    /// Adds a file that is too long for memory, whose bytes are in another file on disk. That may have no name any more.
    pub fn insert_kept(&mut self, name: impl Into<PathBuf>, kept: File) {
        self.files.insert(name.into(), Held::Disk(Arc::new(Mutex::new(kept))));
    }

    /// Adds a stream of raw pictures that is read once, as it comes. Its name says what it is: `.y4m`, `.pam` or `.pfm`.
    pub fn insert_live(&mut self, name: impl Into<PathBuf>, bytes: impl BufRead + Send + 'static) {
        let stream = LiveStream(Mutex::new(Some(Box::new(bytes))));
        self.files.insert(name.into(), Held::Live(Arc::new(stream)));
    }
}

/// Reader of a file that others read, too, by the same descriptor: each has its own place.
struct KeptReader {
    file: Arc<Mutex<File>>,
    place: u64,
}

impl Read for KeptReader {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let mut file = lock(&self.file);
        file.seek(SeekFrom::Start(self.place))?;
        let read = file.read(bytes)?;
        self.place += read as u64;
        Ok(read)
    }
}

impl Seek for KeptReader {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let mut file = lock(&self.file);
        // The descriptor may be at another reader's place.
        file.seek(SeekFrom::Start(self.place))?;
        self.place = file.seek(to)?;
        Ok(self.place)
    }
}

impl Debug for InMemory {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_set().entries(self.files.keys()).finish()
    }
}

impl Files for InMemory {
    fn open(&self, path: &Path) -> Result<Box<dyn ReadSeek + Send>, IoError> {
        match self.files.get(path) {
            Some(Held::Memory(bytes)) => Ok(Box::new(Cursor::new(Arc::clone(bytes)))),
            Some(Held::Disk(kept)) => Ok(Box::new(BufReader::new(KeptReader { file: Arc::clone(kept), place: 0 }))),
            Some(Held::Live(_)) => {
                let source =
                    io::Error::new(io::ErrorKind::NotSeekable, "a stream can be read once, and from its beginning");
                Err(IoError::Open { path: path.to_owned(), source })
            }
            None => Disk.open(path),
        }
    }

    fn holds(&self, path: &Path) -> bool {
        self.files.contains_key(path)
    }

    fn live(&self, path: &Path) -> Option<&LiveStream> {
        match self.files.get(path) {
            Some(Held::Live(stream)) => Some(stream),
            _ => None,
        }
    }

    fn stamp(&self, path: &Path) -> Option<Stamp> {
        if self.holds(path) { None } else { Disk.stamp(path) }
    }
}

/// Reads the header of a picture.
///
/// # Errors
/// When the file cannot be opened, is of no known format, or is damaged before its pixels.
pub fn probe(files: &dyn Files, path: &Path) -> Result<Header, IoError> {
    if let Some((name, videos)) = frame(files, path) {
        return videos.header(&name);
    }
    probe_chosen(files.open(path)?, path, &files.choice())
}

/// Reads a picture.
///
/// # Errors
/// When the file cannot be opened, is of no known format, declares more pixels than the limits allow, or is damaged.
pub fn read(files: &dyn Files, path: &Path, limits: &Limits) -> Result<ImageFile, IoError> {
    read_in(files, path, limits, &FramePool::default())
}

/// Reads a picture into memory of a pool.
///
/// # Errors
/// As [`read`].
pub(crate) fn read_in(files: &dyn Files, path: &Path, limits: &Limits, pool: &FramePool) -> Result<ImageFile, IoError> {
    read_choice(files, path, (limits, pool), &files.choice())
}

/// Reads the parts and channels of a picture that are chosen; of a frame of a video, all.
///
/// # Errors
/// As [`read`].
pub(crate) fn read_choice(
    files: &dyn Files,
    path: &Path,
    (limits, pool): (&Limits, &FramePool),
    choice: &Choice,
) -> Result<ImageFile, IoError> {
    match frame(files, path) {
        Some((name, videos)) => videos.picture(&name, limits, pool),
        None => read_chosen(files.open(path)?, path, (limits, pool), choice),
    }
}

/// Returns the frame of a video that a name in place of a file's means, with the videos that are read.
fn frame<'a>(files: &'a dyn Files, path: &Path) -> Option<(FrameName, &'a Videos)> {
    Some((FrameName::parse(path)?, files.videos()?))
}

/// Reads channels of a file beside its picture.
///
/// # Errors
/// When the file cannot be read or lacks a channel.
pub(crate) fn read_further(
    files: &dyn Files,
    path: &Path,
    limits: &Limits,
    channels: &[&str],
) -> Result<Vec<Plane>, IoError> {
    read_layers(files.open(path)?, path, limits, (&files.choice(), channels))
}

/// Means of reading inputs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Access<'a> {
    /// Source of bytes.
    pub(crate) files: &'a dyn Files,
    /// Memory budget.
    pub(crate) memory: MemoryBudget,
    /// Picture that was decoded before it is needed.
    pub(crate) decoded: &'a DecodedPicture,
}

impl Access<'_> {
    /// Reads the header of a picture.
    pub(crate) fn probe(self, path: &Path) -> Result<Header, IoError> {
        probe(self.files, path)
    }

    /// Reads the header of an st map.
    pub(crate) fn probe_pairs(self, path: &Path) -> Result<Header, IoError> {
        probe_pairs_from(self.files.open(path)?, path)
    }

    /// Reads an st map.
    pub(crate) fn read_pairs(self, path: &Path) -> Result<StPairs, IoError> {
        read_pairs_from(self.files.open(path)?, path, &Limits::memory(self.memory.bytes))
    }

    /// Reads a calibration.
    pub(crate) fn read_calibration(self, path: &Path) -> Result<Calibration, CalibrationError> {
        let open = |source| CalibrationError::Open { path: path.to_owned(), source };
        Calibration::read_from(self.open(path).map_err(open)?, path)
    }

    /// Reads a Hugin project.
    pub(crate) fn read_project(self, path: &Path) -> Result<PtoProject, PtoError> {
        let open = |source| PtoError::Open { path: path.to_owned(), source };
        PtoProject::read_from(self.open(path).map_err(open)?, path)
    }

    /// Reads all bytes of a file other than a picture, up to [`LONGEST`].
    pub(crate) fn read_bytes(self, path: &Path) -> io::Result<Vec<u8>> {
        let bytes = self.read_most(path, LONGEST + 1)?;
        if bytes.len() as u64 > LONGEST {
            let reason = format!("more than {LONGEST} bytes, which no path of a camera has");
            return Err(io::Error::new(io::ErrorKind::FileTooLarge, reason));
        }
        Ok(bytes)
    }

    /// Reads so many bytes of a file, or all if it has fewer.
    pub(crate) fn read_most(self, path: &Path, most: u64) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        self.open(path)?.take(most).read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    /// Opens a file other than a picture. The caller adds to errors what was expected.
    fn open(self, path: &Path) -> io::Result<Box<dyn ReadSeek + Send>> {
        self.files.open(path).map_err(|error| match error {
            IoError::Open { source, .. } => source,
            other => io::Error::other(other),
        })
    }
}
