//! Cameras that were measured: their pictures out and in again, and calibrations that do not fit.

use crate::bench::{Bench, assert_says, picture};

/// OpenCV's pinhole model, as `cv2.FileStorage` writes it; the axis is off the middle and pixels are not square.
const PINHOLE: &str = "%YAML:1.0\n---\nimage_width: 320\nimage_height: 240\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   \
                       cols: 3\n   dt: d\n   data: [ 200., 0., 170., 0., 210., 110., 0., 0., 1. ]\n\
                       distortion_coefficients: !!opencv-matrix\n   data: [ -0.22, 0.045, 0.002, -0.001, 0.001 ]\n";

/// OpenCV's fisheye model, its sensor skewed.
const FISHEYE: &str = r#"{"image_size": [320, 240], "K": [[130, 3, 150.5], [0, 128, 121], [0, 0, 1]],
                          "D": [-0.0014, -0.0032, 0.0043, -0.0016]}"#;

/// OCamCalib's, about as large.
const OCAM: &str = "#polynomial coefficients for the DIRECT mapping function (ocam_model.ss in MATLAB).\n\n\
                    4 -110.0 0.0 2.9e-03 -1.2e-06\n\n#inverse\n\n2 1 1\n\n#center\n\n118.5 162.25\n\n#affine\n\n\
                    1.002 0.004 -0.003\n\n#image size: \"height\" and \"width\"\n\n240 320\n";

fn bench() -> Bench {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 1024, 512));
    std::fs::create_dir(bench.path("camera")).unwrap();
    for (name, text) in [("pinhole.yml", PINHOLE), ("fisheye.json", FISHEYE), ("calib_results.txt", OCAM)] {
        std::fs::write(bench.path("camera").join(name), text).unwrap();
    }
    bench
}

#[test]
fn what_a_camera_saw_is_seen_again() {
    let bench = bench();
    bench.succeed(&["convert", "sky.png", "direct.png", "--to", "perspective:fov=50", "--size", "120"]);
    for spec in [
        "perspective:calibration=camera/pinhole.yml",
        "fisheye:calibration=camera/fisheye.json",
        "fisheye:calibration=camera/calib_results.txt",
    ] {
        // Twice the size that was measured: as good.
        bench.succeed(&["convert", "sky.png", "seen.png", "--to", spec, "--size", "640x480", "-y"]);
        let back = ["--to", "perspective:fov=50", "--size", "120", "-y"];
        bench.succeed(&[&["convert", "seen.png", "back.png", "--from", spec], &back[..]].concat());
        bench.succeed(&["compare", "back.png", "direct.png", "--min-psnr", "58"]);
    }
}

#[test]
fn a_calibration_has_a_size_of_its_own() {
    let bench = bench();
    for spec in ["perspective:calibration=camera/pinhole.yml", "fisheye:calibration=camera/fisheye.json"] {
        bench.succeed(&["convert", "sky.png", "seen.png", "--to", spec, "-y"]);
        assert_says(&bench.succeed(&["info", "seen.png"]), &["width: 320", "height: 240"]);
    }
}

#[test]
fn world_files_name_calibrations_beside_them() {
    let bench = bench();
    let to = "perspective:calibration=camera/pinhole.yml";
    bench.succeed(&["convert", "sky.png", "camera/seen.png", "--to", to, "--size", "320x240"]);
    let world = "[[view]]\nimage = \"seen.png\"\nspec = \"perspective:calibration=pinhole.yml\"\n";
    std::fs::write(bench.path("camera/world.toml"), world).unwrap();
    bench.succeed(&["convert", "camera/world.toml", "out.png", "--to", "perspective:fov=50", "--size", "60"]);
}

#[test]
fn calibrations_that_do_not_fit_say_why() {
    let bench = bench();
    // r = θ − θ³/3 turns back at 57.3°, 100 · 2/3 pixels from the axis.
    let folding = FISHEYE.replace("-0.0014, -0.0032, 0.0043, -0.0016", "-0.333333333, 0, 0, 0");
    std::fs::write(bench.path("folding.json"), folding).unwrap();
    std::fs::write(bench.path("bent.yml"), PINHOLE.replace("0.045", "-0.2")).unwrap();
    std::fs::write(bench.path("told.json"), FISHEYE.replacen('{', "{\"distortion_model\": \"equidistant\",", 1))
        .unwrap();
    let to = |spec: &'static str, size| ["convert", "sky.png", "out.png", "--to", spec, "--size", size];
    std::fs::write(bench.path("torn.yml"), &PINHOLE[..120]).unwrap();
    // What is wrong is the file.
    for (spec, expected) in [
        ("perspective:calibration=none.yml", &["--to <SPEC>: calibration=: ", "none.yml", "cannot open"][..]),
        ("st-map:file=map.exr,base=fisheye:calibration=none.json", &["none.json", "cannot open"]),
        ("perspective:calibration=torn.yml", &["torn.yml"]),
        ("perspective:calibration=sky.png", &["sky.png"]),
        ("perspective:calibration=camera/calib_results.txt", &["calib_results.txt", "fisheye:calibration="]),
        ("perspective:calibration=told.json", &["told.json", "fisheye:calibration="]),
        ("fisheye:calibration=camera/pinhole.yml", &["5 distortion coefficients", "perspective:calibration="]),
    ] {
        assert_says(&bench.fail(1, &to(spec, "320x240")), expected);
    }
    for (spec, size, expected) in [
        ("perspective:calibration=camera/pinhole.yml", "400x400", &["400x400", "320x240", "canvas="][..]),
        ("fisheye:calibration=camera/fisheye.json,k=1", "320x240", &["k= and calibration= cannot both"]),
        ("fisheye:calibration=folding.json", "320x240", &["turns back 57.29", "86 pixels", "fov= (at most 114.59"]),
        ("fisheye:calibration=folding.json,fov=120", "320x240", &["the field of view is 120°", "114.59"]),
        ("perspective:calibration=bent.yml", "320x240", &["turns back", "pixels", "fov="]),
        ("fisheye:calibration=", "320x240", &["calibration=: expected a file, as in calibration="]),
        ("perspective:fov=60,calibration=", "320x240", &["calibration=: expected a file, as in calibration="]),
    ] {
        assert_says(&bench.fail(2, &to(spec, size)), expected);
    }
    bench.succeed(&to("fisheye:calibration=folding.json,fov=110", "320x240"));
    bench.succeed(&[&to("perspective:calibration=bent.yml,fov=60", "320x240")[..], &["-y"]].concat());
}
