use glam::{DVec2, DVec3};

use crate::demo::hall;
use crate::demo::lettering::{self, Line};
use crate::demo::ray::{Hit, Part, Ray, Surface, nearer};
use crate::demo::solid::{Cuboid, Drum, Row};

/// Two rows of fluted columns and the beams that they carry.
pub(in crate::demo) struct Colonnade;

const STONE: DVec3 = DVec3::new(0.76, 0.66, 0.52);
const HALF_BEAM: f64 = 0.42;
/// Flutes round a column.
const FLUTES: f64 = 18.0;

/// Radius, bottom and top of the drums of a column: foot, ring, shaft, ring and capital.
const DRUMS: [(f64, f64, f64); 6] = [
    (0.52, 0.0, 0.22),
    (0.44, 0.22, 0.34),
    (SHAFT, 0.34, 4.12),
    (0.39, 4.12, 4.20),
    (SHAFT, 4.20, 4.34),
    (0.50, 4.34, hall::BEAM_BOTTOM),
];
const SHAFT: f64 = 0.34;
const WIDEST: f64 = 0.52;

impl Part for Colonnade {
    fn hit(&self, ray: &Ray) -> Option<Hit> {
        [-1.0, 1.0].into_iter().fold(None, |nearest, side| nearer(nearest, side_hit(ray, side)))
    }
}

fn side_hit(ray: &Ray, side: f64) -> Option<Hit> {
    let x = side * hall::HALF_WIDTH;
    let row = Row {
        x,
        first: hall::FIRST_COLUMN,
        spacing: hall::BAY,
        count: hall::COLUMNS,
        radius: WIDEST,
        bottom: 0.0,
        top: hall::BEAM_BOTTOM,
    };
    row.passed(ray).fold(beam(ray, side), |nearest, z| nearer(nearest, column(ray, DVec2::new(x, z))))
}

fn column(ray: &Ray, axis: DVec2) -> Option<Hit> {
    let (lowest, highest) = Drum { axis, radius: WIDEST, bottom: 0.0, top: hall::BEAM_BOTTOM }.heights(ray)?;
    DRUMS.iter().fold(None, |nearest, &(radius, bottom, top)| {
        if bottom > highest || top < lowest {
            return nearest;
        }
        let drum = Drum { axis, radius, bottom, top };
        let hit = drum.entry(ray).map(|(distance, normal)| {
            let normal = if radius == SHAFT && normal.y == 0.0 { flute(normal) } else { normal };
            Hit { distance, normal, surface: Surface::matte(STONE) }
        });
        nearer(nearest, hit)
    })
}

/// Returns the normal in a flute: the shaft's outline stays round, only its shading is hollow.
fn flute(normal: DVec3) -> DVec3 {
    let phase = normal.z.atan2(normal.x) * FLUTES / std::f64::consts::TAU;
    let aside = (phase - phase.round()) * 2.0;
    let along = DVec3::new(-normal.z, 0.0, normal.x);
    // Hollow between sharp ridges: the slope jumps from one side to the other at each ridge.
    (normal - along * (0.8 * aside)).normalize()
}

fn beam(ray: &Ray, side: f64) -> Option<Hit> {
    let middle = side * hall::HALF_WIDTH;
    let beam = Cuboid {
        least: DVec3::new(middle - HALF_BEAM, hall::BEAM_BOTTOM, hall::FRONT - 0.6),
        greatest: DVec3::new(middle + HALF_BEAM, hall::SPRINGING, hall::BACK + 0.6),
    };
    let (distance, normal) = beam.entry(ray)?;
    let inward = normal.x * side < -0.5;
    let colour = frieze(ray.at(distance), normal, if inward { Some(side) } else { None });
    Some(Hit { distance, normal, surface: Surface::matte(colour) })
}

/// The inscription: cities in which cosmoramas were shown, repeated around each row of columns.
const CITIES: Line =
    Line { text: "PARIS * WIEN * LONDON * ROMA * CAIRO * ", middle: DVec2::new(0.0, 4.92), height: 0.24 };

/// Offset of the inscription that keeps words clear of the lamp beside the viewer.
const BETWEEN_LAMPS: f64 = -1.43;

/// Returns the colour of a beam's side: mouldings, a row of dentils, and on the inner side the inscription.
fn frieze(point: DVec3, normal: DVec3, inward: Option<f64>) -> DVec3 {
    const SHADOWED: DVec3 = DVec3::new(0.30, 0.20, 0.13);
    if normal.y.abs() > 0.5 {
        return STONE;
    }
    let height = point.y;
    let dentil = height > 5.14 && height < 5.26 && (point.z * 4.0).rem_euclid(1.0) < 0.4;
    let moulding = (height - 4.72).abs() < 0.012 || (height - 5.11).abs() < 0.012 || (height - 5.29).abs() < 0.008;
    if dentil || moulding {
        return SHADOWED;
    }
    // Seen from inside, the right beam is read toward the back and the left one toward the front.
    let written = inward.is_some_and(|side| {
        let along =
            (side * point.z + BETWEEN_LAMPS + CITIES.width() / 2.0).rem_euclid(CITIES.width()) - CITIES.width() / 2.0;
        lettering::covers(&CITIES, DVec2::new(along, height))
    });
    if written { SHADOWED } else { STONE }
}
