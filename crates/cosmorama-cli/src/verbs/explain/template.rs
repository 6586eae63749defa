//! Templates for those who paint the pictures of a world: guides as layers with alpha.

use std::path::{Path, PathBuf};

use anyhow::Result;
use cosmorama::camera::View;
use cosmorama::explain::Guide;
use cosmorama::raster::{Channels, Depth, EncodedImage, Transfer};
use cosmorama_convert::{GeometrySettings, Picture, refuse_existing};
use cosmorama_io::pending::Hidden;
use cosmorama_io::{Metadata, WriteOptions, write_hidden};

use crate::console::Console;
use crate::verbs::make_folder;

/// Writes the guides over each picture of an output into a folder: a file for each layer. Returns their names.
pub(super) fn write(
    folder: &Path,
    geometry: &GeometrySettings,
    overwrite: bool,
    console: &Console,
) -> Result<Vec<PathBuf>> {
    let pictures = Picture::planned(geometry)?;
    let views: Vec<View> = pictures.iter().map(|picture| picture.view.clone()).collect();
    let layers = || (0..views.len()).flat_map(|index| Guide::ALL.map(|guide| (index, guide)));
    let files: Vec<PathBuf> = layers().map(|(index, guide)| file(folder, &pictures[index], guide)).collect();
    if !overwrite {
        refuse_existing(files.iter().map(PathBuf::as_path))?;
    }
    let _folders = make_folder(folder, console)?;
    let metadata = Metadata { transfer: Some(Transfer::Srgb), ..Metadata::default() };
    let options = WriteOptions { unfinished: console.unfinished.clone(), ..WriteOptions::with_metadata(metadata) };
    let mut drawn: Vec<Hidden> = Vec::new();
    for ((index, guide), path) in layers().zip(&files) {
        let layer = guide.picture(&views, index);
        let encoded = EncodedImage::encode(&layer, Channels::Rgba, Depth::Eight, &Transfer::Srgb);
        drawn.push(write_hidden(path, &[encoded], &options)?);
    }
    // All layers, or none.
    Hidden::appear_all(drawn)?;
    Ok(files)
}

fn file(folder: &Path, picture: &Picture, guide: Guide) -> PathBuf {
    let name = picture.label().map_or_else(|| guide.name().to_owned(), |label| format!("{label}-{}", guide.name()));
    folder.join(name).with_extension("png")
}
