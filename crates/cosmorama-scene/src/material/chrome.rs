use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use cosmorama::camera::Footprint;
use cosmorama::lighting::{ColourTable, TableAngle};
use cosmorama::raster::Rgba;
use cosmorama::sphere::{Angle, Direction, Orientation};
use glam::DVec3;
use thiserror::Error;

use super::MaterialError;

/// Cheap chrome: a table of colours by elevation, averaged over what a pixel reflects by sums made beforehand, and lights
/// that are points (Greene 1986, section 8). There is no world to filter. Copies share the table and the lights.
#[derive(Clone, Debug, PartialEq)]
pub struct Chrome {
    /// Colours from [`FIRST`] on in equal steps, with the sums over them.
    entries: Arc<[Entry]>,
    highlights: Arc<[Highlight]>,
}

/// A light that is a point, as a shiny surface shows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Highlight {
    /// Its direction.
    pub direction: Direction,
    /// Its light in the middle of the highlight.
    pub colour: [f64; 3],
    /// Sharpness: the power of Phong's lobe.
    pub power: f64,
}

/// Reason why there is no such light.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum HighlightError {
    /// The yaw is no number.
    #[error("a yaw of {0} is none; expected degrees")]
    Yaw(f64),
    /// The pitch is beyond zenith or nadir.
    #[error("a pitch of {0} is outside -90 to 90 degrees")]
    Pitch(f64),
    /// The power is out of range.
    #[error("a power of {0} is outside 1 to {most}", most = Highlight::SHARPEST)]
    Power(f64),
}

/// The table where an entry begins: its colour, and the sums up to there of colours and of these sums.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Entry {
    colour: DVec3,
    sum: DVec3,
    sum_of_sums: DVec3,
}

/// Entries of the table in half a turn. It goes on beyond the zenith and the nadir, downwards from there.
const STEPS: usize = 1024;
const STEP: f64 = PI / STEPS as f64;

/// Elevation of the first entry, and number of entries.
const FIRST: f64 = -1.5 * PI;
const ENTRIES: usize = 3 * STEPS + 1;

/// Least width of an interval: far less than an entry, and enough for differences of sums.
const NARROWEST: f64 = 1e-4;

impl Chrome {
    /// Returns the chrome of a table by elevation, in the world's own frame.
    ///
    /// # Errors
    /// When the table goes by azimuth.
    pub fn new(table: &ColourTable, highlights: Vec<Highlight>) -> Result<Self, MaterialError> {
        if table.angle() != TableAngle::Elevation {
            return Err(MaterialError::NotByElevation);
        }
        let mut entries = Vec::with_capacity(ENTRIES);
        let mut entry = Entry { colour: colour_at(table, FIRST), ..Entry::default() };
        entries.push(entry);
        for k in 1..ENTRIES {
            let colour = colour_at(table, FIRST + STEP * k as f64);
            // Between entries colours are straight lines: their sums are polynomials.
            entry = Entry { colour, ..after(&entry, colour, 1.0) };
            entries.push(entry);
        }
        Ok(Self { entries: entries.into(), highlights: highlights.into() })
    }

    /// Returns a gradation from earth to sky, bright at the horizon, without highlights.
    pub fn earth_and_sky() -> Self {
        let stops = [
            (-90.0, [0.02, 0.012, 0.008]),
            (-25.0, [0.14, 0.07, 0.03]),
            (-1.5, [0.75, 0.5, 0.28]),
            (1.5, [1.0, 0.97, 0.9]),
            (25.0, [0.22, 0.42, 0.75]),
            (90.0, [0.02, 0.06, 0.25]),
        ];
        let stops = stops.map(|(degrees, colour)| (Angle::from_degrees(degrees), colour)).to_vec();
        let table = ColourTable::new((TableAngle::Elevation, Orientation::IDENTITY), stops).expect("angles that grow");
        Self::new(&table, Vec::new()).expect("a table by elevation")
    }

    /// Returns the chrome with lights.
    #[must_use]
    pub fn with_highlights(self, highlights: impl Into<Arc<[Highlight]>>) -> Self {
        Self { highlights: highlights.into(), ..self }
    }

    /// Returns its lights.
    pub fn highlights(&self) -> &Arc<[Highlight]> {
        &self.highlights
    }

    /// Returns the place of its table in memory, by which copies of one chrome are known, and its bytes.
    pub(crate) fn table(&self) -> (*const (), usize) {
        (self.entries.as_ptr().cast(), size_of_val::<[Entry]>(&self.entries))
    }

    /// Averages the table over a footprint, and adds the lights.
    ///
    /// Over a pixel the elevation changes by a along one side and by b along the other, so that it is distributed as the
    /// sum of two even intervals: the average is a second difference of the sums of sums, over ab, however wide it is.
    pub(crate) fn average(&self, footprint: &Footprint) -> Rgba {
        let direction = footprint.direction.vector();
        let up = (DVec3::Y - direction * direction.y).try_normalize();
        let up = up.unwrap_or_else(|| direction.any_orthonormal_vector());
        let width = |side: DVec3| side.dot(up).abs().clamp(NARROWEST, FRAC_PI_2);
        let (a, b) = (width(footprint.jacobian.dx), width(footprint.jacobian.dy));
        let middle = direction.y.clamp(-1.0, 1.0).asin();
        let (far, near) = (0.5 * (a + b), 0.5 * (a - b));
        let at = |elevation: f64| self.sum_of_sums(elevation);
        let difference = at(middle + far) - at(middle + near) - at(middle - near) + at(middle - far);
        let light: DVec3 = self.highlights.iter().map(|light| light.seen(footprint)).sum();
        let [red, green, blue] = (difference / (a * b) + light).to_array().map(|part| part as f32);
        Rgba::opaque(red, green, blue)
    }

    fn sum_of_sums(&self, elevation: f64) -> DVec3 {
        let place = (elevation - FIRST) / STEP;
        let entry = (place.max(0.0) as usize).min(ENTRIES - 2);
        let part = place - entry as f64;
        let (from, to) = (&self.entries[entry], &self.entries[entry + 1]);
        after(from, from.colour.lerp(to.colour, part), part).sum_of_sums
    }
}

/// Returns the sums a part of a step after an entry, where the colour has become another.
fn after(entry: &Entry, colour: DVec3, part: f64) -> Entry {
    let width = STEP * part;
    Entry {
        colour,
        sum: entry.sum + (entry.colour + colour) * (0.5 * width),
        sum_of_sums: entry.sum_of_sums + entry.sum * width + (entry.colour * 2.0 + colour) * (width * width / 6.0),
    }
}

/// Looks up the colour at an elevation. Beyond the zenith and the nadir, elevations fall and rise again.
fn colour_at(table: &ColourTable, elevation: f64) -> DVec3 {
    let (sin, cos) = elevation.sin_cos();
    DVec3::from_array(table.at(Direction::from_unit(DVec3::new(0.0, sin, -cos.abs()))))
}

impl Highlight {
    /// Power of a light of which none is said.
    pub const USUAL_POWER: f64 = 300.0;

    /// Greatest power.
    pub const SHARPEST: f64 = 1e9;

    /// Returns a white light at a yaw and a pitch, in degrees.
    ///
    /// # Errors
    /// When a number is out of range.
    pub fn new([yaw, pitch]: [f64; 2], power: f64) -> Result<Self, HighlightError> {
        if !yaw.is_finite() {
            return Err(HighlightError::Yaw(yaw));
        }
        if !(-90.0..=90.0).contains(&pitch) {
            return Err(HighlightError::Pitch(pitch));
        }
        if !(1.0..=Self::SHARPEST).contains(&power) {
            return Err(HighlightError::Power(power));
        }
        let [yaw, pitch] = [yaw, pitch].map(Angle::from_degrees);
        let turn = Orientation::from_yaw_pitch_roll(yaw, pitch, Angle::ZERO);
        Ok(Self { direction: turn.to_world(Direction::FRONT), colour: [1.0; 3], power })
    }

    /// Returns the highlight in a footprint: a lobe that the footprint widens, and so darkens.
    fn seen(&self, footprint: &Footprint) -> DVec3 {
        let [dx, dy] = [footprint.jacobian.dx, footprint.jacobian.dy].map(|side| side.length_squared());
        // Of a square the variance is a twelfth of its side's square; of the two, the mean.
        let variance = self.power.recip() + (dx + dy) / 24.0;
        let apart = 1.0 - self.direction.dot(footprint.direction);
        DVec3::from_array(self.colour) * ((-apart / variance).exp() / (self.power * variance))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Averages the table over many samples of a footprint's parallelogram.
    fn brute(table: &ColourTable, footprint: &Footprint) -> DVec3 {
        const SIDE: usize = 200;
        let at = |k: usize| (k as f64 + 0.5) / SIDE as f64 - 0.5;
        let samples = (0..SIDE * SIDE).map(|k| {
            let seen = footprint.direction_at(at(k % SIDE), at(k / SIDE)).expect("less than half a turn");
            DVec3::from_array(table.at(seen))
        });
        samples.sum::<DVec3>() / (SIDE * SIDE) as f64
    }

    fn footprint(longitude: f64, latitude: f64, sides: [[f64; 2]; 2]) -> Footprint {
        let direction = DVec3::new(latitude.cos() * longitude.sin(), latitude.sin(), -latitude.cos() * longitude.cos());
        let right = DVec3::Y.cross(direction).normalize();
        let up = direction.cross(right);
        let [dx, dy] = sides.map(|[across, along]| right * across + up * along);
        Footprint::new(Direction::from_unit(direction), dx, dy)
    }

    fn table(stops: &[(f64, [f64; 3])]) -> ColourTable {
        let stops = stops.iter().map(|(elevation, colour)| (Angle::from_radians(*elevation), *colour)).collect();
        ColourTable::new((TableAngle::Elevation, Orientation::IDENTITY), stops).unwrap()
    }

    const STRIPES: [(f64, [f64; 3]); 6] = [
        (-1.2, [0.0, 1.0, 0.3]),
        (-0.4, [0.2, 0.4, 0.9]),
        (-0.39, [1.0, 0.1, 0.9]),
        (0.1, [0.9, 0.1, 0.2]),
        (0.3, [0.1, 1.0, 0.0]),
        (1.5, [0.6, 0.6, 0.6]),
    ];

    #[test]
    fn averages_are_those_of_many_samples() {
        let stripes = table(&STRIPES);
        let chrome = Chrome::new(&stripes, Vec::new()).unwrap();
        for k in 0..60 {
            let t = f64::from(k);
            // Away from zenith and nadir, where elevation has a tip.
            let size = [0.002, 0.02, 0.1, 0.25][k as usize % 4];
            let sides = [[size * (t * 0.7).cos(), size * (t * 0.7).sin()], [size * (t * 1.1).sin(), size * 0.6]];
            let footprint = footprint(t * 0.37, 0.9 * (t * 0.53).sin(), sides);
            let (found, expected) = (chrome.average(&footprint).0, brute(&stripes, &footprint));
            let bound = 2e-3 + 0.25 * size * size;
            for channel in 0..3 {
                let error = (f64::from(found[channel]) - expected[channel]).abs();
                assert!(error < bound, "{k}: {error} of {size}");
            }
        }
    }

    #[test]
    fn what_is_straight_stays_and_zenith_and_nadir_turn_back() {
        let straight = [(-FRAC_PI_2, [0.0; 3]), (FRAC_PI_2, [PI; 3])];
        let chrome = Chrome::new(&table(&straight), Vec::new()).unwrap();
        let seen = |latitude: f64, size: f64| {
            f64::from(chrome.average(&footprint(0.3, latitude, [[size, 0.0], [0.0, size]])).0[0])
        };
        for latitude in [-1.0, -0.2, 0.0, 0.7] {
            assert!((seen(latitude, 0.4) - (latitude + FRAC_PI_2)).abs() < 1e-6);
        }
        // Over the zenith the elevation is even on both sides: a quarter of the width below.
        assert!((seen(FRAC_PI_2 - 1e-12, 0.4) - (PI - 0.1)).abs() < 1e-4);
        assert!((seen(1e-12 - FRAC_PI_2, 0.4) - 0.1).abs() < 1e-4);
    }

    #[test]
    fn highlights_keep_their_light_when_they_are_widened() {
        let light = Highlight { direction: Direction::FRONT, colour: [1.0, 0.5, 0.25], power: 400.0 };
        let total = |size: f64| -> f64 {
            let step = 0.01;
            let cells = (-100..100).flat_map(|x| (-100..100).map(move |y| (f64::from(x) * step, f64::from(y) * step)));
            let seen = cells.map(|(x, y)| light.seen(&footprint(x, y, [[size, 0.0], [0.0, size]])).x * y.cos());
            seen.sum::<f64>() * step * step
        };
        let (sharp, wide) = (total(0.0), total(0.2));
        assert!((wide / sharp - 1.0).abs() < 0.01, "{sharp} and {wide}");
    }

    #[test]
    fn lights_are_where_yaw_and_pitch_say() {
        let right = Highlight::new([90.0, 0.0], 10.0).unwrap();
        assert!((right.direction.vector() - DVec3::X).length() < 1e-12, "{right:?}");
        assert_eq!(Highlight::new([0.0, 91.0], 10.0), Err(HighlightError::Pitch(91.0)));
        assert_eq!(Highlight::new([0.0, 0.0], 0.5), Err(HighlightError::Power(0.5)));
        assert!(Highlight::new([f64::NAN, 0.0], 10.0).is_err());
    }

    #[test]
    fn tables_by_azimuth_are_refused() {
        let stops = vec![(Angle::ZERO, [0.5; 3])];
        let by_azimuth = ColourTable::new((TableAngle::Azimuth, Orientation::IDENTITY), stops).unwrap();
        assert_eq!(Chrome::new(&by_azimuth, Vec::new()), Err(MaterialError::NotByElevation));
    }
}
