//! What a frame says of how it was made, which `--resume` compares with what would be made. The words go through a file of each format
//! that has room for them; some go on to a whole conversion, which takes a thousand times as long.
#![no_main]

use std::io::Cursor;
use std::sync::LazyLock;

use cosmorama::raster::{Channels, Depth};
use cosmorama_convert::{Conversion, Existing, compared_origins};
use cosmorama_fuzz::{path, picture, prepare, written};
use cosmorama_io::{Format, FrameList, Metadata, WriteOptions, probe, probe_from, write, write_to};
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

/// Formats with room for the words.
const FORMATS: [(Format, &str); 4] = [
    (Format::Png, "dome_1.png"),
    (Format::Jpeg, "dome_1.jpg"),
    (Format::Tiff, "dome_1.tif"),
    (Format::Exr, "dome_1.exr"),
];

/// Inputs of which one is resumed.
const SELDOM: usize = 256;

fuzz_target!(init: prepare(seeds), |bytes: &[u8]| {
    let honest = HONEST.as_str();
    let Ok(text) = str::from_utf8(bytes) else { return };
    let sum = bytes.iter().fold(0, |sum: usize, byte| sum.wrapping_mul(31).wrapping_add(usize::from(*byte)));
    // An honest text is read through all formats, any other through one.
    let tried = if text == honest { &FORMATS[..] } else { &FORMATS[sum % FORMATS.len()..][..1] };
    for (format, name) in tried {
        let Some(file) = framed(text, *format, name) else { return };
        let found = probe_from(Cursor::new(&file), name).expect("it was written").metadata.origin.unwrap_or_default();
        let (is_damaged, differences, _, damage) = compared_origins(&found, honest);
        let is_refused = is_damaged || !differences.is_empty() || damage.is_some();
        assert!(text != honest || !is_refused, "an honest frame is refused");
    }
    if text == honest || sum / FORMATS.len() % SELDOM == 0 {
        written("dome_1.png", &framed(text, Format::Png, "dome_1.png").unwrap_or_default());
        let resumed = dome(Existing::Resume).check().result;
        assert!(text != honest || resumed.is_ok(), "an honest frame is refused");
    }
});

/// Returns a file with words about how it was made; `None` where they cannot be written.
fn framed(text: &str, format: Format, name: &str) -> Option<Vec<u8>> {
    let metadata = Metadata { origin: Some(text.to_owned()), ..Metadata::default() };
    // Without waiting for a disk, as files of the program do.
    let (mut file, options) = (Cursor::new(Vec::new()), WriteOptions::with_metadata(metadata));
    let depth = if format == Format::Exr { Depth::Float } else { Depth::Eight };
    write_to(&mut file, name, format, &picture((12, 12), Channels::Rgb, depth), &options).ok()?;
    Some(file.into_inner())
}

fn seeds() -> Vec<(String, Vec<u8>)> {
    vec![("origin".to_owned(), HONEST.clone().into_bytes())]
}
