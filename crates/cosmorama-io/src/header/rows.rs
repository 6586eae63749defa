use std::io;
use std::ops::Range;

use cosmorama::raster::{AlphaMode, Channels, Depth, EncodedImage, Samples};

use super::Plane;
use crate::metadata::SampleKind;

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

/// A picture with named channels beside it, or such channels alone, whose rows are made while they are written.
pub struct MadeLayers<'a> {
    /// Columns and rows.
    pub size: (usize, usize),
    /// Channels and depth of the picture; `None` for channels alone.
    pub picture: Option<(Channels, Depth)>,
    /// Names of the picture's channels, in the order of its samples; plain R, G, B, Y and A, unless given.
    pub names: Vec<String>,
    /// Names and sample types of the further channels. One with the name of a picture's channel is left out.
    pub planes: Vec<(String, SampleKind)>,
    /// Rows that are made at once, at most.
    pub at_once: usize,
    /// Makes rows; `None` ends the writing with an error. Each row is asked for once, from above.
    pub make: &'a mut (dyn FnMut(Range<usize>) -> Option<LayeredRows> + Send),
}

/// Rows of a picture with named channels beside it.
pub struct LayeredRows {
    /// Rows of the picture, if there is one.
    pub picture: Option<EncodedImage>,
    /// Further channels in the same rows.
    pub planes: Vec<Plane>,
}

/// Visits rows, as many at once as are made together. The next ones are made meanwhile, if this thread has others beside it.
pub(crate) fn visit<P: Send, E: From<io::Error>>(
    rows: Range<usize>,
    at_once: usize,
    make: &mut (dyn FnMut(Range<usize>) -> Option<P> + Send),
    mut each: impl FnMut(P) -> Result<(), E>,
) -> Result<(), E> {
    let (at_once, end) = (at_once.max(1), rows.end);
    let mut part = |top: usize| make(top..end.min(top + at_once)).ok_or_else(not_made);
    let (mut top, mut made): (usize, Option<io::Result<P>>) = (rows.start, None);
    while top < end {
        let here = made.take().unwrap_or_else(|| part(top))?;
        top += at_once;
        rayon::in_place_scope(|scope| {
            if top < end {
                scope.spawn(|_| made = Some(part(top)));
            }
            each(here)
        })?;
    }
    Ok(())
}

fn not_made() -> io::Error {
    io::Error::other("its rows were not made")
}

impl MadeRows<'_> {
    /// Visits rows, as many at once as are made together.
    pub(crate) fn visit<E: From<io::Error>>(
        &mut self,
        rows: Range<usize>,
        each: impl FnMut(EncodedImage) -> Result<(), E>,
    ) -> Result<(), E> {
        visit(rows, self.at_once, &mut *self.make, each)
    }

    /// Makes rows.
    pub(crate) fn part(&mut self, rows: Range<usize>) -> io::Result<EncodedImage> {
        (self.make)(rows).ok_or_else(not_made)
    }

    /// Makes the whole picture, for a writer that needs all of it.
    pub(crate) fn held(mut self) -> io::Result<EncodedImage> {
        let ((width, height), channels, depth) = (self.size, self.channels, self.depth);
        let all = width * height * channels.count();
        let mut samples: Option<Samples> = None;
        self.visit(0..height, |rows| {
            match &mut samples {
                None => samples = Some(rows.into_samples()),
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
            Self::Made(made) => made.visit(rows, |part| each(&part, 0..part.height())),
        }
    }
}

#[cfg(test)]
mod tests {
    use half::f16;

    use super::*;
    use crate::{
        Compression, EnvMap, LayeredImage, Metadata, PlaneSamples, WriteOptions, write, write_layer_rows_hidden,
        write_layers, write_rows_hidden,
    };

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
    fn rows_with_named_channels_become_the_file_of_the_whole() {
        let folder = tempfile::tempdir().unwrap();
        let (whole, by_rows) = (folder.path().join("whole.exr"), folder.path().join("by_rows.exr"));
        let (light, numbers) = (picture(Channels::Rgba, Depth::Half), picture(Channels::Grey, Depth::Float));
        let Samples::Float(depths) = numbers.samples() else { panic!("no floats") };
        let named = |name: &str, samples| Plane { name: name.to_owned(), samples };
        let planes = |rows: Range<usize>| {
            let here = rows.start * SIZE.0..rows.end * SIZE.0;
            let labels = here.clone().map(|at| at as u32 * 7919).collect();
            vec![named("id", PlaneSamples::Uint(labels)), named("Z", PlaneSamples::Float(depths[here].to_vec()))]
        };
        let kinds = [("id", SampleKind::Uint), ("Z", SampleKind::Float)].map(|(name, kind)| (name.to_owned(), kind));
        for picture in [Some(&light), None] {
            let all = LayeredImage { size: SIZE, picture, names: Vec::new(), planes: planes(0..SIZE.1) };
            write_layers(&whole, all, &WriteOptions::default()).unwrap();
            let make = &mut |rows: Range<usize>| {
                let part = |image: &EncodedImage| {
                    image.cropped((0, rows.start), (SIZE.0, rows.len())).with_alpha_mode(image.alpha_mode())
                };
                Some(LayeredRows { picture: picture.map(part), planes: planes(rows.clone()) })
            };
            let picture = picture.map(|image| (image.channels(), image.depth()));
            let named = || (SIZE, Vec::new(), kinds.to_vec());
            let (size, names, kinds) = named();
            let layers = MadeLayers { size, picture, names, planes: kinds, at_once: 500, make };
            write_layer_rows_hidden(&by_rows, layers, &WriteOptions::default()).unwrap().appear().unwrap();
            assert!(std::fs::read(&whole).unwrap() == std::fs::read(&by_rows).unwrap(), "{picture:?}");
            // Rows without their labels.
            let make = &mut |rows: Range<usize>| Some(LayeredRows { picture: None, planes: planes(rows).split_off(1) });
            let (size, names, kinds) = named();
            let layers = MadeLayers { size, picture: None, names, planes: kinds, at_once: 500, make };
            assert!(write_layer_rows_hidden(&by_rows, layers, &WriteOptions::default()).is_err());
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
