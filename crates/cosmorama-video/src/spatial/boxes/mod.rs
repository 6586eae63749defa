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
    let refused = |reason| VideoError::Boxes { path: path.to_owned(), reason };
    let boxes = tags::write(tags).map_err(refused)?;
    let movie = Movie::read(path)?;
    if tracks::extensions(&movie.content, Handler::Video).map_err(|fault| damaged(path, &fault))?.is_empty() {
        return Err(refused("it has no track of video, which the tags are of; expected one".to_owned()));
    }
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

#[cfg(test)]
mod tests {
    use super::tree::boxed;
    use super::*;

    /// Returns a track of sound with these extending boxes.
    fn sound(extensions: &[u8]) -> Vec<u8> {
        let entry = boxed(b"mp4a", &[&[0; 28], extensions].concat()).unwrap();
        let descriptions = boxed(b"stsd", &[&[0, 0, 0, 0, 0, 0, 0, 1], entry.as_slice()].concat()).unwrap();
        let table = boxed(b"minf", &boxed(b"stbl", &descriptions).unwrap()).unwrap();
        let handler = boxed(b"hdlr", b"\0\0\0\0\0\0\0\0soun\0\0\0\0").unwrap();
        boxed(b"trak", &boxed(b"mdia", &[handler, table].concat()).unwrap()).unwrap()
    }

    #[test]
    fn the_field_of_a_sound_goes_into_another_file() {
        let folder = tempfile::tempdir().unwrap();
        let (from, to) = (folder.path().join("from.mp4"), folder.path().join("to.mp4"));
        let (field, other) = (boxed(b"SA3D", b"ambisonics").unwrap(), boxed(b"esds", b"codec").unwrap());
        let file = |tracks: &[Vec<u8>]| {
            [boxed(b"moov", &tracks.concat()).unwrap(), boxed(b"mdat", b"frames").unwrap()].concat()
        };
        let both = [other.clone(), field.clone()].concat();
        std::fs::write(&from, file(&[sound(&other), sound(&both)])).unwrap();
        std::fs::write(&to, file(&[sound(&other), sound(&other)])).unwrap();
        let fields = sound_fields(&from).unwrap();
        assert_eq!(fields, [None, Some(field.clone())]);
        // Twice: the second takes the place of the first.
        for _ in 0..2 {
            write_sound_fields(&to, &fields).unwrap();
            assert_eq!(sound_fields(&to).unwrap(), fields);
        }
        let written = std::fs::read(&to).unwrap();
        assert_eq!(written.windows(field.len()).filter(|bytes| *bytes == field).count(), 1);
        let frames = written.windows(6).position(|bytes| bytes == b"frames").unwrap();
        assert_eq!(frames, file(&[sound(&other), sound(&other)]).len() - 6);
    }
}
