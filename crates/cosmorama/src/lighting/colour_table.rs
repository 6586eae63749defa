use std::f64::consts::PI;

use rayon::prelude::*;
use thiserror::Error;

use super::prefilter::averages::Normalisation;
use super::texel_angles::texel_angles;
use crate::camera::PixelPoint;
use crate::raster::Rgba;
use crate::sphere::{Angle, Direction, Orientation};
use crate::world::{Source, World};

/// Largest number of colours in a table that is made of a world.
pub const LARGEST_COLOUR_TABLE: usize = 8192;

/// Angle by which a table is looked up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TableAngle {
    /// Angle above the horizon, −90° to 90°.
    #[default]
    Elevation,
    /// Angle to the right of the front, −180° to 180°.
    Azimuth,
}

/// Light by one angle alone: a one-dimensional table of colours, as for chrome (N. Greene, *Applications of World Projections*,
/// Graphics Interface '86, section 8).
///
/// ```
/// use cosmorama::lighting::{ColourTable, TableAngle};
/// use cosmorama::prelude::*;
///
/// let stops = [(-90.0, [0.1; 3]), (0.0, [1.0; 3]), (90.0, [0.2, 0.4, 0.8])];
/// let stops = stops.map(|(degrees, colour)| (Angle::from_degrees(degrees), colour)).to_vec();
/// let chrome = ColourTable::new((TableAngle::Elevation, Orientation::IDENTITY), stops)?;
/// assert_eq!(chrome.at(Direction::FRONT), [1.0; 3]);
/// # Ok::<(), cosmorama::lighting::ColourTableError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ColourTable {
    angle: TableAngle,
    frame: Orientation,
    stops: Vec<(Angle, [f64; 3])>,
}

/// Reason why there is no such table.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ColourTableError {
    /// There is no colour, or there are too many.
    #[error("a table of {0} colours is outside 1 to {LARGEST_COLOUR_TABLE}")]
    Count(usize),
    /// An angle is outside the range.
    #[error("an angle of {0}° is outside −{1}° to {1}°")]
    Angle(f64, f64),
    /// Angles do not grow.
    #[error("angles must grow, but {1}° follows {0}°")]
    Order(f64, f64),
    /// A colour is no number.
    #[error("the colour at {0}° is not finite")]
    Colour(f64),
}

impl TableAngle {
    /// Returns the largest angle, in degrees.
    pub fn most(self) -> f64 {
        match self {
            Self::Elevation => 90.0,
            Self::Azimuth => 180.0,
        }
    }

    /// Returns the angle of a direction.
    fn of(self, direction: Direction) -> Angle {
        let (longitude, latitude) = direction.longitude_latitude();
        match self {
            Self::Elevation => latitude,
            Self::Azimuth => longitude,
        }
    }
}

impl ColourTable {
    /// Creates a table of colours at growing angles. Between them it is linear. Below the first and above the last the colour stays,
    /// by elevation; by azimuth it goes around. Angles are those in the frame of a camera: its own up and front.
    ///
    /// # Errors
    /// When there is no colour, angles do not grow or are out of range, or a colour is not finite.
    pub fn new(
        (angle, frame): (TableAngle, Orientation),
        stops: Vec<(Angle, [f64; 3])>,
    ) -> Result<Self, ColourTableError> {
        if stops.is_empty() || stops.len() > LARGEST_COLOUR_TABLE {
            return Err(ColourTableError::Count(stops.len()));
        }
        for (at, colour) in &stops {
            let degrees = at.degrees();
            if degrees.is_nan() || degrees.abs() > angle.most() + 1e-9 {
                return Err(ColourTableError::Angle(degrees, angle.most()));
            }
            if !colour.iter().all(|light| light.is_finite()) {
                return Err(ColourTableError::Colour(degrees));
            }
        }
        let not_growing = stops.windows(2).find(|pair| pair[1].0.radians() <= pair[0].0.radians());
        match not_growing {
            Some(pair) => Err(ColourTableError::Order(pair[0].0.degrees(), pair[1].0.degrees())),
            None => Ok(Self { angle, frame, stops }),
        }
    }

    /// Averages the light of a world's texels over bands of equal angle, by solid angle. `unseen` is the light of what the world does
    /// not show.
    ///
    /// # Errors
    /// When the number of bands is out of range.
    ///
    /// # Panics
    /// When there are not as many texels as the world has.
    pub fn of_texels(
        world: &World,
        (texels, unseen): (&[Rgba], Rgba),
        (angle, frame): (TableAngle, Orientation),
        count: usize,
    ) -> Result<Self, ColourTableError> {
        if count == 0 || count > LARGEST_COLOUR_TABLE {
            return Err(ColourTableError::Count(count));
        }
        assert_eq!(texels.len(), world.texel_count(), "one texel of light for each texel of the world");
        let bands = Bands { angle, frame, count };
        let mut sums = vec![[0.0; 4]; count];
        for source in world.sources() {
            bands.add(source, &texels[source.texels()], &mut sums);
        }
        let shown: f64 = sums.iter().map(|sum| sum[3]).sum();
        let complete = Normalisation::of(shown) == Normalisation::Complete;
        let colour = |(k, [red, green, blue, alpha]): (usize, [f64; 4])| {
            // All of a complete world's bands are shown but for what texels are too coarse for.
            let whole = if complete { alpha } else { bands.solid_angle(k).max(alpha) };
            let hidden = |channel: usize| f64::from(unseen.0[channel]) * (whole - alpha);
            let light = [red + hidden(0), green + hidden(1), blue + hidden(2)];
            (whole > 0.0).then(|| light.map(|light| light / whole))
        };
        let colours: Vec<_> = sums.into_iter().enumerate().map(colour).collect();
        let known = colours.iter().enumerate().filter_map(|(k, colour)| Some((bands.middle(k), (*colour)?)));
        let partial = Self { angle, frame, stops: known.collect() };
        if partial.stops.is_empty() {
            let black = (Angle::from_degrees(0.0), [0.0; 3]);
            return Ok(Self { stops: vec![black], ..partial });
        }
        let stops = (0..count).map(|k| (bands.middle(k), partial.at_angle(bands.middle(k)))).collect();
        Ok(Self { stops, ..partial })
    }

    /// Returns the angle by which it is looked up.
    pub fn angle(&self) -> TableAngle {
        self.angle
    }

    /// Returns its angles and colours.
    pub fn stops(&self) -> &[(Angle, [f64; 3])] {
        &self.stops
    }

    /// Averages the colours over the sphere.
    pub fn mean(&self) -> [f64; 3] {
        let bands = Bands { angle: self.angle, frame: self.frame, count: LARGEST_COLOUR_TABLE };
        let mut sum = [0.0; 3];
        for band in 0..bands.count {
            let part = bands.solid_angle(band) / (4.0 * PI);
            sum.iter_mut().zip(self.at_angle(bands.middle(band))).for_each(|(sum, light)| *sum += part * light);
        }
        sum
    }

    /// Looks up the colour in a direction.
    pub fn at(&self, direction: Direction) -> [f64; 3] {
        self.at_angle(self.angle.of(self.frame.to_view(direction)))
    }

    /// Looks up the colour at an angle.
    fn at_angle(&self, angle: Angle) -> [f64; 3] {
        let (stops, at) = (&self.stops, angle.radians());
        let (first, last) = (stops[0], stops[stops.len() - 1]);
        let next = stops.partition_point(|(stop, _)| stop.radians() <= at);
        let is_inside = next > 0 && next < stops.len();
        if self.angle == TableAngle::Elevation && !is_inside {
            return if next == 0 { first.1 } else { last.1 };
        }
        let place = |(stop, colour): (Angle, [f64; 3]), turns: f64| (stop.radians() + turns * 2.0 * PI, colour);
        let below = if next == 0 { place(last, -1.0) } else { place(stops[next - 1], 0.0) };
        let above = if next == stops.len() { place(first, 1.0) } else { place(stops[next], 0.0) };
        let part = (at - below.0) / (above.0 - below.0);
        [0, 1, 2].map(|channel: usize| below.1[channel] + part * (above.1[channel] - below.1[channel]))
    }
}

/// Bands of equal angle.
#[derive(Clone, Copy)]
struct Bands {
    angle: TableAngle,
    frame: Orientation,
    count: usize,
}

/// Rows that are summed together. Sums of pieces are added in order, so that the number of threads does not matter.
const ROWS: usize = 64;

/// Samples along each side of a texel at most, and samples for each band that a texel is high.
const MOST_SAMPLES: usize = 8;
const SAMPLES: f64 = 4.0;

impl Bands {
    /// Returns the width of a band, in radians.
    fn width(self) -> f64 {
        2.0 * self.angle.most().to_radians() / self.count as f64
    }

    /// Returns the angle in the middle of a band.
    fn middle(self, band: usize) -> Angle {
        Angle::from_degrees(self.angle.most() * ((2 * band + 1) as f64 / self.count as f64 - 1.0))
    }

    /// Returns the solid angle of a band.
    fn solid_angle(self, band: usize) -> f64 {
        match self.angle {
            TableAngle::Elevation => 4.0 * PI * self.middle(band).sin_cos().1 * (0.5 * self.width()).sin(),
            TableAngle::Azimuth => 4.0 * PI / self.count as f64,
        }
    }

    /// Returns the band of a direction.
    fn of(self, direction: Direction) -> usize {
        let angle = self.angle.of(self.frame.to_view(direction)).radians() + self.angle.most().to_radians();
        ((angle / self.width()) as usize).min(self.count - 1)
    }

    /// Adds light and opacity times solid angle of a view.
    fn add(self, source: &Source, texels: &[Rgba], sums: &mut [[f64; 4]]) {
        let angles = texel_angles(source);
        let (width, height) = (source.view.width(), source.view.height());
        // A texel that is high for a band is spread over those that it touches.
        let side = ((SAMPLES * source.texel_pitch / self.width()).ceil() as usize).clamp(1, MOST_SAMPLES);
        let piece = |k: usize| {
            let mut sums = vec![[0.0; 4]; self.count];
            for texel in k * ROWS * width..height.min((k + 1) * ROWS) * width {
                let angle = f64::from(angles[texel]);
                if angle > 0.0 {
                    let light = texels[texel].0.map(|light| f64::from(light) * angle);
                    self.spread(source, (texel % width, texel / width), side, (light, &mut sums));
                }
            }
            sums
        };
        let pieces: Vec<_> = (0..height.div_ceil(ROWS)).into_par_iter().map(piece).collect();
        for piece in pieces {
            for (sum, part) in sums.iter_mut().zip(piece) {
                sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
            }
        }
    }

    /// Adds a texel's light to the bands of some of its points.
    fn spread(self, source: &Source, (i, j): (usize, usize), side: usize, (light, sums): ([f64; 4], &mut [[f64; 4]])) {
        let part = 1.0 / (side * side) as f64;
        let place = |k: usize| (k as f64 + 0.5) / side as f64;
        for k in 0..side * side {
            let point = PixelPoint::new(i as f64 + place(k % side), j as f64 + place(k / side));
            let direction = source.view.direction(point).or_else(|| source.view.direction(PixelPoint::centre(i, j)));
            if let Some(direction) = direction {
                sums[self.of(direction)].iter_mut().zip(light).for_each(|(sum, light)| *sum += part * light);
            }
        }
    }
}
