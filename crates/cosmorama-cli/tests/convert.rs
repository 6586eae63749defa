//! What a conversion promises.

mod bench;

use bench::{Bench, flat, floats, picture, word};
use cosmorama::raster::{Channels, Depth, EncodedImage, Samples, Transfer};
use cosmorama::sphere::{CubeFace, Direction};
use cosmorama::world::{CubeFaceFrame, Frame, PixelPoint};
use serde_json::Value;

fn eight_bits(image: &EncodedImage) -> &[u8] {
    match image.samples() {
        Samples::U8(samples) => samples,
        other => panic!("8 bits were expected, not {other:?}"),
    }
}

/// Cube faces whose colour is their direction, from −1…1 to 0…1.
fn direction_faces(bench: &Bench, size: usize) {
    let view = Frame::CubeFace(CubeFaceFrame).view(size, size).unwrap();
    for face in CubeFace::ALL {
        let image = floats(size, size, |i, j| {
            let direction = face.orientation().to_world(view.direction(PixelPoint::centre(i, j)).unwrap());
            direction.vector().to_array().map(|c| (c / 2.0 + 0.5) as f32)
        });
        bench.save(&format!("world_{}.exr", word(face)), &image);
    }
}

/// What the middle of an image sees of the world of directions.
fn middle(bench: &Bench, name: &str) -> Direction {
    let image = bench.load(name).to_light(&Transfer::Linear);
    let pixel = image.get(image.width() / 2, image.height() / 2).0;
    Direction::new([0, 1, 2].map(|c| f64::from(pixel[c]) * 2.0 - 1.0).into()).unwrap()
}

#[test]
fn the_output_looks_where_it_is_turned() {
    let bench = Bench::new();
    direction_faces(&bench, 32);
    let looks = |args: &[&str], expected: Direction| {
        let mut all = vec!["convert", "world_{face}.exr", "view.exr", "-y", "--size", "33x33"];
        all.extend(args);
        bench.succeed(&all);
        let seen = middle(&bench, "view.exr");
        assert!(seen.angle_to(expected).degrees() < 0.05, "{args:?} sees {seen:?}, not {expected:?}");
    };
    let camera = "perspective:fov=20";
    looks(&["--to", camera], Direction::FRONT);
    looks(&["--to", camera, "--yaw", "90"], Direction::RIGHT);
    looks(&["--to", camera, "--yaw", "-90"], Direction::LEFT);
    looks(&["--to", camera, "--pitch", "90"], Direction::UP);
    looks(&["--to", camera, "--yaw", "180", "--roll", "77"], Direction::BACK);
    looks(&["--to", "perspective:fov=20,pitch=-90"], Direction::DOWN);
    looks(&["--to", "fulldome"], Direction::UP);
    looks(&["--to", "fulldome:tilt=90"], Direction::FRONT);
    looks(&["--to", "fisheye", "--yaw", "90"], Direction::RIGHT);
    looks(&["--to", "omnimax:framing=circle,axis=90"], Direction::UP);
    looks(&["--to", "equirect", "--yaw", "180"], Direction::BACK);
    // The input may be turned, too: what was ahead of it is then to the right.
    looks(&["--from", "cube:yaw=90", "--to", camera, "--yaw", "90"], Direction::FRONT);
}

#[test]
fn there_and_back() {
    let bench = Bench::new();
    direction_faces(&bench, 64);
    bench.succeed(&["convert", "world_{face}.exr", "sky.exr", "--to", "equirect"]);
    bench.succeed(&["convert", "sky.exr", "back_{face}.exr", "--size", "64"]);
    for face in CubeFace::ALL {
        let first = format!("world_{}.exr", word(face));
        let again = format!("back_{}.exr", word(face));
        bench.succeed(&["compare", &again, &first, "--min-psnr", "60", "--max-shift", "0.03"]);
    }
    bench.succeed(&["convert", "sky.exr", "dome.exr", "--to", "fulldome"]);
    bench.succeed(&[
        "convert",
        "dome.exr",
        "up.exr",
        "--from",
        "fulldome",
        "--to",
        "perspective",
        "--size",
        "64x64",
        "--pitch",
        "90",
    ]);
    bench.succeed(&["compare", "up.exr", "world_top.exr", "--min-psnr", "55"]);
}

#[test]
fn panoramas_in_openexr_are_environment_maps() {
    let bench = Bench::new();
    direction_faces(&bench, 32);
    bench.succeed(&["convert", "world_{face}.exr", "sky.exr", "--to", "equirect", "--size", "64"]);
    let info: Value = serde_json::from_str(&bench.succeed(&["info", "sky.exr", "--json"])).unwrap();
    assert_eq!((&info["envmap"], &info["depth"]), (&"latlong".into(), &"float".into()));
    assert!(info["projection"].as_str().unwrap().starts_with("equirect, samples on the edges"), "{info}");
    let args = ["convert", "world_{face}.exr", "centred.exr", "--to", "equirect:samples=centres", "--size", "64"];
    bench.succeed(&args);
    let info: Value = serde_json::from_str(&bench.succeed(&["info", "centred.exr", "--json"])).unwrap();
    assert_eq!(info["envmap"], Value::Null);
    // On the edges, the first column and the last show the same, and the first row is the pole.
    let sky = bench.load("sky.exr").to_light(&Transfer::Linear);
    for c in 0..3 {
        assert!((sky.get(0, 16).0[c] - sky.get(63, 16).0[c]).abs() < 1e-3);
        assert!((sky.get(5, 0).0[c] - sky.get(40, 0).0[c]).abs() < 5e-3);
    }
}

#[test]
fn the_same_bytes_for_any_number_of_threads() {
    let bench = Bench::new();
    bench.faces("face_", 128);
    for filter in ["ewa", "bilinear", "reference:samples=2"] {
        let bytes = |threads: &str| {
            let args = ["convert", "face_{face}.png", "out.png", "--to", "omnimax", "--size", "200", "-y"];
            bench.succeed(&[&args[..], &["--filter", filter, "--threads", threads]].concat());
            bench.bytes("out.png")
        };
        let one = bytes("1");
        assert!(one == bytes("2") && one == bytes("7"), "{filter}");
    }
}

#[test]
fn a_sequence_is_the_same_as_its_frames() {
    let bench = Bench::new();
    for frame in 1..=3 {
        for face in CubeFace::ALL {
            bench.save(&format!("{face}/{face}_{frame:04}.png"), &picture(frame + face as usize, 48, 48));
        }
    }
    let args = ["convert", "{face}/{face}_####.png", "dome_%03d.png", "--to", "fulldome", "--size", "64"];
    let report: Value = serde_json::from_str(&bench.succeed(&[&args[..], &["--json"]].concat())).unwrap();
    assert_eq!((&report["frames"], report["inputs"].as_array().unwrap().len()), (&3.into(), 15));
    for frame in 1..=3 {
        let input = format!("{{face}}/{{face}}_{frame:04}.png");
        bench.succeed(&["convert", &input, "one.png", "--to", "fulldome", "--size", "64", "-y"]);
        assert!(bench.bytes("one.png") == bench.bytes(&format!("dome_{frame:03}.png")), "frame {frame}");
    }
}

#[test]
fn a_plan_that_does_not_fit_is_done_without() {
    let bench = Bench::new();
    for frame in 1..=2 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 128, 64));
    }
    let bytes = |memory: &str| {
        let args =
            ["convert", "sky_#.png", "dome_#.png", "--to", "fulldome", "--size", "256", "-y", "--memory", memory];
        bench.succeed(&args);
        bench.bytes("dome_2.png")
    };
    assert!(bytes("3M") == bytes("1G"));
}

#[test]
fn resume_keeps_what_is_complete_and_makes_the_rest() {
    let bench = Bench::new();
    for frame in 1..=4 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32));
    }
    let args = ["convert", "sky_#.png", "out_#.png", "--to", "fisheye", "--size", "32", "--json"];
    bench.succeed(&args);
    let made: Vec<Vec<u8>> = (1..=4).map(|frame| bench.bytes(&format!("out_{frame}.png"))).collect();
    // Complete but different, truncated, of another size: only the first may stay.
    bench.save("out_1.png", &flat(32, 32, &[1, 2, 3]));
    std::fs::write(bench.path("out_2.png"), &made[1][..made[1].len() / 2]).unwrap();
    bench.save("out_3.png", &flat(16, 16, &[1, 2, 3]));
    std::fs::remove_file(bench.path("out_4.png")).unwrap();
    let report: Value = serde_json::from_str(&bench.succeed(&[&args[..], &["--resume"]].concat())).unwrap();
    assert_eq!((&report["frames"], &report["skipped"]), (&3.into(), &1.into()));
    assert_eq!(bench.load("out_1.png"), flat(32, 32, &[1, 2, 3]));
    for frame in 2..=4 {
        assert!(bench.bytes(&format!("out_{frame}.png")) == made[frame - 1], "frame {frame}");
    }
    let report: Value = serde_json::from_str(&bench.succeed(&[&args[..], &["--resume"]].concat())).unwrap();
    assert_eq!((&report["frames"], &report["skipped"]), (&0.into(), &4.into()));
    bench.succeed(&[&args[..], &["-y"]].concat());
    assert!(bench.bytes("out_1.png") == made[0]);
}

#[test]
fn what_comes_in_goes_out() {
    let bench = Bench::new();
    let convert = |input: &str, output: &str, extra: &[&str]| {
        let args =
            ["convert", input, output, "--from", "equirect", "--to", "perspective:fov=60", "--size", "8x6", "-y"];
        bench.succeed(&[&args[..], extra].concat());
        bench.load(output)
    };
    // One colour stays that colour, whatever the transfer function.
    for transfer in ["auto", "srgb", "linear", "bt1886", "pq", "hlg", "gamma:2.2"] {
        bench.save("sky.png", &flat(64, 32, &[200, 100, 50]));
        let out = convert("sky.png", "out.png", &["--transfer", transfer]);
        assert!(eight_bits(&out).chunks(3).all(|pixel| pixel == [200, 100, 50]), "{transfer}: {out:?}");
    }
    // Grey stays grey, alpha stays, and its colour.
    for pixel in [&[77u8][..], &[90, 128], &[10, 20, 30, 64]] {
        bench.save("sky.png", &flat(64, 32, pixel));
        let out = convert("sky.png", "out.png", &[]);
        assert_eq!(out.channels().count(), pixel.len());
        assert!(eight_bits(&out).chunks(pixel.len()).all(|found| found == pixel), "{out:?}");
    }
    // The depth stays where the format can hold it, and follows where it must.
    let sky = EncodedImage::new(64, 32, Channels::Rgb, Depth::Sixteen, Samples::U16(vec![40000; 64 * 32 * 3])).unwrap();
    bench.save("deep.png", &sky);
    assert_eq!(convert("deep.png", "out.png", &[]).depth(), Depth::Sixteen);
    assert_eq!(convert("deep.png", "out.jpg", &[]).depth(), Depth::Eight);
    assert_eq!(convert("deep.png", "out.exr", &["--depth", "half"]).depth(), Depth::Half);
    // Float files are linear: sRGB 40000 is this much light, and comes back as it went.
    let light = convert("deep.png", "sky.exr", &[]).to_light(&Transfer::Linear);
    assert!((f64::from(light.get(3, 3).0[0]) - Transfer::Srgb.decode(40000.0 / 65535.0, 0)).abs() < 1e-4);
    bench.save("float.exr", &floats(64, 32, |_, _| [light.get(3, 3).0[0]; 3]));
    let Samples::U16(back) = convert("float.exr", "out.png", &["--depth", "16"]).into_samples() else {
        panic!("16 bits")
    };
    assert!(back.iter().all(|code| code.abs_diff(40000) <= 1), "{}", back[0]);
}

#[test]
fn outside_the_lens() {
    let bench = Bench::new();
    bench.save("sky.png", &flat(64, 32, &[200, 100, 50]));
    bench.save("veil.png", &flat(64, 32, &[200, 100, 50, 255]));
    let corner = |input: &str, extra: &[&str]| {
        let args = ["convert", input, "out.png", "--to", "fulldome", "--size", "32", "-y"];
        bench.succeed(&[&args[..], extra].concat());
        let out = bench.load("out.png");
        let count = out.channels().count();
        let samples = eight_bits(&out).to_vec();
        let at = |i: usize, j: usize| samples[(j * 32 + i) * count..][..count].to_vec();
        assert_eq!(at(16, 16)[..3], [200, 100, 50]);
        at(0, 0)
    };
    assert_eq!(corner("sky.png", &[]), [0, 0, 0]);
    assert_eq!(corner("veil.png", &[]), [0, 0, 0, 0]);
    assert_eq!(corner("sky.png", &["--background", "#ff8000"]), [255, 128, 0]);
    assert_eq!(corner("veil.png", &["--background", "#ff8000"]), [255, 128, 0, 255]);
    assert_eq!(corner("sky.png", &["--background", "transparent"]), [0, 0, 0, 0]);
}

#[test]
fn missing_directions_may_be_filled() {
    let bench = Bench::new();
    bench.save("ahead.png", &flat(32, 32, &[200, 100, 50]));
    let at_the_side = |missing: &str| {
        let args = [
            "convert",
            "ahead.png",
            "out.png",
            "--from",
            "perspective:fov=90",
            "--to",
            "fisheye",
            "--size",
            "64",
            "-y",
        ];
        bench.succeed(&[&args[..], &["--missing", missing]].concat());
        let out = bench.load("out.png");
        let count = out.channels().count();
        let row = &eight_bits(&out)[32 * 64 * count..][..64 * count];
        assert_eq!(row[32 * count..][..3], [200, 100, 50]);
        row[4 * count..][..count].to_vec()
    };
    assert_eq!(at_the_side("#00ff00"), [0, 255, 0]);
    assert_eq!(at_the_side("transparent"), [0, 0, 0, 0]);
    assert_eq!(at_the_side("0.5,0.5,0.5"), [188, 188, 188]);
}

#[test]
fn what_is_not_needed_does_not_leak_in() {
    let bench = Bench::new();
    bench.faces("face_", 64);
    bench.succeed(&["convert", "face_{face}.png", "clean.png", "--to", "omnimax"]);
    // The far halves of the sides and of the top, the back and the bottom may hold anything.
    let spoil = |face: CubeFace, needed: &dyn Fn(usize, usize) -> bool| {
        let name = format!("face_{}.png", word(face));
        let image = bench.load(&name);
        let mut samples = eight_bits(&image).to_vec();
        for (index, sample) in samples.iter_mut().enumerate() {
            if !needed(index / 3 % 64, index / 3 / 64) {
                *sample = 255 - *sample;
            }
        }
        let spoilt = EncodedImage::new(64, 64, Channels::Rgb, Depth::Eight, Samples::U8(samples)).unwrap();
        bench.save(&name, &spoilt);
    };
    spoil(CubeFace::Right, &|i, _| i < 36);
    spoil(CubeFace::Left, &|i, _| i >= 28);
    spoil(CubeFace::Up, &|_, j| j >= 28);
    spoil(CubeFace::Back, &|_, _| false);
    bench.succeed(&["convert", "face_{face}.png", "spoilt.png", "--to", "omnimax"]);
    assert!(bench.bytes("clean.png") == bench.bytes("spoilt.png"));
}

#[test]
fn cropped_faces_are_as_good_as_whole_ones() {
    let bench = Bench::new();
    bench.faces("face_", 64);
    bench.succeed(&["convert", "face_{face}.png", "whole.png", "--to", "omnimax"]);
    let image = bench.load("face_left.png");
    let rows = eight_bits(&image).chunks(64 * 3).flat_map(|row| row[24 * 3..].to_vec()).collect();
    let crop = EncodedImage::new(40, 64, Channels::Rgb, Depth::Eight, Samples::U8(rows)).unwrap();
    bench.save("face_left.png", &crop);
    let from = ["--from", "cube:canvas.left=64x64+24+0"];
    bench.succeed(&[&["convert", "face_{face}.png", "cropped.png", "--to", "omnimax"][..], &from].concat());
    assert!(bench.bytes("whole.png") == bench.bytes("cropped.png"));
}

#[test]
fn faces_of_different_sizes_and_shapes() {
    let bench = Bench::new();
    for (face, size) in CubeFace::ALL.into_iter().zip([96, 64, 16, 64, 48, 16]) {
        bench.save(&format!("face_{face}.png"), &flat(size, size, &[200, 100, 50]));
        bench.save(&format!("wide_{face}.png"), &flat(64, 60, &[200, 100, 50]));
    }
    for input in ["face_{face}.png", "wide_{face}.png"] {
        bench.succeed(&["convert", input, "out.png", "--to", "fisheye:fov=360", "--size", "64", "-y"]);
        let out = bench.load("out.png");
        let inside = |index: usize| {
            let (x, y) = ((index % 64) as f64 - 31.5, (index / 64) as f64 - 31.5);
            x.hypot(y) < 30.0
        };
        let pixels = eight_bits(&out).chunks(3).enumerate().filter(|(index, _)| inside(*index));
        assert!(pixels.into_iter().all(|(_, pixel)| pixel == [200, 100, 50]), "{input}");
    }
}

#[test]
fn isolated_nans_are_closed_from_around() {
    let bench = Bench::new();
    let hole = |i: usize, j: usize| if (i, j) == (32, 16) { [f32::NAN; 3] } else { [0.25, 0.5, 2.0] };
    bench.save("sky.exr", &floats(64, 32, hole));
    bench.succeed(&[
        "convert",
        "sky.exr",
        "out.exr",
        "--to",
        "perspective:fov=60",
        "--size",
        "24x24",
        "--from",
        "equirect",
    ]);
    let out = bench.load("out.exr").to_light(&Transfer::Linear);
    let fine = |pixel: &cosmorama::raster::Rgba| {
        pixel.0.iter().zip([0.25, 0.5, 2.0]).all(|(found, expected)| (found - expected).abs() < 1e-5)
    };
    assert!(out.pixels().iter().all(fine));
}

#[test]
fn cube_faces_are_written_as_others_name_them() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 128, 64));
    for folder in ["f", "t"] {
        std::fs::create_dir(bench.path(folder)).unwrap();
    }
    bench.succeed(&["convert", "sky.png", "%c/c_%c.png", "--to", "cube:naming=bourke,faces=front,up", "--size", "16"]);
    assert_eq!(bench.files().len(), 3);
    assert!(bench.path("f/c_f.png").exists() && bench.path("t/c_t.png").exists());
}

#[test]
fn the_report_is_all_there() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    let out = bench.succeed(&["convert", "sky.png", "out.png", "--to", "fulldome", "--size", "32", "--json"]);
    let report: Value = serde_json::from_str(&out).unwrap();
    assert_eq!((&report["inputs"][0], &report["outputs"][0]), (&"sky.png".into(), &"out.png".into()));
    assert_eq!(report["frames"], 1);
    for stage in ["decode", "plan", "filter", "encode"] {
        assert!(report["cpu_seconds"][stage].as_f64().unwrap() >= 0.0, "{stage}");
    }
    assert!(report["wall_seconds"].as_f64().unwrap() > 0.0);
    assert!(report["peak_memory_bytes"].as_u64().unwrap() > 1 << 20);
    assert!(report["warnings"][0].as_str().unwrap().contains("--from equirect"));
}

#[test]
fn progress_for_machines() {
    let bench = Bench::new();
    for frame in 1..=4 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32));
    }
    let progress = |style: &str| {
        let args = ["convert", "sky_#.png", "out_#.png", "--to", "fisheye", "--size", "16", "-y", "--from", "equirect"];
        bench::text(&bench.run(&[&args[..], &["--progress", style, "--json"]].concat()).stderr)
    };
    let openjd = "openjd_progress: 25.00\nopenjd_progress: 50.00\nopenjd_progress: 75.00\nopenjd_progress: 100.00\n";
    assert_eq!(progress("openjd"), openjd);
    let lines = progress("json");
    let last: Value = serde_json::from_str(lines.lines().last().unwrap()).unwrap();
    assert_eq!((&last["done"], &last["total"], &last["frame"]), (&4.into(), &4.into(), &4.into()));
    assert_eq!(progress("none"), "");
    assert!(progress("auto").contains("frame 2: 2 of 4 done"));
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_nothing_behind() {
    for (signal, code) in [("INT", 130), ("TERM", 143)] {
        let bench = Bench::new();
        bench.save("sky.png", &picture(1, 256, 128));
        let before = bench.files();
        let args =
            ["convert", "sky.png", "out.png", "--to", "fulldome", "--size", "3000", "--filter", "reference:samples=8"];
        let mut child = bench.command(&args).stderr(std::process::Stdio::null()).spawn().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(700));
        let kill = std::process::Command::new("kill").args([format!("-{signal}"), child.id().to_string()]).status();
        assert!(kill.unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(code));
        assert_eq!(bench.files(), before);
    }
}
