//! How weights come to stand beside the samples of their texels.

use fearless_simd::{Simd, i16x8, i16x32, prelude::*, u8x64};

/// Texels of a row that are worked on together.
pub(super) const GROUP: usize = 8;

/// How the weights of a row's texels come to stand where those are.
pub(super) struct Spread<S: Simd> {
    /// From where in the block that holds all of them.
    order: u8x64<S>,
    /// All bits where there is a texel, none beyond the last.
    pub(super) counts: i16x32<S>,
}

impl<S: Simd> Spread<S> {
    #[inline(always)]
    pub(super) fn of(simd: S, is_reversed: bool, count: usize) -> Self {
        let table = &SPREADS[usize::from(is_reversed)][count - 1];
        Self { order: u8x64::load_array_ref(simd, &table.order), counts: i16x32::load_array_ref(simd, &table.counts) }
    }

    /// A block of eight, each where its texel stands, both for all channels.
    #[inline(always)]
    pub(super) fn of_block(&self, block: i16x8<S>) -> i16x32<S> {
        self.counts.simd.swizzle_dyn_within_blocks_i16x32(i16x32::block_splat(block), self.order)
    }
}

/// From two texels in a block to pairs of one channel each.
pub(super) const PAIRS: [u8; 64] = {
    let block = [0, 1, 8, 9, 2, 3, 10, 11, 4, 5, 12, 13, 6, 7, 14, 15];
    let mut order = [0; 64];
    let mut at = 0;
    while at < 64 {
        order[at] = block[at % 16];
        at += 1;
    }
    order
};

/// A [`Spread`] in memory.
struct SpreadTable {
    order: [u8; 64],
    counts: [i16; 32],
}

/// By whether texels run the other way, and by how many there are.
static SPREADS: [[SpreadTable; GROUP]; 2] = {
    let mut spreads = [const { [const { SpreadTable { order: [14; 64], counts: [0; 32] } }; GROUP] }; 2];
    let mut way = 0;
    while way < 2 {
        let mut count = 1;
        while count <= GROUP {
            let mut sample = 0;
            while sample < 32 {
                // Blocks hold two texels, of which those of one channel stand beside each other.
                let texel = sample / 8 * 2 + sample % 2;
                // What lies beyond has no weight, and the bit of its place in a mask is zero.
                let mut weight = GROUP - 1;
                if texel < count {
                    weight = if way == 1 { count - 1 - texel } else { texel };
                    spreads[way][count - 1].counts[sample] = -1;
                }
                spreads[way][count - 1].order[2 * sample] = 2 * weight as u8;
                spreads[way][count - 1].order[2 * sample + 1] = 2 * weight as u8 + 1;
                sample += 1;
            }
            count += 1;
        }
        way += 1;
    }
    spreads
};

/// All bits of a texel that lies under the pixel, by the bits that tell which do.
pub(super) static MASKS: [[i16; GROUP]; 256] = {
    let mut masks = [[0; GROUP]; 256];
    let mut bits = 0;
    while bits < 256 {
        let mut texel = 0;
        while texel < GROUP {
            if bits >> texel & 1 == 1 {
                masks[bits][texel] = -1;
            }
            texel += 1;
        }
        bits += 1;
    }
    masks
};
