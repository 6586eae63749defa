//! What forms of a world gain or lose of the light of real skies with a sun, by filter, in percent of all their light.
//!
//! `cargo run --release -p testkit --example light_kept`

use cosmorama::filter::{CrossSection, FilterSettings, Kernel};
use cosmorama::raster::{Rgba, Transfer};
use cosmorama::world::World;
use cosmorama_io::{Limits, read};
use testkit::{Form, LIGHT, Sky, equirect, shared};

/// Pixels a steradian of a panorama of 1024 × 512, the mean.
const DENSITY: f64 = 41_722.0;

const SKIES: [&str; 4] = ["chinese_garden", "noon_grass", "spiaggia_di_mondello", "rainforest_trail"];

/// From which form to which; what comes from a panorama is the file itself.
const PAIRS: [(&str, &str); 7] = [
    ("equirect", "cube"),
    ("equirect", "eac"),
    ("equirect", "octahedral"),
    ("equirect", "mirror-ball"),
    ("mirror-ball", "octahedral"),
    ("mollweide", "sinusoidal"),
    ("cube", "equirect"),
];

fn filters() -> [(&'static str, FilterSettings); 7] {
    let of = |kernel, anti_ringing| FilterSettings { kernel, anti_ringing, ..FilterSettings::DEFAULT };
    let gaussian = Kernel::uniform(CrossSection::Gaussian { alpha: 2.0, cutoff: 1.0 });
    [
        ("default", FilterSettings::DEFAULT),
        ("default, --anti-ringing off", of(Kernel::ADAPTIVE, false)),
        ("mitchell", of(Kernel::uniform(CrossSection::MITCHELL), true)),
        ("gaussian", of(gaussian, true)),
        ("box", of(Kernel::uniform(CrossSection::Box), true)),
        ("light, --anti-ringing on", of(Kernel::LIGHT, true)),
        ("light", LIGHT),
    ]
}

#[allow(clippy::print_stdout)] // An example may talk; the library may not.
fn main() {
    let Some(folder) = shared("data/equirect_hdr") else { return };
    let file = |name| {
        let path = folder.join(format!("polyhaven_{name}_1k.hdr"));
        let file = read(&path, &Limits::default()).expect("a sky");
        file.image.to_light(&Transfer::Linear).pixels().to_vec()
    };
    let skies: Vec<Vec<Rgba>> = SKIES.into_iter().map(file).collect();
    let panorama = World::new([("panorama".to_owned(), equirect(1024))]).expect("one view");
    let forms = Form::all(DENSITY);
    let form = |name| forms.iter().find(|form| form.name == name).expect("a form");
    for (from, to) in PAIRS {
        println!("\n| {from} → {to} | {} |", SKIES.join(" | "));
        let (world, skies) = if from == "equirect" {
            (panorama.clone(), skies.clone())
        } else {
            let sky = Sky::new(&panorama, form(from), FilterSettings::DEFAULT);
            (form(from).world(), skies.iter().map(|light| sky.light(light)).collect())
        };
        for (name, filter) in filters() {
            let sky = if filter == LIGHT { Sky::balanced } else { Sky::new }(&world, form(to), filter);
            let gains = skies.iter().map(|light| format!(" {:.3} |", 100.0 * sky.gain(&world, light)));
            println!("| `{name}` |{}", gains.collect::<String>());
        }
    }
}
