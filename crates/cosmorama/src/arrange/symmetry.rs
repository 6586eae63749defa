use super::Pose;
use super::pose::opposite;
use crate::sphere::CubeFace;

/// One of the 48 rotations and reflections of the cube, given by the images of its front, right and upper face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Symmetry {
    front: CubeFace,
    right: CubeFace,
    up: CubeFace,
}

impl Symmetry {
    /// Returns all 48 rotations and reflections.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        CubeFace::ALL.into_iter().flat_map(Pose::all_of).map(|pose| {
            let [front, right, up] = pose.axes();
            Self { front, right, up }
        })
    }

    fn rename(self, face: CubeFace) -> CubeFace {
        match face {
            CubeFace::Front => self.front,
            CubeFace::Right => self.right,
            CubeFace::Up => self.up,
            CubeFace::Back => opposite(self.front),
            CubeFace::Left => opposite(self.right),
            CubeFace::Down => opposite(self.up),
        }
    }

    /// Returns an arrangement, rotated or reflected as a whole.
    pub(super) fn of(self, poses: &[Pose]) -> Vec<Pose> {
        poses.iter().map(|pose| pose.map(|face| self.rename(face))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::FacePlacement;

    #[test]
    fn there_are_forty_eight_and_they_keep_neighbours() {
        let cube = CubeFace::ALL.map(|face| Pose::new(face, FacePlacement::UPRIGHT));
        let mut images: Vec<Vec<Pose>> = Symmetry::all().map(|symmetry| symmetry.of(&cube)).collect();
        let touching = |poses: &[Pose]| {
            let side = |a: usize, b: usize| poses[a].side_towards(poses[b].face);
            (0..36).map(|k| side(k / 6, k % 6)).collect::<Vec<_>>()
        };
        assert!(images.iter().all(|image| touching(image) == touching(&cube)));
        while let Some(image) = images.pop() {
            assert!(!images.contains(&image));
        }
    }
}
