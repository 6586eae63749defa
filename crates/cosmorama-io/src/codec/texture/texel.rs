use cosmorama::raster::{Channels, Depth, Samples};
use half::f16;

/// Encoding of a texture's texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Texels {
    /// Bytes: their number per texel, and the position of each channel among them.
    Bytes { stride: usize, places: &'static [usize] },
    /// Half floats: their number per texel.
    Half(usize),
    /// Single-precision floats: their number per texel.
    Float(usize),
    /// Nine bits for each colour with a shared exponent of five bits.
    SharedExponent,
    /// Floats of 11, 11 and 10 bits.
    SmallFloats,
    /// Compressed blocks of 4×4 texels.
    Blocks(BlockFormat),
}

/// Compression of a block of 4×4 texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BlockFormat {
    Bc1,
    Bc2,
    Bc3,
    Bc6h { signed: bool },
    Bc7,
}

impl Texels {
    pub(super) const GREY8: Self = Self::Bytes { stride: 1, places: &[0] };
    pub(super) const RGB8: Self = Self::Bytes { stride: 3, places: &[0, 1, 2] };
    pub(super) const BGR8: Self = Self::Bytes { stride: 3, places: &[2, 1, 0] };
    pub(super) const RGBA8: Self = Self::Bytes { stride: 4, places: &[0, 1, 2, 3] };
    pub(super) const BGRA8: Self = Self::Bytes { stride: 4, places: &[2, 1, 0, 3] };
    pub(super) const RGBX8: Self = Self::Bytes { stride: 4, places: &[0, 1, 2] };
    pub(super) const BGRX8: Self = Self::Bytes { stride: 4, places: &[2, 1, 0] };

    /// Returns the channels after decoding.
    pub(super) const fn channels(self) -> Channels {
        match self {
            Self::Bytes { places, .. } => channels_of(places.len()),
            Self::Half(count) | Self::Float(count) => channels_of(count),
            Self::SharedExponent | Self::SmallFloats | Self::Blocks(BlockFormat::Bc6h { .. }) => Channels::Rgb,
            Self::Blocks(_) => Channels::Rgba,
        }
    }

    /// Returns the depth after decoding. Halves hold the small floats exactly.
    pub(super) const fn depth(self) -> Depth {
        match self {
            Self::Bytes { .. } => Depth::Eight,
            Self::Float(_) => Depth::Float,
            Self::Half(_) | Self::SharedExponent | Self::SmallFloats => Depth::Half,
            Self::Blocks(BlockFormat::Bc6h { .. }) => Depth::Half,
            Self::Blocks(_) => Depth::Eight,
        }
    }

    /// Returns the edge of a block in texels.
    pub(super) const fn block_edge(self) -> u32 {
        match self {
            Self::Blocks(_) => 4,
            _ => 1,
        }
    }

    /// Returns the bytes of a block, or of a texel.
    pub(super) const fn block_bytes(self) -> u64 {
        match self {
            Self::Bytes { stride, .. } => stride as u64,
            Self::Half(count) => 2 * count as u64,
            Self::Float(count) => 4 * count as u64,
            Self::SharedExponent | Self::SmallFloats => 4,
            Self::Blocks(BlockFormat::Bc1) => 8,
            Self::Blocks(_) => 16,
        }
    }

    /// Returns the bits of a texel.
    pub(super) const fn bits(self) -> u64 {
        8 * self.block_bytes() / (self.block_edge() * self.block_edge()) as u64
    }

    /// Decodes the samples of a square face. `bytes` holds all of it, each row at a multiple of `alignment`.
    pub(super) fn decode(self, bytes: &[u8], edge: usize, alignment: usize) -> Samples {
        let row = edge.div_ceil(self.block_edge() as usize) * self.block_bytes() as usize;
        let rows = bytes.chunks_exact(row.next_multiple_of(alignment)).map(|padded| &padded[..row]);
        match self {
            Self::Bytes { stride, places } => {
                let texels = rows.flat_map(|row| row.chunks_exact(stride));
                Samples::U8(texels.flat_map(|texel| places.iter().map(|&place| texel[place])).collect())
            }
            Self::Half(_) => {
                let halves = rows.flat_map(|row| row.chunks_exact(2));
                Samples::Half(halves.map(|half| f16::from_le_bytes([half[0], half[1]])).collect())
            }
            Self::Float(_) => {
                let floats = rows.flat_map(|row| row.chunks_exact(4));
                Samples::Float(floats.map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect())
            }
            Self::SharedExponent => Samples::Half(words(rows).flat_map(shared_exponent).collect()),
            Self::SmallFloats => Samples::Half(words(rows).flat_map(small_floats).collect()),
            Self::Blocks(BlockFormat::Bc6h { signed }) => {
                let halves = blocks::<u16, 3>(rows, edge, 16, |block, texels| {
                    bcdec_rs::bc6h_half(block, texels, 4 * 3, signed);
                });
                Samples::Half(halves.into_iter().map(f16::from_bits).collect())
            }
            Self::Blocks(format) => {
                let bytes = self.block_bytes() as usize;
                Samples::U8(blocks::<u8, 4>(rows, edge, bytes, |block, texels| match format {
                    BlockFormat::Bc1 => bcdec_rs::bc1(block, texels, 4 * 4),
                    BlockFormat::Bc2 => bcdec_rs::bc2(block, texels, 4 * 4),
                    BlockFormat::Bc3 => bcdec_rs::bc3(block, texels, 4 * 4),
                    BlockFormat::Bc7 | BlockFormat::Bc6h { .. } => bcdec_rs::bc7(block, texels, 4 * 4),
                }))
            }
        }
    }
}

const fn channels_of(count: usize) -> Channels {
    match count {
        1 => Channels::Grey,
        3 => Channels::Rgb,
        _ => Channels::Rgba,
    }
}

fn words<'a>(rows: impl Iterator<Item = &'a [u8]>) -> impl Iterator<Item = u32> {
    rows.flat_map(|row| row.chunks_exact(4)).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
}

/// Decodes red in the lowest nine bits, then green and blue, with the exponent on top: m · 2^(e − 24).
fn shared_exponent(word: u32) -> [f16; 3] {
    let scale = f32::from_bits((127 + (word >> 27) - 24) << 23);
    [0, 9, 18].map(|shift| f16::from_f32((word >> shift & 0x1ff) as f32 * scale))
}

/// Decodes red in the lowest eleven bits, then green, and blue in ten: halves without sign and with fewer digits.
fn small_floats(word: u32) -> [f16; 3] {
    [word << 4 & 0x7ff0, word >> 7 & 0x7ff0, word >> 17 & 0x7fe0].map(|bits| f16::from_bits(bits as u16))
}

/// Converts rows of blocks to rows of texels, cut off at the edge.
fn blocks<'a, S: Copy + Default, const COUNT: usize>(
    rows: impl Iterator<Item = &'a [u8]>,
    edge: usize,
    block_bytes: usize,
    decode: impl Fn(&[u8], &mut [S]),
) -> Vec<S> {
    let mut samples = vec![S::default(); edge * edge * COUNT];
    let mut texels = vec![S::default(); 16 * COUNT];
    for (row, blocks) in rows.enumerate() {
        for (column, block) in blocks.chunks_exact(block_bytes).enumerate() {
            decode(block, &mut texels);
            let width = (edge - column * 4).min(4) * COUNT;
            for (j, texels) in texels.chunks_exact(4 * COUNT).enumerate().take(edge - row * 4) {
                let at = ((row * 4 + j) * edge + column * 4) * COUNT;
                samples[at..at + width].copy_from_slice(&texels[..width]);
            }
        }
    }
    samples
}

#[cfg(test)]
mod tests {
    use super::*;

    fn halves(texels: Texels, word: u32) -> Vec<f32> {
        match texels.decode(&word.to_le_bytes(), 1, 1) {
            Samples::Half(halves) => halves.into_iter().map(f16::to_f32).collect(),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn packed_floats() {
        // One is mantissa 256 and exponent 16: 256 · 2^(16 − 24).
        let one = 256 | 128 << 9 | 511 << 18 | 16 << 27;
        assert_eq!(halves(Texels::SharedExponent, one), [1.0, 0.5, 511.0 / 256.0]);
        assert_eq!(halves(Texels::SharedExponent, 1), [f32::powi(2.0, -24), 0.0, 0.0]);
        // Exponent 15 without mantissa is one.
        assert_eq!(halves(Texels::SmallFloats, 15 << 6 | 16 << 17 | 14 << 27), [1.0, 2.0, 0.5]);
    }

    #[test]
    fn a_face_that_is_no_multiple_of_a_block_is_cut_off() {
        // White: both ends of the ramp are 0xffff.
        let white = [0xff, 0xff, 0xff, 0xff, 0, 0, 0, 0].repeat(4);
        assert_eq!(Texels::Blocks(BlockFormat::Bc1).decode(&white, 5, 1), Samples::U8(vec![255; 5 * 5 * 4]));
    }

    #[test]
    fn rows_may_be_padded() {
        let bytes = [1, 2, 3, 0, 4, 5, 6, 0];
        assert_eq!(Texels::GREY8.decode(&bytes[..8], 2, 4), Samples::U8(vec![1, 2, 4, 5]));
        assert_eq!(Texels::BGR8.decode(&bytes[..4], 1, 4), Samples::U8(vec![3, 2, 1]));
    }
}
