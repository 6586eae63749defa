/// One of the three colour channels. Grey uses green's curve where curves differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ColourChannel {
    /// Red.
    Red,
    /// Green.
    Green,
    /// Blue.
    Blue,
}

impl ColourChannel {
    /// All three, in the order of [`Rgba`](crate::raster::Rgba).
    pub const ALL: [Self; 3] = [Self::Red, Self::Green, Self::Blue];

    /// Returns its index in [`Rgba`](crate::raster::Rgba).
    pub const fn index(self) -> usize {
        self as usize
    }
}
