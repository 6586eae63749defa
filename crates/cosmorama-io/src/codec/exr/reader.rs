use std::io::{self, SeekFrom};
use std::path::Path;
use std::sync::Arc;

use cosmorama::raster::{AlphaMode, Depth, FramePool, Sample, Samples, Transfer};
use exr::block::chunk::{Chunk, TileCoordinates};
use exr::block::lines::LineRef;
use exr::block::reader::{ChunksReader, Reader};
use exr::block::{BlockIndex, UncompressedBlock};
use exr::compression::Compression;
use exr::error::Error;
use exr::math::Vec2;
use exr::meta::attribute::{EnvironmentMap, SampleType};
use exr::meta::header::Header as Part;
use exr::meta::{BlockDescription, MetaData};
use half::f16;
use rayon::prelude::*;

use super::attributes;
use super::colour;
use super::dwa;
use super::offer::Offer;
use super::selection::Selection;
use super::window::Crop;
use crate::codec::behind::{count_marks, next_bytes, skip_padding};
use crate::codec::interface::{Density, Source, contained, is_beside_others, length, whole_image};
use crate::{Attribute, Carried, Choice, EnvMap, Format, Header, ImageFile, IoError, Limits, Metadata};

const FORMAT: Format = Format::Exr;

/// First bytes of every file.
pub(super) const MARK: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Bytes of the mark, the version and its flags.
const START: usize = 8;

/// Greatest number of chunks that each thread decompresses at once, and that all do together: more would only take memory, which stays with
/// the program.
const BATCH: usize = 2;
const MOST_BATCHED: usize = 64;
/// Bytes of these chunks together; a single chunk may have more.
pub(super) const BATCH_BYTES: u128 = 1 << 26;

/// Reads a file's header for the picture that a choice permits, and for the channels beside it.
pub(crate) fn probe(path: &Path, source: Source<'_>, choice: &Choice) -> Result<Header, IoError> {
    let (bytes, attributes) = (length(path, &mut *source)?, attributes::read(path, &mut *source)?);
    let reader = open(path, source)?;
    let (header, selection, _) = announce(path, reader.headers(), Wanted::Picture(choice))?;
    check_data(path, &reader.headers()[selection.part], bytes)?;
    Ok(with_attributes(header, attributes, selection.part))
}

/// Refuses a part of more pixels than a file of so many bytes can hold, also where most are cut off from the picture.
fn check_data(path: &Path, part: &Part, bytes: u64) -> Result<(), IoError> {
    density(part).check(path, FORMAT, (part.layer_size.width(), part.layer_size.height()), bytes)
}

/// Returns the density of pixels with all channels of a part.
fn density(part: &Part) -> Density {
    let unpacked = match part.compression {
        // Squares of 8 × 8 pixels, or runs, packed a second time.
        Compression::DWAA(_) | Compression::DWAB(_) => return Density::pixels(1 << 16),
        Compression::Uncompressed => 1,
        // Of floats, three bytes out of four are packed.
        Compression::PXR24 => Density::DEFLATE * 4 / 3,
        _ => Density::DEFLATE,
    };
    let whole = part.channels.list.iter().filter(|channel| channel.sampling == Vec2(1, 1));
    let bytes: usize = whole.map(|channel| channel.sample_type.bytes_per_sample()).sum();
    Density::of_bits(8 * bytes as u64, unpacked)
}

/// Adds the attributes of the part that is read.
fn with_attributes(mut header: Header, mut parts: Vec<Vec<Attribute>>, part: usize) -> Header {
    if part < parts.len() {
        header.metadata.carried = Arc::new(Carried { attributes: parts.swap_remove(part), ..Carried::default() });
    }
    header
}

/// Reads a file's header for the two channels of its st map.
pub(crate) fn probe_pairs(path: &Path, source: Source<'_>) -> Result<Header, IoError> {
    let bytes = length(path, &mut *source)?;
    attributes::read(path, &mut *source)?;
    let reader = open(path, source)?;
    let (header, selection, _) = announce(path, reader.headers(), Wanted::Pair)?;
    check_data(path, &reader.headers()[selection.part], bytes)?;
    Ok(header)
}

/// Reads the first part that holds a picture, at its largest resolution.
pub(crate) fn read(
    path: &Path,
    source: Source<'_>,
    memory: (&Limits, &FramePool),
    choice: &Choice,
) -> Result<ImageFile, IoError> {
    read_selected(path, source, memory, Wanted::Picture(choice))
}

/// Reads the two channels of an st map as an image of two channels.
pub(crate) fn read_pairs(path: &Path, source: Source<'_>, limits: &Limits) -> Result<ImageFile, IoError> {
    read_selected(path, source, (limits, &FramePool::default()), Wanted::Pair)
}

/// Channels to select.
#[derive(Clone, Copy)]
pub(super) enum Wanted<'a> {
    /// A picture, among the parts and channels that a choice permits.
    Picture(&'a Choice),
    /// The two channels of an st map.
    Pair,
}

impl Wanted<'_> {
    fn select(self, path: &Path, parts: &[Part]) -> Result<Selection, IoError> {
        let (selected, expected) = match self {
            Self::Picture(choice) => {
                let offers = Offer::chosen(path, parts, choice)?;
                let picture = Selection::of(parts, &offers);
                let selected = match picture {
                    Err(found) if choice.without_picture => Selection::stand_in(parts, &offers, found),
                    picture => picture,
                };
                (selected, PICTURE)
            }
            Self::Pair => (Selection::pair(parts), PAIR),
        };
        selected.map_err(|found| IoError::unsupported(path, FORMAT, found, expected))
    }
}

/// Channels of a picture, for messages.
const PICTURE: &str = "RGB or Y channels, with or without A, of half or float samples";

/// Channels of an st map, for messages.
const PAIR: &str = "the two channels of an st map, of half or float samples: R and G, u and v, s and t or x and y";

fn read_selected(
    path: &Path,
    source: Source<'_>,
    (limits, pool): (&Limits, &FramePool),
    wanted: Wanted<'_>,
) -> Result<ImageFile, IoError> {
    let (bytes, attributes) = (length(path, &mut *source)?, attributes::read(path, &mut *source)?);
    let reader = open(path, &mut *source)?;
    let (header, selection, crop) = announce(path, reader.headers(), wanted)?;
    let header = with_attributes(header, attributes, selection.part);
    check_limits(path, &reader.headers()[selection.part], &header, limits)?;
    check_data(path, &reader.headers()[selection.part], bytes)?;
    let fail = |error| damaged(path, error);
    // No block may hold pixels outside the data window.
    let count = crop.width * crop.height * selection.channels.count();
    let samples = match header.depth {
        Depth::Half => {
            let samples = pool.take_zeroed(count);
            Samples::Half(pixels(reader, &selection, &crop, half_line, samples).map_err(fail)?)
        }
        _ => {
            let samples = pool.take_zeroed(count);
            Samples::Float(pixels(reader, &selection, &crop, float_line, samples).map_err(fail)?)
        }
    };
    check_behind(path, source)?;
    let mut file = whole_image(path, header, samples)?;
    file.image = file.image.with_alpha_mode(AlphaMode::Premultiplied);
    Ok(file)
}

/// Reads a file to its end, and drops the pixels of its picture block by block.
pub(crate) fn check(path: &Path, source: Source<'_>, limits: &Limits, choice: &Choice) -> Result<(), IoError> {
    let bytes = length(path, &mut *source)?;
    attributes::read(path, &mut *source)?;
    let reader = open(path, &mut *source)?;
    let (header, selection, _) = announce(path, reader.headers(), Wanted::Picture(choice))?;
    let part = &reader.headers()[selection.part];
    check_block(path, part, &header, limits)?;
    // All chunks of a file may lie in one place, so that reading them to its end does not limit what is done.
    check_data(path, part, bytes)?;
    // Half for blocks, and half for the chunks of which they are made.
    let at_once = u128::from(limits.memory / 2).min(BATCH_BYTES);
    each_block(reader, selection.part, at_once, |block, part| {
        // Lines that are not in their block are found as they are for a picture.
        block.lines(&part.channels).for_each(drop);
        Ok(())
    })
    .map_err(|error| damaged(path, error))?;
    check_behind(path, source)
}

/// Refuses files that follow the one that has been read.
fn check_behind(path: &Path, source: Source<'_>) -> Result<(), IoError> {
    let behind = count_behind(source).map_err(|error| IoError::open(path, error))?;
    if behind > 0 {
        return Err(IoError::several(path, FORMAT, 1 + behind, "pictures one behind the other"));
    }
    Ok(())
}

/// Counts the files that follow one whose last chunk has been read. Bytes that begin no file are harmless padding.
/// Chunks of other parts and resolutions are harmless, too.
fn count_behind(source: Source<'_>) -> io::Result<usize> {
    let first = skip_padding(source)?;
    let start = next_bytes(source, START)?;
    source.seek(SeekFrom::Start(first))?;
    if !start.starts_with(&MARK) || MetaData::read_from_buffered(&mut *source, false).is_err() {
        return Ok(0);
    }
    // Files written by one program begin alike, with the same version and flags.
    Ok(1 + count_marks(source, &start)?)
}

/// Checks the memory for the display window and for a block of all channels, since a small display window may have a
/// huge data window.
fn check_limits(path: &Path, part: &Part, header: &Header, limits: &Limits) -> Result<(), IoError> {
    let size = (part.layer_size.width() as u64, part.layer_size.height() as u64);
    limits.check(path, size, header.channels, header.depth)?;
    check_block(path, part, header, limits)
}

/// Checks the memory for a block of all channels.
fn check_block(path: &Path, part: &Part, header: &Header, limits: &Limits) -> Result<(), IoError> {
    let size = (part.layer_size.width() as u64, part.layer_size.height() as u64);
    limits.check_bytes(path, size, header.channels, header.depth, block_bytes(part))
}

/// Returns the bytes of the largest block, with all channels.
pub(super) fn block_bytes(part: &Part) -> u128 {
    let (width, height) = (part.layer_size.width(), part.layer_size.height());
    let (columns, rows) = match part.blocks {
        BlockDescription::Tiles(tiles) => (tiles.tile_size.width().min(width), tiles.tile_size.height().min(height)),
        BlockDescription::ScanLines => (width, part.compression.scan_lines_per_block().min(height)),
    };
    let pixel: usize = part.channels.list.iter().map(|channel| channel.sample_type.bytes_per_sample()).sum();
    (columns as u128 * rows as u128).saturating_mul(pixel as u128)
}

pub(super) fn open<'a>(path: &Path, source: Source<'a>) -> Result<Reader<Source<'a>>, IoError> {
    let strictly = has_wrong_count(source).map_err(|error| IoError::open(path, error))?;
    let reader = exr::block::read(source, strictly).map_err(|error| damaged(path, error))?;
    // Channels are sorted by name.
    let pairs = reader.headers().iter().flat_map(|part| part.channels.list.windows(2));
    match pairs.into_iter().find(|pair| pair[0].name == pair[1].name) {
        Some(pair) => {
            Err(IoError::damaged(path, FORMAT, format_args!("two of its channels are called {}", pair[0].name)))
        }
        None => Ok(reader),
    }
}

/// Returns whether a file of one part is refused only for its `chunkCount`. That number is then ignored, as in
/// OpenEXR's own library, which computes the number of chunks from size and compression. Programs like exrenvmap copy
/// the attribute from their input. The decoder's stricter way of reading does not compare the number, because exr 1.74
/// inverts the flag (`MetaData::read_validated_from_buffered_peekable`); once that is fixed, such files are not refused
/// here.
fn has_wrong_count(source: Source<'_>) -> io::Result<bool> {
    let is_refused = matches!(exr::block::read(&mut *source, false), Err(Error::Invalid(_)));
    source.rewind()?;
    let has = is_refused && exr::block::read(&mut *source, true).is_ok_and(|reader| reader.headers().len() == 1);
    source.rewind()?;
    Ok(has)
}

pub(super) fn damaged(path: &Path, error: Error) -> IoError {
    match error {
        Error::NotSupported(found) => IoError::unsupported(path, FORMAT, found, "flat images"),
        // So says the system of a place before a file's first byte.
        Error::Io(error) if error.kind() == io::ErrorKind::InvalidInput => {
            IoError::damaged(path, FORMAT, "it says that data begin outside the file")
        }
        Error::Io(error) => IoError::open(path, error),
        error => IoError::damaged(path, FORMAT, error),
    }
}

/// Chooses the part and the channels to read, and returns their header.
pub(super) fn announce(path: &Path, parts: &[Part], wanted: Wanted<'_>) -> Result<(Header, Selection, Crop), IoError> {
    let selection = wanted.select(path, parts)?;
    let part = &parts[selection.part];
    let crop = Crop::of(part).ok_or_else(|| {
        IoError::unsupported(path, FORMAT, "no pixels inside the display window", "a picture in the display window")
    })?;
    let own = &part.own_attributes;
    let metadata = Metadata {
        transfer: Some(Transfer::Linear),
        envmap: own.environment_map.map(|kind| match kind {
            EnvironmentMap::LatitudeLongitude => EnvMap::LatLong,
            EnvironmentMap::Cube => EnvMap::Cube,
        }),
        other_channels: selection.others.clone(),
        layers: selection.layers.clone(),
        notes: Vec::from_iter(selection.is_mixed.then(|| {
            let names = selection.layers.picture.join(", ");
            format!("its channels {names} are of several sample types, and go on as one picture of floats")
        })),
        ..Metadata::by(own.software_name.as_ref().map(ToString::to_string))
    };
    let metadata = colour::read(part, metadata);
    let header = Header {
        format: FORMAT,
        width: crop.width,
        height: crop.height,
        channels: selection.channels,
        depth: selection.depth,
        metadata,
        window: crop.window,
    };
    Ok((header, selection, crop))
}

/// Reads the samples of a line of one channel and passes each, with its column, to a callback.
type ReadLine<S> = fn(&LineRef<'_>, SampleType, &mut dyn FnMut(usize, S)) -> Result<(), Error>;

fn half_line(line: &LineRef<'_>, _: SampleType, put: &mut dyn FnMut(usize, f16)) -> Result<(), Error> {
    line.read_samples::<f16>().enumerate().try_for_each(|(i, sample)| sample.map(|sample| put(i, sample)))
}

fn float_line(line: &LineRef<'_>, stored: SampleType, put: &mut dyn FnMut(usize, f32)) -> Result<(), Error> {
    match stored {
        SampleType::F16 => half_line(line, stored, &mut |i, sample| put(i, sample.to_f32())),
        SampleType::U32 => {
            line.read_samples::<u32>().enumerate().try_for_each(|(i, sample)| sample.map(|s| put(i, s as f32)))
        }
        _ => line.read_samples::<f32>().enumerate().try_for_each(|(i, sample)| sample.map(|sample| put(i, sample))),
    }
}

/// Decodes the chosen channels of the chosen part, interleaved, into zeroed samples.
fn pixels<S: Sample>(
    reader: Reader<Source<'_>>,
    selection: &Selection,
    crop: &Crop,
    read_line: ReadLine<S>,
    mut samples: Vec<S>,
) -> Result<Vec<S>, Error> {
    each_block(reader, selection.part, BATCH_BYTES, |block, part| {
        insert(block, part, selection, crop, read_line, &mut samples)
    })?;
    Ok(samples)
}

/// Decompresses the blocks of a part, at its largest resolution, and calls `visit` with each. Those that are decompressed together
/// have at most `at_once` bytes, unless a single one has more.
pub(super) fn each_block(
    reader: Reader<Source<'_>>,
    part: usize,
    at_once: u128,
    mut visit: impl FnMut(&UncompressedBlock, &Part) -> Result<(), Error>,
) -> Result<(), Error> {
    let wanted = |_: &MetaData, tile: TileCoordinates, block: BlockIndex| {
        block.layer == part && tile.is_largest_resolution_level()
    };
    let block_bytes = block_bytes(&reader.headers()[part]).max(1);
    let mut chunks = reader.filter_chunks(false, wanted)?;
    let threads = if is_beside_others() { 1 } else { rayon::current_num_threads() };
    let most = threads.saturating_mul(BATCH).min(MOST_BATCHED);
    let batch_size = (at_once / block_bytes).clamp(1, most as u128) as usize;
    loop {
        let batch = chunks.by_ref().take(batch_size).collect::<Result<Vec<Chunk>, Error>>()?;
        if batch.is_empty() {
            return Ok(());
        }
        let meta = chunks.meta_data();
        let compression = meta.headers[part].compression;
        if !batch.iter().all(|chunk| dwa::is_plausible(chunk, compression, block_bytes)) {
            return Err(Error::Invalid("a chunk larger than its block".into()));
        }
        // Other threads do not know that this one's panics are caught.
        let decompress = |chunk: Chunk| {
            let block = contained(|| UncompressedBlock::decompress_chunk(chunk, meta, false));
            block.unwrap_or_else(|reason| Err(Error::Invalid(reason.into())))
        };
        let blocks: Result<Vec<UncompressedBlock>, Error> = if is_beside_others() {
            batch.into_iter().map(decompress).collect()
        } else {
            batch.into_par_iter().map(decompress).collect()
        };
        for block in blocks? {
            visit(&block, &meta.headers[part])?;
        }
    }
}

fn insert<S>(
    block: &UncompressedBlock,
    part: &Part,
    selection: &Selection,
    crop: &Crop,
    read_line: ReadLine<S>,
    samples: &mut [S],
) -> Result<(), Error> {
    let count = selection.channels.count();
    for line in block.lines(&part.channels) {
        let Some(channel) = selection.slot(line.location.channel) else { continue };
        let Some(row) = crop.row(line.location.position.y()) else { continue };
        let stored = part.channels.list[line.location.channel].sample_type;
        let first = line.location.position.x();
        let row = &mut samples[row * crop.width * count..][..crop.width * count];
        read_line(&line, stored, &mut |i, sample| {
            if let Some(column) = crop.column(first + i) {
                row[column * count + channel] = sample;
            }
        })?;
    }
    Ok(())
}
