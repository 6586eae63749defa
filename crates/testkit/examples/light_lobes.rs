//! How near fast averages of light are to the sum over all texels, and what they cost.
//!
//! `cargo run --release -p testkit --example light_lobes` prints, for real skies and for grey with a single sun, relative
//! differences at 64×32 directions; it fails where they are more than docs/light.md promises. With `speed`, it prints CPU-seconds.

use std::process::ExitCode;

use cosmorama::camera::{CameraModel, CubeFaceCamera, EquirectCamera, Placement, View};
use cosmorama::lighting::{AllTexels, LightFigures, Lobe, LobeAverages, PreparedLight};
use cosmorama::raster::{Image, Rgba, Transfer};
use cosmorama::sphere::CubeFace;
use cosmorama::world::World;
use cosmorama_io::{Limits, read};
use cpu_time::ProcessTime;
use testkit::{equirect, shared};

/// Side of the blocks of texels of which one becomes a texel of the judged world: 1024 columns to 256.
const STEP: usize = 4;

struct Sky {
    name: String,
    width: usize,
    texels: Vec<Rgba>,
}

impl Sky {
    fn world(&self) -> World {
        World::new([("sky".to_owned(), equirect(self.width))]).expect("one view")
    }

    /// Takes each texel of another size from the nearest.
    fn sized(&self, width: usize) -> Self {
        let at = |k: usize| {
            let (i, j) = (k % width * self.width / width, k / width * self.width / width);
            self.texels[j * self.width + i]
        };
        Self { name: self.name.clone(), width, texels: (0..width * width / 2).map(at).collect() }
    }
}

fn skies() -> Vec<Sky> {
    let mut skies = Vec::new();
    for entry in shared("data/equirect_hdr").into_iter().flat_map(|folder| std::fs::read_dir(folder).expect("a folder"))
    {
        let path = entry.expect("an entry").path();
        let image = read(&path, &Limits::default()).expect("a sky").image.to_light(&Transfer::Linear);
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        skies.push(Sky { name, width: image.width(), texels: image.pixels().to_vec() });
    }
    skies.sort_by(|a, b| a.name.cmp(&b.name));
    let mut grey = vec![Rgba::opaque(0.18, 0.18, 0.18); 1024 * 512];
    grey[150 * 1024 + 310] = Rgba::opaque(250_000.0, 250_000.0, 250_000.0);
    skies.push(Sky { name: "grey with a sun".to_owned(), width: 1024, texels: grey });
    skies
}

fn lobes() -> Vec<(String, Lobe)> {
    let ggx = [0.02, 0.05, 0.1, 0.25, 0.5, 1.0].map(|alpha| (format!("ggx {alpha}"), Lobe::ggx(alpha)));
    let phong = [16.0, 64.0].map(|exponent| (format!("phong {exponent}"), Lobe::phong(exponent)));
    let charlie = [0.1, 0.5].map(|alpha| (format!("charlie {alpha}"), Lobe::charlie(alpha)));
    ggx.into_iter().chain(phong).chain(charlie).map(|(name, lobe)| (name, lobe.expect("in range"))).collect()
}

fn target(width: usize) -> View {
    CameraModel::from(EquirectCamera::default()).view(width, width / 2).expect("a panorama")
}

/// Largest and root mean square of relative differences.
fn differences(found: &Image<Rgba>, expected: &Image<Rgba>) -> (f64, f64) {
    let pairs = found.pixels().iter().zip(expected.pixels());
    let parts = pairs.flat_map(|(a, b)| (0..3).map(|channel| f64::from(a.0[channel]) / f64::from(b.0[channel]) - 1.0));
    let parts: Vec<f64> = parts.filter(|part| !part.is_nan()).collect();
    let squares: f64 = parts.iter().map(|part| part * part).sum();
    (parts.iter().fold(0.0, |worst, part| worst.max(part.abs())), (squares / parts.len() as f64).sqrt())
}

#[allow(clippy::print_stdout)] // An example may talk; the library may not.
fn accuracy() -> bool {
    let (target, mut is_near) = (target(64), true);
    let seen = World::new([("map".to_owned(), target.clone())]).expect("one view");
    println!("| sky | lobe | largest | rms | energy |");
    for sky in skies() {
        let sky = sky.sized(sky.width / STEP);
        let world = sky.world();
        for (name, lobe) in lobes() {
            let fast = PreparedLight::of_texels(&world, &sky.texels, &[lobe]);
            let found = fast.picture(&target, &lobe, Rgba::BLACK);
            let expected = AllTexels::of_texels(&world, &sky.texels).picture(&target, &lobe, Rgba::BLACK);
            let (worst, rms) = differences(&found, &expected);
            let mean = |image: &Image<Rgba>| LightFigures::of(&seen, image.pixels()).mean[1];
            let energy = mean(&found) / mean(&expected) - 1.0;
            println!("| {} | {name} | {worst:.1e} | {rms:.1e} | {energy:.1e} |", sky.name);
            is_near &= rms < 2e-3 && energy.abs() < 1e-3;
        }
    }
    is_near
}

/// Runs work, and prints its CPU-seconds.
#[allow(clippy::print_stdout)]
fn timed<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let start = ProcessTime::now();
    let made = work();
    println!("{what}: {:.3} CPU-s", start.elapsed().as_secs_f64());
    made
}

fn speed() {
    let skies = skies();
    let garden = skies.iter().find(|sky| sky.name.contains("garden")).expect("the garden");
    let face = |face: CubeFace, edge: usize| {
        let camera = Placement { orientation: face.orientation(), ..Placement::new(CameraModel::from(CubeFaceCamera)) };
        camera.view(edge, edge).expect("a face")
    };
    let (fine, large) = (garden.sized(2048), garden.sized(4096));
    for _ in 0..2 {
        let world = large.world();
        let light = timed("diffuse of 4096x2048: prepare", || {
            PreparedLight::of_texels(&world, &large.texels, &[Lobe::LAMBERT])
        });
        timed("diffuse of 4096x2048: 64x32", || light.picture(&target(64), &Lobe::LAMBERT, Rgba::BLACK));
        let world = fine.world();
        let alphas = [0.0625, 0.25, 0.5625, 1.0];
        let lobes = alphas.map(|alpha| Lobe::ggx(alpha).expect("in range"));
        let light = timed("chain of 2048x1024: prepare", || PreparedLight::of_texels(&world, &fine.texels, &lobes));
        for (lobe, edge) in lobes.iter().zip([128, 64, 32, 16]) {
            timed(&format!("chain of 2048x1024: faces of {edge}"), || {
                CubeFace::ALL.map(|side| light.picture(&face(side, edge), lobe, Rgba::BLACK))
            });
        }
        for alpha in [0.01, 0.005] {
            let lobe = Lobe::ggx(alpha).expect("in range");
            let light = timed(&format!("alpha {alpha} of 2048x1024: prepare"), || {
                PreparedLight::of_texels(&world, &fine.texels, &[lobe])
            });
            timed(&format!("alpha {alpha} of 2048x1024: faces of 128"), || {
                CubeFace::ALL.map(|side| light.picture(&face(side, 128), &lobe, Rgba::BLACK))
            });
        }
        let faces = World::new(CubeFace::ALL.map(|side| (side.name().to_owned(), face(side, 1024)))).expect("a cube");
        let texels = vec![Rgba::opaque(0.5, 0.25, 0.125); faces.texel_count()];
        timed("diffuse of faces of 1024: prepare", || {
            PreparedLight::of_texels(&faces, &texels, &[Lobe::LAMBERT]);
        });
    }
}

fn main() -> ExitCode {
    let is_well = if std::env::args().any(|arg| arg == "speed") {
        speed();
        true
    } else {
        accuracy()
    };
    if is_well { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
