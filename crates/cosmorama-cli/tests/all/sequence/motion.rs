//! Cameras that move: paths and turns against stills, and what is wrong with a path.

use crate::bench::{Bench, assert_says, picture};
use cosmorama::sphere::{Angle, Direction, Orientation};
use cosmorama_io::{Limits, read};

const PATH: &str = "frame,yaw,pitch,roll\n1,20,5,-10\n2,25,6,0\n4,-30,12,30\n";

fn bench_with(path: &str) -> Bench {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 256, 128));
    std::fs::write(bench.path("path.csv"), path).unwrap();
    bench
}

/// Runs a conversion of the sky with a path.
fn moved(bench: &Bench, to: &[&str], output: &str) {
    bench.succeed(&[&["convert", "sky.png", output, "--path", "path.csv"], to].concat());
}

#[test]
fn each_frame_of_a_path_is_the_still_of_its_pose() {
    let bench = bench_with(PATH);
    let targets: [&[&str]; 5] = [
        &["--to", "perspective:fov=60,yaw=10", "--size", "64"],
        &["--to", "fulldome:tilt=20", "--size", "64"],
        &["--to", "omnimax:axis=11", "--size", "96"],
        &["--to", "equirect", "--size", "96"],
        &["--to", "cube:layout=3x2", "--size", "32"],
    ];
    for to in targets {
        moved(&bench, &[to, &["-y"]].concat(), "f_##.png");
        for (frame, [yaw, pitch, roll]) in [(1, ["20", "5", "-10"]), (2, ["25", "6", "0"]), (4, ["-30", "12", "30"])] {
            let pose = ["--yaw", yaw, "--pitch", pitch, "--roll", roll];
            bench.succeed(&[&["convert", "sky.png", "still.png", "-y"], to, &pose[..]].concat());
            assert!(bench.load("still.png") == bench.load(&format!("f_{frame:02}.png")), "{to:?}, frame {frame}");
        }
        assert!(bench.path("f_03.png").is_file(), "the path has a frame 3");
    }
}

#[test]
fn a_turn_goes_round_and_ends_where_it_began() {
    let bench = Bench::new();
    bench.succeed(&[
        "convert",
        "builtin:directions",
        "world.exr",
        "--to",
        "equirect",
        "--size",
        "1024",
        "--depth",
        "float",
    ]);
    let args = ["convert", "world.exr", "f_###.exr", "--to", "perspective:fov=60", "--size", "32x24", "--pitch", "10"];
    bench.succeed(&[&args[..], &["--yaw", "0..360", "--frames", "0-360"]].concat());
    assert!(bench.bytes("f_000.exr") == bench.bytes("f_360.exr"));
    // A pixel at the centre is 2·tan 30°/32 wide.
    let pixel = 2.0 * 30f64.to_radians().tan() / 32.0;
    for frame in 0..360 {
        let image = read(bench.path(&format!("f_{frame:03}.exr")), &Limits::NONE).unwrap().to_light();
        let camera = Orientation::from_yaw_pitch_roll(
            Angle::from_degrees(f64::from(frame)),
            Angle::from_degrees(10.0),
            Angle::ZERO,
        );
        for (at, found) in image.pixels().iter().enumerate() {
            let (x, y) = ((at % 32) as f64 - 15.5, 11.5 - (at / 32) as f64);
            let expected = camera.to_world(Direction::new([x * pixel, y * pixel, -1.0].into()).unwrap());
            let colours = [found.0[0], found.0[1], found.0[2]].map(|colour| 2.0 * f64::from(colour) - 1.0);
            let found = Direction::new(colours.into()).unwrap();
            let off = found.angle_to(expected).radians() / pixel;
            assert!(off < 0.01, "frame {frame}, pixel {at}: off by {off} px");
        }
    }
}

#[test]
fn a_turn_is_eased_and_zooms() {
    let bench = bench_with(PATH);
    let to = ["--to", "perspective:vfov=50", "--size", "48x32"];
    let turn = ["--yaw", "0..80", "--fov", "50..30", "--frames", "1-5", "--easing", "in"];
    bench.succeed(&[&["convert", "sky.png", "f_#.png"], &to[..], &turn].concat());
    // A quarter of the time is a sixteenth of the way.
    let still = ["--to", "perspective:vfov=48.75", "--size", "48x32", "--yaw", "5"];
    bench.succeed(&[&["convert", "sky.png", "still.png"], &still[..]].concat());
    assert!(bench.load("still.png") == bench.load("f_2.png"));
    let path = "frame,yaw,pitch,roll,fov\n1,5,0,0,48.75\n2,5,0,0,40\n";
    std::fs::write(bench.path("path.csv"), path).unwrap();
    moved(&bench, &to, "p_#.png");
    assert!(bench.load("still.png") == bench.load("p_1.png"));
}

#[test]
fn sequences_and_formulas_keep_step_and_a_camera_may_rest() {
    let bench = bench_with("frame,yaw,pitch,roll\n1,0,0,0\n2,40,0,0\n4,40,0,0\n5,0,0,0\n");
    for frame in 1..=5 {
        bench.save(&format!("s_{frame}.png"), &picture(frame, 128, 64));
    }
    let to = ["--to", "fulldome", "--size", "64"];
    bench.succeed(&[&["convert", "s_#.png", "f_#.png", "--path", "path.csv", "--frames", "2-5"], &to[..]].concat());
    assert!(!bench.path("f_1.png").exists());
    for (frame, yaw) in [(2, "40"), (3, "40"), (4, "40"), (5, "0")] {
        let input = format!("s_{frame}.png");
        bench.succeed(&[&["convert", &input, "still.png", "-y", "--yaw", yaw], &to[..]].concat());
        assert!(bench.load("still.png") == bench.load(&format!("f_{frame}.png")), "frame {frame}");
    }
    bench.succeed(&[&["convert", "builtin:grid", "g_#.png", "--path", "path.csv"], &to[..]].concat());
    bench.succeed(&[&["convert", "builtin:grid", "grid.png", "--yaw", "40"], &to[..]].concat());
    assert!(bench.load("grid.png") == bench.load("g_3.png"));
    // One frame may have a plain name.
    bench.succeed(&[&["convert", "sky.png", "one.png", "--path", "path.csv", "--frames", "3"], &to[..]].concat());
}

#[test]
fn a_frame_between_two_poses_is_on_the_shortest_arc() {
    let bench = bench_with("time,yaw,pitch,roll\n0,170,0,0\n0.5,-170,0,0\n");
    let to = ["--to", "perspective:fov=60", "--size", "48x32"];
    for (extra, fps) in [(&[][..], "4"), (&["--path-curve", "smooth"], "4.0")] {
        moved(&bench, &[&to[..], extra, &["--fps", fps, "-y"]].concat(), "f_#.png");
        bench.succeed(&[&["convert", "sky.png", "still.png", "-y", "--yaw", "180"], &to[..]].concat());
        let light = |name: &str| read(bench.path(name), &Limits::NONE).unwrap().to_light();
        for (a, b) in light("still.png").pixels().iter().zip(light("f_1.png").pixels()) {
            assert!((0..3).all(|c| (a.0[c] - b.0[c]).abs() < 0.01), "{a:?}, not {b:?}");
        }
    }
}

#[test]
fn what_is_wrong_with_a_path_is_told_before_anything_is_made() {
    let bench = bench_with(PATH);
    bench.save("s_1.png", &picture(1, 128, 64));
    bench.save("s_9.png", &picture(1, 128, 64));
    std::fs::write(bench.path("nan.csv"), "frame,yaw,pitch,roll\n1,0,0,nan\n").unwrap();
    std::fs::write(bench.path("zoom.csv"), "frame,yaw,pitch,roll,fov\n1,0,0,0,60\n").unwrap();
    std::fs::write(bench.path("wide.csv"), "frame,yaw,pitch,roll,fov\n1,0,0,0,60\n2,0,0,0,190\n").unwrap();
    let flat = ["--to", "perspective:fov=60", "--size", "16"];
    let cases: [(i32, &[&str], &[&str]); 12] = [
        (1, &["sky.png", "f_#.png", "--path", "no.csv"], &["cannot open", "no.csv"]),
        (1, &["sky.png", "f_#.png", "--path", "nan.csv"], &["nan.csv: line 2: roll is 'nan'"]),
        (2, &["sky.png", "f_#.png", "--path", "path.csv", "--frames", "3-6"], &["from frame 1 to 4", "frames 5,6"]),
        (2, &["s_#.png", "f_#.png", "--path", "path.csv", "--frames", "9"], &["none for frame 9"]),
        (2, &["sky.png", "f.png", "--path", "path.csv"], &["4 frames cannot go into the one file f.png"]),
        (2, &["sky.png", "f_#.png", "--yaw", "0..90"], &["--frames is missing"]),
        (2, &["sky.png", "f_#.png", "--path", "path.csv", "--yaw", "3"], &["--path", "--yaw"]),
        (2, &["sky.png", "f_#.png", "--path", "path.csv", "--fps", "24"], &["by frame"]),
        (2, &["sky.png", "f_#.png", "--yaw", "30", "--easing", "in"], &["--easing", "nothing turns"]),
        (2, &["sky.png", "f_#.png", "--fov", "30"], &["expected two angles"]),
        (2, &["sky.png", "f_#.png", "--path", "wide.csv"], &["190", "180"]),
        (2, &["sky.png", "path.csv", "--path", "path.csv"], &["path.csv"]),
    ];
    for (code, args, parts) in cases {
        let message = bench.fail(code, &[&["convert"], args, &flat].concat());
        assert_says(&message, parts);
    }
    let panorama = ["convert", "sky.png", "f_#.png", "--path", "zoom.csv", "--to", "equirect", "--size", "64"];
    assert_says(&bench.fail(2, &panorama), &["equirect", "field of view", "zoom.csv has fov"]);
}

#[test]
fn a_camera_that_leaves_the_coverage_is_told_of_by_frame() {
    let bench = bench_with("frame,yaw,pitch,roll\n1,0,0,0\n10,0,-80,0\n");
    bench.faces("face_", 64);
    std::fs::remove_file(bench.path("face_bottom.png")).unwrap();
    let to = ["--to", "perspective:fov=40", "--size", "32x24", "--path", "path.csv"];
    let message = bench.fail(1, &[&["convert", "face_{face}.png", "f_##.png"], &to[..]].concat());
    assert_says(&message, &["frames 5-10: down: ", " of its 64x64 pixels are needed", "face_bottom.png is missing"]);
    bench.succeed(&[&["convert", "face_{face}.png", "f_##.png", "--frames", "1-4"], &to[..]].concat());
    let filled = ["--missing", "transparent", "-y"];
    bench.succeed(&[&["convert", "face_{face}.png", "f_##.png"], &to[..], &filled].concat());
    // A view of the front alone covers little.
    bench.succeed(&["convert", "sky.png", "view.png", "--to", "perspective:fov=90", "--size", "64"]);
    let view = ["convert", "view.png", "f_##.png", "--from", "perspective:fov=90"];
    let message = bench.fail(1, &[&view[..], &to[..], &["-y"]].concat());
    assert_says(&message, &["look where no view does", "frames "]);
}

/// Writes the path of the oracle's exposure: frame 1, from 0.5 to 1.5. Its roll is to the other side.
fn oracle_path(bench: &Bench) {
    let key = |k: i32| {
        let t = f64::from(k) / 64.0 - 0.5;
        format!("{},{},-4,{}\n", 1.0 + t, 20.0 + 6.0 * t, -4.0 * t)
    };
    let rows: String = (0..=64).map(key).collect();
    std::fs::write(bench.path("path.csv"), format!("frame,yaw,pitch,roll\n{rows}")).unwrap();
}

#[test]
fn a_blurred_frame_is_that_of_a_renderer() {
    let Some(folder) = testkit::shared("oracles/povray") else { return };
    let bench = Bench::new();
    oracle_path(&bench);
    let (faces, direct) = (folder.join("face_{face}.png"), folder.join("motion_blur64.png"));
    let psnr = |motion: &str| {
        let to = ["--to", "perspective:fov=60", "--size", "640x480", "--transfer", "linear", "-y"];
        let shot = ["--path", "path.csv", "--frames", "1", "--shutter", "1", "--motion", motion];
        bench.succeed(&[&["convert", faces.to_str().unwrap(), "out.png"], &to[..], &shot].concat());
        let compared = ["compare", "out.png", direct.to_str().unwrap(), "--transfer", "linear", "--json"];
        let report: serde_json::Value = serde_json::from_str(&bench.succeed(&compared)).unwrap();
        report["linear"]["psnr"].as_f64().unwrap()
    };
    let [swept, ellipse, none] = ["swept", "ellipse", "none"].map(psnr);
    println!("motion_blur64: swept {swept:.2} dB, ellipse {ellipse:.2} dB, none {none:.2} dB");
    assert!(swept >= 44.0, "swept: {swept} dB");
    assert!(ellipse >= 31.0 && none < 20.0, "ellipse: {ellipse} dB, none: {none} dB");
}

#[test]
fn a_shutter_blurs_what_moves_and_costs_nothing_where_nothing_does() {
    let bench = bench_with("frame,yaw,pitch,roll\n1,0,0,0\n3,0,0,0\n4,20,0,30\n5,40,0,60\n");
    let to = ["--to", "perspective:fov=60", "--size", "48x32", "--shutter", "0.5"];
    let still = ["--to", "perspective:fov=60", "--size", "48x32"];
    moved(&bench, &[&to[..], &["--frames", "1-2"]].concat(), "f_#.png");
    bench.succeed(&[&["convert", "sky.png", "still.png"], &still[..]].concat());
    assert!(bench.load("f_1.png") == bench.load("still.png"));
    // Blurred pictures keep their mean light, and lose contrast.
    let light = |name: &str| read(bench.path(name), &Limits::NONE).unwrap().to_light();
    moved(&bench, &[&to[..], &["--frames", "4", "-y"]].concat(), "swept_#.png");
    moved(&bench, &[&to[..], &["--frames", "4", "--motion", "none", "-y"]].concat(), "none_#.png");
    moved(&bench, &[&still[..], &["--frames", "4"]].concat(), "sharp_#.png");
    assert!(
        bench.load("none_4.png") == bench.load("sharp_4.png") && bench.load("swept_4.png") != bench.load("sharp_4.png")
    );
    for motion in ["ellipse", "swept"] {
        moved(
            &bench,
            &[&to[..], &["--frames", "4", "--motion", motion, "--threads", "1"]].concat(),
            &format!("{motion}_one_#.png"),
        );
        let (a, b) = (light(&format!("{motion}_one_4.png")), light("swept_4.png"));
        let worst = a.pixels().iter().zip(b.pixels()).map(|(a, b)| (a.0[0] - b.0[0]).abs()).fold(0.0, f32::max);
        assert!(worst < if motion == "swept" { 1e-9 } else { 0.02 }, "{motion}: {worst}");
    }
    // A frame's exposure up to its time is that of the middle between it and the one before.
    moved(
        &bench,
        &[&still[..], &["--frames", "5", "--shutter", "1", "--shutter-phase", "trailing"]].concat(),
        "late_#.png",
    );
    let earlier = "frame,yaw,pitch,roll\n3.5,0,0,0\n4.5,20,0,30\n5.5,40,0,60\n";
    std::fs::write(bench.path("path.csv"), earlier).unwrap();
    moved(&bench, &[&still[..], &["--frames", "5", "--shutter", "1"]].concat(), "centred_#.png");
    for (a, b) in light("late_5.png").pixels().iter().zip(light("centred_5.png").pixels()) {
        assert!((0..3).all(|c| (a.0[c] - b.0[c]).abs() < 0.005), "{a:?}, not {b:?}");
    }
}

#[test]
fn every_target_and_source_is_blurred() {
    let bench = bench_with("frame,yaw,pitch,roll\n1,0,0,0\n2,20,4,10\n3,40,0,0\n");
    bench.faces("face_", 32);
    let shot = ["--path", "path.csv", "--frames", "2", "--shutter", "0.5"];
    let targets: [&[&str]; 4] = [
        &["f_#.png", "--to", "fulldome", "--size", "32"],
        &["f_#.tif", "--to", "equirect", "--size", "32"],
        &["f_{face}_#.png", "--to", "cube", "--size", "16"],
        &["f_#.exr", "--to", "cube:layout=3x2", "--size", "16"],
    ];
    for to in targets {
        for motion in ["swept", "ellipse"] {
            let how = [to, &shot, &["--motion", motion, "-y"]].concat();
            bench.succeed(&[&["convert", "face_{face}.png"], &how[..]].concat());
            if motion == "swept" {
                bench.succeed(&[&["convert", "builtin:demo"], &how[..]].concat());
            }
        }
    }
    // Outside the lens there is nothing before and after.
    let dome = bench.load("f_2.png");
    assert_eq!(&crate::bench::eight_bits(&dome)[..3], [0, 0, 0]);
    let cases: [(&[&str], &str); 5] = [
        (&["--motion", "swept"], "--motion is for motion blur"),
        (&["--shutter", "180", "--yaw", "0..9", "--frames", "1-2"], "0.5 for a shutter of 180°"),
        (&["--shutter", "0.5", "--shutter-phase", "late", "--yaw", "0..9"], "leading, trailing"),
        (&["--shutter-phase", "leading"], "--shutter-phase is for motion blur"),
        (&["--shutter", "-1"], "from 0 to 10"),
    ];
    for (args, words) in cases {
        let to = ["convert", "face_{face}.png", "g_#.png", "--to", "fulldome"];
        assert_says(&bench.fail(2, &[&to[..], args].concat()), &[words]);
    }
    let ellipse = ["--to", "fulldome", "--size", "16", "--motion", "ellipse"];
    let message = bench.fail(2, &[&["convert", "builtin:demo", "h_#.png"], &shot[..], &ellipse].concat());
    assert_says(&message, &["a formula has none"]);
}

#[test]
fn explain_tells_what_a_path_sees_before_it_is_rendered() {
    let bench = bench_with("frame,yaw,pitch,roll\n1,0,0,0\n10,0,-80,0\n");
    bench.faces("face_", 64);
    let to = ["--to", "perspective:vfov=45", "--size", "320x240"];
    let explain = |input: &[&str], extra: &[&str]| bench.succeed(&[&["explain"], input, &to[..], extra].concat());
    let text = explain(&["face_{face}.png"], &["--path", "path.csv"]);
    // A view of 45° by 3:4 covers about six percent of the world (Greene 1986); a pixel at its centre is tan 22.5°/120 wide: 120/tan 22.5° is half of 579.
    assert_says(
        &text,
        &["frames   1-10;", "10 frames see", "5.9 % at once", "parity   579x579 for", "inside   all of it"],
    );
    std::fs::remove_file(bench.path("face_bottom.png")).unwrap();
    let text = explain(&["face_{face}.png"], &["--path", "path.csv"]);
    assert_says(&text, &["outside  frames 4-10: down: ", "is missing"]);
    let extra = ["--path", "path.csv", "--frames", "1-2", "--json", "--output", "diagrams"];
    let report: serde_json::Value = serde_json::from_str(&explain(&["face_{face}.png"], &extra)).unwrap();
    let path = &report[0]["path"];
    assert_eq!((&path["inside"], &path["count"], &path["frames"]), (&true.into(), &2.into(), &"1,2".into()));
    let svg = String::from_utf8(bench.bytes("diagrams/path.svg")).unwrap();
    assert!(svg.matches("<ellipse").count() >= 4 && bench.path("diagrams/path.png").is_file(), "{svg}");
    // Of an input that does not exist yet, sizes are advised; a whole turn of a level view sees a ring.
    let planned = ["--from", "cube", "--input-size", "64"];
    let text = explain(&planned, &["--yaw", "0..360", "--frames", "1-37"]);
    assert_says(&text, &["37 frames see", "parity   579x579"]);
    assert!(!text.contains("inside"), "{text}");
    let message = bench.fail(2, &[&["explain", "face_{face}.png"], &to[..], &["--yaw", "0..360"]].concat());
    assert_says(&message, &["--frames is missing"]);
}

/// Writes a scene in which a camera turns to the left by 60° over 12 frames of 24 a second.
fn scene(bench: &Bench) {
    let (sin, cos) = 30_f32.to_radians().sin_cos();
    let numbers: [f32; 10] = [0.0, 0.5, 0.0, 0.0, 0.0, 1.0, 0.0, sin, 0.0, cos];
    std::fs::write(bench.path("scene.bin"), numbers.iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<u8>>()).unwrap();
    let json = r#"{"asset":{"version":"2.0"},"buffers":[{"byteLength":40,"uri":"scene.bin"}],
        "bufferViews":[{"buffer":0,"byteLength":40}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[0.5]},
        {"bufferView":0,"byteOffset":8,"componentType":5126,"count":2,"type":"VEC4"}],
        "cameras":[{"type":"perspective","perspective":{"yfov":0.8,"znear":0.1}}],
        "nodes":[{"name":"Shot","camera":0},{"name":"Rest","camera":0}],"scenes":[{"nodes":[0,1]}],
        "animations":[{"samplers":[{"input":0,"output":1}],
        "channels":[{"sampler":0,"target":{"node":0,"path":"rotation"}},{"sampler":0,"target":{"node":0,"path":"translation"}}]}]}"#;
    std::fs::write(bench.path("scene.gltf"), json).unwrap();
}

#[test]
fn a_camera_of_a_scene_is_a_path() {
    let bench = bench_with(PATH);
    scene(&bench);
    let to = ["--to", "perspective:fov=60", "--size", "48x32"];
    let path = ["--path", "scene.gltf#Shot", "--fps", "24", "-y"];
    bench.succeed(&[&["convert", "sky.png", "f_##.png"], &to[..], &path].concat());
    bench.succeed(&[&["convert", "sky.png", "still.png", "--yaw", "-20"], &to[..]].concat());
    assert!(bench.load("f_04.png") == bench.load("still.png") && bench.path("f_12.png").is_file());
    let output = bench.run(&[&["convert", "sky.png", "f_##.png"], &to[..], &path].concat());
    assert_says(&crate::bench::text(&output.stderr), &["Shot also goes from place to place"]);
    std::fs::remove_file(bench.path("f_04.png")).unwrap();
    let cases: [(i32, &[&str], &[&str]); 4] = [
        (1, &["scene.gltf#Crane", "--fps", "24"], &["no camera or node Crane; there are Shot and Rest"]),
        (1, &["scene.gltf#Rest", "--fps", "24"], &["nothing turns Rest"]),
        (2, &["scene.gltf#Shot"], &["(fps) is needed"]),
        (1, &["other.glb", "--fps", "24"], &["cannot open --path other.glb"]),
    ];
    for (code, args, parts) in cases {
        let message = bench.fail(code, &[&["convert", "sky.png", "g_##.png", "--path"], args, &to[..]].concat());
        assert_says(&message, parts);
    }
    std::fs::remove_file(bench.path("scene.bin")).unwrap();
    let message = bench.fail(1, &[&["convert", "sky.png", "g_##.png"], &path[..4], &to[..]].concat());
    assert_says(&message, &["cannot open its buffer scene.bin"]);
}

#[test]
fn tables_of_gyroflow_are_paths() {
    let bench = bench_with(PATH);
    // The first pose looks down, as gyroscopes do that know no gravity; then it turns to its own right, by 10° each frame.
    let row = |frame: i32| {
        let turn =
            Orientation::from_yaw_pitch_roll(Angle::from_degrees(10.0 * f64::from(frame)), Angle::ZERO, Angle::ZERO);
        let down = Orientation::from_yaw_pitch_roll(
            Angle::from_degrees(70.0),
            Angle::from_degrees(-80.0),
            Angle::from_degrees(5.0),
        );
        let [x, y, z, w] = turn.within(down).rotation().to_array();
        let time = 1000.0 * f64::from(frame) / 25.0;
        format!("{frame},{time:.3},0.1,{w:.6},{x:.6},{y:.6},{z:.6},{w:.6},{x:.6},{y:.6},{z:.6}\n")
    };
    let names = "frame,timestamp_ms,org_acc_x,org_quat_w,org_quat_x,org_quat_y,org_quat_z,stab_quat_w,stab_quat_x,stab_quat_y,stab_quat_z";
    std::fs::write(bench.path("gyro.csv"), format!("{names}\n{}", (0..4).map(row).collect::<String>())).unwrap();
    let to = ["--to", "perspective:fov=60", "--size", "48x32", "-y"];
    for extra in [&[][..], &["--fps", "25"]] {
        bench.succeed(&[&["convert", "sky.png", "f_#.png", "--path", "gyro.csv"], &to[..], extra].concat());
        bench.succeed(&[&["convert", "sky.png", "still.png", "--yaw", "30"], &to[..]].concat());
        let light = |name: &str| read(bench.path(name), &Limits::NONE).unwrap().to_light();
        for (a, b) in light("still.png").pixels().iter().zip(light("f_3.png").pixels()) {
            assert!((0..3).all(|c| (a.0[c] - b.0[c]).abs() < 0.005), "{extra:?}: {a:?}, not {b:?}");
        }
    }
}
