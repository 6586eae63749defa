use std::io::{Seek, Write};
use std::path::Path;

use cosmorama::raster::{AlphaMode, Channels, Depth, EncodedImage, Samples};
use exr::compression::Compression as Packing;
use exr::image::write::WritableImage;
use exr::image::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer};
use exr::meta::attribute::{EnvironmentMap, Text};
use exr::meta::header::LayerAttributes;
use exr::prelude::SmallVec;
use half::f16;

use crate::codec::interface::is_beside_others;
use crate::{Compression, EnvMap, IoError, Metadata, WriteOptions};

/// Writes scan lines of premultiplied light, as the format requires.
pub(crate) fn write(
    path: &Path,
    output: impl Write + Seek,
    image: &EncodedImage,
    metadata: &Metadata,
    compression: Compression,
) -> Result<(), IoError> {
    let names: &[&str] = match image.channels() {
        Channels::Grey => &["Y"],
        Channels::GreyAlpha => &["Y", "A"],
        Channels::Rgb => &["R", "G", "B"],
        Channels::Rgba => &["R", "G", "B", "A"],
    };
    let list: SmallVec<[AnyChannel<FlatSamples>; 4]> = names
        .iter()
        .enumerate()
        .map(|(i, name)| Ok(AnyChannel::new(*name, plane(path, image, i)?)))
        .collect::<Result<_, IoError>>()?;
    save(path, output, (image.width(), image.height()), list, metadata, compression)
}

/// Writes named planes of numbers, as halves or as floats.
pub(crate) fn write_planes(
    path: &Path,
    output: impl Write + Seek,
    size: (usize, usize),
    planes: Vec<(&str, Vec<f32>)>,
    depth: Depth,
    options: &WriteOptions,
) -> Result<(), IoError> {
    let samples = |numbers: Vec<f32>| match depth {
        Depth::Half => FlatSamples::F16(numbers.into_iter().map(f16::from_f32).collect()),
        _ => FlatSamples::F32(numbers),
    };
    let list = planes.into_iter().map(|(name, numbers)| AnyChannel::new(name, samples(numbers))).collect();
    save(path, output, size, list, &options.metadata, options.compression)
}

fn save(
    path: &Path,
    output: impl Write + Seek,
    size: (usize, usize),
    list: SmallVec<[AnyChannel<FlatSamples>; 4]>,
    metadata: &Metadata,
    compression: Compression,
) -> Result<(), IoError> {
    let packing = match compression {
        Compression::None => Packing::Uncompressed,
        Compression::Fast => Packing::RLE,
        Compression::Balanced | Compression::High => Packing::ZIP16,
    };
    let encoding = Encoding { compression: packing, ..Encoding::SMALL_LOSSLESS };
    let attributes = LayerAttributes {
        environment_map: metadata.envmap.and_then(|kind| match kind {
            EnvMap::LatLong => Some(EnvironmentMap::LatitudeLongitude),
            EnvMap::Cube => Some(EnvironmentMap::Cube),
            EnvMap::GlCube => None,
        }),
        software_name: Some(Text::from("cosmorama")),
        ..LayerAttributes::default()
    };
    let layer = Layer::new(size, attributes, encoding, AnyChannels::sort(list));
    let picture = Image::from_layer(layer);
    let writer = picture.write();
    // The encoder has threads of its own, for one that works alone and has some to spare.
    let written = if rayon::current_num_threads() > 1 && !is_beside_others() {
        writer.to_buffered(output)
    } else {
        writer.non_parallel().to_buffered(output)
    };
    written.map_err(|error| IoError::write(path, error))
}

/// Returns the samples of one channel.
fn plane(path: &Path, image: &EncodedImage, channel: usize) -> Result<FlatSamples, IoError> {
    match image.samples() {
        Samples::Half(samples) => Ok(FlatSamples::F16(multiplied(samples, image, channel, |sample, alpha| {
            f16::from_f32(sample.to_f32() * alpha.to_f32())
        }))),
        Samples::Float(samples) => {
            Ok(FlatSamples::F32(multiplied(samples, image, channel, |sample, alpha| sample * alpha)))
        }
        Samples::U8(_) | Samples::U16(_) => Err(IoError::write(path, "OpenEXR holds halves and floats")),
    }
}

fn multiplied<S: Copy>(samples: &[S], image: &EncodedImage, channel: usize, by: impl Fn(S, S) -> S) -> Vec<S> {
    let count = image.channels().count();
    let alpha = count - 1;
    let straight = image.channels().has_alpha() && image.alpha_mode() == AlphaMode::Straight && channel != alpha;
    let pixels = samples.chunks_exact(count);
    pixels.map(|pixel| if straight { by(pixel[channel], pixel[alpha]) } else { pixel[channel] }).collect()
}
