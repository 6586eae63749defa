//! Texts that programs write for us: calibrations, Hugin's projects, paths of cameras; and what files say about how they were made.

use std::io::Cursor;
use std::path::Path;
use std::time::Instant;

use cosmorama::raster::{Channels, Depth};
use cosmorama_io::{
    Calibration, CameraPath, Format, Limits, Metadata, PathSource, PtoProject, WriteOptions, probe_from, read_from,
    write_to,
};
use testkit::Mutants;

use super::LONGEST;
use crate::common::picture;

/// A kind of text: a name, an example as programs write it, words that mean something in it, and whether it is read.
struct Kind {
    name: &'static str,
    text: &'static str,
    words: &'static [&'static str],
    read: fn(&Path, &[u8]) -> bool,
}

const KINDS: [Kind; 11] = [
    Kind {
        name: "opencv.yml",
        text: include_str!("../../../../../fuzz/seeds/calibrations/opencv.yml"),
        words: &["&a ", "*a ", "? ", "- ", "|\n", "<<: *a", "xi: 1", "model: kannala-brandt", "%TAG ! !"],
        read: calibration,
    },
    Kind {
        name: "ros.yaml",
        text: include_str!("../../../../../fuzz/seeds/calibrations/ros.yaml"),
        words: &["fisheye", "equidistant", "rational_polynomial", "cam1:", "&a ", "*a "],
        read: calibration,
    },
    Kind {
        name: "camera.json",
        text: include_str!("../../../../../fuzz/seeds/calibrations/camera.json"),
        words: &["[", "]", "{", "}", "null", "\"xi\": 2,", "\"model\": \"fisheye\","],
        read: calibration,
    },
    Kind {
        name: "opencv.xml",
        text: include_str!("../../../../../fuzz/seeds/calibrations/opencv.xml"),
        words: &["<a>", "</a>", "<!--", "-->", "<![CDATA[", "<!DOCTYPE a [<!ENTITY b \"c\">]>", "&b;", "&#x0;"],
        read: calibration,
    },
    Kind {
        name: "ocam.txt",
        text: include_str!("../../../../../fuzz/seeds/calibrations/ocam.txt"),
        words: &["#", "\n\n", "5 ", "1000000 "],
        read: calibration,
    },
    Kind {
        name: "two.pto",
        text: include_str!("../../../../../fuzz/seeds/projects/two.pto"),
        words: &["\ni ", "\np ", "\nk ", "=0", "=1", "v=1", "n\"", "S1,2,3,4 ", "f3 ", "f19 "],
        read: project,
    },
    Kind {
        name: "path.csv",
        text: include_str!("../../../../../fuzz/seeds/paths/path.csv"),
        words: &["time", "qw,qx,qy,qz", ";", "\t", "\"", "\"\"", "\r\n", "org_pitch", "nan"],
        read: path,
    },
    Kind {
        name: "quaternions.json",
        text: include_str!("../../../../../fuzz/seeds/paths/quaternions.json"),
        words: &["[", "]", "{", "}", "null", "\"frame\": 1,", "\"time\": [0, 1],", "\"yaw\": 3,"],
        read: path,
    },
    Kind {
        name: "gyroflow.csv",
        text: include_str!("../../../../../fuzz/seeds/paths/gyroflow.csv"),
        words: &["org_quat_w,org_quat_x,org_quat_y,org_quat_z", "stab_", "\n", ","],
        read: path,
    },
    Kind {
        name: "gyroflow.json",
        text: include_str!("../../../../../fuzz/seeds/paths/gyroflow.json"),
        words: &["[", "]", "{", "}", "null", "\"stab_quat_w\": [1, 1],"],
        read: path,
    },
    Kind {
        name: "camera.gltf",
        text: include_str!("../../../../../fuzz/seeds/paths/camera.gltf"),
        words: &[
            "CUBICSPLINE",
            "STEP",
            "\"children\":[0],",
            "\"sparse\":{\"count\":1},",
            "VEC3",
            "5121",
            "{",
            "}",
            "[",
            "]",
        ],
        read: path,
    },
];

fn calibration(name: &Path, bytes: &[u8]) -> bool {
    Calibration::read_from(bytes, name).is_ok()
}

fn project(name: &Path, bytes: &[u8]) -> bool {
    PtoProject::read_from(bytes, name).is_ok()
}

/// By frame and by time, of the camera that makes pictures and of the one that made them.
fn path(name: &Path, bytes: &[u8]) -> bool {
    let beside = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
    let ways = [(None, false), (Some(25.0), false), (Some(25.0), true)];
    let read = |(fps, is_of_input): (Option<f64>, bool)| {
        CameraPath::read(bytes, &PathSource { name, fps, node: None, is_of_input, beside: &beside })
    };
    ways.into_iter().filter_map(|way| read(way).ok()).fold(false, |_, path| {
        let is_finite = |pose: &cosmorama_io::PathPose| {
            pose.frame.is_finite() && pose.orientation.yaw_pitch_roll().iter().all(|angle| angle.degrees().is_finite())
        };
        assert!(path.poses.iter().all(is_finite), "{}: {:?}", name.display(), path.poses);
        true
    })
}

#[test]
fn texts_of_other_programs_never_panic() {
    for (seed, Kind { name, text, words, read }) in (0..).zip(KINDS) {
        let read = |bytes: &[u8]| read(Path::new(name), bytes);
        assert!(read(text.as_bytes()), "{name} is as programs write it");
        for length in 0..text.len() {
            read(&text.as_bytes()[..length]);
        }
        for (mutant, damaged) in Mutants::new(text.as_bytes(), words, seed).take(Mutants::count(2000)).enumerate() {
            let start = Instant::now();
            read(&damaged);
            let spent = start.elapsed();
            assert!(spent < LONGEST, "{name}, mutant {mutant}: {spent:?} for {}", String::from_utf8_lossy(&damaged));
        }
    }
}

#[test]
fn gltf_shorter_than_its_own_header_is_refused() {
    let beside = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
    let source = PathSource { name: Path::new("a.glb"), fps: None, node: None, is_of_input: false, beside: &beside };
    for length in [0_u32, 11] {
        let bytes = [b"glTF\x02\0\0\0", &length.to_le_bytes()[..], &[0; 20]].concat();
        let error = CameraPath::read(&bytes, &source).unwrap_err().to_string();
        assert!(error.contains("a.glb") && error.contains(&format!("it has {length} bytes")), "{error}");
    }
}

/// Each pose brings a name of its own: a table of all names for all poses would have 80 gigabytes.
#[test]
fn more_names_than_programs_write_are_refused() {
    let beside = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
    let read = |name: &str, text: &str| {
        let source = PathSource { name: Path::new(name), fps: None, node: None, is_of_input: false, beside: &beside };
        CameraPath::read(text.as_bytes(), &source).unwrap_err().to_string()
    };
    let names: Vec<String> = (0..80_000).map(|index| format!("\"frame{index}\"")).collect();
    let poses: Vec<String> = names.iter().map(|name| format!("{{{name}: 1}}")).collect();
    let columns: Vec<String> = names.iter().map(|name| format!("{name}: [1]")).collect();
    for (name, text) in [
        ("a.json", format!("[{}]", poses.join(","))),
        ("b.json", format!("{{{}}}", columns.join(","))),
        ("c.csv", names.join(",")),
    ] {
        let start = Instant::now();
        let error = read(name, &text);
        assert!(error.contains(name) && error.contains("more than 256 columns"), "{error}");
        assert!(start.elapsed() < LONGEST / 2, "{name}: {:?}", start.elapsed());
    }
}

/// Times that are finite may be of frames that are not.
#[test]
fn frames_beyond_all_numbers_are_refused_with_their_place() {
    let text = "time,yaw,pitch,roll\n-1e308,0,0,0\n1,0,0,0\n";
    let error = CameraPath::parse(text.as_bytes(), Path::new("far.csv"), Some(25.0)).unwrap_err().to_string();
    assert!(error.contains("far.csv: line 2: ") && error.contains("frame -inf"), "{error}");
}

/// Each pose is compared with the one before it, and with no other.
#[test]
fn long_paths_take_time_by_their_length() {
    let text: String = (0..300_000).map(|frame| format!("{frame},0,0,0\n")).collect();
    let start = Instant::now();
    let path = CameraPath::parse(text.as_bytes(), Path::new("long.csv"), None).unwrap();
    assert_eq!(path.poses.len(), 300_000);
    assert!(start.elapsed() < LONGEST, "{:?}", start.elapsed());
}

/// What a file says of how it was made is read from its texts, which may be longer, shorter or other than any we write.
#[test]
fn origins_are_words_that_every_format_holds() {
    const ORIGIN: &str = "0.2.0, geometry 0123abcd, filter 89abcdef, colour 00000000, pose 11111111, input 22222222";
    let metadata = Metadata { origin: Some(ORIGIN.to_owned()), ..Metadata::default() };
    let options = WriteOptions::with_metadata(metadata);
    for format in [Format::Png, Format::Jpeg, Format::Tiff, Format::Exr, Format::Hdr] {
        let image = picture(8, 6, Channels::Rgb, format.nearest_depth(Depth::Eight));
        let mut good = Cursor::new(Vec::new());
        write_to(&mut good, "a", format, &image, &options).unwrap();
        let good = good.into_inner();
        assert_eq!(probe_from(Cursor::new(&good), "a").unwrap().metadata.origin.as_deref(), Some(ORIGIN), "{format}");
        let words = ["cosmorama", "cosmorama (", ")", ", pose ", "Software\0"];
        for damaged in Mutants::new(&good, &words, 8).take(Mutants::count(600)) {
            let start = Instant::now();
            let told = probe_from(Cursor::new(&damaged), "a").ok().and_then(|header| header.metadata.origin);
            let is_told =
                |origin: &String| origin.len() <= 256 && origin.bytes().all(|letter| (b' '..=b'~').contains(&letter));
            assert!(told.as_ref().is_none_or(is_told), "{format}: {told:?}");
            drop(read_from(Cursor::new(&damaged), "a", &Limits::memory(1 << 24)));
            assert!(start.elapsed() < LONGEST, "{format}: {:?}", start.elapsed());
        }
    }
}
