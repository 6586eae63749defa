/// How a file's picture has to be turned to be the face that CONVENTIONS draws: as seen by a camera at the
/// centre, the up face's bottom edge and the down face's top edge touching the front.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct FacePlacement {
    /// Quarter turns of the picture, clockwise, 0 to 3; after mirroring.
    pub quarter_turns: u8,
    /// Whether left and right are to be exchanged first.
    pub mirrored: bool,
}

impl FacePlacement {
    /// As it is.
    pub const UPRIGHT: Self = Self { quarter_turns: 0, mirrored: false };
    /// Turned upside down, by a half turn.
    pub const HALF_TURN: Self = Self { quarter_turns: 2, mirrored: false };
}
