use std::io;
use std::ops::Range;

use cosmorama::raster::{AlphaMode, Channels, Depth, EncodedImage, Samples};

/// A picture whose rows are made while it is written, so that it need not be held whole.
pub struct MadeRows<'a> {
    /// Columns and rows of the picture.
    pub size: (usize, usize),
    /// Channels of all rows.
    pub channels: Channels,
    /// Depth of all rows.
    pub depth: Depth,
    /// Relation of colours to alpha in all rows.
    pub alpha_mode: AlphaMode,
    /// Rows that are made at once, at most.
    pub at_once: usize,
    /// Makes rows of the picture; `None` ends the writing with an error. Each row is asked for once, from above. Before, a writer may
    /// ask for some of them, to see how well they are compressed.
    pub make: &'a mut (dyn FnMut(Range<usize>) -> Option<EncodedImage> + Send),
}

impl MadeRows<'_> {
    /// Visits rows, as many at once as are made together. The next ones are made meanwhile, if this thread has others beside it.
    pub(crate) fn visit<E: From<io::Error>>(
        &mut self,
        rows: Range<usize>,
        mut each: impl FnMut(&EncodedImage) -> Result<(), E>,
    ) -> Result<(), E> {
        let (at_once, end) = (self.at_once.max(1), rows.end);
        let part = |top: usize| top..end.min(top + at_once);
        let (mut top, mut made): (usize, Option<io::Result<EncodedImage>>) = (rows.start, None);
        while top < end {
            let here = made.take().unwrap_or_else(|| self.part(part(top)))?;
            top += at_once;
            rayon::in_place_scope(|scope| {
                if top < end {
                    scope.spawn(|_| made = Some(self.part(part(top))));
                }
                each(&here)
            })?;
        }
        Ok(())
    }

    /// Makes rows.
    pub(crate) fn part(&mut self, rows: Range<usize>) -> io::Result<EncodedImage> {
        (self.make)(rows).ok_or_else(|| io::Error::other("its rows were not made"))
    }

    /// Makes the whole picture, for a writer that needs all of it.
    pub(crate) fn held(mut self) -> io::Result<EncodedImage> {
        let ((width, height), channels, depth) = (self.size, self.channels, self.depth);
        let all = width * height * channels.count();
        let mut samples: Option<Samples> = None;
        self.visit(0..height, |rows| {
            match &mut samples {
                None => samples = Some(rows.samples().clone()),
                Some(above) => append(above, rows.samples(), all),
            }
            Ok::<(), io::Error>(())
        })?;
        let samples = samples.ok_or_else(|| io::Error::other("a picture without rows"))?;
        let image = EncodedImage::new(width, height, channels, depth, samples).map_err(io::Error::other)?;
        Ok(image.with_alpha_mode(self.alpha_mode))
    }
}

/// Appends samples of rows, which are of one kind with those above them, to what is to be so many.
fn append(above: &mut Samples, below: &Samples, all: usize) {
    fn put<S: Copy>(above: &mut Vec<S>, below: &[S], all: usize) {
        // Once: memory is then neither copied nor taken in excess.
        above.reserve_exact(all - above.len());
        above.extend_from_slice(below);
    }
    match (above, below) {
        (Samples::U8(above), Samples::U8(below)) => put(above, below, all),
        (Samples::U16(above), Samples::U16(below)) => put(above, below, all),
        (Samples::Half(above), Samples::Half(below)) => put(above, below, all),
        (Samples::Float(above), Samples::Float(below)) => put(above, below, all),
        _ => unreachable!("rows of one picture have one kind of samples"),
    }
}

/// A picture to be written.
pub(crate) enum Picture<'p, 'a> {
    /// A picture in memory.
    Held(&'p EncodedImage),
    /// A picture whose rows are made while they are written.
    Made(MadeRows<'a>),
}

impl Picture<'_, '_> {
    /// Returns columns and rows.
    pub(crate) fn size(&self) -> (usize, usize) {
        match self {
            Self::Held(image) => (image.width(), image.height()),
            Self::Made(rows) => rows.size,
        }
    }

    pub(crate) fn channels(&self) -> Channels {
        match self {
            Self::Held(image) => image.channels(),
            Self::Made(rows) => rows.channels,
        }
    }

    pub(crate) fn depth(&self) -> Depth {
        match self {
            Self::Held(image) => image.depth(),
            Self::Made(rows) => rows.depth,
        }
    }

    pub(crate) fn alpha_mode(&self) -> AlphaMode {
        match self {
            Self::Held(image) => image.alpha_mode(),
            Self::Made(rows) => rows.alpha_mode,
        }
    }

    /// Visits rows from above, as parts of pictures: each is a picture, and those of its rows that are meant.
    pub(crate) fn visit<E: From<io::Error>>(
        &mut self,
        rows: Range<usize>,
        mut each: impl FnMut(&EncodedImage, Range<usize>) -> Result<(), E>,
    ) -> Result<(), E> {
        match self {
            Self::Held(image) => each(image, rows),
            Self::Made(made) => made.visit(rows, |part| each(part, 0..part.height())),
        }
    }
}

#[cfg(test)]
mod tests {
    use half::f16;

    use super::*;
    use crate::{Compression, EnvMap, Metadata, WriteOptions, write, write_rows_hidden};

    /// Columns and rows: the last rows that are made together are fewer.
    const SIZE: (usize, usize) = (70, 1100);

    /// Makes a picture that is smooth above and noise below, so that a writer which judges it by its beginning would err.
    fn picture(channels: Channels, depth: Depth) -> EncodedImage {
        let count = SIZE.0 * SIZE.1 * channels.count();
        let mut state = 1u64;
        let codes = (0..count).map(|at| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            if at < count / 4 { (at / SIZE.0) as u16 } else { (state >> 48) as u16 }
        });
        let samples = match depth {
            Depth::Eight => Samples::U8(codes.map(|code| code as u8).collect()),
            Depth::Half => Samples::Half(codes.map(|code| f16::from_f32(f32::from(code) / 65535.0)).collect()),
            Depth::Float => Samples::Float(codes.map(|code| f32::from(code) / 65535.0).collect()),
            _ => Samples::U16(codes.collect()),
        };
        EncodedImage::new(SIZE.0, SIZE.1, channels, depth, samples).unwrap().with_alpha_mode(AlphaMode::Premultiplied)
    }

    #[test]
    fn rows_become_the_file_of_the_whole_picture() {
        let folder = tempfile::tempdir().unwrap();
        let (whole, by_rows) = (folder.path().join("whole"), folder.path().join("by_rows"));
        for (end, channels, depth) in [
            ("png", Channels::Rgb, Depth::Eight),
            ("png", Channels::Rgba, Depth::Sixteen),
            ("png", Channels::Grey, Depth::Ten),
            ("exr", Channels::Rgb, Depth::Half),
            ("exr", Channels::Rgba, Depth::Float),
            ("tif", Channels::Rgb, Depth::Eight),
            ("tif", Channels::Rgba, Depth::Sixteen),
            ("tif", Channels::GreyAlpha, Depth::Half),
            ("tif", Channels::Grey, Depth::Float),
            ("hdr", Channels::Rgb, Depth::Float),
            ("tga", Channels::Rgba, Depth::Eight),
            ("tga", Channels::Grey, Depth::Eight),
            ("jpg", Channels::Rgb, Depth::Eight),
            ("jpg", Channels::Grey, Depth::Eight),
        ] {
            for compression in [Compression::None, Compression::Fast, Compression::Balanced, Compression::High] {
                let image = picture(channels, depth);
                let options = WriteOptions { compression, ..WriteOptions::default() };
                let (whole, by_rows) = (whole.with_extension(end), by_rows.with_extension(end));
                write(&whole, &image, &options).unwrap();
                let alpha_mode = image.alpha_mode();
                let make = &mut |rows: Range<usize>| {
                    let part = image.cropped((0, rows.start), (SIZE.0, rows.len()));
                    Some(part.with_alpha_mode(alpha_mode))
                };
                let rows = MadeRows { size: SIZE, channels, depth, alpha_mode, at_once: 500, make };
                write_rows_hidden(&by_rows, rows, &options).unwrap().appear().unwrap();
                let read = |path| std::fs::read(path).unwrap();
                assert!(read(whole) == read(by_rows), "{end} of {channels}, {depth}, {compression:?}");
            }
        }
    }

    #[test]
    fn rows_of_a_texture_are_held() {
        let folder = tempfile::tempdir().unwrap();
        let (whole, by_rows) = (folder.path().join("whole.dds"), folder.path().join("by_rows.dds"));
        let cube = picture(Channels::Rgba, Depth::Half).cropped((0, 0), (64, 6 * 64));
        let options = WriteOptions::with_metadata(Metadata { envmap: Some(EnvMap::GlCube), ..Metadata::default() });
        write(&whole, &cube, &options).unwrap();
        let make = &mut |rows: Range<usize>| Some(cube.cropped((0, rows.start), (64, rows.len())));
        let (size, alpha_mode) = ((64, 6 * 64), cube.alpha_mode());
        let rows = MadeRows { size, channels: Channels::Rgba, depth: Depth::Half, alpha_mode, at_once: 100, make };
        write_rows_hidden(&by_rows, rows, &options).unwrap().appear().unwrap();
        assert!(std::fs::read(whole).unwrap() == std::fs::read(by_rows).unwrap());
    }

    #[test]
    fn a_picture_whose_rows_end_is_no_file() {
        for (end, depth) in [
            ("exr", Depth::Half),
            ("png", Depth::Sixteen),
            ("tif", Depth::Sixteen),
            ("hdr", Depth::Float),
            ("jpg", Depth::Eight),
            ("tga", Depth::Eight),
        ] {
            let folder = tempfile::tempdir().unwrap();
            let image = picture(Channels::Rgb, depth);
            let make = &mut |rows: Range<usize>| {
                (rows.end < 1000).then(|| image.cropped((0, rows.start), (SIZE.0, rows.len())))
            };
            let (channels, alpha_mode) = (image.channels(), image.alpha_mode());
            let rows = MadeRows { size: SIZE, channels, depth, alpha_mode, at_once: 100, make };
            assert!(
                write_rows_hidden(folder.path().join("a").with_extension(end), rows, &WriteOptions::default()).is_err()
            );
            assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "{end}");
        }
    }
}
