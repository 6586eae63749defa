use super::{Direction, Orientation};

/// One of the six faces of the cube around the world's centre.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum CubeFace {
    /// The face towards −Z.
    Front,
    /// The face towards +X.
    Right,
    /// The face towards +Z.
    Back,
    /// The face towards −X.
    Left,
    /// The face towards +Y; its bottom edge touches the front face's top edge.
    Up,
    /// The face towards −Y; its top edge touches the front face's bottom edge.
    Down,
}

impl CubeFace {
    /// All six faces, in the project's own order.
    pub const ALL: [Self; 6] = [Self::Front, Self::Right, Self::Back, Self::Left, Self::Up, Self::Down];

    /// Returns the project's own name of the face, in lower case.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::Right => "right",
            Self::Back => "back",
            Self::Left => "left",
            Self::Up => "up",
            Self::Down => "down",
        }
    }

    /// Returns the direction in which the face's camera looks.
    pub const fn forward(self) -> Direction {
        match self {
            Self::Front => Direction::FRONT,
            Self::Right => Direction::RIGHT,
            Self::Back => Direction::BACK,
            Self::Left => Direction::LEFT,
            Self::Up => Direction::UP,
            Self::Down => Direction::DOWN,
        }
    }

    /// Returns the direction to the right in the face's image.
    pub const fn right(self) -> Direction {
        match self {
            Self::Front | Self::Up | Self::Down => Direction::RIGHT,
            Self::Right => Direction::BACK,
            Self::Back => Direction::LEFT,
            Self::Left => Direction::FRONT,
        }
    }

    /// Returns the direction up in the face's image.
    pub const fn up(self) -> Direction {
        match self {
            Self::Front | Self::Right | Self::Back | Self::Left => Direction::UP,
            Self::Up => Direction::BACK,
            Self::Down => Direction::FRONT,
        }
    }

    /// Returns the orientation of the face's camera.
    pub fn orientation(self) -> Orientation {
        Orientation::from_axes(self.right(), self.up(), self.forward())
    }

    /// Returns the face through which a direction passes. On an edge the face named first in [`CubeFace::ALL`] wins.
    pub fn of(direction: Direction) -> Self {
        let mut best = Self::Front;
        for face in Self::ALL {
            if direction.dot(face.forward()) > direction.dot(best.forward()) {
                best = face;
            }
        }
        best
    }
}

impl std::fmt::Display for CubeFace {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_face_is_right_handed_and_owns_its_own_axis() {
        for face in CubeFace::ALL {
            let handedness = face.right().vector().cross(face.up().vector());
            assert_eq!(handedness, -face.forward().vector(), "{face}");
            assert_eq!(CubeFace::of(face.forward()), face);
        }
    }
}
