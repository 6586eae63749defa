use glam::DVec2;

/// Returns smooth noise between 0 and 1: random values at integer points of the plane, blended smoothly between them.
pub(in crate::demo) fn noise(point: DVec2) -> f64 {
    let (column, row) = (floor(point.x), floor(point.y));
    let within = point - DVec2::new(column as f64, row as f64);
    let blend = within * within * (DVec2::splat(3.0) - within * 2.0);
    let (column, row) = (column as u32, row as u32);
    let corner = |right: u32, down: u32| hash(column.wrapping_add(right), row.wrapping_add(down));
    let top = corner(0, 0) + (corner(1, 0) - corner(0, 0)) * blend.x;
    let bottom = corner(0, 1) + (corner(1, 1) - corner(0, 1)) * blend.x;
    top + (bottom - top) * blend.y
}

/// Rounds down. The standard floor is a function call on older processors, and noise calls it often.
fn floor(value: f64) -> i64 {
    let toward_zero = value as i64;
    toward_zero - i64::from(value < toward_zero as f64)
}

/// Returns noise in octaves, each twice as fine and half as strong; between 0 and 1.
pub(in crate::demo) fn octaves(point: DVec2, count: u32) -> f64 {
    let (mut sum, mut total, mut strength, mut point) = (0.0, 0.0, 1.0, point);
    for _ in 0..count {
        sum += strength * noise(point);
        total += strength;
        strength *= 0.5;
        // The turn keeps the octaves' lattices from lining up.
        point = DVec2::new(1.6 * point.x - 1.2 * point.y, 1.2 * point.x + 1.6 * point.y) + DVec2::splat(17.3);
    }
    sum / total
}

/// Returns a value between 0 and 1 for a lattice point, by mixing bits with multiplications.
fn hash(column: u32, row: u32) -> f64 {
    let mut bits = column.wrapping_mul(0x9E37_79B1) ^ row.wrapping_mul(0x85EB_CA77);
    bits = (bits ^ (bits >> 15)).wrapping_mul(0x2C1B_3C6D);
    bits = (bits ^ (bits >> 12)).wrapping_mul(0x297A_2D39);
    f64::from(bits ^ (bits >> 15)) / f64::from(u32::MAX)
}

/// Returns 0 below `low`, 1 above `high`, and a smooth transition between.
pub(in crate::demo) fn smoothstep(low: f64, high: f64, value: f64) -> f64 {
    let t = ((value - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_smooth_across_lattice_lines() {
        for step in -50..50 {
            let x = f64::from(step);
            let y = 0.37 * x + 0.2;
            assert!((noise(DVec2::new(x - 1e-9, y)) - noise(DVec2::new(x + 1e-9, y))).abs() < 1e-7);
        }
    }
}
