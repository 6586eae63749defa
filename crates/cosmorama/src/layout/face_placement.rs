use crate::sphere::{Angle, CubeFace, Direction, Orientation};

/// Rotation and mirroring that turn a picture into an upright face. Upright faces are drawn in `docs/conventions.md`:
/// the up face's bottom edge and the down face's top edge touch the front.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct FacePlacement {
    /// Clockwise quarter turns of the picture, 0 to 3, applied after mirroring.
    pub quarter_turns: u8,
    /// Whether left and right are exchanged first.
    pub mirrored: bool,
}

impl FacePlacement {
    /// The picture is upright already.
    pub const UPRIGHT: Self = Self { quarter_turns: 0, mirrored: false };
    /// The picture is upside down.
    pub const HALF_TURN: Self = Self { quarter_turns: 2, mirrored: false };

    /// Returns the placement of a picture that was itself turned clockwise by so many quarters.
    pub const fn turned(quarter_turns: u8) -> Self {
        Self { quarter_turns: (4 - quarter_turns % 4) % 4, mirrored: false }
    }

    /// Returns the orientation of the camera that takes a face's picture before it is turned. A picture that has to be turned
    /// clockwise was taken by a camera that was itself turned clockwise.
    pub fn orientation(self, face: CubeFace) -> Orientation {
        let turn = Angle::from_degrees(90.0 * f64::from(self.quarter_turns));
        Orientation::from_yaw_pitch_roll(Angle::ZERO, Angle::ZERO, turn).within(face.orientation())
    }

    /// Returns the directions to the right and up in the picture before it is turned.
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
