use std::sync::Arc;

use cosmorama::raster::FramePool;

use crate::metadata::Metadata;
use crate::pending::Unfinished;

/// Options for writing a file, and the metadata to write into it.
#[derive(Clone, Debug)]
pub struct WriteOptions {
    /// JPEG quality, 1 to 100.
    pub quality: u8,
    /// Compression of PNG, TIFF and OpenEXR files, always lossless.
    pub compression: Compression,
    /// Metadata about the pixels; those that the format cannot hold are left out.
    pub metadata: Metadata,
    /// Registry of files in progress, which a signal handler removes; a private one unless given.
    pub unfinished: Unfinished,
    /// Pool of memory for samples in the file's order; the default keeps nothing.
    pub pool: Arc<FramePool>,
}

impl WriteOptions {
    /// Returns default options with this metadata.
    pub fn with_metadata(metadata: Metadata) -> Self {
        Self { metadata, ..Self::default() }
    }
}

impl Default for WriteOptions {
    fn default() -> Self {
        Self {
            quality: 95,
            compression: Compression::default(),
            metadata: Metadata::default(),
            unfinished: Unfinished::default(),
            pool: Arc::default(),
        }
    }
}

/// Trade-off between time and size in lossless compression.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Compression {
    /// No compression.
    None,
    /// Fast writing, and fast reading. PNG: fdeflate after the Up filter; TIFF: Deflate, level 1; OpenEXR: RLE.
    Fast,
    /// PNG: fdeflate after the filter that suits each row; TIFF: Deflate, level 1; OpenEXR: ZIP of 16 rows.
    #[default]
    Balanced,
    /// Small files. PNG: Deflate, level 6, after the filter that suits each row; TIFF: Deflate, level 6; OpenEXR: ZIP
    /// of 16 rows.
    High,
}
