use crate::raster::{Image, Rgba};

/// Difference of maps of light from others that are right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapDifference {
    /// Root mean square of the difference, over that of the right maps.
    pub rms: f64,
    /// Largest difference of a sample, over the largest sample.
    pub largest: f64,
}

impl MapDifference {
    /// Compares pairs of maps, the right one first; alpha does not count.
    ///
    /// ```
    /// use cosmorama::lighting::MapDifference;
    /// use cosmorama::raster::{Image, Rgba};
    ///
    /// let [right, other] = [2.0, 1.0].map(|light| Image::filled(2, 1, Rgba::opaque(light, light, light)));
    /// assert_eq!(MapDifference::of([(&right, &other)]), MapDifference { rms: 0.5, largest: 0.5 });
    /// ```
    pub fn of<'a>(pairs: impl IntoIterator<Item = (&'a Image<Rgba>, &'a Image<Rgba>)>) -> Self {
        let (mut square, mut whole, mut largest, mut most) = (0.0, 0.0, 0.0f64, 0.0f64);
        let pixels = pairs.into_iter().flat_map(|(right, other)| right.pixels().iter().zip(other.pixels()));
        for (right, other) in pixels {
            for (right, other) in right.0[..3].iter().zip(&other.0[..3]) {
                let (right, off) = (f64::from(*right), f64::from(*other) - f64::from(*right));
                square += off * off;
                whole += right * right;
                largest = largest.max(off.abs());
                most = most.max(right.abs());
            }
        }
        let ratio = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
        Self { rms: ratio(square, whole).sqrt(), largest: ratio(largest, most) }
    }
}
