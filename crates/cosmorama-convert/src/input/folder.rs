//! Folders and wildcards in the place of a file or a pattern: the error says how to name what is there.

use std::path::{Path, PathBuf};

use cosmorama::layout::Naming;
use cosmorama_io::{FaceSet, Format, FoundFrames, IoError};
use cosmorama_spec::nearest;

use crate::detect::GivenFaces;
use crate::diagnostic::{Code, ConvertError, Result, bail, failure, usage_as};
use crate::input::Builtin;
use crate::source::Files;

/// Greatest number of suggested patterns.
const SHOWN: usize = 3;

/// Checks that a path is one file, not a folder or a wildcard. If it is missing, frames beside it are suggested.
pub fn is_one_file(files: &dyn Files, pattern: &str, path: &Path) -> Result<()> {
    if files.holds(path) {
        return Ok(());
    }
    if path.is_dir() {
        return Err(usage_as(Code::Unreadable, format!("{pattern} is a folder; {}", advice(path))));
    }
    if path.exists() {
        return Ok(());
    }
    let found = path.parent().map_or_else(Vec::new, FoundFrames::in_folder);
    let is_wild = pattern.contains(['*', '?', '{', '[', '$']);
    let found: Vec<_> = found.into_iter().filter(|found| is_wild || is_alike(path, found)).collect();
    let there = if found.is_empty() { String::new() } else { format!("; there are {}", names(&found)) };
    if is_wild {
        let there = path.parent().and_then(faces_of).map_or(there, |faces| format!("; there are {}", faces.display()));
        return Err(usage_as(
            Code::NotFound,
            format!(
                "{pattern} names no file; for the faces of a cube, write {{face}} or %c where a face's name stands, for frames \
             ####{there}"
            ),
        ));
    }
    if pattern.contains("://") {
        bail!(NotFound: "{pattern}: an address, where a file was expected; download it first, as with curl -O {pattern}");
    }
    if Builtin::all().any(|(name, _)| name == pattern) {
        bail!(NotFound: "{pattern}: there is no such file; the world by formula of this name is builtin:{pattern}");
    }
    match meant(pattern, path) {
        _ if !found.is_empty() => bail!(NotFound: "{pattern}: there is no such file{there}"),
        Some(meant) => bail!(NotFound: "{pattern}: there is no such file; {meant}"),
        // There is nothing to add: opening the file reports what is wrong.
        None => Ok(()),
    }
}

/// Finds the files of a cube's faces. Where a pattern fits none, the error says how to name what its folder holds.
///
/// # Errors
/// As [`FaceSet::find`].
pub fn face_set(pattern: &str, naming: Option<&'static Naming>) -> Result<FaceSet> {
    FaceSet::find(pattern, naming).map_err(|error| match &error {
        IoError::NoFaces { folder, .. } if folder.is_dir() => {
            let other_naming = naming.and_then(|_| FaceSet::find(pattern, None).ok());
            match (other_naming, faces_of(folder), with_slashes(pattern)) {
                (Some(set), ..) => failure!(NotFound: "{error}; there are faces by naming={}", set.naming().name),
                (_, _, Some(slashes)) => failure!(NotFound: "{pattern}: no such files; {slashes}"),
                (_, Some(faces), _) => failure!(
                    NotFound: "{pattern}: no such faces; for the faces of a cube that are in {}, write {}",
                    folder.display(),
                    faces.display()
                ),
                (None, None, None) => failure!(
                    NotFound: "{error}; {}; faces by other names, such as numbers, are to be renamed or linked (docs/names.md)",
                    advice(folder)
                ),
            }
        }
        _ => error.into(),
    })
}

/// Returns the advice to separate folders by `/`, for names that separate them by `\`.
fn with_slashes(name: &str) -> Option<String> {
    let is_windows_path = !cfg!(windows) && name.contains('\\');
    is_windows_path.then(|| format!("folders are separated by /: {}", name.replace('\\', "/")))
}

/// Returns advice on a name that no file has: a shell's sign that it did not replace, several names in one, or a file whose
/// name is much alike.
fn meant(name: &str, path: &Path) -> Option<String> {
    if let Some(slashes) = with_slashes(name) {
        return Some(slashes);
    }
    if name.starts_with("~/") {
        return Some(
            "a shell does not replace ~ in quotes: leave the quotes out, or write the folder in full".to_owned(),
        );
    }
    if name.contains(',') && name.split(',').all(|name| Path::new(name.trim()).is_file()) {
        return Some(
            "several files are no input; for the faces of a cube, write {face} where a face's name stands, for other \
             views list them in a world file (docs/tasks.md)"
                .to_owned(),
        );
    }
    let typed = path.file_name()?.to_str()?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let beside = files(folder.unwrap_or(Path::new(".")));
    let names: Vec<&str> = beside.iter().map(String::as_str).collect();
    let alike = nearest(typed, &names).filter(|name| Format::of_name(Path::new(name)).is_some())?;
    // Half of the letters alike are enough for a word, not for a name: one letter is another, or they are in another order.
    let sorted = |name: &str| {
        let mut letters: Vec<char> = name.chars().collect();
        letters.sort_unstable();
        letters
    };
    let differ = typed.chars().zip(alike.chars()).filter(|(one, other)| one != other).count();
    let is_alike = typed.len() == alike.len() && differ == 1 || sorted(typed) == sorted(alike);
    is_alike.then(|| format!("did you mean {}?", path.with_file_name(alike).display()))
}

/// Adds to an error about missing frames how to name the faces of a cube, if the folder holds some.
pub(crate) fn with_faces(error: ConvertError) -> ConvertError {
    let faces = match &error {
        ConvertError::Io(IoError::NoFrames { folder, .. }) => faces_of(folder),
        _ => None,
    };
    match faces {
        Some(faces) => failure!(NotFound: "{error}; or, for the faces of a cube, write {}", faces.display()),
        None => error,
    }
}

/// Adds to an error about a picture whose projection is not known the pattern of the cube of which it is a face, if its folder
/// holds others of it.
pub(crate) fn with_sisters(error: ConvertError, path: &Path) -> ConvertError {
    let ConvertError::Failed(diagnostic) = &error else { return error };
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let faces = faces_of(folder).filter(|_| diagnostic.code == Code::Ambiguous);
    let set = faces.as_ref().and_then(|faces| FaceSet::find(faces.to_str()?, None).ok());
    match (faces, set) {
        (Some(faces), Some(set)) if set.present().any(|face| face.path.file_name() == path.file_name()) => {
            let text = diagnostic.message.marked();
            failure!(Ambiguous: "{text}; it is a face of a cube, all of whose faces are {}", faces.display())
        }
        _ => error,
    }
}

/// Returns whether a name begins like the names of frames, which may then be meant.
fn is_alike(path: &Path, frames: &FoundFrames) -> bool {
    let beginning = |path: &Path| -> Vec<char> {
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
        name.chars().take_while(|letter| !letter.is_ascii_digit() && !"#@%.".contains(*letter)).collect()
    };
    let (typed, there) = (beginning(path), beginning(Path::new(frames.pattern.as_str())));
    let common = typed.iter().zip(&there).take_while(|(one, other)| one == other).count();
    2 * common >= typed.len().max(there.len())
}

/// Suggests patterns for the contents of a folder.
fn advice(folder: &Path) -> String {
    if let Some(faces) = faces_of(folder) {
        return format!("for the faces of a cube in it, write {}", faces.display());
    }
    let sequences = FoundFrames::in_folder(folder);
    let mut files = files(folder);
    if !sequences.is_empty() {
        return format!("for the frames in it, write {}", names(&sequences));
    }
    files.retain(|name| Format::of_name(Path::new(name)).is_some());
    match &files[..] {
        [] => format!(
            "no image is in it; write which file, as in {} for the faces of a cube, {} for frames",
            folder.join("{face}.png").display(),
            folder.join("####.png").display()
        ),
        [first, ..] => format!("write which file in it, as in {}", folder.join(first).display()),
    }
}

/// Lists sequences as alternatives.
fn names(found: &[FoundFrames]) -> String {
    let mut names: Vec<String> = found.iter().take(SHOWN).map(ToString::to_string).collect();
    if found.len() > SHOWN {
        names.push("…".to_owned());
    }
    names.join(" or ")
}

/// Returns the names in a folder, in order.
fn files(folder: &Path) -> Vec<String> {
    let entries = folder.read_dir().into_iter().flatten();
    let mut names: Vec<String> = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect();
    names.sort_unstable();
    names
}

/// Returns the pattern of a cube's faces in a folder, if there is one. Faces with frame numbers come before faces of
/// one frame.
fn faces_of(folder: &Path) -> Option<PathBuf> {
    let sequences = FoundFrames::in_folder(folder);
    let patterns = sequences.iter().filter_map(|found| found.pattern.as_str().rsplit('/').next());
    let tried: Vec<String> = patterns.map(str::to_owned).chain(files(folder)).collect();
    faces_in(folder, &tried)
}

/// Returns the first pattern of a cube's faces among names in a folder, if there is one. Names may be those of faces
/// alone, or have `front` in them.
fn faces_in(folder: &Path, names: &[String]) -> Option<PathBuf> {
    let by_extension = |name: &String| Some(format!("{{face}}.{}", name.rsplit_once('.')?.1));
    let by_front = |name: &String| name.contains("front").then(|| name.replacen("front", "{face}", 1));
    let mut tried = names.iter().flat_map(|name| by_extension(name).into_iter().chain(by_front(name)));
    let found = tried.find(|name| {
        let set = folder.join(name).to_str().and_then(|pattern| FaceSet::find(pattern, None).ok());
        set.is_some_and(|set| set.present().count() >= GivenFaces::LEAST)
    })?;
    Some(folder.join(found))
}
