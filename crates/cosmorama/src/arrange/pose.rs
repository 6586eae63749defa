use super::Side;
use crate::layout::FacePlacement;
use crate::sphere::CubeFace;

/// How a picture lies on the cube: the face that it is, and the faces to which its right and upper side point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pose {
    /// The face that it is.
    pub face: CubeFace,
    /// Where its right side points.
    right: CubeFace,
    /// Where its upper side points.
    up: CubeFace,
}

impl Pose {
    /// Builds the pose of a face's picture that must be turned so to be upright.
    pub fn new(face: CubeFace, lies: FacePlacement) -> Self {
        let (right, up) = lies.axes(face);
        Self { face, right: CubeFace::of(right), up: CubeFace::of(up) }
    }

    /// All eight of a face: four turns, and the same mirrored.
    pub fn all_of(face: CubeFace) -> [Self; 8] {
        std::array::from_fn(|k| Self::new(face, FacePlacement { quarter_turns: k as u8 % 4, mirrored: k >= 4 }))
    }

    /// How the picture has to be turned to be its face.
    pub fn placement(self) -> FacePlacement {
        let mirrored = self.is_mirrored();
        let fits = |turns: &u8| Self::new(self.face, FacePlacement { quarter_turns: *turns, mirrored }) == self;
        FacePlacement { quarter_turns: (0..4).find(fits).unwrap_or_default(), mirrored }
    }

    /// Whether left and right are exchanged in it.
    pub fn is_mirrored(self) -> bool {
        let handedness = self.right.forward().vector().cross(self.up.forward().vector());
        handedness.dot(self.face.forward().vector()) > 0.0
    }

    /// The side of the picture that touches a neighbour of its face; `None` for the face itself and the one opposite.
    pub fn side_towards(self, other: CubeFace) -> Option<Side> {
        let sides = [(self.up, Side::Top), (self.right, Side::Right)];
        let near = |(axis, side): (CubeFace, Side)| (axis == other).then_some(side);
        let far = [(opposite(self.up), Side::Bottom), (opposite(self.right), Side::Left)];
        sides.into_iter().chain(far).find_map(near)
    }

    /// Renames the faces of this pose, as a turn or a reflection of the cube does.
    pub(super) fn map(self, rename: impl Fn(CubeFace) -> CubeFace) -> Self {
        Self { face: rename(self.face), right: rename(self.right), up: rename(self.up) }
    }

    /// The faces ahead, to the right and up.
    pub(super) fn axes(self) -> [CubeFace; 3] {
        [self.face, self.right, self.up]
    }
}

/// The face on the other side of the cube.
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
