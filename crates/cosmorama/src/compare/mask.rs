use super::CompareError;
use crate::raster::{Image, Rgba};

/// Least alpha of a pixel that counts as opaque; a weighted average of ones may be slightly less than one.
const OPAQUE: f32 = 1.0 - 1e-6;

/// A selection of a picture's pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Mask(Image<bool>);

impl From<Image<bool>> for Mask {
    fn from(counts: Image<bool>) -> Self {
        Self(counts)
    }
}

impl Mask {
    /// Selects every pixel.
    pub fn everything(width: usize, height: usize) -> Self {
        Self(Image::filled(width, height, true))
    }

    /// Selects the pixels, by column and row, for which `counts` holds.
    pub fn from_fn(width: usize, height: usize, counts: impl FnMut(usize, usize) -> bool) -> Self {
        Self(Image::from_fn(width, height, counts))
    }

    /// Selects the pixels that are finite and opaque in both pictures.
    ///
    /// # Errors
    /// When the sizes differ.
    pub fn opaque(first: &Image<Rgba>, second: &Image<Rgba>) -> Result<Self, CompareError> {
        let (width, _) = common_size(first, second)?;
        let counts = |pixel: &Rgba| pixel.alpha() >= OPAQUE && pixel.0.iter().all(|c| c.is_finite());
        let both = |k: usize| counts(&first.pixels()[k]) && counts(&second.pixels()[k]);
        Ok(Self::from_fn(width, first.height(), |i, j| both(j * width + i)))
    }

    /// Returns the columns and rows.
    pub fn size(&self) -> (usize, usize) {
        (self.0.width(), self.0.height())
    }

    /// Returns the number of selected pixels.
    pub fn count(&self) -> usize {
        self.0.pixels().iter().filter(|counts| **counts).count()
    }

    /// Returns which pixels of a row are selected.
    pub fn row(&self, j: usize) -> &[bool] {
        self.0.row(j)
    }

    /// Selects the pixels that are in both masks.
    ///
    /// # Errors
    /// When the sizes differ.
    pub fn and(&self, other: &Self) -> Result<Self, CompareError> {
        self.combined(other, |mine, theirs| mine && theirs)
    }

    /// Selects the pixels that are in this mask but not in the other.
    ///
    /// # Errors
    /// When the sizes differ.
    pub fn without(&self, other: &Self) -> Result<Self, CompareError> {
        self.combined(other, |mine, theirs| mine && !theirs)
    }

    /// Selects pixels that are more than so many steps left, right, up or down from any unselected pixel and from the
    /// border.
    #[must_use]
    pub fn eroded(&self, steps: u8) -> Self {
        self.by_distance(|counts| !counts, 0, |distance| distance > steps)
    }

    /// Selects pixels within so many steps left, right, up or down of a selected one.
    #[must_use]
    pub fn grown(&self, steps: u8) -> Self {
        self.by_distance(|counts| counts, u8::MAX, |distance| distance <= steps)
    }

    fn combined(&self, other: &Self, rule: impl Fn(bool, bool) -> bool) -> Result<Self, CompareError> {
        if self.size() != other.size() {
            return Err(CompareError::MaskSize { mask: other.size(), pictures: self.size() });
        }
        let (width, height) = self.size();
        Ok(Self::from_fn(width, height, |i, j| rule(*self.0.get(i, j), *other.0.get(i, j))))
    }

    /// Selects pixels by their taxicab distance to the nearest source; beyond the border the distance is `outside`.
    fn by_distance(&self, source: impl Fn(bool) -> bool, outside: u8, kept: impl Fn(u8) -> bool) -> Self {
        let (width, height) = self.size();
        let mut distance: Vec<u8> = self.0.pixels().iter().map(|&c| if source(c) { 0 } else { u8::MAX }).collect();
        // Two sweeps are exact for this distance; the second is the first on the picture turned by 180°.
        sweep(&mut distance, width, outside);
        distance.reverse();
        sweep(&mut distance, width, outside);
        distance.reverse();
        Self::from_fn(width, height, |i, j| kept(distance[j * width + i]))
    }
}

/// Propagates distances to the right and down.
fn sweep(distance: &mut [u8], width: usize, outside: u8) {
    for k in 0..distance.len() {
        let left = if k % width == 0 { outside } else { distance[k - 1] };
        let above = if k < width { outside } else { distance[k - width] };
        distance[k] = distance[k].min(left.min(above).saturating_add(1));
    }
}

/// Returns the size of both pictures.
pub(super) fn common_size(first: &Image<Rgba>, second: &Image<Rgba>) -> Result<(usize, usize), CompareError> {
    let [first, second] = [first, second].map(|picture| (picture.width(), picture.height()));
    if first == second { Ok(first) } else { Err(CompareError::SizesDiffer { first, second }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(mask: &Mask) -> Vec<String> {
        let (_, height) = mask.size();
        (0..height).map(|j| mask.row(j).iter().map(|&c| if c { '#' } else { '.' }).collect()).collect()
    }

    #[test]
    fn a_point_grows_into_a_diamond() {
        let point = Mask::from_fn(5, 4, |i, j| (i, j) == (2, 1));
        assert_eq!(picture(&point.grown(2)), [".###.", "#####", ".###.", "..#.."]);
    }

    #[test]
    fn erosion_eats_from_holes_and_from_the_border() {
        let holed = Mask::from_fn(7, 5, |i, j| (i, j) != (2, 2));
        assert_eq!(picture(&holed.eroded(1)), [".......", ".#.###.", "....##.", ".#.###.", "......."]);
        assert_eq!(Mask::everything(20, 17).eroded(8).count(), 4);
    }

    #[test]
    fn opaque_leaves_out_holes_of_either_picture() {
        let solid = Image::filled(2, 1, Rgba::BLACK);
        let holed = Image::new(2, 1, vec![Rgba::BLACK, Rgba([f32::NAN, 0.0, 0.0, 1.0])]).unwrap();
        assert_eq!(picture(&Mask::opaque(&holed, &solid).unwrap()), ["#."]);
        assert_eq!(picture(&Mask::opaque(&solid, &Image::filled(2, 1, Rgba::TRANSPARENT)).unwrap()), [".."]);
    }

    #[test]
    fn masks_combine() {
        let left = Mask::from_fn(3, 1, |i, _| i < 2);
        let right = Mask::from_fn(3, 1, |i, _| i > 0);
        assert_eq!(picture(&left.and(&right).unwrap()), [".#."]);
        assert_eq!(picture(&left.without(&right).unwrap()), ["#.."]);
        assert!(left.and(&Mask::everything(2, 1)).is_err());
    }
}
