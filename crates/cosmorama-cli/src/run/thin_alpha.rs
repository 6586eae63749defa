use std::collections::BTreeMap;
use std::path::PathBuf;

use super::frame_light::FrameLight;
use crate::job::{ConvertJob, ThinAlpha};

/// What should be known of files of a frame in which no pixel has full alpha.
pub(super) fn warnings(job: &ConvertJob, frame: Option<u64>, light: &FrameLight) -> Vec<String> {
    if !job.light.input_alpha {
        return Vec::new();
    }
    // A file may hold several views, of which some may be thin.
    let mut files: BTreeMap<PathBuf, Option<ThinAlpha>> = BTreeMap::new();
    let worlds = job.worlds.iter().enumerate();
    let sources = worlds.flat_map(|(index, world)| world.sources().iter().map(move |source| (index, source)));
    for ((view, header, _), (world, source)) in job.input.present().zip(sources) {
        let path = view.files.path(frame);
        let known = files.get(&path).copied();
        if !header.channels.has_alpha() || known == Some(None) {
            continue;
        }
        let texels = source.offset..source.offset + source.texels().len();
        let found = ThinAlpha::of(texels.map(|texel| light.texels().rgba(world, texel)));
        let both = found.map(|found| known.flatten().map_or(found, |known| known.with(found)));
        files.insert(path, both);
    }
    let told = |(path, alpha): (PathBuf, Option<ThinAlpha>)| Some(format!("{}: {}", path.display(), alpha?.told()?));
    files.into_iter().filter_map(told).collect()
}
