use std::collections::BTreeSet;
use std::fmt::Debug;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use xxhash_rust::xxh3::xxh3_64;

use crate::colour::Light;
use crate::input::Input;
use crate::settings::{Conversion, GeometrySettings};
use crate::source::Files;

/// Digests of the settings by which frames are made. With the digest of its inputs, they are the origin of a frame, which goes
/// into its file.
#[derive(Clone, Debug)]
pub(crate) struct Origin {
    geometry: u32,
    filter: u32,
    colour: u32,
    /// Files that are read for every frame, beside those of views.
    beside: BTreeSet<PathBuf>,
}

/// Number of bytes, from the beginning and from the end of a file, that are looked at. Pictures that differ differ there, since
/// they are compressed, or in length.
const ENDS: u64 = 1 << 16;

impl Origin {
    pub(crate) fn of(settings: &Conversion, light: &Light) -> Self {
        let GeometrySettings { filter, kernel, anti_ringing, .. } = &settings.geometry;
        let GeometrySettings { from, to, size, orientation, camera, in_path, blur, .. } = &settings.geometry;
        let Conversion { in_transfer, in_primaries, ignore_profile, ocio, part, channels, layers, missing, .. } =
            settings;
        let Conversion { backdrop, opacity, quality, strip, light: lobes, st_map, mips, remarks, .. } = settings;
        let named = [from, to].into_iter().flatten().flat_map(|spec| spec.files.iter().cloned());
        Self {
            geometry: digest(&(from, to, size, orientation, camera, in_path, blur, st_map)),
            filter: digest(&(filter, kernel, anti_ringing, lobes)),
            // Not how samples are packed, which changes none.
            colour: digest(&(
                (light.channels, light.depth, &light.transfer, light.background, &light.working),
                (in_transfer, in_primaries, ignore_profile, ocio, part, channels, layers, missing),
                (backdrop, opacity, quality, strip, mips, remarks),
            )),
            beside: named.chain(settings.geometry.pose_files()).collect(),
        }
    }

    /// Returns the origin of a frame, in words; `None` for a picture that is no frame.
    pub(crate) fn of_frame(&self, files: &dyn Files, input: &Input, frame: Option<u64>) -> Option<String> {
        let frame = frame?;
        let views = input.present().map(|(view, ..)| view.files.path(Some(frame)));
        let read: BTreeSet<PathBuf> = views.chain(self.beside.iter().cloned()).collect();
        let ends: Vec<Option<u64>> = read.iter().map(|path| ends(files, path)).collect();
        let Self { geometry, filter, colour, .. } = self;
        let input = digest(&ends);
        Some(format!("geometry {geometry:08x}, filter {filter:08x}, colour {colour:08x}, input {input:08x}"))
    }
}

/// Returns the part of an origin that is of settings alone, which frames of one run share.
pub(crate) fn settings_of(origin: &str) -> Option<&str> {
    Some(origin.rsplit_once(", input ")?.0)
}

/// Returns the names of the parts in which two origins differ.
pub(crate) fn differences(found: &str, expected: &str) -> Vec<String> {
    let parts = |origin: &str| -> Vec<String> { origin.split(", ").map(str::to_owned).collect() };
    let (found, expected) = (parts(found), parts(expected));
    let differ = expected.iter().filter(|part| !found.contains(part));
    differ.filter_map(|part| Some(part.split_once(' ')?.0.to_owned())).collect()
}

fn digest(value: &impl Debug) -> u32 {
    xxh3_64(format!("{value:?}").as_bytes()) as u32
}

/// Returns a digest of a file's length and of its ends; `None` if it cannot be read.
fn ends(files: &dyn Files, path: &Path) -> Option<u64> {
    let mut file = files.open(path).ok()?;
    let length = file.seek(SeekFrom::End(0)).ok()?;
    let mut bytes = length.to_le_bytes().to_vec();
    for start in [0, length.saturating_sub(ENDS)] {
        file.seek(SeekFrom::Start(start)).ok()?;
        (&mut file).take(ENDS).read_to_end(&mut bytes).ok()?;
    }
    Some(xxh3_64(&bytes))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::InMemory;

    #[test]
    fn what_differs_is_named() {
        let (one, other) = ("geometry 1, filter 2, colour 3, input 4", "geometry 1, filter 5, colour 3, input 6");
        assert_eq!(differences(one, one), Vec::<String>::new());
        assert_eq!(differences(one, other), ["filter", "input"]);
        assert_eq!(differences("", one), ["geometry", "filter", "colour", "input"]);
        assert_eq!((settings_of(one), settings_of("")), (Some("geometry 1, filter 2, colour 3"), None));
    }

    #[test]
    fn files_are_told_apart_by_length_and_ends() {
        let mut files = InMemory::default();
        let long = vec![7_u8; 1 << 18];
        files.insert("long", long.clone());
        files.insert("longer", [&long[..], &[7]].concat());
        files.insert("other", [&long[1..], &[8]].concat());
        files.insert("same", long);
        let of = |name: &str| ends(&files, Path::new(name));
        assert!(of("long").is_some() && of("long") == of("same"));
        assert!(of("long") != of("longer") && of("long") != of("other") && of("none").is_none());
    }
}
