use exr::block::chunk::{Chunk, CompressedBlock};
use exr::compression::Compression;

/// Places, among the eleven counters at the start of a DWA chunk, of those for the decompressed sizes of its sections.
/// The decoder allocates that much memory without a check.
const SIZES: [usize; 5] = [1, 6, 7, 8, 9];

/// Returns whether a chunk declares sizes that are plausible for a block of so many bytes. A lossy block is padded to
/// squares of 8 × 8, which may make a narrow one sixteen times as large.
pub(super) fn is_plausible(chunk: &Chunk, compression: Compression, block_bytes: u128) -> bool {
    if !matches!(compression, Compression::DWAA(_) | Compression::DWAB(_)) {
        return true;
    }
    let bytes = match &chunk.compressed_block {
        CompressedBlock::ScanLine(block) => &block.compressed_pixels_le,
        CompressedBlock::Tile(block) => &block.compressed_pixels_le,
        _ => return true,
    };
    let most = block_bytes.saturating_mul(16).saturating_add(1 << 16);
    let counter =
        |i: usize| bytes.get(8 * i..8 * i + 8).and_then(|bytes| bytes.try_into().ok()).map(u64::from_le_bytes);
    // A block that compression did not make smaller is stored as it is, without counters.
    bytes.len() as u128 == block_bytes || SIZES.iter().filter_map(|&i| counter(i)).all(|size| u128::from(size) <= most)
}

#[cfg(test)]
mod tests {
    use exr::block::chunk::CompressedScanLineBlock;

    use super::*;

    fn chunk(counters: [u64; 11]) -> Chunk {
        let compressed_pixels_le = counters.iter().flat_map(|counter| counter.to_le_bytes()).collect();
        let block = CompressedScanLineBlock { y_coordinate: 0, compressed_pixels_le };
        Chunk { layer_index: 0, compressed_block: CompressedBlock::ScanLine(block) }
    }

    #[test]
    fn a_chunk_that_asks_for_the_moon_is_refused() {
        let dwa = Compression::DWAA(None);
        assert!(is_plausible(&chunk([2, 4000, 90, 80, 70, 60, 500, 400, 300, 200, 1]), dwa, 10_000));
        for counter in SIZES {
            let mut counters = [0; 11];
            counters[counter] = 1 << 60;
            assert!(!is_plausible(&chunk(counters), dwa, 10_000), "{counter}");
            assert!(is_plausible(&chunk(counters), Compression::ZIP16, 10_000));
        }
    }
}
