//! What a file is too short for is refused before memory or work is spent on it.

use super::{crc32, exr_of, giant_tiff, put_box, written};
use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};
use cosmorama_io::{
    Compression, Format, IoError, Limits, WriteOptions, probe, probe_from, read, read_from, write, write_to,
};
use std::io::Cursor;

/// Writes a size into a PNG's header.
fn put_size(png: &mut [u8], width: u32, height: u32) {
    png[16..24].copy_from_slice(&[width, height].map(u32::to_be_bytes).concat());
    let checksum = crc32(&png[12..29]);
    png[29..33].copy_from_slice(&checksum.to_be_bytes());
}

/// Files of each format whose headers declare more pixels than their bytes can hold: that costs no work for so many pixels.
#[test]
fn what_a_file_is_too_short_for_is_refused_by_its_header() {
    let [mut png, mut jpeg, mut tga, mut dds] = ["png", "jpg", "tga", "dds"].map(written);
    put_size(&mut png, 0x0f_0000, 0x0f00);
    let mut small = png.clone();
    // Bits enough, if each pixel had one.
    put_size(&mut small, 2000, 2000);
    let frame = jpeg.windows(2).position(|pair| pair == [0xff, 0xc0]).unwrap();
    jpeg[frame + 5..frame + 9].copy_from_slice(&[0x3a, 0x98, 0x75, 0x30]);
    tga[12..16].fill(0x7f);
    let edge = 5000_u32.to_le_bytes();
    dds[12..16].copy_from_slice(&edge);
    dds[16..20].copy_from_slice(&edge);
    let hdr = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 65535 +X 65535\n".to_vec();
    let mut window = exr_of(65535, 4096);
    put_box(&mut window, b"displayWindow\0box2i\0", [9, 9]);
    let files = [
        ("png", png, "983040x3840"),
        ("png", small, "2000x2000"),
        ("jpg", jpeg, "30000x15000"),
        ("tga", tga, "32639x32639"),
        ("hdr", hdr, "65535x65535"),
        ("exr", exr_of(65535, 4096), "65535x65535"),
        // The picture is small, but not the data of which it is a part.
        ("exr", window, "65535x65535"),
        ("tif", giant_tiff(), "65535x65535"),
        ("dds", dds, "5000x30000"),
    ];
    let folder = tempfile::tempdir().unwrap();
    for (extension, bytes, size) in files {
        let path = folder.path().join(format!("lie.{extension}"));
        std::fs::write(&path, &bytes).unwrap();
        let error = probe(&path).unwrap_err();
        let message = error.to_string();
        assert_eq!(message, read(&path, &Limits::NONE).map(|_| ()).unwrap_err().to_string());
        assert!(matches!(error, IoError::Damaged { .. }), "{message}");
        assert!(message.contains(&format!("its {} bytes cannot hold {size} pixels", bytes.len())), "{message}");
    }
}

/// The most that compressions of ours make of one colour is held.
#[test]
fn pictures_of_one_colour_are_not_called_too_short() {
    let folder = tempfile::tempdir().unwrap();
    for extension in ["png", "jpg", "tif", "tga", "hdr", "exr"] {
        let path = folder.path().join(format!("flat.{extension}"));
        let format = Format::from_extension(&path).unwrap();
        let depth = format.nearest_depth(Depth::Eight);
        let count = 2000 * 1000 * 3;
        let samples = match depth {
            Depth::Eight => Samples::U8(vec![0; count]),
            Depth::Half => Samples::Half(vec![half::f16::ZERO; count]),
            _ => Samples::Float(vec![0.0; count]),
        };
        let image = EncodedImage::new(2000, 1000, Channels::Rgb, depth, samples).unwrap();
        for compression in [Compression::None, Compression::Fast, Compression::Balanced, Compression::High] {
            write(&path, &image, &WriteOptions { compression, ..WriteOptions::default() }).unwrap();
            assert_eq!(probe(&path).unwrap().width, 2000, "{extension}, {compression:?}");
        }
    }
}

/// The message about a file whose header cannot be true, or is not supported.
fn refused(name: &str, bytes: &[u8]) -> String {
    let probed = probe_from(Cursor::new(bytes), name).map(|_| ()).unwrap_err().to_string();
    let read = read_from(Cursor::new(bytes), name, &Limits::NONE).map(|_| ()).unwrap_err().to_string();
    assert_eq!(probed, read);
    probed
}

/// A KTX 2 file whose cube has such an edge, packed into so many bytes by a scheme.
fn packed_cube(edge: u32, scheme: u32, packed: u64) -> Vec<u8> {
    let mut ktx2 = written("ktx2");
    ktx2[20..28].copy_from_slice(&[edge; 2].map(u32::to_le_bytes).concat());
    ktx2[44..48].copy_from_slice(&scheme.to_le_bytes());
    let bytes = u64::from(edge * edge * 6 * 8);
    ktx2[88..104].copy_from_slice(&[packed, bytes].map(u64::to_le_bytes).concat());
    ktx2
}

#[test]
fn packed_texels_have_limits() {
    // Of zlib a byte becomes 1032, of Zstandard 32768.
    for (scheme, edge, fits) in [(3, 24, 32), (2, 200, 64)] {
        let message = refused("cube.ktx2", &packed_cube(edge, scheme, fits - 8));
        assert!(
            message.contains(&format!("its {} bytes cannot hold {edge}x{} pixels", fits - 8, 6 * edge)),
            "{message}"
        );
        assert!(probe_from(Cursor::new(packed_cube(edge, scheme, fits)), "cube.ktx2").is_ok());
    }
}

#[test]
fn compressions_that_are_not_read_are_told_by_the_header() {
    for (method, name) in
        [(2, "fax"), (3, "fax"), (4, "fax"), (6, "JPEG"), (50_000, "Zstandard"), (50_001, "WebP"), (7777, "unknown")]
    {
        let mut tiff = giant_tiff();
        // The value of the fourth tag.
        tiff[10 + 3 * 12 + 8..][..4].copy_from_slice(&u32::to_le_bytes(method));
        let message = probe_from(Cursor::new(&tiff), "a.tif").unwrap_err().to_string();
        assert!(message.contains(&format!("compression {method}, ")) && message.contains(name), "{message}");
    }
}

/// A little-endian TIFF of grey, in JPEG: these bytes are its one strip or tile of so many columns and rows, and these the tables.
fn jpeg_tiff(size: [u32; 2], tile: Option<[u32; 2]>, jpeg: &[u8], tables: &[u8]) -> Vec<u8> {
    let (at, count) = (8, jpeg.len() as u32);
    let [width, height] = size;
    let mut entries = vec![(256, width), (257, height), (258, 8), (259, 7), (262, 1), (277, 1)];
    match tile {
        None => entries.extend([(273, at), (278, height), (279, count)]),
        Some([width, height]) => entries.extend([(322, width), (323, height), (324, at), (325, count)]),
    }
    entries.sort_unstable();
    let mut tiff = [&b"II\x2a\0"[..], &(8 + count + tables.len() as u32).to_le_bytes(), jpeg, tables].concat();
    tiff.extend((entries.len() as u16 + u16::from(!tables.is_empty())).to_le_bytes());
    let mut entry = |tag: u16, kind: u16, count: u32, value: u32| {
        tiff.extend([&tag.to_le_bytes()[..], &kind.to_le_bytes(), &count.to_le_bytes(), &value.to_le_bytes()].concat());
    };
    let (before, behind): (Vec<_>, Vec<_>) = entries.into_iter().partition(|(tag, _)| *tag < 347);
    before.into_iter().for_each(|(tag, value)| entry(tag, 4, 1, value));
    if !tables.is_empty() {
        entry(347, 7, tables.len() as u32, 8 + count);
    }
    behind.into_iter().for_each(|(tag, value)| entry(tag, 4, 1, value));
    tiff.extend([0; 4]);
    tiff
}

/// A strip in JPEG names a size of its own, for which the decoder would take memory.
#[test]
fn strips_in_jpeg_hold_what_they_declare() {
    // Fill bytes before a mark, and tables, are no way around.
    let frame = |start: &[u8]| [start, &[0xff, 0xff, 0xc0, 0, 11, 8, 0x40, 0, 0x40, 0, 1, 1, 0x11, 0]].concat();
    let scan = [0xff, 0xda, 0, 8, 1, 1, 0, 0, 63, 0, 0, 0];
    let alone = [frame(&[0xff, 0xd8]), scan.to_vec()].concat();
    let (behind, tables) = ([&[0xff, 0xd8][..], &scan].concat(), [frame(&[0xff, 0xd8]), vec![0xff, 0xd9]].concat());
    for tiff in [jpeg_tiff([64, 32], None, &alone, &[]), jpeg_tiff([64, 32], None, &behind, &tables)] {
        let message = read_from(Cursor::new(tiff), "a.tif", &Limits::NONE).map(|_| ()).unwrap_err().to_string();
        assert!(message.contains("bytes cannot hold 16384x16384 pixels"), "{message}");
    }
    // Tiles are filled up beyond the picture.
    let grey = EncodedImage::new(64, 64, Channels::Grey, Depth::Eight, Samples::U8(vec![90; 64 * 64])).unwrap();
    let mut jpeg = Cursor::new(Vec::new());
    write_to(&mut jpeg, "a.jpg", Format::Jpeg, &grey, &WriteOptions::default()).unwrap();
    let tiled = jpeg_tiff([60, 20], Some([64, 64]), jpeg.get_ref(), &[]);
    assert_eq!(read_from(Cursor::new(tiled), "a.tif", &Limits::NONE).unwrap().image.height(), 20);
}

/// A colour profile of 80 MB in some kilobytes.
#[test]
fn endless_profiles_are_not_unpacked() {
    let mut packed = flate2::write::ZlibEncoder::new(b"p\0\0".to_vec(), flate2::Compression::best());
    std::io::copy(&mut std::io::Read::take(std::io::repeat(0), 80 << 20), &mut packed).unwrap();
    let chunk = [b"iCCP", &packed.finish().unwrap()[..]].concat();
    let length = (chunk.len() as u32 - 4).to_be_bytes();
    let png = written("png");
    let bytes = [&png[..33], &length, &chunk, &crc32(&chunk).to_be_bytes(), &png[33..]].concat();
    let header = probe_from(Cursor::new(bytes), "a.png").unwrap();
    assert!(header.metadata.profile_fault.is_some_and(|fault| format!("{fault:?}").contains("cannot be unpacked")));
}

/// Damage in what a PNG says beside its pixels is damage, too: no text is lost in silence.
#[test]
fn checksums_of_all_chunks_are_looked_at() {
    let png = written("png");
    for kind in [b"tEXt", b"sRGB", b"zzZz"] {
        let chunk = [&kind[..], b"Software\0cosmorama"].concat();
        let chunk = if kind == b"sRGB" { &chunk[..5] } else { &chunk[..] };
        let length = (chunk.len() as u32 - 4).to_be_bytes();
        let with = |checksum: u32| [&png[..33], &length, chunk, &checksum.to_be_bytes(), &png[33..]].concat();
        assert!(probe_from(Cursor::new(with(crc32(chunk))), "a.png").is_ok());
        let message = refused("a.png", &with(crc32(chunk) ^ 1));
        assert!(message.contains("CRC"), "{message}");
    }
}
