use std::io::SeekFrom;
use std::path::Path;

use cosmorama::raster::{AlphaMode, Depth, Transfer};

use super::cube::{CubeTexture, EXPECTED, TextureFormat, WrittenCube, key_values};
use super::texel::{BlockFormat, Texels};
use crate::codec::interface::{Sink, Source};
use crate::{Format, IoError, Metadata};

const FORMAT: Format = Format::Ktx;

/// Constants of OpenGL.
mod gl {
    pub(super) const UNSIGNED_BYTE: u32 = 0x1401;
    pub(super) const FLOAT: u32 = 0x1406;
    pub(super) const HALF_FLOAT: u32 = 0x140b;
    pub(super) const RED: u32 = 0x1903;
    pub(super) const RGB: u32 = 0x1907;
    pub(super) const RGBA: u32 = 0x1908;
    pub(super) const LUMINANCE: u32 = 0x1909;
    pub(super) const BGR: u32 = 0x80e0;
    pub(super) const BGRA: u32 = 0x80e1;
    pub(super) const SRGB8: u32 = 0x8c41;
    pub(super) const SRGB8_ALPHA8: u32 = 0x8c43;
    pub(super) const RGBA8: u32 = 0x8058;
    pub(super) const RGBA32F: u32 = 0x8814;
    pub(super) const RGBA16F: u32 = 0x881a;
    pub(super) const R11F_G11F_B10F: u32 = 0x8c3a;
    pub(super) const RGB9_E5: u32 = 0x8c3d;
    pub(super) const RGB_DXT1: u32 = 0x83f0;
    pub(super) const RGBA_DXT1: u32 = 0x83f1;
    pub(super) const RGBA_DXT3: u32 = 0x83f2;
    pub(super) const RGBA_DXT5: u32 = 0x83f3;
    pub(super) const SRGB_DXT1: u32 = 0x8c4c;
    pub(super) const SRGB_ALPHA_DXT1: u32 = 0x8c4d;
    pub(super) const SRGB_ALPHA_DXT3: u32 = 0x8c4e;
    pub(super) const SRGB_ALPHA_DXT5: u32 = 0x8c4f;
    pub(super) const RGBA_BPTC_UNORM: u32 = 0x8e8c;
    pub(super) const SRGB_ALPHA_BPTC_UNORM: u32 = 0x8e8d;
    pub(super) const RGB_BPTC_SIGNED_FLOAT: u32 = 0x8e8e;
    pub(super) const RGB_BPTC_UNSIGNED_FLOAT: u32 = 0x8e8f;
}

const MAGIC: &[u8; 12] = b"\xabKTX 11\xbb\r\n\x1a\n";
/// Number of integers after the identification.
const NUMBERS: usize = 13;
const LITTLE_ENDIAN: u32 = 0x0403_0201;

/// Codec of cube maps in KTX textures of version 1.
pub(crate) struct Ktx;

impl TextureFormat for Ktx {
    const FORMAT: Format = FORMAT;

    fn texture(&self, path: &Path, source: Source<'_>) -> Result<CubeTexture, IoError> {
        texture(path, source)
    }

    /// Writes six faces with their mip levels: RGBA of 8 bits, sRGB unless the light is linear, halves or floats.
    fn write(&self, path: &Path, output: Sink<'_>, cube: WrittenCube, metadata: &Metadata) -> Result<(), IoError> {
        let WrittenCube { levels, edge, depth } = cube;
        let (kind, size, internal) = match (depth, &metadata.transfer) {
            (Depth::Half, _) => (gl::HALF_FLOAT, 2, gl::RGBA16F),
            (Depth::Float, _) => (gl::FLOAT, 4, gl::RGBA32F),
            (_, None | Some(Transfer::Srgb)) => (gl::UNSIGNED_BYTE, 1, gl::SRGB8_ALPHA8),
            _ => (gl::UNSIGNED_BYTE, 1, gl::RGBA8),
        };
        let pairs = key_values(("KTXorientation", "S=r,T=d"), metadata);
        let numbers: [u32; NUMBERS] = [
            LITTLE_ENDIAN,
            kind,
            size,
            gl::RGBA,
            internal,
            gl::RGBA,
            edge,
            edge,
            0,
            0,
            6,
            levels.len() as u32,
            pairs.len() as u32,
        ];
        let numbers: Vec<u8> = numbers.into_iter().flat_map(u32::to_le_bytes).collect();
        let mut write = |bytes: &[u8]| output.write_all(bytes).map_err(|error| IoError::write(path, error));
        [&MAGIC[..], &numbers, &pairs].into_iter().try_for_each(&mut write)?;
        // Of a cube, a level's size is that of one face.
        levels.iter().try_for_each(|faces| {
            write(&(faces.len() as u32 / 6).to_le_bytes())?;
            write(faces)
        })
    }
}

/// Reads the structure of a file of version 1, without its texels; version 2 is another format.
fn texture(path: &Path, source: Source<'_>) -> Result<CubeTexture, IoError> {
    let short = |_| IoError::damaged(path, FORMAT, "it ends too early");
    let mut start = [0; 12 + 4 * NUMBERS];
    source.read_exact(&mut start).map_err(short)?;
    let mut numbers = [0; NUMBERS];
    for (number, b) in numbers.iter_mut().zip(start[12..].chunks_exact(4)) {
        *number = u32::from_le_bytes([b[0], b[1], b[2], b[3]]);
    }
    let [endianness, kind, _, order, internal, _, width, height, depth, layers, faces, levels, key_bytes] = numbers;
    let unsupported = |found: String| IoError::unsupported(path, FORMAT, found, EXPECTED);
    if endianness != LITTLE_ENDIAN {
        return Err(unsupported("numbers with their highest byte first".to_owned()));
    }
    if faces != 6 || depth > 1 || layers > 1 {
        return Err(unsupported("a texture that is no cube".to_owned()));
    }
    if width != height || width == 0 {
        return Err(IoError::damaged(path, FORMAT, format_args!("{width}x{height} pixels are no face of a cube")));
    }
    let texels = texels(internal, order, kind).ok_or_else(|| {
        unsupported(format!("texels of the OpenGL formats {internal:#06x}, {order:#06x} and type {kind:#06x}"))
    })?;
    let level = (start.len() as u64) + u64::from(key_bytes);
    let mut size = [0; 4];
    source.seek(SeekFrom::Start(level)).and_then(|_| source.read_exact(&mut size)).map_err(short)?;
    let srgb = matches!(
        internal,
        gl::SRGB8
            | gl::SRGB8_ALPHA8
            | gl::SRGB_DXT1
            | gl::SRGB_ALPHA_DXT1
            | gl::SRGB_ALPHA_DXT3
            | gl::SRGB_ALPHA_DXT5
            | gl::SRGB_ALPHA_BPTC_UNORM
    );
    let transfer = if texels.depth() == Depth::Eight { srgb.then_some(Transfer::Srgb) } else { Some(Transfer::Linear) };
    let mut cube = CubeTexture {
        texels,
        transfer,
        primaries: None,
        complaints: Vec::new(),
        alpha: if texels.depth() == Depth::Eight { AlphaMode::Straight } else { AlphaMode::Premultiplied },
        edge: width,
        row_alignment: 4,
        offsets: [0; 6],
        packed: None,
    };
    cube.check_levels(path, FORMAT, "numberOfMipmapLevels", levels)?;
    let (declared, bytes) = (u64::from(u32::from_le_bytes(size)), cube.face_bytes());
    if declared != bytes {
        return Err(IoError::damaged(
            path,
            FORMAT,
            format_args!("a face is said to have {declared} bytes; {width}x{width} pixels have {bytes}"),
        ));
    }
    for (face, offset) in (0_u64..).zip(&mut cube.offsets) {
        *offset = level + 4 + face * bytes;
    }
    Ok(cube)
}

/// Returns the encoding of texels: by the internal format if compressed or packed, else by order and type.
fn texels(internal: u32, order: u32, kind: u32) -> Option<Texels> {
    let packed = match internal {
        gl::R11F_G11F_B10F => Some(Texels::SmallFloats),
        gl::RGB9_E5 => Some(Texels::SharedExponent),
        gl::RGB_DXT1 | gl::RGBA_DXT1 | gl::SRGB_DXT1 | gl::SRGB_ALPHA_DXT1 => Some(Texels::Blocks(BlockFormat::Bc1)),
        gl::RGBA_DXT3 | gl::SRGB_ALPHA_DXT3 => Some(Texels::Blocks(BlockFormat::Bc2)),
        gl::RGBA_DXT5 | gl::SRGB_ALPHA_DXT5 => Some(Texels::Blocks(BlockFormat::Bc3)),
        gl::RGBA_BPTC_UNORM | gl::SRGB_ALPHA_BPTC_UNORM => Some(Texels::Blocks(BlockFormat::Bc7)),
        gl::RGB_BPTC_SIGNED_FLOAT => Some(Texels::Blocks(BlockFormat::Bc6h { signed: true })),
        gl::RGB_BPTC_UNSIGNED_FLOAT => Some(Texels::Blocks(BlockFormat::Bc6h { signed: false })),
        _ => None,
    };
    let count = match order {
        gl::RED | gl::LUMINANCE => Some(1),
        gl::RGB => Some(3),
        gl::RGBA => Some(4),
        _ => None,
    };
    // R11F_G11F_B10F may also be made of halves or floats.
    match (kind, order) {
        (gl::UNSIGNED_BYTE, gl::RED | gl::LUMINANCE) => Some(Texels::GREY8),
        (gl::UNSIGNED_BYTE, gl::RGB) => Some(Texels::RGB8),
        (gl::UNSIGNED_BYTE, gl::RGBA) => Some(Texels::RGBA8),
        (gl::UNSIGNED_BYTE, gl::BGR) => Some(Texels::BGR8),
        (gl::UNSIGNED_BYTE, gl::BGRA) => Some(Texels::BGRA8),
        (gl::HALF_FLOAT, _) => count.map(Texels::Half),
        (gl::FLOAT, _) => count.map(Texels::Float),
        _ => packed,
    }
}
