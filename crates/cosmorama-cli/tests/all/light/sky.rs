//! Panoramas to take light from.

use cosmorama::raster::{Channels, Depth, EncodedImage, Image, Rgba, Transfer};

use crate::bench::Bench;

/// A panorama in floats.
pub(super) fn save_sky(bench: &Bench, name: &str, width: usize, light: impl Fn(usize, usize) -> [f32; 3]) {
    let picture = Image::from_fn(width, width / 2, |i, j| {
        let [red, green, blue] = light(i, j);
        Rgba::opaque(red, green, blue)
    });
    bench.save(name, &EncodedImage::encode(&picture, Channels::Rgb, Depth::Float, &Transfer::Linear));
}

/// Red, green and blue of a picture.
pub(super) fn light(bench: &Bench, name: &str) -> Vec<[f32; 3]> {
    let light = bench.load(name).to_light(&Transfer::Linear);
    light.pixels().iter().map(|Rgba([red, green, blue, _])| [*red, *green, *blue]).collect()
}
