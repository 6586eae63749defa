//! That sequences keep what `--memory` promises.

use crate::bench::{Bench, assert_says, picture, text};
use crate::sequence::films::{ffmpeg, has_ffmpeg};
use serde_json::Value;

#[test]
fn sequences_of_deep_pictures_take_no_more_memory_than_they_may() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(3, 256, 128));
    for (extension, depth) in [("png", "16"), ("exr", "half")] {
        let first = format!("sky_01.{extension}");
        let deep = ["--from", "equirect", "--to", "equirect", "--size", "2048x1024", "--depth", depth];
        bench.succeed(&[&["convert", "sky.png", &first], &deep[..]].concat());
        for frame in 2..=8 {
            std::fs::hard_link(bench.path(&first), bench.path(&format!("sky_{frame:02}.{extension}"))).unwrap();
        }
        let (input, output) = (format!("sky_##.{extension}"), format!("dome_##.{extension}"));
        let args = ["convert", &input, &output, "--from", "equirect", "--to", "fulldome", "--size", "1024", "-y"];
        // A frame takes 84 MiB, of OpenEXR 100: there is room for some that are read and written meanwhile, and in the end for plans.
        for memory in [120, 200] {
            let limits = ["--memory", &format!("{memory}M"), "--threads", "4", "--json"];
            let report: Value = serde_json::from_str(&bench.succeed(&[&args[..], &limits].concat())).unwrap();
            let peak = report["peak_memory_bytes"].as_u64().unwrap() >> 20;
            // What threads hold by themselves differs from run to run.
            assert!(peak < memory + memory / 8, "{depth}: {peak} of {memory} MiB");
        }
    }
}

/// What ffmpeg holds counts, too: to encode H.264, more than all else.
#[cfg(feature = "video")]
#[test]
fn codecs_of_films_take_their_part_of_the_memory() {
    if !has_ffmpeg() {
        return;
    }
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 256, 128));
    let run = |film: &str, more: &[&str]| {
        let args =
            ["convert", "sky.png", film, "--to", "fulldome", "--size", "1024", "--memory", "192M", "--threads", "2"];
        let done = bench.run(&[&args[..], more].concat());
        (done.status.code(), text(&done.stderr))
    };
    let (code, told) = run("film.mp4", &[]);
    assert_eq!(code, Some(1), "{told}");
    assert_says(&told, &["ffmpeg, which reads and makes films, needs about", "ProRes in .mov holds less"]);
    let (code, told) = run("fast.mkv", &["--video-codec", "h264", "--video-args", "-preset ultrafast"]);
    assert_eq!(code, Some(0), "{told}");
    // Arguments that do not decide on it change nothing.
    assert_eq!(run("film.mp4", &["--video-args", "-crf 20"]).0, Some(1));
    // Of two films in layers, each has a decoder, whose memory neither layer has.
    super::films::film(&bench, "film.mkv", 3);
    let args = ["convert", "film.mkv", "out_#.png", "--from", "equirect", "--to", "fulldome", "--size", "64"];
    let layers =
        ["--backdrop", "film.mkv", "--backdrop-from", "equirect", "--memory", "160M", "--threads", "2", "--json"];
    let report: Value = serde_json::from_str(&bench.succeed(&[&args[..], &layers].concat())).unwrap();
    assert!(report["codec_memory_bytes"].as_u64().unwrap() > 72 << 20, "{report}");
    // Of a film that is verified, its decoder.
    let source = "testsrc2=size=2048x1024:rate=25,trim=end_frame=2";
    ffmpeg(&bench, &["-f", "lavfi", "-i", source, "-c:v", "libx264", "-preset", "ultrafast", "large.mp4"]);
    let told = bench.fail(1, &["verify", "large.mp4", "--memory", "90M"]);
    assert_says(&told, &["of memory with ffmpeg's codecs, which hold about"]);
    // Less memory does not permit more.
    for (memory, only) in [("40M", "only 40.0 MiB"), ("4M", "only 4.0 MiB")] {
        let told = bench.fail(1, &[&args[..], &["-y", "--memory", memory]].concat());
        assert_says(&told, &["ffmpeg", only]);
    }
}

/// The estimate that is told, and the most memory that was held, in MiB.
fn estimate_and_peak(bench: &Bench, args: &[&str]) -> [f64; 2] {
    let threads: &[&str] = if args.contains(&"--threads") { &[] } else { &["--threads", "2"] };
    let report: Value = serde_json::from_str(&bench.succeed(&[args, threads, &["-y", "--json"]].concat())).unwrap();
    ["estimated_memory_bytes", "peak_memory_bytes"].map(|key| report[key].as_f64().unwrap() / f64::from(1 << 20))
}

#[test]
fn estimates_are_no_less_than_what_is_held_and_little_more() {
    let bench = Bench::new();
    bench.faces("face_", 1024);
    for frame in 1..=5 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 2048, 1024));
    }
    let sky = ["--from", "equirect"];
    bench.succeed(
        &[&["convert", "sky_1.png", "sky.exr", "--to", "equirect", "--size", "2048", "--depth", "float"][..], &sky]
            .concat(),
    );
    bench.save("v.png", &picture(1, 16, 8));
    let view = |k: usize| {
        let (yaw, pitch) = (9 * (k % 40), 4 * (k / 40));
        format!("[[view]]\nimage = \"v.png\"\nspec = \"perspective:fov=9,yaw={yaw},pitch={pitch}\"\npriority = {k}\n")
    };
    std::fs::write(bench.path("views.toml"), (0..800).map(view).collect::<String>()).unwrap();
    let dome = |to: &'static str, size: &'static str| ["--to", to, "--size", size];
    bench.save("narrow.png", &picture(1, 2000, 2000));
    let cases: Vec<(&str, Vec<&str>)> = vec![
        ("upright dome", [&["convert", "face_{face}.png", "o.png"][..], &dome("fulldome", "4096")].concat()),
        ("tilted dome", [&["convert", "face_{face}.png", "o.png"][..], &dome("fulldome:tilt=20", "4096")].concat()),
        ("floats", [&["convert", "sky.exr", "o_{face}.exr"][..], &dome("cube", "1024"), &sky].concat()),
        (
            "16 bits",
            [&["convert", "sky_1.png", "o.png", "--depth", "16"][..], &dome("fulldome", "2048"), &sky].concat(),
        ),
        (
            "16 bits with alpha",
            [
                &["convert", "face_{face}.png", "o.png", "--depth", "16", "--background", "transparent"][..],
                &dome("equirect", "3072"),
            ]
            .concat(),
        ),
        (
            "many views",
            [&["convert", "views.toml", "o.png", "--missing", "black"][..], &dome("equirect", "256")].concat(),
        ),
        (
            "longer chain",
            [
                &["light", "specular", "sky.exr", "o_{level}_{face}.exr", "--levels", "5"][..],
                &dome("cube", "256"),
                &sky,
            ]
            .concat(),
        ),
        ("one sheet", [&["convert", "sky_1.png", "o.png"][..], &dome("cube:layout=3x2", "1024"), &sky].concat()),
        ("sequence", [&["convert", "sky_#.png", "o_#.png"][..], &dome("fulldome", "2048"), &sky].concat()),
        (
            "halves",
            [&["convert", "sky_#.png", "o_#.exr", "--depth", "half"][..], &dome("fulldome", "1024"), &sky].concat(),
        ),
        (
            "pyramid",
            [&["convert", "sky_1.png", "o.png", "--filter", "ewa-pyramid"][..], &dome("fulldome", "512"), &sky]
                .concat(),
        ),
        (
            "light",
            [
                &["light", "specular", "sky.exr", "o_{level}_{face}.exr", "--levels", "3"][..],
                &dome("cube", "128"),
                &sky,
            ]
            .concat(),
        ),
        // Texels crowd around a pole of the panorama, under pixels that are large.
        ("few pixels", [&["convert", "sky.exr", "o.exr"][..], &dome("mirror-ball:pitch=20", "16"), &sky].concat()),
        // A copy of the light is looked at for the lens's circle.
        (
            "fisheye",
            [&["convert", "narrow.png", "o.png", "--from", "fisheye:fov=200"][..], &dome("fisheye:fov=160", "256")]
                .concat(),
        ),
        ("formula", [&["convert", "builtin:checker", "o.png"][..], &dome("fulldome", "3072")].concat()),
        (
            "formula in frames",
            [
                &["convert", "builtin:checker", "o_#.png", "--frames", "1-3", "--yaw", "0..9"][..],
                &dome("fulldome", "2048"),
            ]
            .concat(),
        ),
        // Encoders of OpenEXR hold a copy of the samples; as many frames as threads are written at once.
        (
            "halves, 8 threads",
            [
                &["convert", "sky_#.png", "o_#.exr", "--depth", "half", "--threads", "8"][..],
                &dome("fulldome", "1024"),
                &sky,
            ]
            .concat(),
        ),
        ("places", [&["convert", "sky_1.png", "o.exr", "--st-map"][..], &dome("fulldome", "512")].concat()),
        (
            "places, as said",
            [&["convert", "sky_1.png", "o.exr", "--st-map"][..], &dome("fulldome", "512"), &sky].concat(),
        ),
        ("diffuse", [&["light", "diffuse", "sky_1.png", "o.exr"][..], &["--size", "256"], &sky].concat()),
        ("directions", [&["convert", "builtin:direction-map", "o.exr"][..], &dome("equirect", "3072")].concat()),
        ("things", ["shade", "sky.exr", "ball.png", "--object", "sphere", "--size", "1024"].to_vec()),
    ];
    let figures: Vec<String> = cases
        .iter()
        .map(|(name, args)| {
            let [told, held] = estimate_and_peak(&bench, args);
            let is_right = held <= told && told <= 1.5 * held;
            format!(
                "{}{name}: {told:.0} MiB told, {held:.0} held, {:.2} times",
                if is_right { "" } else { "WRONG " },
                told / held
            )
        })
        .collect();
    assert!(figures.iter().all(|figure| !figure.starts_with("WRONG")), "{}", figures.join("\n"));
    // All texels lie under a few pixels. Each thread may hold them all, but seldom do two at once.
    let narrow = ["convert", "narrow.png", "o.png", "--from", "perspective:fov=4", "--missing", "black"];
    let [told, held] = estimate_and_peak(&bench, &[&narrow[..], &dome("equirect", "256")].concat());
    assert!(held <= told && told <= 4.0 * held, "narrow view: {told:.0} MiB told, {held:.0} held");
}

/// A header declares a huge canvas, of which the file holds next to nothing: that costs neither memory nor minutes.
#[test]
fn canvases_cost_what_files_hold_of_them() {
    let bench = Bench::new();
    bench.save("part.png", &picture(1, 16, 16));
    let from = "equirect:canvas=20000x10000+9000+3000";
    let convert = ["convert", "part.png", "o.png", "--from", from, "--to", "fulldome", "--size", "64"];
    assert_says(&bench.fail(1, &convert), &["does not cover", "look where no view does"]);
    let [_, held] = estimate_and_peak(&bench, &[&convert[..], &["--missing", "black"]].concat());
    assert!(held < 64.0, "{held} MiB");
    let told = bench.succeed(&["explain", "part.png", "--from", from, "--to", "fulldome", "--size", "64"]);
    assert!(told.contains("part.png  16x16"), "{told}");
}

/// Memory of a picture and of a sequence that `explain` tells, of 8 bits and of halves, in MiB.
fn explained(bench: &Bench, args: &[&str]) -> [[f64; 2]; 2] {
    let told = bench.succeed(&[&["explain"], args, &["--threads", "2", "--json"]].concat());
    let report: Value = serde_json::from_str(&told).unwrap();
    [0, 1].map(|files| {
        ["picture_memory_bytes", "sequence_memory_bytes"]
            .map(|key| report[0]["cost"][files][key].as_f64().unwrap() / f64::from(1 << 20))
    })
}

/// Asserts that `explain` tells of a picture and of a sequence what their conversions tell, in 8 bits and in halves.
fn assert_explained(bench: &Bench, picture: Option<&str>, sequence: &str, args: &[&str]) {
    let [bytes, halves] = explained(bench, &[&[picture.unwrap_or(sequence)], args].concat());
    for ([alone, many], (extension, depth)) in [(bytes, ("png", "8")), (halves, ("exr", "half"))] {
        let converted = |input: &str, output: &str| {
            let output = format!("{output}.{extension}");
            let convert = ["convert", input, &output, "--depth", depth, "--missing", "black"];
            let [told, _] = estimate_and_peak(bench, &[&convert[..], args].concat());
            told
        };
        let one = picture.map(|picture| (alone, converted(picture, "o")));
        for (explained, told) in one.into_iter().chain([(many, converted(sequence, "o_##"))]) {
            let is_right = (0.97..1.1).contains(&(explained / told));
            assert!(is_right, "{sequence}, {args:?}, {extension}: {explained} MiB explained, {told} told");
        }
    }
}

#[test]
fn memory_is_explained_as_conversions_tell_it() {
    let bench = Bench::new();
    for frame in 1..=9 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 1024, 512));
    }
    let sky = ["--from", "equirect", "--size", "512"];
    assert_explained(&bench, Some("sky_1.png"), "sky_#.png", &[&sky[..], &["--to", "fulldome:tilt=20"]].concat());
    let deep = ["convert", "sky_#.png", "deep_#.png", "--depth", "16", "--from", "equirect", "--to", "equirect"];
    bench.succeed(&deep);
    assert_explained(&bench, Some("deep_1.png"), "deep_#.png", &[&sky[..], &["--to", "fulldome:tilt=20"]].concat());
    // What a map's picture shows beside the lens is nowhere.
    bench.succeed(&[
        "convert",
        "sky_1.png",
        "map.exr",
        "--from",
        "equirect",
        "--to",
        "fulldome",
        "--size",
        "512",
        "--st-map",
    ]);
    let map = ["--from", "equirect", "--to", "st-map:file=map.exr"];
    assert_explained(&bench, Some("sky_1.png"), "sky_#.png", &map);
    if has_ffmpeg() {
        ffmpeg(&bench, &["-i", "sky_%d.png", "-pix_fmt", "yuv420p", "-c:v", "libx264", "film.mp4"]);
        assert_explained(&bench, None, "film.mp4", &[&sky[..], &["--to", "fulldome:tilt=20"]].concat());
    }
}

#[test]
fn explanations_hold_memory_and_frames_against_what_is_asked() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    let dome = ["sky.png", "--from", "equirect", "--to", "fulldome:tilt=20", "--size", "2048", "--memory", "100M"];
    let text = bench.succeed(&[&["explain"], &dome[..], &["--frames", "1-1200"]].concat());
    let [bytes, halves] = ["PNG of 8 bits", "OpenEXR halves"]
        .map(|name| text.lines().find(|line| line.contains(name)).unwrap_or_else(|| panic!("no {name}: {text}")));
    assert!(
        !bytes.contains("refused") && halves.matches("(refused: more than --memory allows)").count() == 2,
        "{text}"
    );
    assert_eq!(text.matches("1200 frames: about").count(), 2, "{text}");
    let convert = |output, depth| [&["convert", dome[0], output, "--depth", depth], &dome[1..]].concat();
    bench.succeed(&convert("o.png", "8"));
    assert_says(&bench.fail(1, &convert("o.exr", "half")), &["a frame needs about", "--memory"]);
    let json: Value = serde_json::from_str(&bench.succeed(&[&["explain"], &dome[..], &["--json"]].concat())).unwrap();
    let cost = &json[0]["cost"];
    assert_eq!(
        (&cost[0]["picture_memory_is_allowed"], &cost[1]["picture_memory_is_allowed"]),
        (&true.into(), &false.into())
    );
    assert_eq!(cost[1]["sequence_memory_is_allowed"], false);
    assert!(cost[1]["sequence_memory_bytes"].as_u64().unwrap() > 100 << 20, "what is needed, not what is allowed");
    assert_eq!(cost[0]["frames"], 50_000);
    let hours = |key: &str| cost[0][key].as_f64().unwrap();
    assert!((hours("core_hours") * 3600.0 / hours("cpu_seconds_a_frame") - 50_000.0).abs() < 0.1);
}
