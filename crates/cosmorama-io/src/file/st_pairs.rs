use std::path::Path;

use cosmorama::raster::{Channels, Depth, Samples};

use super::open;
use crate::codec::exr;
use crate::{Format, Header, ImageFile, IoError, Limits, probe, read};

/// The numbers of an st map as its file has them: two a pixel, s to the right and t up.
#[derive(Clone, Debug, PartialEq)]
pub struct StPairs {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Row by row from the top; not numbers where the file holds no pixel of its canvas.
    pub pairs: Vec<[f32; 2]>,
}

impl StPairs {
    /// That of a pixel.
    pub fn get(&self, i: usize, j: usize) -> [f32; 2] {
        self.pairs[j * self.width + i]
    }
}

/// What a file says of its st map before its numbers: as [`probe`], but of the channels that [`read_pairs`] reads.
///
/// # Errors
/// When an OpenEXR file has no two such channels, and those of [`probe`].
pub fn probe_pairs(path: &Path) -> Result<Header, IoError> {
    let (format, mut source) = open(path)?;
    if format == Format::Exr { exr::probe_pairs(path, &mut source) } else { probe(path) }
}

/// Reads the first two channels of a picture as they are: of OpenEXR files R and G, or what else such maps are called (u and
/// v, s and t, x and y, also in a layer); integers as parts of their greatest value.
///
/// # Errors
/// When there are not two channels or no more than 8 bits, and those of [`read`].
pub fn read_pairs(path: &Path, limits: &Limits) -> Result<StPairs, IoError> {
    let (format, mut source) = open(path)?;
    let file = if format == Format::Exr { exr::read_pairs(path, &mut source, limits)? } else { read(path, limits)? };
    let count = file.image.channels().count();
    // Grey, with or without alpha; the two channels of an OpenEXR file are counted alike.
    if !file.image.channels().is_colour() && format != Format::Exr {
        let found = file.image.channels().to_string();
        return Err(IoError::unsupported(path, format, found, "two channels or more: s in the first, t in the second"));
    }
    let ImageFile { image, window, .. } = file;
    let (width, height) = (image.width(), image.height());
    let first_two = |numbers: Vec<f32>| numbers.chunks_exact(count).map(|pixel| [pixel[0], pixel[1]]).collect();
    let greatest = f32::from(u16::MAX);
    let pairs: Vec<[f32; 2]> = first_two(match image.into_samples() {
        Samples::U8(_) => {
            return Err(IoError::unsupported(
                path,
                format,
                "8 bits",
                "an st map of 16 bits or more, 32-bit floats at best",
            ));
        }
        Samples::U16(samples) => samples.into_iter().map(|sample| f32::from(sample) / greatest).collect(),
        Samples::Half(samples) => samples.into_iter().map(f32::from).collect(),
        Samples::Float(samples) => samples,
    });
    let Some(window) = window else { return Ok(StPairs { width, height, pairs }) };
    let (columns, rows) = (window.canvas_width, window.canvas_height);
    limits.check(path, (columns as u64, rows as u64), Channels::GreyAlpha, Depth::Float)?;
    let mut canvas = vec![[f32::NAN; 2]; columns * rows];
    for (j, row) in pairs.chunks_exact(width).enumerate() {
        canvas[(window.y + j) * columns + window.x..][..width].copy_from_slice(row);
    }
    Ok(StPairs { width: columns, height: rows, pairs: canvas })
}
