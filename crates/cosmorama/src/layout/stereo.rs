use super::{Arrangement, LayoutError};
use crate::camera::PixelRect;

/// An eye of a stereo pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Eye {
    /// The left one.
    Left,
    /// The right one.
    Right,
}

impl Eye {
    /// Both eyes, the left one first.
    pub const ALL: [Self; 2] = [Self::Left, Self::Right];

    /// Returns the name in messages and SPECs: `left` or `right`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }
}

/// Arrangement of the pictures of two eyes in one image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stereo {
    /// Arrangement of the two pictures.
    pub arrangement: Arrangement,
    /// Whether each is squeezed to half its width (side by side) or height, so that the image has the size of one.
    pub is_half: bool,
    /// Whether the right eye's picture comes first.
    pub is_swapped: bool,
}

impl Stereo {
    /// Returns the factors by which the pictures are squeezed horizontally and vertically.
    pub const fn squeeze(self) -> (usize, usize) {
        match (self.is_half, self.arrangement) {
            (false, _) => (1, 1),
            (true, Arrangement::SideBySide) => (2, 1),
            (true, Arrangement::TopBottom) => (1, 2),
        }
    }

    /// Returns the part of an image that shows an eye's picture.
    ///
    /// # Errors
    /// When the image cannot be halved.
    pub fn part(self, eye: Eye, width: usize, height: usize) -> Result<PixelRect, LayoutError> {
        let [first, second] = self.arrangement.halves(width, height)?;
        Ok(if (eye == Eye::Left) == self.is_swapped { second } else { first })
    }

    /// Returns the size of the image that holds two pictures; the given size is that of a picture before it is
    /// squeezed.
    ///
    /// # Errors
    /// When the number of columns or rows to be halved is odd.
    pub fn image_size(self, (width, height): (usize, usize)) -> Result<(usize, usize), LayoutError> {
        let (x, y) = self.squeeze();
        if width % x != 0 || height % y != 0 {
            return Err(LayoutError::NoHalves { arrangement: self.arrangement, width, height });
        }
        Ok(self.arrangement.whole((width / x, height / y)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_left_eye_comes_first_unless_swapped() {
        let left = |stereo: Stereo| stereo.part(Eye::Left, 8, 4).unwrap();
        let stereo = Stereo::default();
        assert_eq!(left(stereo), PixelRect { left: 0, top: 0, right: 4, bottom: 4 });
        let swapped = Stereo { is_swapped: true, ..stereo };
        assert_eq!(left(swapped), PixelRect { left: 4, top: 0, right: 8, bottom: 4 });
        assert_eq!(swapped.part(Eye::Right, 8, 4), stereo.part(Eye::Left, 8, 4));
        let above = Stereo { arrangement: Arrangement::TopBottom, ..stereo };
        assert_eq!(left(above), PixelRect { left: 0, top: 0, right: 8, bottom: 2 });
    }

    #[test]
    fn half_packings_have_the_size_of_one_picture() {
        for arrangement in [Arrangement::SideBySide, Arrangement::TopBottom] {
            let half = Stereo { arrangement, is_half: true, is_swapped: false };
            assert_eq!(half.image_size((8, 4)), Ok((8, 4)));
        }
        let half = Stereo { is_half: true, ..Stereo::default() };
        assert!(half.image_size((7, 4)).is_err());
        assert_eq!(Stereo::default().image_size((7, 4)), Ok((14, 4)));
    }
}
