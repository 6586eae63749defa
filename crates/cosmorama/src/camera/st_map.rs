use super::{Camera, CameraError, FieldStop, PixelGrid, PixelPoint, View};
use crate::projection::{PlanePoint, PlaneRect, ProjectionKind, StMap, StMapError, StMapTable};
use crate::sphere::{Direction, Orientation};

/// A picture whose mapping is a table; the table fills the image, whatever its size.
#[derive(Clone, Debug, PartialEq)]
pub struct StMapCamera {
    /// The table.
    pub map: StMap,
    /// Preferred height over width.
    pub natural_ratio: f64,
}

impl StMapCamera {
    /// Returns the picture whose pixels are those of a map of so many columns and rows. Each looks to the place in
    /// `base`, the picture at the map's other end, that the map gives: s from 0 (left) to 1, t from 0 (bottom) to 1.
    ///
    /// # Errors
    /// When no four neighbouring pixels have a place.
    pub fn looking(
        (width, height): (usize, usize),
        pair: impl Fn(usize, usize) -> [f32; 2] + Sync,
        base: &View,
    ) -> Result<Self, StMapError> {
        let (columns, rows) = (base.width() as f64, base.height() as f64);
        let seen = |[s, t]: [f64; 2]| base.direction(PixelPoint::new(s * columns, (1.0 - t) * rows));
        let table = StMapTable::of_pixels(width, height, |i, j| place(pair(i, j)).and_then(seen))?;
        Ok(Self::of(table))
    }

    /// Returns the picture to which the places in a map refer, where the map's own pixels are those of `base`.
    ///
    /// # Errors
    /// When no four neighbouring pixels belong together.
    pub fn looked_at(
        (width, height): (usize, usize),
        pair: impl Fn(usize, usize) -> [f32; 2] + Sync,
        base: &View,
    ) -> Result<Self, StMapError> {
        let sample = |i, j| -> Option<(PlanePoint, Direction)> {
            let [s, t] = place(pair(i, j))?;
            Some((PlanePoint::new(s - 0.5, t - 0.5), base.direction(PixelPoint::centre(i, j))?))
        };
        Ok(Self::of(StMapTable::of_places(width, height, sample)?))
    }

    fn of(table: StMapTable) -> Self {
        let (width, height) = table.size();
        Self { map: StMap::new(table), natural_ratio: height as f64 / width as f64 }
    }
}

impl Camera for StMapCamera {
    fn view(&self, width: usize, height: usize) -> Result<View, CameraError> {
        let square = PlaneRect { min: PlanePoint::new(-0.5, -0.5), max: PlanePoint::new(0.5, 0.5) };
        Ok(View {
            projection: ProjectionKind::StMap(self.map.clone()),
            orientation: Orientation::IDENTITY,
            grid: PixelGrid::spanning(width, height, square),
            stop: FieldStop::NONE,
        })
    }

    fn natural_ratio(&self) -> f64 {
        self.natural_ratio
    }
}

/// Returns the place that a pixel of a map gives. `None` where its values are not finite, are exactly (0, 0), or lie
/// outside on both axes, by which programs mark pixels without a place.
fn place(pair: [f32; 2]) -> Option<[f64; 2]> {
    let is_nothing = pair == [0.0, 0.0] || pair == [-1.0, -1.0] || !pair.iter().all(|number| number.is_finite());
    (!is_nothing).then(|| pair.map(f64::from))
}
