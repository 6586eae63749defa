use std::fmt;

use super::Pose;
use crate::sphere::CubeFace;

/// A change to pictures that are on wrong faces, or lie wrongly on their faces. A picture is named by its declared
/// face.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Change {
    /// Two pictures are exchanged.
    Swapped(CubeFace, CubeFace),
    /// A picture belongs to another face than declared.
    Moved {
        /// Declared face.
        from: CubeFace,
        /// Actual face.
        to: CubeFace,
    },
    /// A picture has to be turned clockwise.
    Turned {
        /// Face of the picture.
        face: CubeFace,
        /// Number of clockwise quarter turns.
        quarter_turns: u8,
    },
    /// A picture is mirrored, and must then be turned clockwise.
    Mirrored {
        /// Face of the picture.
        face: CubeFace,
        /// Number of clockwise quarter turns.
        quarter_turns: u8,
    },
}

/// Finds the changes that convert one arrangement of pictures to another.
///
/// # Panics
/// When the two arrangements differ in their number of pictures.
pub fn changes(given: &[Pose], wanted: &[Pose]) -> Vec<Change> {
    assert_eq!(given.len(), wanted.len(), "a pose for each picture");
    let mut changes: Vec<Change> = Vec::new();
    let goes = |face: CubeFace| given.iter().position(|pose| pose.face == face).map(|at| wanted[at].face);
    for (from, to) in given.iter().zip(wanted).map(|(given, wanted)| (given.face, wanted.face)) {
        if from == to {
            continue;
        }
        if goes(to) != Some(from) {
            changes.push(Change::Moved { from, to });
        } else if !changes.contains(&Change::Swapped(to, from)) {
            changes.push(Change::Swapped(from, to));
        }
    }
    changes.extend(given.iter().zip(wanted).filter_map(|(given, wanted)| turn(*given, *wanted)));
    changes
}

/// Returns the rotation or mirroring that a picture on its own face still needs.
fn turn(given: Pose, wanted: Pose) -> Option<Change> {
    let (face, lies, should) = (given.face, given.placement(), wanted.placement());
    if lies.mirrored == should.mirrored {
        let quarter_turns = (should.quarter_turns + 4 - lies.quarter_turns) % 4;
        (quarter_turns > 0).then_some(Change::Turned { face, quarter_turns })
    } else {
        // A reflection after a turn is a turn the other way after the reflection.
        Some(Change::Mirrored { face, quarter_turns: (should.quarter_turns + lies.quarter_turns) % 4 })
    }
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let degrees = |quarter_turns: &u8| 90 * u32::from(*quarter_turns);
        match self {
            Self::Swapped(a, b) => write!(f, "{a} and {b} are swapped"),
            Self::Moved { from, to } => write!(f, "what is given as {from} is {to}"),
            Self::Turned { face, quarter_turns } => {
                write!(f, "{face} has to be turned clockwise by {} degrees", degrees(quarter_turns))
            }
            Self::Mirrored { face, quarter_turns: 0 } => write!(f, "{face} is mirrored left to right"),
            Self::Mirrored { face, quarter_turns: 2 } => write!(f, "{face} is mirrored top to bottom"),
            Self::Mirrored { face, quarter_turns } => write!(
                f,
                "{face} is mirrored left to right, and then has to be turned clockwise by {} degrees",
                degrees(quarter_turns)
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::FacePlacement;

    fn cube() -> Vec<Pose> {
        CubeFace::ALL.map(|face| Pose::new(face, FacePlacement::UPRIGHT)).to_vec()
    }

    fn told(given: &[Pose], wanted: &[Pose]) -> Vec<String> {
        changes(given, wanted).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn changes_are_told_in_words() {
        let given = cube();
        let mut wanted = cube();
        wanted.swap(1, 3);
        wanted[4] = Pose::new(CubeFace::Up, FacePlacement { quarter_turns: 1, mirrored: false });
        wanted[5] = Pose::new(CubeFace::Down, FacePlacement { quarter_turns: 2, mirrored: true });
        assert_eq!(
            told(&given, &wanted),
            [
                "right and left are swapped",
                "up has to be turned clockwise by 90 degrees",
                "down is mirrored top to bottom"
            ]
        );
        assert_eq!(told(&given, &given), [""; 0]);
        let mut cycle = cube();
        cycle[..3].rotate_left(1);
        assert_eq!(told(&given, &cycle).len(), 3);
    }
}
