/// How to write a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WriteOptions {
    /// JPEG quality, 1 to 100.
    pub quality: u8,
    /// How hard PNG, TIFF and OpenEXR files are pressed, always without loss.
    pub compression: Compression,
}

impl Default for WriteOptions {
    fn default() -> Self {
        Self { quality: 95, compression: Compression::default() }
    }
}

/// What time is spent on small files. Nothing is lost by any of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Compression {
    /// None: as large as the samples.
    None,
    /// For speed, of writing and of reading again. PNG: fdeflate after the Up filter; TIFF: Deflate, level 1; OpenEXR: RLE.
    Fast,
    /// PNG: fdeflate after the filter that suits each row; TIFF: Deflate, level 1; OpenEXR: ZIP of 16 rows.
    #[default]
    Balanced,
    /// For size. PNG: Deflate, level 6, after the filter that suits each row; TIFF: Deflate, level 6; OpenEXR: ZIP of 16 rows.
    High,
}
