//! `--filter ewa-pyramid`: how near to EWA, and at what cost.
//!
//! `cargo run --release -p testkit --example pyramid -- quality|shrink|size`; `-- count SIZE SHRINK ROWS` is for
//! `benches/speed`, which counts the instructions of [`counted`].

use std::f64::consts::PI;

use cosmorama::camera::View;
use cosmorama::filter::{FilterKind, FilterSettings};
use cosmorama::raster::{ColourChannel, Image, Rgba, Transfer};
use cosmorama::render::{Arithmetic, Plan, Resampler};
use cosmorama::sphere::CubeFace;
use cosmorama::world::World;
use cosmorama_io::{Limits, read};
use cpu_time::ProcessTime;
use testkit::{cube, equirect, fisheye, perspective, shared};

const PYRAMID: FilterSettings = FilterSettings { kind: FilterKind::EwaPyramid, ..FilterSettings::DEFAULT };

#[allow(clippy::print_stdout)] // An example may talk; the library may not.
fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["quality"] => quality(),
        ["shrink"] => shrink(),
        ["size"] => size(),
        ["count", size, shrink, rows] => {
            count(size.parse().expect("pixels"), shrink.parse().expect("texels a pixel"), rows.parse().expect("rows"));
        }
        _ => println!("quality, shrink, size, or count SIZE SHRINK ROWS?"),
    }
}

/// Six faces of the oracles' scene.
fn faces() -> Option<(World, Vec<Rgba>)> {
    let folder = shared("oracles/povray")?;
    let names = CubeFace::ALL.map(|face| match face.name() {
        "up" => "top",
        "down" => "bottom",
        name => name,
    });
    let file = |name| {
        let file = read(folder.join(format!("face_{name}.png")), &Limits::default()).expect("a face");
        file.image.to_light(&Transfer::Linear).pixels().to_vec()
    };
    Some((cube(&CubeFace::ALL, 1024, 1024), names.into_iter().flat_map(file).collect()))
}

/// Resamples a world into a panorama.
fn panorama((world, light): &(World, Vec<Rgba>)) -> (World, Vec<Rgba>) {
    let target = equirect(4096);
    let light = Resampler { world, target: &target, filter: FilterSettings::DEFAULT }.render(light);
    (World::new([("panorama".to_owned(), target)]).expect("one view"), light.pixels().to_vec())
}

/// A fulldome of which a pixel at the centre holds so many texels.
fn dome(texels_per_radian: f64, shrink: f64) -> View {
    fisheye((texels_per_radian * PI / shrink).round() as usize, 180.0)
}

fn psnr(a: &Image<Rgba>, b: &Image<Rgba>, target: &View, code: impl Fn(f64) -> f64) -> f64 {
    let (mut sum, mut count) = (0.0, 0usize);
    for (at, (a, b)) in a.pixels().iter().zip(b.pixels()).enumerate() {
        let whole = target.screen_pixel(at % target.width(), at / target.width());
        if whole.is_some_and(|screen| screen.coverage == 1.0) {
            sum += (0..3).map(|c| (code(f64::from(a.0[c])) - code(f64::from(b.0[c]))).powi(2)).sum::<f64>();
            count += 3;
        }
    }
    -10.0 * (sum / count as f64).log10()
}

#[allow(clippy::print_stdout)]
fn quality() {
    let Some(faces) = faces() else { return };
    let worlds = [("cube", 512.0, faces.clone()), ("panorama", 4096.0 / (2.0 * PI), panorama(&faces))];
    println!("| from | texels a pixel | PSNR against `ewa`, linear / encoded, dB |");
    println!("|---|---|---|");
    for (name, density, (world, light)) in &worlds {
        for shrink in [2.0, 4.0, 8.0, 16.0, 32.0, 64.0] {
            let target = dome(*density, shrink);
            let [exact, pyramid] = [FilterSettings::DEFAULT, PYRAMID]
                .map(|filter| Resampler { world, target: &target, filter }.render(light));
            let by_code = |code: fn(f64) -> f64| psnr(&exact, &pyramid, &target, code);
            let (linear, encoded) =
                (by_code(|light| light), by_code(|light| Transfer::Srgb.encode(light, ColourChannel::Green)));
            println!("| {name} | {shrink} | {linear:.1} / {encoded:.1} |");
        }
    }
}

/// The CPU-seconds of the fastest of three.
fn timed<T>(mut what: impl FnMut() -> T) -> (f64, T) {
    let mut once = || {
        let start = ProcessTime::now();
        let made = what();
        (start.elapsed().as_secs_f64(), made)
    };
    let mut best = once();
    for _ in 0..2 {
        let next = once();
        if next.0 < best.0 {
            best = next;
        }
    }
    best
}

/// Noise: filters do not look at light, but memory does.
fn noise(world: &World) -> Vec<Rgba> {
    let value = |at: usize| (at.wrapping_mul(2_654_435_761) >> 9 & 1023) as f32 / 1023.0;
    (0..world.texel_count()).map(|at| Rgba::opaque(value(at), value(at + 7), value(at + 31))).collect()
}

/// The upper part of a picture, in the same pixels.
fn upper(view: &View, rows: usize) -> View {
    View { grid: view.grid.window(view.width(), rows, 0.0, 0.0), ..view.clone() }
}

/// A cube of which a pixel of [`view`] holds so many texels.
fn cube_for(size: usize, shrink: f64) -> World {
    let edge = (size as f64 * shrink).round() as usize;
    cube(&CubeFace::ALL, edge, edge)
}

/// A turned view of 90°, in which nothing is mirrored.
fn view(size: usize) -> View {
    perspective(size, size, 90.0, 20.0, 30.0, 10.0)
}

/// What that costs.
#[allow(clippy::print_stdout)]
fn cost_line(size: usize, shrink: f64) {
    let (world, target) = (cube_for(size, shrink), view(size));
    let edge = world.sources()[0].view.width();
    let light = noise(&world);
    // What half of the picture costs less is the price of its pixels; the rest is that of the pyramid.
    let half = upper(&target, size / 2);
    let pixels = (size * size / 2) as f64;
    let of = |filter, target| Resampler { world: &world, target, filter };
    let (exact, _) = timed(|| of(FilterSettings::DEFAULT, &target).render(&light));
    let (cold, _) = timed(|| of(PYRAMID, &target).render(&light));
    let [warm, half] = [&target, &half].map(|target| {
        let plan = of(PYRAMID, target).plan(Arithmetic::Float).expect("a pyramid");
        timed(|| plan.apply(&light)).0
    });
    let (a_pixel, levels) = ((warm - half) / pixels * 1e9, 2.0 * half - warm);
    println!("| {size} | {shrink} | {edge} | {exact:.2} | {cold:.2} | {warm:.3} | {levels:.3} | {a_pixel:.0} |");
}

#[allow(clippy::print_stdout)]
fn heading() {
    println!(
        "| size | texels a pixel | faces | `ewa` | `ewa-pyramid` | by plan | of it the levels | a pixel by plan, ns |"
    );
    println!("|---|---|---|---|---|---|---|---|");
}

fn shrink() {
    heading();
    for (size, shrink) in [(512, 1.0), (512, 1.4), (512, 2.0), (512, 2.8), (512, 4.0), (256, 5.6), (256, 8.0)] {
        cost_line(size, shrink);
    }
    for (size, shrink) in [(128, 11.3), (128, 16.0), (64, 22.6), (64, 32.0), (32, 64.0)] {
        cost_line(size, shrink);
    }
}

fn size() {
    heading();
    for size in [256, 512, 1024] {
        cost_line(size, 2.8);
    }
}

/// One planned frame of the first rows of [`view`], on one thread.
fn count(size: usize, shrink: f64, rows: usize) {
    let (world, target) = (cube_for(size, shrink), upper(&view(size), rows));
    let light = noise(&world);
    let plan =
        Resampler { world: &world, target: &target, filter: PYRAMID }.plan(Arithmetic::Float).expect("a pyramid");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    pool.install(|| counted(&plan, &light));
}

/// A function of its own, for callgrind to know it by its name.
#[inline(never)]
fn counted(plan: &Plan, light: &[Rgba]) {
    std::hint::black_box(plan.apply(light));
}
