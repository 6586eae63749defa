//! What a frame says of how it was made, which `--resume` compares with what would be made.
#![no_main]

use std::io::Cursor;
use std::sync::LazyLock;

use cosmorama::raster::{Channels, Depth};
use cosmorama_convert::{Conversion, Existing};
use cosmorama_fuzz::{path, picture, prepare, written};
use cosmorama_io::{Format, FrameList, Metadata, WriteOptions, probe, write, write_to};
use libfuzzer_sys::fuzz_target;

/// Origin that the program itself writes.
static HONEST: LazyLock<String> = LazyLock::new(|| {
    write(path("sky_1.png"), &picture((32, 16), Channels::Rgb, Depth::Eight), &WriteOptions::default())
        .expect("a panorama");
    let checked = dome(Existing::Replace).check().result.expect("a dome of it");
    checked.run(&mut cosmorama_convert::Quiet).expect("the dome is written");
    probe(path("dome_1.png")).expect("it is read").metadata.origin.expect("it says how it was made")
});

fn dome(existing: Existing) -> Conversion {
    let name = |of: &str| path(&format!("{of}_#.png")).display().to_string();
    let conversion = Conversion::new(name("sky"), name("dome")).from("equirect".parse().expect("a projection"));
    let conversion = conversion.to("fulldome".parse().expect("a projection")).size("12".parse().expect("a size"));
    conversion.frames(FrameList::new(1..=1)).existing(existing).threads(1)
}

fuzz_target!(init: prepare(seeds), |bytes: &[u8]| {
    let honest = HONEST.as_str();
    let Ok(text) = str::from_utf8(bytes) else { return };
    let metadata = Metadata { origin: Some(text.to_owned()), ..Metadata::default() };
    let image = picture((12, 12), Channels::Rgb, Depth::Eight);
    // Without waiting for a disk, as files of the program do.
    let (mut file, options) = (Cursor::new(Vec::new()), WriteOptions::with_metadata(metadata));
    if write_to(&mut file, "dome_1.png", Format::Png, &image, &options).is_err() {
        return;
    }
    written("dome_1.png", file.get_ref());
    let resumed = dome(Existing::Resume).check().result;
    assert!(text != honest || resumed.is_ok(), "an honest frame is refused");
});

fn seeds() -> Vec<(String, Vec<u8>)> {
    vec![("origin".to_owned(), HONEST.clone().into_bytes())]
}
