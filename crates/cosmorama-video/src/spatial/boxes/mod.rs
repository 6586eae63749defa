//! Boxes of MP4 and MOV files.

mod file;
mod tags;
mod tracks;
mod tree;

use std::path::Path;

use self::file::Movie;
use self::tracks::Handler;
use super::SpatialTags;
use crate::VideoError;

/// Finding about boxes that are damaged, in words.
type Fault = String;

pub(super) fn read(path: &Path) -> Result<Option<SpatialTags>, VideoError> {
    let movie = Movie::read(path)?;
    let extensions = tracks::extensions(&movie.content, Handler::Video).map_err(|fault| damaged(path, &fault))?;
    let Some(extensions) = extensions.first() else { return Ok(None) };
    tags::read(extensions).map_err(|fault| damaged(path, &fault))
}

pub(super) fn write(path: &Path, tags: &SpatialTags) -> Result<(), VideoError> {
    let boxes = tags::write(tags).map_err(|reason| VideoError::Boxes { path: path.to_owned(), reason })?;
    let movie = Movie::read(path)?;
    let content = tracks::with_extensions(&movie.content, Handler::Video, &[b"st3d", b"sv3d"], &[Some(boxes)]);
    movie.replace(path, &content.map_err(|fault| damaged(path, &fault))?)
}

/// Boxes that say how the channels of a file's sounds lie around the listener, for each sound track.
pub(crate) fn sound_fields(path: &Path) -> Result<Vec<Option<Vec<u8>>>, VideoError> {
    let movie = Movie::read(path)?;
    let tracks = tracks::extensions(&movie.content, Handler::Sound).map_err(|fault| damaged(path, &fault))?;
    let field = |extensions: &&[u8]| tree::find(extensions, b"SA3D").ok().flatten().map(|found| found.whole.to_vec());
    Ok(tracks.iter().map(field).collect())
}

/// Writes such boxes into the sound tracks of another file.
pub(crate) fn write_sound_fields(path: &Path, fields: &[Option<Vec<u8>>]) -> Result<(), VideoError> {
    let movie = Movie::read(path)?;
    let content = tracks::with_extensions(&movie.content, Handler::Sound, &[b"SA3D"], fields);
    movie.replace(path, &content.map_err(|fault| damaged(path, &fault))?)
}

fn damaged(path: &Path, fault: &str) -> VideoError {
    VideoError::Boxes { path: path.to_owned(), reason: format!("its boxes are damaged ({fault}); make the file again") }
}
