use std::collections::{HashMap, HashSet};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

use cosmorama::layout::{FacePlacement, Naming};
use cosmorama::raster::FramePool;
use cosmorama::sphere::CubeFace;

use super::images::FaceImages;
use super::pattern::{FacePattern, LetterCase};
use crate::file::{read, upright};
use crate::header::ImageFile;
use crate::sequence::FramePattern;
use crate::{IoError, Limits};

/// One face of a set, whether its file exists or not.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FaceFile {
    /// Face of the cube.
    pub face: CubeFace,
    /// File of the face, or the pattern of its frames (see [`FramePattern::parse`]).
    pub path: PathBuf,
    /// Rotation that turns the picture upright. [`FaceSet::read_all`] applies it; programs that read the file
    /// themselves must do so.
    pub placement: FacePlacement,
    /// Whether the file, or any frame of it, exists.
    pub present: bool,
}

/// Files of the six faces of a cube, of which some may be missing.
///
/// ```
/// use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};
/// use cosmorama_io::{FaceSet, Limits, WriteOptions, write};
///
/// let folder = tempfile::tempdir()?;
/// for (grey, name) in (0..).zip(["front", "right", "back", "left", "top", "bottom"]) {
///     let face = EncodedImage::new(4, 4, Channels::Grey, Depth::Eight, Samples::U8(vec![grey; 16]))?;
///     write(folder.path().join(format!("{name}.png")), &face, &WriteOptions::default())?;
/// }
///
/// let faces = FaceSet::find(&format!("{}/{{face}}.png", folder.path().display()), None)?;
/// assert_eq!(faces.naming().name, "words");
/// let light = faces.read_all(&Limits::default())?.to_light();
/// assert_eq!(light[0].width(), 4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct FaceSet {
    naming: &'static Naming,
    faces: [FaceFile; 6],
}

impl FaceSet {
    /// Number of faces that a dome needs. A set of fewer may be unrelated files.
    const ENOUGH: usize = 4;

    /// Finds the faces of a pattern among existing files. Without `naming`, every automatic preset is tried, and the
    /// one that explains most files wins. A preset that finds only some of another's files gives way to it, and so does
    /// one with too few faces to one with four or more. Two others that disagree are an error.
    ///
    /// # Errors
    /// When the text is not a face pattern, nothing is found, or two presets fit.
    pub fn find(pattern: &str, naming: Option<&'static Naming>) -> Result<Self, IoError> {
        let pattern = parse(pattern)?;
        let namings: Vec<&'static Naming> = match naming {
            Some(naming) => vec![naming],
            None => Naming::presets().iter().filter(|naming| naming.automatic).collect(),
        };
        let mut found: Vec<Self> = Vec::new();
        let mut folders = Folders::default();
        for naming in &namings {
            for case in LetterCase::ALL {
                let set = Self::look(&pattern, naming, case, &mut folders);
                if set.present().next().is_some() && !found.iter().any(|other| other.includes(&set)) {
                    found.retain(|other| !set.includes(other));
                    found.push(set);
                }
            }
        }
        if found.iter().any(Self::is_enough) {
            found.retain(Self::is_enough);
        }
        match found.len() {
            0 => Err(folder(&pattern, &namings).unwrap_or_else(|| no_faces(&pattern, &namings))),
            1 => Ok(found.remove(0)),
            _ => Err(IoError::AmbiguousNaming {
                pattern: pattern.as_str().to_owned(),
                first: found[0].naming.name,
                first_faces: found[0].describe(),
                second: found[1].naming.name,
                second_faces: found[1].describe(),
            }),
        }
    }

    /// Lists the files that a pattern and a preset name, for writing: they need not exist.
    ///
    /// # Errors
    /// When the text is not a face pattern.
    pub fn named(pattern: &str, naming: &'static Naming) -> Result<Self, IoError> {
        Ok(Self::look(&parse(pattern)?, naming, LetterCase::Lower, &mut Folders::default()))
    }

    fn look(pattern: &FacePattern, naming: &'static Naming, case: LetterCase, folders: &mut Folders) -> Self {
        let faces = CubeFace::ALL.map(|face| {
            let path = PathBuf::from(pattern.name(naming, case, face));
            let present = folders.hold(pattern.folder(), &path);
            FaceFile { face, path, placement: naming.placement(face), present }
        });
        Self { naming, faces }
    }

    fn is_enough(&self) -> bool {
        self.present().count() >= Self::ENOUGH
    }

    /// Reads all six faces and turns each of them upright, as the library expects them. `limits` apply to each file.
    ///
    /// # Errors
    /// When a face has no file, or one cannot be read.
    pub fn read_all(&self, limits: &Limits) -> Result<FaceImages, IoError> {
        if let Some(missing) = self.missing().next() {
            return Err(IoError::MissingFaces {
                path: missing.path.clone(),
                missing: self.missing().map(|face| face.face.to_string()).collect::<Vec<_>>().join(", "),
            });
        }
        let read_upright = |file: &FaceFile| -> Result<ImageFile, IoError> {
            let ImageFile { format, image, metadata, window } = read(&file.path, limits)?;
            Ok(ImageFile { format, image: upright(image, file.placement, &FramePool::default()), metadata, window })
        };
        let pair = |a: &FaceFile, b: &FaceFile| rayon::join(|| read_upright(a), || read_upright(b));
        let [front, right, back, left, up, down] = &self.faces;
        let (((front, right), (back, left)), (up, down)) =
            rayon::join(|| rayon::join(|| pair(front, right), || pair(back, left)), || pair(up, down));
        Ok(FaceImages { files: [front?, right?, back?, left?, up?, down?], samples: self.naming.samples })
    }

    /// Returns the matching preset.
    pub fn naming(&self) -> &'static Naming {
        self.naming
    }

    /// Returns all six faces, in the order of [`CubeFace::ALL`].
    pub fn faces(&self) -> &[FaceFile; 6] {
        &self.faces
    }

    /// Returns one face.
    pub fn face(&self, face: CubeFace) -> &FaceFile {
        &self.faces[face as usize]
    }

    /// Iterates over the faces whose files exist.
    pub fn present(&self) -> impl Iterator<Item = &FaceFile> {
        self.faces.iter().filter(|face| face.present)
    }

    /// Iterates over the faces whose files are missing.
    pub fn missing(&self) -> impl Iterator<Item = &FaceFile> {
        self.faces.iter().filter(|face| !face.present)
    }

    /// Returns whether every file that the other set found is in this one, with the same meaning.
    fn includes(&self, other: &Self) -> bool {
        other.present().all(|face| *self.face(face.face) == *face)
    }

    fn describe(&self) -> String {
        let each = |face: &FaceFile| format!("{} is {}", file_name(&face.path), face.face);
        self.present().map(each).collect::<Vec<_>>().join(", ")
    }
}

fn parse(pattern: &str) -> Result<FacePattern, IoError> {
    FacePattern::parse(pattern).ok_or_else(|| IoError::NotAFacePattern { pattern: pattern.to_owned() })
}

/// Listings of folders, compared letter by letter. On a disk that ignores case, `FRONT.png` would otherwise also be
/// found as `front.png`.
#[derive(Default)]
struct Folders(HashMap<PathBuf, Option<HashSet<OsString>>>);

impl Folders {
    /// Returns whether a file, or any frame of it, exists under exactly this name, as far as it varies below `fixed`.
    fn hold(&mut self, fixed: &Path, path: &Path) -> bool {
        match path.to_str().and_then(FramePattern::parse) {
            Some(frames) => {
                let folder = frames.folder();
                let names_a_face = !fixed.starts_with(&folder);
                (!names_a_face || self.name(fixed, &folder)) && frames.existing().is_ok_and(|frames| !frames.is_empty())
            }
            None => self.name(fixed, path) && path.is_file(),
        }
    }

    fn name(&mut self, fixed: &Path, path: &Path) -> bool {
        let mut varying = path.ancestors().take_while(|part| *part != fixed && !part.as_os_str().is_empty());
        varying.all(|part| match (part.parent(), part.file_name()) {
            (Some(folder), Some(name)) => self.entries(folder).is_none_or(|entries| entries.contains(name)),
            // `..` and the root have no other spelling.
            _ => true,
        })
    }

    /// Lists a folder; `None` if it cannot be listed, although its files may still be opened by name.
    fn entries(&mut self, folder: &Path) -> Option<&HashSet<OsString>> {
        let list = || {
            let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
            Some(std::fs::read_dir(folder).ok()?.flatten().map(|entry| entry.file_name()).collect())
        };
        self.0.entry(folder.to_owned()).or_insert_with(list).as_ref()
    }
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// Returns the error for a folder that has the name of a face.
fn folder(pattern: &FacePattern, namings: &[&'static Naming]) -> Option<IoError> {
    let cases = |naming: &&'static Naming| LetterCase::ALL.map(|case| (*naming, case));
    let paths = namings.iter().flat_map(cases).flat_map(|(naming, case)| {
        CubeFace::ALL.into_iter().map(move |face| PathBuf::from(pattern.name(naming, case, face)))
    });
    let path = paths.into_iter().find(|path| path.is_dir())?;
    Some(IoError::FaceIsFolder { pattern: pattern.as_str().to_owned(), path })
}

fn no_faces(pattern: &FacePattern, namings: &[&'static Naming]) -> IoError {
    // If folders are named by frame number, the folder that holds all of them.
    let numbered = pattern.folder().to_str().and_then(FramePattern::parse);
    let folder = numbered.map_or_else(|| pattern.folder().to_owned(), |frames| frames.folder());
    if let Err(error) = std::fs::read_dir(&folder) {
        return IoError::open(&folder, error);
    }
    let tried = |naming: &&Naming| format!("{} ({})", naming.names.join(" "), naming.name);
    IoError::NoFaces {
        pattern: pattern.as_str().to_owned(),
        folder: pattern.folder().to_owned(),
        tried: namings.iter().map(tried).collect::<Vec<_>>().join(", "),
    }
}
