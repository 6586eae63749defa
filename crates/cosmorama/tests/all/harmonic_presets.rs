//! Harmonics in the forms of other programs, taken back to light by those programs' own formulas.

use std::f64::consts::{FRAC_1_PI, PI};

use cosmorama::lighting::{HarmonicBasis, HarmonicKind, HarmonicPreset, Harmonics, StoredHarmonics};
use cosmorama::prelude::*;

/// A sky with another colour on each side.
fn sky() -> (World, Light) {
    let view = CameraModel::from(EquirectCamera::default()).view(128, 64).unwrap();
    World::from_panorama(Image::from_fn(128, 64, |i, j| {
        let direction = view.direction(PixelPoint::centre(i, j)).unwrap();
        let [x, y, z] = direction.vector().to_array();
        Rgba::opaque((x + 0.3 * y).exp() as f32, (y - x * z).exp() as f32, (0.5 * z - y * x).exp() as f32)
    }))
    .unwrap()
}

/// Polynomials of Filament's and Unity's shaders.
fn polynomials([x, y, z]: [f64; 3]) -> [f64; 9] {
    [1.0, y, z, x, x * y, y * z, 3.0 * z * z - 1.0, x * z, x * x - y * y]
}

/// Constants of Ramamoorthi and Hanrahan's functions, as three.js and Godot have them.
const CONSTANTS: [f64; 9] = [0.282095, 0.488603, 0.488603, 0.488603, 1.092548, 1.092548, 0.315392, 1.092548, 0.546274];

/// Factors of Godot's shader, `lightmap_captures`.
const GODOT: [f64; 9] = [0.886227, 1.023327, 1.023327, 1.023327, 0.858086, 0.858086, 0.247708, 0.858086, 0.429043];

/// Column and row of a panorama, 0 to 1, at which a program looks in a direction of its own.
fn panorama(preset: HarmonicPreset, [x, y, z]: [f64; 3]) -> [f64; 2] {
    let row = y.acos() / PI;
    match preset {
        // cmgen's `toRectilinear`, of a cube whose x it mirrors.
        HarmonicPreset::Filament => [0.5 + 0.5 * (-x).atan2(z) / PI, row],
        HarmonicPreset::Three => [0.5 + 0.5 * z.atan2(x) / PI, row],
        // Skybox/Panoramic's `ToRadialCoords`.
        HarmonicPreset::Unity => [0.5 - 0.5 * z.atan2(x) / PI, row],
        HarmonicPreset::Godot => [(0.5 * x.atan2(-z) / PI).rem_euclid(1.0), row],
    }
}

/// Light that a program takes numbers for in a direction of its own, and the factor of the light that this is.
fn by_the_program(preset: HarmonicPreset, kind: HarmonicKind, numbers: &[[f64; 3]], at: [f64; 3]) -> ([f64; 3], f64) {
    let (factors, part) = match (preset, kind) {
        (HarmonicPreset::Filament | HarmonicPreset::Unity, HarmonicKind::Irradiance) => ([1.0; 9], FRAC_1_PI),
        // `TSH` of CubemapSH.cpp: x and y have a minus.
        (HarmonicPreset::Filament, HarmonicKind::Radiance) => {
            let signs = [1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0];
            (std::array::from_fn(|k| signs[k] * CONSTANTS[k]), 1.0)
        }
        (HarmonicPreset::Godot, _) => (GODOT, FRAC_1_PI),
        _ => (CONSTANTS, 1.0),
    };
    let functions = polynomials(at);
    let sum = |channel: usize| (0..9).map(|k| factors[k] * functions[k] * numbers[k][channel]).sum();
    ([0, 1, 2].map(sum), part)
}

#[test]
fn programs_take_numbers_for_the_light_of_their_panorama() {
    let (world, light) = sky();
    let own = Harmonics::new(&world, &light, 2, HarmonicBasis::ZUp).unwrap();
    let cases = [
        (HarmonicPreset::Filament, HarmonicKind::Irradiance),
        (HarmonicPreset::Filament, HarmonicKind::Radiance),
        (HarmonicPreset::Three, HarmonicKind::Radiance),
        (HarmonicPreset::Unity, HarmonicKind::Irradiance),
        (HarmonicPreset::Godot, HarmonicKind::Radiance),
    ];
    for (preset, kind) in cases {
        let radiance = Harmonics::new(&world, &light, 2, preset.basis()).unwrap();
        let stored = StoredHarmonics::of(preset, &radiance, kind).unwrap();
        for at in Direction::spread(50).map(|direction| direction.vector().to_array()) {
            let [column, row] = panorama(preset, at);
            let degrees = |turn: f64| Angle::from_degrees(turn);
            let direction =
                Direction::from_longitude_latitude(degrees(360.0 * column - 180.0), degrees(90.0 - 180.0 * row));
            let (found, part) = by_the_program(preset, kind, stored.numbers(), at);
            // Godot keeps radiance and lights with it.
            let is_lit = kind == HarmonicKind::Irradiance || preset == HarmonicPreset::Godot;
            let expected = if is_lit { own.irradiance().at(direction) } else { own.at(direction) };
            let ours = stored.at(direction);
            for channel in 0..3 {
                let expected = part * expected[channel];
                // Six digits of constants.
                assert!((found[channel] - expected).abs() < 2e-5, "{preset:?} {kind:?} {at:?}: {found:?}, {expected}");
                assert!((ours[channel] - expected).abs() < 1e-9, "{preset:?} {kind:?}: {ours:?}, {expected}");
            }
        }
    }
}
