//! Pictures and videos as cameras with two lenses make them, drawn here by their public descriptions.

use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};
use cosmorama::sphere::Direction;

use crate::bench::{Bench, assert_says, eight_bits, floats};

/// Returns the direction at an angle from a lens's axis, towards parts of its right and of up that make one.
fn seen(is_front: bool, angle: f64, right: f64, up: f64) -> [f64; 3] {
    let (forward, side) =
        if is_front { (Direction::FRONT, Direction::RIGHT) } else { (Direction::BACK, Direction::LEFT) };
    let [forward, side, above] = [forward, side, Direction::UP].map(|axis| [0, 1, 2].map(|part| axis.vector()[part]));
    [0, 1, 2].map(|part| forward[part] * angle.cos() + (side[part] * right + above[part] * up) * angle.sin())
}

/// Light of a direction: each of its parts from 0 to 1.
fn light(direction: [f64; 3]) -> [f32; 3] {
    direction.map(|part| ((part + 1.0) / 2.0) as f32)
}

/// Two circles in squares of 256 pixels beside each other. `upright` turns columns to the right and rows up into the lens's right
/// and up, and `quarter` is the radius at 90 degrees, of a square's width.
fn circles(quarter: f64, upright: impl Fn(bool, f64, f64) -> (f64, f64)) -> EncodedImage {
    floats(512, 256, |i, j| {
        let is_front = i < 256;
        let (x, y) = ((i % 256) as f64 + 0.5 - 128.0, 128.0 - (j as f64 + 0.5));
        let radius = x.hypot(y);
        let (right, up) = upright(is_front, x / radius, y / radius);
        let angle = radius / (quarter * 256.0) * 90.0;
        if radius > 128.0 { [0.0; 3] } else { light(seen(is_front, angle.to_radians(), right, up)) }
    })
}

/// Asserts that each pixel of a panorama has the light of its own direction, to within an angle.
fn assert_directions(bench: &Bench, panorama: &str, degrees: f64) {
    let image = bench.load(panorama);
    let Samples::Float(samples) = image.samples() else { panic!("floats") };
    let (width, height) = (image.width(), image.height());
    for (at, pixel) in samples.chunks_exact(image.channels().count()).enumerate() {
        let yaw = ((at % width) as f64 + 0.5) / width as f64 * 360.0 - 180.0;
        let pitch = 90.0 - ((at / width) as f64 + 0.5) / height as f64 * 180.0;
        let [yaw, pitch] = [yaw, pitch].map(f64::to_radians);
        let ahead = seen(true, yaw.abs(), yaw.signum(), 0.0);
        let up = seen(true, std::f64::consts::FRAC_PI_2, 0.0, 1.0);
        let expected = [0, 1, 2].map(|part| ahead[part] * pitch.cos() + up[part] * pitch.sin());
        let found = [0, 1, 2].map(|part| f64::from(pixel[part]) * 2.0 - 1.0);
        let distance = (0..3).map(|part| (found[part] - expected[part]).powi(2)).sum::<f64>().sqrt();
        assert!(distance.to_degrees() < degrees, "pixel {at}: {found:?} {expected:?}");
    }
}

const PANORAMA: [&str; 6] = ["--to", "equirect", "--size", "256", "--depth", "float"];

#[test]
fn two_circles_of_insta360_show_every_direction_where_it_is() {
    let bench = Bench::new();
    bench.save("two.exr", &circles(90.0 / 204.0, |_, right, up| (right, up)));
    bench.succeed(&[&["convert", "two.exr", "sky.exr", "--from", "insta360"], &PANORAMA[..]].concat());
    // A pixel of the circles is 0.8 degrees.
    assert_directions(&bench, "sky.exr", 0.8);
    bench.save("two.exr", &circles(90.0 / 191.5, |_, right, up| (right, up)));
    bench.succeed(&[&["convert", "two.exr", "air.exr", "--from", "insta360:fov=191.5"], &PANORAMA[..]].concat());
    assert_directions(&bench, "air.exr", 0.8);
}

/// The left picture has its upper side at the left, the right one at the right.
#[test]
fn two_circles_of_theta_show_every_direction_where_it_is() {
    let bench = Bench::new();
    let upright = |is_front: bool, right: f64, up: f64| if is_front { (up, -right) } else { (-up, right) };
    bench.save("two.exr", &circles(0.445, upright));
    bench.succeed(&[&["convert", "two.exr", "sky.exr", "--from", "theta"], &PANORAMA[..]].concat());
    assert_directions(&bench, "sky.exr", 0.8);
}

/// An equi-angular cube, without the columns that GoPro MAX stores twice.
const EDGE: usize = 128;

/// Copies the columns of an equi-angular cube of 8 bits into a picture like GoPro MAX's: both halves of each outer face have 16 columns
/// of the other.
fn doubled(sheet: &EncodedImage) -> EncodedImage {
    let half = EDGE / 2;
    let columns: Vec<usize> =
        [0..half + 16, half - 16..2 * EDGE + half + 16, 2 * EDGE + half - 16..3 * EDGE].into_iter().flatten().collect();
    let pixel = |row: usize, column: usize| &eight_bits(sheet)[(row * 3 * EDGE + column) * 3..][..3];
    let rows = (0..2 * EDGE).flat_map(|row| columns.iter().flat_map(move |column| pixel(row, *column)));
    let samples = Samples::U8(rows.copied().collect());
    EncodedImage::new(columns.len(), 2 * EDGE, Channels::Rgb, Depth::Eight, samples).unwrap()
}

/// Makes `sheet.png`, an equi-angular cube, and `rows.png`, the same as GoPro MAX stores it.
fn sheets(bench: &Bench) {
    bench.succeed(&["convert", "builtin:demo", "sheet.png", "--to", "eac", "--size", "128"]);
    let rows = doubled(&bench.load("sheet.png"));
    assert_eq!((rows.width(), rows.height()), (448, 256));
    bench.save("rows.png", &rows);
}

#[test]
fn rows_of_gopro_max_are_the_cube_that_they_were_made_of() {
    let bench = Bench::new();
    sheets(&bench);
    let panorama = ["--to", "equirect", "--size", "256"];
    bench.succeed(&[&["convert", "sheet.png", "sky.png", "--from", "eac"], &panorama[..]].concat());
    bench.succeed(&[&["convert", "rows.png", "max.png", "--from", "gopro-max"], &panorama[..]].concat());
    // Columns that are there twice are blended, and show the same: no step is left where they begin and end.
    let (sky, max) = (bench.load("sky.png"), bench.load("max.png"));
    let worst = eight_bits(&sky).iter().zip(eight_bits(&max)).map(|(one, other)| one.abs_diff(*other)).max();
    assert!(worst <= Some(2), "{worst:?}");
    // It is written as it is read.
    bench.succeed(&["convert", "sky.png", "again.png", "--from", "equirect", "--to", "gopro-max", "--size", "448x256"]);
    bench.succeed(&[&["convert", "again.png", "back.png", "--from", "gopro-max"], &panorama[..]].concat());
    bench.succeed(&["compare", "back.png", "sky.png", "--min-psnr", "26", "--max-shift", "0.01"]);
    // Other sizes are refused, with those that are right.
    let wrong = bench.fail(1, &["convert", "sheet.png", "no.png", "--from", "gopro-max", "--to", "equirect"]);
    assert_says(&wrong, &["sheet.png: 384x256 pixels", "32 columns twice", "64 columns"]);
}

#[cfg(feature = "video")]
mod videos {
    use super::*;
    use crate::bench::text;
    use crate::sequence::films::{ffmpeg, has_ffmpeg};

    /// Makes a video whose two streams are parts of pictures.
    fn film(bench: &Bench, picture: &str, name: &str, parts: [&str; 2], codecs: &[&str]) {
        let [one, other] = parts;
        let graph = format!("[0]split[a][b];[a]crop={one}[x];[b]crop={other}[y]");
        let source = ["-framerate", "25", "-i", picture, "-filter_complex", &graph, "-map", "[x]", "-map", "[y]"];
        ffmpeg(bench, &[&source[..], codecs, &["-pix_fmt", "rgb24", "-f", "mov", name]].concat());
    }

    #[test]
    fn both_streams_of_gopro_max_are_read_in_step() {
        if !has_ffmpeg() {
            return;
        }
        let bench = Bench::new();
        for (frame, yaw) in ["0", "30", "60"].iter().enumerate() {
            let sheet = format!("sheet_{frame}.png");
            bench.succeed(&["convert", "builtin:demo", &sheet, "--to", "eac", "--size", "128", "--yaw", yaw]);
            bench.save(&format!("rows_{frame}.png"), &doubled(&bench.load(&sheet)));
        }
        film(&bench, "rows_%d.png", "GS01.360", ["448:128:0:0", "448:128:0:128"], &["-c:v", "png"]);
        let told = bench.succeed(&["info", "GS01.360"]);
        assert_says(&told, &["projection: cube:layout=eac,overlap=32 (two streams)", "width: 448", "height: 256"]);
        assert_says(&told, &["frames: 0-2", "one above the other"]);
        let panorama = ["--to", "equirect", "--size", "128"];
        bench.succeed(&[&["convert", "rows_#.png", "sky_#.png", "--from", "gopro-max"], &panorama[..]].concat());
        // No --from is needed.
        bench.succeed(&[&["convert", "GS01.360", "max_#.png"], &panorama[..]].concat());
        for frame in 0..3 {
            let [sky, max] = ["sky", "max"].map(|name| bench.load(&format!("{name}_{frame}.png")));
            assert!(eight_bits(&sky) == eight_bits(&max), "frame {frame}");
        }
        // A damaged picture of the second stream is missed, too.
        let mut bytes = bench.bytes("GS01.360");
        let at = bytes.windows(4).rposition(|name| name == b"IDAT").unwrap();
        bytes[at + 4..at + 8].fill(0x55);
        std::fs::write(bench.path("GS02.360"), bytes).unwrap();
        let output = bench.run(&[&["convert", "GS02.360", "no_#.png"], &panorama[..]].concat());
        assert_eq!(output.status.code(), Some(1));
        assert_says(&text(&output.stderr), &["GS02.360", "frame 2"]);
    }

    #[test]
    fn both_streams_of_insta360_lie_side_by_side() {
        if !has_ffmpeg() {
            return;
        }
        let bench = Bench::new();
        bench.succeed(&["convert", "builtin:demo", "two.png", "--to", "insta360", "--size", "128"]);
        film(&bench, "two.png", "VID_00.insv", ["128:128:0:0", "128:128:128:0"], &["-c:v", "png"]);
        let panorama = ["--to", "equirect", "--size", "128"];
        bench.succeed(&[&["convert", "two.png", "sky.png", "--from", "insta360"], &panorama[..]].concat());
        bench.succeed(&[&["convert", "VID_00.insv", "max.png", "--frames", "0"], &panorama[..]].concat());
        assert!(eight_bits(&bench.load("sky.png")) == eight_bits(&bench.load("max.png")));
        // Named otherwise, its first stream is a square picture like others.
        std::fs::copy(bench.path("VID_00.insv"), bench.path("square.mov")).unwrap();
        assert_says(&bench.succeed(&["info", "square.mov"]), &["width: 128", "height: 128"]);
    }
}
