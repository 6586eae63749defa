/// One of the three channels of colour. Grey goes by green where their curves differ.
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
    /// All three, in the order of [`super::Rgba`].
    pub const ALL: [Self; 3] = [Self::Red, Self::Green, Self::Blue];

    /// Its place among them.
    pub const fn index(self) -> usize {
        self as usize
    }
}
