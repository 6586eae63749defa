use super::Side;
use crate::layout::FacePlacement;
use crate::sphere::CubeFace;

/// Pose of a picture on the cube: its face, and the faces to which its right and upper side point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pose {
    /// Face of the picture.
    pub face: CubeFace,
    /// Face to which the picture's right side points.
    right: CubeFace,
    /// Face to which the picture's upper side points.
    up: CubeFace,
}

impl Pose {
    /// Creates the pose of a face's picture from the rotation that makes it upright.
    pub fn new(face: CubeFace, lies: FacePlacement) -> Self {
        let (right, up) = lies.axes(face);
        Self { face, right: CubeFace::of(right), up: CubeFace::of(up) }
    }

    /// Returns the eight poses on a face: four rotations, plain and mirrored.
    pub fn all_of(face: CubeFace) -> [Self; 8] {
        std::array::from_fn(|k| Self::new(face, FacePlacement { quarter_turns: k as u8 % 4, mirrored: k >= 4 }))
    }

    /// Returns the rotation and mirroring that make the picture upright.
    pub fn placement(self) -> FacePlacement {
        let mirrored = self.is_mirrored();
        let fits = |turns: &u8| Self::new(self.face, FacePlacement { quarter_turns: *turns, mirrored }) == self;
        FacePlacement { quarter_turns: (0..4).find(fits).unwrap_or_default(), mirrored }
    }

    /// Returns whether the picture is mirrored.
    pub fn is_mirrored(self) -> bool {
        let handedness = self.right.forward().vector().cross(self.up.forward().vector());
        handedness.dot(self.face.forward().vector()) > 0.0
    }

    /// Returns the side of the picture that touches a neighbouring face; `None` for the face itself and the opposite
    /// one.
    pub fn side_towards(self, other: CubeFace) -> Option<Side> {
        let sides = [(self.up, Side::Top), (self.right, Side::Right)];
        let near = |(axis, side): (CubeFace, Side)| (axis == other).then_some(side);
        let far = [(opposite(self.up), Side::Bottom), (opposite(self.right), Side::Left)];
        sides.into_iter().chain(far).find_map(near)
    }

    /// Renames the faces of the pose, as by a rotation or reflection of the cube.
    pub(super) fn map(self, rename: impl Fn(CubeFace) -> CubeFace) -> Self {
        Self { face: rename(self.face), right: rename(self.right), up: rename(self.up) }
    }

    /// Returns the faces ahead, to the right and up.
    pub(super) fn axes(self) -> [CubeFace; 3] {
        [self.face, self.right, self.up]
    }
}

/// Returns the face on the other side of the cube.
pub(super) fn opposite(face: CubeFace) -> CubeFace {
    CubeFace::of(face.forward().opposite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pose_is_a_placement() {
        for face in CubeFace::ALL {
            for pose in Pose::all_of(face) {
                assert_eq!(Pose::new(face, pose.placement()), pose);
                let touched = CubeFace::ALL.into_iter().filter(|other| pose.side_towards(*other).is_some());
                assert_eq!(touched.count(), 4);
            }
            assert!(!Pose::new(face, FacePlacement::UPRIGHT).is_mirrored(), "{face}");
        }
    }

    #[test]
    fn a_picture_turned_clockwise_has_its_top_on_the_right() {
        let turned = Pose::new(CubeFace::Front, FacePlacement { quarter_turns: 1, mirrored: false });
        assert_eq!(turned.side_towards(CubeFace::Right), Some(Side::Top));
        assert_eq!(turned.side_towards(CubeFace::Up), Some(Side::Left));
        assert_eq!(turned.side_towards(CubeFace::Back), None);
    }
}
