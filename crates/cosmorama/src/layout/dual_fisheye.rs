use super::{Arrangement, LayoutError};
use crate::camera::{CameraModel, FisheyeCamera, LensCircle, Mirror, PixelPoint, PixelRect, Placement};
use crate::sphere::{Angle, Orientation};
use crate::world::Blend;

/// Two fisheye pictures in one image, by cameras back to back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DualFisheye {
    /// Arrangement of the two pictures.
    pub arrangement: Arrangement,
    /// The camera whose picture comes first.
    pub first: LensSide,
    /// The camera that looks to the front.
    pub front: DualLens,
    /// The camera that looks to the back.
    pub back: DualLens,
    /// Width of the band at each circle in which the picture fades out; `None` for the whole overlap.
    pub feather: Option<Angle>,
}

/// One of two cameras back to back, by where it looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LensSide {
    /// To the front.
    Front,
    /// To the back.
    Back,
}

impl LensSide {
    /// Both cameras.
    pub const ALL: [Self; 2] = [Self::Front, Self::Back];

    /// Returns the name in messages and SPECs: `front` or `back`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::Back => "back",
        }
    }

    /// Returns the nominal orientation of the camera.
    pub fn orientation(self) -> Orientation {
        let yaw = match self {
            Self::Front => Angle::ZERO,
            Self::Back => Angle::HALF_TURN,
        };
        Orientation::from_yaw_pitch_roll(yaw, Angle::ZERO, Angle::ZERO)
    }
}

/// One of two cameras, with its lens and its deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DualLens {
    /// Fisheye model. If its circle is placed explicitly, it is in pixels of the whole image.
    pub frame: FisheyeCamera,
    /// Rotation of the camera relative to its nominal orientation, in the camera's own frame.
    pub turned: Orientation,
}

/// One of two fisheye pictures in an image of known size.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedLens {
    /// Camera of the picture.
    pub side: LensSide,
    /// Rectangle of the picture's pixels.
    pub rect: PixelRect,
    /// Camera model and orientation of the picture.
    pub placement: Placement,
}

impl DualFisheye {
    /// Typical field of view of such cameras: a little more than half the world.
    pub const FIELD_OF_VIEW: Angle = Angle::from_degrees(195.0);

    /// Returns the two pictures in an image of `width` × `height` pixels, in their order in the image. `mirror` mirrors
    /// the image as a whole.
    ///
    /// # Errors
    /// When the image cannot be halved.
    pub fn lenses(&self, width: usize, height: usize, mirror: Mirror) -> Result<[PlacedLens; 2], LayoutError> {
        let halves = self.arrangement.halves(width, height)?;
        let is_turned_round = match self.arrangement {
            Arrangement::SideBySide => mirror.x,
            Arrangement::TopBottom => mirror.y,
        };
        let sides = if self.first == LensSide::Front { LensSide::ALL } else { [LensSide::Back, LensSide::Front] };
        let lens = |place: usize| {
            // Circles are placed in the image as it was before it was mirrored.
            let (side, unmirrored) = (sides[if is_turned_round { 1 - place } else { place }], halves[place]);
            let drawn = if is_turned_round { halves[1 - place] } else { unmirrored };
            let DualLens { frame, turned } = self.lens(side);
            let circle = within(frame.circle, drawn);
            let frame = CameraModel::Fisheye(FisheyeCamera { circle, ..frame });
            let orientation = turned.within(side.orientation());
            PlacedLens { side, rect: halves[place], placement: Placement { frame, orientation, mirror, canvas: None } }
        };
        Ok([lens(0), lens(1)])
    }

    fn lens(&self, side: LensSide) -> DualLens {
        match side {
            LensSide::Front => self.front,
            LensSide::Back => self.back,
        }
    }

    /// Returns the blending of the two pictures where they overlap: each fades to zero at its own circle.
    pub fn blend(&self) -> Blend {
        let shared = (self.front.frame.field_of_view + self.back.frame.field_of_view) * 0.5 - Angle::HALF_TURN;
        let feather = self.feather.unwrap_or(shared);
        Blend { priority: 0, feather: if feather > Angle::ZERO { feather } else { Angle::ZERO } }
    }
}

/// Converts a circle from pixels of the whole image to pixels of the half in which it lies.
fn within(circle: LensCircle, half: PixelRect) -> LensCircle {
    let centre = circle.centre.map(|at| PixelPoint::new(at.x - half.left as f64, at.y - half.top as f64));
    LensCircle { centre, ..circle }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::Direction;

    fn camera() -> DualFisheye {
        let frame = FisheyeCamera { field_of_view: DualFisheye::FIELD_OF_VIEW, ..FisheyeCamera::default() };
        let lens = DualLens { frame, turned: Orientation::IDENTITY };
        let arrangement = Arrangement::SideBySide;
        DualFisheye { arrangement, first: LensSide::Front, front: lens, back: lens, feather: None }
    }

    fn seen(lens: &PlacedLens, x: f64, y: f64) -> Direction {
        let view = lens.placement.view(lens.rect.width(), lens.rect.height()).unwrap();
        view.direction(PixelPoint::new(x, y)).unwrap()
    }

    #[test]
    fn one_looks_ahead_and_one_back() {
        let [front, back] = camera().lenses(200, 100, Mirror::default()).unwrap();
        assert!(seen(&front, 50.0, 50.0).angle_to(Direction::FRONT).degrees() < 1e-9);
        assert!(seen(&back, 50.0, 50.0).angle_to(Direction::BACK).degrees() < 1e-9);
        // The right side of the picture of the camera that looks back shows the left of the world.
        assert!(seen(&back, 90.0, 50.0).dot(Direction::LEFT) > 0.9);
        assert_eq!((front.rect.left, back.rect.left), (0, 100));
        assert!(camera().lenses(201, 100, Mirror::default()).is_err());
    }

    #[test]
    fn a_mirrored_image_has_its_halves_exchanged() {
        let mut camera = camera();
        let circle = LensCircle { centre: Some(PixelPoint::new(148.0, 50.0)), radius: Some(45.0) };
        camera.back.frame.circle = circle;
        let [back, front] = camera.lenses(200, 100, Mirror { x: true, y: false }).unwrap();
        assert_eq!((back.side, back.rect.left, front.side), (LensSide::Back, 0, LensSide::Front));
        // Column 52 is as far from one side as column 148 of 200 is from the other.
        assert!(seen(&back, 52.0, 50.0).angle_to(Direction::BACK).degrees() < 1e-9);
        assert!(seen(&front, 90.0, 50.0).dot(Direction::LEFT) > 0.9);
    }

    #[test]
    fn they_share_what_both_see() {
        assert!((camera().blend().feather.degrees() - 15.0).abs() < 1e-9);
        let mut narrow = camera();
        narrow.front.frame.field_of_view = Angle::from_degrees(150.0);
        assert_eq!(narrow.blend().feather, Angle::ZERO);
    }
}
