//! Files that are being written and do not count yet.
//!
//! [`write`](crate::write()) writes to a temporary file beside the output and renames it when it is whole. An
//! interrupt handler calls [`remove_all`] before the program ends: no part of a file stays behind. Files that a
//! killed program left are named `.cosmorama-*.part`.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::{Builder, NamedTempFile};

use crate::IoError;

/// How the name of a temporary file begins.
pub const PREFIX: &str = ".cosmorama-";
/// How the name of a temporary file ends.
pub const SUFFIX: &str = ".part";

static IN_FLIGHT: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn in_flight() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    // A set of paths is whole after every step, even if a thread panicked.
    IN_FLIGHT.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The temporary files that are being written now.
pub fn list() -> Vec<PathBuf> {
    in_flight().iter().cloned().collect()
}

/// Deletes all temporary files that are being written now; their writers will fail. For interrupt handlers.
pub fn remove_all() {
    for path in in_flight().iter() {
        // One that is gone already is as wanted.
        let _ = std::fs::remove_file(path);
    }
}

/// A file in the making. Dropped without [`Pending::finish`], it leaves nothing behind.
pub struct Pending {
    target: PathBuf,
    // Dropped, and so deleted, before it is struck off the list.
    file: NamedTempFile,
    listed: Listed,
}

/// An entry of the list, as long as it lives.
struct Listed(PathBuf);

impl Listed {
    fn new(path: &Path) -> Self {
        in_flight().insert(path.to_owned());
        Self(path.to_owned())
    }
}

impl Drop for Listed {
    fn drop(&mut self) {
        in_flight().remove(&self.0);
    }
}

impl Pending {
    /// A file that is to become `target`, in the same folder so that renaming it takes no time.
    ///
    /// # Errors
    /// When the folder is missing or cannot be written to.
    pub fn create(target: &Path) -> Result<Self, IoError> {
        let folder = match target.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        if target.is_dir() {
            return Err(IoError::write(target, "there is a folder of this name"));
        }
        let mut builder = Builder::new();
        builder.prefix(PREFIX).suffix(SUFFIX);
        readable_by_all(&mut builder);
        let file = builder.tempfile_in(folder).map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => {
                IoError::write(target, format_args!("its folder {} does not exist; make it first", folder.display()))
            }
            _ => IoError::write(target, error),
        })?;
        let listed = Listed::new(file.path());
        Ok(Self { target: target.to_owned(), file, listed })
    }

    /// Where to write; flush it before [`Pending::finish`], or errors go unnoticed.
    pub fn writer(&mut self) -> BufWriter<&mut File> {
        BufWriter::with_capacity(1 << 18, self.file.as_file_mut())
    }

    /// The temporary file's own path, for programs that write it themselves.
    pub fn path(&self) -> &Path {
        self.file.path()
    }

    /// Makes the file appear, whole, under its name; an older one is replaced.
    ///
    /// # Errors
    /// When it cannot be renamed.
    pub fn finish(self) -> Result<(), IoError> {
        let Self { target, file, listed } = self;
        let result = file.persist(&target);
        drop(listed);
        result.map(drop).map_err(|failed| IoError::write(&target, failed.error))
    }
}

/// `tempfile` makes files that only their owner can read; an output is for everyone that the umask lets.
#[cfg(unix)]
fn readable_by_all(builder: &mut Builder<'_, '_>) {
    use std::os::unix::fs::PermissionsExt;
    builder.permissions(std::fs::Permissions::from_mode(0o666));
}

#[cfg(not(unix))]
fn readable_by_all(_: &mut Builder<'_, '_>) {}
