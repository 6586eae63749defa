use crate::sphere::{CubeFace, Direction};

/// How a picture has to be turned to be the face that CONVENTIONS draws: as seen by a camera at the centre, the up face's
/// bottom edge and the down face's top edge touching the front.
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

    /// A picture that was itself turned clockwise, by so many quarters, from how the face is drawn.
    pub const fn turned(quarter_turns: u8) -> Self {
        Self { quarter_turns: (4 - quarter_turns % 4) % 4, mirrored: false }
    }

    /// The directions to the right and up in the picture as it is.
    pub fn axes(self, face: CubeFace) -> (Direction, Direction) {
        let (right, up) = (face.right(), face.up());
        let (right, up) = match self.quarter_turns % 4 {
            0 => (right, up),
            1 => (up.opposite(), right),
            2 => (right.opposite(), up.opposite()),
            _ => (up, right.opposite()),
        };
        (if self.mirrored { right.opposite() } else { right }, up)
    }
}
