use std::io::{BufRead, Seek};
use std::path::Path;

use cosmorama::raster::{Channels, Depth, FramePool, Samples};

use super::read::{decoded, open};
use crate::codec::{codec, recognise};
use crate::header::{Format, Header, ImageFile};
use crate::{IoError, Limits};

/// Values of an st map as in its file: two per pixel, s to the right and t up.
#[derive(Clone, Debug, PartialEq)]
pub struct StPairs {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Pairs row by row from the top; NaN where the canvas has no pixel in the file.
    pub pairs: Vec<[f32; 2]>,
}

impl StPairs {
    /// Returns the pair of the pixel in column `i` and row `j`.
    pub fn get(&self, i: usize, j: usize) -> [f32; 2] {
        self.pairs[j * self.width + i]
    }
}

/// Reads the header of an st map's file: like [`probe`](crate::probe), but for the channels that [`read_pairs`] reads.
///
/// # Errors
/// When an OpenEXR file has no such pair of channels, or [`probe`](crate::probe) fails.
pub fn probe_pairs(path: impl AsRef<Path>) -> Result<Header, IoError> {
    let path = path.as_ref();
    probe_pairs_from(open(path)?, path)
}

/// Reads the header of an st map in memory, or from any other reader. `name` is the file's name in messages.
///
/// # Errors
/// When reading fails, or [`probe_pairs`] fails.
pub fn probe_pairs_from(mut source: impl BufRead + Seek, name: impl AsRef<Path>) -> Result<Header, IoError> {
    let name = name.as_ref();
    let format = recognise(name, &mut source)?;
    Ok(decoded(name, format, || codec(name, format)?.probe_pairs(name, &mut source))?.upright())
}

/// Reads the two channels of an st map without decoding them. In OpenEXR files these are R and G, u and v, s and t, or
/// x and y, also in a layer. Integers are scaled to 0–1.
///
/// # Errors
/// When there are fewer than two channels or at most 8 bits, or [`read`](crate::read) fails.
pub fn read_pairs(path: impl AsRef<Path>, limits: &Limits) -> Result<StPairs, IoError> {
    let path = path.as_ref();
    read_pairs_from(open(path)?, path, limits)
}

/// Reads an st map in memory, or from any other reader, like [`read_pairs`]. `name` is the file's name in messages.
///
/// # Errors
/// When reading fails, or [`read_pairs`] fails.
pub fn read_pairs_from(
    mut source: impl BufRead + Seek,
    name: impl AsRef<Path>,
    limits: &Limits,
) -> Result<StPairs, IoError> {
    let path = name.as_ref();
    let format = recognise(path, &mut source)?;
    let file = decoded(path, format, || codec(path, format)?.decode_pairs(path, &mut source, limits))?;
    let file = file.upright(&FramePool::default());
    let count = file.image.channels().count();
    // Grey counts as one channel, with or without alpha, except in OpenEXR, where two channels make a pair.
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
