use glam::{DVec2, DVec3};

use super::noise::{noise, octaves, smoothstep};

/// Direction of the sun, a unit vector: 28° left of the front, 33° high.
pub(in crate::demo) const SUN: DVec3 = DVec3::new(-0.393731982196, 0.544639035015, -0.740502159169);
/// Light of the sun on a surface that faces it.
pub(in crate::demo) const SUNLIGHT: DVec3 = DVec3::new(1.62, 1.12, 0.66);
/// Cosine of the sun's angular radius of 0.7°, which is larger than in reality.
const SUN_EDGE: f64 = 0.999_925_37;
/// Radiance of the sun's disc, bright enough to show faults of a filter.
const DISC: DVec3 = DVec3::new(30.0, 24.0, 15.0);

const HORIZON: DVec3 = DVec3::new(0.93, 0.62, 0.40);
const MIDDLE: DVec3 = DVec3::new(0.42, 0.48, 0.60);
const ZENITH: DVec3 = DVec3::new(0.08, 0.19, 0.42);

/// Returns the light of the sky in a direction: hills, clouds, sun and air.
pub(in crate::demo) fn light(direction: DVec3) -> DVec3 {
    let air = air(direction);
    let hills = hills(direction);
    if direction.y < hills {
        let near = smoothstep(0.0, 0.08, hills - direction.y);
        return haze(direction).lerp(DVec3::new(0.24, 0.24, 0.36), 0.65 - 0.25 * near);
    }
    let (cover, cloud) = clouds(direction);
    let disc = if direction.dot(SUN) > SUN_EDGE { DISC } else { DVec3::ZERO };
    (air + disc).lerp(cloud, cover)
}

/// Returns the fraction of an object's light that is left after a distance through the air.
pub(in crate::demo) fn clarity(distance: f64) -> f64 {
    (-distance / 260.0).exp()
}

/// Returns the colour of the haze into which distant objects fade.
pub(in crate::demo) fn haze(direction: DVec3) -> DVec3 {
    let flat = DVec3::new(direction.x, 0.0, direction.z).try_normalize().unwrap_or(DVec3::NEG_Z);
    air(flat)
}

/// Returns the light of the sky and of the sunlit ground on a surface that faces `normal`.
pub(in crate::demo) fn ambient(normal: DVec3) -> DVec3 {
    const ABOVE: DVec3 = DVec3::new(0.40, 0.43, 0.52);
    const BELOW: DVec3 = DVec3::new(0.30, 0.22, 0.17);
    // The sky is brighter round the sun.
    let toward = 1.0 + 0.45 * normal.dot(DVec3::new(SUN.x, 0.0, SUN.z));
    BELOW.lerp(ABOVE, 0.5 + 0.5 * normal.y) * toward
}

fn air(direction: DVec3) -> DVec3 {
    let height = direction.y.clamp(0.0, 1.0).sqrt();
    let gradient = if height < 0.55 {
        HORIZON.lerp(MIDDLE, smoothstep(0.0, 1.0, height / 0.55))
    } else {
        MIDDLE.lerp(ZENITH, (height - 0.55) / 0.45)
    };
    let toward = direction.dot(SUN).max(0.0);
    let glow = DVec3::new(0.30, 0.17, 0.06) * toward.powi(6) + DVec3::new(0.5, 0.36, 0.2) * toward.powi(160);
    gradient + glow
}

/// Returns the sine of the elevation of the hills' outline.
fn hills(direction: DVec3) -> f64 {
    if direction.y > 0.15 {
        return 0.0;
    }
    let flat = DVec2::new(direction.x, direction.z).normalize_or_zero();
    0.012 + 0.085 * octaves(flat * 2.3 + DVec2::splat(3.7), 5).powi(2)
}

/// Returns cover and colour of the clouds: a flat layer, thinner towards the horizon.
fn clouds(direction: DVec3) -> (f64, DVec3) {
    let ceiling = DVec2::new(direction.x, direction.z) / (direction.y + 0.12);
    let point = ceiling * DVec2::new(1.5, 2.1) + DVec2::new(5.2, 1.3);
    let thickness = octaves(point, 5);
    let cover = smoothstep(0.46, 0.72, thickness) * smoothstep(0.0, 0.25, direction.y);
    if cover <= 0.0 {
        return (0.0, DVec3::ZERO);
    }
    // Thinner toward the sun means that sunlight comes in from there.
    let sunward = noise(point + DVec2::new(SUN.x, SUN.z) * 0.35);
    let lit = (0.75 + 0.9 * (thickness - 0.7 * sunward)).clamp(0.0, 1.4);
    let silver = direction.dot(SUN).max(0.0).powi(24);
    (0.9 * cover, DVec3::new(0.95, 0.76, 0.66) * lit + DVec3::new(1.1, 0.8, 0.5) * silver)
}
