use super::{Camera, CameraError, FieldStop, PixelGrid, PixelPoint, View};
use crate::projection::{PlanePoint, PlaneRect, ProjectionKind, StMap, StMapError, StMapTable};
use crate::sphere::{Direction, Orientation};

/// A picture whose mapping is a table: it fills its image, whatever the size of that.
#[derive(Clone, Debug, PartialEq)]
pub struct StMapCamera {
    /// The table.
    pub map: StMap,
    /// The height over the width that suits it.
    pub natural_ratio: f64,
}

impl StMapCamera {
    /// The picture whose pixels are a map's, of so many columns and rows: each looks where `base`, the picture at the map's
    /// other end, has what the map says, s from 0 (left) to 1 and t from 0 (bottom) to 1.
    ///
    /// # Errors
    /// When no four neighbours look anywhere.
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

    /// The picture in which the places lie that a map says: the map's pixels are those of `base`.
    ///
    /// # Errors
    /// When no four neighbours belong together.
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

/// Where a map says that its pixel looks; nowhere where it says no number or, as programs do that know of nothing better,
/// the very corner or a place outside on both axes.
fn place(pair: [f32; 2]) -> Option<[f64; 2]> {
    let is_nothing = pair == [0.0, 0.0] || pair == [-1.0, -1.0] || !pair.iter().all(|number| number.is_finite());
    (!is_nothing).then(|| pair.map(f64::from))
}
