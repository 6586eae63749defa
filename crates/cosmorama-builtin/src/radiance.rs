use cosmorama::camera::Footprint;
use cosmorama::sphere::Direction;

/// A world given by formula: how much light comes from each direction.
///
/// Linear light, Rec. 709 primaries, finite and never negative; 1 is the white of an integer image.
/// It is a point sample without any filter, so whoever makes pixels of it must average.
pub trait Radiance: Sync {
    /// Red, green and blue light that arrives from `direction`.
    fn radiance(&self, direction: Direction) -> [f32; 3];

    /// The mean of the light over a pixel, weighted by exp(−2r²), r in pixels from its middle, as far as the formula
    /// gives it.
    fn average(&self, pixel: &Footprint) -> Average {
        let _ = pixel;
        Average::Unknown
    }
}

impl<F: Fn(Direction) -> [f32; 3] + Sync> Radiance for F {
    fn radiance(&self, direction: Direction) -> [f32; 3] {
        self(direction)
    }
}

/// What a formula knows of the light of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Average {
    /// Its mean.
    Known([f32; 3]),
    /// That it changes a lot within the pixel: many samples have to be averaged.
    Intricate,
    /// Nothing: some samples have to tell how many are needed.
    Unknown,
}
