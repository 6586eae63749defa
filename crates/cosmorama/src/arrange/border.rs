use super::Side;
use crate::raster::Rgba;

/// Samples along the four sides of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Border {
    /// Samples of each side, clockwise.
    sides: [Vec<Sample>; 4],
}

/// A place on a side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    /// Red, green and blue at the picture's edge, on a perceptual scale.
    pub(super) colour: [f32; 3],
    /// Variance of each channel, estimated from the slopes across and along the side.
    pub(super) doubt: [f32; 3],
}

/// Greatest number of samples on a side.
const SAMPLES: usize = 128;

impl Border {
    /// Returns the common number of samples on a side for pictures whose least width or height is given.
    pub fn samples_for(least: usize) -> usize {
        least.min(SAMPLES)
    }

    /// Samples the sides of a picture of `width`×`height` pixels of linear light, at `samples` places each.
    pub fn of((width, height): (usize, usize), samples: usize, light: impl Fn(usize, usize) -> Rgba) -> Self {
        let side = |side: Side| {
            let length = if matches!(side, Side::Top | Side::Bottom) { width } else { height };
            let row =
                |depth: usize| strip(length, samples, |along| light_at(side, (width, height), along, depth, &light));
            extrapolated(&row(0), &row(1))
        };
        Self { sides: Side::ALL.map(side) }
    }

    pub(super) fn side(&self, side: Side) -> &[Sample] {
        &self.sides[side as usize]
    }

    pub(super) fn samples(&self) -> usize {
        self.sides[0].len()
    }
}

/// Returns the pixel at a position along a side, clockwise, and at a distance from it; a picture of one row has no
/// second.
fn light_at(
    side: Side,
    (width, height): (usize, usize),
    along: usize,
    depth: usize,
    light: impl Fn(usize, usize) -> Rgba,
) -> Rgba {
    let (across, down) = (depth.min(width.saturating_sub(1)), depth.min(height.saturating_sub(1)));
    match side {
        Side::Top => light(along, down),
        Side::Right => light(width - 1 - across, along),
        Side::Bottom => light(width - 1 - along, height - 1 - down),
        Side::Left => light(across, height - 1 - along),
    }
}

/// Averages a row of pixels into samples on the perceptual scale.
fn strip(length: usize, samples: usize, light: impl Fn(usize) -> Rgba) -> Vec<[f32; 3]> {
    let average = |k: usize| {
        let (start, end) = (k * length / samples, ((k + 1) * length / samples).max(k * length / samples + 1));
        let mut sum = [0.0; 3];
        for along in start..end {
            let [red, green, blue, _] = light(along).0;
            for (sum, light) in sum.iter_mut().zip([red, green, blue]) {
                *sum += tone(light) / (end - start) as f32;
            }
        }
        sum
    };
    (0..samples).map(average).collect()
}

/// Converts light to a perceptual scale: about sRGB up to white, and continued beyond, so that suns do not dominate.
fn tone(light: f32) -> f32 {
    light.max(0.0).powf(1.0 / 2.2)
}

/// Extrapolates the outermost row, and the one inside it, to the edge half a pixel further out.
fn extrapolated(outer: &[[f32; 3]], inner: &[[f32; 3]]) -> Vec<Sample> {
    let at = |k: usize| {
        let (before, after) = (outer[k.saturating_sub(1)], outer[(k + 1).min(outer.len() - 1)]);
        let slope: [f32; 3] = std::array::from_fn(|c| 0.5 * (outer[k][c] - inner[k][c]));
        let along: [f32; 3] = std::array::from_fn(|c| 0.25 * (after[c] - before[c]));
        Sample {
            colour: std::array::from_fn(|c| outer[k][c] + slope[c]),
            doubt: std::array::from_fn(|c| slope[c] * slope[c] + along[c] * along[c]),
        }
    };
    (0..outer.len()).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_go_round_clockwise_and_end_at_the_edge() {
        let light = |i: usize, j: usize| Rgba::opaque((i as f32 + 0.5).powf(2.2), (j as f32 + 0.5).powf(2.2), 0.0);
        let border = Border::of((8, 6), 6, light);
        let [red, green, _] = border.side(Side::Right)[0].colour;
        assert!((red - 8.0).abs() < 1e-4 && (green - 0.5).abs() < 1e-4, "{red} {green}");
        let [red, green, _] = border.side(Side::Left)[0].colour;
        assert!(red.abs() < 1e-4 && (green - 5.5).abs() < 1e-4, "{red} {green}");
        let bottom = border.side(Side::Bottom);
        assert!(bottom[0].colour[0] > bottom[5].colour[0] && (bottom[2].colour[1] - 6.0).abs() < 1e-4);
    }
}
