use std::path::Path;

use cosmorama::raster::{AlphaMode, Depth, Transfer};
use ddsfile::{
    AlphaMode as DdsAlpha, Caps, Caps2, D3D10ResourceDimension, D3DFormat, DxgiFormat, FourCC, Header as DdsHeader,
    Header10, MiscFlag,
};

use super::cube::{CubeTexture, EXPECTED, TextureFormat, WrittenCube};
use super::texel::{BlockFormat, Texels};
use crate::codec::interface::{Sink, Source};
use crate::{Format, IoError, Metadata};

const FORMAT: Format = Format::Dds;

const MAGIC: &[u8; 4] = b"DDS ";
/// Offset of `dwCaps2`.
const CAPS2: usize = 112;

/// Codec of cube maps in DirectDraw surfaces.
pub(crate) struct Dds;

impl TextureFormat for Dds {
    const FORMAT: Format = FORMAT;

    fn texture(&self, path: &Path, source: Source<'_>) -> Result<CubeTexture, IoError> {
        texture(path, source)
    }

    /// Writes six faces with their mip levels: RGBA of 8 bits under the old header, which every program reads but which
    /// does not record the transfer function, or premultiplied halves or floats under the header of Direct3D 10.
    fn write(&self, path: &Path, output: Sink<'_>, cube: WrittenCube, _: &Metadata) -> Result<(), IoError> {
        let WrittenCube { levels: faces, edge, depth } = cube;
        let start = start(edge, depth, faces.len() as u32).map_err(|error| IoError::write(path, error))?;
        // Each face is followed by its own smaller copies.
        let face = |face: usize| {
            let part = move |level: &Vec<u8>| level.len() / 6 * face..level.len() / 6 * (face + 1);
            faces.iter().map(move |level| &level[part(level)])
        };
        let mut parts = std::iter::once(start.as_slice()).chain((0..6).flat_map(face));
        parts.try_for_each(|part| output.write_all(part)).map_err(|error| IoError::write(path, error))
    }
}

/// Reads the file's structure without its texels.
fn texture(path: &Path, source: Source<'_>) -> Result<CubeTexture, IoError> {
    let damaged = |reason: &dyn std::fmt::Display| IoError::damaged(path, FORMAT, reason);
    let unsupported = |found: String| IoError::unsupported(path, FORMAT, found, EXPECTED);
    let mut start = [0; 128];
    source.read_exact(&mut start).map_err(|_| damaged(&"it ends too early"))?;
    let header = DdsHeader::read(&start[MAGIC.len()..]).map_err(|error| damaged(&error))?;
    let modern = match header.spf.fourcc {
        Some(FourCC(FourCC::DX10)) => Some(Header10::read(&mut *source).map_err(|error| damaged(&error))?),
        _ => None,
    };
    let caps2 = u32::from_le_bytes([start[CAPS2], start[CAPS2 + 1], start[CAPS2 + 2], start[CAPS2 + 3]]);
    let is_cube = match &modern {
        Some(modern) => modern.misc_flag.contains(MiscFlag::TEXTURECUBE) && modern.array_size <= 1,
        None => Caps2::from_bits_truncate(caps2).contains(Caps2::CUBEMAP | Caps2::CUBEMAP_ALLFACES),
    };
    if !is_cube {
        return Err(unsupported("a texture that is no cube of six faces".to_owned()));
    }
    if header.width != header.height || header.width == 0 {
        return Err(damaged(&format_args!("{}x{} pixels are no face of a cube", header.width, header.height)));
    }
    let (found, srgb) = match &modern {
        Some(modern) => modern_texels(modern.dxgi_format),
        None => (D3DFormat::try_from_pixel_format(&header.spf).and_then(texels), false),
    };
    let texels = found.ok_or_else(|| {
        let name = modern.as_ref().map(|modern| format!("{:?}", modern.dxgi_format));
        unsupported(format!("texels of the format {}", name.unwrap_or_else(|| format!("{:?}", header.spf))))
    })?;
    let premultiplied = modern.as_ref().is_some_and(|modern| modern.alpha_mode == DdsAlpha::PreMultiplied);
    let mut cube = CubeTexture {
        texels,
        transfer: if texels.depth() == Depth::Eight { srgb.then_some(Transfer::Srgb) } else { Some(Transfer::Linear) },
        primaries: None,
        complaints: Vec::new(),
        alpha: if premultiplied { AlphaMode::Premultiplied } else { AlphaMode::Straight },
        edge: header.width,
        row_alignment: 1,
        offsets: [0; 6],
        packed: None,
    };
    cube.check_levels(path, FORMAT, "dwMipMapCount", header.mip_map_count.unwrap_or(1))?;
    let first = start.len() as u64 + if modern.is_some() { 20 } else { 0 };
    let stride = face_stride(&cube, header.mip_map_count.unwrap_or(1));
    for (face, offset) in (0_u64..).zip(&mut cube.offsets) {
        *offset = stride
            .checked_mul(face)
            .and_then(|at| at.checked_add(first))
            .ok_or_else(|| damaged(&"it ends too early"))?;
    }
    Ok(cube)
}

/// Returns the bytes of a face with its mip levels, which follow it.
fn face_stride(cube: &CubeTexture, levels: u32) -> u64 {
    // A face of 2³¹ × 2³¹ pixels has 32 levels.
    (0..levels.clamp(1, 32)).map(|level| cube.level_bytes(level)).fold(0, u64::saturating_add)
}

/// Returns the encoding of texels of Direct3D 9, whose names begin with the highest byte.
fn texels(format: D3DFormat) -> Option<Texels> {
    Some(match format {
        D3DFormat::L8 => Texels::GREY8,
        D3DFormat::R8G8B8 => Texels::BGR8,
        D3DFormat::A8R8G8B8 => Texels::BGRA8,
        D3DFormat::X8R8G8B8 => Texels::BGRX8,
        D3DFormat::A8B8G8R8 => Texels::RGBA8,
        D3DFormat::X8B8G8R8 => Texels::RGBX8,
        D3DFormat::R16F => Texels::Half(1),
        D3DFormat::A16B16G16R16F => Texels::Half(4),
        D3DFormat::R32F => Texels::Float(1),
        D3DFormat::A32B32G32R32F => Texels::Float(4),
        D3DFormat::DXT1 => Texels::Blocks(BlockFormat::Bc1),
        D3DFormat::DXT3 => Texels::Blocks(BlockFormat::Bc2),
        D3DFormat::DXT5 => Texels::Blocks(BlockFormat::Bc3),
        _ => return None,
    })
}

/// Returns the encoding of texels of Direct3D 10 and later, and whether it is sRGB.
fn modern_texels(format: DxgiFormat) -> (Option<Texels>, bool) {
    let blocks = |format| Texels::Blocks(format);
    let (texels, srgb) = match format {
        DxgiFormat::R8_UNorm => (Texels::GREY8, false),
        DxgiFormat::R8G8B8A8_UNorm => (Texels::RGBA8, false),
        DxgiFormat::R8G8B8A8_UNorm_sRGB => (Texels::RGBA8, true),
        DxgiFormat::B8G8R8A8_UNorm => (Texels::BGRA8, false),
        DxgiFormat::B8G8R8A8_UNorm_sRGB => (Texels::BGRA8, true),
        DxgiFormat::B8G8R8X8_UNorm => (Texels::BGRX8, false),
        DxgiFormat::B8G8R8X8_UNorm_sRGB => (Texels::BGRX8, true),
        DxgiFormat::R16_Float => (Texels::Half(1), false),
        DxgiFormat::R16G16B16A16_Float => (Texels::Half(4), false),
        DxgiFormat::R32_Float => (Texels::Float(1), false),
        DxgiFormat::R32G32B32_Float => (Texels::Float(3), false),
        DxgiFormat::R32G32B32A32_Float => (Texels::Float(4), false),
        DxgiFormat::R11G11B10_Float => (Texels::SmallFloats, false),
        DxgiFormat::R9G9B9E5_SharedExp => (Texels::SharedExponent, false),
        DxgiFormat::BC1_UNorm => (blocks(BlockFormat::Bc1), false),
        DxgiFormat::BC1_UNorm_sRGB => (blocks(BlockFormat::Bc1), true),
        DxgiFormat::BC2_UNorm => (blocks(BlockFormat::Bc2), false),
        DxgiFormat::BC2_UNorm_sRGB => (blocks(BlockFormat::Bc2), true),
        DxgiFormat::BC3_UNorm => (blocks(BlockFormat::Bc3), false),
        DxgiFormat::BC3_UNorm_sRGB => (blocks(BlockFormat::Bc3), true),
        DxgiFormat::BC6H_UF16 => (blocks(BlockFormat::Bc6h { signed: false }), false),
        DxgiFormat::BC6H_SF16 => (blocks(BlockFormat::Bc6h { signed: true }), false),
        DxgiFormat::BC7_UNorm => (blocks(BlockFormat::Bc7), false),
        DxgiFormat::BC7_UNorm_sRGB => (blocks(BlockFormat::Bc7), true),
        _ => return (None, false),
    };
    (Some(texels), srgb)
}

/// Returns the header.
fn start(edge: u32, depth: Depth, levels: u32) -> Result<Vec<u8>, ddsfile::Error> {
    let caps2 = Some(Caps2::CUBEMAP | Caps2::CUBEMAP_ALLFACES);
    let float = match depth {
        Depth::Half => Some(DxgiFormat::R16G16B16A16_Float),
        Depth::Float => Some(DxgiFormat::R32G32B32A32_Float),
        _ => None,
    };
    let levels = (levels > 1).then_some(levels);
    let mut header = match float {
        Some(float) => DdsHeader::new_dxgi(edge, edge, None, float, levels, None, caps2)?,
        None => DdsHeader::new_d3d(edge, edge, None, D3DFormat::A8B8G8R8, levels, caps2)?,
    };
    header.caps |= Caps::COMPLEX;
    let mut start = MAGIC.to_vec();
    header.write(&mut start)?;
    if let Some(float) = float {
        Header10::new(float, true, D3D10ResourceDimension::Texture2D, 1, DdsAlpha::PreMultiplied).write(&mut start)?;
    }
    Ok(start)
}
