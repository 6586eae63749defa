use cosmorama::camera::{PixelPoint, View};
use cosmorama::world::World;

/// The common field of a view and another form of the world: the pixels that can be compared, and the seams of the
/// other form between them.
pub(crate) struct CommonField<'a> {
    view: &'a View,
    /// Whether both show the whole world, so that directions beyond the view's border are in both.
    are_whole: bool,
    other: &'a World,
    /// View and position of each pixel's direction in the other form.
    places: Vec<Option<(usize, PixelPoint)>>,
    counted: Vec<bool>,
}

/// Distance in pixels within which all directions must be in both forms for a pixel to be compared.
const REACH: f64 = 4.0;

/// Greatest distance, in texels of the other form, between neighbours on the same side of a seam.
const APART: f64 = 24.0;

impl<'a> CommonField<'a> {
    /// Finds the part of the sphere that `view` shares with `other`; `are_whole` when both show the whole world.
    pub(crate) fn new(view: &'a View, are_whole: bool, other: &'a World) -> Self {
        let pixels = || (0..view.height()).flat_map(|j| (0..view.width()).map(move |i| PixelPoint::centre(i, j)));
        let place = |pixel: PixelPoint| view.direction(pixel).and_then(|direction| other.owner(direction));
        let mut field = Self { view, are_whole, other, places: pixels().map(place).collect(), counted: Vec::new() };
        field.counted = (0..field.places.len()).map(|k| field.is_common(k % view.width(), k / view.width())).collect();
        field
    }

    /// Returns whether a pixel can be compared.
    pub(crate) fn counts(&self, i: usize, j: usize) -> bool {
        i < self.view.width() && j < self.view.height() && self.counted[j * self.view.width() + i]
    }

    /// Returns whether the other form has a seam between two pixels: it shows them far apart, and their middle not half
    /// way between.
    pub(crate) fn parts(&self, a: (usize, usize), b: (usize, usize)) -> bool {
        let places = [a, b].map(|(i, j)| self.places[j * self.view.width() + i]);
        let [Some((face, first)), Some((next, second))] = places else { return false };
        if face != next {
            return true;
        }
        let apart = (first.x - second.x).hypot(first.y - second.y);
        let middle = PixelPoint::new((a.0 + b.0 + 1) as f64 / 2.0, (a.1 + b.1 + 1) as f64 / 2.0);
        apart > APART
            && self.view.direction(middle).and_then(|direction| self.other.owner(direction)).is_none_or(
                |(_, between)| {
                    let (x, y) = ((first.x + second.x) / 2.0, (first.y + second.y) / 2.0);
                    (between.x - x).hypot(between.y - y) > apart / 4.0
                },
            )
    }

    /// Returns whether a pixel is whole, it and its neighbours are in both forms, and the other form has the finer
    /// pixels there.
    fn is_common(&self, i: usize, j: usize) -> bool {
        let screen = self.view.screen_pixel(i, j).filter(|screen| screen.coverage == 1.0);
        let Some((screen, (index, at))) = screen.zip(self.places[j * self.view.width() + i]) else { return false };
        let Some(texel) = self.other.sources()[index].view.footprint(at) else { return false };
        let pixel = screen.footprint.jacobian;
        let is_finer =
            texel.jacobian.dx.length().max(texel.jacobian.dy.length()) < pixel.dx.length().min(pixel.dy.length());
        let pixel = PixelPoint::centre(i, j);
        let around = [-1.0, 0.0, 1.0].into_iter().flat_map(|y| [-1.0, 0.0, 1.0].map(|x| (x * REACH, y * REACH)));
        is_finer
            && around.map(|(x, y)| PixelPoint::new(pixel.x + x, pixel.y + y)).all(|point| {
                let direction = self.view.direction(point).filter(|_| self.are_whole || self.view.shows(point));
                direction.map_or(self.are_whole, |direction| self.other.owner(direction).is_some())
            })
    }
}
