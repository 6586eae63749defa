//! Streams of raw pictures through pipes, so that programs chain.

use std::io::Write;
use std::process::{Output, Stdio};

use super::films::{ffmpeg, film, has_ffmpeg, taken_apart};
use crate::bench::{Bench, assert_says, eight_bits, floats, picture, text};
use cosmorama::raster::{EncodedImage, Samples};

const DOME: [&str; 6] = ["--from", "equirect", "--to", "fulldome", "--size", "16"];

fn piped(bench: &Bench, args: &[&str], input: &[u8]) -> Output {
    let mut command = bench.command(args);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let mut to = child.stdin.take().unwrap();
    std::thread::scope(|scope| {
        // Whoever refuses its arguments reads nothing.
        scope.spawn(move || drop(to.write_all(input)));
        child.wait_with_output().unwrap()
    })
}

/// Returns a picture as binary PPM.
fn ppm(image: &EncodedImage) -> Vec<u8> {
    let head = format!("P6\n{} {}\n255\n", image.width(), image.height());
    [head.as_bytes(), eight_bits(image)].concat()
}

#[test]
fn pictures_of_netpbm_chain() {
    let bench = Bench::new();
    let frames: Vec<u8> = (0..5).flat_map(|seed| ppm(&picture(seed, 64, 32))).collect();
    for (seed, name) in (0..5).map(|seed| (seed, format!("sky_{seed}.png"))) {
        bench.save(&name, &picture(seed, 64, 32));
    }
    bench.succeed(&[&["convert", "sky_#.png", "dome_#.png"], &DOME[..]].concat());
    let output = piped(&bench, &[&["convert", "-", "-", "--format", "pam"], &DOME[..]].concat(), &frames);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(!text(&output.stderr).contains("frames a second, since"), "PAM has no rate: {}", text(&output.stderr));
    let end = b"ENDHDR\n";
    let heads = output.stdout.windows(end.len()).enumerate().filter(|(_, window)| window == end);
    let made: Vec<&[u8]> = heads.map(|(at, _)| &output.stdout[at + end.len()..][..16 * 16 * 3]).collect();
    assert_eq!(made.len(), 5);
    for (seed, made) in made.iter().enumerate() {
        assert!(eight_bits(&bench.load(&format!("dome_{seed}.png"))) == *made, "{seed}");
    }
    // The stream goes on through another conversion.
    let again =
        ["convert", "-", "again_#.png", "--from", "fulldome", "--to", "perspective:fov=60,pitch=90", "--size", "8"];
    let last = piped(&bench, &again, &output.stdout);
    assert!(last.status.success() && bench.path("again_4.png").exists(), "{}", text(&last.stderr));
    // Frames are chosen by number, and one of them is a picture.
    let one = piped(&bench, &[&["convert", "-", "one.png", "--frames", "3"], &DOME[..]].concat(), &frames);
    assert!(one.status.success(), "{}", text(&one.stderr));
    assert!(eight_bits(&bench.load("one.png")) == eight_bits(&bench.load("dome_3.png")));
}

#[test]
fn floats_go_through_unclipped() {
    let bench = Bench::new();
    let light = floats(64, 32, |i, j| [i as f32, 0.25, j as f32 * 8.0]);
    bench.save("sky.exr", &light);
    bench.succeed(&[&["convert", "sky.exr", "dome.exr", "--depth", "float"], &DOME[..]].concat());
    let Samples::Float(samples) = light.samples() else { panic!("floats") };
    let rows = samples.rchunks_exact(64 * 3).flatten().flat_map(|sample| sample.to_le_bytes());
    let map = [&b"PF\n64 32\n-1.0\n"[..], &rows.collect::<Vec<u8>>()].concat();
    let output = piped(&bench, &[&["convert", "-", "-", "--format", "pfm"], &DOME[..]].concat(), &map.repeat(2));
    assert!(output.status.success(), "{}", text(&output.stderr));
    let head = b"PF\n16 16\n-1.0\n";
    assert!(output.stdout.starts_with(head) && output.stdout.len() == 2 * (head.len() + 16 * 16 * 12));
    let made = bench.load("dome.exr");
    let Samples::Float(samples) = made.samples() else { panic!("floats") };
    let rows = samples.rchunks_exact(16 * 3).flatten().flat_map(|sample| sample.to_le_bytes());
    assert!(output.stdout[head.len()..][..16 * 16 * 12] == rows.collect::<Vec<u8>>());
}

#[test]
fn a_stream_that_ends_early_is_refused_and_the_frame_named() {
    let bench = Bench::new();
    let frames: Vec<u8> = (0..3).flat_map(|seed| ppm(&picture(seed, 64, 32))).collect();
    let args = [&["convert", "-", "dome_#.png"], &DOME[..]].concat();
    let output = piped(&bench, &args, &frames[..frames.len() - 7]);
    assert_says(&bench.check_failure(1, &output, &bench.files()), &["standard input", "frame 2"]);
    let output = piped(&bench, &args, b"P7\nWIDTH 70000\nHEIGHT 70000\nDEPTH 4\nMAXVAL 65535\nENDHDR\n");
    assert_says(&bench.check_failure(1, &output, &bench.files()), &["standard input", "70000"]);
}

#[test]
fn yuv_comes_and_goes_as_by_ffmpeg() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    film(&bench, "film.mkv", 4);
    ffmpeg(&bench, &["-i", "film.mkv", "-pix_fmt", "yuv444p", "-f", "yuv4mpegpipe", "-strict", "-1", "film.y4m"]);
    let args = [&["convert", "-", "-", "--format", "y4m"], &DOME[..]].concat();
    let output = piped(&bench, &args, &bench.bytes("film.y4m"));
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_says(&text(&output.stdout[..40]), &["YUV4MPEG2 ", "F25:1", "W16 H16"]);
    // The same through files.
    bench.succeed(&[&["convert", "film.y4m", "dome.y4m"], &DOME[..]].concat());
    assert!(bench.bytes("dome.y4m") == output.stdout);
    assert_eq!(taken_apart(&bench, "dome.y4m", "made"), 4);
    assert_says(&bench.succeed(&["info", "film.y4m"]), &["frames: 0-3", "frame_rate: 25"]);
}
