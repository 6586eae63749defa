//! What forms of a world gain or lose of the light of a small sun by `--kernel light`, where that is hardest to keep: at poles, at
//! seams, at the edges and corners of faces. Before and after its light is brought into balance, in percent, the most of all
//! places; and how far from constant a constant world is then.
//!
//! `cargo run --release -p testkit --example light_balance`

use cosmorama::raster::Rgba;
use cosmorama::world::World;
use testkit::{Form, HARD_PLACES, LIGHT, Sky, equirect_density, sun};

const PAIRS: [(&str, &str); 12] = [
    ("equirect", "cube"),
    ("equirect", "octahedral"),
    ("equirect", "mirror-ball"),
    ("cube", "equirect"),
    ("cube", "octahedral"),
    ("cube", "sinusoidal"),
    ("octahedral", "cube"),
    ("octahedral", "equirect"),
    ("eac", "cube"),
    ("mirror-ball", "equirect"),
    ("mollweide", "sinusoidal"),
    ("hammer", "octahedral"),
];

#[allow(clippy::print_stdout)] // An example may talk; the library may not.
fn main() {
    let density = equirect_density(1024);
    let forms = Form::all(density);
    let form = |name| forms.iter().find(|form| form.name == name).expect("a form");
    println!("| | before | in balance | a constant world: worst pixel | rms |\n|---|---|---|---|---|");
    for (from, to) in PAIRS {
        let world: World = form(from).world();
        let suns = HARD_PLACES.map(|place| sun(&world, place, density.sqrt().recip()));
        let most = |sky: &Sky| suns.iter().map(|sun| 100.0 * sky.gain(&world, sun)).fold(0.0, larger);
        let (plain, balanced) = (Sky::new(&world, form(to), LIGHT), Sky::balanced(&world, form(to), LIGHT));
        let (worst, rms) = ripples(&balanced.light(&vec![Rgba::opaque(1.0, 1.0, 1.0); world.texel_count()]));
        let [worst, rms] = [worst, rms].map(|part| 100.0 * part);
        println!("| {from} → {to} | {:.2} | {:.3} | {worst:.2} | {rms:.3} |", most(&plain), most(&balanced));
    }
}

fn larger(a: f64, b: f64) -> f64 {
    if b.abs() > a.abs() { b } else { a }
}

/// How far from one pixels are, at most and on average.
fn ripples(light: &[Rgba]) -> (f64, f64) {
    let off: Vec<f64> =
        light.iter().filter(|pixel| pixel.alpha() > 0.0).map(|pixel| f64::from(pixel.0[0]) - 1.0).collect();
    let squares: f64 = off.iter().map(|off| off * off).sum();
    (off.iter().fold(0.0, |most: f64, off| most.max(off.abs())), (squares / off.len() as f64).sqrt())
}
