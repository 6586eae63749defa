//! Commands that people type wrongly: each is answered by what to type instead.

use crate::bench::{Bench, assert_says, picture};
use cosmorama_spec::{Spec, SpecError};

/// What follows `cosmorama`, and a part of the message: what to type.
const MISTAKES: [(&str, &str); 69] = [
    // Keys of SPECs as options.
    ("convert sky.png out.png --tilt 20", "tilt is a key of fulldome: --to fulldome:tilt=20"),
    ("convert sky.png out.png --to fulldome --tilt 20", "tilt is a key of fulldome: --to fulldome:tilt=20"),
    ("convert sky.png out.png --to fulldome:fov=200 --tilt=-20", "--to fulldome:fov=200,tilt=-20"),
    ("convert sky.png out.png --to perspective --fov 60", "--to perspective:fov=60"),
    ("convert sky.png out.png --to flat --h_fov 90", "of perspective that is the key fov: --to flat:fov=90"),
    ("convert sky.png out.png --to equirect --fov 180", "of equirect that is the key hfov: --to equirect:hfov=180"),
    ("convert sky.png out.png --to omnimax --hfov 90", "hfov is a key of equirect, mercator, cylinder and equal-area"),
    ("convert sky.png out.png --to cube --layout 3x2", "--to cube:layout=3x2"),
    (
        "convert sky.png out.png --lens equisolid",
        "lens is a key of fisheye, hugin and dual-fisheye: --to fisheye:lens=equisolid",
    ),
    (
        "convert dome.png out.png --from fisheye --to equirect --calibration cam.yml",
        "--from fisheye:calibration=cam.yml",
    ),
    ("convert sky.png out.png --to fulldome --flip x", "--to fulldome:flip=x"),
    ("convert sky.png out.png --to fulldome --mirror x", "--to fulldome:flip=x"),
    ("convert sky.png out.png --to equirect --rotate 90", "the view is turned by --yaw, --pitch and --roll"),
    ("explain sky.png --to omnimax --axis 11", "axis is a key of omnimax: --to omnimax:axis=11"),
    ("convert sky.png out.png --to fulldome tilt=20", "without spaces: --to fulldome:tilt=20"),
    ("convert sky.png out.png --to fulldome: tilt=20", "without spaces: --to fulldome:tilt=20"),
    // Options of other programs.
    ("convert sky.png out.png --to fulldome --width 4096", "write --size WxH, as in --size 4096x2048"),
    ("convert sky.png out.png --to fulldome --height 4096", "write --size WxH"),
    ("convert sky.png out.png --to fulldome -o out.png", "the output without an option, after the input"),
    ("convert -i sky.png out.png", "the input without an option, before the output"),
    ("convert sky.png out.png --projection fulldome", "write --to SPEC"),
    ("convert sky.png out.png --to fulldome --force", "write -y"),
    ("convert sky.png out.png --to fulldome --interpolation bicubic", "--kernel NAME, as in --kernel catmull-rom"),
    ("convert sky.png out.png --to fulldome --jobs 4", "write --threads N"),
    ("convert sky.png out.png --to fulldome --bits 16", "write --depth DEPTH, as in --depth 16"),
    ("convert sky.png out.png --to fulldome --start 10", "write --frames LIST"),
    ("convert sky.png out.png --to fulldome --pan 30", "write --yaw D"),
    ("convert sky.png out.png --to fulldome --overwrit", "did you mean --overwrite?"),
    ("convert sky.png out.png --to fulldome --diff d.png", "cosmorama compare has it"),
    ("compare sky.png sky.png --width 30", "'cosmorama compare -h' lists the options"),
    ("compare sky.png sky.png sky.png", "two pictures are compared"),
    ("info sky.png --to fulldome", "cosmorama convert has it"),
    (
        "convert sky.png out.png --to fulldome --size 64 x 64",
        "a size is one word, without spaces, as in --size 4096x2048",
    ),
    (
        "convert sky.png out.mp4 --to fulldome --video-args -crf 20",
        "quotes hold an encoder's arguments together: --video-args '-crf 20'",
    ),
    ("convert sky.png out.png --to cube --rotate 90", "--to cube:rotate="),
    ("convert sky.png out.png --to omnimax --axis 120", "--to omnimax:axis=DEGREES"),
    ("convert sky.png out.png --to fulldome --output-size 2048", "write --size WxH"),
    ("convert sky.png out.png --names blender", "naming is a key of cube: --to cube:naming=PRESET"),
    ("convert sky.png out.png --to fulldome --fps 24", "pictures have no frame rate"),
    ("convert sky.png out.png --to fulldome --y", "write -y"),
    ("convert sky.png out.png -vf v360=e:flat", "is --from e --to flat"),
    ("compare sky.png sky.png --tolerance 0.1", "--min-psnr DB"),
    ("compare sky.png sky.png --amplify 3", "--gain FACTOR"),
    // SPECs.
    ("convert sky.png out.png --to cube:names=px", "did you mean 'naming'?"),
    ("convert sky.png out.png fulldome", "that is a projection: --to fulldome"),
    ("convert sky.png out.png --to domemastre", "did you mean 'domemaster'?"),
    ("convert sky.png out.png --to Fulldome", "did you mean 'fulldome'?"),
    ("convert sky.png out.png --to fulldome,tilt=20", "did you mean 'fulldome:tilt=20'?"),
    ("convert sky.png out.png --to fulldome:20", "write fulldome:tilt=20 or fulldome:fov=20"),
    ("convert sky.png out.png --to fulldome:tlit=20", "did you mean 'tilt'?"),
    ("convert sky.png out.png --to fisheye:fov=wide", "expected an angle in degrees, as in fov=90"),
    (
        "convert sky.png out.png --to flat:h_fov=90:v_fov=60",
        "by commas here, not by colons; write perspective:fov=90,vfov=60",
    ),
    ("convert sky.png out.png --to flat:h_fov=90", "did you mean 'fov'?"),
    ("convert sky.png out.png --to cube:half=upper", "front, right, back, left, up, down"),
    ("convert sky.png out.png --to tetrahedron", "v360=input=tetrahedron:output=e"),
    // Words.
    ("convert sky.png out.png --to fulldome --filter bicubic", "that is a kernel: --kernel catmull-rom"),
    ("convert sky.png out.png --to fulldome --filter mitchell", "that is a kernel: --kernel mitchell"),
    ("convert sky.png out.png --to fulldome --filter nearest", "did you mean 'point'?"),
    ("convert sky.png out.png --to fulldome --kernel ewa", "that is a filter: --filter ewa"),
    ("convert sky.png out.png --to fulldome --kernel lanczos", "did you mean 'lanczos3'?"),
    ("convert sky.png out.png --to fulldome --transfer sRGB", "did you mean 'srgb'?"),
    ("convert sky.png out.png --to fulldome --transfer 2.2", "did you mean 'gamma:2.2'?"),
    ("convert sky.png out.png --to fulldome --size 4kk", "as in 1966x1436, 4096 or 4k"),
    ("convert sky.png out.png --to fulldome --frames 1..10", "for frames 1 to 10 write 1-10"),
    // Verbs.
    ("convrt sky.png out.png --to fulldome", "did you mean 'convert'?"),
    ("remap sky.png out.png --to fulldome", "did you mean 'convert'?"),
    ("sky.png out.png --to fulldome", "cosmorama convert sky.png OUTPUT --to SPEC"),
    ("fulldome sky.png out.png", "cosmorama convert INPUT OUTPUT --to fulldome"),
    ("convert sky.png", "Example: cosmorama convert 'faces/{face}.png' omnimax.png"),
];

#[test]
fn each_mistake_is_answered_by_what_to_type() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    for (command, expected) in MISTAKES {
        let words: Vec<&str> = command.split(' ').collect();
        let message = bench.fail(2, &words);
        assert!(message.contains(expected), "$ cosmorama {command}\n'{expected}' is not in: {message}");
        assert!(!message.contains("--help'") && message.lines().count() < 30, "$ cosmorama {command}\n{message}");
    }
}

/// Every key of every projection, be it typed as an option, names the projections that take it.
#[test]
fn every_key_that_is_typed_as_an_option_names_its_projections() {
    let bench = Bench::new();
    let options = bench.succeed(&["convert", "--help"]);
    let mut told = 0;
    for kind in cosmorama_spec::SpecKind::all() {
        for key in kind.own_keys().iter().chain(kind.common_keys()) {
            let option = format!("--{}", key.name);
            // The output's yaw, pitch and roll are options, too; of one lens or face keys have its name.
            if options.contains(&format!("{option} ")) || key.name.contains('.') {
                continue;
            }
            let message = bench.fail(2, &["convert", "sky.png", "out.png", &option, "1"]);
            assert_says(&message, &[&format!("{} is a key of ", key.name), kind.name()]);
            // The value that was typed is advised wherever the projection takes it, and nowhere else.
            let advised = message.split("--to ").nth(1).and_then(|rest| rest.split([' ', ';', '\n']).next()).unwrap();
            let (typed, value) = advised.split_once(&format!("{}=", key.name)).unwrap();
            let is_refused = format!("{typed}{}=1", key.name).parse::<Spec>();
            let is_refused = matches!(is_refused, Err(SpecError::Value { key: of, .. }) if of == key.name);
            assert_eq!(value == "1", !is_refused, "{advised}");
            told += 1;
        }
    }
    assert!(told > 100, "{told}");
}

#[test]
fn a_wrong_spec_is_answered_by_the_keys_of_its_projection() {
    let bench = Bench::new();
    let message = bench.fail(2, &["convert", "sky.png", "out.png", "--to", "fulldome:tlit=20"]);
    let expected = "error: invalid value 'fulldome:tlit=20' for '--to <SPEC>': unknown key 'tlit' for fulldome; did you mean 'tilt'?

fulldome takes
  fov=DEGREES             across the circle (180)
  tilt=DEGREES            how far the dome leans to the front (0)
  and, as every SPEC, yaw, pitch, roll, flip, canvas, aspect, stereo, swap, eye
'cosmorama help spec' lists every projection with its keys
";
    assert_eq!(message, expected);
}

/// Values of options are text, but for files: what is none is named, with a remedy.
#[cfg(unix)]
#[test]
fn a_value_that_is_no_text_is_named() {
    use std::os::unix::ffi::OsStrExt as _;
    let bench = Bench::new();
    let name = std::ffi::OsStr::from_bytes(b"sky\xff.csv");
    let output =
        bench.command(&["convert", "a.png", "out.png", "--to", "fulldome", "--path"]).arg(name).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert_says(&crate::bench::text(&output.stderr), &["sky\u{fffd}.csv", "no text in UTF-8", "rename it"]);
}

/// What a file system allows, a name may hold: blanks, quotes, ends of lines, a dash in front.
#[cfg(unix)]
#[test]
fn names_may_hold_what_file_systems_allow() {
    let bench = Bench::new();
    bench.save("sky.png", &crate::bench::picture(1, 64, 32));
    let (to, size) = (["convert", "--from=equirect", "--to=fulldome"], "--size=16");
    bench.succeed(&[&to[..], &[size, "sky.png", "plain.png"]].concat());
    for stem in ["a b", "it's \"it\"", "two\nlines", "$HOME `x` ?;&", "-dash", "--to", "\u{1b}[31m"] {
        for frame in 1..=2 {
            std::fs::copy(bench.path("sky.png"), bench.path(&format!("{stem}_{frame}.png"))).unwrap();
        }
        let dome = format!("{stem} out.png");
        bench.succeed(&[&to[..], &[size, "--", &format!("{stem}_1.png"), &dome]].concat());
        let frames = [size, "--", &format!("{stem}_#.png"), &format!("{stem} in/dome_#.png")].map(str::to_owned);
        let frames: Vec<&str> = frames.iter().map(String::as_str).collect();
        let output = bench.run(&[&to[..], &["-vv"], &frames].concat());
        let told = crate::bench::text(&output.stderr);
        assert!(output.status.success() && !told.contains('\u{1b}') && !told.contains("two\nlines"), "{stem}: {told}");
        bench.succeed(&[&to[..], &["--resume"], &frames].concat());
        for made in [dome, format!("{stem} in/dome_1.png"), format!("{stem} in/dome_2.png")] {
            assert_eq!(bench.load(&made), bench.load("plain.png"), "{made:?}");
        }
    }
}
