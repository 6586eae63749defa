//! Several pictures in one file: an error that counts them, unless those behind the first are previews or padding.

use std::io::Cursor;

use cosmorama::raster::{Channels, Depth, EncodedImage, Image, Rgba, Samples, Transfer};
use cosmorama_io::{Format, ImageFile, IoError, Limits, WriteOptions, probe_from, read_from, write_to};
use tiff::encoder::{TiffEncoder, colortype};
use tiff::tags::Tag;

fn grey(width: usize, height: usize) -> EncodedImage {
    let samples = (0..width * height).map(|k| (k * 37 % 251) as u8).collect();
    EncodedImage::new(width, height, Channels::Grey, Depth::Eight, Samples::U8(samples)).unwrap()
}

fn bytes(format: Format, image: &EncodedImage) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    write_to(&mut bytes, "in memory", format, image, &WriteOptions::default()).unwrap();
    bytes.into_inner()
}

/// A picture of 20 by 10 pixels in every format that may be piped.
fn pictures() -> Vec<Vec<u8>> {
    let light = |channels: Channels, depth| {
        let image = Image::filled(20, 10, Rgba::opaque(0.5, 0.25, 1.0));
        EncodedImage::encode(&image, channels, depth, &Transfer::Linear)
    };
    let deep = [
        (Format::Exr, Depth::Half),
        (Format::Exr, Depth::Float),
        (Format::Hdr, Depth::Float),
        (Format::Tiff, Depth::Half),
    ];
    let deep = deep.map(|(format, depth)| bytes(format, &light(Channels::Rgb, depth)));
    let flat = [Format::Png, Format::Jpeg, Format::Tiff].map(|format| bytes(format, &grey(20, 10)));
    flat.into_iter().chain(deep).chain([big_endian_tiff()]).collect()
}

/// A TIFF file as others write it: its pixels before its page.
fn big_endian_tiff() -> Vec<u8> {
    let mut bytes = [&b"MM\0*\0\0\0\xd0"[..], &[7; 200]].concat();
    let entries: [(u16, u16, u32); 8] =
        [(256, 3, 20), (257, 3, 10), (258, 3, 8), (259, 3, 1), (262, 3, 1), (273, 4, 8), (278, 3, 10), (279, 4, 200)];
    bytes.extend((entries.len() as u16).to_be_bytes());
    for (tag, kind, value) in entries {
        bytes.extend([tag.to_be_bytes(), kind.to_be_bytes()].concat());
        bytes.extend(1_u32.to_be_bytes());
        bytes.extend(if kind == 3 { (value << 16).to_be_bytes() } else { value.to_be_bytes() });
    }
    bytes.extend([0; 4]);
    bytes
}

fn read(bytes: &[u8]) -> Result<ImageFile, IoError> {
    read_from(Cursor::new(bytes), "in memory", &Limits::default())
}

fn assert_counts(bytes: &[u8], count: usize) {
    let error = read(bytes).err().map_or_else(String::new, |error| error.to_string());
    assert!(error.contains(&format!("holds {count} ")) && error.contains("a file of its own"), "{error}");
}

#[test]
fn pictures_one_behind_the_other_are_counted() {
    for one in pictures() {
        assert_counts(&one.repeat(2), 2);
        let error = read(&one.repeat(2)).err().map_or_else(String::new, |error| error.to_string());
        assert!(error.contains("frame_%04d.png"), "how a pipe becomes files: {error}");
        assert_counts(&one.repeat(24), 24);
        assert_counts(&[&one[..], &[0; 100], &one].concat(), 2);
    }
}

#[test]
fn padding_is_harmless() {
    for one in pictures() {
        for behind in
            [&[0; 3][..], &[0; 5000], b"\n", b"anything else", b"#?", b"II*\0\x08\0\0\0", b"\x76\x2f\x31\x01\x02\0\0\0"]
        {
            assert_eq!(read(&[&one[..], behind].concat()).unwrap().image.width(), 20);
        }
    }
}

#[test]
fn previews_of_cameras_are_no_pictures() {
    let (picture, preview) = (bytes(Format::Jpeg, &grey(20, 10)), bytes(Format::Jpeg, &grey(8, 4)));
    assert_eq!(read(&[&picture[..], &preview].concat()).unwrap().image.width(), 20);

    // What the file lists may be as large as the picture, as gain maps and second views are.
    let list = b"MPF\0MM\0\x2a\0\0\0\x08\0\x01\xb0\x01\0\x04\0\0\0\x01\0\0\0\x03\0\0\0\0";
    let segment = [&[0xff, 0xe2], &(list.len() as u16 + 2).to_be_bytes()[..], list].concat();
    let camera = [&picture[..2], &segment, &picture[2..], &picture, &preview].concat();
    assert_eq!(read(&camera).unwrap().image.width(), 20);
    let header = probe_from(Cursor::new(&camera), "in memory").unwrap();
    assert!(header.metadata.notes[0].contains("2 other pictures"), "{:?}", header.metadata.notes);
    assert!(probe_from(Cursor::new(&picture), "in memory").unwrap().metadata.notes.is_empty());
}

/// A TIFF file whose pages have these sizes and kinds.
fn pages(pages: &[(u32, u32, u32)]) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut bytes).unwrap();
    for (width, height, kind) in pages {
        let mut page = encoder.new_image::<colortype::Gray8>(*width, *height).unwrap();
        page.encoder().write_tag(Tag::NewSubfileType, *kind).unwrap();
        page.write_data(&vec![7; (width * height) as usize]).unwrap();
    }
    bytes.into_inner()
}

#[test]
fn pages_are_counted_and_copies_of_one_are_not() {
    let many = pages(&[(20, 10, 0), (20, 10, 2), (10, 5, 1), (20, 10, 0)]);
    assert_counts(&many, 3);
    assert!(probe_from(Cursor::new(&many), "in memory").is_err());
    let masked = pages(&[(20, 10, 0), (10, 5, 1), (20, 10, 4)]);
    assert_eq!(read(&masked).unwrap().image.width(), 20);
    let odd = pages(&[(20, 10, 0), (3, 5, 0)]);
    assert_eq!(read(&odd).unwrap().image.width(), 20);
    assert_eq!(probe_from(Cursor::new(&odd), "in memory").unwrap().metadata.notes.len(), 1);
}
