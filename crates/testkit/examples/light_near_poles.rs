//! What forms of a world gain or lose of the light of a small sun near a pole, or near the seam behind, by `--kernel light`: in
//! percent, the most of three longitudes or latitudes.
//!
//! `cargo run --release -p testkit --example light_near_poles`

use cosmorama::raster::Rgba;
use cosmorama::resample::{Filter, Kernel};
use cosmorama::sphere::Direction;
use cosmorama::world::{PixelPoint, World};
use testkit::{Form, Sky};

/// Pixels a steradian of a panorama of 1024 × 512, the mean.
const DENSITY: f64 = 41_722.0;

const PAIRS: [(&str, &str); 6] = [
    ("equirect", "cube"),
    ("cube", "equirect"),
    ("cube", "sinusoidal"),
    ("mollweide", "cube"),
    ("mollweide", "sinusoidal"),
    ("hammer", "octahedral"),
];

/// How far the sun is, in the mean pixel's width.
const PIXELS: [f64; 6] = [4.0, 8.0, 16.0, 32.0, 64.0, 128.0];

/// Whence it is so far.
const PLACES: [&str; 2] = ["the pole", "the seam"];

fn direction(longitude: f64, latitude: f64) -> Direction {
    let (along, up) = (latitude.cos(), latitude.sin());
    let vector = [along * longitude.sin(), up, -along * longitude.cos()];
    Direction::new(vector.into()).expect("not nothing")
}

/// Suns so far from a pole or from the seam.
fn suns(place: &str, distance: f64) -> [Direction; 3] {
    use std::f64::consts::{FRAC_PI_2, PI};
    if place == PLACES[0] {
        [-71.0_f64, 20.0, 110.0].map(|longitude| direction(longitude.to_radians(), FRAC_PI_2 - distance))
    } else {
        [0.0_f64, 30.0, 60.0].map(|latitude| {
            let latitude = latitude.to_radians();
            direction(PI - distance / latitude.cos(), latitude)
        })
    }
}

/// The light of a sun a pixel wide, and next to nothing around it.
fn sky(form: &Form, sun: Direction, pixel: f64) -> Vec<Rgba> {
    let texels = form.views.iter().flat_map(|view| {
        (0..view.height()).flat_map(move |j| (0..view.width()).map(move |i| view.direction(PixelPoint::centre(i, j))))
    });
    let light = |texel: Option<Direction>| {
        let light = texel.map_or(0.0, |texel| {
            let distance = texel.vector().distance(sun.vector()) / pixel;
            (1e5 * (-0.5 * distance * distance).exp() + 1e-6) as f32
        });
        Rgba::opaque(light, light, light)
    };
    texels.map(light).collect()
}

#[allow(clippy::print_stdout)] // An example may talk; the library may not.
fn main() {
    let filter = Filter { kernel: Kernel::LIGHT, anti_ringing: false, ..Filter::DEFAULT };
    let forms = Form::all(DENSITY);
    let form = |name| forms.iter().find(|form| form.name == name).expect("a form");
    let pixel = DENSITY.sqrt().recip();
    for place in PLACES {
        println!("\n| pixels from {place} | {} |", PIXELS.map(|pixels| pixels.to_string()).join(" | "));
        println!("|---|{}", "---|".repeat(PIXELS.len()));
        for (from, to) in PAIRS {
            let world: World = form(from).world();
            let made = Sky::new(&world, form(to), filter);
            let gain = |pixels: f64| {
                let gains = suns(place, pixels * pixel).map(|sun| made.gain(&world, &sky(form(from), sun, pixel)));
                gains.into_iter().fold(0.0, |most: f64, gain| if gain.abs() > most.abs() { gain } else { most })
            };
            let gains = PIXELS.map(|pixels| format!(" {:.2} |", 100.0 * gain(pixels)));
            println!("| {from} → {to} |{}", gains.concat());
        }
    }
}
