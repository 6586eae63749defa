//! Boxes of MP4 and MOV files: the tags of spherical video, read and written, and whether the file is whole.
#![no_main]

use cosmorama_fuzz::{bytes_of, prepare, written};
use cosmorama_video::{SpatialTags, StereoMode};
use libfuzzer_sys::fuzz_target;

fuzz_target!(init: prepare(seeds), |bytes: &[u8]| {
    let path = written("film.mp4", bytes);
    let _ = SpatialTags::read(&path);
    // Whatever could be written is read again.
    let tags = SpatialTags::vr180();
    if tags.write(&path).is_ok() {
        assert_eq!(SpatialTags::read(&path).ok().flatten(), Some(tags));
    }
});

/// A box with a content.
fn boxed(name: &[u8; 4], content: &[u8]) -> Vec<u8> {
    [&(content.len() as u32 + 8).to_be_bytes(), &name[..], content].concat()
}

/// The description of one video track, without frames.
fn film() -> Vec<u8> {
    let entry = boxed(b"avc1", &[0; 78]);
    let descriptions = boxed(b"stsd", &[&[0, 0, 0, 0, 0, 0, 0, 1], &entry[..]].concat());
    let table = boxed(b"minf", &boxed(b"stbl", &descriptions));
    let handler = boxed(b"hdlr", b"\0\0\0\0\0\0\0\0vide\0\0\0\0");
    let track = boxed(b"trak", &boxed(b"mdia", &[handler, table].concat()));
    [boxed(b"ftyp", b"isom\0\0\0\0"), boxed(b"moov", &track), boxed(b"mdat", b"frames")].concat()
}

/// A film without tags, and with each of ours.
fn seeds() -> Vec<(String, Vec<u8>)> {
    let all = [StereoMode::Mono, StereoMode::TopBottom, StereoMode::LeftRight].map(SpatialTags::panorama);
    let tagged = |tags: SpatialTags| {
        let path = written("seed.mp4", &film());
        tags.write(&path).expect("the film has a video track");
        bytes_of(&path)
    };
    let films = all.into_iter().chain([SpatialTags::vr180()]).map(tagged).chain([film()]);
    films.enumerate().map(|(number, film)| (format!("{number}.mp4"), film)).collect()
}
