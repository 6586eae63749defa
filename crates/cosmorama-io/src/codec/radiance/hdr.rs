use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use cosmorama::raster::{Channels, Depth, EncodedImage, FramePool, Primaries, Samples, Transfer};

use super::rgbe::{self, Rgbe};
use crate::codec::behind::{next_bytes, skip_padding};
use crate::codec::interface::{Codec, Density, Sink, Source, length, whole_image};
use crate::header::Picture;
use crate::{Choice, Format, Header, ImageFile, IoError, Limits, MadeRows, Metadata, WriteOptions};

const FORMAT: Format = Format::Hdr;

/// First bytes of every file.
const MARK: [u8; 2] = *b"#?";

/// Number of bytes of pixels that are read at once.
const BUFFER: usize = 1 << 16;

/// Bytes of a pixel.
const PIXEL: u128 = size_of::<Rgbe>() as u128;

/// Greatest length of a header line.
const LONGEST_LINE: u64 = 4096;
/// Greatest number of header lines.
const MOST_LINES: usize = 1024;

/// Returns the density of pixels: a run may fill a row, which has at least one pixel of four bytes.
fn density(header: &Header) -> Density {
    Density::pixels(header.width.div_ceil(4) as u64)
}

/// Codec of Radiance RGBE.
pub(crate) struct Hdr;

impl Codec for Hdr {
    fn probe(&self, path: &Path, source: Source<'_>) -> Result<Header, IoError> {
        let bytes = length(path, &mut *source)?;
        let Preamble { header, .. } = Preamble::read(path, source)?;
        header.check_density(path, density(&header), bytes)?;
        Ok(header)
    }

    fn decode(&self, path: &Path, source: Source<'_>, limits: &Limits, pool: &FramePool) -> Result<ImageFile, IoError> {
        let bytes = length(path, &mut *source)?;
        let Preamble { header, exposure, upside_down } = Preamble::read(path, &mut *source)?;
        limits.check(path, (header.width as u64, header.height as u64), header.channels, header.depth)?;
        header.check_density(path, density(&header), bytes)?;
        let mut samples = pool.take::<f32>(header.width * header.height * 3);
        each_line(path, source, &header, |j, line| {
            let row = if upside_down { header.height - 1 - j } else { j };
            let row = &mut samples[row * header.width * 3..][..header.width * 3];
            for (sample, pixel) in row.chunks_exact_mut(3).zip(line) {
                sample.copy_from_slice(&rgbe::decode(*pixel).map(|light| light / exposure));
            }
        })?;
        whole_image(path, header, Samples::Float(samples))
    }

    fn check_chosen(&self, path: &Path, source: Source<'_>, limits: &Limits, _: &Choice) -> Result<(), IoError> {
        let Preamble { header, .. } = Preamble::read(path, &mut *source)?;
        let (size, line) = ((header.width as u64, header.height as u64), header.width as u128 * PIXEL);
        limits.check_bytes(path, size, header.channels, header.depth, line)?;
        each_line(path, source, &header, |_, _| ())
    }

    fn encode(
        &self,
        path: &Path,
        output: Sink<'_>,
        image: &EncodedImage,
        options: &WriteOptions,
    ) -> Result<(), IoError> {
        write(output, Picture::Held(image), &options.metadata).map_err(|error| IoError::write(path, error))
    }

    fn encode_rows(
        &self,
        path: &Path,
        output: Sink<'_>,
        rows: MadeRows<'_>,
        options: &WriteOptions,
    ) -> Result<(), IoError> {
        write(output, Picture::Made(rows), &options.metadata).map_err(|error| IoError::write(path, error))
    }
}

/// Writes a picture. Light beyond the format's range is clamped; there is no alpha.
fn write(output: Sink<'_>, mut picture: Picture<'_, '_>, metadata: &Metadata) -> io::Result<()> {
    write!(output, "#?RADIANCE\nSOFTWARE={}\n", metadata.software_to_write())?;
    metadata.remarks.iter().try_for_each(|remark| writeln!(output, "{}={}", remark.name, remark.text))?;
    write!(output, "{}FORMAT=32-bit_rle_rgbe\n\n", line_of(metadata))?;
    let (width, height) = picture.size();
    writeln!(output, "-Y {height} +X {width}")?;
    let (mut line, mut bytes) = (Vec::with_capacity(width), Vec::new());
    picture.visit(0..height, |image, rows| {
        let (Samples::Float(samples), Channels::Rgb) = (image.samples(), image.channels()) else {
            return Err(io::Error::other("Radiance HDR holds RGB floats"));
        };
        samples[rows.start * width * 3..rows.end * width * 3].chunks_exact((width * 3).max(1)).try_for_each(|row| {
            line.clear();
            line.extend(row.chunks_exact(3).map(|pixel| rgbe::encode([pixel[0], pixel[1], pixel[2]])));
            bytes.clear();
            rgbe::write_line(&mut bytes, &line)?;
            output.write_all(&bytes)
        })
    })?;
    output.flush()
}

/// Reads the scan lines behind a header, and calls `visit` with the number and the pixels of each. Refuses pictures behind them.
fn each_line(
    path: &Path,
    source: Source<'_>,
    header: &Header,
    mut visit: impl FnMut(usize, &[Rgbe]),
) -> Result<(), IoError> {
    // Pixels are read byte by byte, which is faster from a buffer of known type.
    let mut source = BufReader::with_capacity(BUFFER, source);
    // What the limits permit may be more than there is.
    let mut line: Vec<Rgbe> = bytemuck::try_zeroed_vec(header.width).map_err(|()| {
        IoError::damaged(path, FORMAT, format_args!("there is no memory for lines of {} pixels", header.width))
    })?;
    for j in 0..header.height {
        rgbe::read_line(&mut source, &mut line).map_err(|error| IoError::damaged(path, FORMAT, error))?;
        visit(j, &line);
    }
    let behind = count_behind(path, &mut source, &mut line).map_err(|error| IoError::open(path, error))?;
    if behind > 0 {
        return Err(IoError::several(path, FORMAT, 1 + behind, "pictures one behind the other"));
    }
    Ok(())
}

/// Counts the pictures that follow one that has been read. Bytes that begin no picture are harmless padding.
fn count_behind<R: Read + Seek>(path: &Path, source: &mut BufReader<R>, line: &mut Vec<Rgbe>) -> io::Result<usize> {
    let mut count = 0;
    loop {
        let first = skip_padding(source)?;
        let is_marked = next_bytes(source, MARK.len())? == MARK;
        source.seek(SeekFrom::Start(first))?;
        let preamble = if is_marked { Preamble::read(path, source).ok() } else { None };
        let Some(Preamble { header, .. }) = preamble else { return Ok(count) };
        count += 1;
        // No memory is allocated for a width that the file merely claims to have.
        line.resize(header.width.min(line.len().max(1)), [0; 4]);
        let is_whole = header.width == line.len() && (0..header.height).all(|_| rgbe::read_line(source, line).is_ok());
        if !is_whole {
            return Ok(count);
        }
    }
}

/// Header before the pixels.
struct Preamble {
    header: Header,
    /// Factor by which the pixels were multiplied.
    exposure: f32,
    upside_down: bool,
}

impl Preamble {
    fn read(path: &Path, source: Source<'_>) -> Result<Self, IoError> {
        let fail = |reason: &str| IoError::damaged(path, FORMAT, reason);
        let mut exposure = 1.0_f32;
        let mut metadata = Metadata { transfer: Some(Transfer::Linear), ..Metadata::default() };
        for _ in 0..MOST_LINES {
            let line = read_line(source).ok_or_else(|| fail("it ends within its header"))?;
            match line.split_once('=') {
                _ if line.is_empty() => {
                    let size = read_line(source).ok_or_else(|| fail("it ends within its header"))?;
                    let (width, height, upside_down) = parse_size(path, &size)?;
                    let exposure = if exposure.is_normal() && exposure > 0.0 { exposure } else { 1.0 };
                    let header = header(width, height, metadata);
                    return Ok(Self { header, exposure, upside_down });
                }
                Some(("FORMAT", format)) if format.trim() != "32-bit_rle_rgbe" => {
                    return Err(IoError::unsupported(path, FORMAT, format.trim(), "32-bit_rle_rgbe"));
                }
                // Every program that changed the exposure adds its own line.
                Some(("EXPOSURE", factor)) => exposure *= factor.trim().parse().unwrap_or(1.0),
                Some(("SOFTWARE", name)) => {
                    let Metadata { software, origin, .. } = Metadata::by(Some(name.trim().to_owned()));
                    (metadata.software, metadata.origin) = (software, origin);
                }
                Some(("PRIMARIES", numbers)) => match primaries(numbers) {
                    Some(primaries) => metadata.primaries = Some(primaries),
                    // Lines as the skies of Poly Haven have them.
                    None if numbers.split_whitespace().eq(["0"; 8]) => {
                        metadata.notes.push("its PRIMARIES are all 0, which is taken for none".to_owned());
                    }
                    None => metadata.complaints.push(format!(
                        "its PRIMARIES are ignored: expected the x and y of red, green, blue and white, found {numbers:?}"
                    )),
                },
                _ => {}
            }
        }
        Err(fail("its header has no end"))
    }
}

/// Parses `PRIMARIES=rx ry gx gy bx by wx wy`.
fn primaries(text: &str) -> Option<Primaries> {
    let numbers: Vec<f64> = text.split_whitespace().map(str::parse).collect::<Result<_, _>>().ok()?;
    let [rx, ry, gx, gy, bx, by, wx, wy] = numbers[..] else { return None };
    Primaries::of_pairs([rx, ry], [gx, gy], [bx, by], [wx, wy])
}

/// Returns the line of the header that names the primaries, if they have to be named.
fn line_of(metadata: &Metadata) -> String {
    let Some(primaries) = metadata.primaries else { return String::new() };
    let numbers: Vec<String> = primaries.pairs().iter().flatten().map(|number| format!("{number:.5}")).collect();
    format!("PRIMARIES={}\n", numbers.join(" "))
}

fn header(width: usize, height: usize, metadata: Metadata) -> Header {
    Header { format: FORMAT, width, height, channels: Channels::Rgb, depth: Depth::Float, metadata, window: None }
}

fn read_line(source: Source<'_>) -> Option<String> {
    let mut bytes = Vec::new();
    source.take(LONGEST_LINE).read_until(b'\n', &mut bytes).ok()?;
    let line = bytes.strip_suffix(b"\n")?;
    Some(String::from_utf8_lossy(line.strip_suffix(b"\r").unwrap_or(line)).into_owned())
}

/// Parses `-Y 512 +X 1024`: rows from the top, columns from the left. Rows from the bottom are accepted, too.
fn parse_size(path: &Path, line: &str) -> Result<(usize, usize, bool), IoError> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let [y, height, x, width] = words[..] else {
        return Err(IoError::damaged(path, FORMAT, format_args!("{line:?} is no size")));
    };
    let (Ok(width), Ok(height)) = (width.parse::<u32>(), height.parse::<u32>()) else {
        return Err(IoError::damaged(path, FORMAT, format_args!("{line:?} is no size")));
    };
    if width == 0 || height == 0 {
        return Err(IoError::damaged(path, FORMAT, "it has no pixels"));
    }
    match (y, x) {
        ("-Y" | "+Y", "+X") => Ok((width as usize, height as usize, y == "+Y")),
        _ => Err(IoError::unsupported(path, FORMAT, format_args!("scan lines that run {line}"), "-Y … +X …")),
    }
}
