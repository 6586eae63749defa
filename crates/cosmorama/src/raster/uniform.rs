use super::{Image, Rgba};

/// The colour of a region, and the share of its pixels that have it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uniform {
    /// The colour of the region's first pixel.
    pub colour: Rgba,
    /// Share of the pixels that have this colour, within the error of a lossy codec.
    pub share: f64,
}

/// Largest change that a lossy codec makes to a uniform colour.
const TOLERANCE: f32 = 0.02;

impl Image<Rgba> {
    /// Measures how uniform a region is, given by column and row; `None` if it is empty.
    pub fn uniformity(&self, mut region: impl FnMut(usize, usize) -> bool) -> Option<Uniform> {
        let places = (0..self.height()).flat_map(|j| (0..self.width()).map(move |i| (i, j)));
        let mut pixels = places.filter(|&(i, j)| region(i, j)).map(|(i, j)| *self.get(i, j));
        let colour = pixels.next()?;
        let is_alike = |pixel: &Rgba| pixel.0.iter().zip(colour.0).all(|(a, b)| (a - b).abs() <= TOLERANCE);
        let (mut all, mut alike) = (1_usize, 1_usize);
        for pixel in pixels {
            all += 1;
            alike += usize::from(is_alike(&pixel));
        }
        Some(Uniform { colour, share: alike as f64 / all as f64 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_region_is_as_uniform_as_its_pixels() {
        let grey = |light: f32| Rgba::opaque(light, light, light);
        let image = Image::from_fn(4, 4, |i, j| if i < 2 { grey(0.01) } else { grey((i + j) as f32) });
        let left = image.uniformity(|i, _| i < 2).unwrap();
        assert_eq!(left, Uniform { colour: grey(0.01), share: 1.0 });
        assert_eq!(image.uniformity(|_, _| true).unwrap().share, 0.5);
        assert_eq!(image.uniformity(|_, _| false), None);
    }
}
