use std::io::{self, Seek, Write};
use std::ops::Range;
use std::path::Path;

use cosmorama::raster::{AlphaMode, Channels, Depth, EncodedImage, FramePool, Sample, Samples};
use exr::block::chunk::Chunk;
use exr::block::writer::ChunksWriter;
use exr::block::{BlockIndex, UncompressedBlock, enumerate_ordered_header_block_indices};
use exr::compression::Compression as Packing;
use exr::image::write::WritableImage;
use exr::image::write::samples::WritableSamples;
use exr::image::{AnyChannel, AnyChannels, Blocks, Encoding, FlatSamples, Image, Layer, Levels};
use exr::math::{RoundingMode, Vec2};
use exr::meta::attribute::{SampleType, Text};
use exr::meta::header::Header;
use exr::meta::mip_map_levels;
use exr::prelude::SmallVec;
use half::f16;
use rayon::prelude::*;

use super::in_order::InOrder;
use super::{attributes, colour};
use crate::codec::interface::is_beside_others;
use crate::header::visit;
use crate::{Compression, IoError, LayeredImage, LayeredRows, MadeLayers, MadeRows, Plane, PlaneSamples, WriteOptions};

/// Writes scan lines of premultiplied light, as the format requires.
pub(crate) fn write(
    path: &Path,
    output: impl Write + Seek,
    image: &EncodedImage,
    options: &WriteOptions,
) -> Result<(), IoError> {
    save_lines(path, output, (image.width(), image.height()), picture(path, image, &[], options)?, options)
}

/// Writes scan lines of a picture whose rows are made meanwhile.
pub(super) fn write_rows(
    path: &Path,
    output: impl Write + Seek,
    rows: MadeRows<'_>,
    options: &WriteOptions,
) -> Result<(), IoError> {
    let MadeRows { size, channels, depth, at_once, make, .. } = rows;
    let planes = |part: &EncodedImage| picture(path, part, &[], options);
    let form = planes(&without_rows(path, size.0, (channels, depth))?)?;
    write_parts((path, options), output, Parts { size, form, at_once, make }, |part: EncodedImage| planes(&part))
}

/// Writes scan lines of a picture with named channels beside it, or of such channels alone, whose rows are made meanwhile.
pub(super) fn write_layer_rows(
    path: &Path,
    output: impl Write + Seek,
    layers: MadeLayers<'_>,
    options: &WriteOptions,
) -> Result<(), IoError> {
    let MadeLayers { size, picture, names, planes, at_once, make } = layers;
    let picture = picture.map(|form| without_rows(path, size.0, form)).transpose()?;
    let plane = |(name, kind)| Plane { name, samples: PlaneSamples::zeros(kind, 0) };
    let all = |picture: Option<&EncodedImage>, planes| layered(path, (picture, &names), planes, options);
    let form = all(picture.as_ref(), planes.into_iter().map(plane).collect())?;
    let parts = Parts { size, form, at_once, make };
    write_parts((path, options), output, parts, |part: LayeredRows| all(part.picture.as_ref(), part.planes))
}

/// A file of parts, which are made while it is written.
struct Parts<'a, P> {
    size: (usize, usize),
    /// Channels, without samples.
    form: Planes,
    /// Rows of a part.
    at_once: usize,
    make: &'a mut (dyn FnMut(Range<usize>) -> Option<P> + Send),
}

/// Writes scan lines of parts, whose channels are those of `planes`.
fn write_parts<P: Send>(
    (path, options): (&Path, &WriteOptions),
    output: impl Write + Seek,
    Parts { size, form, at_once, make }: Parts<'_, P>,
    planes: impl Fn(P) -> Result<Planes, IoError>,
) -> Result<(), IoError> {
    let described = described(path, (size, Blocks::ScanLines), form, options)?;
    let headers = described.write().infer_meta_data();
    let written = exr::block::write(InOrder::new(output), headers, false, |meta, chunks| {
        let mut blocks = enumerate_ordered_header_block_indices(&meta.headers).peekable();
        let mut top = 0;
        visit(0..size.1, at_once.next_multiple_of(BLOCK), make, |part| {
            let planes = AnyChannels::sort(planes(part).map_err(io::Error::other)?).list;
            let rows = planes.first().map_or(0, |plane| plane.sample_data.len() / size.0.max(1));
            let bottom = top + rows;
            if !are_as_described(&meta.headers, &planes, rows * size.0) {
                return Err(io::Error::other("rows of other channels, or of other sizes, than was said").into());
            }
            let mut here = std::iter::from_fn(|| blocks.next_if(|(_, block)| block.pixel_position.y() < bottom));
            let compressed = |(place, block): (usize, BlockIndex)| {
                Ok((place, filled(&meta.headers, block, (&planes, top))?.compress_to_chunk(&meta.headers)?))
            };
            loop {
                // A few for each thread: compressed ones are held.
                let some: Vec<_> = here.by_ref().take(2 * rayon::current_num_threads()).collect();
                if some.is_empty() {
                    break;
                }
                let some: Vec<exr::error::Result<(usize, Chunk)>> = some.into_par_iter().map(compressed).collect();
                some.into_iter()
                    .try_for_each(|chunk| chunk.and_then(|(place, chunk)| chunks.write_chunk(place, chunk)))?;
            }
            top = bottom;
            Ok::<(), exr::error::Error>(())
        })
    });
    written.map_err(|error| IoError::write(path, error))
}

/// Returns whether planes are those of the header, with so many samples each.
fn are_as_described(headers: &[Header], planes: &Planes, samples: usize) -> bool {
    let kind = |samples: &FlatSamples| match samples {
        FlatSamples::F16(_) => SampleType::F16,
        FlatSamples::F32(_) => SampleType::F32,
        FlatSamples::U32(_) => SampleType::U32,
    };
    let described = headers.iter().flat_map(|header| &header.channels.list);
    let found = planes.iter().map(|plane| (&plane.name, kind(&plane.sample_data)));
    planes.iter().all(|plane| plane.sample_data.len() == samples)
        && described.map(|channel| (&channel.name, channel.sample_type)).eq(found)
}

/// Returns a picture of that width without rows.
fn without_rows(path: &Path, width: usize, (channels, depth): (Channels, Depth)) -> Result<EncodedImage, IoError> {
    let nothing = if depth == Depth::Half { Samples::Half(Vec::new()) } else { Samples::Float(Vec::new()) };
    EncodedImage::new(width, 0, channels, depth, nothing).map_err(|error| IoError::write(path, error))
}

/// Returns a block with its samples, from planes that begin with the row `top`.
fn filled(
    headers: &[Header],
    block: BlockIndex,
    (planes, top): (&Planes, usize),
) -> exr::error::Result<UncompressedBlock> {
    let width = headers[block.layer].layer_size.width();
    let mut lines = Ok(());
    let filled = UncompressedBlock::from_lines(&headers[block.layer].channels, block, |line| {
        let location = line.location;
        let from = (location.position.y() - top) * width + location.position.x();
        let place = from..from + location.sample_count;
        let written = match &planes[location.channel].sample_data {
            FlatSamples::F16(samples) => line.write_samples_from_slice(&samples[place]),
            FlatSamples::F32(samples) => line.write_samples_from_slice(&samples[place]),
            FlatSamples::U32(samples) => line.write_samples_from_slice(&samples[place]),
        };
        lines = std::mem::replace(&mut lines, Ok(())).and(written);
    });
    lines.map(|()| filled)
}

/// Rows of the largest block of scan lines that is compressed by itself.
const BLOCK: usize = 16;

/// Rows and columns of a tile, as `maketx` and `exrmaketiled` have them.
const TILE: Vec2<usize> = Vec2(64, 64);

/// Writes tiles of a picture and its mip levels, down to one pixel.
pub(crate) fn write_levels(
    path: &Path,
    output: impl Write + Seek,
    levels: &[EncodedImage],
    options: &WriteOptions,
) -> Result<(), IoError> {
    let Some(largest) = levels.first() else { return Err(IoError::write(path, "there is no picture")) };
    if levels.len() == 1 {
        return write(path, output, largest, options);
    }
    let size = Vec2(largest.width(), largest.height());
    let sizes = mip_map_levels(RoundingMode::Down, size).map(|(_, size)| size);
    if !levels.iter().map(|level| Vec2(level.width(), level.height())).eq(sizes) {
        let count = mip_map_levels(RoundingMode::Down, size).count();
        let reason = format_args!(
            "{} levels; {}x{} pixels have {count}, each half of the one before",
            levels.len(),
            size.0,
            size.1
        );
        return Err(IoError::write(path, reason));
    }
    let form = |level: &EncodedImage| (level.channels(), level.depth());
    if levels.iter().any(|level| form(level) != form(largest)) {
        return Err(IoError::write(path, "levels of several channels or depths"));
    }
    let mut list: SmallVec<[AnyChannel<Levels<FlatSamples>>; 4]> = SmallVec::new();
    for image in levels {
        for (channel, plane) in picture(path, image, &[], options)?.into_iter().enumerate() {
            if let Some(Levels::Mip { level_data, .. }) = list.get_mut(channel).map(|all| &mut all.sample_data) {
                level_data.push(plane.sample_data);
            } else {
                let level_data = vec![plane.sample_data];
                list.push(AnyChannel::new(plane.name, Levels::Mip { rounding_mode: RoundingMode::Down, level_data }));
            }
        }
    }
    save(path, output, ((size.0, size.1), Blocks::Tiles(TILE)), list, options).map(drop)
}

/// Writes a picture with named channels beside it.
pub(super) fn write_layers(
    path: &Path,
    output: impl Write + Seek,
    layered: LayeredImage<'_>,
    options: &WriteOptions,
) -> Result<(), IoError> {
    let LayeredImage { size, picture, names, planes } = layered;
    save_lines(path, output, size, self::layered(path, (picture, &names), planes, options)?, options)
}

/// Returns the channels of a picture, if there is one, and further ones beside it.
fn layered(
    path: &Path,
    (image, names): (Option<&EncodedImage>, &[String]),
    planes: Vec<Plane>,
    options: &WriteOptions,
) -> Result<Planes, IoError> {
    let mut list = image.map_or_else(|| Ok(Planes::new()), |image| picture(path, image, names, options))?;
    let own = list.len();
    for Plane { name, samples } in planes {
        let samples = match samples {
            PlaneSamples::Half(samples) => FlatSamples::F16(samples),
            PlaneSamples::Float(samples) => FlatSamples::F32(samples),
            PlaneSamples::Uint(samples) => FlatSamples::U32(samples),
        };
        let name = Text::from(name.as_str());
        if list[..own].iter().all(|channel| channel.name != name) {
            list.push(AnyChannel::new(name, samples));
        }
    }
    Ok(list)
}

/// Channels of a file.
type Planes = SmallVec<[AnyChannel<FlatSamples>; 4]>;

/// Returns the channels of a picture, by these names or by the usual ones.
fn picture(path: &Path, image: &EncodedImage, names: &[String], options: &WriteOptions) -> Result<Planes, IoError> {
    let usual: &[&str] = match image.channels() {
        Channels::Grey => &["Y"],
        Channels::GreyAlpha => &["Y", "A"],
        Channels::Rgb => &["R", "G", "B"],
        Channels::Rgba => &["R", "G", "B", "A"],
    };
    let name = |i: usize| names.get(i).map_or(usual[i], String::as_str);
    (0..usual.len()).map(|i| Ok(AnyChannel::new(name(i), plane(path, image, i, &options.pool)?))).collect()
}

/// Writes scan lines, and gives their memory back.
fn save_lines(
    path: &Path,
    output: impl Write + Seek,
    size: (usize, usize),
    list: Planes,
    options: &WriteOptions,
) -> Result<(), IoError> {
    let list = save(path, output, (size, Blocks::ScanLines), list, options)?;
    list.into_iter().for_each(|plane| give_back(plane.sample_data, &options.pool));
    Ok(())
}

/// Describes a file of channels, which are to be sorted by name.
fn described<S: for<'s> WritableSamples<'s> + 'static>(
    path: &Path,
    (size, blocks): ((usize, usize), Blocks),
    list: SmallVec<[AnyChannel<S>; 4]>,
    options: &WriteOptions,
) -> Result<Image<Layer<AnyChannels<S>>>, IoError> {
    let packing = match options.compression {
        Compression::None => Packing::Uncompressed,
        Compression::Fast => Packing::RLE,
        Compression::Balanced | Compression::High => Packing::ZIP16,
    };
    let encoding = Encoding { compression: packing, blocks, ..Encoding::SMALL_LOSSLESS };
    let layer = Layer::new(size, attributes::written(&options.metadata), encoding, AnyChannels::sort(list));
    let mut picture = Image::from_layer(layer);
    // Sorted by name. The encoder's own check of this is one of those that are left out below.
    let channels = &picture.layer_data.channel_data.list;
    if let Some(pair) = channels.windows(2).find(|pair| pair[0].name == pair[1].name) {
        return Err(IoError::write(path, format_args!("two channels are called {}", pair[0].name)));
    }
    picture.attributes.chromaticities = options.metadata.primaries.as_ref().map(colour::chromaticities);
    Ok(picture)
}

/// Writes channels, and returns them.
fn save<S: for<'s> WritableSamples<'s> + 'static>(
    path: &Path,
    output: impl Write + Seek,
    form: ((usize, usize), Blocks),
    list: SmallVec<[AnyChannel<S>; 4]>,
    options: &WriteOptions,
) -> Result<SmallVec<[AnyChannel<S>; 4]>, IoError> {
    let picture = described(path, form, list, options)?;
    // The encoder's checks refuse standard attributes that it has not made itself.
    let writer = picture.write().skip_compatibility_checks();
    // The encoder has threads of its own. They are used if this thread works alone and there are several cores.
    let written = if rayon::current_num_threads() > 1 && !is_beside_others() {
        writer.to_buffered(InOrder::new(output))
    } else {
        writer.non_parallel().to_buffered(InOrder::new(output))
    };
    written.map_err(|error| IoError::write(path, error))?;
    Ok(picture.layer_data.channel_data.list)
}

/// Gives the memory of a written plane back.
fn give_back(plane: FlatSamples, pool: &FramePool) {
    match plane {
        FlatSamples::F16(samples) => pool.give(Samples::Half(samples)),
        FlatSamples::F32(samples) => pool.give(Samples::Float(samples)),
        FlatSamples::U32(_) => {}
    }
}

/// Returns the samples of one channel.
fn plane(path: &Path, image: &EncodedImage, channel: usize, pool: &FramePool) -> Result<FlatSamples, IoError> {
    match image.samples() {
        Samples::Half(samples) => {
            let by = |sample: f16, alpha: f16| f16::from_f32(sample.to_f32() * alpha.to_f32());
            Ok(FlatSamples::F16(multiplied(samples, image, channel, by, pool)))
        }
        Samples::Float(samples) => {
            Ok(FlatSamples::F32(multiplied(samples, image, channel, |sample, alpha| sample * alpha, pool)))
        }
        Samples::U8(_) | Samples::U16(_) => Err(IoError::write(path, "OpenEXR holds halves and floats")),
    }
}

fn multiplied<S: Sample>(
    samples: &[S],
    image: &EncodedImage,
    channel: usize,
    by: impl Fn(S, S) -> S,
    pool: &FramePool,
) -> Vec<S> {
    let count = image.channels().count();
    let alpha = count - 1;
    let straight = image.channels().has_alpha() && image.alpha_mode() == AlphaMode::Straight && channel != alpha;
    let mut plane = pool.take(samples.len() / count);
    for (into, pixel) in plane.iter_mut().zip(samples.chunks_exact(count)) {
        *into = if straight { by(pixel[channel], pixel[alpha]) } else { pixel[channel] };
    }
    plane
}
