//! Worlds behind the input's alpha: composites against those made directly and by hand, frames in step, and mistakes.

use cosmorama::camera::{CameraModel, CubeFaceCamera, EquirectCamera, FisheyeCamera, View};
use cosmorama::raster::{AlphaMode, Channels, Depth, EncodedImage, Image, Rgba, Samples, Transfer};
use cosmorama::sphere::{Angle, CubeFace, Direction, Orientation};
use cosmorama_builtin::{DemoWorld, Radiance, picture};
use cosmorama_io::{Limits, read};

use crate::bench::{Bench, assert_says, flat, picture as pattern, veiled};

/// Leaves of a fan around the front, of several colours and 70 % of opacity, with a hub of 100 %.
fn fan(direction: Direction) -> Option<([f32; 3], f32)> {
    let [x, y, z] = direction.vector().to_array();
    let (angle, radius) = (y.atan2(x), x.hypot(y));
    if z > 0.0 || radius > 0.6 {
        return None;
    }
    if radius < 0.15 {
        return Some(([1.0, 0.9, 0.1], 1.0));
    }
    let leaf = (angle * 9.0 / std::f64::consts::PI).floor();
    (leaf.rem_euclid(2.0) == 0.0).then_some(([0.1, 0.1 + 0.05 * (leaf as f32 + 9.0), 0.9], 0.7))
}

fn face_view(face: CubeFace, size: usize) -> View {
    let view = CameraModel::CubeFace(CubeFaceCamera).view(size, size).unwrap();
    View { orientation: face.orientation(), ..view }
}

/// Renders the fan alone, with alpha.
fn foreground(view: &View) -> Image<Rgba> {
    let colour = |direction: Direction| fan(direction).map_or([0.0; 3], |(colour, alpha)| colour.map(|c| c * alpha));
    let alpha = |direction: Direction| [fan(direction).map_or(0.0, |(_, alpha)| alpha); 3];
    let (mut light, alpha) = (picture(&colour, view), picture(&alpha, view));
    light.pixels_mut().iter_mut().zip(alpha.pixels()).for_each(|(pixel, alpha)| pixel.0[3] = alpha.0[0]);
    light
}

/// Light of the fan before the demo world.
fn composite(direction: Direction) -> [f32; 3] {
    let behind = DemoWorld.radiance(direction);
    let Some((colour, alpha)) = fan(direction) else { return behind };
    [0, 1, 2].map(|c| colour[c] * alpha + behind[c] * (1.0 - alpha))
}

fn save(bench: &Bench, name: &str, light: &Image<Rgba>, channels: Channels) {
    bench.save(name, &EncodedImage::encode(light, channels, Depth::Float, &Transfer::Linear));
}

fn light(bench: &Bench, name: &str) -> Image<Rgba> {
    read(bench.path(name), &Limits::NONE).unwrap().to_light()
}

fn psnr(a: &Image<Rgba>, b: &Image<Rgba>) -> f64 {
    let square =
        |(a, b): (&Rgba, &Rgba)| (0..3).map(|c| f64::from(a.0[c].min(1.0) - b.0[c].min(1.0)).powi(2)).sum::<f64>();
    let mean = a.pixels().iter().zip(b.pixels()).map(square).sum::<f64>() / (3 * a.pixels().len()) as f64;
    -10.0 * mean.log10()
}

#[test]
fn layers_are_the_composite_that_is_rendered_directly() {
    let bench = Bench::new();
    for face in CubeFace::ALL {
        let view = face_view(face, 256);
        save(&bench, &format!("fan_{face}.exr"), &foreground(&view), Channels::Rgba);
        save(&bench, &format!("demo_{face}.exr"), &picture(&DemoWorld, &view), Channels::Rgb);
        save(&bench, &format!("all_{face}.exr"), &picture(&composite, &view), Channels::Rgb);
    }
    let targets: [(&[&str], View); 2] = [
        (&["--to", "fisheye:fov=180", "--size", "192", "--pitch", "30", "--roll", "7"], {
            let dome = CameraModel::Fisheye(FisheyeCamera::default()).view(192, 192).unwrap();
            let [pitch, roll] = [30.0, 7.0].map(Angle::from_degrees);
            View { orientation: Orientation::from_yaw_pitch_roll(Angle::ZERO, pitch, roll), ..dome }
        }),
        (
            &["--to", "equirect", "--size", "256"],
            CameraModel::Equirect(EquirectCamera::default()).view(256, 128).unwrap(),
        ),
    ];
    for (to, view) in targets {
        let convert = |input: &str, more: &[&str]| {
            bench.succeed(&[&["convert", input, "out.exr", "-y"], to, more].concat());
            light(&bench, "out.exr")
        };
        let (layered, whole) =
            (convert("fan_{face}.exr", &["--backdrop", "demo_{face}.exr"]), convert("all_{face}.exr", &[]));
        let direct = picture(&composite, &view);
        let [to_whole, to_direct, of_whole] =
            [(&layered, &whole), (&layered, &direct), (&whole, &direct)].map(|(a, b)| psnr(a, b));
        println!(
            "{to:?}: {to_whole:.2} dB from the composite world, {to_direct:.2} dB from a direct one, which that has {of_whole:.2} dB from"
        );
        assert!(to_whole > 45.0, "{to:?}: {to_whole} dB");
        assert!(to_direct > of_whole - 0.5, "{to:?}: {to_direct} dB, {of_whole} dB");
        assert!(layered.pixels().iter().zip(whole.pixels()).all(|(a, b)| (a.alpha() - b.alpha()).abs() < 1e-3));
        // A formula behind is the formula itself.
        let exact = psnr(&convert("fan_{face}.exr", &["--backdrop", "builtin:demo"]), &direct);
        assert!(exact > to_direct, "{to:?}: {exact} dB");
    }
}

#[test]
fn edges_have_no_fringe() {
    let bench = Bench::new();
    // A disc with a hard edge and one with a soft one; what is transparent has a glaring colour in straight files.
    let disc = |i: usize, j: usize, at: f64, soft: f64| {
        let radius = (i as f64 - at).hypot(j as f64 - 32.0);
        ((14.0 - radius) / soft + 0.5).clamp(0.0, 1.0)
    };
    let alpha = |i: usize, j: usize| disc(i, j, 30.3, 0.01).max(disc(i, j, 90.6, 9.0));
    let straight = |colour: [u16; 3]| {
        let pixel = |k: usize| {
            let alpha = (65535.0 * alpha(k % 128, k / 128)).round() as u16;
            let [r, g, b] = if alpha == 0 { [65535, 0, 65535] } else { colour };
            [r, g, b, alpha]
        };
        let samples = Samples::U16((0..128 * 64).flat_map(pixel).collect());
        EncodedImage::new(128, 64, Channels::Rgba, Depth::Sixteen, samples).unwrap()
    };
    bench.save("white.png", &straight([65535; 3]));
    bench.save("black.png", &straight([0; 3]));
    for (name, code) in [("light.png", 255), ("dark.png", 0)] {
        bench.save(name, &flat(128, 64, &[code; 3]));
    }
    for to in
        [&["--to", "fulldome:tilt=30", "--size", "101"][..], &["--to", "perspective:fov=100", "--size", "800x600"]]
    {
        let over = |input: &str, behind: &str| {
            let args =
                ["convert", input, "out.exr", "-y", "--from", "equirect", "--backdrop", behind, "--depth", "float"];
            bench.succeed(&[&args[..], to].concat());
            light(&bench, "out.exr")
        };
        let (white_black, black_white) = (over("white.png", "dark.png"), over("black.png", "light.png"));
        let (white_white, black_black) = (over("white.png", "light.png"), over("black.png", "dark.png"));
        let all = white_black
            .pixels()
            .iter()
            .zip(black_white.pixels())
            .zip(white_white.pixels().iter().zip(black_black.pixels()));
        for (at, ((up, down), (whole, none))) in all.enumerate() {
            // Pixels that the lens's rim cuts are in part outside.
            let part = whole.0[0];
            for c in 0..3 {
                assert!(
                    (whole.0[c] - part).abs() < 1e-5 && none.0[c].abs() < 1e-6,
                    "{to:?}, {at}: {whole:?}, {none:?}"
                );
                assert!((up.0[c] + down.0[c] - part).abs() < 1e-5, "{to:?}, {at}: {up:?} and {down:?} for {part}");
                assert!((-1e-6..=part + 1e-6).contains(&up.0[c]) && up.0[c] == up.0[0], "{to:?}, {at}: {up:?}");
            }
        }
    }
}

/// A frame with a soft window, premultiplied, of a colour by number.
fn plate(number: usize) -> EncodedImage {
    let colour = 0.2 + 0.1 * number as f32;
    let image = veiled(48, 32, |_, _| [0.0; 3]);
    let Samples::Float(mut samples) = image.into_samples() else { panic!("floats are floats") };
    for (k, pixel) in samples.chunks_mut(4).enumerate() {
        let alpha = if (k % 48) < 20 + number { 1.0 } else { (k % 7) as f32 / 14.0 };
        pixel.copy_from_slice(&[colour * alpha, 0.5 * alpha, alpha, alpha]);
    }
    EncodedImage::new(48, 32, Channels::Rgba, Depth::Float, Samples::Float(samples))
        .unwrap()
        .with_alpha_mode(AlphaMode::Premultiplied)
}

#[test]
fn a_plate_before_a_moving_world_is_laid_over_it() {
    let bench = Bench::new();
    std::fs::write(bench.path("shot.csv"), "frame,yaw,pitch,roll\n1,0,0,0\n2,9,2,5\n3,15,4,10\n4,30,0,0\n").unwrap();
    bench.save("sky.png", &pattern(1, 256, 128));
    for frame in 1..=3 {
        bench.save(&format!("plate_{frame}.exr"), &plate(frame));
    }
    let camera = ["--to", "perspective:fov=60", "--size", "48x32", "--depth", "float", "-y"];
    let shot = ["--path", "shot.csv", "--frames", "1-3"];
    // The plate is filtered, too, where it stands.
    let alone = ["convert", "plate_#.exr", "front_#.exr", "--from", "perspective:fov=60"];
    bench.succeed(&[&alone[..], &camera].concat());
    // The plate is rendered once, and the world as without it. The kernel of ellipses is softer.
    let kinds: [(&[&str], f32); 3] =
        [(&[], 1e-4), (&["--shutter", "0.5"], 1e-5), (&["--shutter", "0.5", "--motion", "ellipse"], 0.3)];
    for (shutter, most) in kinds {
        let front = ["convert", "plate_#.exr", "out_#.exr", "--from", "perspective:fov=60", "--in-path", "shot.csv"];
        bench.succeed(&[&front[..], &camera, &shot, shutter, &["--backdrop", "sky.png"]].concat());
        bench.succeed(&[&["convert", "sky.png", "behind_#.exr"], &camera[..], &shot, shutter].concat());
        for frame in 1..=3 {
            let [found, behind, front] =
                ["out", "behind", "front"].map(|name| light(&bench, &format!("{name}_{frame}.exr")));
            for ((found, behind), front) in found.pixels().iter().zip(behind.pixels()).zip(front.pixels()) {
                let expected = front.over(*behind);
                assert!(
                    (0..4).all(|c| (found.0[c] - expected.0[c]).abs() < most),
                    "{shutter:?}: {found:?}, not {expected:?}"
                );
                assert!(front.alpha() < 1.0 || (0..3).all(|c| found.0[c] > 0.1), "the plate hides what is behind");
            }
        }
    }
    // Where nothing moves together, a still plate is seen with the world, by turned cameras.
    let still = ["convert", "plate_1.exr", "wide_#.exr", "--from", "perspective:fov=60", "--backdrop", "sky.png"];
    bench.succeed(&[&still[..], &["--to", "perspective:fov=100", "--size", "48x32", "--path", "shot.csv"]].concat());
    let corner = light(&bench, "wide_4.exr").pixels()[0];
    assert!((corner.alpha() - 1.0).abs() < 1e-6, "around the plate there is the world: {corner:?}");
}

#[test]
fn frames_go_in_step() {
    let bench = Bench::new();
    for frame in 1..=6 {
        bench.save(&format!("glass_{frame}.png"), &flat(64, 32, &[255, 255, 255, 0]));
    }
    for frame in 1..=3 {
        bench.save(&format!("sky_{frame}.png"), &flat(64, 32, &[10 * frame as u8, 0, 0]));
    }
    bench.save("still.png", &flat(64, 32, &[255, 255, 255, 0]));
    let to = ["--to", "fulldome", "--size", "16", "-y", "--backdrop", "sky_#.png"];
    let made = |input: &str, more: &[&str], frames: &[u64]| -> Vec<u8> {
        bench.succeed(&[&["convert", input, "out_#.png"], &to[..], more].concat());
        let red = |frame: &u64| crate::bench::eight_bits(&bench.load(&format!("out_{frame}.png")))[(8 * 16 + 8) * 3];
        frames.iter().map(red).collect()
    };
    let all = [1, 2, 3, 4, 5, 6];
    assert_eq!(made("glass_#.png", &["--frames", "1-3"], &[1, 2, 3]), [10, 20, 30]);
    assert_eq!(made("glass_#.png", &["--backdrop-frames", "hold"], &all), [10, 20, 30, 30, 30, 30]);
    assert_eq!(made("glass_#.png", &["--backdrop-frames", "loop+1"], &all), [20, 30, 10, 20, 30, 10]);
    assert_eq!(made("glass_#.png", &["--backdrop-frames", "-3", "--frames", "4-6"], &[4, 5, 6]), [10, 20, 30]);
    // A still input takes the backdrop's frames.
    assert_eq!(made("still.png", &["--backdrop-frames", "+1"], &[0, 1, 2]), [10, 20, 30]);
    assert_eq!(made("still.png", &["--frames", "2-3"], &[2, 3]), [20, 30]);
    // A still world stands behind all frames, and what is opaque and whole needs no alpha.
    bench.succeed(&[
        "convert",
        "glass_#.png",
        "whole_#.jpg",
        "--to",
        "equirect",
        "--size",
        "32",
        "--backdrop",
        "sky_2.png",
    ]);
    assert_eq!(bench.load("whole_6.jpg").channels(), Channels::Rgb);
    let report =
        bench.succeed(&[&["convert", "glass_#.png", "out_#.png", "--json", "--frames", "1"], &to[..]].concat());
    assert_says(&report, &["glass_1.png", "sky_1.png"]);
}

#[test]
fn mistakes_with_a_backdrop_are_told_before_anything_is_made() {
    let bench = Bench::new();
    bench.save("glass.png", &flat(64, 32, &[255, 255, 255, 0]));
    for frame in 1..=4 {
        bench.save(&format!("glass_{frame}.png"), &flat(64, 32, &[255, 255, 255, 0]));
    }
    bench.save("sky_1.png", &flat(64, 32, &[1; 3]));
    bench.save("sky_2.png", &flat(64, 32, &[1; 3]));
    bench.save("square.png", &flat(48, 40, &[1; 3]));
    bench.faces("face_", 16);
    std::fs::remove_file(bench.path("face_top.png")).unwrap();
    let cases: [(i32, &[&str], &[&str]); 11] = [
        (
            1,
            &["glass_#.png", "o_#.png", "--backdrop", "sky_#.png"],
            &["frames 1 to 2, but none for frames 3,4", "hold, loop"],
        ),
        (2, &["glass.png", "o.png", "--backdrop", "sky_#.png"], &["2 frames cannot go into the one file o.png"]),
        (1, &["glass.png", "o.png", "--backdrop", "no.png"], &["no.png"]),
        (1, &["glass.png", "o.png", "--backdrop", "square.png"], &["square.png", "--backdrop-from"]),
        (
            1,
            &["glass.png", "o.png", "--backdrop", "face_{face}.png"],
            &["--backdrop face_{face}.png: the input does not cover", "face_top.png is missing"],
        ),
        (
            2,
            &["builtin:grid", "o.png", "--backdrop", "sky_1.png"],
            &["--backdrop sky_1.png", "builtin:grid hides all of it"],
        ),
        (2, &["glass.png", "o.exr", "--backdrop", "sky_1.png", "--st-map"], &["--st-map", "leave it out"]),
        (2, &["glass.png", "o.png", "--backdrop", "builtin:direction-map"], &["numbers, not light"]),
        (2, &["glass.png", "o.png", "--backdrop-frames", "loop"], &["--backdrop"]),
        (
            2,
            &["glass.png", "o.png", "--backdrop", "sky_1.png", "--backdrop-frames", "mirror"],
            &["expected step, hold or loop"],
        ),
        (
            2,
            &["glass.png", "sky_1.png", "--backdrop", "sky_1.png", "-y"],
            &["sky_1.png: the output would replace its own input"],
        ),
    ];
    for (code, args, parts) in cases {
        let message = bench.fail(code, &[&["convert"], args, &["--to", "fulldome", "--size", "16"]].concat());
        assert_says(&message, parts);
    }
    // A sequence behind a still of no frames.
    let message = bench.fail(
        2,
        &["convert", "glass.png", "o.png", "--to", "fulldome", "--size", "9", "--in-path", "no.csv", "--fov", "3..4"],
    );
    assert_says(&message, &["--frames is missing"]);
}

#[test]
fn the_pictures_of_a_moving_camera_are_steadied_by_its_poses() {
    let bench = Bench::new();
    bench.succeed(&["convert", "builtin:demo", "world.exr", "--to", "equirect", "--size", "1024"]);
    let path = "frame,yaw,pitch,roll\n1,0,0,0\n2,11,-6,9\n3,-13,4,-20\n";
    std::fs::write(bench.path("shake.csv"), path).unwrap();
    let wide = ["--to", "perspective:fov=110", "--size", "480x360", "--path", "shake.csv"];
    bench.succeed(&[&["convert", "world.exr", "shot_#.exr"], &wide[..]].concat());
    let steady = ["convert", "shot_#.exr", "steady_#.exr", "--from", "perspective:fov=110", "--in-path", "shake.csv"];
    bench.succeed(&[&steady[..], &["--to", "perspective:fov=50", "--size", "160x120"]].concat());
    bench.succeed(&["convert", "world.exr", "still.exr", "--to", "perspective:fov=50", "--size", "160x120"]);
    let still = light(&bench, "still.exr");
    for frame in 1..=3 {
        let shaken = psnr(&light(&bench, &format!("steady_{frame}.exr")), &still);
        println!("frame {frame}: {shaken:.2} dB");
        assert!(shaken > 34.0, "frame {frame}: {shaken} dB");
    }
    std::fs::write(bench.path("zoom.csv"), "frame,yaw,pitch,roll,fov\n1,0,0,0,50\n2,0,0,0,50\n3,0,0,0,50\n").unwrap();
    let to = ["--to", "perspective:fov=50", "--size", "16", "-y"];
    let zoomed = ["convert", "shot_#.exr", "steady_#.exr", "--from", "perspective:fov=110", "--in-path", "zoom.csv"];
    assert_says(&bench.fail(2, &[&zoomed[..], &to].concat()), &["--in-path zoom.csv has fov", "--from"]);
    let lacking = ["convert", "shot_#.exr", "steady_#.exr", "--from", "perspective:fov=110", "--in-path", "no.csv"];
    assert_says(&bench.fail(1, &[&lacking[..], &to].concat()), &["cannot open --in-path no.csv"]);
}
