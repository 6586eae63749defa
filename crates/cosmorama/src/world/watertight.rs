use super::{Source, World};
use crate::camera::{FieldStop, PixelPoint};
use crate::projection::ProjectionKind;
use crate::sphere::Direction;

/// Distance below which two corners are the same, in radians; it allows for rounding.
const SAME: f64 = 1e-12;

impl World {
    /// Returns whether the views certainly leave no hole between them.
    ///
    /// All sides of the pictures must be great circles, and each must also be the side of another picture, as in a
    /// cube.
    pub(crate) fn is_closed(&self) -> bool {
        let corners: Option<Vec<[Direction; 4]>> = self.sources().iter().map(corners).collect();
        let Some(corners) = corners else { return false };
        let sides: Vec<_> = corners.iter().flat_map(|at| (0..4).map(|k| [at[k], at[(k + 1) % 4]])).collect();
        let is_same = |a: Direction, b: Direction| a.vector().distance(b.vector()) < SAME;
        // All go round clockwise, so that neighbours go along what they share in opposite ways, and each picture counts once for
        // what it shows: where no side is left over, their number is the same everywhere.
        sides.iter().all(|[a, b]| sides.iter().filter(|[c, d]| is_same(*a, *d) && is_same(*b, *c)).count() == 1)
    }
}

/// Returns the directions of a picture's corners, clockwise even if it is mirrored. `None` if its sides may not be
/// great circles, or if a part of it does not count.
fn corners(source: &Source) -> Option<[Direction; 4]> {
    let view = &source.view;
    let is_straight = matches!(view.projection, ProjectionKind::Perspective(_) | ProjectionKind::EquiAngular(_));
    if !is_straight || view.stop != FieldStop::NONE || source.mask.is_some() {
        return None;
    }
    let (width, height) = (view.width() as f64, view.height() as f64);
    let at = |x, y| view.direction(PixelPoint::new(x, y));
    let [a, b, c, d] = [at(0.0, 0.0)?, at(width, 0.0)?, at(width, height)?, at(0.0, height)?];
    let step = view.grid.step();
    Some(if step.x * step.y < 0.0 { [a, d, c, b] } else { [a, b, c, d] })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::camera::{CameraModel, CubeFaceCamera, PixelGrid, View};
    use crate::sphere::{Angle, CubeFace, Orientation};
    use crate::world::{Blend, ViewMask, WorldView, panorama};

    fn cube(faces: impl IntoIterator<Item = CubeFace>, turn: Orientation) -> Vec<(String, View)> {
        let front = CameraModel::CubeFace(CubeFaceCamera).view(16, 12).expect("a face");
        let view = |face: CubeFace| View { orientation: face.orientation().within(turn), ..front.clone() };
        faces.into_iter().map(|face| (face.name().to_owned(), view(face))).collect()
    }

    fn is_closed(views: Vec<(String, View)>) -> bool {
        World::new(views).expect("a world").is_closed()
    }

    #[test]
    fn six_faces_leave_no_hole() {
        let [yaw, pitch, roll] = [20.0, -35.0, 77.0].map(Angle::from_degrees);
        for turn in [Orientation::IDENTITY, Orientation::from_yaw_pitch_roll(yaw, pitch, roll)] {
            assert!(is_closed(cube(CubeFace::ALL, turn)));
        }
    }

    #[test]
    fn what_lacks_a_face_or_a_part_of_one_does() {
        let whole = || cube(CubeFace::ALL, Orientation::IDENTITY);
        assert!(!is_closed(whole().split_off(1)));
        let mut twice = whole();
        twice[0].1 = twice[1].1.clone();
        assert!(!is_closed(twice));
        let mut turned = whole();
        let little = Orientation::from_yaw_pitch_roll(Angle::from_degrees(1e-6), Angle::ZERO, Angle::ZERO);
        turned[2].1.orientation = turned[2].1.orientation.within(little);
        assert!(!is_closed(turned));
        let mut stopped = whole();
        stopped[3].1.stop = FieldStop::circle(1.2);
        assert!(!is_closed(stopped));
        assert!(!is_closed(vec![("all".to_owned(), panorama(16, 8))]));
    }

    /// Mirrors the views whose indices `asked` selects.
    fn mirrored(
        views: Vec<(String, View)>,
        flip: fn(PixelGrid) -> PixelGrid,
        asked: impl Fn(usize) -> bool,
    ) -> Vec<(String, View)> {
        let turn = |(k, (name, view)): (usize, (String, View))| {
            (name, if asked(k) { View { grid: flip(view.grid), ..view } } else { view })
        };
        views.into_iter().enumerate().map(turn).collect()
    }

    const FLIPS: [fn(PixelGrid) -> PixelGrid; 2] = [PixelGrid::flipped_x, PixelGrid::flipped_y];

    #[test]
    fn mirrored_faces_leave_no_hole_either() {
        let whole = || cube(CubeFace::ALL, Orientation::IDENTITY);
        for flip in FLIPS {
            assert!(is_closed(mirrored(whole(), flip, |_| true)));
            assert!(is_closed(mirrored(whole(), flip, |k| k == 2)));
            assert!(!is_closed(mirrored(whole().split_off(1), flip, |_| true)));
        }
    }

    #[test]
    fn a_picture_and_its_mirror_image_are_not_the_world() {
        for flip in FLIPS {
            assert!(!is_closed(mirrored(cube([CubeFace::Front; 2], Orientation::IDENTITY), flip, |k| k == 1)));
        }
    }

    #[test]
    fn a_mask_may_hide_anything() {
        let mask = |k: usize| (k == 4).then(|| Arc::new(ViewMask::new(16, 12, |i, j| (i, j) != (7, 5))));
        let part = |(k, (name, view))| WorldView { name, view, blend: Blend::default(), mask: mask(k) };
        let faces = cube(CubeFace::ALL, Orientation::IDENTITY).into_iter().enumerate().map(part);
        assert!(!World::blended(faces).expect("a world").is_closed());
    }
}
