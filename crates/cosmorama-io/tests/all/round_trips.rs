//! What is written is read back: every format, depth and set of channels.

use std::io::Cursor;

use crate::common::picture;
use cosmorama::raster::{Channels, Depth, EncodedImage, FramePool, Samples, Transfer};
use cosmorama_io::{
    Choice, EnvMap, Format, IoError, Limits, Metadata, Remark, Window, WriteOptions, check_chosen, probe, probe_from,
    read, read_chosen, read_from, write, write_levels, write_planes, write_to,
};
use half::f16;

const EXTENSIONS: [(Format, &str); 6] = [
    (Format::Png, "png"),
    (Format::Jpeg, "jpg"),
    (Format::Tiff, "tif"),
    (Format::Tga, "tga"),
    (Format::Hdr, "hdr"),
    (Format::Exr, "exr"),
];

fn largest_difference(a: &EncodedImage, b: &EncodedImage) -> f32 {
    let light = |image: &EncodedImage| image.to_light(&Transfer::Linear);
    let (a, b) = (light(a), light(b));
    let pairs = a.pixels().iter().zip(b.pixels());
    pairs.flat_map(|(a, b)| (0..4).map(|c| (a.0[c] - b.0[c]).abs()).collect::<Vec<_>>()).fold(0.0, f32::max)
}

#[test]
fn every_format_depth_and_channels() {
    let folder = tempfile::tempdir().unwrap();
    for (format, extension) in EXTENSIONS {
        for depth in format.depths() {
            for channels in format.channels() {
                let image = picture(67, 35, *channels, *depth);
                let path = folder.path().join(format!("{depth}_{}.{extension}", channels.count()));
                write(&path, &image, &WriteOptions::default()).unwrap();
                let file = read(&path, &Limits::default()).unwrap();
                let what = format!("{format} {depth} {channels}");
                assert_eq!(file.format, format);
                assert_eq!(file.window, None);
                match format {
                    Format::Jpeg => assert!(largest_difference(&file.image, &image) < 0.25, "{what}"),
                    Format::Hdr => assert!(largest_difference(&file.image, &image) < 1.0 / 256.0, "{what}"),
                    // TIFF has no word for significant bits.
                    Format::Tiff => assert!(file.image.samples() == image.samples(), "{what}"),
                    _ => assert!(file.image == image, "{what}"),
                }
                let header = probe(&path).unwrap();
                assert_eq!((header.width, header.height), (67, 35), "{what}");
                assert_eq!(header.channels, file.image.channels(), "{what}");
                assert_eq!(header.depth, file.image.depth(), "{what}");
                assert_eq!(header.metadata, file.metadata, "{what}");
                let mut bytes = Cursor::new(Vec::new());
                write_to(&mut bytes, "memory", format, &image, &WriteOptions::default()).unwrap();
                assert!(*bytes.get_ref() == std::fs::read(&path).unwrap(), "{what}");
                let name = format!("memory.{extension}");
                assert_eq!(probe_from(&mut bytes, &name).unwrap(), header, "{what}");
                assert!(read_from(&mut bytes, &name, &Limits::default()).unwrap() == file, "{what}");
            }
        }
    }
    assert_eq!(
        crate::common::files(folder.path()).iter().filter(|path| path.to_string_lossy().contains(".part")).count(),
        0
    );
}

#[test]
fn panoramas_say_which_part_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let image = picture(60, 20, Channels::Rgb, Depth::Eight);
    let panorama = Some(Window { canvas_width: 128, canvas_height: 64, x: 5, y: 30 });
    for name in ["a.png", "a.jpg"] {
        let path = folder.path().join(name);
        let metadata = Metadata { panorama, ..Metadata::default() };
        write(&path, &image, &WriteOptions::with_metadata(metadata.clone())).unwrap();
        assert_eq!(probe(&path).unwrap().metadata.panorama, panorama, "{name}");
        assert_eq!(read(&path, &Limits::default()).unwrap().metadata.panorama, panorama, "{name}");
    }
}

#[test]
fn cubes_in_texture_files() {
    let folder = tempfile::tempdir().unwrap();
    for extension in ["ktx2", "ktx", "dds"] {
        let path = folder.path().join(format!("a.{extension}"));
        for (depth, transfer) in [
            (Depth::Eight, Transfer::Srgb),
            (Depth::Eight, Transfer::Linear),
            (Depth::Half, Transfer::Linear),
            (Depth::Float, Transfer::Linear),
        ] {
            let image = picture(7, 42, Channels::Rgba, depth);
            let envmap = Some(EnvMap::GlCube);
            let metadata = Metadata { envmap, transfer: Some(transfer.clone()), ..Metadata::default() };
            write(&path, &image, &WriteOptions::with_metadata(metadata.clone())).unwrap();
            let file = read(&path, &Limits::default()).unwrap();
            assert!(file.image == image, "{extension} {depth}");
            assert_eq!(file.metadata.envmap, envmap);
            // In DDS, bytes are of sRGB unless something else is said, but they do not say it. KTX says only that they are.
            let said = match (extension, depth) {
                ("dds", Depth::Eight) => None,
                ("ktx", Depth::Eight) => Some(transfer).filter(|transfer| *transfer == Transfer::Srgb),
                _ => Some(transfer),
            };
            assert_eq!(file.metadata.transfer, said, "{extension} {depth}");
            assert_eq!(probe(&path).unwrap().metadata, file.metadata);
            // Any other picture is none that the format could hold.
            for (image, envmap) in [(&image, None), (&picture(7, 35, Channels::Rgba, depth), envmap)] {
                let metadata = Metadata { envmap, ..Metadata::default() };
                let error =
                    write(&path, image, &WriteOptions::with_metadata(metadata.clone())).unwrap_err().to_string();
                assert!(error.contains("the six faces of a cube"), "{error}");
            }
        }
    }
    // Smaller copies, each half as large; what is read is the largest.
    for extension in ["ktx2", "ktx", "dds"] {
        let path = folder.path().join(format!("levels.{extension}"));
        let levels: Vec<EncodedImage> =
            [7, 3, 1].map(|edge| picture(edge, 6 * edge, Channels::Rgba, Depth::Half)).into();
        let remarks = vec![Remark { name: "lightUnit", text: "radiance".into() }];
        let metadata = Metadata { envmap: Some(EnvMap::GlCube), remarks, ..Metadata::default() };
        write_levels(&path, &levels, &WriteOptions::with_metadata(metadata.clone())).unwrap();
        assert!(read(&path, &Limits::default()).unwrap().image == levels[0], "{extension}");
        for wrong in [&levels[1..=1], &levels[2..]] {
            let wrong: Vec<EncodedImage> = [&levels[..1], wrong, wrong].concat();
            let error =
                write_levels(&path, &wrong, &WriteOptions::with_metadata(metadata.clone())).unwrap_err().to_string();
            assert!(error.contains("no half of the level before"), "{error}");
        }
    }
    let path = folder.path().join("old.ktx");
    let texels: Vec<u8> = (0..6 * 2 * 8).collect();
    std::fs::write(&path, crate::common::ktx(2, 0x1401, 0x1907, &texels)).unwrap();
    let image = read(&path, &Limits::default()).unwrap().image;
    let Samples::U8(samples) = image.samples() else { panic!("8 bits") };
    assert_eq!((image.width(), image.height(), &samples[..7]), (2, 12, &[0, 1, 2, 3, 4, 5, 8][..]));
    let error = write(&path, &image, &WriteOptions::default()).unwrap_err().to_string();
    assert!(error.contains("it can hold RGBA"), "{error}");
}

/// Six faces of 4x4 texels, byte number i being 5 (i / 8), packed by the zstd program.
const PACKED: [u8; 76] = [
    0x28, 0xb5, 0x2f, 0xfd, 0x04, 0x68, 0xfd, 0x01, 0x00, 0x74, 0x03, 0x00, 0x05, 0x0a, 0x0f, 0x14, 0x19, 0x1e, 0x23,
    0x28, 0x2d, 0x32, 0x37, 0x3c, 0x41, 0x46, 0x4b, 0x50, 0x55, 0x5a, 0x5f, 0x64, 0x69, 0x6e, 0x73, 0x78, 0x7d, 0x82,
    0x87, 0x8c, 0x91, 0x96, 0x9b, 0xa0, 0xa5, 0xaa, 0xaf, 0xb4, 0xb9, 0xbe, 0xc3, 0xc8, 0xcd, 0xd2, 0xd7, 0xdc, 0xe1,
    0xe6, 0xeb, 0xeb, 0xeb, 0xeb, 0xeb, 0xeb, 0xeb, 0xeb, 0x2f, 0x54, 0x01, 0x00, 0x04, 0x01, 0xe7, 0x3a, 0xea, 0xd6,
];

#[test]
fn packed_texels_in_ktx2() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ktx2");
    let samples = (0..384_u32).map(|i| (i / 8 * 5) as u8).collect();
    let image = EncodedImage::new(4, 24, Channels::Rgba, Depth::Eight, Samples::U8(samples)).unwrap();
    let metadata = Metadata { envmap: Some(EnvMap::GlCube), ..Metadata::default() };
    write(&path, &image, &WriteOptions::with_metadata(metadata.clone())).unwrap();
    let plain = std::fs::read(&path).unwrap();
    let offset = u64::from_le_bytes(plain[80..88].try_into().unwrap()) as usize;
    let mut zlib = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
    std::io::Write::write_all(&mut zlib, &plain[offset..offset + 384]).unwrap();
    let zlib = zlib.finish().unwrap();
    let packed = |scheme: u8, texels: &[u8]| {
        let mut file = plain[..offset].to_vec();
        file[44] = scheme;
        file[88..96].copy_from_slice(&(texels.len() as u64).to_le_bytes());
        std::fs::write(&path, [&file, texels].concat()).unwrap();
        read(&path, &Limits::default())
    };
    for (scheme, texels) in [(2, &PACKED[..]), (3, &zlib)] {
        assert!(packed(scheme, texels).unwrap().image == image, "scheme {scheme}");
        // Cut off, or other texels than it says.
        for wrong in [&texels[..texels.len() / 2], &texels[1..], &[]] {
            let error = packed(scheme, wrong).unwrap_err().to_string();
            assert!(error.contains("a.ktx2: damaged or truncated"), "{error}");
        }
    }
    let error = packed(1, &zlib).unwrap_err().to_string();
    assert!(error.contains("BasisLZ") && error.contains("ktx transcode"), "{error}");
    let mut uastc = plain;
    uastc[12..16].fill(0);
    let descriptor = u32::from_le_bytes(uastc[48..52].try_into().unwrap()) as usize;
    uastc[descriptor + 12] = 166;
    std::fs::write(&path, uastc).unwrap();
    let error = probe(&path).unwrap_err().to_string();
    assert!(error.contains("UASTC texels"), "{error}");
}

#[test]
fn odd_sizes() {
    let folder = tempfile::tempdir().unwrap();
    for (format, extension) in EXTENSIONS {
        let depth = format.nearest_depth(Depth::Eight);
        for (width, height) in [(1, 1), (7, 1), (1, 300), (8, 2), (257, 3)] {
            let image = picture(width, height, Channels::Rgb, depth);
            let path = folder.path().join(format!("{width}x{height}.{extension}"));
            write(&path, &image, &WriteOptions::default()).unwrap();
            let back = read(&path, &Limits::NONE).unwrap().image;
            assert_eq!((back.width(), back.height()), (width, height), "{format}");
        }
    }
}

#[test]
fn png_says_its_transfer_function() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let image = picture(4, 4, Channels::Rgb, Depth::Eight);
    for transfer in [Transfer::Srgb, Transfer::Linear, Transfer::Pq, Transfer::Hlg, Transfer::Bt1886] {
        let metadata = Metadata { transfer: Some(transfer), ..Metadata::default() };
        write(&path, &image, &WriteOptions::with_metadata(metadata.clone())).unwrap();
        assert_eq!(read(&path, &Limits::default()).unwrap().metadata.transfer, metadata.transfer);
    }
    let metadata = Metadata { transfer: Some(Transfer::Gamma(2.2)), ..Metadata::default() };
    write(&path, &image, &WriteOptions::with_metadata(metadata.clone())).unwrap();
    let Some(Transfer::Gamma(gamma)) = probe(&path).unwrap().metadata.transfer else { panic!("a gamma") };
    assert!((gamma - 2.2).abs() < 1e-3);
}

#[test]
fn icc_profiles_are_read_and_carried() {
    let folder = tempfile::tempdir().unwrap();
    let mut profile = moxcms::ColorProfile::new_display_p3();
    let curve = Some(moxcms::ToneReprCurve::Parametric(vec![1.8]));
    (profile.red_trc, profile.green_trc, profile.blue_trc) = (curve.clone(), curve.clone(), curve);
    profile.cicp = None;
    let metadata = Metadata { icc: Some(profile.encode().unwrap()), ..Metadata::default() };
    for extension in ["png", "jpg", "tif"] {
        let path = folder.path().join(format!("a.{extension}"));
        write(&path, &picture(16, 16, Channels::Rgb, Depth::Eight), &WriteOptions::with_metadata(metadata.clone()))
            .unwrap();
        let back = read(&path, &Limits::default()).unwrap().metadata;
        assert!(back.icc == metadata.icc, "{extension}");
        let Some(Transfer::Gamma(gamma)) = back.transfer else { panic!("{extension}: {:?}", back.transfer) };
        assert!((gamma - 1.8).abs() < 0.005, "{gamma}");
    }
}

#[test]
fn exr_says_that_it_is_an_environment() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    for envmap in [EnvMap::LatLong, EnvMap::Cube] {
        let metadata = Metadata { envmap: Some(envmap), ..Metadata::default() };
        write(&path, &picture(8, 4, Channels::Rgb, Depth::Half), &WriteOptions::with_metadata(metadata.clone()))
            .unwrap();
        assert_eq!(probe(&path).unwrap().metadata.envmap, Some(envmap));
    }
}

#[test]
fn a_glow_with_alpha_zero_survives_exr_and_tiff() {
    let folder = tempfile::tempdir().unwrap();
    let samples = Samples::Float(vec![3.0, 2.0, 1.0, 0.0]);
    let image = EncodedImage::new(1, 1, Channels::Rgba, Depth::Float, samples).unwrap();
    let image = image.with_alpha_mode(cosmorama::raster::AlphaMode::Premultiplied);
    for extension in ["exr", "tif"] {
        let path = folder.path().join(format!("a.{extension}"));
        write(&path, &image, &WriteOptions::default()).unwrap();
        assert_eq!(read(&path, &Limits::default()).unwrap().image, image);
    }
}

#[test]
fn integers_brighter_than_their_alpha_are_no_premultiplied_tiff() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.tif");
    let read_back = |grey: fn(u8) -> u8| {
        let samples = (0..=255).flat_map(|alpha| [grey(alpha), grey(alpha), grey(alpha), alpha]).collect();
        let image = EncodedImage::new(16, 16, Channels::Rgba, Depth::Eight, Samples::U8(samples)).unwrap();
        write(&path, &image, &WriteOptions::default()).unwrap();
        testkit::say_premultiplied(&path).unwrap();
        read(&path, &Limits::default()).map(|file| file.metadata.cut_colours).map_err(|error| error.to_string())
    };
    assert_eq!(read_back(|alpha| alpha), Ok(0));
    assert_eq!(read_back(|alpha| alpha.saturating_add(1)), Ok(0));
    // Some: their pixels are counted.
    assert_eq!(read_back(|alpha| if alpha < 40 { 100 } else { alpha }), Ok(39));
    let message = read_back(|_| 230).unwrap_err();
    assert!(message.contains("a.tif") && message.contains("colour exceeds alpha in 228 of 254 pixels"), "{message}");
}

#[test]
fn straight_floats_are_multiplied_for_exr() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let samples = Samples::Float(vec![1.0, 0.5, 0.0, 0.5, 7.0, 7.0, 7.0, 0.0]);
    let image = EncodedImage::new(2, 1, Channels::Rgba, Depth::Float, samples).unwrap();
    write(&path, &image, &WriteOptions::default()).unwrap();
    let back = read(&path, &Limits::default()).unwrap().image;
    assert_eq!(*back.samples(), Samples::Float(vec![0.5, 0.25, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0]));
}

#[test]
fn what_a_format_cannot_hold_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |name: &str, channels, depth| {
        let image = picture(4, 4, channels, depth);
        let path = folder.path().join(name);
        let message = write(&path, &image, &WriteOptions::default()).unwrap_err().to_string();
        assert!(!path.exists());
        message
    };
    assert!(refused("a.jpg", Channels::Rgba, Depth::Eight).contains("JPEG cannot hold RGBA"));
    assert!(refused("a.hdr", Channels::Rgba, Depth::Float).contains("cannot hold RGBA"));
    assert!(refused("a.png", Channels::Rgb, Depth::Float).contains("depth 8, 10, 12, 16"));
    assert!(refused("a.xyz", Channels::Rgb, Depth::Eight).contains("png, jpg"));
    assert!(refused("a", Channels::Rgb, Depth::Eight).contains("extension"));
    assert!(refused("no/such/folder/a.png", Channels::Rgb, Depth::Eight).contains("no/such/folder does not exist"));
    assert_eq!(crate::common::files(folder.path()).len(), 0);
}

#[test]
fn an_older_file_is_replaced_only_by_a_whole_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.jpg");
    let image = picture(4, 4, Channels::Rgb, Depth::Eight);
    write(&path, &image, &WriteOptions::default()).unwrap();
    let before = std::fs::read(&path).unwrap();
    // A profile that no JPEG can hold: writing fails after it began.
    let metadata = Metadata { icc: Some(vec![0; 20_000_000]), ..Metadata::default() };
    assert!(write(&path, &image, &WriteOptions::with_metadata(metadata.clone())).is_err());
    assert_eq!(std::fs::read(&path).unwrap(), before);
    assert_eq!(crate::common::files(folder.path()), [path]);
}

#[cfg(unix)]
#[test]
fn outputs_can_be_read_by_whom_the_umask_lets() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    write(&path, &picture(4, 4, Channels::Rgb, Depth::Eight), &WriteOptions::default()).unwrap();
    std::fs::write(folder.path().join("plain"), "").unwrap();
    let mode = |path| std::fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(path), mode(folder.path().join("plain")));
}

#[test]
fn a_colour_mapped_tga_from_the_bottom() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.tga");
    // Two entries of 24 bits, blue first; one column of two rows, the lower one first.
    let bytes = [0, 1, 1, 0, 0, 2, 0, 24, 0, 0, 0, 0, 1, 0, 2, 0, 8, 0, 1, 2, 3, 4, 5, 6, 0, 1];
    std::fs::write(&path, bytes).unwrap();
    let image = read(&path, &Limits::default()).unwrap().image;
    assert_eq!(*image.samples(), Samples::U8(vec![6, 5, 4, 3, 2, 1]));
}

#[test]
fn a_tga_whose_fourth_byte_is_padding_is_opaque() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.tga");
    let start = [0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 32];
    std::fs::write(&path, [&start[..], &[0, 1, 2, 3, 0]].concat()).unwrap();
    assert_eq!(read(&path, &Limits::default()).unwrap().image.channels(), Channels::Rgb);
    std::fs::write(&path, [&start[..], &[8, 1, 2, 3, 0]].concat()).unwrap();
    assert_eq!(read(&path, &Limits::default()).unwrap().image.channels(), Channels::Rgba);
}

/// Origins are found again in formats that name the program, and what cannot be one is left out.
#[test]
fn origins_come_back() {
    let folder = tempfile::tempdir().unwrap();
    let formats = [
        ("exr", Depth::Float),
        ("png", Depth::Sixteen),
        ("tif", Depth::Eight),
        ("hdr", Depth::Float),
        ("jpg", Depth::Eight),
    ];
    for (extension, depth) in formats {
        let path = folder.path().join(format!("a.{extension}"));
        let longest = "x".repeat(256);
        let too_long = "x".repeat(257);
        let words = ["0.1.0, pose 7 (a)", &longest, "", &too_long, "two\nlines", "Wörter", "\0"];
        for (index, words) in words.into_iter().enumerate() {
            let origin = Some(words.to_owned());
            let metadata = Metadata { origin: origin.clone(), ..Metadata::default() };
            write(&path, &picture(8, 4, Channels::Rgb, depth), &WriteOptions::with_metadata(metadata)).unwrap();
            let found = read(&path, &Limits::default()).unwrap().metadata;
            assert_eq!(found.origin, origin.filter(|_| index < 2), "{extension}: {words:?}");
            assert!(found.software.is_none_or(|name| name.starts_with("cosmorama")), "{extension}");
        }
    }
}

/// A picture is the same file however often it is written.
#[test]
fn files_of_one_picture_are_alike() {
    let remarks = ["first", "second", "third", "fourth", "fifth"].map(|name| Remark { name, text: name.into() });
    let metadata = Metadata { remarks: remarks.into(), origin: Some("a, b".to_owned()), ..Metadata::default() };
    let options = WriteOptions::with_metadata(metadata);
    for (format, _) in EXTENSIONS {
        let image = picture(8, 6, Channels::Rgb, format.nearest_depth(Depth::Float));
        let file = || {
            let mut file = Cursor::new(Vec::new());
            write_to(&mut file, "a", format, &image, &options).unwrap();
            file.into_inner()
        };
        let first = file();
        assert!((0..20).all(|_| file() == first), "{format}");
    }
}

/// A flipped bit in the name of the program, or in the words behind it, is seen: the words are others, but not none.
#[test]
fn damaged_origins_are_not_none() {
    const ORIGIN: &str = "0.2.0, geometry 0123abcd, pose 11111111, check 22222222";
    let name = format!("cosmorama ({ORIGIN})");
    let options = || WriteOptions::with_metadata(Metadata { origin: Some(ORIGIN.to_owned()), ..Metadata::default() });
    for format in [Format::Jpeg, Format::Tiff, Format::Exr, Format::Hdr] {
        let image = picture(8, 6, Channels::Rgb, format.nearest_depth(Depth::Eight));
        let mut good = Cursor::new(Vec::new());
        write_to(&mut good, "a", format, &image, &options()).unwrap();
        let good = good.into_inner();
        let at = good.windows(name.len()).position(|part| part == name.as_bytes()).expect("the name of the program");
        for bit in 0..8 * name.len() {
            let mut damaged = good.clone();
            damaged[at + bit / 8] ^= 1 << (bit % 8);
            let found = probe_from(Cursor::new(damaged), "a").unwrap().metadata.origin;
            assert!(found.as_ref().is_some_and(|found| found != ORIGIN), "{format}, bit {bit}: {found:?}");
        }
    }
    // Of other programs, and of ours without words, there are none.
    for other in ["cosmorama", "cosmorama 0.3", "cosmorama-view (x)", "Adobe Photoshop (Windows)", "Überblender (1)"] {
        let file = format!("#?RADIANCE\nSOFTWARE={other}\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\nabcd");
        assert_eq!(probe_from(Cursor::new(file), "a").unwrap().metadata.origin, None, "{other}");
    }
}

/// Statements about pixels are found again where a format has a place for them.
#[test]
fn remarks_are_written() {
    let folder = tempfile::tempdir().unwrap();
    let remarks = vec![Remark { name: "lightUnit", text: "irradiance".into() }];
    for (extension, depth) in
        [("exr", Depth::Float), ("png", Depth::Sixteen), ("tif", Depth::Float), ("hdr", Depth::Float)]
    {
        let path = folder.path().join(format!("a.{extension}"));
        let metadata = Metadata { remarks: remarks.clone(), ..Metadata::default() };
        write(&path, &picture(8, 4, Channels::Rgb, depth), &WriteOptions::with_metadata(metadata)).unwrap();
        let carried = read(&path, &Limits::default()).unwrap().metadata.carried;
        match extension {
            "exr" => {
                let found = carried.attributes.iter().find(|attribute| attribute.name == "lightUnit").unwrap();
                assert_eq!((found.kind.as_str(), &found.bytes[..]), ("string", &b"irradiance"[..]));
                // Carried along, it gives way to another.
                let remarks = vec![Remark { name: "lightUnit", text: "radiance".into() }];
                let metadata = Metadata { remarks, carried, ..Metadata::default() };
                write(&path, &picture(8, 4, Channels::Rgb, depth), &WriteOptions::with_metadata(metadata)).unwrap();
                let carried = read(&path, &Limits::default()).unwrap().metadata.carried;
                let found: Vec<_> = carried.attributes.iter().filter(|found| found.name == "lightUnit").collect();
                assert_eq!((found.len(), &found[0].bytes[..]), (1, &b"radiance"[..]));
            }
            "png" => {
                let found = carried.texts.iter().find(|text| text.keyword() == "lightUnit").unwrap();
                assert_eq!(found.text().as_deref(), Some("irradiance"));
            }
            "tif" => {
                let bytes = std::fs::read(&path).unwrap();
                assert!(bytes.windows(21).any(|bytes| bytes == b"lightUnit: irradiance"));
            }
            _ => {
                let bytes = std::fs::read(&path).unwrap();
                assert!(bytes.starts_with(b"#?RADIANCE\nSOFTWARE=cosmorama\nlightUnit=irradiance\n"));
            }
        }
    }
}

#[test]
fn two_channels_of_one_name_are_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("twice.exr");
    let planes = vec![("u", vec![0.0; 4]), ("v", vec![1.0; 4]), ("u", vec![2.0; 4])];
    let error = write_planes(&path, (2, 2), planes, Depth::Float, &WriteOptions::default()).unwrap_err();
    assert!(error.to_string().contains("two channels are called u") && !path.exists(), "{error}");
}

#[test]
fn a_check_finds_what_reading_finds() {
    let folder = tempfile::tempdir().unwrap();
    let choice = Choice::default();
    for (name, depth) in [
        ("a.png", Depth::Eight),
        ("b.png", Depth::Sixteen),
        ("a.tif", Depth::Eight),
        ("a.exr", Depth::Half),
        ("a.hdr", Depth::Float),
        ("a.jpg", Depth::Eight),
        ("a.tga", Depth::Eight),
    ] {
        let path = folder.path().join(name);
        let samples = match depth {
            Depth::Eight => Samples::U8((0..40 * 30 * 3).map(|at| (at * 7 % 250) as u8).collect()),
            Depth::Sixteen => Samples::U16((0..40 * 30 * 3).map(|at| (at * 977) as u16).collect()),
            Depth::Half => Samples::Half((0..40 * 30 * 3).map(|at| f16::from_f32((at % 7) as f32)).collect()),
            _ => Samples::Float((0..40 * 30 * 3).map(|at| (at % 7) as f32).collect()),
        };
        let image = EncodedImage::new(40, 30, Channels::Rgb, depth, samples).unwrap();
        write(&path, &image, &WriteOptions::default()).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        let check =
            |bytes: &[u8], memory: u64| check_chosen(Cursor::new(bytes), name, &Limits::memory(memory), &choice);
        let read = |bytes: &[u8]| {
            read_chosen(Cursor::new(bytes), name, (&Limits::memory(1 << 20), &FramePool::default()), &choice)
        };
        check(&bytes, 1 << 20).unwrap();
        let without_memory = check(&bytes, 1);
        // What these two hold is the same for pictures of all sizes.
        assert_eq!(without_memory.is_ok(), [".png", ".tga"].iter().any(|end| name.ends_with(end)), "{name}");
        assert!(without_memory.err().is_none_or(|error| matches!(error, IoError::TooLarge { .. })), "{name}");
        for kept in (0..bytes.len()).step_by(1 + bytes.len() / 97) {
            assert_eq!(check(&bytes[..kept], 1 << 20).is_ok(), read(&bytes[..kept]).is_ok(), "{name} of {kept} bytes");
        }
        for at in (0..bytes.len()).step_by(1 + bytes.len() / 211) {
            let mut changed = bytes.clone();
            changed[at] ^= 0x55;
            assert_eq!(check(&changed, 1 << 20).is_ok(), read(&changed).is_ok(), "{name}, byte {at}");
        }
    }
}
