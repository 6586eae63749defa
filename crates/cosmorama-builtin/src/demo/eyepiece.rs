use cosmorama::raster::{Image, Rgba};

/// Eyepiece of a cosmorama, the peep-show of the 1820s: a brass ring in dark wood, and nothing where one looks through.
#[derive(Clone, Copy, Debug, Default)]
pub struct Eyepiece;

/// Radii of the ring, in half heights of the picture.
const INNER: f64 = 0.88;
const OUTER: f64 = 0.98;

/// Breadth of the soft shadow inside the ring.
const SHADOW: f64 = 0.12;

impl Eyepiece {
    /// Draws it in linear light, with alpha.
    pub fn picture(self, width: usize, height: usize) -> Image<Rgba> {
        let unit = height as f64 / 2.0;
        Image::from_fn(width, height, |i, j| {
            let (x, y) = (i as f64 + 0.5 - width as f64 / 2.0, j as f64 + 0.5 - unit);
            let radius = x.hypot(y) / unit;
            // Parts of the pixel outside of a circle.
            let beyond = |circle: f64| ((radius - circle) * unit + 0.5).clamp(0.0, 1.0) as f32;
            let (ring, wood) = (beyond(INNER), beyond(OUTER));
            // The ring is round in section, and lit from above on the left.
            let across = ((radius - INNER) / (OUTER - INNER)).clamp(0.0, 1.0) * 2.0 - 1.0;
            let facing = (1.0 - across * across).sqrt() * 0.6 - across * (x + y) / (radius * unit).max(1e-9) * 0.5;
            let gleam = (0.05 + facing.max(0.0).powi(3)) as f32;
            let grain = (0.5 + 0.5 * (0.35 * y + 3.0 * (0.011 * x).sin()).sin()) as f32;
            let brass = Rgba::opaque(0.75 * gleam, 0.5 * gleam, 0.15 * gleam);
            let walnut = Rgba::opaque(0.030 + 0.02 * grain, 0.014 + 0.008 * grain, 0.006);
            let shade = ((radius - INNER + SHADOW) / SHADOW).clamp(0.0, 1.0).powi(2) as f32;
            let glass = Rgba([0.0, 0.0, 0.0, 0.8 * shade]);
            glass * (1.0 - ring) + brass * (ring - wood) + walnut * wood
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_looks_through_its_middle_only() {
        let image = Eyepiece.picture(160, 90);
        assert_eq!(image.get(80, 45).alpha(), 0.0);
        assert_eq!([image.get(0, 0).alpha(), image.get(30, 45).alpha()], [1.0, 1.0]);
        assert!(image.pixels().iter().all(|pixel| (0..3).all(|c| (0.0..=pixel.alpha() + 1e-6).contains(&pixel.0[c]))));
    }
}
