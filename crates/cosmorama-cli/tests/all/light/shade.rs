//! Things under a world: `shade`.

use cosmorama::compare::{Mask, compare};
use cosmorama::raster::{Channels, Depth, EncodedImage, Image, Rgba, Transfer};
use serde_json::Value;

use crate::bench::{Bench, assert_says};

/// The camera of ../shared/oracles/reflection/spheres.py.
const CAMERA: [&str; 8] =
    ["--camera", "perspective:fov=45.56481146096338", "--eye", "0,0,10", "--size", "512x256", "--depth", "float"];
const TANGENT: f64 = 0.42;
const DISTANCE: f64 = 10.0;

/// Whether a pixel shows nothing but the sphere at this place of the x axis.
fn is_inside(i: usize, j: usize, x: f64) -> bool {
    let corner = |i: usize, j: usize| {
        let direction =
            [(2.0 * i as f64 / 512.0 - 1.0) * TANGENT, (1.0 - 2.0 * j as f64 / 256.0) * TANGENT / 2.0, -1.0];
        let length = direction.iter().map(|part| part * part).sum::<f64>().sqrt();
        let offset = [-x, 0.0, DISTANCE];
        let along: f64 = direction.iter().zip(offset).map(|(a, b)| a * b / length).sum();
        offset.iter().map(|part| part * part).sum::<f64>() - along * along < 1.0
    };
    corner(i, j) && corner(i + 1, j) && corner(i, j + 1) && corner(i + 1, j + 1)
}

/// PSNR of linear light and shift, of the sphere at a place, against Mitsuba's.
fn against_mitsuba(bench: &Bench, args: &[&str], x: f64) -> (f64, f64) {
    let (faces, oracles) = (testkit::shared("oracles/povray").unwrap(), testkit::shared("oracles/reflection").unwrap());
    let faces = faces.join("face_{face}.png").display().to_string();
    bench.succeed(&[&["shade", &faces, "out.exr", "--transfer", "linear", "-y"], &CAMERA[..], args].concat());
    let light = |image: cosmorama::raster::EncodedImage| image.to_light(&Transfer::Linear);
    let truth = cosmorama_io::read(oracles.join("spheres.exr"), &cosmorama_io::Limits::NONE).unwrap().image;
    let mask = Mask::from_fn(512, 256, |i, j| is_inside(i, j, x));
    let comparison = compare(&light(bench.load("out.exr")), &light(truth), &mask).unwrap();
    (comparison.linear.psnr, comparison.registration.map_or(0.0, |found| found.shift()))
}

#[test]
fn spheres_are_those_of_a_path_tracer() {
    if testkit::shared("oracles/reflection").is_none() {
        return;
    }
    let bench = Bench::new();
    let args = ["--object", "plate4"];
    let (matt, _) = against_mitsuba(&bench, &args, -2.4);
    let (mirror, shift) = against_mitsuba(&bench, &args, 2.4);
    // A lobe of N = V = R is no GGX at a slant, and keeps light that facets lose: metallic-roughness does not (docs/objects.md).
    let (rough, _) = against_mitsuba(&bench, &["--alpha", "0.2"], 0.0);
    let material = ["--material", "metallic=1,roughness=0.4472135955,color=white"];
    let (metal, _) = against_mitsuba(&bench, &[&material[..], &["--target", "0,0,0"]].concat(), 0.0);
    println!(
        "matt {matt:.2} dB, mirror {mirror:.2} dB, shift {shift:.4} px, rough {rough:.2} dB, as metal {metal:.2} dB"
    );
    assert!(matt >= 55.0 && mirror >= 46.0 && shift <= 0.01, "{matt} dB, {mirror} dB, {shift} px");
    assert!(rough >= 28.5 && metal >= 35.5, "{rough} dB, {metal} dB");
}

/// Light of a picture's pixels.
fn light(bench: &Bench, name: &str) -> Image<Rgba> {
    bench.load(name).to_light(&Transfer::Linear)
}

#[test]
fn cameras_and_backgrounds_are_those_asked_for() {
    let bench = Bench::new();
    bench.save("sky.exr", &crate::bench::floats(64, 32, |_, _| [0.25, 0.5, 1.0]));
    let shade = |args: &[&str]| bench.succeed(&[&["shade", "sky.exr", "ball.exr", "-y"], args].concat());
    // In a world of one colour mirrors and matt things have that colour, by any camera, and beside them there is nothing.
    for camera in ["perspective:fov=50", "orthographic", "orthographic:height=2.5", "equirect", "cube:layout=3x2"] {
        let things = ["--object", "spheres:3", "--dc", "0.5", "--sc", "0.5", "--background", "transparent"];
        shade(&[&["--camera", camera, "--size", "64"], &things[..]].concat());
        let made = light(&bench, "ball.exr");
        assert!(made.pixels().iter().all(|pixel| (pixel.0[2] - pixel.0[3]).abs() < 2e-3), "{camera}");
        let is_there = |alpha: f32| made.pixels().iter().any(|pixel| pixel.0[3] == alpha);
        assert!(is_there(0.0) && made.pixels().iter().any(|pixel| pixel.0[3] > 0.99), "{camera}");
    }
    // A ball of radius 1 on 48 rows that are 2.5 high.
    shade(&["--camera", "orthographic:height=2.5", "--size", "64x48", "--background", "transparent"]);
    let area = |made: &Image<Rgba>| made.pixels().iter().map(|pixel| f64::from(pixel.0[3])).sum::<f64>();
    let expected = std::f64::consts::PI * (48.0 / 2.5f64).powi(2);
    let found = area(&light(&bench, "ball.exr"));
    assert!((found / expected - 1.0).abs() < 2e-3, "{found} for {expected}");
    let report =
        shade(&["--background", "transparent", "--material", "matte", "--dc", "0.5", "--json", "--size", "64x48"]);
    let report: Value = serde_json::from_str(&report).unwrap();
    assert_eq!(report["outputs"][0], "ball.exr");
    let made = bench.load("ball.exr");
    assert_eq!((made.channels(), made.depth()), (Channels::Rgba, Depth::Half));
    let made = made.to_light(&Transfer::Linear);
    let (middle, corner) = (made.get(32, 24).0, made.get(0, 0).0);
    assert!((middle[1] - 0.25).abs() < 1e-3 && middle[3] == 1.0, "{middle:?}");
    assert_eq!(corner, [0.0; 4]);
    // The silhouette is a circle of asin(1/d), from where the ball fills 48 rows of 64 columns that are 40° wide, but for 5 %.
    let half = 20f64.to_radians().tan();
    let distance = 1.05 / (0.75 * half).atan().sin();
    let expected = std::f64::consts::PI * (32.0 * distance.recip().asin().tan() / half).powi(2);
    let found = area(&made);
    assert!((found / expected - 1.0).abs() < 2e-3, "{found} for {expected}");
}

/// The light of a highlight of power 100 behind the eye, in the pixel beside the middle of 64² pixels that are 40° wide.
///
/// The ray leaves the axis by ψ and meets the ball of radius 1 at a normal φ from the axis, so that the reflected one is off by
/// 2φ + ψ. Over a pixel that turns by the square's side, whose variance adds to that of the lobe, 1/100.
fn beside_highlight() -> f64 {
    let (half, power) = (20f64.to_radians(), 100.0f64);
    let distance = 1.05 / half.sin();
    let reflected = |pixels: f64| {
        let ray = (pixels / 32.0 * half.tan()).atan();
        2.0 * ((distance * ray.sin()).asin() - ray) + ray
    };
    let off = reflected(0.5f64.hypot(0.5));
    let side = reflected(1.0);
    let variance = power.recip() + side * side / 12.0;
    (-(1.0 - off.cos()) / variance).exp() / (power * variance)
}

#[test]
fn chrome_needs_no_world() {
    let bench = Bench::new();
    let chrome =
        ["shade", "none", "ball.exr", "--material", "chrome", "--background", "black", "--size", "64x64", "-y"];
    let shade = |args: &[&str]| {
        bench.succeed(&[&chrome[..], args].concat());
        light(&bench, "ball.exr")
    };
    let made = shade(&[]);
    // The sky is reflected above, the earth below, and a colour is even along the horizon.
    let at = |i: usize, j: usize| made.get(i, j).0;
    assert!(at(32, 20)[2] > at(32, 20)[0] && at(32, 44)[0] > at(32, 44)[2], "{:?} {:?}", at(32, 20), at(32, 44));
    assert!((0..3).all(|k| (at(31, 20)[k] - at(32, 20)[k]).abs() < 1e-3));
    // Of one colour there is no table.
    let made = shade(&["--chrome", "0=0.25,0.5,1"]);
    let middle = made.get(32, 32).0;
    assert!((middle[0] - 0.25).abs() < 1e-3 && (middle[2] - 1.0).abs() < 1e-3, "{middle:?}");
    let lit = shade(&["--chrome", "0=black", "--highlight", "180:0:100"]);
    let (beside, far) = (f64::from(lit.get(32, 32).0[1]), lit.get(44, 32).0[1]);
    let expected = beside_highlight();
    assert!((beside - expected).abs() < 5e-3 && far < 0.1, "{beside} for {expected}, {far}");
    for (args, says) in [
        (&["shade", "none", "ball.exr"][..], &["--material chrome"][..]),
        (&["shade", "none", "ball.exr", "--material", "chrome"], &["--background"]),
        (
            &["shade", "none", "ball.exr", "--material", "chrome", "--chrome", "10=red;0=blue"],
            &["--chrome", "must grow"],
        ),
        (
            &["shade", "none", "ball.exr", "--material", "chrome", "--chrome", "red"],
            &["--chrome", "'red'", "DEGREES=COLOUR"],
        ),
        (&["shade", "none", "ball.exr", "--material", "chrome", "--highlight", "9"], &["--highlight", "YAW:PITCH"]),
        (&["shade", "builtin:demo", "ball.exr", "--highlight", "0:0"], &["--highlight", "--material chrome"]),
    ] {
        assert_says(&bench.fail(2, args), says);
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let bench = Bench::new();
    bench.save("sky.exr", &crate::bench::floats(64, 32, |_, _| [0.25, 0.5, 1.0]));
    std::fs::write(bench.path("scene.toml"), "[[object]]\nshape = 'sphere'\n").unwrap();
    let cases: [(&[&str], &[&str]); 21] = [
        (&["ball.jpg", "--background", "transparent"], &["JPEG", "no alpha", ".png"]),
        (&["ball.png", "--eye", "0,0,0"], &["--eye", "no direction"]),
        (&["ball.png", "--eye", "0,0"], &["--eye", "three numbers"]),
        (&["ball.png", "--alpha", "2"], &["α of 2", "0 to 1"]),
        (&["ball.png", "--material", "glass", "--alpha", "2"], &["--alpha: a roughness α of 2"]),
        (&["ball.png", "--material", "glass", "--absorption", "-1"], &["--absorption: an absorption of -1"]),
        (&["ball.png", "--object", "plate4", "--material", "matte"], &["plate4", "leave out --material"]),
        (&["ball.png", "--object", "teapot"], &["sphere, spheres:N, plate4 or a file (.obj"]),
        (&["ball.png", "--object", "spheres:0"], &["spheres:5"]),
        (&["ball.png", "--camera", "orthographic:height=0"], &["height=H"]),
        (&["ball.png", "--camera", "cube"], &["--camera", "layout=3x2"]),
        (&["ball.png", "--material", "metalic=1"], &["'metalic'", "did you mean metallic?"]),
        (&["ball.png", "--material", "metallic=2"], &["2 is outside 0 to 1"]),
        (&["ball.png", "--material", "metallic=1,metallic=0"], &["'metallic' is given twice"]),
        (&["ball.png", "--material", "roughness=1", "--alpha", "0.5"], &["--alpha", "roughness=0.5"]),
        (
            &["ball.png", "--material", "glass", "--refract", "bent", "--surfaces", "8"],
            &["--refract bent", "--surfaces"],
        ),
        (&["ball.png", "--scene", "scene.toml", "--highlight", "0:0"], &["--highlight", "nothing in the scene file"]),
        (&["ball.png", "--texture", "sky.exr"], &["--texture", "--material matte"]),
        (&["ball.png", "--part", "sphere2=sky.exr"], &["--part", "no 'sphere2'", "sphere1"]),
        (&["ball.png", "--proxy", "box:1,2"], &["--proxy", "box:X,Y,Z"]),
        (&["ball.png", "--turntable", "4"], &["--turntable", "turn_####.png"]),
    ];
    for (args, says) in cases {
        assert_says(&bench.fail(2, &[&["shade", "sky.exr"], args].concat()), says);
    }
    assert_says(&bench.fail(2, &["shade", "sky.exr", "sky.exr", "-y"]), &["sky.exr"]);
    assert_says(&bench.fail(1, &["shade", "none.exr", "ball.png"]), &["none.exr"]);
    assert_says(&bench.fail(1, &["shade", "sky.exr", "ball.png", "--size", "1000000x1000000"]), &["memory"]);
}

#[test]
fn metallic_roughness_and_textures_have_their_colours() {
    let bench = Bench::new();
    bench.save("white.exr", &crate::bench::floats(64, 32, |_, _| [1.0; 3]));
    // Its left half is red, its right half blue; the middle faces the camera.
    bench.save("map.exr", &crate::bench::floats(64, 32, |i, _| if i < 32 { [0.5, 0.0, 0.0] } else { [0.0, 0.0, 0.5] }));
    let shade = |args: &[&str]| {
        let command = ["shade", "white.exr", "ball.exr", "--size", "64x64", "--background", "transparent", "-y"];
        bench.succeed(&[&command[..], args].concat());
        light(&bench, "ball.exr")
    };
    // Under a white world, smooth metal has its colour straight on, and is white at the outline.
    let gold = shade(&["--material", "metallic=1,roughness=0.05,color=1:0.5:0.25"]);
    let at = |image: &Image<Rgba>, i: usize| image.get(i, 32).unpremultiplied();
    let (middle, outline) = (at(&gold, 32), at(&gold, 61));
    let near = |found: [f32; 3], expected: [f32; 3]| (0..3).all(|k| (found[k] - expected[k]).abs() < 0.01);
    assert!(near(middle, [1.0, 0.5, 0.25]) && outline[2] > 0.35, "{middle:?} {outline:?}");
    // An insulator keeps all light of a white world: what it does not reflect it scatters.
    let white = shade(&["--material", "roughness=0.4"]);
    assert!((4..60).all(|i| near(at(&white, i), [1.0; 3])), "{:?}", at(&white, 20));
    // Alpha is of no account on surfaces, even where there is none.
    let halves =
        Image::from_fn(64, 32, |i, _| if i < 32 { Rgba([0.5, 0.0, 0.0, 0.0]) } else { Rgba([0.0, 0.0, 0.25, 0.5]) });
    bench.save("clear.exr", &EncodedImage::encode(&halves, Channels::Rgba, Depth::Float, &Transfer::Linear));
    for map in ["map.exr", "clear.exr"] {
        let globe = shade(&["--material", "matte", "--texture", map]);
        let (left, right) = (at(&globe, 20), at(&globe, 44));
        assert!(near(left, [0.5, 0.0, 0.0]) && near(right, [0.0, 0.0, 0.5]), "{map}: {left:?} {right:?}");
    }
    // Its north is white, and its south black: around the ball they do not meet.
    bench.save("poles.exr", &crate::bench::floats(64, 32, |_, j| if j < 16 { [1.0; 3] } else { [0.0; 3] }));
    let seen = ["--camera", "orthographic:height=2", "--eye", "0,5,0.01", "--target", "0,0,0"];
    let north = shade(&[&["--material", "matte", "--texture", "poles.exr"], &seen[..]].concat());
    assert!((28..36).all(|i| near(at(&north, i), [1.0; 3])), "{:?}", at(&north, 32));
}

#[test]
fn scene_files_turntables_and_parts_are_pictures() {
    let bench = Bench::new();
    bench.save("white.exr", &crate::bench::floats(64, 32, |_, _| [1.0; 3]));
    bench.save("red.exr", &crate::bench::floats(64, 32, |_, _| [1.0, 0.0, 0.0]));
    let scene = "[camera]\nprojection = 'orthographic:height=4'\nsize = '64x64'\neye = [0, 0, 9]\ntarget = [0, 0, 0]\n\
                 [[object]]\nname = 'ball'\nshape = 'sphere'\ntranslate = [1, 0, 0]\n";
    std::fs::write(bench.path("scene.toml"), scene).unwrap();
    let args = ["--scene", "scene.toml", "--background", "black", "--turntable", "2", "--part", "ball=red.exr"];
    bench.succeed(&[&["shade", "white.exr", "turn_##.exr"], &args[..]].concat());
    for (name, shown, empty) in [("turn_01.exr", 48, 16), ("turn_02.exr", 16, 48)] {
        let image = light(&bench, name);
        let (thing, beside) = (image.get(shown, 32).0, image.get(empty, 32).0);
        assert!((thing[0] - 1.0).abs() < 1e-3 && thing[1] < 1e-3 && beside[0] == 0.0, "{name}: {thing:?} {beside:?}");
    }
    // A square that is moved to where the ball was.
    std::fs::write(bench.path("flat.obj"), "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n").unwrap();
    let model =
        scene.replace("shape = 'sphere'", "file = 'flat.obj'\nmaterial = 'matte'\nscale = 0.5\nrotate = [0, 0, 45]");
    std::fs::write(bench.path("model.toml"), model).unwrap();
    bench.succeed(&["shade", "white.exr", "model.exr", "--scene", "model.toml", "--background", "black", "-y"]);
    let image = light(&bench, "model.exr");
    let at = |x: usize, y: usize| image.get(x, y).0[1];
    assert!(
        at(48, 32) > 0.9 && at(48, 39) > 0.9 && at(57, 41) < 0.1 && at(32, 32) < 0.1,
        "{} {}",
        at(48, 39),
        at(57, 41)
    );
    std::fs::write(bench.path("wrong.toml"), scene.replace("shape", "shap")).unwrap();
    let wrong = |args: &[&str]| bench.fail(1, &[&["shade", "white.exr", "ball.exr", "--scene"], args].concat());
    assert_says(&wrong(&["wrong.toml"]), &["wrong.toml, line 8", "`shap`", "did you mean 'shape'?"]);
    assert_says(&wrong(&["lost.toml"]), &["lost.toml"]);
}

/// Writes a scene of a ball of chrome with a table of its own, and one of the usual table, side by side.
fn chrome_scene(bench: &Bench, lights: &str) {
    let scene = "[camera]\nprojection = 'orthographic:height=4'\nsize = '64x32'\neye = [0, 0, 9]\ntarget = [0, 0, 0]\n\
                 [material.blue]\nkind = 'chrome'\nchrome = '0=0,0,0.5'\n\
                 [[object]]\nshape = 'sphere'\nmaterial = 'blue'\ntranslate = [-2, 0, 0]\n\
                 [[object]]\nshape = 'sphere'\nmaterial = 'chrome'\ntranslate = [2, 0, 0]\n";
    std::fs::write(bench.path("scene.toml"), format!("{scene}{lights}")).unwrap();
}

#[test]
fn scene_files_have_lights_and_tables_of_chrome() {
    let bench = Bench::new();
    bench.save("sky.exr", &crate::bench::floats(64, 32, |_, _| [1.0; 3]));
    let shade = |lights: &str, args: &[&str]| {
        chrome_scene(&bench, lights);
        let scene = ["shade", "sky.exr", "out.exr", "--scene", "scene.toml", "--background", "black", "-y"];
        bench.succeed(&[&scene[..], args].concat());
        light(&bench, "out.exr")
    };
    let (light, blue) = ("[[light]]\nyaw = 180\npitch = 0\npower = 100\ncolor = '1,0.5,0'\n", [0.0, 0.0, 0.5]);
    let near = |found: [f32; 4], expected: [f32; 3]| (0..3).all(|k| (found[k] - expected[k]).abs() < 0.02);
    let (dark, lit) = (shade("", &[]), shade(light, &[]));
    // Each ball has its own table: one is even, the other goes from earth to sky.
    assert!(near(dark.get(16, 16).0, blue) && near(dark.get(16, 11).0, blue), "{:?}", dark.get(16, 16));
    assert!(dark.get(48, 11).0[2] > dark.get(48, 11).0[0] && dark.get(48, 21).0[0] > dark.get(48, 21).0[2]);
    // The light is that of the option, on both balls, and has its own colour.
    let white = shade("", &["--highlight", "180:0:100"]);
    for i in [16, 48] {
        let [before, after, white] = [&dark, &lit, &white].map(|image| image.get(i, 16).0);
        let added = white[1] - before[1];
        assert!(added > 0.2, "{added}");
        assert!(near(after, [before[0] + added, before[1] + 0.5 * added, before[2]]), "{after:?} {white:?}");
    }
    // Options go before: one table for all, and one light in the place of the file's.
    let other = shade(light, &["--chrome", "0=0,0.25,0", "--highlight", "0:90:100"]);
    assert!([16, 48].iter().all(|i| near(other.get(*i, 16).0, [0.0, 0.25, 0.0])), "{:?}", other.get(16, 16));
    // The zenith is where the surface is at 45°.
    assert!(other.get(48, 10).0[0] > 0.1, "{:?}", other.get(48, 10));
    let fail = |lights: &str, says: &[&str]| {
        chrome_scene(&bench, lights);
        assert_says(&bench.fail(1, &["shade", "sky.exr", "out.exr", "--scene", "scene.toml", "-y"]), says);
    };
    fail(&light.replace("pitch = 0", "pitch = 91"), &["scene.toml, line 19", "a pitch of 91"]);
    fail(&light.replace("100", "0.5"), &["scene.toml, line 20", "a power of 0.5"]);
    fail(&light.replace("yaw = 180\n", ""), &["scene.toml, line 17", "yaw"]);
    fail("[material.red]\nkind = 'chrome'\nchrome = '0=red;0=blue'\n", &["scene.toml, line 19", "must grow"]);
    std::fs::write(bench.path("plain.toml"), format!("[[object]]\nshape = 'sphere'\n{light}")).unwrap();
    let plain = bench.fail(1, &["shade", "sky.exr", "out.exr", "--scene", "plain.toml", "-y"]);
    assert_says(&plain, &["plain.toml, line 4", "lights shine on chrome"]);
}

#[test]
fn a_backdrop_is_seen_behind_things_and_nowhere_else() {
    let bench = Bench::new();
    bench.save("red.exr", &crate::bench::floats(64, 32, |_, _| [1.0, 0.0, 0.0]));
    let camera = ["--camera", "perspective:fov=60", "--eye", "0,0,6", "--target", "0,0,0", "--size", "64x48"];
    let shade = |args: &[&str]| {
        bench.succeed(&[&["shade"], args, &camera[..], &["-y"]].concat());
    };
    bench.succeed(&["convert", "builtin:checker", "map.exr", "--to", "equirect", "--size", "256"]);
    shade(&["red.exr", "ball.exr", "--backdrop", "map.exr", "--reflect", "ewa", "--depth", "float"]);
    let lens = ["--to", "perspective:fov=60", "--size", "64x48", "--depth", "float", "-y"];
    bench.succeed(&[&["convert", "map.exr", "map_seen.exr"], &lens[..]].concat());
    let (made, seen) = (light(&bench, "ball.exr"), light(&bench, "map_seen.exr"));
    // The ball mirrors its own world; beside it is what convert shows of the other, by the same filter.
    let middle = made.get(32, 24).0;
    assert!((middle[0] - 1.0).abs() < 1e-3 && middle[1] < 1e-3, "{middle:?}");
    let differ = |(i, j): &(usize, usize)| (made.get(*i, *j).0[0] - seen.get(*i, *j).0[0]).abs();
    assert!([(0, 0), (5, 40), (63, 10), (12, 24)].iter().map(differ).fold(0.0, f32::max) < 1e-5);
    // A plate need not show more than the picture does.
    let plate = ["--backdrop", "map_seen.exr", "--reflect", "ewa", "--depth", "float"];
    let plated = |from: &'static str| [&["red.exr", "plate.exr", "--backdrop-from", from], &plate[..]].concat();
    shade(&plated("perspective:fov=80"));
    assert!(light(&bench, "plate.exr").pixels().iter().all(|pixel| pixel.alpha() > 0.999));
    let narrow = [&["shade"], &plated("perspective:fov=30")[..], &camera, &["-y"]].concat();
    std::fs::remove_file(bench.path("plate.exr")).unwrap();
    assert_says(&bench.fail(1, &narrow), &["--backdrop: map_seen.exr shows nothing in", "pixels", "--missing black"]);
    bench.succeed(&[&narrow[..], &["--missing", "0,1,0"]].concat());
    assert!((light(&bench, "plate.exr").get(0, 0).0[1] - 1.0).abs() < 1e-3);
    // Of a whole turn it is the same in all pictures, and chrome has one without a world.
    shade(&["red.exr", "turn_#.exr", "--backdrop", "map.exr", "--turntable", "2"]);
    let [one, two] = ["turn_1.exr", "turn_2.exr"].map(|name| light(&bench, name));
    assert!(one.get(0, 0) == two.get(0, 0) && one.get(63, 10) == two.get(63, 10));
    shade(&["none", "chrome.exr", "--material", "chrome", "--backdrop", "builtin:checker"]);
    let chrome = light(&bench, "chrome.exr");
    assert!(chrome.pixels().iter().filter(|pixel| pixel.0[0] > 0.5).count() > 500);
    let fail = |code: i32, args: &[&str], says: &[&str]| {
        assert_says(&bench.fail(code, &[&["shade", "red.exr", "out.exr"], args].concat()), says);
    };
    fail(2, &["--backdrop", "map.exr", "--background", "black"], &["--backdrop", "--background"]);
    fail(2, &["--backdrop", "none"], &["--backdrop", "none is no world"]);
    fail(2, &["--backdrop-from", "equirect"], &["--backdrop"]);
    fail(1, &["--backdrop", "lost.exr"], &["--backdrop", "lost.exr"]);
    bench.save("odd.exr", &crate::bench::floats(64, 40, |_, _| [1.0; 3]));
    let unknown = bench.fail(1, &["shade", "red.exr", "out.exr", "--backdrop", "odd.exr"]);
    assert_says(&unknown, &["--backdrop", "odd.exr", "--backdrop-from"]);
    assert!(!unknown.contains("--from"), "{unknown}");
    assert_says(&bench.fail(2, &["shade", "red.exr", "map.exr", "--backdrop", "map.exr", "-y"]), &["map.exr"]);
}

#[test]
fn a_scene_file_has_a_backdrop_and_options_go_before() {
    let bench = Bench::new();
    bench.save("red.exr", &crate::bench::floats(64, 32, |_, _| [1.0, 0.0, 0.0]));
    bench.save("green.exr", &crate::bench::floats(64, 32, |_, _| [0.0, 1.0, 0.0]));
    bench.save("plate.exr", &crate::bench::floats(64, 40, |_, _| [0.0, 0.0, 1.0]));
    let things = "[camera]\nprojection = 'perspective:fov=60'\neye = [0, 0, 6]\ntarget = [0, 0, 0]\nsize = '64x40'\n\
                  [[object]]\nshape = 'sphere'\n[backdrop]\n";
    let args = ["shade", "red.exr", "ball.exr", "--scene", "scene.toml", "-y"];
    let write = |backdrop: &str| std::fs::write(bench.path("scene.toml"), format!("{things}{backdrop}")).unwrap();
    let corner = |options: &[&str]| {
        bench.succeed(&[&args[..], options].concat());
        let made = light(&bench, "ball.exr");
        // The ball mirrors its own world.
        assert!((made.get(32, 20).0[0] - 1.0).abs() < 1e-3, "{:?}", made.get(32, 20));
        made.get(1, 1).0.map(|part| (part * 100.0).round())
    };
    write("image = 'green.exr'\n");
    assert_eq!(corner(&[]), [0.0, 100.0, 0.0, 100.0]);
    // Its files are read, and not written upon.
    assert_says(&bench.fail(2, &[&args[..2], &["green.exr"], &args[3..]].concat()), &["green.exr"]);
    write("image = 'plate.exr'\nspec = 'perspective:fov=80'\n");
    assert_eq!(corner(&[]), [0.0, 0.0, 100.0, 100.0]);
    assert_eq!(corner(&["--backdrop", "green.exr"]), [0.0, 100.0, 0.0, 100.0]);
    assert_eq!(corner(&["--background", "black"]), [0.0, 0.0, 0.0, 100.0]);
    assert_eq!(corner(&["--background", "world"]), [100.0, 0.0, 0.0, 100.0]);
    for (backdrop, says) in [
        ("image = 'lost.exr'\n", &["line 9: ", "lost.exr"][..]),
        ("image = 'none'\n", &["line 9", "none is no world"]),
        ("image = 'plate.exr'\n", &["line 9", "plate.exr", "give spec "]),
        (
            "image = 'plate.exr'\nspec = 'perspektive:fov=80'\n",
            &["line 10: spec = \"perspektive:fov=80\"", "perspective"],
        ),
        ("image = 'plate.exr'\nspec = 'perspective:fov=30'\n", &["line 9: ", "shows nothing in", "--missing black"]),
        ("image = 'builtin:grid'\nspec = 'equirect'\n", &["line 9: spec cannot be given for builtin:grid"]),
        ("imag = 'green.exr'\n", &["line 9: unknown key `imag`", "did you mean 'image'?"]),
        ("spec = 'equirect'\n", &["line 8", "image"]),
    ] {
        write(backdrop);
        let error = bench.fail(1, &args);
        assert_says(&error, &[&["scene.toml, "], says].concat());
        assert!(!error.contains("--backdrop") && !error.contains("--from"), "{error}");
    }
}

/// Returns what is told of a ball under a panorama to who asks.
fn notes(bench: &Bench, args: &[&str]) -> String {
    let output = bench.run(&[&["shade", "sky.exr", "ball.exr", "--size", "32", "-y", "-v"], args].concat());
    assert!(output.status.success());
    String::from_utf8(output.stderr).unwrap()
}

#[test]
fn a_guessed_projection_is_told_by_the_name_of_its_setting() {
    let bench = Bench::new();
    bench.save("sky.exr", &crate::bench::floats(64, 32, |_, _| [1.0; 3]));
    bench.save("map.exr", &crate::bench::floats(64, 32, |_, _| [0.5; 3]));
    let told = notes(&bench, &["--backdrop", "map.exr"]);
    assert_says(&told, &["sky.exr is taken for a panorama (--from equirect)", "(--backdrop-from equirect)"]);
    let scene = "[world.room]\nimage = 'map.exr'\n[[object]]\nshape = 'sphere'\nworld = 'room'\n";
    std::fs::write(bench.path("scene.toml"), scene).unwrap();
    let told = notes(&bench, &["--scene", "scene.toml"]);
    assert_says(&told, &["map.exr is taken for a panorama (spec equirect)"]);
}

#[test]
fn tables_of_chrome_and_maps_count_as_memory() {
    let bench = Bench::new();
    bench.save("sky.exr", &crate::bench::floats(64, 32, |_, _| [1.0; 3]));
    let estimated = |scene: &str| {
        std::fs::write(bench.path("scene.toml"), scene).unwrap();
        let args = ["shade", "sky.exr", "ball.exr", "--scene", "scene.toml", "--size", "32", "-y", "--json"];
        let report: serde_json::Value = serde_json::from_str(&bench.succeed(&args)).unwrap();
        report["estimated_memory_bytes"].as_u64().unwrap()
    };
    let balls = |materials: &[&str]| -> String {
        let ball = |material: &&str| format!("[[object]]\nshape = 'sphere'\nmaterial = '{material}'\n");
        let colour = |k: usize| format!("[material.c{k}]\nkind = 'chrome'\nchrome = '0=0,0,{k}'\n");
        materials.iter().map(ball).chain((1..4).map(colour)).collect()
    };
    let [one, three, shared] =
        [&["c1"][..], &["c1", "c2", "c3"], &["c1", "c1", "c1"]].map(|names| estimated(&balls(names)));
    // Each table has 3,073 entries of nine doubles.
    assert_eq!((three - one, shared - one), (2 * 3073 * 72, 0));
    let rough = |roughness: &str| {
        estimated(&format!("[material.m]\nroughness = {roughness}\n[[object]]\nshape = 'sphere'\nmaterial = 'm'\n"))
    };
    assert!(rough("0.3") > rough("0.0") + 6 * 50 * 50 * 16);
}

#[test]
fn mistakes_of_scene_files_name_the_line_of_the_key() {
    let bench = Bench::new();
    bench.save("sky.exr", &crate::bench::floats(64, 32, |_, _| [1.0; 3]));
    std::fs::write(bench.path("flat.obj"), "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nf 1 2 3\n").unwrap();
    let scene = "[camera]\nprojection = 'perspective:fov=40'\nsize = '64x48'\neye = [0, 0, 9]\ntarget = [0, 0, 0]\n\
                 [[object]]\nname = 'ball'\nshape = 'sphere'\n[[object]]\nname = 'other'\nshape = 'sphere'\n";
    for (from, to, says) in [
        ("perspective:fov=40", "cube", &["line 2", "layout=3x2"][..]),
        ("perspective:fov=40", "perspective:fov=400", &["line 2", "400°"]),
        ("perspective:fov=40", "gltf", &["line 2", "no model here has a camera"]),
        ("64x48", "64x", &["line 3", "64x"]),
        ("64x48", "1000000x1000000", &["line 3", "memory"]),
        ("[0, 0, 9]", "[0, 0, 0]", &["line 4", "no direction"]),
        ("'other'", "'ball'", &["line 10", "'ball'", "line 7, too"]),
        ("name = 'other'", "name = 'sphere1'", &["line 10: 'sphere1'"]),
        (
            "shape = 'sphere'",
            "file = 'flat.obj'\nmaterial = 'glass'",
            &["line 8", "'ball'", "flat.obj: glass must be closed"],
        ),
    ] {
        let text = scene.replacen(from, to, 1);
        let text = if to.contains("sphere1") { text.replacen("name = 'ball'\n", "#\n", 1) } else { text };
        std::fs::write(bench.path("scene.toml"), text).unwrap();
        let error = bench.fail(1, &["shade", "sky.exr", "ball.exr", "--scene", "scene.toml"]);
        assert_says(&error, &[&["scene.toml, "], says].concat());
        assert!(!error.contains("--camera"), "{error}");
    }
    // An option that is wrong is told as that, and one that is right goes before what is wrong.
    std::fs::write(bench.path("scene.toml"), scene.replace("[0, 0, 9]", "[0, 0, 0]")).unwrap();
    let args = ["shade", "sky.exr", "ball.exr", "--scene", "scene.toml"];
    bench.succeed(&[&args[..], &["--eye", "0,0,9"]].concat());
    assert_says(&bench.fail(2, &[&args[..], &["-y", "--camera", "cube"]].concat()), &["--camera", "layout=3x2"]);
    let open = bench.fail(1, &["shade", "sky.exr", "flat.exr", "--object", "flat.obj", "--material", "glass"]);
    assert_says(&open, &["flat.obj: glass must be closed"]);
}

/// A square under a camera of its own, in glTF; its material glows green.
const SQUARE: &str = r#"{
  "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
  "nodes": [{"mesh": 0}, {"name": "above", "camera": 0, "translation": [0.5, 0.5, 3]}],
  "cameras": [{"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 0.5, "znear": 0.1, "zfar": 9}}],
  "materials": [{"emissiveFactor": [0, 1, 0], "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 1}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": 5, "material": 0}]}],
  "accessors": [
    {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
    {"bufferView": 1, "componentType": 5121, "count": 4, "type": "SCALAR"}
  ],
  "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 4}],
  "buffers": [{"uri": "square.bin", "byteLength": 52}]
}"#;

#[test]
fn models_have_materials_and_cameras_of_their_own() {
    let bench = Bench::new();
    bench.save("white.exr", &crate::bench::floats(64, 32, |_, _| [1.0; 3]));
    let corners = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let numbers = corners.iter().flatten().flat_map(|number| number.to_le_bytes());
    std::fs::write(bench.path("square.bin"), numbers.chain([0, 1, 2, 3]).collect::<Vec<u8>>()).unwrap();
    std::fs::write(bench.path("square.gltf"), SQUARE).unwrap();
    let shade = ["shade", "white.exr", "out.exr", "--object", "square.gltf"];
    for camera in ["gltf", "gltf:above"] {
        let seen = ["--material", "own", "--camera", camera, "--size", "64", "--background", "black", "-y"];
        bench.succeed(&[&shade[..], &seen].concat());
        let image = light(&bench, "out.exr");
        // Twice as wide as high, as the file says; the square fills its height.
        assert_eq!((image.width(), image.height()), (64, 32));
        let (shown, beside) = (image.get(32, 2).0, image.get(8, 16).0);
        assert!((shown[1] - 1.0).abs() < 1e-3 && shown[0] < 1e-3 && beside[1] == 0.0, "{shown:?} {beside:?}");
    }
    let fail = |args: &[&str]| bench.fail(2, &[&shade[..], args].concat());
    assert_says(&fail(&["--camera", "gltf:below"]), &["--camera gltf:below", "there are above"]);
    assert_says(&fail(&["--camera", "gltf", "--eye", "0,0,1"]), &["--eye", "leave"]);
    assert_says(&fail(&["--material", "own", "--dc", "1"]), &["--material own", "--dc"]);
    let fail = |args: &[&str]| bench.fail(2, &[&["shade", "white.exr", "ball.exr"], args].concat());
    assert_says(&fail(&["--material", "own"]), &["--material own", "--object teapot.glb"]);
    assert_says(&fail(&["--camera", "gltf"]), &["--camera gltf", "no model here has a camera"]);
}

#[test]
fn things_hide_light_where_that_is_asked_for() {
    let bench = Bench::new();
    bench.save("white.exr", &crate::bench::floats(64, 32, |_, _| [1.0; 3]));
    let scene = "[camera]\nprojection = 'perspective:fov=40'\nsize = '64x64'\neye = [0, 3, 6]\ntarget = [0, 0, 0]\n\
                 [[object]]\nfile = 'floor.obj'\nmaterial = 'matte'\n\
                 [[object]]\nshape = 'sphere'\nmaterial = 'mirror'\ntranslate = [0, 0.6, 0]\nscale = 0.5\n";
    std::fs::write(bench.path("scene.toml"), scene).unwrap();
    std::fs::write(bench.path("floor.obj"), "v -4 0 4\nv 4 0 4\nv 4 0 -4\nv -4 0 -4\nf 1 2 3 4\n").unwrap();
    for (name, how) in [("open.exr", "none"), ("hidden.exr", "ambient")] {
        bench.succeed(&[
            "shade",
            "white.exr",
            name,
            "--scene",
            "scene.toml",
            "--background",
            "black",
            "--occlusion",
            how,
        ]);
    }
    let [open, hidden] = ["open.exr", "hidden.exr"].map(|name| light(&bench, name));
    let at = |image: &Image<Rgba>, j: usize| image.get(32, j).0[0];
    // This pixel sees the floor at (0, 0, 0.966). Of a ball of radius R at a distance d, by θ from the normal, hidden is (R/d)² cos θ.
    let distance = 0.6f64.hypot(0.966);
    let expected = 1.0 - (0.5 / distance).powi(2) * (0.6 / distance);
    let (open, hidden) = (at(&open, 38), at(&hidden, 38));
    // 64 rays miss it by 0.012, by root of mean square.
    assert!(
        (open - 1.0).abs() < 1e-3 && (f64::from(hidden) - expected).abs() < 0.036,
        "{open} {hidden} for {expected}"
    );
}
