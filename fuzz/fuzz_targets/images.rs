//! Image files: PNG, JPEG, TIFF, TGA, Radiance, OpenEXR, KTX 2, KTX and DDS, with the metadata inside of them.
#![no_main]

use std::io::Cursor;

use cosmorama::raster::{Channels, Depth, Primaries, Transfer};
use cosmorama_fuzz::{MEMORY, bytes_of, path, picture, prepare};
use cosmorama_io::{
    Choice, Compression, EnvMap, Format, IoError, Metadata, Pose, Window, WriteOptions, check_chosen, probe_from,
    read_from, read_layers, read_pairs_from, write,
};
use libfuzzer_sys::fuzz_target;

/// TGA has no first bytes that tell it: whatever no other reader knows is given to its reader by this name.
const NAME: &str = "picture.tga";

fuzz_target!(init: prepare(seeds), |bytes: &[u8]| {
    let _ = probe_from(Cursor::new(bytes), NAME);
    let checked = check_chosen(Cursor::new(bytes), NAME, &MEMORY, &Choice::default());
    match read_from(Cursor::new(bytes), NAME, &MEMORY) {
        Ok(file) => {
            assert!(checked.is_ok(), "a check refuses what can be read: {checked:?}");
            drop(file.to_light());
        }
        // A check takes less memory.
        Err(IoError::TooLarge { .. }) => {}
        Err(error) => assert!(checked.is_err(), "a check finds whole what cannot be read: {error}"),
    }
    let _ = read_layers(Cursor::new(bytes), NAME, &MEMORY, (&Choice::default(), &["R"]));
    let _ = read_pairs_from(Cursor::new(bytes), NAME, &MEMORY);
});

/// A file of each format, of each number of channels and of each compression that it takes, as we write them; and a KTX.
fn seeds() -> Vec<(String, Vec<u8>)> {
    let formats = ["png", "jpg", "tif", "tga", "hdr", "exr", "ktx2", "dds"];
    let kinds = [
        (Channels::Grey, Compression::None),
        (Channels::Rgb, Compression::Fast),
        (Channels::Rgba, Compression::Balanced),
    ];
    let all = formats.into_iter().flat_map(|format| kinds.map(|kind| (format, kind)));
    let seeds = all.filter_map(|(format, kind)| Some((format!("{:?}.{format}", kind.0), seed(format, kind)?)));
    seeds.chain([("Rgb.ktx".to_owned(), ktx())]).collect()
}

fn seed(extension: &str, (channels, compression): (Channels, Compression)) -> Option<Vec<u8>> {
    let path = path(&format!("seed.{extension}"));
    let depth = match Format::from_extension(&path).ok()?.nearest_depth(Depth::Sixteen) {
        Depth::Half => Depth::Float,
        depth => depth,
    };
    let (size, envmap) = match extension {
        "ktx2" | "dds" => ((4, 24), Some(EnvMap::GlCube)),
        _ => ((12, 9), None),
    };
    let metadata = Metadata {
        envmap,
        transfer: Some(Transfer::Srgb),
        primaries: Some(Primaries::P3_D65),
        panorama: Some(Window { canvas_width: 24, canvas_height: 12, x: 3, y: 2 }),
        pose: Some(Pose { heading: 10.0, pitch: 5.0, roll: -3.0 }),
        origin: Some("0.2.0, geometry 0123abcd".to_owned()),
        ..Metadata::default()
    };
    let options = WriteOptions { compression, ..WriteOptions::with_metadata(metadata) };
    write(&path, &picture(size, channels, depth), &options).ok()?;
    Some(bytes_of(&path))
}

/// A cube of bytes in RGB, whose rows are padded to four bytes (KTX 1, section 2).
fn ktx() -> Vec<u8> {
    const EDGE: u32 = 3;
    let texels = [7; 6 * 3 * (3 * 3 + 3)];
    let numbers = [0x0403_0201, 0x1401, 1, 0x1907, 0x1907, 0x1907, EDGE, EDGE, 0, 0, 6, 1, 0, texels.len() as u32 / 6];
    let numbers = numbers.map(u32::to_le_bytes).concat();
    [b"\xabKTX 11\xbb\r\n\x1a\n", &numbers[..], &texels].concat()
}
