//! Disks that run full, and folders that may only be read.

use std::process::{Command, Output};

use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};

use crate::bench::{Bench, assert_says, picture, text};

const FRAMES: usize = 6;

/// Panoramas, of which the fifth is noise, so that its dome is larger than the others.
fn skies(bench: &Bench) {
    for frame in 1..=FRAMES {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 256, 128));
    }
    let mixed = |sample: u32| {
        let mixed = sample.wrapping_mul(0x9e37_79b9);
        ((mixed ^ (mixed >> 15)).wrapping_mul(0x85eb_ca6b) >> 24) as u8
    };
    let noise = (0..3 * 256 * 128).map(mixed).collect();
    let noise = EncodedImage::new(256, 128, Channels::Rgb, Depth::Eight, Samples::U8(noise)).unwrap();
    bench.save("sky_5.png", &noise);
}

const ARGS: &str = "convert sky_#.png dome_#.png --from equirect --to fulldome --size 128 --threads 1";

/// Runs the program under a limit, which a shell sets.
fn limited(bench: &Bench, limit: &str, args: &str) -> Output {
    let script = format!("{limit}; exec {} {args}", env!("CARGO_BIN_EXE_cosmorama"));
    Command::new("sh").args(["-c", &script]).current_dir(bench.path("")).output().unwrap()
}

/// The domes that are there; nothing but skies may lie beside them.
fn domes(bench: &Bench) -> Vec<String> {
    let names = bench.files().into_iter().map(|path| path.file_name().unwrap().to_str().unwrap().to_owned());
    let made: Vec<String> = names.filter(|name| !name.starts_with("sky_")).collect();
    assert!(made.iter().all(|name| name.starts_with("dome_")), "{made:?}");
    made
}

#[test]
fn a_disk_that_runs_full_ends_a_sequence_with_the_frame_and_resume_goes_on() {
    let bench = Bench::new();
    skies(&bench);
    bench.succeed(&ARGS.split(' ').collect::<Vec<_>>());
    let whole: Vec<Vec<u8>> = (1..=FRAMES).map(|frame| bench.bytes(&format!("dome_{frame}.png"))).collect();
    domes(&bench).iter().for_each(|name| std::fs::remove_file(bench.path(name)).unwrap());
    // A limit on the size of files fails as a full disk does. Blocks of 512 bytes: room for all frames but the fifth.
    let of_others =
        whole.iter().enumerate().filter(|(index, _)| *index != 4).map(|(_, bytes)| bytes.len()).max().unwrap();
    assert!(whole[4].len() > of_others + 512, "{} {of_others}", whole[4].len());
    let output = limited(&bench, &format!("ulimit -f {}", of_others.div_ceil(512)), ARGS);
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert_says(&message, &["error: frame 5: cannot write dome_5.png"]);
    let made = domes(&bench);
    assert!((4..FRAMES).contains(&made.len()) && !made.contains(&"dome_5.png".to_owned()), "{made:?}");
    let resumed: Vec<&str> = ARGS.split(' ').chain(["--resume"]).collect();
    bench.succeed(&resumed);
    assert!((1..=FRAMES).all(|frame| bench.bytes(&format!("dome_{frame}.png")) == whole[frame - 1]));
}

#[test]
fn a_folder_that_may_only_be_read_is_found_before_the_work() {
    let bench = Bench::new();
    skies(&bench);
    // Not even root can write here.
    let message = bench.fail(
        1,
        &["convert", "sky_#.png", "/sys/dome_#.png", "--from", "equirect", "--to", "fulldome", "--size", "64"],
    );
    assert_says(
        &message,
        &["cannot write /sys/dome_1.png", "no files can be made in its folder /sys", "choose another"],
    );
}
