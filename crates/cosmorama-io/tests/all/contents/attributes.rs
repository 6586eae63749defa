//! Attributes of OpenEXR files, which are written as they were read.

use std::process::Command;
use std::sync::Arc;

use crate::common::{picture, program};
use cosmorama::raster::{Channels, Depth};
use cosmorama_io::{Attribute, Carried, Metadata, WriteOptions, probe, write};

/// Standard attributes of their own type and of others: a film scan's key code, a time code of 50 frames a second, and what
/// programs make of names that they believe free.
#[test]
fn standard_attributes_come_back_byte_by_byte() {
    let attribute =
        |name: &str, kind: &str, bytes: &[u8]| Attribute { name: name.into(), kind: kind.into(), bytes: bytes.into() };
    let key_code: Vec<u8> =
        [1_i32, 2, 123_456, 1234, 7, 4, 64].iter().flat_map(|number| number.to_le_bytes()).collect();
    let given = vec![
        attribute("keyCode", "keycode", &key_code),
        attribute("timeCode", "timecode", &[0x35, 0x45, 0x23, 0x01, 0, 0, 0, 0]),
        attribute("owner", "int", &7_i32.to_le_bytes()),
        attribute("framesPerSecond", "double", &23.976_f64.to_le_bytes()),
        attribute("adoptedNeutral", "v2i", &[1, 0, 0, 0, 2, 0, 0, 0]),
        attribute("comments", "stringvector", &[2, 0, 0, 0, b'a', b'b']),
        attribute("capDate", "string", b"2026:11:25 10:00:00"),
        attribute("studio/shot", "studioType", &[1, 2, 3]),
    ];
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let carried = Arc::new(Carried::from(given.clone()));
    let options = WriteOptions::with_metadata(Metadata { carried, ..Metadata::default() });
    write(&path, &picture(8, 8, Channels::Rgb, Depth::Half), &options).unwrap();
    let found = &probe(&path).unwrap().metadata.carried;
    for attribute in given {
        let all = found.attributes.iter().filter(|other| other.name == attribute.name);
        assert_eq!(all.collect::<Vec<_>>(), [&attribute]);
    }
    if let Some(exrheader) = program("exrheader") {
        let output = Command::new(exrheader).arg(&path).output().unwrap();
        let told = String::from_utf8_lossy(&output.stdout);
        assert!(
            output.status.success() && told.contains("23:45:35"),
            "{told}{}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
}
