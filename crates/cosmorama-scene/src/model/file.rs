//! Files that models name.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::ModelFault;

/// Reads a file of at most so many bytes.
pub(super) fn read(path: &Path, most: u64) -> Result<Vec<u8>, ModelFault> {
    let file = File::open(path)?;
    let length = file.metadata()?.len();
    if length > most {
        return Err(ModelFault::TooLong { bytes: length, most });
    }
    let mut bytes = Vec::new();
    file.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    // Pipes tell no length.
    if bytes.len() as u64 > most { Err(ModelFault::TooLong { bytes: bytes.len() as u64, most }) } else { Ok(bytes) }
}

/// Returns the path of a file that a model names; of none that is elsewhere, or is no file but a device or a pipe.
pub(super) fn beside(folder: &Path, name: &str) -> Result<PathBuf, String> {
    if Path::new(name).is_absolute() {
        return Err(format!("is at '{name}'; expected a file beside the model's, by a name relative to that"));
    }
    let path = folder.join(name);
    match path.metadata() {
        Ok(found) if !found.is_file() => Err(format!("is at {}, which is no file", path.display())),
        _ => Ok(path),
    }
}
