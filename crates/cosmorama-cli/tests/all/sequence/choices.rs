//! What a wrong choice costs: a shot with pan, tilt and roll past small lamps, against the mean of many frames; and motion blur
//! with other kernels, channels and eyes.

use cosmorama::raster::{Channels, Depth, EncodedImage, Image, Rgba, Transfer};
use cosmorama_io::{
    Choice, LayeredImage, Limits, Plane, PlaneSamples, WriteOptions, open, read, read_layers, write_layers,
};

use crate::bench::{Bench, floats};

/// Size of the frame, and the frames that make up the truth.
const SIZE: &str = "80x60";
const TRUTH: usize = 512;

/// Angles at the frames 0, 1 and 2 of the shot: the exposure of frame 1 goes from 0.5 to 1.5.
const KEYS: [[f64; 3]; 3] = [[-12.0, -3.0, -20.0], [0.0, 4.0, 0.0], [16.0, -2.0, 20.0]];

/// A world of patterns and lamps of 20 times white, in light.
fn world(bench: &Bench, name: &str, most: f32) {
    let (width, height) = (512, 256);
    let image = floats(width, height, |i, j| {
        let (x, y) = (i as f32 / width as f32, j as f32 / height as f32);
        let stripes = if (40.0 * x + 9.0 * y).fract() < 0.5 { 0.75 } else { 0.08 };
        let pattern = [stripes, 0.2 + 0.3 * (30.0 * y).sin().abs(), 0.5 * x + 0.2 * stripes];
        let is_lamp = i % 37 < 2 && j % 29 < 2;
        if is_lamp { [20.0, 18.0, 15.0].map(|c: f32| c.min(most)) } else { pattern }
    });
    bench.save(name, &image);
}

fn table(rows: impl Iterator<Item = (f64, [f64; 3])>) -> String {
    let row = |(frame, [yaw, pitch, roll]): (f64, [f64; 3])| format!("{frame},{yaw},{pitch},{roll}\n");
    format!("frame,yaw,pitch,roll\n{}", rows.map(row).collect::<String>())
}

fn keys(scale: f64, offset: f64, turned: impl Fn([f64; 3]) -> [f64; 3]) -> String {
    table(KEYS.iter().enumerate().map(|(k, angles)| (k as f64 * scale + offset, turned(*angles))))
}

fn light(bench: &Bench, name: &str) -> Image<Rgba> {
    read(bench.path(name), &Limits::NONE).unwrap().to_light()
}

/// Returns the mean of so many frames over the exposure, each of the middle of its part.
fn mean(bench: &Bench, world: &str, frames: usize, more: &[&str]) -> Image<Rgba> {
    // Time 0.5 of the shot is frame −0.5 of these, and 1.5 the last and a half.
    let path = keys(frames as f64, -0.5 * frames as f64 - 0.5, |angles| angles);
    std::fs::write(bench.path("parts.csv"), path).unwrap();
    let list = format!("0-{}", frames - 1);
    let args =
        ["convert", world, "part_####.exr", "-y", "--to", "perspective:fov=60", "--size", SIZE, "--depth", "float"];
    bench.succeed(&[&args[..], &["--path", "parts.csv", "--frames", &list], more].concat());
    let mut sum: Option<Image<Rgba>> = None;
    for frame in 0..frames {
        let part = light(bench, &format!("part_{frame:04}.exr"));
        let part = part.pixels().iter().map(|pixel| *pixel * (1.0 / frames as f32));
        match &mut sum {
            Some(sum) => sum.pixels_mut().iter_mut().zip(part).for_each(|(sum, part)| *sum += part),
            None => sum = Some(Image::new(80, 60, part.collect()).unwrap()),
        }
    }
    sum.unwrap()
}

fn psnr(a: &Image<Rgba>, b: &Image<Rgba>) -> f64 {
    let square = |(a, b): (&Rgba, &Rgba)| (0..3).map(|c| f64::from(a.0[c] - b.0[c]).powi(2)).sum::<f64>();
    let mean = a.pixels().iter().zip(b.pixels()).map(square).sum::<f64>() / (3 * a.pixels().len()) as f64;
    -10.0 * mean.log10()
}

/// Renders frame 1 of the shot under an open shutter.
fn swept(bench: &Bench, world: &str, path: &str, more: &[&str]) -> Image<Rgba> {
    std::fs::write(bench.path("shot.csv"), path).unwrap();
    let args = ["convert", world, "out.exr", "-y", "--to", "perspective:fov=60", "--size", SIZE, "--depth", "float"];
    bench.succeed(&[&args[..], &["--path", "shot.csv", "--frames", "1", "--shutter", "1"], more].concat());
    light(bench, "out.exr")
}

#[test]
fn wrong_choices_cost_what_they_cost_elsewhere() {
    let bench = Bench::new();
    world(&bench, "world.exr", f32::INFINITY);
    world(&bench, "clipped.exr", 1.0);
    let truth = mean(&bench, "world.exr", TRUTH, &[]);
    let shot = || keys(1.0, 0.0, |angles| angles);
    let right = psnr(&swept(&bench, "world.exr", &shot(), &[]), &truth);
    // Angles that go on evenly are not a turn that does.
    let euler = table((0..=64).map(|k| {
        let (time, part) = (f64::from(k) / 32.0, f64::from(k % 32) / 32.0);
        let [from, to] = if k < 64 { [KEYS[k as usize / 32], KEYS[k as usize / 32 + 1]] } else { [KEYS[2]; 2] };
        (time, [0, 1, 2].map(|c| from[c] + (to[c] - from[c]) * part))
    }));
    let rolled = keys(1.0, 0.0, |[yaw, pitch, roll]| [yaw, pitch, -roll]);
    let costs = [
        ("64 frames instead of 512", psnr(&mean(&bench, "world.exr", 64, &[]), &truth)),
        ("8 frames instead of 512", psnr(&mean(&bench, "world.exr", 8, &[]), &truth)),
        ("angles instead of slerp", psnr(&swept(&bench, "world.exr", &euler, &[]), &truth)),
        ("roll of the other sign", psnr(&swept(&bench, "world.exr", &rolled, &[]), &truth)),
        ("lamps clipped before the blur", psnr(&swept(&bench, "clipped.exr", &shot(), &[]), &truth)),
        ("a shutter 0.02 late", psnr(&swept(&bench, "world.exr", &shot(), &["--shutter-phase", "0.48"]), &truth)),
        ("one ellipse a pixel", psnr(&swept(&bench, "world.exr", &shot(), &["--motion", "ellipse"]), &truth)),
        ("no blur", psnr(&swept(&bench, "world.exr", &shot(), &["--motion", "none"]), &truth)),
    ];
    println!("swept: {right:.1} dB");
    for (what, cost) in costs {
        println!("{what}: {cost:.1} dB");
        assert!(right > cost + 6.0 || what.starts_with("64"), "{what}: {cost} dB, but {right} dB without");
    }
    assert!(right > 46.0, "{right} dB");
    assert!(costs[0].1 < right + 1.0, "64 frames are no better: {} dB, {right} dB", costs[0].1);
}

#[test]
fn code_values_are_not_averaged() {
    let bench = Bench::new();
    world(&bench, "clipped.exr", 1.0);
    bench.succeed(&[
        "convert",
        "clipped.exr",
        "world.png",
        "--from",
        "equirect",
        "--to",
        "equirect",
        "--size",
        "512",
        "--depth",
        "16",
    ]);
    let truth = mean(&bench, "world.png", 128, &[]);
    let shot = keys(1.0, 0.0, |angles| angles);
    let right = psnr(&swept(&bench, "world.png", &shot, &[]), &truth);
    // Codes are taken for light, averaged, and taken for codes again.
    let codes = swept(&bench, "world.png", &shot, &["--in-transfer", "linear"]);
    let decode = |code: f32| Transfer::Srgb.decode(f64::from(code), cosmorama::raster::ColourChannel::Green) as f32;
    let wrong: Vec<Rgba> = codes.pixels().iter().map(|pixel| Rgba(pixel.0.map(decode))).collect();
    let wrong = psnr(&Image::new(80, 60, wrong).unwrap(), &truth);
    println!("light: {right:.1} dB, code values: {wrong:.1} dB");
    assert!(right > 44.0 && wrong < 32.0, "{right} dB, {wrong} dB");
}

#[test]
fn a_premultiplied_foreground_is_not_straight() {
    let bench = Bench::new();
    world(&bench, "world.exr", 1.0);
    let plate = Image::from_fn(80, 60, |i, j| {
        let alpha = (1.5 - (i as f32 - 40.0).hypot(j as f32 - 30.0) / 24.0).clamp(0.0, 1.0);
        Rgba([0.9 * alpha, 0.6 * alpha, 0.3 * alpha, alpha])
    });
    // The same numbers, premultiplied and taken as straight.
    bench.save("plate.exr", &EncodedImage::encode(&plate, Channels::Rgba, Depth::Float, &Transfer::Linear));
    let samples = plate.pixels().iter().flat_map(|pixel| pixel.0.map(|c| (c * 65535.0).round() as u16)).collect();
    let straight =
        EncodedImage::new(80, 60, Channels::Rgba, Depth::Sixteen, cosmorama::raster::Samples::U16(samples)).unwrap();
    bench.save_as("plate.png", &straight, Some(Transfer::Linear));
    let over = |plate: &str, more: &[&str]| {
        let args = ["convert", plate, "out.exr", "-y", "--from", "perspective:fov=60", "--to", "perspective:fov=60"];
        let rest = ["--size", SIZE, "--depth", "float", "--backdrop", "world.exr", "--backdrop-from", "equirect"];
        bench.succeed(&[&args[..], &rest, more].concat());
        light(&bench, "out.exr")
    };
    bench.succeed(&[
        "convert",
        "world.exr",
        "behind.exr",
        "--from",
        "equirect",
        "--to",
        "perspective:fov=60",
        "--size",
        SIZE,
    ]);
    let behind = light(&bench, "behind.exr");
    let expected: Vec<Rgba> =
        plate.pixels().iter().zip(behind.pixels()).map(|(front, behind)| front.over(*behind)).collect();
    let expected = Image::new(80, 60, expected).unwrap();
    let (right, wrong) =
        (psnr(&over("plate.exr", &[]), &expected), psnr(&over("plate.png", &["--in-transfer", "linear"]), &expected));
    println!("premultiplied: {right:.1} dB, as straight: {wrong:.1} dB");
    assert!(right > 50.0 && wrong < 36.0, "{right} dB, {wrong} dB");
}

#[test]
fn blur_takes_kernels_channels_and_eyes() {
    let bench = Bench::new();
    world(&bench, "world.exr", f32::INFINITY);
    let shot = keys(1.0, 0.0, |angles| angles);
    // A kernel that keeps the light of lamps keeps it under a shutter.
    let (kernel, truth) = (["--kernel", "light"], mean(&bench, "world.exr", 48, &["--kernel", "light"]));
    let found = psnr(&swept(&bench, "world.exr", &shot, &kernel), &truth);
    println!("kernel light: {found:.1} dB");
    assert!(found > 40.0, "{found} dB");
    // Further channels are those of the frame's own time.
    let picture = floats(512, 256, |i, j| [(i % 16) as f32 / 16.0, (j % 8) as f32 / 8.0, 0.5]);
    let distances = (0..512 * 256).map(|k| 3.0 + (k % 512) as f32 / 64.0).collect();
    let planes = vec![Plane { name: "depth.Z".to_owned(), samples: PlaneSamples::Float(distances) }];
    let layered = LayeredImage { size: (512, 256), picture: Some(&picture), names: Vec::new(), planes };
    write_layers(bench.path("layers.exr"), layered, &WriteOptions::default()).unwrap();
    let depth = |more: &[&str]| {
        let image = swept(&bench, "layers.exr", &shot, &[&["--from", "equirect"], more].concat());
        let path = bench.path("out.exr");
        let choice = Choice { without_picture: true, ..Choice::default() };
        let read = read_layers(open(&path).unwrap(), &path, &Limits::NONE, (&choice, &["depth.Z"])).unwrap();
        let PlaneSamples::Float(numbers) = read.into_iter().next().unwrap().samples else {
            panic!("floats are floats")
        };
        (image, numbers)
    };
    let (blurred, sharp) = (depth(&[]), depth(&["--motion", "none"]));
    assert!(blurred.1 == sharp.1 && psnr(&blurred.0, &sharp.0) < 30.0);
    // Each eye is blurred as it is alone.
    let eyes =
        floats(
            128,
            128,
            |i, j| if j < 64 { [(i % 9) as f32 / 9.0, 0.0, 0.0] } else { [0.0, 0.0, (i % 7) as f32 / 7.0] },
        );
    bench.save("eyes.exr", &eyes);
    bench.save("left.exr", &floats(128, 64, |i, _| [(i % 9) as f32 / 9.0, 0.0, 0.0]));
    bench.save("right.exr", &floats(128, 64, |i, _| [0.0, 0.0, (i % 7) as f32 / 7.0]));
    std::fs::write(bench.path("shot.csv"), &shot).unwrap();
    let shutter = ["--path", "shot.csv", "--frames", "1", "--shutter", "1", "--size", "64", "-y", "--depth", "float"];
    bench.succeed(
        &[
            &["convert", "eyes.exr", "pair.exr", "--from", "equirect:stereo=tb", "--to", "equirect:stereo=tb"],
            &shutter[..],
        ]
        .concat(),
    );
    let pair = light(&bench, "pair.exr");
    for (eye, half) in [("left.exr", 0), ("right.exr", 32)] {
        bench.succeed(&[&["convert", eye, "one.exr", "--to", "equirect"], &shutter[..]].concat());
        let one = light(&bench, "one.exr");
        for j in 0..32 {
            let differ = |(a, b): (&Rgba, &Rgba)| (0..3).any(|c| (a.0[c] - b.0[c]).abs() > 1e-5);
            assert!(!pair.row(half + j).iter().zip(one.row(j)).any(differ), "{eye}, row {j}");
        }
    }
}
