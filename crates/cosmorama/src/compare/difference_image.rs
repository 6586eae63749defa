use super::pair::{Pair, Site};
use super::{CompareError, Mask};
use crate::raster::{Image, Rgba};

/// Draws the absolute difference of two pictures, by channel, times `gain`; pixels that are not compared are
/// transparent.
///
/// The result is opaque elsewhere, and not clipped: an integer file shows values beyond white as white.
///
/// # Errors
/// When the pictures or the mask differ in size.
pub fn difference_image(
    first: &Image<Rgba>,
    second: &Image<Rgba>,
    mask: &Mask,
    gain: f32,
) -> Result<Image<Rgba>, CompareError> {
    let pair = Pair::new(first, second, mask)?;
    let mut picture = Image::filled(first.width(), first.height(), Rgba::TRANSPARENT);
    let width = first.width();
    for j in 0..first.height() {
        for site in pair.row(j) {
            picture.pixels_mut()[j * width + site.column] = amplified(&site, gain);
        }
    }
    Ok(picture)
}

fn amplified(site: &Site, gain: f32) -> Rgba {
    let [red, green, blue] = std::array::from_fn(|c| (site.second.0[c] - site.first.0[c]).abs() * gain);
    Rgba::opaque(red, green, blue)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_absolute_and_amplified() {
        let first = Image::filled(2, 1, Rgba::opaque(0.5, 0.25, 0.0));
        let second = Image::filled(2, 1, Rgba::opaque(0.25, 0.5, 0.0));
        let mask = Mask::from_fn(2, 1, |i, _| i == 1);
        let picture = difference_image(&first, &second, &mask, 2.0).unwrap();
        assert_eq!(picture.pixels(), [Rgba::TRANSPARENT, Rgba::opaque(0.5, 0.5, 0.0)]);
    }
}
