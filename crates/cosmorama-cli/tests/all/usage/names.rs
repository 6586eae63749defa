//! Names of files: whatever a file system allows, by every verb that takes files.
#![cfg(target_os = "linux")]

use std::ffi::{OsStr, OsString};
use std::os::unix::ffi::OsStrExt;
use std::process::Output;

use crate::bench::{Bench, assert_says, picture, text};

/// Stems of names: blanks, quotes, an end of a line, dashes in front, bytes that are no text, and signs of shells.
const STEMS: [&[u8]; 8] = [
    b"two words ",
    b"it's \"quoted\"",
    b"end\nof a line",
    b"-y",
    b"--help",
    b"b\xff\xfed",
    b"a, frame 3",
    b"$HOME;ls|&~",
];

fn name(stem: &[u8], extension: &str) -> OsString {
    let mut name = OsStr::from_bytes(stem).to_owned();
    name.push(extension);
    name
}

/// Runs a verb with options, and names behind `--`.
fn run(bench: &Bench, args: &[&str], names: &[&OsStr]) -> Output {
    bench.command(args).arg("--").args(names).output().unwrap()
}

/// Runs what must succeed, and leave a file; standard output.
fn made(bench: &Bench, args: &[&str], names: &[&OsStr]) -> String {
    let output = run(bench, args, names);
    assert!(output.status.success(), "{args:?} {names:?}: {}", text(&output.stderr));
    text(&output.stdout)
}

fn exists(bench: &Bench, name: &OsStr) -> bool {
    bench.path("").join(name).is_file()
}

/// Puts a picture into the folder under a name.
fn keep(bench: &Bench, name: &OsStr) {
    if !bench.path("plain.png").exists() {
        bench.save("plain.png", &picture(3, 64, 32));
    }
    std::fs::copy(bench.path("plain.png"), bench.path("").join(name)).unwrap();
}

#[test]
fn pictures_have_any_name() {
    for stem in STEMS {
        let bench = Bench::new();
        let (sky, dome) = (&name(stem, ".png"), &name(stem, " dome.png"));
        keep(&bench, sky);
        let to = ["--to", "fulldome", "--size", "16"];
        let json: serde_json::Value =
            serde_json::from_str(&made(&bench, &[&["convert", "--json"], &to[..]].concat(), &[sky, dome])).unwrap();
        assert_eq!(json["outputs"][0], *dome.to_string_lossy());
        assert!(exists(&bench, dome), "{dome:?}");
        // The same bytes as under a plain name.
        bench.succeed(&[&["convert", "plain.png", "plain dome.png"], &to[..]].concat());
        let bytes = std::fs::read(bench.path("").join(dome)).unwrap();
        assert!(bytes == bench.bytes("plain dome.png"), "{dome:?}");
        // It is not replaced unasked, nor by itself.
        let again = run(&bench, &[&["convert"], &to[..]].concat(), &[sky, dome]);
        assert_says(&text(&again.stderr), &["exists"]);
        let itself = run(&bench, &[&["convert", "-y"], &to[..]].concat(), &[sky, sky]);
        assert_eq!(itself.status.code(), Some(2), "{}", text(&itself.stderr));
        assert_says(&text(&itself.stderr), &["would replace its own input"]);
        // A name that is missing is told as one line.
        let missing = run(&bench, &[&["convert"], &to[..]].concat(), &[&name(stem, " none.png"), dome]);
        // A dollar sign may be a shell's, which is a mistake of the command.
        let code = if stem.contains(&b'$') { 2 } else { 1 };
        assert_eq!((missing.status.code(), text(&missing.stderr).matches("error: ").count()), (Some(code), 1));
    }
}

#[test]
fn every_verb_takes_any_name() {
    for stem in STEMS {
        let bench = Bench::new();
        let sky = &name(stem, ".png");
        keep(&bench, sky);
        let out = |extension: &str| name(stem, extension);
        assert_says(&made(&bench, &["info"], &[sky]), &["width: 64"]);
        let info: serde_json::Value = serde_json::from_str(&made(&bench, &["info", "--json"], &[sky])).unwrap();
        assert_eq!(info["input"], *sky.to_string_lossy());
        assert_says(&made(&bench, &["explain", "--to", "fulldome", "--size", "16"], &[sky]), &["texels"]);
        assert_says(&made(&bench, &["compare"], &[sky, OsStr::new("plain.png")]), &["rms 0.000000"]);
        made(&bench, &["filters", "--from", "equirect", "--to", "fulldome", "--size", "16", "--json"], &[sky]);
        let light = ["--from", "equirect", "--json"];
        made(&bench, &[&["light", "diffuse"], &light[..]].concat(), &[sky, &out(" light.exr")]);
        made(&bench, &[&["light", "table"], &light[..]].concat(), &[sky, &out(" table.csv")]);
        made(&bench, &[&["light", "harmonics"], &light[..]].concat(), &[sky, &out(" sums.json")]);
        made(&bench, &[&["light", "sun"], &light[..]].concat(), &[sky]);
        made(&bench, &["light", "brdf", "--size", "8", "--json"], &[&out(" brdf.exr")]);
        made(&bench, &["shade", "--object", "sphere", "--size", "16"], &[sky, &out(" ball.png")]);
        for file in [" light.exr", " table.csv", " sums.json", " brdf.exr", " ball.png"] {
            assert!(exists(&bench, &out(file)), "{:?}", out(file));
        }
    }
}

/// What stands for several files is text, and so is what a SPEC names.
#[test]
fn what_must_be_text_is_said() {
    let bench = Bench::new();
    let bad = |text: &[u8]| OsStr::from_bytes(text).to_owned();
    keep(&bench, &bad(b"s\xff_1.png"));
    let to = ["convert", "--to", "fulldome", "--size", "16"];
    for (input, output) in [(bad(b"s\xff_#.png"), bad(b"d_#.png")), (bad(b"s\xff_{face}.png"), bad(b"d.png"))] {
        let refused = run(&bench, &to, &[&input, &output]);
        assert_eq!(refused.status.code(), Some(2), "{}", text(&refused.stderr));
        assert_says(&text(&refused.stderr), &["s\u{fffd}_", "are no UTF-8", "no pattern; rename"]);
    }
    keep(&bench, OsStr::new("s_1.png"));
    let refused = run(&bench, &to, &[OsStr::new("s_#.png"), &bad(b"d\xff_#.png")]);
    assert_says(&text(&refused.stderr), &["d\u{fffd}_#.png", "no pattern; rename"]);
    let refused = bench.command(&["verify"]).arg(bad(b"s\xff_#.png")).output().unwrap();
    assert_eq!(refused.status.code(), Some(2));
    assert_says(&text(&refused.stderr), &["s\u{fffd}_#.png", "no pattern; rename"]);
    let option = [OsStr::new("--path"), &bad(b"p\xff.csv")];
    let refused = bench.command(&to).args(["plain.png", "d.png"]).args(option).output().unwrap();
    assert_eq!(refused.status.code(), Some(2));
    assert_says(&text(&refused.stderr), &["'p\u{fffd}.csv' is no text in UTF-8"]);
    // A world file in such a folder finds what is beside it.
    let folder = bench.path("").join(bad(b"dir\xff"));
    std::fs::create_dir(&folder).unwrap();
    std::fs::copy(bench.path("plain.png"), folder.join("view.png")).unwrap();
    std::fs::write(folder.join("world.toml"), "[[view]]\nimage = \"view.png\"\nspec = \"equirect\"\n").unwrap();
    made(&bench, &to, &[&bad(b"dir\xff/world.toml"), &bad(b"dir\xff/dome.png")]);
    assert!(folder.join("dome.png").is_file());
}

/// Streams of raw pictures need no ffmpeg; their frames have names, too.
#[cfg(feature = "video")]
#[test]
fn videos_have_any_name() {
    use crate::sequence::films::{film, has_ffmpeg};
    for stem in STEMS {
        let bench = Bench::new();
        let (film_name, dome) = (&name(stem, ".pam"), &name(stem, " dome.pam"));
        std::fs::write(
            bench.path("").join(film_name),
            [&b"P6\n64 32\n255\n"[..], &[90; 64 * 32 * 3]].concat().repeat(2),
        )
        .unwrap();
        let to = ["convert", "--from", "equirect", "--to", "fulldome", "--size", "16"];
        made(&bench, &to, &[film_name, dome]);
        assert_says(&made(&bench, &["info"], &[dome]), &["frames: 0,1"]);
        if has_ffmpeg() {
            film(&bench, "film.mkv", 3);
            let (film_name, dome) = (&name(stem, ".mkv"), &name(stem, " dome.mkv"));
            std::fs::rename(bench.path("film.mkv"), bench.path("").join(film_name)).unwrap();
            made(&bench, &to, &[film_name, dome]);
            assert_says(&made(&bench, &["info"], &[dome]), &["frames: 0-2"]);
        }
    }
}
