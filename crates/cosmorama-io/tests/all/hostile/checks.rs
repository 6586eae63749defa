//! A check finds what reading finds: whole files in little memory, and in damaged ones every fault.

use std::io::Cursor;
use std::time::Instant;

use super::LONGEST;
use crate::common::picture;
use cosmorama::raster::{AlphaMode, Channels, Depth, EncodedImage, FramePool, Samples};
use cosmorama_io::{
    Choice, Compression, Format, IoError, Limits, WriteOptions, check_chosen, read_chosen, write_levels, write_planes,
    write_to,
};
use exr::prelude::{self as openexr, WritableImage};
use testkit::Mutants;
use tiff::encoder::{TiffEncoder, TiffKind, TiffKindBig, TiffKindStandard};
use tiff::tags::Tag;

/// A good file, and what is read of it.
struct Good {
    name: String,
    bytes: Vec<u8>,
    choice: Choice,
}

impl Good {
    fn new(name: impl Into<String>, bytes: Vec<u8>) -> Self {
        Self { name: name.into(), bytes, choice: Choice::default() }
    }

    fn check(&self, bytes: &[u8], limits: &Limits) -> Result<(), IoError> {
        check_chosen(Cursor::new(bytes), &self.name, limits, &self.choice)
    }

    fn read(&self, bytes: &[u8], limits: &Limits) -> Result<(), IoError> {
        read_chosen(Cursor::new(bytes), &self.name, (limits, &FramePool::default()), &self.choice).map(drop)
    }

    /// Checks and reads a damaged copy. One that says it is too large for memory may be whole.
    fn assert_agrees(&self, bytes: &[u8], damage: &str) {
        let (limits, start) = (Limits::memory(1 << 22), Instant::now());
        let (checked, read) = (self.check(bytes, &limits), self.read(bytes, &limits));
        let are_one = checked.is_ok() == read.is_ok() || matches!(read, Err(IoError::TooLarge { .. }));
        assert!(are_one, "{}, {damage}: check {checked:?}, read {read:?}", self.name);
        assert!(start.elapsed() < LONGEST, "{}, {damage}: {:?}", self.name, start.elapsed());
    }
}

/// A file as we write it.
fn ours(format: Format, image: &EncodedImage, compression: Compression) -> Good {
    let mut bytes = Cursor::new(Vec::new());
    let options = WriteOptions { compression, ..WriteOptions::default() };
    let name = format!("ours.{}", format!("{format:?}").to_lowercase());
    write_to(&mut bytes, &name, format, image, &options).unwrap();
    Good::new(format!("{compression:?}, {}, {name}", image.depth()), bytes.into_inner())
}

fn all_of_ours(width: usize, height: usize) -> Vec<Good> {
    [
        (Format::Png, Depth::Eight),
        (Format::Jpeg, Depth::Eight),
        (Format::Tiff, Depth::Eight),
        (Format::Tiff, Depth::Half),
        (Format::Tiff, Depth::Float),
        (Format::Exr, Depth::Half),
        (Format::Exr, Depth::Float),
        (Format::Hdr, Depth::Float),
        (Format::Tga, Depth::Eight),
    ]
    .into_iter()
    .flat_map(|(format, depth)| {
        let image = picture(width, height, Channels::Rgb, depth);
        let all = [Compression::None, Compression::Balanced];
        let count = if format.has_compression() { 2 } else { 1 };
        all.into_iter().take(count).map(|compression| ours(format, &image, compression)).collect::<Vec<_>>()
    })
    .collect()
}

/// Bytes of an RGB picture that is not quite flat.
fn samples(width: usize, height: usize) -> Vec<u8> {
    (0..width * height * 3).map(|at| (at / 40 * 7 % 250) as u8).collect()
}

/// A TIFF in tiles, or in strips if these are as wide as the picture; packed by deflate or not at all.
fn tiff_of<K: TiffKind>(
    name: &str,
    (width, height): (usize, usize),
    (across, down): (usize, usize),
    is_packed: bool,
) -> Good {
    let (all, mut bytes) = (samples(width, height), Cursor::new(Vec::new()));
    let mut encoder = TiffEncoder::<_, K>::new_generic(&mut bytes).unwrap();
    let mut tags = encoder.image_directory().unwrap();
    let (mut places, mut lengths) = (Vec::new(), Vec::new());
    for top in (0..height).step_by(down) {
        for left in (0..width).step_by(across) {
            let is_strip = across == width;
            let rows = if is_strip { down.min(height - top) } else { down };
            let mut chunk = Vec::new();
            for y in top..top + rows {
                // What is outside the picture is padding.
                let row = (left..left + across).flat_map(|x| {
                    let at = (y.min(height - 1) * width + x.min(width - 1)) * 3;
                    all[at..at + 3].iter().copied()
                });
                chunk.extend(row);
            }
            if is_packed {
                let mut zlib = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
                std::io::Write::write_all(&mut zlib, &chunk).unwrap();
                chunk = zlib.finish().unwrap();
            }
            places.push(K::convert_offset(tags.write_data(&chunk[..]).unwrap()).unwrap());
            lengths.push(K::convert_offset(chunk.len() as u64).unwrap());
        }
    }
    let is_strip = across == width;
    let mut numbers = vec![(Tag::ImageWidth, width), (Tag::ImageLength, height)];
    numbers.extend([(Tag::Compression, if is_packed { 8 } else { 1 }), (Tag::PhotometricInterpretation, 2)]);
    numbers.push((Tag::SamplesPerPixel, 3));
    match is_strip {
        true => numbers.push((Tag::RowsPerStrip, down)),
        false => numbers.extend([(Tag::TileWidth, across), (Tag::TileLength, down)]),
    }
    for (tag, number) in numbers {
        tags.write_tag(tag, number as u32).unwrap();
    }
    tags.write_tag(Tag::BitsPerSample, &[8_u16; 3][..]).unwrap();
    let (place, length) =
        if is_strip { (Tag::StripOffsets, Tag::StripByteCounts) } else { (Tag::TileOffsets, Tag::TileByteCounts) };
    tags.write_tag(place, K::convert_slice(&places)).unwrap();
    tags.write_tag(length, K::convert_slice(&lengths)).unwrap();
    tags.finish().unwrap();
    Good::new(format!("{name}.tif"), bytes.into_inner())
}

fn all_of_tiff(size: (usize, usize)) -> Vec<Good> {
    let (strip, tile) = ((size.0, 7), (16, 16));
    vec![
        tiff_of::<TiffKindStandard>("strips", size, strip, false),
        tiff_of::<TiffKindStandard>("packed strips", size, strip, true),
        tiff_of::<TiffKindStandard>("tiles", size, tile, false),
        tiff_of::<TiffKindStandard>("packed tiles", size, tile, true),
        tiff_of::<TiffKindBig>("big, packed strips", size, strip, true),
        tiff_of::<TiffKindBig>("big, tiles", size, tile, false),
    ]
}

/// An OpenEXR file of halves by the decoder's own library.
fn exr_of(
    (width, height): (usize, usize),
    compression: openexr::Compression,
    blocks: openexr::Blocks,
    display: Option<(i32, usize)>,
) -> Good {
    let channel = |(name, add): (&str, usize)| {
        let halves = (0..width * height).map(|at| half::f16::from_f32(((at / 9 + add) % 61) as f32 / 61.0));
        openexr::AnyChannel::new(name, openexr::FlatSamples::F16(halves.collect()))
    };
    let encoding = openexr::Encoding { compression, blocks, line_order: openexr::LineOrder::Increasing };
    let channels =
        openexr::AnyChannels::sort([("R", 0), ("G", 9), ("B", 30), ("Z", 5)].map(channel).into_iter().collect());
    let attributes = openexr::LayerAttributes::named("a layer");
    let mut image = openexr::Image::from_layer(openexr::Layer::new((width, height), attributes, encoding, channels));
    if let Some((first, side)) = display {
        image.attributes.display_window = openexr::IntegerBounds::new((first, first), (side, side));
    }
    let mut bytes = Cursor::new(Vec::new());
    image.write().non_parallel().to_buffered(&mut bytes).unwrap();
    Good::new(format!("{compression}, {blocks:?}, {display:?}.exr"), bytes.into_inner())
}

fn all_of_exr(size: (usize, usize)) -> Vec<Good> {
    use openexr::{Blocks, Compression, Vec2};
    let lines = [
        Compression::Uncompressed,
        Compression::RLE,
        Compression::ZIP1,
        Compression::ZIP16,
        Compression::PIZ,
        Compression::PXR24,
        Compression::B44,
        Compression::B44A,
    ];
    let tiles = Blocks::Tiles(Vec2(16, 16));
    let mut all: Vec<_> = lines.map(|compression| exr_of(size, compression, Blocks::ScanLines, None)).into();
    all.push(exr_of(size, Compression::ZIP16, tiles, None));
    all.push(exr_of(size, Compression::PIZ, tiles, None));
    // A display window inside the data window, and one that lies partly outside.
    all.push(exr_of(size, Compression::ZIP16, Blocks::ScanLines, Some((5, 10))));
    all.push(exr_of(size, Compression::RLE, tiles, Some((-6, 20))));
    all
}

/// OpenEXR files that are no plain pictures: mip levels, and numbers alone.
fn odd_exr() -> [Good; 2] {
    let folder = tempfile::tempdir().unwrap();
    let (levels, planes) = (folder.path().join("levels.exr"), folder.path().join("planes.exr"));
    let sizes = [(40, 20), (20, 10), (10, 5), (5, 2), (2, 1), (1, 1)];
    let images = sizes.map(|(width, height)| picture(width, height, Channels::Rgb, Depth::Half));
    write_levels(&levels, &images, &WriteOptions::default()).unwrap();
    let plane = |add: usize| (0..40 * 30).map(|at| (at % 23 + add) as f32).collect();
    write_planes(&planes, (40, 30), vec![("u", plane(0)), ("Z", plane(9))], Depth::Float, &WriteOptions::default())
        .unwrap();
    let [levels, planes] = [levels, planes].map(|path| std::fs::read(path).unwrap());
    let choice = Choice { without_picture: true, ..Choice::default() };
    [Good::new("levels.exr", levels), Good { choice, ..Good::new("numbers.exr", planes) }]
}

/// TIFF files that say they are premultiplied: one that is, and one that is not and is refused.
fn premultiplied() -> [Good; 2] {
    [60, 255].map(|colour| {
        let pixels = (0..40 * 30).flat_map(|at| [colour, colour / 2, 0, 60 + (at % 90) as u8]);
        let image = EncodedImage::new(40, 30, Channels::Rgba, Depth::Eight, Samples::U8(pixels.collect())).unwrap();
        ours(Format::Tiff, &image.with_alpha_mode(AlphaMode::Premultiplied), Compression::None)
    })
}

/// TGA files as others write them: colours by places in a map, from the bottom, in runs that go on in the next row.
fn mapped_tga() -> [Good; 2] {
    let colours: Vec<u8> = (0..3 * 20).collect();
    let start = |kind: u8| [&[0, 1, kind, 2, 0, 20, 0, 24, 0, 0, 0, 0, 30, 0, 8, 0, 8, 0], &colours[..]].concat();
    let plain: Vec<u8> = (0..30 * 8).map(|at| 2 + at % 20).collect();
    let runs = (0..4).flat_map(|at| [0x80 | 47, 2 + at, 11, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14]);
    let names = ["mapped.tga", "mapped runs.tga"];
    let [plain, runs] = [[start(1), plain].concat(), [start(9), runs.collect()].concat()];
    [Good::new(names[0], plain), Good::new(names[1], runs)]
}

/// Radiance files in the two older encodings.
fn old_hdr() -> [Good; 2] {
    let start = |width| format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 20 +X {width}\n").into_bytes();
    let plain = (0..5 * 20).flat_map(|at| [at, 2 * at, 200 - at, 128]).collect();
    let runs = [9, 8, 7, 128, 1, 1, 1, 20, 6, 5, 4, 129, 1, 1, 1, 8].repeat(20);
    [Good::new("plain.hdr", [start(5), plain].concat()), Good::new("runs.hdr", [start(30), runs].concat())]
}

#[test]
fn checks_find_in_damaged_files_what_reading_finds() {
    let size = (40, 30);
    let mut all = all_of_ours(size.0, size.1);
    all.extend(all_of_tiff(size));
    all.extend(all_of_exr(size));
    all.extend(odd_exr());
    all.extend(premultiplied());
    all.extend(mapped_tga());
    all.extend(old_hdr());
    for (good, seed) in all.iter().zip(50..) {
        let bytes = &good.bytes;
        good.assert_agrees(bytes, "whole");
        let refused = good.check(bytes, &Limits::default()).err().map(|error| error.to_string());
        assert!(
            refused.iter().all(|reason| reason.contains("say that alpha is straight")),
            "{}: {refused:?}",
            good.name
        );
        let step = 1 + bytes.len() / 60;
        for length in (0..bytes.len()).step_by(step).chain(bytes.len().saturating_sub(12)..bytes.len()) {
            good.assert_agrees(&bytes[..length], &format!("cut to {length} of {} bytes", bytes.len()));
        }
        for (mutant, damaged) in Mutants::new(bytes, &[], seed).take(Mutants::count(90)).enumerate() {
            good.assert_agrees(&damaged, &format!("mutant {mutant}"));
        }
    }
}

/// What a check holds is a row, a strip, a tile or a block.
#[test]
fn checks_of_whole_files_take_little_memory() {
    let size @ (width, height) = (32, 600);
    let quarter = |pixels: usize, bytes: usize| Limits::memory((pixels * bytes / 4) as u64);
    let flat = |(format, width, depth): (Format, usize, Depth)| {
        let count = width * 1500 * 3;
        let samples = match depth {
            Depth::Half => Samples::Half(vec![half::f16::ONE; count]),
            Depth::Float => Samples::Float(vec![1.0; count]),
            _ => Samples::U8(vec![200; count]),
        };
        let image = EncodedImage::new(width, 1500, Channels::Rgb, depth, samples).unwrap();
        (ours(format, &image, Compression::Balanced), quarter(width * 1500, 3 * depth.bytes()))
    };
    let whole = |good: &Good| good.name.contains("None");
    let mut all: Vec<_> = all_of_tiff(size).into_iter().map(|good| (good, quarter(width * height, 3))).collect();
    all.extend(all_of_exr(size).into_iter().filter(whole).map(|good| (good, quarter(width * height, 6))));
    // Our strips have a megabyte.
    let of_ours = [
        (Format::Png, 100, Depth::Eight),
        (Format::Tga, 100, Depth::Eight),
        (Format::Tiff, 1000, Depth::Eight),
        (Format::Exr, 100, Depth::Half),
        (Format::Hdr, 100, Depth::Float),
    ];
    all.extend(of_ours.map(flat));
    for (good, limits) in all {
        let name = &good.name;
        assert_eq!(good.check(&good.bytes, &limits).map_err(|error| error.to_string()), Ok(()), "{name}");
        assert!(matches!(good.read(&good.bytes, &limits), Err(IoError::TooLarge { .. })), "{name}");
        let nothing = good.check(&good.bytes, &Limits::memory(1));
        let takes_none = [".png", ".tga"].iter().any(|end| name.ends_with(end));
        assert!(if takes_none { nothing.is_ok() } else { matches!(nothing, Err(IoError::TooLarge { .. })) }, "{name}");
    }
}

/// Parts of which one alone is too large, in files of a few bytes.
#[test]
fn checks_refuse_giant_parts_before_memory_is_taken() {
    let hdr = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 4294967295\n".to_vec();
    let mut tall = super::exr_of(65535, 4096);
    super::put_box(&mut tall, b"displayWindow\0box2i\0", [9, 9]);
    let files = [("strip.tif", super::giant_tiff()), ("line.hdr", hdr), ("block.exr", tall)];
    for (name, bytes) in files {
        let good = Good::new(name, bytes);
        let little = good.check(&good.bytes, &Limits::memory(1 << 16)).unwrap_err();
        let most = good.check(&good.bytes, &Limits::memory(1 << 40)).unwrap_err();
        for error in [little, most] {
            assert!(matches!(error, IoError::TooLarge { .. } | IoError::Damaged { .. }), "{name}: {error}");
        }
    }
}
