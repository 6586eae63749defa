//! Files that are being written and do not count yet.
//!
//! [`write`](crate::write()) writes to a temporary file beside the output and renames it when it is whole. Meanwhile the file
//! is on a list, [`Unfinished`]; an interrupt handler calls [`Unfinished::remove_all`] before the program ends: no part of a
//! file stays behind. Files that a killed program left are named `.cosmorama-*.part`.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tempfile::{Builder, TempDir, TempPath};

use crate::IoError;

const PREFIX: &str = ".cosmorama-";
const SUFFIX: &str = ".part";

/// List of temporary files that are being written. Clones are the same list.
#[derive(Clone, Debug, Default)]
pub struct Unfinished(Arc<Mutex<BTreeSet<PathBuf>>>);

impl Unfinished {
    /// Deletes all temporary files on the list. For interrupt handlers: the program must end next, because whoever begins,
    /// finishes or gives up a file of this list from now on waits until it does. So nothing can appear after all was removed,
    /// and no writer's failure is told in place of the interrupt.
    pub fn remove_all(&self) {
        let paths = self.paths();
        for path in paths.iter() {
            // One that is gone already is as wanted.
            let _ = if path.is_dir() { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) };
        }
        std::mem::forget(paths);
    }

    fn paths(&self) -> MutexGuard<'_, BTreeSet<PathBuf>> {
        // A set of paths is whole after every step, even if a thread panicked.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Puts on the list what is made while nobody can remove all.
    fn list<T>(&self, make: impl FnOnce() -> io::Result<(PathBuf, T)>) -> io::Result<(T, Listed)> {
        let mut paths = self.paths();
        let (path, made) = make()?;
        paths.insert(path.clone());
        Ok((made, Listed { path, list: self.clone() }))
    }
}

/// A folder for files that nobody is to see. It goes away when it is dropped, and with [`Unfinished::remove_all`].
pub struct Scratch {
    // Deleted before it is struck off the list.
    folder: TempDir,
    _listed: Listed,
}

impl Scratch {
    /// An empty folder among the system's temporary files.
    ///
    /// # Errors
    /// When there cannot be one.
    pub fn create(unfinished: &Unfinished) -> io::Result<Self> {
        let (folder, _listed) = unfinished.list(|| {
            let folder = Builder::new().prefix(PREFIX).tempdir()?;
            Ok((folder.path().to_owned(), folder))
        })?;
        Ok(Self { folder, _listed })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }
}

/// A file in the making. Dropped without [`Pending::finish`], it leaves nothing behind.
pub struct Pending {
    target: PathBuf,
    // Closed before it is deleted, and deleted before it is struck off the list.
    file: BufWriter<File>,
    path: TempPath,
    listed: Listed,
}

/// An entry of the list, as long as it lives.
struct Listed {
    path: PathBuf,
    list: Unfinished,
}

impl Drop for Listed {
    fn drop(&mut self) {
        self.list.paths().remove(&self.path);
    }
}

impl Pending {
    /// A file that is to become `target`, or what that links to, in the same folder so that renaming it takes no time.
    ///
    /// # Errors
    /// When the folder is missing or cannot be written to, or what stands in the place is no file.
    pub fn create(target: &Path, unfinished: &Unfinished) -> Result<Self, IoError> {
        let target = &place(target)?;
        let folder = match target.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        let mut builder = Builder::new();
        builder.prefix(PREFIX).suffix(SUFFIX);
        let make = || {
            // Not by `tempfile`'s own hand, whose files only their owner can read: an output is for everyone that the umask lets.
            let file = builder.make_in(folder, |path| File::create_new(path))?;
            Ok((file.path().to_owned(), file))
        };
        let (file, listed) = unfinished.list(make).map_err(|error| refused(target, folder, &error))?;
        let (file, path) = file.into_parts();
        Ok(Self { target: target.to_owned(), file: BufWriter::with_capacity(1 << 18, file), path, listed })
    }

    /// Where to write.
    pub fn writer(&mut self) -> &mut BufWriter<File> {
        &mut self.file
    }

    /// Makes the file appear, whole, under its name; an older one is replaced.
    ///
    /// # Errors
    /// When the rest of it cannot be written (a full disk may show only now), or it cannot be renamed.
    pub fn finish(self) -> Result<(), IoError> {
        self.close()?.appear()
    }

    /// Ends writing. The file waits for its name, so that several can appear once all are whole.
    ///
    /// # Errors
    /// When the rest of it cannot be written: a full disk may show only now.
    pub fn close(self) -> Result<Hidden, IoError> {
        // What is named first goes last.
        let Self { target, listed, path, mut file } = self;
        let flushed = file.flush();
        // Closed before it is renamed.
        drop(file);
        flushed.and_then(|()| keep_permissions(&target, &path)).map_err(|error| IoError::write(&target, error))?;
        Ok(Hidden { target, path, _listed: listed })
    }
}

/// A whole file that does not have its name yet. Dropped without [`Hidden::appear`], it leaves nothing behind.
pub struct Hidden {
    target: PathBuf,
    // Deleted or renamed before it is struck off the list.
    path: TempPath,
    _listed: Listed,
}

impl Hidden {
    /// Makes it appear under its name; an older file is replaced.
    ///
    /// # Errors
    /// When it cannot be renamed.
    pub fn appear(self) -> Result<(), IoError> {
        let Self { target, _listed: _last, path } = self;
        path.persist(&target).map_err(|failed| IoError::write(&target, failed.error))
    }
}

/// Links that are followed to an output's place: as many as Linux follows.
const LINKS: usize = 40;

/// Where a file is to be: what its name links to, so that the link stays. What stands there and is no file is told before it is
/// written, not after, when the file is to get its name.
///
/// # Errors
/// When a folder, a pipe or a device stands there, or links lead nowhere.
pub fn place(target: &Path) -> Result<PathBuf, IoError> {
    let mut path = target.to_owned();
    for _ in 0..=LINKS {
        let found = match path.symlink_metadata() {
            Ok(found) => found.file_type(),
            Err(error) if error.kind() == io::ErrorKind::InvalidFilename => {
                return Err(IoError::write(&path, format_args!("{error}; choose another name")));
            }
            // Nothing is there, or its folder will say what is the matter.
            Err(_) => return Ok(path),
        };
        if found.is_file() {
            return Ok(path);
        }
        if found.is_dir() {
            return Err(IoError::write(target, "there is a folder of this name"));
        }
        if !found.is_symlink() {
            return Err(IoError::write(
                target,
                "there is a pipe or a device of this name, no file; choose another name",
            ));
        }
        let link = std::fs::read_link(&path).map_err(|error| IoError::write(target, error))?;
        path = path.parent().unwrap_or(Path::new("")).join(link);
    }
    Err(IoError::write(target, "its links lead nowhere but to each other; choose another name"))
}

/// Lets a file be read and written by those who may the one that it is to replace: what was private stays so.
fn keep_permissions(old: &Path, new: &Path) -> io::Result<()> {
    let Ok(old) = std::fs::metadata(old) else { return Ok(()) };
    if !old.is_file() || std::fs::metadata(new)?.permissions() == old.permissions() {
        return Ok(());
    }
    std::fs::set_permissions(new, old.permissions())
}

/// Why no file can be made in a folder, and what to do. Some say that it does not exist and mean that they take no files
/// (`/proc`).
fn refused(target: &Path, folder: &Path, error: &io::Error) -> IoError {
    let name = folder.display();
    match std::fs::metadata(folder) {
        Ok(found) if !found.is_dir() => IoError::write(target, format_args!("{name} is no folder; choose another")),
        Ok(_) if error.kind() == io::ErrorKind::NotFound => {
            IoError::write(target, format_args!("its folder {name} takes no new files; choose another"))
        }
        Ok(_) if matches!(error.kind(), io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem) => {
            let what = format_args!(
                "no files can be made in its folder {name} ({error}); have that allowed, or choose another"
            );
            IoError::write(target, what)
        }
        Err(missing) if missing.kind() == io::ErrorKind::NotFound => {
            IoError::write(target, format_args!("its folder {name} does not exist; make it first"))
        }
        _ => IoError::write(target, error),
    }
}
