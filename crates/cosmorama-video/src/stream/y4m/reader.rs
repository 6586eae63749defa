use std::io::BufRead;

use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};
use rayon::prelude::*;

use super::header::{FRAME, parse};
use super::planes::Plane;
use super::{Subsampling, Y4mFormat};
use crate::VideoError;
use crate::colour::Coding;
use crate::stream::input::Input;

/// Reader of YUV4MPEG2. Frames are RGB of 8 bits, or of 16 for more; grey ones are grey.
#[derive(Debug)]
pub struct Y4mReader<R> {
    input: Input<R>,
    format: Y4mFormat,
    coding: Coding,
}

/// Bytes of the first line, and of a frame's.
const LONGEST_LINE: usize = 1024;

/// Planes of a frame as floats, with their codes.
struct Planes {
    luma: Vec<f32>,
    blue: Vec<f32>,
    red: Vec<f32>,
    alpha: Vec<f32>,
}

impl<R: BufRead> Y4mReader<R> {
    /// Reads the stream's first line. `name` is for messages; a frame may take `memory` bytes.
    ///
    /// # Errors
    /// When it is no YUV4MPEG2, is interlaced, or its frames are larger than permitted.
    pub fn new(source: R, name: &str, memory: u64) -> Result<Self, VideoError> {
        let mut input = Input::new(source, name, memory);
        let line = input.line(LONGEST_LINE)?;
        let format = parse(&line).map_err(|reason| input.fault(reason))?;
        // Codes as floats, and the picture.
        input.check(format.size, 4 * size_of::<f32>() + 8)?;
        let coding = Coding::new(format.matrix, format.range, format.bits);
        let coding = coding.ok_or_else(|| input.fault("its matrix is not known"))?;
        Ok(Self { input, format, coding })
    }

    /// Returns the format.
    pub fn format(&self) -> &Y4mFormat {
        &self.format
    }

    /// Chooses another matrix than the usual one of the size.
    ///
    /// # Errors
    /// When H.273 has no such matrix of three weights.
    pub fn set_matrix(&mut self, matrix: u8) -> Result<(), VideoError> {
        let coding = Coding::new(matrix, self.format.range, self.format.bits);
        let unknown =
            || self.input.fault(format!("{matrix} is no matrix from YUV to RGB; expected 1, 4, 5, 6, 7 or 9"));
        self.coding = coding.ok_or_else(unknown)?;
        self.format.matrix = matrix;
        Ok(())
    }

    /// Returns the next frame; `None` at the end of the stream.
    ///
    /// # Errors
    /// When the stream ends within a frame, or something else is between two.
    pub fn next_frame(&mut self) -> Result<Option<EncodedImage>, VideoError> {
        if self.input.is_over()? {
            return Ok(None);
        }
        let line = self.input.line(LONGEST_LINE)?;
        if line.split(' ').next() != Some(FRAME) {
            return Err(self.input.fault(format!("there is something else before it; expected {FRAME}")));
        }
        let planes = self.planes()?;
        let (width, height) = self.format.size;
        let channels = match self.format.subsampling {
            Subsampling::Grey => Channels::Grey,
            Subsampling::C444Alpha => Channels::Rgba,
            _ => Channels::Rgb,
        };
        let (depth, samples) = if self.format.bits > 8 {
            (Depth::Sixteen, Samples::U16(self.pixels(&planes, channels, 65535.0, |value| value as u16)))
        } else {
            (Depth::Eight, Samples::U8(self.pixels(&planes, channels, 255.0, |value| value as u8)))
        };
        let image = EncodedImage::new(width, height, channels, depth, samples);
        self.input.frame += 1;
        image.map(Some).map_err(|error| self.input.fault(error.to_string()))
    }

    fn planes(&mut self) -> Result<Planes, VideoError> {
        let (width, height) = self.format.size;
        let (columns, rows) = self.format.chroma_size();
        let luma = self.plane(width * height)?;
        let (blue, red) = (self.plane(columns * rows)?, self.plane(columns * rows)?);
        let has_alpha = self.format.subsampling == Subsampling::C444Alpha;
        let alpha = self.plane(if has_alpha { width * height } else { 0 })?;
        Ok(Planes { luma, blue, red, alpha })
    }

    fn plane(&mut self, count: usize) -> Result<Vec<f32>, VideoError> {
        let mut bytes = vec![0; count * self.format.sample_bytes()];
        self.input.fill(&mut bytes)?;
        Ok(match self.format.sample_bytes() {
            1 => bytes.into_iter().map(f32::from).collect(),
            _ => bytes.chunks_exact(2).map(|pair| f32::from(u16::from_le_bytes([pair[0], pair[1]]))).collect(),
        })
    }

    /// Returns the pixels, row by row; each depends on the planes alone.
    fn pixels<S: Copy + Default + Send>(
        &self,
        planes: &Planes,
        channels: Channels,
        white: f32,
        code: impl Fn(f32) -> S + Sync,
    ) -> Vec<S> {
        let (width, height) = self.format.size;
        let (columns, rows) = self.format.chroma_size();
        let chroma = |samples| Plane { samples, width: columns, height: rows };
        let (blue, red) = (chroma(&planes.blue), chroma(&planes.red));
        let nearest = |value: f32| code((value * white).round().clamp(0.0, white));
        // What threads share is no part of the stream.
        let (subsampling, coding) = (self.format.subsampling, self.coding);
        let mut samples = vec![S::default(); width * height * channels.count()];
        samples.par_chunks_exact_mut(width * channels.count()).enumerate().for_each(|(j, row)| {
            let luma = &planes.luma[j * width..(j + 1) * width];
            if channels == Channels::Grey {
                row.iter_mut().zip(luma).for_each(|(sample, y)| *sample = nearest(coding.grey(*y)));
                return;
            }
            let (mut u, mut v, mut mixed) = (vec![0.0; width], vec![0.0; width], Vec::new());
            blue.fill_row(subsampling, j, &mut u, &mut mixed);
            red.fill_row(subsampling, j, &mut v, &mut mixed);
            for (i, pixel) in row.chunks_exact_mut(channels.count()).enumerate() {
                let rgb = coding.rgb([luma[i], u[i], v[i]]);
                pixel.iter_mut().zip(rgb).for_each(|(sample, value)| *sample = nearest(value));
                if let [_, _, _, alpha] = pixel {
                    // Of full range, whatever the range of colours.
                    *alpha = nearest(planes.alpha[j * width + i] / 255.0);
                }
            }
        });
        samples
    }
}
