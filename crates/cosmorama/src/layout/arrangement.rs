use super::LayoutError;
use crate::camera::PixelRect;

/// Arrangement of two pictures of the same size in one image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Arrangement {
    /// The first left, the second right.
    #[default]
    SideBySide,
    /// The first above, the second below.
    TopBottom,
}

impl Arrangement {
    /// Returns the size of the image that holds two pictures of this size.
    pub const fn whole(self, (width, height): (usize, usize)) -> (usize, usize) {
        match self {
            Self::SideBySide => (2 * width, height),
            Self::TopBottom => (width, 2 * height),
        }
    }

    /// Returns the halves of an image.
    ///
    /// # Errors
    /// When the number of columns or rows to be halved is odd.
    pub fn halves(self, width: usize, height: usize) -> Result<[PixelRect; 2], LayoutError> {
        let (x, y) = match self {
            Self::SideBySide => (width / 2, 0),
            Self::TopBottom => (0, height / 2),
        };
        if self.whole((width - x, height - y)) != (width, height) || width == 0 || height == 0 {
            return Err(LayoutError::NoHalves { arrangement: self, width, height });
        }
        let first = PixelRect { left: 0, top: 0, right: width - x, bottom: height - y };
        Ok([first, PixelRect { left: x, top: y, right: width, bottom: height }])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_make_the_whole_and_an_odd_image_has_none() {
        for arrangement in [Arrangement::SideBySide, Arrangement::TopBottom] {
            let [first, second] = arrangement.halves(8, 6).unwrap();
            assert_eq!((first.width(), first.height()), (second.width(), second.height()));
            assert_eq!(arrangement.whole((first.width(), first.height())), (8, 6));
            assert_eq!(first.union(second), PixelRect { left: 0, top: 0, right: 8, bottom: 6 });
        }
        assert!(Arrangement::SideBySide.halves(7, 6).is_err() && Arrangement::TopBottom.halves(7, 6).is_ok());
        assert!(Arrangement::TopBottom.halves(0, 0).is_err());
    }
}
