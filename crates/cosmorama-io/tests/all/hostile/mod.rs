//! Files are hostile: errors, never panics, and no memory for what is only declared.

mod capacity;
mod checks;
mod texts;

use std::path::Path;
use std::time::{Duration, Instant};

use crate::common::picture;
use cosmorama::raster::{Channels, Depth};
use cosmorama_io::{EnvMap, Format, IoError, Limits, Metadata, WriteOptions, probe, read, read_pairs, write};
use proptest::prelude::*;
use testkit::Mutants;

const EXTENSIONS: [&str; 9] = ["png", "jpg", "tif", "tga", "hdr", "exr", "ktx2", "dds", "ktx"];

fn written(extension: &str) -> Vec<u8> {
    if extension == "ktx" {
        return crate::common::ktx(6, 0x1401, 0x1907, &[7; 6 * 6 * (6 * 3 + 2)]);
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(format!("a.{extension}"));
    let depth = Format::from_extension(&path).unwrap().nearest_depth(Depth::Half);
    let (image, envmap) = match extension {
        "ktx2" | "dds" => (picture(6, 36, Channels::Rgba, depth), Some(EnvMap::GlCube)),
        _ => (picture(40, 30, Channels::Rgb, depth), None),
    };
    write(&path, &image, &WriteOptions::with_metadata(Metadata { envmap, ..Metadata::default() })).unwrap();
    std::fs::read(path).unwrap()
}

fn read_bytes(folder: &Path, extension: &str, bytes: &[u8]) -> Result<(), IoError> {
    let path = folder.join(format!("hostile.{extension}"));
    std::fs::write(&path, bytes).unwrap();
    let _ = probe(&path);
    read(&path, &Limits::memory(1 << 24)).map(drop)
}

#[test]
fn truncated_files_are_errors_at_every_length() {
    let folder = tempfile::tempdir().unwrap();
    for extension in EXTENSIONS {
        let bytes = written(extension);
        // The last bytes of a TGA are a footer that no one needs.
        let needed = if extension == "tga" { bytes.len() - 26 } else { bytes.len() };
        let step = (needed / 200).max(1);
        for length in (0..needed).step_by(step).chain(needed.saturating_sub(20)..needed) {
            let result = read_bytes(folder.path(), extension, &bytes[..length]);
            assert!(result.is_err(), "{extension} cut to {length} of {} bytes", bytes.len());
        }
        assert!(read_bytes(folder.path(), extension, &bytes).is_ok(), "{extension}");
    }
}

/// Longest time that a file of some kilobytes may take.
const LONGEST: Duration = Duration::from_secs(10);

#[test]
fn damaged_bytes_never_panic() {
    let folder = tempfile::tempdir().unwrap();
    for extension in EXTENSIONS {
        let bytes = written(extension);
        let mut seed = 1_u32;
        for mutant in 0..Mutants::count(600) {
            let start = Instant::now();
            let mut damaged = bytes.clone();
            for _ in 0..3 {
                seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                // Half of the damage goes into the header, where it hurts most.
                let range = if seed & 0x100 == 0 { 400.min(bytes.len()) } else { bytes.len() };
                damaged[seed as usize / 512 % range] = (seed >> 3) as u8;
            }
            let _ = read_bytes(folder.path(), extension, &damaged);
            assert!(start.elapsed() < LONGEST, "{extension}, mutant {mutant}: {:?}", start.elapsed());
        }
    }
}

/// Parts that are cut out, doubled and moved, and counts that overflow: textures are little but offsets and lengths.
#[test]
fn textures_in_disorder_never_panic() {
    let folder = tempfile::tempdir().unwrap();
    for extension in ["ktx2", "dds", "ktx"] {
        let (good, mut read) = (written(extension), 0);
        for (mutant, damaged) in Mutants::new(&good, &["KTX", "DX10"], 34).take(Mutants::count(2000)).enumerate() {
            let start = Instant::now();
            read += usize::from(read_bytes(folder.path(), extension, &damaged).is_ok());
            assert!(start.elapsed() < LONGEST, "{extension}, mutant {mutant}: {:?}", start.elapsed());
        }
        assert!(read > 0, "some of the damage is in texels: {extension}");
    }
}

#[test]
fn st_maps_are_errors_at_every_length_and_never_panic() {
    let folder = tempfile::tempdir().unwrap();
    for extension in ["exr", "tif", "png"] {
        let path = folder.path().join(format!("map.{extension}"));
        let depth = Format::from_extension(&path).unwrap().nearest_depth(Depth::Float);
        write(&path, &picture(40, 30, Channels::Rgb, depth), &WriteOptions::default()).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        let read_bytes = |bytes: &[u8]| {
            std::fs::write(&path, bytes).unwrap();
            read_pairs(&path, &Limits::memory(1 << 24))
        };
        assert!(read_bytes(&bytes).is_ok(), "{extension}");
        for length in (0..bytes.len()).step_by((bytes.len() / 200).max(1)) {
            assert!(read_bytes(&bytes[..length]).is_err(), "{extension} cut to {length} of {} bytes", bytes.len());
        }
        let mut seed = 3_u32;
        for _ in 0..400 {
            let mut damaged = bytes.clone();
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            damaged[seed as usize / 512 % 400.min(bytes.len())] = (seed >> 3) as u8;
            drop(read_bytes(&damaged));
        }
    }
}

/// The message for a file of a few bytes that declares 65535 × 65535 pixels.
fn giant(extension: &str, bytes: &[u8]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(format!("giant.{extension}"));
    std::fs::write(&path, bytes).unwrap();
    match read(&path, &Limits::memory(1 << 30)) {
        Err(error @ IoError::TooLarge { .. }) => error.to_string(),
        other => panic!("{extension}: {other:?}"),
    }
}

/// An OpenEXR file of a few bytes that declares a square of this side, in so many chunks.
fn exr_of(side: u16, chunks: i32) -> Vec<u8> {
    let mut exr = written("exr");
    let last = i32::from(side) - 1;
    put_box(&mut exr, b"dataWindow\0box2i\0", [last, last]);
    put_box(&mut exr, b"displayWindow\0box2i\0", [last, last]);
    let at = value_of(&exr, b"chunkCount\0int\0");
    exr[at..at + 4].copy_from_slice(&chunks.to_le_bytes());
    exr
}

/// Place of an attribute's value, by its name and its type.
fn value_of(exr: &[u8], attribute: &[u8]) -> usize {
    let at = exr.windows(attribute.len()).position(|bytes| bytes == attribute).unwrap();
    at + attribute.len() + 4
}

/// Writes the last column and row of a window.
fn put_box(exr: &mut [u8], attribute: &[u8], last: [i32; 2]) {
    let at = value_of(exr, attribute);
    exr[at + 8..at + 16].copy_from_slice(&last.map(i32::to_le_bytes).concat());
}

/// A little-endian TIFF: width, height, 8 bits, no compression, RGB, one strip of nothing.
fn giant_tiff() -> Vec<u8> {
    let mut tiff = b"II\x2a\0\x08\0\0\0\x09\0".to_vec();
    let entries: [(u16, u32); 9] =
        [(256, 65535), (257, 65535), (258, 8), (259, 1), (262, 2), (273, 8), (277, 3), (278, 65535), (279, 8)];
    for (tag, value) in entries {
        tiff.extend(tag.to_le_bytes());
        tiff.extend([4, 0, 1, 0, 0, 0]);
        tiff.extend(value.to_le_bytes());
    }
    tiff.extend([0; 4]);
    tiff
}

#[test]
fn giant_sizes_are_refused_before_memory_is_taken() {
    let mut png = written("png");
    png[16..24].copy_from_slice(&[0, 0, 0xff, 0xff, 0, 0, 0xff, 0xff]);
    let checksum = crc32(&png[12..29]);
    png[29..33].copy_from_slice(&checksum.to_be_bytes());
    let message = giant("png", &png);
    for part in ["giant.png", "65535x65535", "25769017350", "1073741824", "--memory"] {
        assert!(message.contains(part), "{message} lacks {part}");
    }

    let mut jpeg = written("jpg");
    let frame = jpeg.windows(2).position(|pair| pair == [0xff, 0xc0]).unwrap();
    jpeg[frame + 5..frame + 9].fill(0xff);
    giant("jpg", &jpeg);

    let mut tga = written("tga");
    tga[12..16].fill(0xff);
    giant("tga", &tga);

    giant("hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 65535 +X 65535\n");

    let mut exr = exr_of(65535, 4096);
    giant("exr", &exr);
    // A small display window hides nothing: the data window counts.
    put_box(&mut exr, b"displayWindow\0box2i\0", [9, 9]);
    giant("exr", &exr);

    giant("tif", &giant_tiff());
}

/// A text of which the decoder would print a line of its own, for the user to wonder at.
#[test]
fn texts_longer_than_their_tiff_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("texts.tif");
    // Width, or the program's name, of the type of texts: by 32 bits, and by 64 (BigTIFF).
    for tag in [256_u16, 305] {
        let classic =
            [&b"II*\0\x08\0\0\0\x01\0"[..], &tag.to_le_bytes(), b"\x02\0\xff\xff\xff\xff\x08\0\0\0\0\0\0\0"].concat();
        let start = b"II+\0\x08\0\0\0\x10\0\0\0\0\0\0\0\x01\0\0\0\0\0\0\0";
        let big = [&start[..], &tag.to_le_bytes(), b"\x02\0\xff\xff\xff\xff\0\0\0\0", &[0; 16]].concat();
        for bytes in [classic, big] {
            std::fs::write(&path, &bytes).unwrap();
            for error in [probe(&path).map(drop).unwrap_err(), read(&path, &Limits::default()).map(drop).unwrap_err()] {
                let message = error.to_string();
                assert!(matches!(error, IoError::Damaged { .. }), "{message}");
                assert!(message.contains(&format!("tag {tag} has a text of 4294967295 bytes")), "{message}");
            }
        }
    }
}

/// Files behind a TIFF, each of a page that names itself as the next.
#[test]
fn pages_that_follow_themselves_end() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("circles.tif");
    let circle = b"II*\0\x08\0\0\0\x01\0\0\x01\x04\0\x01\0\0\0\x01\0\0\0\x08\0\0\0";
    std::fs::write(&path, [written("tif"), circle.repeat(2000)].concat()).unwrap();
    let start = Instant::now();
    let error = read(&path, &Limits::default()).map(drop).unwrap_err().to_string();
    assert!(error.contains("circles.tif") && error.contains("one behind the other"), "{error}");
    assert!(start.elapsed() < LONGEST, "{:?}", start.elapsed());
}

#[test]
fn an_absurd_width_is_told_and_not_called_damage() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("wide.png");
    let mut png = written("png");
    png[16..20].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff]);
    let checksum = crc32(&png[12..29]);
    png[29..33].copy_from_slice(&checksum.to_be_bytes());
    std::fs::write(&path, &png).unwrap();
    let probed = cosmorama_io::probe(&path).map(|_| ()).unwrap_err();
    let found = read(&path, &Limits::NONE).map(|_| ()).unwrap_err();
    for error in [probed, found] {
        let message = error.to_string();
        assert!(matches!(error, IoError::TooLong { .. }), "{message}");
        for part in ["wide.png", "PNG", "2147483647x", "at most 1000000"] {
            assert!(message.contains(part), "{message} lacks {part}");
        }
    }
}

#[test]
fn textures_that_lie_about_their_size() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lie");
    let refused = |bytes: &[u8], limits: &Limits| {
        std::fs::write(&path, bytes).unwrap();
        let header = probe(&path);
        (header, read(&path, limits).unwrap_err())
    };
    let with = |bytes: &[u8], at: usize, value: u32| {
        let mut bytes = bytes.to_vec();
        bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
        bytes
    };
    // Faces of 2³¹ pixels: too large whatever the limit.
    let (ktx2, dds, ktx) = (written("ktx2"), written("dds"), written("ktx"));
    for edge in [1 << 16, 1 << 31, u32::MAX] {
        let dds = with(&with(&dds, 12, edge), 16, edge);
        for limits in [Limits::memory(1 << 30), Limits::NONE] {
            let (_, error) = refused(&dds, &limits);
            let too_large = matches!(error, IoError::TooLarge { .. });
            assert!(too_large || matches!(error, IoError::Damaged { .. }), "{error}");
            assert!(too_large || edge > 1 << 16 || limits == Limits::NONE, "{error}");
        }
        // Here the file also says how many bytes a level has.
        for (header, error) in [
            refused(&with(&with(&ktx2, 20, edge), 24, edge), &Limits::NONE),
            refused(&with(&with(&ktx, 36, edge), 40, edge), &Limits::NONE),
        ] {
            assert!(matches!(header, Err(IoError::Damaged { .. })) && matches!(error, IoError::Damaged { .. }));
        }
    }
    // A level, a descriptor or pairs of keys beyond the end.
    for lie in [with(&ktx2, 84, u32::MAX), with(&ktx2, 48, u32::MAX), with(&ktx, 60, u32::MAX)] {
        let (_, error) = refused(&lie, &Limits::NONE);
        assert!(matches!(error, IoError::Damaged { .. }), "{error}");
    }
    // So many smaller copies of each face.
    let copies = with(&with(&dds, 8, 0x0002_1007), 28, u32::MAX);
    let (_, error) = refused(&copies, &Limits::NONE);
    assert!(matches!(error, IoError::Damaged { .. }), "{error}");
    // No cube at all, texels of no format, packed ones.
    for (lie, says) in [
        (with(&ktx2, 36, 1), "no cube"),
        (with(&ktx2, 12, 9999), "Vulkan format"),
        (with(&ktx2, 44, 1), "packed by BasisLZ"),
        (with(&ktx2, 44, 2), "packed by Zstandard"),
        (with(&ktx, 52, 1), "no cube"),
        (with(&ktx, 12, 0x0102_0304), "highest byte first"),
        (with(&dds, 136, 0), "no cube"),
        (with(&dds, 128, 103), "the format NV12"),
    ] {
        let (_, error) = refused(&lie, &Limits::default());
        assert!(error.to_string().contains(says), "{error}");
    }
}

#[test]
fn a_map_on_a_giant_canvas_is_refused() {
    let mut exr = written("exr");
    put_box(&mut exr, b"displayWindow\0box2i\0", [999_999, 999_999]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.exr");
    std::fs::write(&path, &exr).unwrap();
    let error = read_pairs(&path, &Limits::memory(1 << 24)).unwrap_err().to_string();
    assert!(error.contains("map.exr") && error.contains("1000000x1000000"), "{error}");
}

fn crc32(bytes: &[u8]) -> u32 {
    let mut crc = u32::MAX;
    for byte in bytes {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 };
        }
    }
    !crc
}

#[test]
fn what_is_no_image_is_said_to_be_none() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    std::fs::write(&path, "hello").unwrap();
    assert!(matches!(read(&path, &Limits::default()), Err(IoError::UnknownContent { .. })));
    assert!(matches!(read(folder.path().join("b.png"), &Limits::default()), Err(IoError::Open { .. })));
    assert!(matches!(read(folder.path(), &Limits::default()), Err(IoError::Open { .. })));
    for name in ["a.png", "a.tga"] {
        let path = folder.path().join(name);
        std::fs::write(&path, "").unwrap();
        assert!(matches!(probe(&path), Err(IoError::Empty { .. })), "{name}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn random_bytes_never_panic(kind in 0_usize..9, bytes in proptest::collection::vec(any::<u8>(), 0..600)) {
        let magic: [&[u8]; 9] = [
            b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR",
            b"\xff\xd8\xff\xe0",
            b"II\x2a\0\x08\0\0\0",
            b"\0\0\x02\0\0\0\0\0\0\0\0\0",
            b"#?RADIANCE\n\n-Y 9 +X 20\n",
            b"\x76\x2f\x31\x01\x02\0\0\0",
            b"\xabKTX 20\xbb\r\n\x1a\n\x25\0\0\0",
            b"DDS \x7c\0\0\0",
            b"\xabKTX 11\xbb\r\n\x1a\n\x01\x02\x03\x04",
        ];
        let folder = tempfile::tempdir().unwrap();
        let whole: Vec<u8> = magic[kind].iter().chain(&bytes).copied().collect();
        let _ = read_bytes(folder.path(), EXTENSIONS[kind], &whole);
    }
}

/// More levels than halvings, or a level of two lengths: the number is named.
#[test]
fn levels_that_cannot_be_are_named() {
    let folder = tempfile::tempdir().unwrap();
    for (extension, at, lie, parts) in [
        ("ktx2", 40, 40, ["levelCount is 40", "3 levels at most"]),
        ("ktx2", 96, 7, ["uncompressedByteLength is 7", "byteLength"]),
        ("dds", 28, 60, ["dwMipMapCount is 60", "3 levels at most"]),
        ("ktx", 56, 90, ["numberOfMipmapLevels is 90", "3 levels at most"]),
    ] {
        let mut bytes = written(extension);
        if extension == "dds" {
            // It has no number of levels unless it says so.
            bytes[10] |= 2;
        }
        bytes[at] = lie;
        bytes[at + 1] = 0;
        let error = read_bytes(folder.path(), extension, &bytes).unwrap_err().to_string();
        assert!(parts.iter().all(|part| error.contains(part)), "{error}");
    }
}

/// A profile of zeros: thousands of times smaller in the file than in memory.
#[test]
fn a_profile_that_explodes_is_not_unpacked_whatever_the_limit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("profile.png");
    let metadata = Metadata { icc: Some(vec![0; 80 << 20]), ..Metadata::default() };
    let image = picture(4, 4, Channels::Rgb, Depth::Eight);
    write(&path, &image, &WriteOptions::with_metadata(metadata.clone())).unwrap();
    assert!(std::fs::metadata(&path).unwrap().len() < 1 << 20);
    assert!(!probe(&path).is_ok_and(|header| header.metadata.icc.is_some()));
    assert!(!read(&path, &Limits::NONE).is_ok_and(|file| file.metadata.icc.is_some()));
}

/// How many chunks a file of one part has follows from its sizes. What it says instead takes no memory and damages nothing.
#[test]
fn the_chunks_of_an_exr_are_counted_by_ourselves() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("counted.exr");
    let image = picture(40, 100, Channels::Rgb, Depth::Half);
    write(&path, &image, &WriteOptions::default()).unwrap();
    let honest = std::fs::read(&path).unwrap();
    let name = b"chunkCount\0int\0";
    let at = honest.windows(name.len()).position(|bytes| bytes == name).unwrap() + name.len() + 4;
    for count in [0, 1, 8, 4096, i32::MAX] {
        let mut lying = honest.clone();
        lying[at..at + 4].copy_from_slice(&count.to_le_bytes());
        std::fs::write(&path, &lying).unwrap();
        assert_eq!(read(&path, &Limits::default()).unwrap().image, image, "{count}");
        std::fs::write(&path, &lying[..lying.len() / 2]).unwrap();
        assert!(read(&path, &Limits::default()).is_err(), "{count}, cut off");
    }
}
