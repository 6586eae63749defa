use std::io::SeekFrom;
use std::path::Path;

use cosmorama::raster::{AlphaMode, Channels, Depth, EncodedImage, Samples, Transfer};
use ktx2::{Format as Vk, Header as Ktx2Header, Index, LevelIndex, SupercompressionScheme as Scheme};

use super::cube::{CubeTexture, EXPECTED, TextureFormat, WrittenCube, key_values};
use super::packing::{Packed, Packing};
use super::texel::{BlockFormat, Texels};
use crate::codec::interface::{Sink, Source};
use crate::metadata::khronos;
use crate::{Format, IoError, Metadata, WriteOptions};

const FORMAT: Format = Format::Ktx2;

/// Constants of the data format descriptor (Khronos Data Format Specification 1.3).
mod descriptor {
    pub(super) const RGB_MODEL: u8 = 1;
    pub(super) const ETC1S_MODEL: u8 = 163;
    pub(super) const UASTC_MODEL: u8 = 166;
    pub(super) const LINEAR: u8 = 1;
    pub(super) const SRGB: u8 = 2;
    pub(super) const PREMULTIPLIED: u8 = 1;
    pub(super) const ALPHA: u8 = 15;
    /// Flag of a linear sample, such as alpha beside sRGB colours.
    pub(super) const LINEAR_SAMPLE: u8 = 0x10;
    pub(super) const SIGNED_FLOAT: u8 = 0xc0;
}

/// Codec of cube maps in KTX 2 textures.
pub(crate) struct Ktx2;

impl TextureFormat for Ktx2 {
    const FORMAT: Format = FORMAT;

    fn texture(&self, path: &Path, source: Source<'_>) -> Result<CubeTexture, IoError> {
        texture(path, source)
    }

    /// Writes six faces with their mip levels: RGBA of 8 bits, sRGB unless the light is linear, or premultiplied
    /// halves or floats.
    fn write(&self, path: &Path, output: Sink<'_>, cube: WrittenCube, metadata: &Metadata) -> Result<(), IoError> {
        let WrittenCube { levels, edge, depth } = cube;
        Written { width: edge, height: edge, faces: 6, depth, levels }.write(path, output, metadata)
    }

    fn write_flat(
        &self,
        path: &Path,
        output: Sink<'_>,
        image: &EncodedImage,
        options: &WriteOptions,
    ) -> Result<(), IoError> {
        write_flat(path, output, image, options)
    }
}

/// Writes a flat texture of one level, without faces: RGBA of 8 bits, halves or floats.
fn write_flat(path: &Path, output: Sink<'_>, image: &EncodedImage, options: &WriteOptions) -> Result<(), IoError> {
    let (width, height) = (image.width(), image.height());
    let texels: Vec<u8> = match (image.channels(), image.samples()) {
        (Channels::Rgba, Samples::U8(samples)) => samples.clone(),
        (Channels::Rgba, Samples::Half(samples)) => samples.iter().flat_map(|sample| sample.to_le_bytes()).collect(),
        (Channels::Rgba, Samples::Float(samples)) => samples.iter().flat_map(|sample| sample.to_le_bytes()).collect(),
        _ => {
            return Err(IoError::CannotHold {
                path: path.to_owned(),
                format: FORMAT,
                found: format!("{} of depth {}", image.channels(), image.depth()),
                expected: "RGBA; depth 8, half, float".to_owned(),
            });
        }
    };
    let (Ok(columns), Ok(rows)) = (u32::try_from(width), u32::try_from(height)) else {
        return Err(IoError::write(path, format_args!("{width}x{height} pixels")));
    };
    let file = Written { width: columns, height: rows, faces: 1, depth: image.depth(), levels: vec![texels] };
    file.write(path, output, &options.metadata)
}

/// Texture to write.
struct Written {
    width: u32,
    height: u32,
    /// Six, or one of a flat texture.
    faces: u32,
    depth: Depth,
    /// Texels of each level, face by face, beginning with the largest.
    levels: Vec<Vec<u8>>,
}

impl Written {
    fn write(&self, path: &Path, output: Sink<'_>, metadata: &Metadata) -> Result<(), IoError> {
        let levels = &self.levels;
        let (format, type_size, transfer) = match (self.depth, &metadata.transfer) {
            (Depth::Float, _) => (Vk::R32G32B32A32_SFLOAT, 4, descriptor::LINEAR),
            (Depth::Half, _) => (Vk::R16G16B16A16_SFLOAT, 2, descriptor::LINEAR),
            (_, None | Some(Transfer::Srgb)) => (Vk::R8G8B8A8_SRGB, 1, descriptor::SRGB),
            (_, Some(transfer)) => (Vk::R8G8B8A8_UNORM, 1, khronos::transfer_code(transfer)),
        };
        let described = describe(type_size as u8, transfer, khronos::primaries_code(metadata.primaries.as_ref()));
        let words = key_values(("KTXorientation", "rd"), metadata);
        let dfd = (Ktx2Header::LENGTH + LevelIndex::LENGTH * levels.len()) as u32;
        let kvd = dfd + described.len() as u32;
        // A level begins at a multiple of a texel.
        let start = (kvd + words.len() as u32).next_multiple_of((4 * type_size).max(8));
        let header = Ktx2Header {
            format: Some(format),
            type_size,
            pixel_width: self.width,
            pixel_height: self.height,
            pixel_depth: 0,
            layer_count: 0,
            face_count: self.faces,
            level_count: levels.len() as u32,
            supercompression_scheme: None,
            index: Index {
                dfd_byte_offset: dfd,
                dfd_byte_length: described.len() as u32,
                kvd_byte_offset: kvd,
                kvd_byte_length: words.len() as u32,
                sgd_byte_offset: 0,
                sgd_byte_length: 0,
            },
        };
        // The smallest level comes first in the file, but the largest first in the index. Six faces of RGBA keep all
        // levels aligned.
        let after = |level: usize| levels[level + 1..].iter().map(|level| level.len() as u64).sum::<u64>();
        let index = levels.iter().enumerate().map(|(level, texels)| {
            let bytes = texels.len() as u64;
            LevelIndex {
                byte_offset: u64::from(start) + after(level),
                byte_length: bytes,
                uncompressed_byte_length: bytes,
            }
        });
        let index: Vec<u8> = index.flat_map(|level| level.as_bytes()).collect();
        let padding = vec![0; (start - kvd) as usize - words.len()];
        let parts: [&[u8]; 5] = [&header.as_bytes(), &index, &described, &words, &padding];
        let all = parts.into_iter().chain(levels.iter().rev().map(Vec::as_slice));
        all.into_iter().try_for_each(|part| output.write_all(part)).map_err(|error| IoError::write(path, error))
    }
}

/// Reads the file's structure without its texels.
fn texture(path: &Path, source: Source<'_>) -> Result<CubeTexture, IoError> {
    let short = |_| IoError::damaged(path, FORMAT, "it ends too early");
    let mut start = [0; Ktx2Header::LENGTH];
    source.read_exact(&mut start).map_err(short)?;
    let mut level = [0; LevelIndex::LENGTH];
    source.read_exact(&mut level).map_err(short)?;
    let header = Ktx2Header::from_bytes(&start).map_err(|error| IoError::damaged(path, FORMAT, error))?;
    let unsupported = |found: String| IoError::unsupported(path, FORMAT, found, EXPECTED);
    if header.face_count != 6 || header.pixel_depth > 1 || header.layer_count > 1 {
        return Err(unsupported("a texture that is no cube".to_owned()));
    }
    if header.pixel_width != header.pixel_height {
        return Err(IoError::damaged(path, FORMAT, "the faces of a cube are square"));
    }
    let packing = match header.supercompression_scheme {
        None => None,
        Some(Scheme::Zstandard) => Some(Packing::Zstandard),
        Some(Scheme::ZLIB) => Some(Packing::Zlib),
        Some(scheme) => return Err(unsupported(format!("texels packed by {scheme:?}"))),
    };
    let Some(format) = header.format else {
        return Err(unsupported(model(&descriptor(path, source, header.index.dfd_byte_offset)?).to_owned()));
    };
    let (texels, srgb) =
        texels(format).ok_or_else(|| unsupported(format!("texels of the Vulkan format {format:?}")))?;
    let descriptor = descriptor(path, source, header.index.dfd_byte_offset)?;
    let (said, premultiplied) = (khronos::transfer(descriptor[14]), is_premultiplied(&descriptor));
    let integers = texels.depth() == Depth::Eight;
    let level = LevelIndex::from_bytes(&level);
    let mut cube = CubeTexture {
        texels,
        transfer: if srgb {
            Some(Transfer::Srgb)
        } else {
            said.filter(|_| integers).or_else(|| (!integers).then_some(Transfer::Linear))
        },
        primaries: khronos::primaries(descriptor[13]),
        complaints: khronos::complaints(descriptor[13], descriptor[14]),
        alpha: if premultiplied { AlphaMode::Premultiplied } else { AlphaMode::Straight },
        edge: header.pixel_width,
        row_alignment: 1,
        offsets: [0; 6],
        packed: packing.map(|packing| Packed { packing, offset: level.byte_offset, length: level.byte_length }),
    };
    cube.check_levels(path, FORMAT, "levelCount", header.level_count)?;
    if packing.is_none() && level.uncompressed_byte_length != level.byte_length {
        let reason = format_args!(
            "uncompressedByteLength is {}, but texels that are not packed have byteLength {}",
            level.uncompressed_byte_length, level.byte_length
        );
        return Err(IoError::damaged(path, FORMAT, reason));
    }
    let bytes = cube.face_bytes();
    let length = if packing.is_some() { level.uncompressed_byte_length } else { level.byte_length };
    if bytes.checked_mul(6) != Some(length) {
        return Err(IoError::damaged(
            path,
            FORMAT,
            format_args!(
                "its largest level has {length} bytes; six faces of {} pixels have six times {bytes}",
                header.pixel_width
            ),
        ));
    }
    for (face, offset) in (0_u64..).zip(&mut cube.offsets) {
        let at = level.byte_offset.checked_add(face * bytes);
        *offset = at.ok_or_else(|| IoError::damaged(path, FORMAT, "it ends too early"))?;
    }
    Ok(cube)
}

/// Beginning of the data format descriptor: its header, and properties of all texels.
type Descriptor = [u8; 16];

fn descriptor(path: &Path, source: Source<'_>, offset: u32) -> Result<Descriptor, IoError> {
    let mut start = Descriptor::default();
    source
        .seek(SeekFrom::Start(offset.into()))
        .and_then(|_| source.read_exact(&mut start))
        .map_err(|_| IoError::damaged(path, FORMAT, "its data format descriptor lies beyond its end"))?;
    Ok(start)
}

/// Returns the descriptor's colour model of texels without a Vulkan format.
fn model(descriptor: &Descriptor) -> &'static str {
    match descriptor[12] {
        descriptor::ETC1S_MODEL => "ETC1S texels, as BasisLZ packs them",
        descriptor::UASTC_MODEL => "UASTC texels",
        _ => "texels of no Vulkan format",
    }
}

fn is_premultiplied(descriptor: &Descriptor) -> bool {
    descriptor[15] & descriptor::PREMULTIPLIED != 0
}

/// Returns the encoding of texels of a Vulkan format, and whether it is sRGB.
fn texels(format: Vk) -> Option<(Texels, bool)> {
    let blocks = |format| Texels::Blocks(format);
    Some(match format {
        Vk::R8_UNORM => (Texels::GREY8, false),
        Vk::R8_SRGB => (Texels::GREY8, true),
        Vk::R8G8B8_UNORM => (Texels::RGB8, false),
        Vk::R8G8B8_SRGB => (Texels::RGB8, true),
        Vk::B8G8R8_UNORM => (Texels::BGR8, false),
        Vk::B8G8R8_SRGB => (Texels::BGR8, true),
        Vk::R8G8B8A8_UNORM | Vk::A8B8G8R8_UNORM_PACK32 => (Texels::RGBA8, false),
        Vk::R8G8B8A8_SRGB | Vk::A8B8G8R8_SRGB_PACK32 => (Texels::RGBA8, true),
        Vk::B8G8R8A8_UNORM => (Texels::BGRA8, false),
        Vk::B8G8R8A8_SRGB => (Texels::BGRA8, true),
        Vk::R16_SFLOAT => (Texels::Half(1), false),
        Vk::R16G16B16_SFLOAT => (Texels::Half(3), false),
        Vk::R16G16B16A16_SFLOAT => (Texels::Half(4), false),
        Vk::R32_SFLOAT => (Texels::Float(1), false),
        Vk::R32G32B32_SFLOAT => (Texels::Float(3), false),
        Vk::R32G32B32A32_SFLOAT => (Texels::Float(4), false),
        Vk::B10G11R11_UFLOAT_PACK32 => (Texels::SmallFloats, false),
        Vk::E5B9G9R9_UFLOAT_PACK32 => (Texels::SharedExponent, false),
        Vk::BC1_RGB_UNORM_BLOCK | Vk::BC1_RGBA_UNORM_BLOCK => (blocks(BlockFormat::Bc1), false),
        Vk::BC1_RGB_SRGB_BLOCK | Vk::BC1_RGBA_SRGB_BLOCK => (blocks(BlockFormat::Bc1), true),
        Vk::BC2_UNORM_BLOCK => (blocks(BlockFormat::Bc2), false),
        Vk::BC2_SRGB_BLOCK => (blocks(BlockFormat::Bc2), true),
        Vk::BC3_UNORM_BLOCK => (blocks(BlockFormat::Bc3), false),
        Vk::BC3_SRGB_BLOCK => (blocks(BlockFormat::Bc3), true),
        Vk::BC6H_UFLOAT_BLOCK => (blocks(BlockFormat::Bc6h { signed: false }), false),
        Vk::BC6H_SFLOAT_BLOCK => (blocks(BlockFormat::Bc6h { signed: true }), false),
        Vk::BC7_UNORM_BLOCK => (blocks(BlockFormat::Bc7), false),
        Vk::BC7_SRGB_BLOCK => (blocks(BlockFormat::Bc7), true),
        _ => return None,
    })
}

/// Returns the data format descriptor of RGBA: samples of one byte, or floats of two or four.
fn describe(sample_bytes: u8, transfer: u8, primaries: u8) -> Vec<u8> {
    let float = sample_bytes > 1;
    let premultiplied = if float { descriptor::PREMULTIPLIED } else { 0 };
    const BLOCK: u16 = 24 + 4 * 16;
    let mut bytes = Vec::new();
    bytes.extend((u32::from(BLOCK) + 4).to_le_bytes());
    // Vendor and type: Khronos's basic block; version 1.3 of the specification.
    bytes.extend([0, 0, 0, 0, 2, 0]);
    bytes.extend(BLOCK.to_le_bytes());
    bytes.extend([descriptor::RGB_MODEL, primaries, transfer, premultiplied]);
    // A block is one texel, in one plane.
    bytes.extend([0, 0, 0, 0, 4 * sample_bytes, 0, 0, 0, 0, 0, 0, 0]);
    for (place, channel) in [0, 1, 2, descriptor::ALPHA].into_iter().enumerate() {
        let bits = 8 * sample_bytes;
        let kind = match (float, channel, transfer) {
            (true, ..) => channel | descriptor::SIGNED_FLOAT,
            (false, descriptor::ALPHA, descriptor::SRGB) => channel | descriptor::LINEAR_SAMPLE,
            (false, ..) => channel,
        };
        bytes.extend([bits * place as u8, 0, bits - 1, kind, 0, 0, 0, 0]);
        let (lower, upper) = if float { ((-1.0_f32).to_bits(), 1.0_f32.to_bits()) } else { (0, 255) };
        bytes.extend(lower.to_le_bytes());
        bytes.extend(upper.to_le_bytes());
    }
    bytes
}
