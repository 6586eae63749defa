//! Portable float maps (PF, Pf), one behind the other: light as 32-bit floats, rows from below.

use std::io::{BufRead, Write};

use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};

use super::input::Input;
use super::output::Output;
use crate::VideoError;

/// Order of the bytes of a float.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ByteOrder {
    /// Least significant byte first.
    #[default]
    Little,
    /// Most significant byte first.
    Big,
}

/// Reader of portable float maps, all alike, one behind the other.
#[derive(Debug)]
pub struct PfmReader<R> {
    input: Input<R>,
    first: Option<((usize, usize), Channels)>,
}

impl<R: BufRead> PfmReader<R> {
    /// Creates a reader. `name` is for messages; a frame may take `memory` bytes.
    pub fn new(source: R, name: &str, memory: u64) -> Self {
        Self { input: Input::new(source, name, memory), first: None }
    }

    /// Returns the next picture, grey or RGB floats; `None` at the end of the stream. Values are multiplied by the header's scale.
    ///
    /// # Errors
    /// When the stream ends within a picture, a header is damaged, a picture is larger than permitted, or unlike the first.
    pub fn next_frame(&mut self) -> Result<Option<EncodedImage>, VideoError> {
        if self.input.is_over()? {
            return Ok(None);
        }
        let channels = match self.input.word()?.as_str() {
            "PF" => Channels::Rgb,
            "Pf" => Channels::Grey,
            other => {
                return Err(self.input.fault(format!("it begins with {}; expected PF or Pf", other.escape_debug())));
            }
        };
        let size = (self.input.number("width")?, self.input.number("height")?);
        let word = self.input.word()?;
        let scale = word.parse::<f32>().ok().filter(|scale| scale.is_normal());
        let scale =
            scale.ok_or_else(|| self.input.fault(format!("its scale is {word}; expected a number that is not 0")))?;
        self.input.check(size, channels.count() * Depth::Float.bytes())?;
        if *self.first.get_or_insert((size, channels)) != (size, channels) {
            return Err(self
                .input
                .fault("it is of another size or kind than the first; expected pictures that are alike"));
        }
        let samples = self.samples(size, channels, scale)?;
        let image = EncodedImage::new(size.0, size.1, channels, Depth::Float, Samples::Float(samples));
        self.input.frame += 1;
        image.map(Some).map_err(|error| self.input.fault(error.to_string()))
    }

    /// Reads the rows, of which the lowest comes first. A scale below zero means that the least significant byte does.
    fn samples(
        &mut self,
        (width, height): (usize, usize),
        channels: Channels,
        scale: f32,
    ) -> Result<Vec<f32>, VideoError> {
        let row = width * channels.count();
        let mut samples = vec![0.0_f32; row * height];
        for row in samples.rchunks_exact_mut(row) {
            self.input.fill(bytemuck::cast_slice_mut(row))?;
            for sample in row {
                let bits = sample.to_bits();
                let bits = if scale < 0.0 { u32::from_le(bits) } else { u32::from_be(bits) };
                *sample = f32::from_bits(bits) * scale.abs();
            }
        }
        Ok(samples)
    }
}

/// Writer of portable float maps, one behind the other.
#[derive(Debug)]
pub struct PfmWriter<W> {
    output: Output<W>,
    order: ByteOrder,
}

impl<W: Write> PfmWriter<W> {
    /// Creates a writer. `name` is for messages.
    pub fn new(sink: W, name: &str, order: ByteOrder) -> Self {
        Self { output: Output::new(sink, name), order }
    }

    /// Writes a picture of grey or RGB floats.
    ///
    /// # Errors
    /// When the picture has integers or an alpha, or nothing can be written.
    pub fn write(&mut self, frame: &EncodedImage) -> Result<(), VideoError> {
        let (channels, depth) = (frame.channels(), frame.depth());
        let wrong = || self.output.wrong(format!("is {channels}, depth {depth}"), "grey or RGB, depth float");
        let (Samples::Float(samples), false) = (frame.samples(), channels.has_alpha()) else { return Err(wrong()) };
        let magic = if channels.is_colour() { "PF" } else { "Pf" };
        let scale = if self.order == ByteOrder::Little { "-1.0" } else { "1.0" };
        let mut bytes = format!("{magic}\n{} {}\n{scale}\n", frame.width(), frame.height()).into_bytes();
        for row in samples.rchunks_exact(frame.width() * channels.count()) {
            match self.order {
                ByteOrder::Little => bytes.extend(row.iter().flat_map(|sample| sample.to_le_bytes())),
                ByteOrder::Big => bytes.extend(row.iter().flat_map(|sample| sample.to_be_bytes())),
            }
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
}
