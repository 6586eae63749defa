use super::FacePlacement;
use crate::camera::{Canvas, PixelRect};
use crate::sphere::{CubeFace, Direction};

/// The part of a face's picture that half a cube uses: all of it, or one side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FacePart {
    /// The part in halves of the picture: 0, 1 and 2 are its first edge, its middle and its second edge.
    pub(crate) halves: PixelRect,
}

impl FacePart {
    /// Returns the part of a face that belongs to the half cube around `half` (`None`: the whole cube); `None` if no
    /// part does.
    pub fn of(face: CubeFace, lies: FacePlacement, half: Option<CubeFace>) -> Option<Self> {
        let mut halves = PixelRect { left: 0, top: 0, right: 2, bottom: 2 };
        let Some(half) = half else { return Some(Self { halves }) };
        let (right, up) = lies.axes(face);
        let towards = |axis: Direction| axis.dot(half.forward()).round();
        if towards(face.forward()) < 0.0 {
            return None;
        }
        if towards(right) > 0.0 {
            halves.left = 1;
        } else if towards(right) < 0.0 {
            halves.right = 1;
        }
        if towards(up) > 0.0 {
            halves.bottom = 1;
        } else if towards(up) < 0.0 {
            halves.top = 1;
        }
        Some(Self { halves })
    }

    /// Returns the whole face that belongs to an image of the part.
    pub fn canvas(self, width: usize, height: usize) -> Canvas {
        let (width, height) = (2 * width / self.halves.width(), 2 * height / self.halves.height());
        let (left, top) = (self.halves.left * width / 2, self.halves.top * height / 2);
        Canvas { width, height, left: left as i64, top: top as i64 }
    }

    /// Returns the size of the part of a face of this size.
    pub fn size(self, width: usize, height: usize) -> (usize, usize) {
        (width * self.halves.width() / 2, height * self.halves.height() / 2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sky_is_the_top_and_the_upper_halves() {
        let part = |face| FacePart::of(face, FacePlacement::UPRIGHT, Some(CubeFace::Up));
        let sky = part(CubeFace::Left).unwrap();
        assert_eq!(sky.size(8, 8), (8, 4));
        assert_eq!(sky.canvas(8, 4), Canvas { width: 8, height: 8, left: 0, top: 0 });
        assert_eq!(part(CubeFace::Up).unwrap().size(8, 8), (8, 8));
        assert_eq!(part(CubeFace::Down), None);
        let ground = FacePart::of(CubeFace::Left, FacePlacement::UPRIGHT, Some(CubeFace::Down)).unwrap();
        assert_eq!(ground.canvas(8, 4), Canvas { width: 8, height: 8, left: 0, top: 4 });
        // A picture that lies on its side shows the part on its side.
        let turned = FacePart::of(CubeFace::Left, FacePlacement::turned(1), Some(CubeFace::Up)).unwrap();
        assert_eq!(turned.canvas(4, 8), Canvas { width: 8, height: 8, left: 4, top: 0 });
    }
}
