//! Netpbm's pictures, one behind the other: PGM (P5), PPM (P6) and PAM (P7) of 8 or 16 bits.

use std::io::{BufRead, Write};

use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};

use super::input::Input;
use super::output::Output;
use crate::VideoError;

/// Reader of pictures in PGM, PPM or PAM, all alike, one behind the other.
#[derive(Debug)]
pub struct PamReader<R> {
    input: Input<R>,
    first: Option<Header>,
}

/// Header of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Header {
    size: (usize, usize),
    channels: Channels,
    /// Code of white.
    most: u16,
}

/// Bytes of a line in the header of a PAM.
const LONGEST_LINE: usize = 256;

/// Lines of the header of a PAM.
const MOST_LINES: usize = 64;

impl<R: BufRead> PamReader<R> {
    /// Creates a reader. `name` is for messages; a frame may take `memory` bytes.
    pub fn new(source: R, name: &str, memory: u64) -> Self {
        Self { input: Input::new(source, name, memory), first: None }
    }

    /// Returns the next picture; `None` at the end of the stream. Values below the greatest of 8 or 16 bits are scaled to it.
    ///
    /// # Errors
    /// When the stream ends within a picture, a header is damaged, a picture is larger than permitted, or unlike the first.
    pub fn next_frame(&mut self) -> Result<Option<EncodedImage>, VideoError> {
        if self.input.is_over()? {
            return Ok(None);
        }
        let header = self.header()?;
        let Header { size: (width, height), channels, most } = header;
        let depth = if most > 255 { Depth::Sixteen } else { Depth::Eight };
        self.input.check(header.size, channels.count() * depth.bytes())?;
        if *self.first.get_or_insert(header) != header {
            return Err(self
                .input
                .fault("it is of another size or kind than the first; expected pictures that are alike"));
        }
        let count = width * height * channels.count();
        let samples = if depth == Depth::Eight { self.bytes(count, most)? } else { self.words(count, most)? };
        let image = EncodedImage::new(width, height, channels, depth, samples);
        self.input.frame += 1;
        image.map(Some).map_err(|error| self.input.fault(error.to_string()))
    }

    fn bytes(&mut self, count: usize, most: u16) -> Result<Samples, VideoError> {
        let mut samples = vec![0_u8; count];
        self.input.fill(&mut samples)?;
        self.check_greatest(samples.iter().copied().max().map(u16::from), most)?;
        if most < 255 {
            let scaled = |sample: u8| ((u32::from(sample) * 255 + u32::from(most) / 2) / u32::from(most)) as u8;
            samples.iter_mut().for_each(|sample| *sample = scaled(*sample));
        }
        Ok(Samples::U8(samples))
    }

    fn words(&mut self, count: usize, most: u16) -> Result<Samples, VideoError> {
        let mut samples = vec![0_u16; count];
        self.input.fill(bytemuck::cast_slice_mut(&mut samples))?;
        samples.iter_mut().for_each(|sample| *sample = u16::from_be(*sample));
        self.check_greatest(samples.iter().copied().max(), most)?;
        if most < u16::MAX {
            let scaled = |sample: u16| ((u32::from(sample) * 65535 + u32::from(most) / 2) / u32::from(most)) as u16;
            samples.iter_mut().for_each(|sample| *sample = scaled(*sample));
        }
        Ok(Samples::U16(samples))
    }

    fn check_greatest(&self, greatest: Option<u16>, most: u16) -> Result<(), VideoError> {
        match greatest {
            Some(greatest) if greatest > most => Err(self
                .input
                .fault(format!("it has the value {greatest}; expected at most {most}, as its header says"))),
            _ => Ok(()),
        }
    }

    fn header(&mut self) -> Result<Header, VideoError> {
        let magic = self.input.word()?;
        let (size, planes, most) = match magic.as_str() {
            "P5" | "P6" => {
                let size = (self.input.number("width")?, self.input.number("height")?);
                (size, if magic == "P5" { 1 } else { 3 }, self.input.number("greatest value")?)
            }
            "P7" => self.fields()?,
            other => {
                return Err(self
                    .input
                    .fault(format!("it begins with {}; expected P5, P6 or P7", other.escape_debug())));
            }
        };
        let channels = match planes {
            1 => Channels::Grey,
            2 => Channels::GreyAlpha,
            3 => Channels::Rgb,
            4 => Channels::Rgba,
            other => return Err(self.input.fault(format!("it has {other} channels; expected 1 to 4"))),
        };
        match u16::try_from(most) {
            Ok(most @ 1..) => Ok(Header { size, channels, most }),
            _ => Err(self.input.fault(format!("its greatest value is {most}; expected 1 to 65535"))),
        }
    }

    /// Reads the lines of a PAM's header: size, channels and greatest value.
    fn fields(&mut self) -> Result<((usize, usize), usize, usize), VideoError> {
        let (mut width, mut height, mut planes, mut most) = (0, 0, 0, 0);
        for _ in 0..MOST_LINES {
            let line = self.input.line(LONGEST_LINE)?;
            let (name, value) = line.trim().split_once(char::is_whitespace).unwrap_or((line.trim(), ""));
            let field = match name {
                "ENDHDR" => return Ok(((width, height), planes, most)),
                "WIDTH" => &mut width,
                "HEIGHT" => &mut height,
                "DEPTH" => &mut planes,
                "MAXVAL" => &mut most,
                // The number of channels tells what they are.
                _ => continue,
            };
            *field = value
                .trim()
                .parse()
                .map_err(|_| self.input.fault(format!("its {name} is {}; expected a number", value.escape_debug())))?;
        }
        Err(self.input.fault(format!("its header has more than {MOST_LINES} lines; expected ENDHDR")))
    }
}

/// Writer of pictures in PAM (P7), one behind the other.
#[derive(Debug)]
pub struct PamWriter<W> {
    output: Output<W>,
}

impl<W: Write> PamWriter<W> {
    /// Creates a writer. `name` is for messages.
    pub fn new(sink: W, name: &str) -> Self {
        Self { output: Output::new(sink, name) }
    }

    /// Writes a picture of 8 bits, or of 10 to 16, which become 16.
    ///
    /// # Errors
    /// When the picture has floats, or nothing can be written.
    pub fn write(&mut self, frame: &EncodedImage) -> Result<(), VideoError> {
        let (most, kind) = (if frame.depth() == Depth::Eight { 255 } else { 65535 }, kind(frame.channels()));
        let (width, height, planes) = (frame.width(), frame.height(), frame.channels().count());
        let header =
            format!("P7\nWIDTH {width}\nHEIGHT {height}\nDEPTH {planes}\nMAXVAL {most}\nTUPLTYPE {kind}\nENDHDR\n");
        match frame.samples() {
            Samples::U8(samples) => {
                self.output.write(header.as_bytes())?;
                self.output.write(samples)?;
            }
            Samples::U16(samples) => {
                self.output.write(header.as_bytes())?;
                let bytes: Vec<u8> = samples.iter().flat_map(|sample| sample.to_be_bytes()).collect();
                self.output.write(&bytes)?;
            }
            Samples::Half(_) | Samples::Float(_) => {
                return Err(self.output.wrong(format!("has depth {}", frame.depth()), "integers; PFM holds floats"));
            }
        }
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

fn kind(channels: Channels) -> &'static str {
    match channels {
        Channels::Grey => "GRAYSCALE",
        Channels::GreyAlpha => "GRAYSCALE_ALPHA",
        Channels::Rgb => "RGB",
        Channels::Rgba => "RGB_ALPHA",
    }
}
