/// A side of a picture, clockwise from the top. Its samples run clockwise, too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Left to right.
    Top,
    /// Top to bottom.
    Right,
    /// Right to left.
    Bottom,
    /// Bottom to top.
    Left,
}

impl Side {
    /// All four sides.
    pub const ALL: [Self; 4] = [Self::Top, Self::Right, Self::Bottom, Self::Left];
}
