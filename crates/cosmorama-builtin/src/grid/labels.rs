use cosmorama::explain::lettering;
use cosmorama::sphere::{Angle, Direction, Orientation};
use glam::DVec3;

use super::strokes::Stroke;

/// Lettering for one resolution: the coarser a picture, the larger and fewer its letters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    /// Height of capitals, in degrees.
    pub(super) height: f64,
    /// Degrees between azimuths that are labelled along the horizon.
    azimuths: i32,
    /// Degrees between azimuths that are labelled along the parallels at 45°; `None` for none.
    at_45: Option<i32>,
    /// Degrees between meridians along which elevations are labelled.
    meridians: i32,
    /// Degrees between labelled elevations.
    elevations: i32,
    /// Last labelled elevation on the meridians of front, back and sides, and on the others.
    last: (i32, i32),
    /// Whether the poles are labelled.
    poles: bool,
}

/// Scales, the finest first; each has letters twice as high as the one before.
pub(super) const SCALES: [Scale; 4] = [
    Scale { height: 1.4, azimuths: 10, at_45: Some(30), meridians: 30, elevations: 10, last: (80, 60), poles: true },
    Scale { height: 2.8, azimuths: 30, at_45: None, meridians: 90, elevations: 30, last: (60, 60), poles: true },
    Scale { height: 5.6, azimuths: 45, at_45: None, meridians: 90, elevations: 45, last: (45, 45), poles: false },
    Scale { height: 11.2, azimuths: 90, at_45: None, meridians: 90, elevations: 45, last: (45, 45), poles: false },
];

/// Gap between a line and its letters, in heights of capitals.
const GAP: f64 = 0.36;

/// Colours of labels, close to those of their lines.
const AZIMUTH: DVec3 = DVec3::new(0.55, 1.0, 0.6);
const ELEVATION: DVec3 = DVec3::new(0.45, 0.8, 1.0);
const NAME: DVec3 = DVec3::new(1.0, 1.0, 1.0);

/// Returns the strokes of all labels of a scale.
pub(super) fn all(scale: &Scale) -> Vec<Stroke> {
    let mut strokes = Vec::new();
    let mut write = |colour: DVec3, text: &str, azimuth: i32, elevation: f64| {
        strokes.extend(label(scale.height, colour, text, azimuth, elevation));
    };
    let around = |every: i32| (0..360).step_by(every as usize);
    for azimuth in around(scale.azimuths) {
        write(AZIMUTH, &format!("{azimuth}°"), azimuth, 0.0);
    }
    for azimuth in scale.at_45.into_iter().flat_map(around) {
        for elevation in [-45.0, 45.0] {
            write(AZIMUTH, &format!("{azimuth}°"), azimuth, elevation);
        }
    }
    for azimuth in around(scale.meridians) {
        let last = if azimuth % 90 == 0 { scale.last.0 } else { scale.last.1 };
        let elevations = (-last..=last).step_by(scale.elevations as usize);
        for elevation in elevations.filter(|elevation| *elevation != 0) {
            write(ELEVATION, &format!("{elevation}°"), azimuth, f64::from(elevation));
        }
    }
    for (name, azimuth) in [("FRONT", 0), ("RIGHT", 90), ("BACK", 180), ("LEFT", 270)] {
        // Above the degrees.
        write(NAME, name, azimuth, (2.0 * GAP + 1.0) * scale.height);
    }
    if scale.poles {
        write(NAME, "ZENITH", 0, 90.0 - 3.0 * scale.height);
        write(NAME, "NADIR", 0, -90.0 + 1.5 * scale.height);
    }
    strokes
}

/// Returns the strokes of a label to the right of a line of azimuth and above a line of elevation, upright as seen from
/// the middle of the dome.
fn label(height: f64, colour: DVec3, text: &str, azimuth: i32, elevation: f64) -> Vec<Stroke> {
    let (yaw, pitch) = (Angle::from_degrees(f64::from(azimuth)), Angle::from_degrees(elevation));
    let corner = Orientation::from_yaw_pitch_roll(yaw, pitch, Angle::ZERO);
    let radians = |degrees: f64| Angle::from_degrees(degrees).radians();
    let (height, gap) = (radians(height), radians(GAP * height));
    let on_sphere = |(x, y): (f64, f64)| {
        let on_plane = DVec3::new(gap + x * height, gap - y * height, -1.0);
        Direction::new(on_plane).map(|direction| corner.to_world(direction).vector())
    };
    let (lines, _) = lettering::polylines(text);
    let mut strokes = Vec::new();
    for line in lines {
        let points: Vec<DVec3> = line.into_iter().filter_map(on_sphere).collect();
        strokes.extend(points.windows(2).map(|pair| Stroke { colour, from: pair[0], to: pair[1] }));
    }
    strokes
}
