use cosmorama::explain::lettering;
use cosmorama::sphere::{Angle, Direction, Orientation};
use glam::DVec3;

use super::strokes::Stroke;

/// Height of capitals, in degrees.
pub(super) const HEIGHT: f64 = 1.4;

/// From a line to the letters beside it, in degrees.
const GAP: f64 = 0.5;

/// What is said of azimuth and of elevation has about the colours of the lines.
const AZIMUTH: DVec3 = DVec3::new(0.55, 1.0, 0.6);
const ELEVATION: DVec3 = DVec3::new(0.45, 0.8, 1.0);
const NAME: DVec3 = DVec3::new(1.0, 1.0, 1.0);

/// The strokes of all labels.
pub(super) fn all() -> Vec<Stroke> {
    let mut strokes = Vec::new();
    let mut write = |colour: DVec3, text: &str, azimuth: i32, elevation: f64| {
        strokes.extend(label(colour, text, azimuth, elevation));
    };
    for azimuth in (0..360).step_by(10) {
        write(AZIMUTH, &format!("{azimuth}°"), azimuth, 0.0);
    }
    for azimuth in (0..360).step_by(30) {
        for elevation in [-45.0, 45.0] {
            write(AZIMUTH, &format!("{azimuth}°"), azimuth, elevation);
        }
        let last = if azimuth % 90 == 0 { 80 } else { 60 };
        for elevation in (-last..=last).step_by(10).filter(|elevation| *elevation != 0) {
            write(ELEVATION, &format!("{elevation}°"), azimuth, f64::from(elevation));
        }
    }
    for (name, azimuth) in [("FRONT", 0), ("RIGHT", 90), ("BACK", 180), ("LEFT", 270)] {
        // Above the degrees.
        write(NAME, name, azimuth, 2.0 * GAP + HEIGHT);
    }
    write(NAME, "ZENITH", 0, 86.0);
    write(NAME, "NADIR", 0, -88.0);
    strokes
}

/// A label to the right of a line of azimuth and above one of elevation, upright as seen from the middle of the dome.
fn label(colour: DVec3, text: &str, azimuth: i32, elevation: f64) -> Vec<Stroke> {
    let (yaw, pitch) = (Angle::from_degrees(f64::from(azimuth)), Angle::from_degrees(elevation));
    let corner = Orientation::from_yaw_pitch_roll(yaw, pitch, Angle::ZERO);
    let radians = |degrees: f64| Angle::from_degrees(degrees).radians();
    let (height, gap) = (radians(HEIGHT), radians(GAP));
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
