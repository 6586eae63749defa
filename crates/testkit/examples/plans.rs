//! What planned frames and stills cost, for `benches/speed`, which makes tables of what this prints.
//!
//! `cargo run --release -p testkit --example plans -- threads SIZE` gives seconds and CPU-seconds on one thread and on two of 8 bits,
//! `-- sizes SIZE…` CPU-nanoseconds a pixel of domes of these sizes, and `-- turns SIZE [POSE]` CPU-seconds of a frame on one thread
//! for each line that it reads, `8 bits` or `floats` by plan or `still`, so that other programs can take turns with it. Asked for
//! `bytes`, it tells those of the plan of 8 bits. The domes are [`testkit::Dome`]'s, upright, or with `general` tilted and turned;
//! with `view` it is a view of 1920 × 1080 from the dome's faces.
#![allow(clippy::print_stdout, reason = "a program that says what it measures")]

use std::cell::LazyCell;
use std::io::BufRead;
use std::sync::Mutex;
use std::time::Instant;

use cosmorama::raster::{Image, Rgba};
use cosmorama::render::{Arithmetic, Plan};
use cpu_time::ProcessTime;
use rayon::{ThreadPool, ThreadPoolBuilder};
use testkit::{Dome, perspective, turned};

/// How often two pools are measured, by turns.
const ROUNDS: usize = 9;

/// Pixels that are made of each size, about, as far as [`LEAST`] and [`MOST`] rounds go.
const PIXELS: usize = 80_000_000;
const LEAST: usize = 3;
const MOST: usize = 101;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let sizes = |texts: &[String]| texts.iter().map(|text| text.parse().expect("pixels across")).collect::<Vec<_>>();
    match arguments.split_first() {
        Some((what, rest)) if what == "threads" => sizes(rest).into_iter().for_each(threads),
        Some((what, rest)) if what == "sizes" => sizes(rest).into_iter().for_each(size),
        Some((what, [size, pose @ ..])) if what == "turns" => {
            turns(Dome::new(size.parse().expect("pixels across")), pose.first().map(String::as_str));
        }
        _ => println!("threads SIZE, sizes SIZE… or turns SIZE [general|view]?"),
    }
}

/// What one run took: seconds, and seconds of all threads.
#[derive(Clone, Copy)]
struct Cost {
    wall: f64,
    cpu: f64,
}

fn cost<T>(work: impl FnOnce() -> T) -> (Cost, T) {
    let (wall, cpu) = (Instant::now(), ProcessTime::now());
    let made = work();
    (Cost { wall: wall.elapsed().as_secs_f64(), cpu: cpu.elapsed().as_secs_f64() }, made)
}

/// Of each figure by itself.
fn median(costs: &[Cost]) -> Cost {
    let of = |figure: fn(&Cost) -> f64| {
        let mut figures: Vec<f64> = costs.iter().map(figure).collect();
        figures.sort_by(f64::total_cmp);
        figures[figures.len() / 2]
    };
    Cost { wall: of(|cost| cost.wall), cpu: of(|cost| cost.cpu) }
}

/// Frames that are made by a plan, all into one image.
struct Frames<'a> {
    dome: &'a Dome,
    plan: &'a Plan,
    image: Mutex<Image<[u8; 3]>>,
}

impl<'a> Frames<'a> {
    fn new(dome: &'a Dome, plan: &'a Plan) -> Self {
        Self { dome, plan, image: Mutex::new(plan.apply_fixed(&dome.light, &dome.codec)) }
    }

    fn next(&self) {
        let mut image = self.image.lock().expect("nobody fails");
        self.plan.apply_fixed_into(&self.dome.light, &self.dome.codec, &mut image);
    }
}

fn still(dome: &Dome) {
    drop(dome.resampler().render_fixed(&dome.light, &dome.codec));
}

/// A line of CPU-seconds for each that is read, after one that says that there will be.
fn turns(mut dome: Dome, pose: Option<&str>) {
    match pose {
        None => {}
        // A tilt of 20°, a yaw of 33° and a roll of 7°.
        Some("general") => dome.target.orientation = turned([33.0, 70.0, 7.0]),
        Some("view") => dome.target = perspective(1920, 1080, 50.0, 33.0, 20.0, 7.0),
        Some(other) => panic!("general or view, not {other}"),
    }
    let plan = LazyCell::new(|| dome.resampler().plan(Arithmetic::Fixed).expect("a plan"));
    let frames = LazyCell::new(|| Frames::new(&dome, &plan));
    let floats = LazyCell::new(|| {
        let texels: Vec<Rgba> = (0..dome.world.texel_count()).map(|texel| dome.light.rgba(texel)).collect();
        let plan = dome.resampler().plan(Arithmetic::Float).expect("a plan");
        let image = Mutex::new(plan.apply(&texels));
        (texels, plan, image)
    });
    let pool = ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    println!("ready");
    for line in std::io::stdin().lock().lines() {
        let (cost, ()) = match line.expect("lines of text").as_str() {
            "8 bits" => {
                let frames = &*frames;
                cost(|| pool.install(|| frames.next()))
            }
            "floats" => {
                let (texels, plan, image) = &*floats;
                let work = || plan.apply_into(texels, Rgba::BLACK, &mut image.lock().expect("nobody fails"));
                cost(|| pool.install(work))
            }
            "still" => cost(|| pool.install(|| still(&dome))),
            "bytes" => {
                println!("{}", plan.bytes());
                continue;
            }
            other => panic!("8 bits, floats, still or bytes, not {other}"),
        };
        println!("{}", cost.cpu);
    }
}

/// Lines of: what, threads, seconds, CPU-seconds.
fn threads(size: usize) {
    let dome = Dome::new(size);
    let plan = dome.resampler().plan(Arithmetic::Fixed).expect("a plan");
    let pool = |threads| ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let pools: Vec<(usize, ThreadPool)> = [1, 2].map(|threads| (threads, pool(threads))).into();
    let taking_turns = |name: &str, work: &(dyn Fn() + Sync)| {
        let mut costs = vec![Vec::new(); pools.len()];
        // The first turn finds neither memory nor threads awake.
        for turn in 0..=ROUNDS {
            for ((_, pool), costs) in pools.iter().zip(&mut costs) {
                let (cost, ()) = cost(|| pool.install(work));
                costs.extend((turn > 0).then_some(cost));
            }
        }
        for ((threads, _), costs) in pools.iter().zip(&costs) {
            let Cost { wall, cpu } = median(costs);
            println!("{name}\t{threads}\t{wall}\t{cpu}");
        }
    };
    let frames = Frames::new(&dome, &plan);
    taking_turns("frame by plan", &|| frames.next());
    taking_turns("still", &|| still(&dome));
}

/// A line of: size, bytes of the plan for a pixel, CPU-nanoseconds for a pixel of making it, of a frame by it, and of a still.
fn size(size: usize) {
    let dome = Dome::new(size);
    let pixels = dome.pixels();
    let rounds = (PIXELS / pixels).clamp(LEAST, MOST);
    let nanoseconds = |costs: &[Cost]| median(costs).cpu / pixels as f64 * 1e9;
    let repeated = |work: &dyn Fn()| nanoseconds(&(0..rounds).map(|_| cost(work).0).collect::<Vec<_>>());
    let (making, plan) = cost(|| dome.resampler().plan(Arithmetic::Fixed).expect("a plan"));
    let bytes = plan.bytes() as f64 / pixels as f64;
    let frames = Frames::new(&dome, &plan);
    let by_plan = repeated(&|| frames.next());
    drop(frames);
    drop(plan);
    let still = repeated(&|| still(&dome));
    println!("{size}\t{bytes}\t{}\t{by_plan}\t{still}", nanoseconds(&[making]));
}
