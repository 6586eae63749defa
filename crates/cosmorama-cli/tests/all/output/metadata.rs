//! What becomes of attributes, texts, Exif and XMP: the table of docs/metadata.md, orientation, pose and `--strip`.

use std::io::Cursor;
use std::process::Command;
use std::sync::Arc;

use super::page_table::{self, FORMATS};
use crate::bench::{Bench, eight_bits, flat, text};
use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};
use cosmorama_io::{
    Attribute, Carried, Format, LayeredImage, Metadata, Plane, PlaneSamples, WriteOptions, probe, probe_from, write,
    write_layers,
};

/// An Exif block by the specification: the file's own directory, and the camera's.
fn exif(orientation: u16) -> Vec<u8> {
    let entry = |tag: u16, kind: u16, count: u32, value: [u8; 4]| {
        [&tag.to_le_bytes()[..], &kind.to_le_bytes(), &count.to_le_bytes(), &value].concat()
    };
    let short = |number: u16| [number.to_le_bytes(), [0, 0]].concat().try_into().unwrap();
    let directory =
        |entries: &[Vec<u8>]| [&(entries.len() as u16).to_le_bytes()[..], &entries.concat(), &[0; 4]].concat();
    let own = directory(&[
        entry(0x0112, 3, 1, short(orientation)),
        entry(0x013b, 2, 4, *b"Ada\0"),
        entry(0x8769, 4, 1, 50_u32.to_le_bytes()),
    ]);
    let camera = directory(&[
        entry(0x8827, 3, 1, short(200)),
        entry(0xa002, 4, 1, 9999_u32.to_le_bytes()),
        entry(0xa405, 3, 1, short(24)),
    ]);
    [b"II*\0\x08\0\0\0", &own[..], &camera].concat()
}

/// An XMP packet with these properties.
fn xmp(properties: &str) -> Vec<u8> {
    format!(
        "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">\
         <rdf:Description rdf:about=\"\" xmlns:dc=\"http://purl.org/dc/elements/1.1/\" \
         xmlns:tiff=\"http://ns.adobe.com/tiff/1.0/\" xmlns:crs=\"http://ns.adobe.com/camera-raw-settings/1.0/\" \
         xmlns:GPano=\"http://ns.google.com/photos/1.0/panorama/\" {properties}/></rdf:RDF></x:xmpmeta>"
    )
    .into_bytes()
}

/// Puts segments of an application behind a JPEG's first mark.
fn with_segments(jpeg: &[u8], segments: &[(&[u8], Vec<u8>)]) -> Vec<u8> {
    let segment = |(name, content): &(&[u8], Vec<u8>)| {
        let length = (2 + name.len() + content.len()) as u16;
        [&[0xff, 0xe1][..], &length.to_be_bytes(), name, content].concat()
    };
    [&jpeg[..2], &segments.iter().flat_map(segment).collect::<Vec<u8>>(), &jpeg[2..]].concat()
}

const EXIF: &[u8] = b"Exif\0\0";
const XMP: &[u8] = b"http://ns.adobe.com/xap/1.0/\0";

/// Puts a chunk behind a PNG's header.
fn with_chunk(png: &[u8], kind: &[u8; 4], content: &[u8]) -> Vec<u8> {
    let body = [&kind[..], content].concat();
    // The cyclic redundancy code of the PNG specification, annex D.
    let code = body.iter().fold(u32::MAX, |code, byte| {
        (0..8).fold(code ^ u32::from(*byte), |code, _| if code & 1 == 1 { 0xedb8_8320 ^ code >> 1 } else { code >> 1 })
    });
    let chunk = [&(content.len() as u32).to_be_bytes()[..], &body, &(!code).to_be_bytes()].concat();
    [&png[..33], &chunk, &png[33..]].concat()
}

/// Inputs that say something: one of each kind.
fn inputs(bench: &Bench) {
    let picture = flat(16, 8, &[100, 150, 200]);
    bench.save("a.jpg", &picture);
    let packet = xmp("dc:creator=\"Ada\" tiff:ImageWidth=\"9999\" crs:CropTop=\"0.1\"");
    let jpeg = with_segments(&bench.bytes("a.jpg"), &[(EXIF, exif(1)), (XMP, packet)]);
    std::fs::write(bench.path("a.jpg"), jpeg).unwrap();
    bench.save("a.png", &picture);
    let png = with_chunk(&bench.bytes("a.png"), b"tEXt", b"Title\0Sky");
    std::fs::write(bench.path("a.png"), with_chunk(&png, b"tEXt", b"Thumb::URI\0file:///a")).unwrap();
    let attribute = |name: &str, kind: &str, bytes: &[u8]| Attribute {
        name: name.to_owned(),
        kind: kind.to_owned(),
        bytes: bytes.to_vec(),
    };
    let attributes = vec![
        attribute("owner", "string", b"Ada"),
        attribute("framesPerSecond", "rational", &[24, 0, 0, 0, 1, 0, 0, 0]),
        attribute("studio/shot", "studioType", &[1, 2, 3]),
        attribute("worldToCamera", "m44f", &[0; 64]),
    ];
    let carried = Arc::new(Carried::from(attributes));
    let light = EncodedImage::new(16, 8, Channels::Rgb, Depth::Float, Samples::Float(vec![0.5; 384])).unwrap();
    write(bench.path("a.exr"), &light, &WriteOptions::with_metadata(Metadata { carried, ..Metadata::default() }))
        .unwrap();
}

/// All that a file says.
fn said(bench: &Bench, name: &str) -> Vec<(String, String)> {
    let carried = probe(bench.path(name)).unwrap().metadata.carried;
    let attributes = carried.attributes.iter().map(|attribute| (attribute.name.clone(), attribute.value()));
    let texts = carried.texts.iter().map(|text| (text.keyword(), text.text().unwrap()));
    let exif = carried.exif.as_ref().map(|exif| exif.told()).unwrap_or_default();
    attributes.chain(texts).chain(exif).chain(carried.xmp()).collect()
}

fn shape(extension: &str) -> &'static [&'static str] {
    match extension {
        "ktx2" | "dds" => &["--from", "equirect", "--to", "cube", "--size", "8"],
        _ => &["--from", "equirect", "--to", "equirect", "--size", "16x8"],
    }
}

/// Rows of the table: what is told of, its input, and its name there.
const ROWS: [(&str, &str, &str); 11] = [
    ("OpenEXR `owner`", "a.exr", "owner"),
    ("OpenEXR `framesPerSecond`", "a.exr", "framesPerSecond"),
    ("OpenEXR attribute of an unknown type", "a.exr", "studio/shot"),
    ("OpenEXR `worldToCamera`", "a.exr", "worldToCamera"),
    ("PNG text", "a.png", "Title"),
    ("PNG text about a preview", "a.png", "Thumb::URI"),
    ("Exif `PhotographicSensitivity`", "a.jpg", "PhotographicSensitivity"),
    ("Exif `PixelXDimension`", "a.jpg", "PixelXDimension"),
    ("Exif `FocalLengthIn35mmFilm`", "a.jpg", "FocalLengthIn35mmFilm"),
    ("XMP `dc:creator`", "a.jpg", "dc:creator"),
    ("XMP `crs:CropTop`", "a.jpg", "crs:CropTop"),
];

#[test]
fn the_table_of_the_page_is_what_happens() {
    let bench = Bench::new();
    inputs(&bench);
    let mut rows: Vec<String> = ROWS.iter().map(|(about, ..)| format!("| {about} |")).collect();
    for (_, extension) in FORMATS {
        for input in ["a.exr", "a.png", "a.jpg"] {
            let (before, output) = (said(&bench, input), format!("out.{extension}"));
            let run = bench.run(&[&["-v", "convert", input, &output, "-y"], shape(extension)].concat());
            let told = text(&run.stderr);
            assert!(run.status.success(), "{told}");
            let after = said(&bench, &output);
            for (row, (_, _, key)) in rows.iter_mut().zip(ROWS).filter(|(_, (_, from, _))| *from == input) {
                let value =
                    |all: &[(String, String)]| all.iter().find(|(name, _)| name == key).map(|(_, value)| value.clone());
                let (old, new) = (value(&before).unwrap(), value(&after));
                let is_untrue = told.lines().any(|line| line.contains("untrue of the output") && line.contains(key));
                let cell = match new {
                    Some(new) if new == old => "kept",
                    Some(_) => "rewritten",
                    None if is_untrue => "left out as untrue",
                    None if told.contains("warning:") && told.contains("cannot hold what the input says") => {
                        "not held: a warning"
                    }
                    None if told.contains("cannot hold what the input says") => "not held: told with `-v`",
                    None => "not held",
                };
                *row += &format!(" {cell} |");
            }
            let stripped = bench.succeed(&[&["convert", input, &output, "-y", "--strip"], shape(extension)].concat());
            let left = said(&bench, &output);
            assert!(left.iter().all(|(name, _)| ROWS.iter().all(|(.., key)| key != name)), "{stripped} {left:?}");
        }
    }
    page_table::check("metadata.md", "metadata.rs", &rows);
}

/// The picture 1 2 3 / 4 5 6 in its eight orientations by the table of Exif 2.32, figure 6.
#[test]
fn pictures_are_turned_as_they_ask_and_written_upright() {
    let bench = Bench::new();
    let upright: [(u16, usize, [u8; 6]); 4] = [
        (1, 3, [10, 20, 30, 40, 50, 60]),
        (2, 3, [30, 20, 10, 60, 50, 40]),
        (6, 2, [40, 10, 50, 20, 60, 30]),
        (8, 2, [30, 60, 20, 50, 10, 40]),
    ];
    let stored =
        EncodedImage::new(3, 2, Channels::Grey, Depth::Eight, Samples::U8(vec![10, 20, 30, 40, 50, 60])).unwrap();
    bench.save("s.png", &stored);
    for (orientation, width, expected) in upright {
        std::fs::write(bench.path("t.png"), with_chunk(&bench.bytes("s.png"), b"eXIf", &exif(orientation))).unwrap();
        let picture = bench.load("t.png");
        assert_eq!((picture.width(), eight_bits(&picture)), (width, &expected[..]), "orientation {orientation}");
        assert_eq!(probe(bench.path("t.png")).unwrap().width, width);
    }
    let told = bench.succeed(&["info", "t.png"]);
    assert!(
        told.contains("orientation: 8 (followed") && told.contains("width: 2") && told.contains("Artist: Ada"),
        "{told}"
    );
    bench.succeed(&[
        "convert",
        "t.png",
        "u.png",
        "--from",
        "perspective:fov=60",
        "--to",
        "perspective:fov=60",
        "--size",
        "2x3",
    ]);
    assert_eq!(probe(bench.path("u.png")).unwrap().metadata.orientation, None);
}

/// A panorama whose camera looked east shows north in the middle once its pose is followed.
#[test]
fn a_pose_is_followed_where_asked_and_told_otherwise() {
    let bench = Bench::new();
    // Four columns: north is where the middle of a camera that looks east has its left neighbour of 90°.
    let columns: Vec<u8> =
        (0..8).flat_map(|_| (0..16).flat_map(|i| [if (2..6).contains(&i) { 250 } else { 20 }; 3])).collect();
    let picture = EncodedImage::new(16, 8, Channels::Rgb, Depth::Eight, Samples::U8(columns)).unwrap();
    bench.save("p.jpg", &picture);
    let packet = xmp(
        "GPano:ProjectionType=\"equirectangular\" GPano:FullPanoWidthPixels=\"16\" GPano:FullPanoHeightPixels=\"8\" \
         GPano:PoseHeadingDegrees=\"90\"",
    );
    std::fs::write(bench.path("p.jpg"), with_segments(&bench.bytes("p.jpg"), &[(XMP, packet)])).unwrap();
    let run = |spec: &str| {
        let to = ["--to", "equirect", "--size", "16x8", "--filter", "point", "-y"];
        let output = bench.run(&[&["convert", "p.jpg", "q.png", "--from", spec], &to[..]].concat());
        let middle = eight_bits(&bench.load("q.png"))[(4 * 16 + 8) * 3];
        (text(&output.stderr), middle)
    };
    let (told, middle) = run("equirect");
    assert!(told.contains("PoseHeadingDegrees 90, which is not followed") && middle < 60, "{told} {middle}");
    let (told, middle) = run("equirect:pose=yes");
    assert!(!told.contains("Pose") && middle > 200, "{told} {middle}");
    assert!(
        bench.fail(2, &["convert", "p.jpg", "r.png", "--to", "equirect:pose=yes"]).contains("pose=yes is for inputs")
    );
}

/// Statements about a film's display, and comments, are told of before they are gone.
#[test]
fn what_goes_along_nowhere_is_told() {
    let bench = Bench::new();
    inputs(&bench);
    let png = with_chunk(&bench.bytes("a.png"), b"cLLI", &[0; 8]);
    std::fs::write(bench.path("b.png"), with_chunk(&png, b"mDCV", &[0; 24])).unwrap();
    let jpeg = bench.bytes("a.jpg");
    let comment = b"\xff\xfe\x00\x07noted";
    std::fs::write(bench.path("b.jpg"), [&jpeg[..2], comment, &jpeg[2..]].concat()).unwrap();
    for (input, names) in [("b.png", &["cLLI", "mDCV"][..]), ("b.jpg", &["a comment (COM)"])] {
        let run = bench.run(&[&["-v", "convert", input, "c.png", "-y"], shape("png")].concat());
        let told = text(&run.stderr);
        let line = told.lines().find(|line| line.contains("not carried over")).unwrap_or_default();
        assert!(run.status.success() && names.iter().all(|name| line.contains(name)), "{told}");
        let info = bench.succeed(&["info", input]);
        assert!(info.contains("not_read") && names.iter().all(|name| info.contains(name)), "{info}");
    }
    let plain = bench.run(&[&["-v", "convert", "a.jpg", "c.png", "-y"], shape("png")].concat());
    assert!(!text(&plain.stderr).contains("comment"), "{}", text(&plain.stderr));
}

/// The names behind a cryptomatte's numbers go along with its channels.
#[test]
fn manifests_of_cryptomatte_go_along() {
    let bench = Bench::new();
    let manifest = r#"{"bunny":"13851a76","default":"42c9679f"}"#;
    let entries = [
        ("name", "uCryptoAsset"),
        ("conversion", "uint32_to_float32"),
        ("hash", "MurmurHash3_32"),
        ("manifest", manifest),
    ];
    let attribute = |(key, value): (&str, &str)| Attribute {
        name: format!("cryptomatte/d593dd7/{key}"),
        kind: "string".to_owned(),
        bytes: value.as_bytes().to_vec(),
    };
    let carried = Arc::new(Carried::from(Vec::from(entries.map(attribute))));
    let size = (16, 8);
    let plane = |channel: &str| Plane {
        name: format!("uCryptoAsset00.{channel}"),
        samples: PlaneSamples::Float(vec![f32::from_bits(0x1385_1a76); 128]),
    };
    let planes = ["R", "G", "B", "A"].map(plane).into();
    let layered = LayeredImage { size, picture: None, names: Vec::new(), planes };
    let options = WriteOptions::with_metadata(Metadata { carried, ..Metadata::default() });
    write_layers(bench.path("c.exr"), layered, &options).unwrap();
    bench.succeed(&["convert", "c.exr", "d.exr", "--from", "equirect", "--to", "fulldome", "--size", "8"]);
    for (key, value) in entries {
        assert!(said(&bench, "d.exr").contains(&(format!("cryptomatte/d593dd7/{key}"), value.to_owned())), "{key}");
    }
}

/// Each frame of a sequence has its own time code.
#[test]
fn frames_keep_their_own_attributes() {
    let bench = Bench::new();
    let light = EncodedImage::new(16, 8, Channels::Rgb, Depth::Float, Samples::Float(vec![0.5; 384])).unwrap();
    for frame in 1_u8..=3 {
        let code = Attribute {
            name: "timeCode".to_owned(),
            kind: "timecode".to_owned(),
            bytes: vec![frame, 0, 0, 1, 0, 0, 0, 0],
        };
        let carried = Arc::new(Carried::from(vec![code]));
        let options = WriteOptions::with_metadata(Metadata { carried, ..Metadata::default() });
        write(bench.path(&format!("f_{frame:04}.exr")), &light, &options).unwrap();
    }
    bench.succeed(&["convert", "f_####.exr", "g_####.exr", "--from", "equirect", "--to", "fulldome", "--size", "8"]);
    for frame in 1..=3 {
        let code = ("timeCode".to_owned(), format!("01:00:00:0{frame}"));
        assert!(said(&bench, &format!("g_{frame:04}.exr")).contains(&code));
    }
}

/// Output of another program; `None`, loudly, where it is not installed. In CI it must be.
fn peer(bench: &Bench, program: &str, args: &[&str]) -> Option<String> {
    let Ok(output) = Command::new(program).args(args).current_dir(bench.path("")).output() else {
        assert!(std::env::var_os("CI").is_none(), "{program} is not installed");
        eprintln!("SKIPPED: {program} is not installed");
        return None;
    };
    assert!(output.status.success(), "{program} {args:?}: {}", text(&output.stderr));
    Some(text(&output.stdout))
}

#[test]
fn other_programs_read_what_went_along() {
    let bench = Bench::new();
    inputs(&bench);
    let to = ["--from", "equirect", "--to", "equirect", "--size", "32x16"];
    for output in ["out.jpg", "out.png", "out.tif"] {
        bench.succeed(&[&["convert", "a.jpg", output], &to[..]].concat());
        let Some(told) = peer(&bench, "exiftool", &["-s", "-a", "-G", output]) else { return };
        let says = |group: &str, name: &str, value: &str| {
            let is_it = |line: &str| {
                line.contains(group) && line.contains(&format!(" {name} ")) && line.ends_with(&format!(": {value}"))
            };
            assert!(told.lines().any(is_it), "{output}: no {group} {name}: {value}\n{told}");
        };
        says("EXIF", "Artist", "Ada");
        says("EXIF", "ISO", "200");
        says("EXIF", "ExifImageWidth", "32");
        says("XMP", "Creator", "Ada");
        says("XMP", "FullPanoWidthPixels", "32");
        assert!(
            !told.contains("FocalLengthIn35mm") && !told.contains("CropTop") && !told.contains("Warning"),
            "{told}"
        );
    }
    bench.succeed(&[&["convert", "a.png", "text.png"], &to[..]].concat());
    let told = peer(&bench, "exiftool", &["-s", "text.png"]).unwrap_or_default();
    assert!(told.contains(": Sky") && !told.contains("Thumb"), "{told}");
}

#[test]
fn openexr_reads_our_attributes_and_no_environment_map_but_on_edges() {
    let bench = Bench::new();
    inputs(&bench);
    let run = |output: &str, spec: &str| {
        bench.succeed(&["convert", "a.exr", output, "--from", "equirect", "--to", spec, "--size", "32x16"]);
        peer(&bench, "exrheader", &[output])
    };
    let Some(centres) = run("centres.exr", "equirect") else { return };
    for part in
        ["owner (type string): \"Ada\"", "framesPerSecond (type rational): 24/1", "studio/shot (type studioType)"]
    {
        assert!(centres.contains(part), "{part}: {centres}");
    }
    assert!(!centres.contains("envmap") && !centres.contains("worldToCamera"), "{centres}");
    let edges = run("edges.exr", "equirect:samples=edges").unwrap_or_default();
    assert!(edges.contains("envmap (type envmap): latitude-longitude map"), "{edges}");
}

/// Damaged Exif and XMP are left out or read in part; nothing panics, and the picture stays.
#[test]
fn damaged_metadata_are_left_out() {
    let bench = Bench::new();
    inputs(&bench);
    let bytes = bench.bytes("a.jpg");
    let start = bytes.windows(6).position(|window| window == EXIF).unwrap();
    let end = start + 500;
    let mut seed = 3_u32;
    for _ in 0..400 {
        let mut damaged = bytes.clone();
        for _ in 0..3 {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            damaged[start + 6 + seed as usize / 512 % (end - start)] = (seed >> 3) as u8;
        }
        if let Ok(header) = probe_from(Cursor::new(damaged), "damaged.jpg") {
            for format in Format::ALL {
                let _ = (header.metadata.carried.kept(format.room()), header.metadata.carried.xmp());
            }
        }
    }
    // A directory that names itself, entry by entry.
    let mut circle = b"II*\0\x08\0\0\0\xff\x03".to_vec();
    (0..1023).for_each(|place: u32| {
        circle.extend([0x69, 0x87, 4, 0, 1, 0, 0, 0]);
        circle.extend((8 + place).to_le_bytes());
    });
    bench.save("c.jpg", &flat(16, 8, &[1, 2, 3]));
    std::fs::write(bench.path("c.jpg"), with_segments(&bench.bytes("c.jpg"), &[(EXIF, circle)])).unwrap();
    assert!(bench.succeed(&["info", "c.jpg"]).contains("its Exif metadata are left out"));
}

#[test]
fn an_attribute_of_absurd_size_is_refused_before_it_is_read() {
    let bench = Bench::new();
    inputs(&bench);
    let mut bytes = bench.bytes("a.exr");
    let name = b"owner\0string\0";
    let at = bytes.windows(name.len()).position(|window| window == name).unwrap() + name.len();
    bytes[at..at + 4].copy_from_slice(&i32::MAX.to_le_bytes());
    std::fs::write(bench.path("a.exr"), bytes).unwrap();
    let told = bench.fail(1, &["info", "a.exr"]);
    assert!(told.contains("an attribute owner of 2147483647 bytes") && told.contains("16 MiB"), "{told}");
}
