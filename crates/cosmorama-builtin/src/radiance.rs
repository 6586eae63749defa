use cosmorama::sphere::Direction;

/// A world given by formula: how much light comes from each direction.
///
/// Linear light, Rec. 709 primaries, finite and never negative; 1 is the white of an integer image.
/// It is a point sample without any filter, so whoever makes pixels of it must average.
pub trait Radiance: Sync {
    /// Red, green and blue light that arrives from `direction`.
    fn radiance(&self, direction: Direction) -> [f32; 3];
}

impl<F: Fn(Direction) -> [f32; 3] + Sync> Radiance for F {
    fn radiance(&self, direction: Direction) -> [f32; 3] {
        self(direction)
    }
}
