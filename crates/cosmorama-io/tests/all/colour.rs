//! What files say of colour: written and read again, by the rules of each format where tags contradict each other.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::{picture, program};
use cosmorama::raster::{Channels, Depth, EncodedImage, Primaries, Samples, Transfer};
use cosmorama_io::{EnvMap, Limits, Metadata, ProfileFault, WriteOptions, probe, read, write};

/// The spaces of which every format is asked.
const SPACES: [Primaries; 7] = [
    Primaries::REC709,
    Primaries::P3_D65,
    Primaries::P3_DCI,
    Primaries::REC2020,
    Primaries::AP0,
    Primaries::AP1,
    Primaries::ADOBE_RGB,
];

fn own_primaries() -> Primaries {
    Primaries::of_pairs([0.6, 0.3], [0.25, 0.65], [0.12, 0.08], [0.32, 0.34]).unwrap()
}

/// Columns of red, green, blue and white; for a cube, each face.
fn patches(depth: Depth, channels: Channels, rows: usize) -> EncodedImage {
    let mut light = cosmorama::raster::Image::filled(4, rows, cosmorama::raster::Rgba::BLACK);
    let colours = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0]];
    for (place, pixel) in light.pixels_mut().iter_mut().enumerate() {
        let [red, green, blue] = colours[place % 4];
        *pixel = cosmorama::raster::Rgba::opaque(red, green, blue);
    }
    EncodedImage::encode(&light, channels, depth, &Transfer::Linear)
}

fn tagged(transfer: Transfer, primaries: Primaries) -> Metadata {
    Metadata { transfer: Some(transfer), primaries: Some(primaries), ..Metadata::default() }
}

fn written(path: &Path, image: &EncodedImage, metadata: &Metadata) {
    write(path, image, &WriteOptions::with_metadata(metadata.clone())).unwrap();
}

#[test]
fn every_format_keeps_the_primaries_that_it_can_name() {
    let folder = tempfile::tempdir().unwrap();
    let (any, srgb, linear) = ([&SPACES[..], &[own_primaries()]].concat(), Transfer::Srgb, Transfer::Linear);
    for (name, depth, channels, transfer, spaces) in [
        ("a.png", Depth::Eight, Channels::Rgb, &srgb, &any[..]),
        ("b.png", Depth::Sixteen, Channels::Rgb, &linear, &any),
        ("c.png", Depth::Sixteen, Channels::Rgba, &Transfer::Gamma(2.5), &any),
        ("d.png", Depth::Sixteen, Channels::Rgb, &Transfer::Pq, &any),
        ("a.tif", Depth::Sixteen, Channels::Rgb, &srgb, &any),
        ("b.tif", Depth::Float, Channels::Rgb, &linear, &any),
        ("c.tif", Depth::Sixteen, Channels::Rgb, &Transfer::Hlg, &any),
        ("a.jpg", Depth::Eight, Channels::Rgb, &srgb, &any),
        ("a.exr", Depth::Half, Channels::Rgb, &linear, &any),
        ("a.hdr", Depth::Float, Channels::Rgb, &linear, &any),
        // P3-DCI has no number there.
        (
            "a.ktx2",
            Depth::Eight,
            Channels::Rgba,
            &srgb,
            &[SPACES[0], SPACES[1], SPACES[3], SPACES[4], SPACES[5], SPACES[6]],
        ),
        ("b.ktx2", Depth::Eight, Channels::Rgba, &Transfer::Pq, &[Primaries::REC2020]),
        ("c.ktx2", Depth::Half, Channels::Rgba, &linear, &[Primaries::REC2020, Primaries::AP1]),
    ] {
        for primaries in spaces {
            let path = folder.path().join(name);
            let is_cube = name.ends_with("ktx2");
            let image = patches(depth, channels, if is_cube { 24 } else { 4 });
            let envmap = is_cube.then_some(EnvMap::GlCube);
            written(&path, &image, &Metadata { envmap, ..tagged(transfer.clone(), *primaries) });
            let back = read(&path, &Limits::default()).unwrap();
            let found = back.metadata.primaries.unwrap_or(Primaries::REC709);
            assert!(found.is_same(primaries), "{name}: {found} is not {primaries}");
            let usual = if depth.is_float() { &linear } else { &srgb };
            let same = match (&back.metadata.transfer, transfer) {
                (Some(Transfer::Gamma(found)), Transfer::Gamma(gamma)) => (found - gamma).abs() < 1e-3,
                (found, transfer) => found.as_ref().unwrap_or(usual) == transfer,
            };
            assert!(same, "{name}, {primaries}: {:?}", back.metadata.transfer);
            assert_eq!((&back.metadata.complaints, &back.metadata.profile_fault), (&Vec::new(), &None), "{name}");
            let (ours, theirs) = (image.to_light(&Transfer::Linear), back.image.to_light(&Transfer::Linear));
            let allowed = if name == "a.jpg" { 1.0 } else { 1.0 / 128.0 };
            for (a, b) in ours.pixels().iter().zip(theirs.pixels()) {
                assert!((0..4).all(|c| (a.0[c] - b.0[c]).abs() <= allowed), "{name}: {b:?} is not {a:?}");
            }
        }
    }
}

#[test]
fn what_needs_no_tag_gets_none() {
    let folder = tempfile::tempdir().unwrap();
    let image = picture(8, 8, Channels::Rgb, Depth::Eight);
    let plain = Metadata { transfer: Some(Transfer::Srgb), ..Metadata::default() };
    for (name, start) in [("a.jpg", &b"ICC_PROFILE"[..]), ("a.tif", b"acsp"), ("a.png", b"cICP")] {
        let path = folder.path().join(name);
        written(&path, &image, &plain);
        let bytes = std::fs::read(&path).unwrap();
        assert!(!contains(&bytes, start), "{name}");
        written(&path, &image, &tagged(Transfer::Srgb, Primaries::REC709));
        assert!(std::fs::read(&path).unwrap() == bytes, "{name}");
    }
    let path = folder.path().join("grey.tif");
    written(&path, &picture(8, 8, Channels::Grey, Depth::Eight), &tagged(Transfer::Srgb, Primaries::REC2020));
    assert!(!contains(&std::fs::read(&path).unwrap(), b"acsp"));
    written(&path, &picture(8, 8, Channels::Grey, Depth::Eight), &tagged(Transfer::Gamma(1.8), Primaries::REC2020));
    assert_eq!(probe(&path).unwrap().metadata.transfer, Some(Transfer::Gamma(1.8)));
}

fn contains(bytes: &[u8], what: &[u8]) -> bool {
    bytes.windows(what.len()).any(|window| window == what)
}

/// Adds chunks to a PNG right behind its header.
fn with_chunks(path: &Path, chunks: &[(&[u8; 4], &[u8])]) {
    const HEADER_END: usize = 33;
    let bytes = std::fs::read(path).unwrap();
    let mut file = std::fs::File::create(path).unwrap();
    file.write_all(&bytes[..HEADER_END]).unwrap();
    for (kind, data) in chunks {
        let mut crc = flate2::Crc::new();
        crc.update(*kind);
        crc.update(data);
        let parts = [&(data.len() as u32).to_be_bytes()[..], *kind, data, &crc.sum().to_be_bytes()];
        parts.iter().for_each(|part| file.write_all(part).unwrap());
    }
    file.write_all(&bytes[HEADER_END..]).unwrap();
}

/// A PNG with further chunks, and what it says.
fn png(
    image: &EncodedImage,
    metadata: &Metadata,
    chunks: &[(&[u8; 4], &[u8])],
) -> (tempfile::TempDir, PathBuf, Metadata) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    written(&path, image, metadata);
    with_chunks(&path, chunks);
    let metadata = probe(&path).unwrap().metadata;
    (folder, path, metadata)
}

/// The data of a cHRM chunk.
fn chromaticities(primaries: &Primaries) -> Vec<u8> {
    let [red, green, blue, white] = primaries.pairs();
    let numbers = [white, red, green, blue].into_iter().flatten();
    numbers.flat_map(|number| ((number * 1e5).round() as u32).to_be_bytes()).collect()
}

#[test]
fn cicp_comes_before_a_profile_in_a_png() {
    let image = picture(8, 8, Channels::Rgb, Depth::Sixteen);
    let profile = moxcms::ColorProfile::new_display_p3().encode().unwrap();
    let metadata = Metadata { icc: Some(profile), ..Metadata::default() };
    let (.., found) = png(&image, &metadata, &[(b"cICP", &[9, 16, 0, 1])]);
    assert_eq!((found.primaries, &found.transfer), (Some(Primaries::REC2020), &Some(Transfer::Pq)));
    assert_eq!((found.icc.as_ref(), found.colour_space().as_deref()), (None, Some("Rec. 2020, PQ")));
    let [complaint] = &found.complaints[..] else { panic!("{:?}", found.complaints) };
    assert!(complaint.contains("says Rec. 2020, PQ and its ICC profile Display P3; cICP comes first"), "{complaint}");
}

#[test]
fn tags_of_a_png_that_contradict_each_other_are_told() {
    let image = picture(8, 8, Channels::Rgb, Depth::Eight);
    let srgb = tagged(Transfer::Srgb, Primaries::REC709);
    let chroma = chromaticities(&Primaries::REC2020);
    let (.., found) = png(&image, &srgb, &[(b"cHRM", &chroma)]);
    assert_eq!((found.primaries, found.complaints.len()), (Some(Primaries::REC709), 1));
    let gamma = 45455_u32.to_be_bytes();
    let usual = chromaticities(&Primaries::REC709);
    let (.., found) = png(&image, &srgb, &[(b"gAMA", &gamma), (b"cHRM", &usual)]);
    assert_eq!(found.complaints, Vec::<String>::new());
    let (.., found) = png(&image, &srgb, &[(b"cICP", &[12, 13, 0, 1])]);
    assert_eq!((found.primaries, found.complaints.len()), (Some(Primaries::P3_D65), 1));
    let profile =
        Metadata { icc: Some(moxcms::ColorProfile::new_display_p3().encode().unwrap()), ..Metadata::default() };
    for (chunk, data, said) in
        [(b"cHRM", &chroma[..], "its cHRM chunk Rec. 2020"), (b"sRGB", &[0], "its sRGB chunk sRGB")]
    {
        let (.., found) = png(&image, &profile, &[(chunk, data)]);
        assert_eq!(found.primaries, Some(Primaries::P3_D65));
        assert!(found.complaints.len() == 1 && found.complaints[0].contains(said), "{:?}", found.complaints);
    }
    let (.., found) = png(&image, &profile, &[(b"cICP", &[12, 13, 0, 1]), (b"cHRM", &chroma)]);
    assert!(found.complaints.len() == 1 && found.complaints[0].contains("its cHRM chunk"), "{:?}", found.complaints);
    let (.., found) = png(&image, &Metadata::default(), &[(b"cHRM", &chroma)]);
    assert_eq!((found.primaries, found.transfer), (Some(Primaries::REC2020), None));
    let (.., found) = png(&image, &Metadata::default(), &[(b"cHRM", &[0; 32])]);
    assert_eq!((found.primaries, found.complaints.len()), (None, 1));
}

#[test]
fn numbers_that_nobody_knows_are_named() {
    let image = picture(8, 8, Channels::Rgb, Depth::Eight);
    for (data, said) in
        [([99, 13, 0, 1], "the number of its primaries, 99"), ([1, 99, 0, 1], "the transfer function 99")]
    {
        let (.., found) = png(&image, &tagged(Transfer::Srgb, Primaries::REC709), &[(b"cICP", &data)]);
        assert!(found.complaints.iter().any(|complaint| complaint.contains(said)), "{:?}", found.complaints);
        assert_eq!((found.primaries, found.transfer), (Some(Primaries::REC709), Some(Transfer::Srgb)));
    }
    // What is unspecified leaves the word to others, and is no mistake.
    let profile = moxcms::ColorProfile::new_display_p3().encode().unwrap();
    let (.., found) = png(&image, &Metadata { icc: Some(profile), ..Metadata::default() }, &[(b"cICP", &[2, 2, 0, 1])]);
    assert_eq!((found.primaries, found.complaints.len()), (Some(Primaries::P3_D65), 0));
    let (.., found) = png(&image, &Metadata::default(), &[(b"cICP", &[2, 16, 0, 1])]);
    assert_eq!((found.primaries, found.transfer, found.complaints.len()), (None, Some(Transfer::Pq), 0));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ktx2");
    let metadata = Metadata { envmap: Some(EnvMap::GlCube), ..tagged(Transfer::Srgb, Primaries::REC2020) };
    written(&path, &patches(Depth::Eight, Channels::Rgba, 24), &metadata);
    let mut bytes = std::fs::read(&path).unwrap();
    let descriptor = u32::from_le_bytes([bytes[48], bytes[49], bytes[50], bytes[51]]) as usize;
    assert_eq!(bytes[descriptor + 13], 4);
    bytes[descriptor + 13] = 77;
    std::fs::write(&path, bytes).unwrap();
    let found = probe(&path).unwrap().metadata;
    assert!(found.primaries.is_none() && found.complaints[0].contains("77"), "{:?}", found.complaints);
}

#[test]
fn narrow_range_is_read_as_full_range() {
    let codes = |list: [u16; 4]| Samples::U16(list.iter().flat_map(|code| [code << 8; 3]).collect());
    let image = EncodedImage::new(4, 1, Channels::Rgb, Depth::Sixteen, codes([16, 235, 0, 255])).unwrap();
    let (_folder, path, found) = png(&image, &Metadata::default(), &[(b"cICP", &[9, 16, 0, 0])]);
    assert!(found.notes[0].contains("narrow range"), "{:?}", found.notes);
    let file = read(&path, &Limits::default()).unwrap();
    let expected: Vec<u16> = [0, 65535, 0, 65535].iter().flat_map(|code| [*code; 3]).collect();
    assert_eq!(file.image.samples(), &Samples::U16(expected));
    // What is written of it has full range.
    written(&path, &file.image, &file.metadata);
    assert!(contains(&std::fs::read(&path).unwrap(), &[b'c', b'I', b'C', b'P', 9, 16, 0, 1]));

    let image = EncodedImage::new(1, 1, Channels::Rgba, Depth::Eight, Samples::U8(vec![16, 126, 235, 235])).unwrap();
    let (_folder, path, _) = png(&image, &Metadata::default(), &[(b"cICP", &[1, 1, 0, 0])]);
    assert_eq!(read(&path, &Limits::default()).unwrap().image.samples(), &Samples::U8(vec![0, 128, 255, 235]));
}

#[test]
fn profiles_that_cannot_be_followed_say_why() {
    let folder = tempfile::tempdir().unwrap();
    let image = picture(8, 8, Channels::Rgb, Depth::Eight);
    let mut damaged = moxcms::ColorProfile::new_srgb().encode().unwrap();
    damaged.truncate(200);
    for extension in ["png", "jpg", "tif"] {
        let path = folder.path().join(format!("a.{extension}"));
        written(&path, &image, &Metadata { icc: Some(damaged.clone()), ..Metadata::default() });
        let found = probe(&path).unwrap().metadata;
        assert!(matches!(found.profile_fault, Some(ProfileFault::Damaged(_))), "{extension}");
        assert_eq!((found.transfer, found.primaries), (None, None));
    }
}

/// A profile that cannot even be unpacked, or of which a part is missing, is one that is damaged, and not none.
#[test]
fn what_is_left_of_a_profile_is_told() {
    let is_damaged = |found: &Metadata| matches!(found.profile_fault, Some(ProfileFault::Damaged(_)));
    let image = picture(8, 8, Channels::Rgb, Depth::Eight);
    let packed = |method: u8| [b"profile\0", &[method, 0x78, 0x9c, 1, 2, 3][..]].concat();
    for data in [packed(0), packed(1), b"no end".to_vec()] {
        let (.., found) = png(&image, &Metadata::default(), &[(b"iCCP", &data)]);
        assert!(is_damaged(&found), "{data:?}");
        let (.., found) = png(&image, &Metadata::default(), &[(b"cICP", &[12, 13, 0, 1]), (b"iCCP", &data)]);
        assert!(!is_damaged(&found) && found.complaints[0].contains("since it is damaged"), "{:?}", found.complaints);
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.jpg");
    written(&path, &image, &tagged(Transfer::Srgb, Primaries::P3_D65));
    let mut bytes = std::fs::read(&path).unwrap();
    let name = bytes.windows(12).position(|window| window == b"ICC_PROFILE\0").unwrap();
    // The first of two parts.
    bytes[name + 13] = 2;
    std::fs::write(&path, bytes).unwrap();
    assert!(is_damaged(&probe(&path).unwrap().metadata));
    assert!(is_damaged(&read(&path, &Limits::default()).unwrap().metadata));
}

/// A camera's setting, which is all that such files say (DCF 2.0).
#[test]
fn a_camera_s_adobe_rgb_is_read() {
    let entry = |tag: u16, kind: u16, count: u32, value: [u8; 4]| {
        [&tag.to_le_bytes()[..], &kind.to_le_bytes(), &count.to_le_bytes(), &value].concat()
    };
    let directory =
        |entries: &[Vec<u8>]| [&(entries.len() as u16).to_le_bytes()[..], &entries.concat(), &[0; 4]].concat();
    let own = directory(&[entry(0x8769, 4, 1, 26_u32.to_le_bytes())]);
    let camera = directory(&[entry(0xa001, 3, 1, [0xff, 0xff, 0, 0]), entry(0xa005, 4, 1, 56_u32.to_le_bytes())]);
    let interop = directory(&[entry(1, 2, 4, *b"R03\0")]);
    let exif = [b"Exif\0\0II*\0\x08\0\0\0", &own[..], &camera, &interop].concat();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.jpg");
    written(&path, &picture(8, 8, Channels::Rgb, Depth::Eight), &Metadata::default());
    let bytes = std::fs::read(&path).unwrap();
    let segment = [&[0xff, 0xe1][..], &(exif.len() as u16 + 2).to_be_bytes(), &exif].concat();
    std::fs::write(&path, [&bytes[..2], &segment, &bytes[2..]].concat()).unwrap();
    assert_eq!(probe(&path).unwrap().metadata.colour_space().as_deref(), Some("Adobe RGB (1998)"));
}

#[test]
fn openexr_names_encoded_spaces_and_those_that_it_does_not_know() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let image = patches(Depth::Half, Channels::Rgb, 4);
    for (transfer, id) in [(Transfer::Srgb, "srgb_ap1_scene"), (Transfer::Gamma(2.2), "g22_ap1_scene")] {
        written(&path, &image, &tagged(transfer.clone(), Primaries::AP1));
        assert!(contains(&std::fs::read(&path).unwrap(), id.as_bytes()), "{id}");
        assert_eq!(probe(&path).unwrap().metadata.transfer, Some(transfer));
    }
    written(&path, &image, &tagged(Transfer::Pq, Primaries::AP1));
    assert!(!contains(&std::fs::read(&path).unwrap(), b"colorInteropID"), "no name for this");
    written(&path, &image, &tagged(Transfer::Linear, Primaries::AP1));
    let mut bytes = std::fs::read(&path).unwrap();
    let id = bytes.windows(7).position(|window| window == b"lin_ap1").unwrap();
    bytes[id..id + 3].copy_from_slice(b"odd");
    std::fs::write(&path, bytes).unwrap();
    let found = probe(&path).unwrap().metadata;
    assert!(
        found.complaints[0].contains("odd_ap1_scene, is not known here, and is left out"),
        "{:?}",
        found.complaints
    );
    assert_eq!(found.primaries, Some(Primaries::AP1));
}

#[test]
fn openexr_says_its_chromaticities_and_white() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let image = patches(Depth::Half, Channels::Rgb, 4);
    let metadata = Metadata { white_luminance: Some(100.0), ..tagged(Transfer::Linear, Primaries::AP1) };
    written(&path, &image, &metadata);
    let found = probe(&path).unwrap().metadata;
    assert_eq!((found.primaries, found.white_luminance), (Some(Primaries::AP1), Some(100.0)));
    assert_eq!(found.colour_space().as_deref(), Some("ACEScg"));
    let mut bytes = std::fs::read(&path).unwrap();
    assert!(contains(&bytes, b"colorInteropID\0string\0\x0d\0\0\0lin_ap1_scene"), "an attribute of OpenEXR 3.4");
    // The name of another space beside the numbers.
    let id = bytes.windows(7).position(|window| window == b"lin_ap1").unwrap();
    bytes[id + 6] = b'0';
    std::fs::write(&path, bytes).unwrap();
    let found = probe(&path).unwrap().metadata;
    assert_eq!(found.primaries, Some(Primaries::AP1));
    assert!(found.complaints[0].contains("chromaticities come first"), "{:?}", found.complaints);
    written(&path, &image, &Metadata { white_luminance: Some(-1.0), ..Metadata::default() });
    let found = probe(&path).unwrap().metadata;
    assert!(found.white_luminance.is_none() && found.complaints[0].contains("whiteLuminance"));
}

#[test]
fn radiance_says_its_primaries() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.hdr");
    let pixel = b"FORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x81";
    let found = |line: &str| {
        std::fs::write(&path, [b"#?RADIANCE\n", line.as_bytes(), pixel].concat()).unwrap();
        probe(&path).unwrap().metadata
    };
    let rec2020 = found("PRIMARIES= .708 .292 .17 .797 .131 .046 .3127 .329\n");
    assert_eq!(rec2020.primaries, Some(Primaries::REC2020));
    for line in ["PRIMARIES=\n", "PRIMARIES=1 2 3\n", "PRIMARIES=0 0 0 0 1 1 0 0\n", "PRIMARIES=a b c d e f g h\n"] {
        let found = found(line);
        assert!(found.primaries.is_none() && found.complaints[0].starts_with("its PRIMARIES are ignored"), "{line}");
    }
    for line in ["", "PRIMARIES=0 0 0 0 0 0 0 0\n"] {
        assert!(found(line).primaries.is_none() && found(line).complaints.is_empty(), "{line}");
    }
}

/// What a program prints about a file.
fn told(program: &str, arguments: &[&str], path: &Path) -> String {
    let output = Command::new(program).args(arguments).arg(path).output().unwrap();
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Numbers of a text.
fn numbers(text: &str) -> Vec<f64> {
    text.split(|c: char| !c.is_ascii_digit() && c != '.' && c != '-').filter_map(|word| word.parse().ok()).collect()
}

#[test]
fn exrheader_and_oiiotool_see_our_chromaticities() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    for primaries in SPACES {
        let metadata = Metadata { white_luminance: Some(203.0), ..tagged(Transfer::Linear, primaries) };
        written(&path, &patches(Depth::Half, Channels::Rgb, 4), &metadata);
        if let Some(exrheader) = program("exrheader") {
            let text = told(exrheader, &[], &path);
            let (_, said) = text.split_once("chromaticities").unwrap_or_else(|| panic!("{text}"));
            let lines: Vec<&str> = said.lines().skip(1).take(4).collect();
            let found = numbers(&lines.join(" "));
            let expected = primaries.pairs().into_iter().flatten();
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-5) && found.len() == 8, "{text}");
            assert!(text.contains("whiteLuminance (type float): 203"), "{text}");
        }
        if let Some(oiiotool) = program("oiiotool") {
            let text = told(oiiotool, &["--info", "-v"], &path);
            let line = text.lines().find(|line| line.contains("chromaticities")).unwrap_or_else(|| panic!("{text}"));
            let found = numbers(line);
            let expected = primaries.pairs().into_iter().flatten();
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-5) && found.len() == 8, "{line}");
        }
    }
}

#[test]
fn oiiotool_and_image_magick_see_our_profiles() {
    let folder = tempfile::tempdir().unwrap();
    for (name, primaries, transfer, said) in [
        ("a.tif", Primaries::P3_D65, Transfer::Srgb, "Display P3"),
        ("b.tif", Primaries::REC2020, Transfer::Pq, "Rec. 2020, PQ"),
        ("a.jpg", Primaries::ADOBE_RGB, Transfer::Gamma(563.0 / 256.0), "Adobe RGB (1998)"),
        ("a.png", Primaries::AP1, Transfer::Srgb, "ACES AP1, sRGB's curve"),
    ] {
        let path = folder.path().join(name);
        written(&path, &patches(Depth::Eight, Channels::Rgb, 4), &tagged(transfer, primaries));
        for (judge, arguments) in [("oiiotool", &["--info", "-v"][..]), ("/usr/bin/identify", &["-verbose"])] {
            let Some(judge) = program(judge) else { continue };
            let text = told(judge, arguments, &path);
            assert!(text.contains(said), "{judge} {name}: {text}");
        }
    }
}

#[test]
fn image_magick_sees_our_chromaticities_in_png() {
    let Some(identify) = program("/usr/bin/identify") else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    for primaries in [Primaries::ADOBE_RGB, Primaries::P3_DCI, own_primaries()] {
        written(&path, &patches(Depth::Sixteen, Channels::Rgb, 4), &tagged(Transfer::Gamma(2.2), primaries));
        let text = told(identify, &["-verbose"], &path);
        let (_, said) = text.split_once("Chromaticity:").unwrap_or_else(|| panic!("{text}"));
        let lines: Vec<&str> = said.lines().skip(1).take(4).collect();
        let found = numbers(&lines.join(" "));
        let expected = primaries.pairs().into_iter().flatten();
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-4) && found.len() == 8, "{text}");
    }
}
