use std::io::Write;

use cosmorama::raster::{Channels, EncodedImage, Samples};
use rayon::prelude::*;

use super::header::{FRAME, line};
use super::planes::Plane;
use super::{Subsampling, Y4mFormat};
use crate::VideoError;
use crate::colour::Coding;
use crate::stream::output::Output;

/// Writer of YUV4MPEG2.
#[derive(Debug)]
pub struct Y4mWriter<W> {
    output: Output<W>,
    format: Y4mFormat,
    coding: Coding,
}

impl<W: Write> Y4mWriter<W> {
    /// Writes the stream's first line.
    ///
    /// # Errors
    /// When nothing can be written, or the format has no name.
    pub fn new(sink: W, name: &str, format: Y4mFormat) -> Result<Self, VideoError> {
        let mut output = Output::new(sink, name);
        let coding = Coding::new(format.matrix, format.range, format.bits.clamp(8, 16));
        let (Some(line), Some(coding)) = (line(&format), coding) else {
            let found = format!("is to have {} bits, {:?}, matrix {}", format.bits, format.subsampling, format.matrix);
            let expected = "8, 10, 12 or 16 bits, with C420mpeg2, C422, C444 or grey; C420jpeg and alpha with 8 bits; matrix 1, 4, 5, 6, 7 \
                            or 9";
            return Err(output.wrong(found, expected));
        };
        output.write(line.as_bytes())?;
        Ok(Self { output, format, coding })
    }

    /// Writes a frame: RGB or grey integers of 8 to 16 bits.
    ///
    /// # Errors
    /// When the frame is of another size, has floats, or an alpha that the format has no room for; or nothing can be written.
    pub fn write(&mut self, frame: &EncodedImage) -> Result<(), VideoError> {
        self.check(frame)?;
        let values = match frame.samples() {
            Samples::U8(samples) => samples.par_iter().map(|sample| f32::from(*sample) / 255.0).collect(),
            Samples::U16(samples) => samples.par_iter().map(|sample| f32::from(*sample) / 65535.0).collect(),
            Samples::Half(_) | Samples::Float(_) => Vec::new(),
        };
        let planes = self.planes(&values, frame.channels());
        let codes = planes.iter().flatten();
        let mut bytes = format!("{FRAME}\n").into_bytes();
        match self.format.sample_bytes() {
            1 => bytes.extend(codes.map(|code| *code as u8)),
            _ => bytes.extend(codes.flat_map(|code| code.to_le_bytes())),
        }
        self.output.write(&bytes)?;
        self.output.end_frame()
    }

    /// Writes what is left in buffers.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn finish(self) -> Result<W, VideoError> {
        self.output.finish()
    }

    fn check(&self, frame: &EncodedImage) -> Result<(), VideoError> {
        let (channels, depth) = (frame.channels(), frame.depth());
        let has_room = self.format.subsampling == Subsampling::C444Alpha;
        let is_grey = self.format.subsampling == Subsampling::Grey;
        let is_right = (frame.width(), frame.height()) == self.format.size
            && !depth.is_float()
            && channels.has_alpha() == has_room
            && (!is_grey || channels == Channels::Grey);
        if is_right {
            return Ok(());
        }
        let (width, height) = self.format.size;
        let kind = if is_grey { "grey" } else { "RGB or grey" };
        let alpha = if has_room { " with alpha" } else { " without alpha" };
        let found = format!("has {}x{} pixels, {channels}, depth {depth}", frame.width(), frame.height());
        Err(self.output.wrong(found, format!("{width}x{height} pixels, {kind}{alpha}, integers")))
    }

    /// Returns the codes of each plane.
    fn planes(&self, values: &[f32], channels: Channels) -> Vec<Vec<u16>> {
        let (count, coding) = (channels.count(), self.coding);
        let pixels = values.par_chunks_exact(count);
        let yuv = pixels.map(|pixel| match *pixel {
            [red, green, blue, ..] => coding.yuv([red, green, blue]),
            [grey, ..] => coding.yuv([grey; 3]),
            [] => [0.0; 3],
        });
        let yuv = yuv.collect::<Vec<_>>();
        let luma = yuv.par_iter().map(|[y, ..]| coding.code(*y)).collect();
        let mut planes = vec![luma];
        if self.format.subsampling == Subsampling::Grey {
            return planes;
        }
        for axis in 1..3 {
            let samples = yuv.par_iter().map(|codes| codes[axis]).collect::<Vec<_>>();
            planes.push(self.thinned(&samples));
        }
        if self.format.subsampling == Subsampling::C444Alpha {
            planes
                .push(values.par_chunks_exact(count).map(|pixel| (pixel[count - 1] * 255.0).round() as u16).collect());
        }
        planes
    }

    fn thinned(&self, samples: &[f32]) -> Vec<u16> {
        let (width, height) = self.format.size;
        let (columns, rows) = self.format.chroma_size();
        let (subsampling, coding) = (self.format.subsampling, self.coding);
        let plane = Plane { samples, width, height };
        let at = |at: usize| plane.thinned(subsampling, at % columns, at / columns);
        (0..columns * rows).into_par_iter().map(|index| coding.code(at(index))).collect()
    }
}

#[cfg(test)]
mod tests {
    use cosmorama::raster::Depth;

    use super::*;
    use crate::Ratio;

    #[test]
    fn unnamed_formats_and_other_frames_are_refused() {
        let format = Y4mFormat::new((2, 2), Ratio::ONE);
        let deep = Y4mFormat { bits: 10, subsampling: Subsampling::Jpeg420, ..format };
        assert!(Y4mWriter::new(Vec::new(), "out", deep).is_err());
        assert!(Y4mWriter::new(Vec::new(), "out", Y4mFormat { matrix: 8, ..format }).is_err());
        let mut writer = Y4mWriter::new(Vec::new(), "out", format).unwrap();
        let rgba = EncodedImage::new(2, 2, Channels::Rgba, Depth::Eight, Samples::U8(vec![0; 16])).unwrap();
        let error = writer.write(&rgba).unwrap_err().to_string();
        assert!(error.contains("without alpha"), "{error}");
    }
}
