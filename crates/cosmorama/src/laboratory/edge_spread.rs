use super::pattern::Probe;
use crate::raster::{Image, Rgba};

/// Distance from an edge, in pixels, within which pixels tell its shape.
const REACH: f64 = 6.0;

/// Bins a pixel of the edge's shape.
const BINS: f64 = 5.0;

/// Brightness up to which an edge is dark, and from which it is bright.
const DARK: f64 = 0.1;
const BRIGHT: f64 = 0.9;

/// Returns the width over which edges go from 10 % to 90 %: the edge's shape is the mean of all pixels at one distance, as
/// the slanted-edge method has it (ISO 12233).
pub(super) fn width(probes: &[Probe], image: &Image<Rgba>) -> Option<f64> {
    let shape = shape(probes, image);
    let middle = shape.partition_point(|(distance, _)| *distance < 0.0);
    // From the middle outwards, so that ringing farther out is not taken for the edge; between both it is neither dark nor bright.
    let dark = (0..middle).rev().find(|&at| shape[at].1 < DARK)?;
    let bright = (dark + 1..shape.len()).find(|&at| shape[at].1 > BRIGHT)?;
    let dark = (dark..bright).rev().find(|&at| shape[at].1 < DARK)?;
    Some(crossing(shape[bright - 1], shape[bright], BRIGHT) - crossing(shape[dark], shape[dark + 1], DARK))
}

/// Returns the mean brightness at distances from an edge, from dark to bright, where there are pixels.
fn shape(probes: &[Probe], image: &Image<Rgba>) -> Vec<(f64, f64)> {
    let count = (2.0 * REACH * BINS) as usize;
    let mut bins = vec![(0.0, 0usize); count];
    for probe in probes.iter().filter(|probe| probe.from_edge.abs() < REACH) {
        let blue = f64::from(image.pixels()[probe.pixel].0[2]);
        let bin = &mut bins[(((probe.from_edge + REACH) * BINS) as usize).min(count - 1)];
        *bin = (bin.0 + if probe.rises { blue } else { 1.0 - blue }, bin.1 + 1);
    }
    let full = bins.into_iter().enumerate().filter(|(_, (_, pixels))| *pixels > 0);
    full.map(|(bin, (sum, pixels))| ((bin as f64 + 0.5) / BINS - REACH, sum / pixels as f64)).collect()
}

/// Returns the distance at which a line between two points of the shape reaches a value.
fn crossing(from: (f64, f64), to: (f64, f64), value: f64) -> f64 {
    from.0 + (value - from.1) / (to.1 - from.1) * (to.0 - from.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn probes(width: usize, edge: f64) -> Vec<Probe> {
        let probe = |pixel: usize| Probe {
            pixel,
            frequency: [0.0; 2],
            from_edge: pixel as f64 * 0.01 - edge,
            rises: true,
            texels: 1.0,
        };
        (0..width).map(probe).collect()
    }

    #[test]
    fn a_ramp_is_as_wide_as_it_is() {
        // From dark to bright over two pixels; 10 % to 90 % of it is 1.6.
        let at = |i: usize| ((i as f64 * 0.01 - 8.0) / 2.0 + 0.5).clamp(0.0, 1.0) as f32;
        let image = Image::from_fn(1600, 1, |i, _| Rgba::opaque(0.0, 0.0, at(i)));
        let width = width(&probes(1600, 8.0), &image).expect("an edge");
        assert!((width - 1.6).abs() < 0.02, "{width}");
    }

    /// Checks an edge that is bright on both sides of the middle: there a bin is as bright as the one before.
    #[test]
    fn an_edge_beside_its_place_has_a_width() {
        let image = Image::from_fn(1600, 1, |i, _| Rgba::opaque(0.0, 0.0, if i < 750 { 0.0 } else { 1.0 }));
        let width = width(&probes(1600, 8.0), &image).expect("an edge");
        assert!(width.is_finite() && width > 0.0 && width < 0.5, "{width}");
    }

    #[test]
    fn without_pixels_there_is_no_edge() {
        assert_eq!(width(&[], &Image::filled(1, 1, Rgba::BLACK)), None);
    }
}
