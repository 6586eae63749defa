use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use cosmorama_io::pending::{Hidden, Pending, Unfinished};

/// Extensions of a drawing's files. A build without the feature `diagrams` draws no pixels.
const EXTENSIONS: &[&str] = if cfg!(feature = "diagrams") { &["svg", "png"] } else { &["svg"] };

/// Returns the files that a drawing goes to.
pub(crate) fn files(folder: &Path, name: &str) -> Vec<PathBuf> {
    EXTENSIONS.iter().map(|extension| folder.join(format!("{name}.{extension}"))).collect()
}

/// Writes a drawing as `NAME.svg` and `NAME.png`; pictures that it refers to are found beside it. Both files stay
/// hidden until they are renamed.
pub(crate) fn draw(folder: &Path, name: &str, drawing: &str, unfinished: &Unfinished) -> Result<Vec<Hidden>> {
    let vector = folder.join(format!("{name}.svg"));
    let mut pending = Pending::create(&vector, unfinished)?;
    let written = pending.writer().write_all(drawing.as_bytes());
    written.with_context(|| format!("cannot write {}", vector.display()))?;
    let vector = pending.close()?;
    let raster = pixels::draw(folder, name, drawing, unfinished)?;
    Ok([vector].into_iter().chain(raster).collect())
}

/// Writes a drawing as [`draw`] does, and returns the files' names.
pub(crate) fn save(folder: &Path, name: &str, drawing: &str, unfinished: &Unfinished) -> Result<Vec<PathBuf>> {
    Hidden::appear_all(draw(folder, name, drawing, unfinished)?)?;
    Ok(files(folder, name))
}

/// Drawings as PNG.
#[cfg(feature = "diagrams")]
mod pixels {
    use std::path::Path;

    use anyhow::{Context, Result};
    use cosmorama::raster::Transfer;
    use cosmorama_io::pending::{Hidden, Unfinished};
    use cosmorama_io::{Metadata, WriteOptions, svg, write_hidden};

    /// Number of pixels of a PNG for each unit of its drawing.
    const SCALE: f32 = 1.5;

    pub(super) fn draw(folder: &Path, name: &str, drawing: &str, unfinished: &Unfinished) -> Result<Option<Hidden>> {
        let metadata = Metadata { transfer: Some(Transfer::Srgb), ..Metadata::default() };
        let options = WriteOptions { unfinished: unfinished.clone(), ..WriteOptions::with_metadata(metadata) };
        let image = svg::rasterise(drawing, SCALE, Some(folder)).context("cannot draw a diagram")?;
        Ok(Some(write_hidden(folder.join(format!("{name}.png")), &[image], &options)?))
    }
}

/// Stands in for the drawing of pixels: there are none.
#[cfg(not(feature = "diagrams"))]
mod pixels {
    use std::path::Path;

    use anyhow::Result;
    use cosmorama_io::pending::{Hidden, Unfinished};

    pub(super) fn draw(_: &Path, _: &str, _: &str, _: &Unfinished) -> Result<Option<Hidden>> {
        Ok(None)
    }
}
