use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use cosmorama::raster::Transfer;
use cosmorama_io::pending::{Hidden, Pending, Unfinished};
use cosmorama_io::{Metadata, WriteOptions, svg, write_hidden};

/// Number of pixels of a PNG for each unit of its drawing.
const SCALE: f32 = 1.5;

/// Returns the files that a drawing goes to.
pub(crate) fn files(folder: &Path, name: &str) -> [PathBuf; 2] {
    ["svg", "png"].map(|extension| folder.join(format!("{name}.{extension}")))
}

/// Writes a drawing as `NAME.svg` and `NAME.png`; pictures that it refers to are found beside it. Both files stay
/// hidden until they are renamed.
pub(crate) fn draw(folder: &Path, name: &str, drawing: &str, unfinished: &Unfinished) -> Result<[Hidden; 2]> {
    let [vector, raster] = files(folder, name);
    let mut pending = Pending::create(&vector, unfinished)?;
    let written = pending.writer().write_all(drawing.as_bytes());
    written.with_context(|| format!("cannot write {}", vector.display()))?;
    let metadata = Metadata { transfer: Some(Transfer::Srgb), ..Metadata::default() };
    let options = WriteOptions { unfinished: unfinished.clone(), ..WriteOptions::with_metadata(metadata) };
    let image = svg::rasterise(drawing, SCALE, Some(folder)).context("cannot draw a diagram")?;
    Ok([pending.close()?, write_hidden(&raster, &image, &options)?])
}

/// Writes a drawing as both files, and returns their names.
pub(crate) fn save(folder: &Path, name: &str, drawing: &str, unfinished: &Unfinished) -> Result<[PathBuf; 2]> {
    for file in draw(folder, name, drawing, unfinished)? {
        file.appear()?;
    }
    Ok(files(folder, name))
}
