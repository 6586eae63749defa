use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use cosmorama::raster::{Channels, Depth, EncodedImage, Samples, Transfer};
use cosmorama_io::pending::Pending;
use cosmorama_io::{Metadata, WriteOptions, write};
use resvg::{tiny_skia, usvg};

/// Pixels of a PNG for each unit of its drawing.
const SCALE: f32 = 1.5;

/// Writes a drawing as `NAME.svg` and `NAME.png`; pictures that it refers to are found beside it.
pub(super) fn save(folder: &Path, name: &str, svg: &str) -> Result<[PathBuf; 2]> {
    let vector = folder.join(format!("{name}.svg"));
    let mut pending = Pending::create(&vector)?;
    let written = pending.writer().write_all(svg.as_bytes());
    written.with_context(|| format!("cannot write {}", vector.display()))?;
    pending.finish()?;
    let raster = folder.join(format!("{name}.png"));
    let metadata = Metadata { transfer: Some(Transfer::Srgb), ..Metadata::default() };
    write(&raster, &rasterize(svg, folder)?, &metadata, &WriteOptions::default())?;
    Ok([vector, raster])
}

/// The drawing in pixels. Its letters are drawn lines, so no font is needed.
fn rasterize(svg: &str, folder: &Path) -> Result<EncodedImage> {
    let options = usvg::Options { resources_dir: Some(folder.to_owned()), ..usvg::Options::default() };
    let tree = usvg::Tree::from_str(svg, &options).context("cannot draw a diagram")?;
    let size = tree.size().to_int_size().scale_by(SCALE).context("a diagram has no size")?;
    let mut pixels = tiny_skia::Pixmap::new(size.width(), size.height()).context("a diagram is too large")?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(SCALE, SCALE), &mut pixels.as_mut());
    // Diagrams have opaque paper, so premultiplied colour is colour.
    let samples = pixels.data().chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    let (width, height) = (size.width() as usize, size.height() as usize);
    Ok(EncodedImage::new(width, height, Channels::Rgb, Depth::Eight, Samples::U8(samples))?)
}
