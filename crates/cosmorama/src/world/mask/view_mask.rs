use crate::camera::PixelPoint;
use crate::world::MaskShape;

/// Mask of a view: texels that it hides are treated as if the view did not have them.
#[derive(Clone, PartialEq)]
pub struct ViewMask {
    width: usize,
    /// Distance of each visible texel's centre to that of the nearest hidden one, in texels; 0 for hidden texels.
    distance: Vec<f32>,
}

/// Square of a distance greater than any between two texels.
const FAR_SQUARED: f64 = 1e12;

impl ViewMask {
    /// Creates the mask of a view of `width` columns and `height` rows.
    pub fn new(width: usize, height: usize, counts: impl Fn(usize, usize) -> bool) -> Self {
        // Squares of distances: along columns first, then along rows (Felzenszwalb & Huttenlocher 2012).
        let mut squares: Vec<f64> = (0..width * height)
            .map(|texel| if counts(texel % width, texel / width) { FAR_SQUARED } else { 0.0 })
            .collect();
        let mut envelope = Envelope::default();
        let mut column = vec![0.0; height];
        for i in 0..width {
            (0..height).for_each(|j| column[j] = squares[j * width + i]);
            envelope.widen(&mut column);
            (0..height).for_each(|j| squares[j * width + i] = column[j]);
        }
        squares.chunks_mut(width.max(1)).for_each(|row| envelope.widen(row));
        Self { width, distance: squares.into_iter().map(|square| square.sqrt() as f32).collect() }
    }

    /// Creates the mask of a view from shapes, given in pixels of a picture in which (left, top) is the view's corner.
    pub fn of_shapes(shapes: &[MaskShape], (left, top): (usize, usize), (width, height): (usize, usize)) -> Self {
        let mut counts = vec![true; width * height];
        for (j, row) in counts.chunks_mut(width.max(1)).enumerate() {
            for shape in shapes {
                let cut = shape.row(PixelPoint::centre(left, top + j).y);
                let columns = row.iter_mut().enumerate();
                columns.for_each(|(i, counts)| *counts &= cut.leaves(PixelPoint::centre(left + i, top + j).x));
            }
        }
        Self::new(width, height, |i, j| counts[j * width + i])
    }

    /// Returns whether the texel in column `i` of row `j` is visible.
    pub fn counts(&self, i: usize, j: usize) -> bool {
        self.distance.get(j * self.width + i).is_some_and(|distance| *distance > 0.0)
    }

    /// Returns whether all texels are hidden.
    pub fn is_empty(&self) -> bool {
        self.distance.iter().all(|distance| *distance == 0.0)
    }

    /// Returns the columns and rows.
    pub fn size(&self) -> (usize, usize) {
        (self.width, self.distance.len() / self.width.max(1))
    }

    /// Returns whether the texel at a point of the image is visible.
    pub fn shows(&self, pixel: PixelPoint) -> bool {
        let (width, height) = self.size();
        let inside = |value: f64, size: usize| (value.max(0.0) as usize).min(size.saturating_sub(1));
        self.counts(inside(pixel.x, width), inside(pixel.y, height))
    }

    /// Returns the distance of a point to the nearest masked texel, in texels, measured from the outermost visible
    /// centres.
    pub(crate) fn depth(&self, pixel: PixelPoint) -> f64 {
        let (width, height) = self.size();
        let place = |value: f64, size: usize| {
            let at = (value - 0.5).clamp(0.0, size.saturating_sub(1) as f64);
            let low = at.floor();
            (low as usize, (low as usize + 1).min(size.saturating_sub(1)), at - low)
        };
        let ((left, right, x), (top, bottom, y)) = (place(pixel.x, width), place(pixel.y, height));
        let at = |i: usize, j: usize| f64::from(self.distance[j * self.width + i]);
        let row = |j: usize| at(left, j) + (at(right, j) - at(left, j)) * x;
        let (above, below) = (row(top), row(bottom));
        (above + (below - above) * y - 1.0).max(0.0)
    }
}

impl std::fmt::Debug for ViewMask {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (width, height) = self.size();
        f.debug_struct("ViewMask").field("width", &width).field("height", &height).finish_non_exhaustive()
    }
}

/// Lower envelope of parabolas f(k) + (x − k)², one around each place k.
#[derive(Default)]
struct Envelope {
    places: Vec<usize>,
    /// Places at which each parabola becomes the lowest.
    starts: Vec<f64>,
    lowest: Vec<f64>,
}

impl Envelope {
    /// Replaces f(x) by the least of f(k) + (x − k)².
    fn widen(&mut self, f: &mut [f64]) {
        self.places.clear();
        self.starts.clear();
        for (k, &value) in f.iter().enumerate() {
            let start = loop {
                let Some(&last) = self.places.last() else { break f64::NEG_INFINITY };
                let (a, b) = (last as f64, k as f64);
                let meet = (value + b * b - f[last] - a * a) / (2.0 * (b - a));
                if meet > self.starts[self.starts.len() - 1] {
                    break meet;
                }
                self.places.pop();
                self.starts.pop();
            };
            self.places.push(k);
            self.starts.push(start);
        }
        self.lowest.clear();
        let mut at = 0;
        for x in 0..f.len() {
            while at + 1 < self.starts.len() && self.starts[at + 1] < x as f64 {
                at += 1;
            }
            let k = self.places[at];
            self.lowest.push(f[k] + (x as f64 - k as f64).powi(2));
        }
        f.copy_from_slice(&self.lowest);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_of_every_pair() {
        let hidden = |i: usize, j: usize| (i * 7 + j * 13).is_multiple_of(23) || (i > 12 && j > 6);
        let mask = ViewMask::new(19, 11, |i, j| !hidden(i, j));
        let all = || (0..11usize).flat_map(|j| (0..19usize).map(move |i| (i, j)));
        for (i, j) in all() {
            let to = |(k, l): (usize, usize)| (i as f64 - k as f64).hypot(j as f64 - l as f64);
            let nearest = all().filter(|&(k, l)| hidden(k, l)).map(to).fold(f64::INFINITY, f64::min);
            assert!((f64::from(mask.distance[j * 19 + i]) - nearest).abs() < 1e-6, "({i}, {j})");
            assert_eq!(mask.counts(i, j), !hidden(i, j));
        }
        assert!(!mask.is_empty() && ViewMask::new(3, 2, |_, _| false).is_empty());
    }

    #[test]
    fn shapes_leave_what_they_leave_of_each_pixel() {
        let star = [(2.0, 1.5), (17.5, 3.0), (4.0, 9.5), (9.0, -2.0), (14.0, 10.0)];
        let star = star.map(|(x, y)| PixelPoint::new(x, y)).to_vec();
        let circle = MaskShape::Circle { centre: PixelPoint::new(11.0, 6.0), radius: 7.3 };
        let shapes = [MaskShape::Hole(star), circle, MaskShape::Hole(Vec::new())];
        let mask = ViewMask::of_shapes(&shapes, (3, 1), (19, 11));
        for (i, j) in (0..11usize).flat_map(|j| (0..19usize).map(move |i| (i, j))) {
            let leaves = shapes.iter().all(|shape| shape.leaves(PixelPoint::centre(i + 3, j + 1)));
            assert_eq!(mask.counts(i, j), leaves, "({i}, {j})");
        }
    }

    #[test]
    fn depth_falls_to_nothing_where_the_mask_begins() {
        let mask = ViewMask::new(20, 4, |i, _| i >= 5);
        assert_eq!(mask.depth(PixelPoint::new(5.5, 2.0)), 0.0);
        assert!((mask.depth(PixelPoint::new(8.0, 2.0)) - 2.5).abs() < 1e-6);
        assert!(mask.shows(PixelPoint::new(5.01, 0.0)) && !mask.shows(PixelPoint::new(4.99, 0.0)));
    }
}
