use cosmorama::camera::Footprint;
use cosmorama::sphere::Direction;

/// A world given by formula: how much light comes from each direction.
///
/// Light is linear, in Rec. 709 primaries, finite and never negative; 1 is the white of an integer image. It is a point
/// sample without any filter, so a renderer must average.
pub trait Radiance: Sync {
    /// Returns the red, green and blue light that arrives from `direction`.
    fn radiance(&self, direction: Direction) -> [f32; 3];

    /// Returns the mean light over a pixel, weighted by exp(−2r²) with r in pixels from its centre, if a formula gives
    /// it.
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

/// Mean light of a pixel, as far as a formula gives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Average {
    /// The mean light.
    Known([f32; 3]),
    /// The light varies a lot within the pixel, so many samples are needed.
    Intricate,
    /// Nothing is known, so samples must tell how many are needed.
    Unknown,
}
