//! What real skies with a sun keep of their light in another form, at as many pixels.

use cosmorama::raster::{Rgba, Transfer};
use cosmorama::resample::{Filter, Kernel};
use cosmorama::world::World;
use cosmorama_io::{Limits, read};
use testkit::{Form, Sky, equirect, shared};

/// A sun of one texel is kept by a kernel whose weights add to one over pixels too: a wide one, positive and smooth.
#[test]
fn suns_keep_their_light() {
    let Some(folder) = shared("data/equirect_hdr") else { return };
    let suns = ["chinese_garden", "noon_grass", "spiaggia_di_mondello"].map(|name| {
        let path = folder.join(format!("polyhaven_{name}_1k.hdr"));
        let light: Vec<Rgba> =
            read(&path, &Limits::default()).expect("a sky").image.to_light(&Transfer::Linear).pixels().to_vec();
        (name, light)
    });
    let filter = Filter { kernel: Kernel::LIGHT, anti_ringing: false, ..Filter::DEFAULT };
    let panorama = World::new([("panorama".to_owned(), equirect(1024))]).expect("one view");
    let density = (1024 * 512) as f64 / (4.0 * std::f64::consts::PI);
    for form in Form::all(density).iter().filter(|form| ["cube", "octahedral", "mirror-ball"].contains(&form.name)) {
        let sky = Sky::new(&panorama, form, filter);
        for (name, light) in &suns {
            let gain = sky.gain(&panorama, light);
            assert!(gain.abs() < 0.002, "{name} as {}: {gain}", form.name);
        }
    }
}
