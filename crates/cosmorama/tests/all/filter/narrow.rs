//! A world all but flat, with noise: mappings to it are affine, so that filters have closed forms.

use cosmorama::camera::{Footprint, PixelPoint, View};
use cosmorama::raster::Rgba;
use cosmorama::world::{Light, World};
use glam::{DMat2, DVec2};
use testkit::{light_by_texel, perspective};

/// Texels along a side.
pub(super) const SIDE: usize = 128;

/// A view so narrow that its mapping is affine to 10⁻⁷, as a world.
pub(super) fn narrow() -> World {
    World::new([("narrow".to_owned(), perspective(SIDE, SIDE, 0.02, 0.0, 0.0, 0.0))]).expect("one view")
}

pub(super) fn noise_at(i: usize, j: usize) -> f64 {
    ((i * 7919 + j * 104_729 + i * j * 31) % 997) as f64 / 996.0
}

/// Grey light by texel.
pub(super) fn grey(world: &World, value: impl Fn(usize, usize) -> f64) -> Light {
    let texels = light_by_texel(world, |_, i, j, _| {
        let value = value(i, j) as f32;
        Rgba::opaque(value, value, value)
    });
    Light::new(world, texels).expect("a texel for each")
}

/// A footprint in texels: its middle, and its derivatives by screen x and y.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pixel {
    pub(super) middle: DVec2,
    pub(super) sides: DMat2,
}

impl Pixel {
    pub(super) fn footprint(self, view: &View) -> Footprint {
        let here = view.footprint(PixelPoint::new(self.middle.x, self.middle.y)).expect("inside");
        let along = |texels: DVec2| here.jacobian.dx * texels.x + here.jacobian.dy * texels.y;
        Footprint::new(here.direction, along(self.sides.x_axis), along(self.sides.y_axis))
    }

    /// Offset of a texel's centre on the screen.
    pub(super) fn on_screen(self, i: usize, j: usize) -> DVec2 {
        self.sides.inverse() * (DVec2::new(i as f64 + 0.5, j as f64 + 0.5) - self.middle)
    }

    /// Half the size of the box around the parallelogram.
    pub(super) fn half_box(self) -> DVec2 {
        (self.sides.x_axis.abs() + self.sides.y_axis.abs()) / 2.0
    }

    /// Pixels all over the image, of two texels to eight, in any orientation; those of the second half are mirrored.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        (0..24).map(|k| {
            let middle = DVec2::new(42.0 + 1.93 * f64::from(k), 86.0 - 1.87 * f64::from(k));
            let angle = 0.7 * f64::from(k);
            let (long, short) = (3.0 + f64::from(k % 6), 2.2 + 0.4 * f64::from(k % 4));
            let turn = if k < 12 { 1.3 } else { -1.1 };
            let sides = DMat2::from_cols(DVec2::from_angle(angle) * long, DVec2::from_angle(angle + turn) * short);
            Self { middle, sides }
        })
    }
}
